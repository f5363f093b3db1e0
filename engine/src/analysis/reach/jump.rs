//! The maximum height above the ground that a walking and jumping avatar with gravity can reach.
//!
//! The following bound holds as long as nothing changes the avatar's velocity except its own update and the
//! sprites that stop it. If anything else can change it, the avatar is assumed to fly.
//!
//! The avatar moves upwards only after a jump. A jump sets the upward speed to `strength / mass`, whatever
//! the speed was before, and lifts the avatar by 5 pixels at once. Gravity subtracts `gravity` in each tick.
//! Friction and the speed limit can only reduce the speed further. A wall beside the avatar can restore a
//! speed of `gravity` once, when the avatar comes to rest.
//!
//! The avatar therefore rises above the position where it last stood on something solid by at most
//!
//! ```text
//! u + u² / 2g + g + 6 pixels      with u = strength / mass, g = gravity
//! ```
//!
//! The sideways distance travelled in the meantime is unlimited.
//!
//! The avatar detects the ground when it falls onto it, but then moves back to the position from which it
//! fell. It therefore counts as standing on the ground wherever it can fall onto something solid within one
//! tick.

use super::cells::Cells;
use super::flood::Flood;
use super::meetings::{Meeting, Order, With};
use super::model::Model;
use crate::rules::SpriteType;
use crate::rules::class::SpriteClass;
use crate::rules::effects::{Displacement, EffectSummary, SpeedEffect};

/// Returns the maximum number of rows by which a jump lifts a sprite of the type, or `None` if gravity does
/// not limit the jump.
pub(super) fn climb(model: &Model<'_>, stype: SpriteType) -> Option<i32> {
    let info = model.info(stype);
    let (own, traits) = (model.of_type(stype), &info.traits);
    // The key with which a wizard creates blocks also lifts the wizard a little, even in the air.
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
    if !bound || model.meetings.iter().any(|meeting| breaks_gravity_bound(model, stype, meeting)) {
        return None;
    }
    let lift = traits.jump_strength / traits.mass;
    let pixels = lift + lift * lift / (2.0 * traits.gravity) + traits.gravity + 6.0;
    let rows = (pixels / model.block).ceil();
    (rows < f64::from(model.board.rows)).then_some(rows as i32)
}

/// Returns `true` if an effect changes a sprite's velocity or position in a way that the sprite's own update
/// would not.
fn breaks_gravity_bound(model: &Model<'_>, stype: SpriteType, meeting: &Meeting<'_>) -> bool {
    let summary = meeting.summary(model.rules);
    // A new sprite may inherit an orientation.
    if summary.makes().contains(&stype) {
        return true;
    }
    if let Some(SpeedEffect::OfAll { stype: family, .. }) = summary.speed {
        return model.info(family).in_tree(stype);
    }
    let own = meeting.one == Some(stype);
    match summary.displacement {
        // A moving sprite lifts a sprite that is placed flush with it.
        Some(Displacement::Flush | Displacement::Stop) => {
            own && meeting.two().is_some_and(|two| !model.stops_in_order(stype, two))
        }
        Some(
            Displacement::Apart
            | Displacement::BackAndDown
            | Displacement::OppositeEdge { .. }
            | Displacement::OntoPartner
            | Displacement::InLine
            | Displacement::Pushed
            | Displacement::Carried { .. }
            | Displacement::Exit,
        ) => own,
        Some(Displacement::Back) | None => {
            let forced = summary.turn.is_some() || summary.speed == Some(SpeedEffect::Force);
            let cloned = summary.effects.contains(&EffectSummary::Clone);
            own && (forced || cloned || meeting.with == With::NoPartner)
        }
    }
}

impl Flood<'_> {
    /// Returns the possible cells of a sprite that has just detected something solid below it.
    pub(super) fn footholds(&self, stype: SpriteType) -> Cells {
        let (board, model) = (self.board, self.model);
        let mut solid = Cells::none(board);
        for stype in model.types().filter(|&stype| model.info(stype).traits.solid) {
            solid.add(&self.regions[stype.index()].touch);
        }
        // A sprite that stands between two columns occupies both.
        let height = model.of_type(stype).stride + model.rules.reach.max(1);
        let near = solid.iter().flat_map(|cell| {
            let (x, y) = board.place(cell);
            (y - height..=y).flat_map(move |y| (x - 1..=x + 1).map(move |x| board.at(x, y)))
        });
        Cells::of(board, near)
    }

    /// Adds the cells that a falling and jumping sprite can reach from a cell if it can rise by another
    /// `rise` rows.
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
