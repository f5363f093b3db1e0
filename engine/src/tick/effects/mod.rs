//! Executes effects (`spec/03`). Each file contains one family.

mod health;
mod kill;
mod motion;
mod resource;
mod spawn;
mod transform;
mod walls;

use super::{Scheduler, Step};
use crate::limits::MAX_TIMERS;
use crate::rules::effects::{Batch, Draws, Effect, Summary};
use crate::rules::{EffectInfo, Limit, memory};
use crate::world::{Partners, Slot, Timer, flag};

/// Executes an effect on a sprite and, if it has one, its partner. Effects that lack a required partner log a
/// message.
pub(crate) fn execute(
    step: &mut Step<'_, impl Scheduler>,
    index: u16,
    effect: &Effect,
    one: Slot,
    two: Option<Slot>,
) {
    match (effect, two) {
        (Effect::KillSprite, _) => step.kill(one),
        (Effect::KillAll { stype }, _) => kill::all(step, *stype),
        (Effect::KillIfHasLess { resource, limit }, _) => {
            let hit = step.world.amount(one, *resource) <= *limit;
            kill::when(step, index, one, hit);
        }
        (Effect::KillIfHasMore { resource, limit }, _) => {
            let hit = step.world.amount(one, *resource) >= *limit;
            kill::when(step, index, one, hit);
        }
        (Effect::AddHealthPoints { value, kill_second, to_max }, _) => {
            health::add(step, index, one, two.filter(|_| *kill_second), *value, *to_max);
        }
        (Effect::SubtractHealthPoints { value, limit, stype, .. }, _) => {
            health::subtract(step, index, one, *value, *limit, *stype);
        }
        (Effect::StepBack { pixel_perfect }, _) => {
            motion::step_back(step, one, two.filter(|_| *pixel_perfect))
        }
        (Effect::UndoAll { spare }, _) => motion::undo_all(step, spare),
        (Effect::TurnAround, _) => motion::turn_around(step, one),
        (Effect::ReverseDirection, _) => motion::reverse(step, one),
        (Effect::FlipDirection, _) => motion::flip(step, one),
        (Effect::HalfSpeed, _) => step.world.edit_overrides(one).speed *= 0.5,
        (Effect::WrapAround { offset }, _) => motion::wrap_around(step, one, *offset),
        (Effect::ChangeSpeed { stype, value, how }, _) => motion::change_speed(step, *stype, *value, *how),
        (Effect::Spawn { stype, prob }, _) => spawn::here(step, one, *stype, *prob),
        (Effect::SpawnIf(rule), _) => spawn::if_amount(step, index, one, rule),
        (Effect::CloneSprite, _) => spawn::clone(step, one),
        (Effect::TransformTo { stype, kill_second, force_orientation }, _) => {
            transform::to(step, one, two.filter(|_| *kill_second), *stype, *force_orientation);
        }
        (Effect::TransformToAll { stype, to, kill_second, force_orientation }, _) => {
            transform::all(step, two.filter(|_| *kill_second), *stype, *to, *force_orientation);
        }
        (Effect::TransformToRandomChild { options, kill_second, force_orientation }, _) => {
            transform::random_child(step, one, two.filter(|_| *kill_second), options, *force_orientation);
        }
        (Effect::ShieldFrom { stype, keyword }, _) => {
            step.world.shield((step.world.sprite(one).stype, *stype, *keyword));
        }
        (Effect::KillIfNotUpright, _) => kill::if_not_upright(step, one),
        (Effect::RemoveScore { stype, kill_second }, _) => {
            kill::remove_score(step, one, two.filter(|_| *kill_second), *stype);
        }
        (Effect::UpdateSpawnType { stype, spawn_point }, _) => {
            spawn::update_type(step, two, *stype, *spawn_point);
        }
        (Effect::SpawnIfCounterSubTypes(rule), _) => spawn::if_counter_subtypes(step, index, one, rule),
        (Effect::WaterPhysics, _) => step.world.extra(step.rules, one).gravity = 0.2,
        (Effect::AddTimer { timed }, _) => add_timer(step, *timed),
        (Effect::Disabled(summary), _) => draw_only(step, summary, one, two),
        (_, None) => step.message(),
        (Effect::KillBoth, Some(two)) => {
            step.kill(one);
            step.kill(two);
        }
        (Effect::KillIfAlive, Some(two)) => {
            if !step.world.sprite(two).is(flag::KILLED) {
                step.kill(one);
            }
        }
        (Effect::KillIfFromAbove, Some(two)) => kill::if_from_above(step, index, one, two),
        (Effect::KillIfFrontal { frontal }, Some(two)) => kill::if_frontal(step, index, one, two, *frontal),
        (Effect::KillIfSpeed { limit, fast }, Some(two)) => kill::if_speed(step, one, two, *limit, *fast),
        (Effect::TransformIfCount(rule), Some(two)) => transform::if_count(step, index, one, two, rule),
        (Effect::TransformToSingleton { stype, other, take_orientation }, Some(two)) => {
            transform::to_singleton(step, one, two, *stype, *other, *take_orientation);
        }
        (Effect::BounceDirection { most }, Some(two)) => walls::bounce_direction(step, one, two, *most),
        (Effect::WallStop, Some(two)) => walls::stop(step, one, two),
        (Effect::WallBounce, Some(two)) => walls::bounce(step, one, two),
        (Effect::WallReverse, Some(two)) => walls::reverse(step, one, two),
        (Effect::KillIfOtherHasMore { resource, limit, subtract }, Some(two)) => {
            let hit = step.world.amount(two, *resource) >= *limit;
            kill::when(step, index, one, hit);
            if hit && *subtract {
                step.add_amount(two, *resource, limit.wrapping_neg());
            }
        }
        (Effect::Align { orient }, Some(two)) => motion::align(step, one, two, *orient),
        (Effect::AttractGaze { align, prob }, Some(two)) => {
            motion::attract_gaze(step, one, two, *align, *prob)
        }
        (Effect::BounceForward, Some(two)) => motion::bounce_forward(step, one, two),
        (Effect::PullWithIt { pixel_perfect }, Some(two)) => {
            motion::pull_with_it(step, index, one, two, *pixel_perfect);
        }
        (Effect::TeleportToExit, Some(two)) => motion::teleport(step, one, two),
        (Effect::SpawnBeside { stype, shift, step_back, prob }, Some(two)) => {
            spawn::beside(step, two, *stype, *shift, *step_back, *prob);
        }
        (Effect::SpawnBehind { stype, prob }, Some(two)) => spawn::behind(step, two, *stype, *prob),
        (Effect::CollectResource { kill_resource }, Some(two)) => {
            resource::collect(step, index, one, two, *kill_resource);
        }
        (Effect::CollectResourceIfHeld { held, value, kill_resource }, Some(two)) => {
            resource::collect_if_held(step, index, one, two, (*held, *value), *kill_resource);
        }
        (Effect::ChangeResource { resource, value, kill_resource }, Some(two)) => {
            resource::change(step, index, one, two, (*resource, *value), *kill_resource);
        }
    }
}

/// Executes a batch effect on a sprite and all its partners. Returns the number of executions that the batch
/// counts as.
pub(crate) fn execute_batch(
    step: &mut Step<'_, impl Scheduler>,
    info: &EffectInfo,
    one: Slot,
    partners: &mut Partners,
) -> i32 {
    match info.summary.batch {
        Some(Batch::Bounce) => walls::bounce_batch(step, one, partners),
        Some(Batch::Reverse) => walls::reverse_batch(step, one, partners),
        None => 0,
    }
}

/// Executes a timed effect on no sprite (`spec/03` §6.4).
pub(crate) fn execute_alone(step: &mut Step<'_, impl Scheduler>, index: u16, effect: &Effect) {
    match effect {
        Effect::KillAll { stype } => kill::all(step, *stype),
        Effect::UndoAll { spare } => motion::undo_all(step, spare),
        Effect::ChangeSpeed { stype, value, how } => motion::change_speed(step, *stype, *value, *how),
        Effect::TransformToAll { stype, to, force_orientation, .. } => {
            transform::all(step, None, *stype, *to, *force_orientation);
        }
        Effect::SubtractHealthPoints { value, limit, stype: Some(stype), .. } => {
            match health::last_of(step, *stype) {
                Some(target) => health::subtract(step, index, target, *value, *limit, Some(*stype)),
                None => step.stop(Limit::NoSprite),
            }
        }
        Effect::AddTimer { timed } => add_timer(step, *timed),
        // No effect draws random numbers when it runs on no sprite.
        Effect::Disabled(_) => {}
        Effect::KillIfNotUpright | Effect::WaterPhysics => step.stop(Limit::NoSprite),
        Effect::UpdateSpawnType { stype, spawn_point } => {
            spawn::update_type(step, None, *stype, *spawn_point)
        }
        // These effects need a sprite.
        Effect::KillSprite
        | Effect::KillBoth
        | Effect::KillIfAlive
        | Effect::KillIfFromAbove
        | Effect::KillIfHasLess { .. }
        | Effect::KillIfHasMore { .. }
        | Effect::KillIfOtherHasMore { .. }
        | Effect::KillIfFrontal { .. }
        | Effect::KillIfSpeed { .. }
        | Effect::AddHealthPoints { .. }
        | Effect::StepBack { .. }
        | Effect::TurnAround
        | Effect::ReverseDirection
        | Effect::FlipDirection
        | Effect::HalfSpeed
        | Effect::WrapAround { .. }
        | Effect::Align { .. }
        | Effect::AttractGaze { .. }
        | Effect::BounceForward
        | Effect::PullWithIt { .. }
        | Effect::TeleportToExit
        | Effect::Spawn { .. }
        | Effect::SpawnIf(_)
        | Effect::SpawnBeside { .. }
        | Effect::SpawnBehind { .. }
        | Effect::CloneSprite
        | Effect::TransformTo { .. }
        | Effect::TransformToRandomChild { .. }
        | Effect::CollectResource { .. }
        | Effect::CollectResourceIfHeld { .. }
        | Effect::ChangeResource { .. }
        | Effect::ShieldFrom { .. }
        | Effect::RemoveScore { .. }
        | Effect::SpawnIfCounterSubTypes(_)
        | Effect::TransformIfCount(_)
        | Effect::TransformToSingleton { .. }
        | Effect::BounceDirection { .. }
        | Effect::WallStop
        | Effect::WallBounce
        | Effect::WallReverse
        | Effect::SubtractHealthPoints { .. } => step.message(),
    }
}

/// Makes an effect's random draws without its consequences, so that later draws stay the same.
#[cold]
fn draw_only(step: &mut Step<'_, impl Scheduler>, summary: &Summary, one: Slot, two: Option<Slot>) {
    if summary.needs_partner && two.is_none() {
        return;
    }
    match summary.draws {
        Draws::Nothing => {}
        Draws::Direction => {
            step.world.dice().below(4);
        }
        Draws::Chance(_) => {
            step.world.dice().double();
        }
        Draws::ChanceIfOriented(_) => two.into_iter().for_each(|two| motion::draw_gaze(step, one, two)),
        Draws::OneOf(0) => {}
        Draws::OneOf(types) => {
            step.world.dice().below(types as i32);
        }
        Draws::Exit => two.into_iter().for_each(|two| motion::draw_exit(step, two)),
    }
}

fn add_timer(step: &mut Step<'_, impl Scheduler>, timed: u16) {
    if step.world.timers().len() >= MAX_TIMERS {
        return step.stop(Limit::Timers);
    }
    let due = step.world.tick().saturating_add(step.rules.timed[usize::from(timed)].timer);
    step.plan(Timer { due, timed });
}

/// Returns an execution's score change, and a flag that is `true` if the text of the score change is not a
/// number.
pub(crate) fn score_change(info: &EffectInfo, remembered: u8) -> (i32, bool) {
    if remembered & memory::KILLED != 0 {
        (info.summary.score_if_killed, info.score_faults[1])
    } else {
        (info.score_change, info.score_faults[0])
    }
}

impl<S: Scheduler> Step<'_, S> {
    /// Records whether the effect's score applies, which some effects decide at run time.
    fn apply_score(&mut self, index: u16, on: bool) {
        self.world.remember(index, memory::APPLY_SCORE, on);
    }

    /// Records whether the changes in `counter` apply.
    fn apply_count(&mut self, index: u16, on: bool) {
        if self.counts(index) {
            self.world.remember(index, memory::NO_COUNT, !on);
        }
    }

    /// Records whether the changes in `counterElse` apply.
    fn apply_count_else(&mut self, index: u16, on: bool) {
        if self.counts(index) {
            self.world.remember(index, memory::NO_COUNT_ELSE, !on);
        }
    }

    fn counts(&self, index: u16) -> bool {
        self.rules.effects[usize::from(index)].counting.is_some()
    }
}
