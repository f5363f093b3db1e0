//! Characters that move at random or chase other sprites (`spec/02` §7).

use crate::numbers::geometry::{Direction, Rect};
use crate::rules::class::{ClassFamily, SpriteClass};
use crate::rules::{Limit, Rules, SpriteType};
use crate::tick::physics;
use crate::tick::{Scheduler, Step};
use crate::world::{NO_HEADING, NONE, Slot, Sprite, Target, World, flag};
use smallvec::SmallVec;

/// The directions to choose from, as indices into [`Direction::BASE`]. A direction appears once for each
/// target that favours it.
type Options = SmallVec<[u8; 16]>;

/// Updates a character: applies its drift, then moves it in the chosen direction.
#[inline(always)]
pub(super) fn update(step: &mut Step<'_, impl Scheduler>, slot: Slot, class: SpriteClass) {
    let sprite = step.world.sprite(slot);
    let traits = &step.rules.types[sprite.stype.index()].traits;
    // Other characters do not drift.
    if sprite.is(flag::FIRST_TICK | flag::ORIENTED) || traits.continuous {
        physics::passive(step, slot);
    }
    let direction = if wanders(class) {
        let heading = random_heading(step, slot, traits.cons);
        if heading != NO_HEADING {
            let speed = step.world.overrides(slot).speed;
            physics::active_along(step, slot, heading as usize, speed);
            return;
        }
        Direction::NONE
    } else {
        pursue(step, slot, class)
    };
    let speed = step.world.overrides(slot).speed;
    physics::active(step, slot, direction, speed);
}

/// Chooses a direction for a waiting character.
#[inline(always)]
pub(crate) fn choose(step: &mut Step<'_, impl Scheduler>, slot: Slot, class: SpriteClass) {
    if wanders(class) {
        let cons = step.rules.types[step.world.sprite(slot).stype.index()].traits.cons;
        random_heading(step, slot, cons);
    } else {
        pursue(step, slot, class);
    }
}

/// Returns `true` if characters of the class move at random.
fn wanders(class: SpriteClass) -> bool {
    matches!(class, SpriteClass::RandomNPC | SpriteClass::RandomInertial)
}

#[inline(never)]
fn pursue(step: &mut Step<'_, impl Scheduler>, slot: Slot, class: SpriteClass) -> Direction {
    use ClassFamily as Family;
    use SpriteClass as C;
    match (class, class.family()) {
        (C::LOSChaser, _) => los_chaser(step, slot),
        (C::PathChaser, _) => path_chaser(step, slot),
        (C::AlternateChaser, _) => alternate_chaser(step, slot),
        (C::RandomAltChaser, _) => or_random(step, slot, alternate_chaser),
        (C::PathAltChaser, _) => path_alt_chaser(step, slot),
        (C::RandomPathAltChaser, _) => or_random(step, slot, path_alt_chaser),
        (_, Family::Npc) => chaser(step, slot),
        // Only characters are updated here.
        (_, Family::Thing | Family::Resource | Family::Flicker | Family::Missile) => chaser(step, slot),
        (_, Family::Walker | Family::Producer | Family::Avatar) => chaser(step, slot),
    }
}

/// Returns a random direction. After each draw, the next `cons` updates return the same direction.
fn random_move(step: &mut Step<'_, impl Scheduler>, slot: Slot, cons: i32) -> Direction {
    towards(random_heading(step, slot, cons))
}

/// Draws a direction like [`random_move`], but returns an index into [`Direction::BASE`], or [`NO_HEADING`].
#[inline]
fn random_heading(step: &mut Step<'_, impl Scheduler>, slot: Slot, cons: i32) -> u32 {
    let mut chance = step.world.chance();
    let sprite = step.world.edit_motion(slot);
    if sprite.count < cons {
        sprite.count += 1;
    } else {
        sprite.count = 0;
        sprite.set_heading(chance.below(4) as u32);
    }
    let heading = sprite.heading();
    *step.world.dice() = chance;
    heading
}

/// Returns the last drawn direction.
fn heading(step: &Step<'_, impl Scheduler>, slot: Slot) -> Direction {
    towards(step.world.sprite(slot).heading())
}

fn towards(heading: u32) -> Direction {
    match heading {
        NO_HEADING => Direction::NONE,
        heading => Direction::BASE[heading as usize],
    }
}

/// Draws one of the options, or returns `None` if there are none.
#[inline(always)]
fn drawn(step: &mut Step<'_, impl Scheduler>, options: &[u8]) -> Option<Direction> {
    if options.is_empty() {
        return None;
    }
    let drawn = step.world.dice().below(options.len() as i32) as usize;
    Some(Direction::BASE[usize::from(options[drawn])])
}

/// Chooses the direction of a Chaser (or Fleeing): a step towards (or away from) one of the closest targets.
fn chaser(step: &mut Step<'_, impl Scheduler>, slot: Slot) -> Direction {
    chase_visible(step, slot, |_, _| true)
}

/// Chooses the direction of a LOSChaser, which sees only in the direction that it drew last, even through
/// walls.
fn los_chaser(step: &mut Step<'_, impl Scheduler>, slot: Slot) -> Direction {
    let ahead = heading(step, slot);
    chase_visible(step, slot, |own, target| match ahead {
        Direction::DOWN => own.x == target.x && target.y >= own.y,
        Direction::UP => own.x == target.x && target.y <= own.y,
        Direction::LEFT => own.y == target.y && target.x <= own.x,
        Direction::RIGHT => own.y == target.y && target.x >= own.x,
        _ => false,
    })
}

fn chase_visible(
    step: &mut Step<'_, impl Scheduler>,
    slot: Slot,
    sees: impl Fn(Rect, Rect) -> bool,
) -> Direction {
    let Sprite { rect: own, stype, .. } = *step.world.sprite(slot);
    let traits = &step.rules.types[stype.index()].traits;
    let targets = own_or_related(step, traits.stypes.first().copied().unwrap_or(SpriteType::NONE));
    let visible = targets.rects(step.world).filter(|&target| sees(own, target));
    let near = |distance: f64| traits.max_distance == -1.0 || distance <= traits.max_distance;
    let options = options(traits.continuous, traits.fleeing, own, visible, near);
    drawn(step, &options).unwrap_or_else(|| random_move(step, slot, traits.cons))
}

/// Returns the directions to choose from, given the closest targets, if those are close enough.
#[inline(always)]
fn options(
    continuous: bool,
    flee: bool,
    own: Rect,
    targets: impl Iterator<Item = Rect> + Clone,
    near: impl Fn(f64) -> bool,
) -> Options {
    let mut options = Options::new();
    let nearest = closest(continuous, own, targets.clone()).filter(|nearest| near(nearest.distance));
    let Some(Closest { distance, first, tied }) = nearest else { return options };
    add_options(continuous, flee, own, first, &mut options);
    if tied {
        let all = targets.filter(|&target| physics::distance(continuous, own, target) == distance);
        all.skip(1).for_each(|target| add_options(continuous, flee, own, target, &mut options));
    }
    options
}

/// Adds the directions in which a move by one pixel reduces the distance to the target or, when fleeing, increases it.
fn add_options(continuous: bool, flee: bool, own: Rect, target: Rect, options: &mut Options) {
    let is_near = [own.x, own.y, target.x, target.y].iter().all(|at| at.unsigned_abs() < 1 << 30);
    if !continuous && is_near {
        // With grid physics, the distance shrinks by one if there is a gap in that direction, and otherwise
        // grows by one.
        let (right, below) = (target.x - own.x, target.y - own.y);
        let gaps = [-below, -right, below, right];
        for (direction, gap) in (0..).zip(gaps) {
            if (gap > 0) != flee {
                options.push(direction);
            }
        }
        return;
    }
    let distance = physics::distance(continuous, own, target);
    for (number, direction) in (0..).zip(Direction::BASE) {
        let (x, y) = (own.x.wrapping_add(direction.x as i32), own.y.wrapping_add(direction.y as i32));
        let then = physics::distance(continuous, own.at(x, y), target);
        if if flee { distance < then } else { distance > then } {
            options.push(number);
        }
    }
}

/// A sprite's targets: the sprites of one type, followed by those of other types.
#[derive(Clone, Copy)]
struct Targets<'a> {
    first: Option<SpriteType>,
    others: &'a [SpriteType],
}

impl<'a> Targets<'a> {
    const NONE: Targets<'static> = Targets { first: None, others: &[] };

    fn types(self) -> impl Iterator<Item = SpriteType> + Clone + use<'a> {
        self.first.into_iter().chain(self.others.iter().copied())
    }

    fn slots(self, world: &World) -> impl Iterator<Item = Slot> + Clone {
        self.types().flat_map(|stype| world.slots(stype))
    }

    fn rects(self, world: &World) -> impl Iterator<Item = Rect> + Clone {
        self.slots(world).map(|slot| world.sprite(slot).rect)
    }

    fn count(self, world: &World) -> usize {
        self.types().map(|stype| usize::from(world.group(stype).count)).sum()
    }
}

/// Returns the sprites of exactly this type. If there are none, returns the sprites of related types in the SpriteSet.
fn own_or_related<'a>(step: &mut Step<'a, impl Scheduler>, stype: SpriteType) -> Targets<'a> {
    if stype == SpriteType::NONE {
        step.stop(Limit::NoType);
        return Targets::NONE;
    }
    let targets = targets_of(step.rules, step.world, stype);
    step.work(targets.types().count() + targets.count(step.world));
    targets
}

fn targets_of<'a>(rules: &'a Rules, world: &World, stype: SpriteType) -> Targets<'a> {
    match world.group(stype).head {
        NONE => Targets { first: None, others: &rules.types[stype.index()].tree },
        _ => Targets { first: Some(stype), others: &[] },
    }
}

/// The first of the closest targets, and a flag that is `true` if further targets are equally close.
struct Closest {
    distance: f64,
    first: Rect,
    tied: bool,
}

#[inline(always)]
fn closest(continuous: bool, from: Rect, targets: impl Iterator<Item = Rect>) -> Option<Closest> {
    let mut found: Option<Closest> = None;
    targets.for_each(|rect| {
        let distance = physics::distance(continuous, from, rect);
        match &mut found {
            Some(nearest) if distance > nearest.distance => {}
            Some(nearest) if distance == nearest.distance => nearest.tied = true,
            _ => found = Some(Closest { distance, first: rect, tied: false }),
        }
    });
    found
}

/// Chooses the direction of a PathChaser: the first step of the path to the first of the closest targets.
fn path_chaser(step: &mut Step<'_, impl Scheduler>, slot: Slot) -> Direction {
    let Sprite { rect: own, stype, .. } = *step.world.sprite(slot);
    let traits = &step.rules.types[stype.index()].traits;
    let targets = own_or_related(step, traits.stypes.first().copied().unwrap_or(SpriteType::NONE));
    match closest(traits.continuous, own, targets.rects(step.world)) {
        Some(Closest { first, .. }) => {
            let way = first_step(step, own, (first.x, first.y));
            step.world.edit_motion(slot).count = traits.cons;
            way.unwrap_or(Direction::NONE)
        }
        None => random_move(step, slot, traits.cons),
    }
}

/// Returns the direction that a PathChaser would choose now, or [`Direction::NONE`] if it has no target or no
/// path to it.
pub(crate) fn path_ahead(rules: &Rules, world: &World, sprite: &Sprite) -> Direction {
    let traits = &rules.types[sprite.stype.index()].traits;
    let Some(&stype) = traits.stypes.first().filter(|&&stype| stype != SpriteType::NONE) else {
        return Direction::NONE;
    };
    let own = sprite.rect;
    let targets = targets_of(rules, world, stype).slots(world).map(|slot| world.present(slot).rect);
    let nearest = closest(traits.continuous, own, targets);
    let way =
        nearest.and_then(|nearest| world.first_step((own.x, own.y), (nearest.first.x, nearest.first.y)).0);
    way.unwrap_or(Direction::NONE)
}

/// Returns the first step of the path to a position; `None` if there is no path or no step to take. A game without
/// `obs=` has no paths, so the request stops the episode.
fn first_step(step: &mut Step<'_, impl Scheduler>, from: Rect, to: (i32, i32)) -> Option<Direction> {
    if !step.rules.finds_paths {
        step.stop(Limit::NoPaths);
        return None;
    }
    let (way, looked) = step.world.first_step((from.x, from.y), to);
    step.work(looked);
    way
}

/// Returns the targets for the AlternateChaser family: the type's own sprites, followed by those of its whole
/// tree, which includes the type itself. Sprites of a leaf type therefore appear twice.
fn alternate_targets<'a>(step: &mut Step<'a, impl Scheduler>, slot: Slot) -> Targets<'a> {
    let rules = step.rules;
    let stypes = &rules.types[step.world.sprite(slot).stype.index()].traits.stypes;
    if stypes.contains(&SpriteType::NONE) {
        step.stop(Limit::NoType);
        return Targets::NONE;
    }
    let total: i32 = stypes.iter().map(|&stype| step.world.count(rules, stype)).sum();
    if total == 0 {
        return Targets::NONE;
    }
    // The reference chooses among several types with a separate, unseeded generator.
    let chosen = match stypes.len() {
        1 => stypes[0],
        count => stypes[step.world.second_dice().below(count as i32) as usize],
    };
    let targets = Targets { first: Some(chosen), others: &rules.types[chosen.index()].tree };
    step.work(stypes.len() + targets.count(step.world));
    targets
}

/// Chooses the direction of an AlternateChaser: a step towards one of the closest targets. An AlternateChaser
/// never flees, regardless of its parameters.
fn alternate_chaser(step: &mut Step<'_, impl Scheduler>, slot: Slot) -> Direction {
    let targets = alternate_targets(step, slot);
    let Sprite { rect: own, stype, .. } = *step.world.sprite(slot);
    let continuous = step.rules.types[stype.index()].traits.continuous;
    let options = options(continuous, false, own, targets.rects(step.world), |_| true);
    drawn(step, &options).unwrap_or_else(|| Direction::BASE[step.world.dice().below(4) as usize])
}

/// Chooses the direction of a RandomAltChaser or RandomPathAltChaser, which occasionally takes a random step.
/// The draw that decides this is always made.
fn or_random<S: Scheduler>(
    step: &mut Step<'_, S>,
    slot: Slot,
    otherwise: fn(&mut Step<'_, S>, Slot) -> Direction,
) -> Direction {
    let epsilon = step.rules.types[step.world.sprite(slot).stype.index()].traits.epsilon;
    if step.world.dice().double() < epsilon {
        Direction::BASE[step.world.dice().below(4) as usize]
    } else {
        otherwise(step, slot)
    }
}

/// Chooses the direction of a PathAltChaser, which follows paths to one target until it reaches that target's
/// position.
fn path_alt_chaser(step: &mut Step<'_, impl Scheduler>, slot: Slot) -> Direction {
    let rules = step.rules;
    let own = step.world.sprite(slot).rect;
    let current = match step.world.extra(rules, slot).target {
        Target::None => None,
        Target::Sprite(target) => {
            Some((step.world.extra(rules, slot).target, step.world.sprite(target).rect))
        }
        Target::Gone(rect) => Some((Target::Gone(rect), rect)),
    };
    let chosen = match current {
        Some((target, rect)) if !own.contains(rect) => Some((target, rect)),
        _ => match new_target(step, slot) {
            Ok(chosen) => chosen,
            Err(limit) => {
                step.stop(limit);
                return Direction::NONE;
            }
        },
    };
    let Some((target, rect)) = chosen else {
        return Direction::BASE[step.world.dice().below(4) as usize];
    };
    let mut way = first_step(step, own, (rect.x, rect.y));
    let extra = step.world.extra(rules, slot);
    extra.target = target;
    match (way, extra.last_known) {
        (None, Some(known)) => way = first_step(step, own, known),
        _ => extra.last_known = Some((rect.x, rect.y)),
    }
    way.unwrap_or(Direction::NONE)
}

/// Returns the first of the closest targets, or `None` if there are no targets. With `randomTarget`, returns a random
/// target, or an error if there are no targets.
fn new_target(step: &mut Step<'_, impl Scheduler>, slot: Slot) -> Result<Option<(Target, Rect)>, Limit> {
    let Sprite { rect: own, stype, .. } = *step.world.sprite(slot);
    let traits = &step.rules.types[stype.index()].traits;
    let targets = alternate_targets(step, slot);
    let rect = |world: &World, target: Slot| world.sprite(target).rect;
    let chosen = if traits.random_target {
        let count = targets.count(step.world);
        if count == 0 {
            return Err(Limit::NoSprite);
        }
        let drawn = step.world.dice().below(count as i32) as usize;
        targets.slots(step.world).nth(drawn)
    } else {
        let distance = |target: &Slot| physics::distance(traits.continuous, own, rect(step.world, *target));
        let mut best: Option<(f64, Slot)> = None;
        for target in targets.slots(step.world) {
            let distance = distance(&target);
            if best.is_none_or(|(least, _)| distance < least) {
                best = Some((distance, target));
            }
        }
        best.map(|(_, target)| target)
    };
    Ok(chosen.map(|target| (Target::Sprite(target), rect(step.world, target))))
}
