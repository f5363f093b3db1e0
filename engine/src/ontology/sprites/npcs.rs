//! Characters that move by chance or after others (`spec/02` §7).

use super::NO_HEADING;
use crate::game::SpriteType;
use crate::geometry::{Direction, Rect};
use crate::ontology::physics;
use crate::state::{NONE, Slot};
use crate::step::Step;
use smallvec::SmallVec;

pub(super) fn random_npc(step: &mut Step<'_>, slot: Slot) {
    passive(step, slot);
    let direction = random_move(step, slot);
    let speed = step.state.sprite(slot).speed;
    physics::active(step, slot, direction, speed);
}

/// NPCs replace the base update, but keep its passive movement.
fn passive(step: &mut Step<'_>, slot: Slot) {
    let traits = &step.rules.types[step.state.sprite(slot).stype.index()].traits;
    if !traits.is_static && !traits.only_active {
        physics::passive(step, slot);
    }
}

/// A drawn direction, kept for `cons` more updates.
fn random_move(step: &mut Step<'_>, slot: Slot) -> Direction {
    let cons = step.rules.types[step.state.sprite(slot).stype.index()].traits.cons;
    if step.state.sprite(slot).count < cons {
        step.state.edit(slot).count += 1;
    } else {
        let heading = step.state.chance.below(4) as u16;
        let sprite = step.state.edit(slot);
        (sprite.count, sprite.heading) = (0, heading);
    }
    match step.state.sprite(slot).heading {
        NO_HEADING => Direction::NONE,
        heading => Direction::BASE[usize::from(heading)],
    }
}

/// Chaser and Fleeing: a step that changes the distance to one of the closest targets in the wanted sense.
pub(super) fn chaser(step: &mut Step<'_>, slot: Slot) {
    passive(step, slot);
    let sprite = *step.state.sprite(slot);
    let traits = &step.rules.types[sprite.stype.index()].traits;
    let mut options: SmallVec<[Direction; 8]> = SmallVec::new();
    for target in closest(step, sprite.rect, traits.stypes[0]) {
        let distance = physics::distance(sprite.rect, target);
        if traits.max_distance != -1.0 && distance > traits.max_distance {
            continue;
        }
        for direction in Direction::BASE {
            let shifted = sprite.rect.at(
                sprite.rect.x.wrapping_add(direction.x as i32),
                sprite.rect.y.wrapping_add(direction.y as i32),
            );
            let then = physics::distance(shifted, target);
            if if traits.fleeing { distance < then } else { distance > then } {
                options.push(direction);
            }
        }
    }
    let direction = match options.len() {
        0 => random_move(step, slot),
        count => options[step.state.chance.below(count as i32) as usize],
    };
    physics::active(step, slot, direction, sprite.speed);
}

/// The rectangles of the closest targets: sprites of exactly that type, or of its relatives if there are none.
fn closest(step: &Step<'_>, from: Rect, stype: SpriteType) -> SmallVec<[Rect; 8]> {
    let mut nearest = f64::INFINITY;
    let mut found = SmallVec::new();
    let own = [stype];
    let types: &[SpriteType] = match step.state.group(stype).head {
        NONE => &step.rules.types[stype.index()].tree,
        _ => &own,
    };
    for target in types.iter().flat_map(|&stype| step.state.slots(stype)) {
        let rect = step.state.sprite(target).rect;
        let distance = physics::distance(from, rect);
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
