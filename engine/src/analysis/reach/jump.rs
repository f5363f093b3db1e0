//! Avatars that fall, walk and jump: how high they get above what they stand on.
//!
//! What follows holds as long as nothing but the avatar's own update, and what stops it, changes its velocity; otherwise
//! it is taken to fly. Its velocity is upwards only after a jump. A jump gives it the speed `strength / mass` upwards,
//! whatever it had, and lifts it by 5 pixels at once; gravity takes away `gravity` in each tick; friction and the limit
//! of speed can only take more. A wall beside it can give it back the speed `gravity` once, as it comes to rest. So
//! above the place where it last stood on something solid it rises by at most
//!
//! ```text
//! u + u² / 2g + g + 6 pixels      with u = strength / mass, g = gravity
//! ```
//!
//! How far it gets sideways in the meantime is not limited. And it notices the ground when it falls onto it, but is put
//! back to where it fell from: so it counts as standing as far above something solid as it can fall in a tick.

use super::cells::Cells;
use super::flood::Flood;
use super::meetings::{Meeting, Order, With};
use super::model::Model;
use crate::game::SpriteType;
use crate::ontology::class::SpriteClass;
use crate::ontology::effects::Effect;

/// Rows of cells that one jump of such a sprite can lift it, if it is bound by gravity.
pub(super) fn climb(model: &Model<'_>, stype: SpriteType) -> Option<i32> {
    let info = model.info(stype);
    let (own, traits) = (model.of_type(stype), &info.traits);
    // A wizard's key for blocks lifts it a little, too, whatever it stands on.
    let jumps = info.class == Some(SpriteClass::PlatformerAvatar);
    let sane = traits.gravity > 0.0
        && traits.mass > 0.0
        && traits.jump_strength >= 0.0
        && (0.0..=1.0).contains(&traits.friction)
        && (traits.max_speed == -1.0 || traits.max_speed >= 0.0)
        && !traits.on_ground
        && traits.orientation.y >= 0.0
        && traits.speed >= 0.0;
    let bound = jumps && traits.continuous && sane && !own.boundless && !own.placed && own.leap == 0;
    if !bound || model.meetings.iter().any(|meeting| frees(model, stype, meeting)) {
        return None;
    }
    let lift = traits.jump_strength / traits.mass;
    let pixels = lift + lift * lift / (2.0 * traits.gravity) + traits.gravity + 6.0;
    let rows = (pixels / model.block).ceil();
    (rows < f64::from(model.board.rows)).then_some(rows as i32)
}

/// Whether an effect gives a sprite a velocity, or a place, that is not its own doing.
fn frees(model: &Model<'_>, stype: SpriteType, meeting: &Meeting<'_>) -> bool {
    let effect = meeting.effect(model.rules);
    // A new sprite may take over an orientation.
    if effect.makes().contains(&stype) {
        return true;
    }
    if let Effect::ChangeSpeed { stype: family, .. } = effect {
        return model.info(*family).in_tree(stype);
    }
    let own = meeting.one == Some(stype);
    match effect {
        Effect::TurnAround
        | Effect::ReverseDirection
        | Effect::FlipDirection
        | Effect::WrapAround { .. }
        | Effect::Align { .. }
        | Effect::AttractGaze { .. }
        | Effect::BounceForward
        | Effect::PullWithIt { .. }
        | Effect::TeleportToExit
        | Effect::BounceDirection { .. }
        | Effect::WallBounce
        | Effect::WallReverse
        | Effect::CloneSprite
        | Effect::WaterPhysics => own,
        // Flush with what moves, it is lifted by that.
        Effect::WallStop | Effect::StepBack { pixel_perfect: true } => {
            own && meeting.two().is_some_and(|two| !model.stops_in_order(stype, two))
        }
        _ => own && meeting.with == With::Nobody,
    }
}

impl Flood<'_> {
    /// Cells at which a sprite that has just noticed something solid below it can be.
    pub(super) fn footholds(&self, stype: SpriteType) -> Cells {
        let (board, model) = (self.board, self.model);
        let mut solid = Cells::none(board);
        for stype in model.types().filter(|&stype| model.info(stype).traits.solid) {
            solid.add(&self.regions[stype.index()].touch);
        }
        // It is in two columns if it stands between them.
        let height = model.of_type(stype).stride + model.rules.reach.max(1);
        let near = solid.iter().flat_map(|cell| {
            let (x, y) = board.place(cell);
            (y - height..=y).flat_map(move |y| (x - 1..=x + 1).map(move |x| board.at(x, y)))
        });
        Cells::of(board, near)
    }

    /// Where a sprite that falls and jumps can get to from a cell, when it can still rise by so many rows.
    pub(super) fn leap(&mut self, stype: SpriteType, from: usize, rise: i32) {
        let stride = self.model.of_type(stype).stride;
        let (x, y) = self.board.place(from);
        for dy in -stride..=stride {
            if dy < 0 && rise == 0 {
                continue;
            }
            for dx in -stride..=stride {
                let cell = self.board.at(x + dx, y + dy);
                let rest = match dy {
                    _ if dx.abs().max(dy.abs()) > 1 => None,
                    -1 => Some(rise - 1),
                    0 => Some(rise),
                    _ => Some(0),
                };
                self.rise_to(stype, cell, rest, Order::UPDATE);
            }
        }
    }
}
