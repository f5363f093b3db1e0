//! One step of a game: the cycle of `spec/01` §4. Effects and updates change sprites through the operations
//! in `population.rs` and `motion.rs`.

mod avatars;
mod effects;
mod events;
mod motion;
pub(crate) mod physics;
mod population;
mod scheduler;
pub(crate) mod sprites;
mod terminations;

use crate::limits::{EFFECT_WORK, MAX_HELD, MAX_MESSAGES, MAX_TICKS, MAX_WORK};
use crate::numbers::geometry::Direction;
use crate::rules::class::SpriteClass;
use crate::rules::{Action, Limit, Outcome, Rules, SpriteType};
use crate::world::{Models, NONE, Slot, World, flag};
pub(crate) use scheduler::{Scheduler, Unscheduled};

/// An execution of an interaction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Meeting {
    /// The interaction's index in [`Description::interactions`](crate::Description).
    pub line: usize,
    /// The first sprite's type, before the effect acts on the sprite.
    pub first: SpriteType,
    /// The partner's type, or `None` for the edge of the screen or a timed effect.
    pub second: Option<SpriteType>,
    /// The column and row of the cell that contains the first sprite's top-left corner.
    pub cell: (i32, i32),
}

/// A sprite's removal by an interaction that involves the sprite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Removal {
    /// The interaction's index in [`Description::interactions`](crate::Description).
    pub line: usize,
    /// The removed sprite's type.
    pub sprite: SpriteType,
    /// The partner's type, or `None` for the edge of the screen or a timed effect.
    pub by: Option<SpriteType>,
}

/// An observer of a step, which is notified of executed interactions and the sprites involved.
pub trait Watch {
    /// Called after interaction `line` (an index into [`Description::interactions`](crate::Description)) has
    /// been executed. An interaction that moves the same sprite back to the same position in every tick is
    /// reported only once.
    fn interaction(&mut self, line: usize);

    /// Returns `true` if [`Watch::meeting`] should be called.
    fn wants_meetings(&self) -> bool {
        false
    }

    /// Called after [`Watch::interaction`] with the sprites that took part, except for timed effects that run
    /// on no sprite.
    fn meeting(&mut self, _meeting: Meeting) {}

    /// Returns `true` if [`Watch::removal`] should be called.
    fn wants_removals(&self) -> bool {
        false
    }

    /// Called after an execution for each participating sprite that was removed or disabled. Dead avatars are
    /// disabled.
    fn removal(&mut self, _removal: Removal) {}

    /// Called at the end of the step with the amount of work. See [`MAX_WORK`].
    fn worked(&mut self, _work: usize) {}
}

/// An observer that ignores everything and costs nothing.
impl Watch for () {
    fn interaction(&mut self, _: usize) {}
}

/// A step in progress.
pub(crate) struct Step<'a, S> {
    pub(crate) rules: &'a Rules,
    pub(crate) models: &'a Models,
    pub(crate) world: &'a mut World,
    pub(crate) scheduler: S,
    /// The update-order position of the type being updated. Types with a lower position have not been updated
    /// yet in this tick.
    pub(crate) updating: i32,
    /// The reason why the step was stopped, or `None` if it was not stopped.
    pub(crate) stopped: Option<Limit>,
    /// The amount of work so far. See [`MAX_WORK`].
    pub(crate) work: usize,
    /// The creation number of the sprite being updated.
    pub(crate) updating_id: u32,
    /// The index of the current event-phase pass, or −1 before the first pass.
    pub(crate) pass: i32,
}

impl<'a, S: Scheduler> Step<'a, S> {
    pub(crate) fn new(
        rules: &'a Rules,
        models: &'a Models,
        world: &'a mut World,
        scheduler: S,
    ) -> Step<'a, S> {
        Step {
            rules,
            models,
            world,
            scheduler,
            updating: i32::MAX,
            stopped: None,
            work: 0,
            updating_id: 0,
            pass: -1,
        }
    }

    /// Plays one tick (`spec/01` §4).
    pub(crate) fn cycle(&mut self, action: Action, watch: &mut (impl Watch + ?Sized)) {
        self.world.start_tick(action);
        S::begin(self);
        self.world.settle_moved();
        self.update(action);
        if self.stopped.is_none() {
            self.events(watch);
        }
        if self.stopped.is_some() {
            S::unsettles(self);
        }
        self.pass = i32::MAX;
        self.clear();
        S::ends(self);
        if let Some(limit) = self.stopped {
            self.world.end(Outcome::Stopped(limit));
            return;
        }
        self.terminate();
        if self.world.messages() > MAX_MESSAGES {
            self.world.forget_messages();
            if self.world.outcome() == Outcome::Ongoing {
                self.world.end(Outcome::Ended);
            }
        }
        if self.world.tick() >= MAX_TICKS && self.world.outcome() != Outcome::Won {
            // The avatar loses. Without an avatar, the reference crashes.
            let gone = self.world.avatar() == NONE;
            self.world.end(if gone { Outcome::Stopped(Limit::NoAvatar) } else { Outcome::Lost });
        }
    }

    /// Updates the avatar, then all other sprites.
    fn update(&mut self, action: Action) {
        let avatar = self.world.avatar();
        if avatar != NONE && !self.world.sprite(avatar).is(flag::DISABLED) {
            let stype = self.world.sprite(avatar).stype;
            if self.rules.types[stype.index()].traits.oriented_image {
                self.turn_picture(avatar);
            }
            avatars::update(self, avatar, action);
            if self.stopped.is_some() {
                return;
            }
        }
        S::update_all(self);
        if self.stopped.is_none() {
            self.updating = -1;
        }
    }

    /// Updates a type's sprites, in order of creation.
    fn update_type(&mut self, stype: SpriteType) {
        let info = &self.rules.types[stype.index()];
        let Some((class, order)) = info.updated() else { return };
        if !self.start_type(order, stype) {
            return;
        }
        let mut slot = self.world.group(stype).head;
        while slot != NONE {
            self.update_sprite(slot, class, info.traits.oriented_image);
            if self.stopped.is_some() {
                return;
            }
            slot = self.world.sprite(slot).next;
        }
    }

    /// Starts the updates of a type's sprites. Returns `false` if the type has no sprites or too many
    /// sprites.
    #[inline(always)]
    pub(crate) fn start_type(&mut self, order: i32, stype: SpriteType) -> bool {
        let count = self.world.group(stype).count;
        if count == 0 {
            return false;
        }
        (self.updating, self.updating_id) = (order, 0);
        self.work(usize::from(count));
        self.stopped.is_none()
    }

    /// Updates a sprite (`spec/02`).
    #[inline(always)]
    pub(crate) fn update_sprite(&mut self, slot: Slot, class: SpriteClass, oriented_image: bool) {
        self.updating_id = self.world.sprite(slot).id;
        if oriented_image {
            self.turn_picture(slot);
        }
        sprites::update(self, slot, class);
    }

    /// Checks the orientation. Before each update, the reference searches for an image with this orientation,
    /// and throws an exception if there is none.
    fn turn_picture(&mut self, slot: Slot) {
        if !Direction::BASE.contains(&self.world.overrides(slot).orientation) {
            self.stop(Limit::UnfitSprite);
        }
    }

    /// Finds the player's avatar: the last sprite of an avatar class in update order, ignoring the type that
    /// is drawn first (`spec/01` §4.2). Levels checked in strict mode have a single avatar.
    pub(crate) fn find_avatar(&mut self) {
        let types = self.rules.order.iter().skip(1).rev();
        let slots = types.flat_map(|&stype| self.world.slots(stype));
        let avatar = slots.filter(|&slot| self.world.sprite(slot).is(flag::AVATAR)).last();
        match avatar {
            Some(slot) if !self.can_be_played(slot) => self.stop(Limit::UnfitSprite),
            Some(slot) => self.control(slot),
            // The reference looks for the avatar once when it builds the level, and again when the run
            // starts.
            None => (0..2).for_each(|_| self.message()),
        }
    }

    /// Removes all avatars except the first one created, and logs a message, as the reference does. Levels
    /// checked in strict mode have only one avatar.
    pub(crate) fn remove_extra_avatars(&mut self) {
        let slots = 0..self.world.slot_count() as Slot;
        let counts = |slot: &Slot| self.world.sprite(*slot).is(flag::AVATAR) || self.can_be_played(*slot);
        let avatars: Vec<Slot> = slots.filter(counts).collect();
        let Some((_, extra @ [_, ..])) = avatars.split_first() else { return };
        self.message();
        for &slot in extra {
            self.world.release(self.models, slot, &mut self.scheduler);
        }
        self.world.forget_gone();
    }

    /// Removes the sprites killed in this tick (`spec/01` §4.10).
    #[inline(always)]
    fn clear(&mut self) {
        if !self.world.killed().is_empty() {
            self.clear_killed();
        }
        self.world.end_tick();
    }

    fn terminate(&mut self) {
        // The last result still holds, because all terminations other than Timeouts count sprites.
        if !self.world.census_changed() && self.world.tick() < self.rules.first_timeout {
            return;
        }
        self.world.settle_census(false);
        for termination in &self.rules.terminations {
            if let Some(can_end) = termination.permits(self.rules, self.world) {
                // Earlier terminations are checked again in the next tick.
                if self.world.permit_end(can_end) {
                    self.world.settle_census(true);
                }
            }
            if termination.holds(self.rules, self.world) {
                let won = termination.wins(self.world);
                self.world.end(if won { Outcome::Won } else { Outcome::Lost });
                return;
            }
        }
    }

    /// Stops the episode, because the reference engine would throw an exception, or because a limit of this
    /// engine is exceeded.
    pub(crate) fn stop(&mut self, limit: Limit) {
        self.stopped.get_or_insert(limit);
    }

    /// Counts examined sprites or cells. Stops the episode if their number in one tick exceeds the limit.
    pub(crate) fn work(&mut self, amount: usize) {
        self.work = self.work.saturating_add(amount);
        if self.work > MAX_WORK {
            self.stop(Limit::Work);
        }
    }

    /// Counts an execution of an effect.
    pub(crate) fn work_of_effect(&mut self) {
        self.work(EFFECT_WORK);
    }

    /// Calls [`World::add_amount`], and enforces the resource limit.
    pub(crate) fn add_amount(&mut self, holder: Slot, resource: SpriteType, change: i32) {
        self.world.add_amount(holder, resource, change);
        if self.world.held().len() > MAX_HELD {
            self.stop(Limit::Resources);
        }
    }

    pub(crate) fn message(&mut self) {
        self.world.add_messages(1);
    }
}
