//! Effects that kill (`spec/03` §7.1, §8.1).

use crate::game::SpriteType;
use crate::geometry::Direction;
use crate::state::Slot;
use crate::step::Step;

/// Kills if `hit`; the score applies only then.
pub(super) fn when(step: &mut Step<'_>, index: u16, one: Slot, hit: bool) {
    step.apply_score(index, hit);
    if hit {
        step.kill(one);
    }
}

/// Every sprite of exactly that type.
pub(super) fn all(step: &mut Step<'_>, stype: SpriteType) {
    let mut slot = step.state.group(stype).head;
    while slot != crate::state::NONE {
        step.kill(slot);
        slot = step.state.sprite(slot).next;
    }
}

pub(super) fn if_from_above(step: &mut Step<'_>, index: u16, one: Slot, two: Slot) {
    let (first, second) = (step.state.sprite(one), step.state.sprite(two));
    let above = first.last.y > second.last.y + second.rect.h / 2;
    let falling = second.rect.y > second.last.y;
    when(step, index, one, above && falling);
}

/// killIfFrontal and killIfNotFrontal: a sprite that stands still dies under both.
pub(super) fn if_frontal(step: &mut Step<'_>, index: u16, one: Slot, two: Slot, frontal: bool) {
    let (u, v) = (step.last_direction(one).normalised(), step.last_direction(two).normalised());
    let still = u == Direction::NONE;
    let head_on = u.x + v.x == 0.0 && u.y + v.y == 0.0;
    when(step, index, one, still || head_on == frontal);
}
