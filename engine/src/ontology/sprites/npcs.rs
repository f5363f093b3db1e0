//! Characters that move by chance or after others (`spec/02` §7).

use super::NO_HEADING;
use crate::game::{Limit, SpriteType};
use crate::geometry::{Direction, Rect};
use crate::ontology::physics;
use crate::state::{NONE, Slot, Target};
use crate::step::Step;
use smallvec::SmallVec;

/// Directions to choose among; a direction that several targets ask for is there several times.
type Options = SmallVec<[Direction; 8]>;

pub(super) fn random_npc(step: &mut Step<'_>, slot: Slot) {
    physics::passive(step, slot);
    let cons = step.rules.types[step.state.sprite(slot).stype.index()].traits.cons;
    let direction = random_move(step, slot, cons);
    walk(step, slot, direction);
}

fn walk(step: &mut Step<'_>, slot: Slot, direction: Direction) {
    let speed = step.state.sprite(slot).speed;
    physics::active(step, slot, direction, speed);
}

/// A drawn direction, kept for `cons` more updates.
#[inline]
pub(crate) fn random_move(step: &mut Step<'_>, slot: Slot, cons: i32) -> Direction {
    let mut chance = step.state.chance;
    let sprite = step.state.edit_motion(slot);
    if sprite.count < cons {
        sprite.count += 1;
    } else {
        (sprite.count, sprite.heading) = (0, chance.below(4) as u16);
    }
    let heading = sprite.heading;
    step.state.chance = chance;
    towards(heading)
}

/// The last drawn direction.
fn heading(step: &Step<'_>, slot: Slot) -> Direction {
    towards(step.state.sprite(slot).heading)
}

fn towards(heading: u16) -> Direction {
    match heading {
        NO_HEADING => Direction::NONE,
        heading => Direction::BASE[usize::from(heading)],
    }
}

/// One of the options, or a draw of the sprite's own.
fn drawn(step: &mut Step<'_>, options: &Options) -> Option<Direction> {
    (!options.is_empty()).then(|| options[step.state.chance.below(options.len() as i32) as usize])
}

/// Chaser and Fleeing: a step that changes the distance to one of the closest targets in the wanted sense.
pub(super) fn chaser(step: &mut Step<'_>, slot: Slot) {
    chase_visible(step, slot, |_, _| true);
}

/// LOSChaser: sees only along the direction that it drew last, through walls.
pub(super) fn los_chaser(step: &mut Step<'_>, slot: Slot) {
    let ahead = heading(step, slot);
    chase_visible(step, slot, |own, target| match ahead {
        Direction::DOWN => own.x == target.x && target.y >= own.y,
        Direction::UP => own.x == target.x && target.y <= own.y,
        Direction::LEFT => own.y == target.y && target.x <= own.x,
        Direction::RIGHT => own.y == target.y && target.x >= own.x,
        _ => false,
    });
}

fn chase_visible(step: &mut Step<'_>, slot: Slot, sees: impl Fn(Rect, Rect) -> bool) {
    physics::passive(step, slot);
    let own = *step.state.sprite(slot);
    let traits = &step.rules.types[own.stype.index()].traits;
    let targets = own_or_related(step, traits.stypes.first().copied().unwrap_or(SpriteType::NONE));
    let visible = targets.into_iter().map(|target| step.state.sprite(target).rect);
    let mut options = Options::new();
    for target in closest(traits.continuous, own.rect, visible.filter(|&target| sees(own.rect, target))) {
        let distance = physics::distance(traits.continuous, own.rect, target);
        if traits.max_distance == -1.0 || distance <= traits.max_distance {
            add_options(traits.continuous, traits.fleeing, own.rect, target, &mut options);
        }
    }
    let direction = drawn(step, &options).unwrap_or_else(|| random_move(step, slot, traits.cons));
    walk(step, slot, direction);
}

/// The directions in which one pixel brings nearer to the target, or takes away from it.
fn add_options(continuous: bool, flee: bool, own: Rect, target: Rect, options: &mut Options) {
    let is_near = [own.x, own.y, target.x, target.y].iter().all(|at| at.unsigned_abs() < 1 << 30);
    if !continuous && is_near {
        // On the grid, the distance is one less if there is a gap that way, and one more otherwise.
        let (right, below) = (target.x - own.x, target.y - own.y);
        let gaps = [-below, -right, below, right];
        for (direction, gap) in Direction::BASE.into_iter().zip(gaps) {
            if (gap > 0) != flee {
                options.push(direction);
            }
        }
        return;
    }
    let distance = physics::distance(continuous, own, target);
    for direction in Direction::BASE {
        let (x, y) = (own.x.wrapping_add(direction.x as i32), own.y.wrapping_add(direction.y as i32));
        let then = physics::distance(continuous, own.at(x, y), target);
        if if flee { distance < then } else { distance > then } {
            options.push(direction);
        }
    }
}

/// Sprites of exactly that type, or of its relatives if there are none.
fn own_or_related(step: &mut Step<'_>, stype: SpriteType) -> SmallVec<[Slot; 8]> {
    if stype == SpriteType::NONE {
        step.stop(Limit::NoType);
        return SmallVec::new();
    }
    let own = [stype];
    let types: &[SpriteType] = match step.state.group(stype).head {
        NONE => &step.rules.types[stype.index()].tree,
        _ => &own,
    };
    let targets: SmallVec<[Slot; 8]> = types.iter().flat_map(|&stype| step.state.slots(stype)).collect();
    step.work(types.len() + targets.len());
    targets
}

/// All at the least distance, in order.
fn closest(continuous: bool, from: Rect, targets: impl Iterator<Item = Rect>) -> SmallVec<[Rect; 8]> {
    let mut nearest = f64::INFINITY;
    let mut found = SmallVec::new();
    for rect in targets {
        let distance = physics::distance(continuous, from, rect);
        if distance < nearest {
            nearest = distance;
            found.clear();
        }
        if distance == nearest {
            found.push(rect);
        }
    }
    found
}

/// PathChaser: along the path to the first of the closest targets.
pub(super) fn path_chaser(step: &mut Step<'_>, slot: Slot) {
    physics::passive(step, slot);
    let own = *step.state.sprite(slot);
    let traits = &step.rules.types[own.stype.index()].traits;
    let targets = own_or_related(step, traits.stypes.first().copied().unwrap_or(SpriteType::NONE));
    let rects = targets.into_iter().map(|target| step.state.sprite(target).rect);
    let direction = match closest(traits.continuous, own.rect, rects).first() {
        Some(target) => {
            let way = first_step(step, own.rect, (target.x, target.y));
            step.state.edit_motion(slot).count = traits.cons;
            way.unwrap_or(Direction::NONE)
        }
        None => random_move(step, slot, traits.cons),
    };
    walk(step, slot, direction);
}

/// The first step of the way to a place; a game without `obs=` has no paths, and asking for one is the end of it.
fn first_step(step: &mut Step<'_>, from: Rect, to: (i32, i32)) -> Option<Direction> {
    if !step.rules.finds_paths {
        step.stop(Limit::NoPaths);
        return None;
    }
    let (way, looked) = step.state.first_step((from.x, from.y), to);
    step.work(looked);
    way
}

/// The targets of the AlternateChaser family: sprites of the type, then those of its relatives, itself among them, so
/// that those of a leaf type are there twice.
fn alternate_targets(step: &mut Step<'_>, slot: Slot) -> SmallVec<[Slot; 8]> {
    let rules = step.rules;
    let stypes = &rules.types[step.state.sprite(slot).stype.index()].traits.stypes;
    if stypes.contains(&SpriteType::NONE) {
        step.stop(Limit::NoType);
        return SmallVec::new();
    }
    let total: i32 = stypes.iter().map(|&stype| step.state.count(rules, stype)).sum();
    if total == 0 {
        return SmallVec::new();
    }
    // Among several types the reference chooses with a generator of its own, without a seed.
    let chosen = match stypes.len() {
        1 => stypes[0],
        count => stypes[step.state.jumps.below(count as i32) as usize],
    };
    let related = rules.types[chosen.index()].tree.iter().copied();
    let listed = std::iter::once(chosen).chain(related);
    let targets: SmallVec<[Slot; 8]> = listed.flat_map(|stype| step.state.slots(stype)).collect();
    step.work(stypes.len() + targets.len());
    targets
}

/// AlternateChaser: a step nearer to one of the closest targets; it never flees, whatever its parameters say.
pub(super) fn alternate_chaser(step: &mut Step<'_>, slot: Slot) {
    physics::passive(step, slot);
    let targets = alternate_targets(step, slot);
    approach(step, slot, &targets);
}

fn approach(step: &mut Step<'_>, slot: Slot, targets: &[Slot]) {
    let own = *step.state.sprite(slot);
    let continuous = step.rules.types[own.stype.index()].traits.continuous;
    let rects = targets.iter().map(|&target| step.state.sprite(target).rect);
    let mut options = Options::new();
    for target in closest(continuous, own.rect, rects) {
        add_options(continuous, false, own.rect, target, &mut options);
    }
    let direction =
        drawn(step, &options).unwrap_or_else(|| Direction::BASE[step.state.chance.below(4) as usize]);
    walk(step, slot, direction);
}

/// RandomAltChaser and RandomPathAltChaser: now and then a random step instead; the first draw is made in any case.
pub(super) fn or_random(step: &mut Step<'_>, slot: Slot, otherwise: fn(&mut Step<'_>, Slot)) {
    let epsilon = step.rules.types[step.state.sprite(slot).stype.index()].traits.epsilon;
    if step.state.chance.double() < epsilon {
        physics::passive(step, slot);
        let direction = Direction::BASE[step.state.chance.below(4) as usize];
        walk(step, slot, direction);
    } else {
        otherwise(step, slot);
    }
}

/// PathAltChaser: keeps to one target until it stands on it, along paths.
pub(super) fn path_alt_chaser(step: &mut Step<'_>, slot: Slot) {
    physics::passive(step, slot);
    let rules = step.rules;
    let own = step.state.sprite(slot).rect;
    let current = match step.state.extra(rules, slot).target {
        Target::None => None,
        Target::Sprite(target) => {
            Some((step.state.extra(rules, slot).target, step.state.sprite(target).rect))
        }
        Target::Gone(rect) => Some((Target::Gone(rect), rect)),
    };
    let chosen = match current {
        Some((target, rect)) if !own.contains(rect) => Some((target, rect)),
        _ => match new_target(step, slot) {
            Ok(chosen) => chosen,
            Err(limit) => return step.stop(limit),
        },
    };
    let Some((target, rect)) = chosen else {
        let direction = Direction::BASE[step.state.chance.below(4) as usize];
        return walk(step, slot, direction);
    };
    let mut way = first_step(step, own, (rect.x, rect.y));
    let extra = step.state.extra(rules, slot);
    extra.target = target;
    match (way, extra.last_known) {
        (None, Some(known)) => way = first_step(step, own, known),
        _ => extra.last_known = Some((rect.x, rect.y)),
    }
    walk(step, slot, way.unwrap_or(Direction::NONE));
}

/// The first of the closest targets, or a drawn one.
fn new_target(step: &mut Step<'_>, slot: Slot) -> Result<Option<(Target, Rect)>, Limit> {
    let own = *step.state.sprite(slot);
    let traits = &step.rules.types[own.stype.index()].traits;
    let targets = alternate_targets(step, slot);
    let rect = |step: &Step<'_>, target: Slot| step.state.sprite(target).rect;
    let chosen = if traits.random_target {
        if targets.is_empty() {
            return Err(Limit::NoSprite);
        }
        Some(targets[step.state.chance.below(targets.len() as i32) as usize])
    } else {
        let distance = |target: &Slot| physics::distance(traits.continuous, own.rect, rect(step, *target));
        let mut best: Option<(f64, Slot)> = None;
        for target in &targets {
            let distance = distance(target);
            if best.is_none_or(|(least, _)| distance < least) {
                best = Some((distance, *target));
            }
        }
        best.map(|(_, target)| target)
    };
    Ok(chosen.map(|target| (Target::Sprite(target), rect(step, target))))
}
