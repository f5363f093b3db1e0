//! Mobility: how the sprites of each type can move.

use super::cells::Directions;
use super::meetings::{Meeting, With};
use super::model::Model;
use crate::numbers::geometry::Direction;
use crate::rules::SpriteType;
use crate::rules::class::{ClassFamily, SpriteClass};
use crate::rules::effects::{EffectSummary, Summary};

/// The maximum speed off the grid axes, in cells per tick. A faster sprite is assumed to reach any cell.
const MAX_STRIDE: f64 = 4.0;

/// The mobility of a type's sprites: how they move and are moved.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Mobility {
    /// The directions in which a sprite's own update can move it.
    pub(super) directions: Directions,
    /// The orientations that a sprite can have.
    pub(super) facing: Directions,
    /// The directions in which a sprite can have moved since its last update, for any reason.
    pub(super) moved: Directions,
    /// The maximum speed that a sprite can have, in the units of its physics.
    pub(super) top: f64,
    /// `true` if the speed can be negative.
    pub(super) backwards: bool,
    /// The maximum number of cells by which a sprite's own update can move it, rounded up.
    pub(super) stride: i32,
    /// The maximum number of consecutive barred cells that a sprite's own update can skip.
    pub(super) leap: i32,
    /// `true` if sprites may reach any cell that is not barred.
    pub(super) boundless: bool,
    /// `true` if sprites may stand between cells, or be larger or smaller than a cell.
    pub(super) off_grid: bool,
    /// `true` if nothing ever moves sprites of the type.
    pub(super) fixed: bool,
    /// `true` if some effect moves sprites directly to a position, so that another effect may move them again
    /// in the same tick.
    pub(super) placed: bool,
    /// `true` if some effect can move sprites an arbitrary distance.
    pub(super) moved_any_distance: bool,
    /// `true` if sprites do not move in their first update.
    pub(super) waits: bool,
    /// `true` if sprites always face the direction of their last move.
    pub(super) straight: bool,
    /// `true` if sprites always move in the direction that they face.
    pub(super) goes_ahead: bool,
    /// `true` if the player can turn the sprite at will.
    pub(super) turns: bool,
    /// `true` if something can move a sprite, or the sprites that it leaves behind, to its previous position.
    pub(super) goes_back: bool,
}

impl Mobility {
    /// Returns `true` if a sprite can skip cells in a tick, so that it is not necessarily stopped by the
    /// first sprite in its path.
    pub(super) fn comes_from_far(&self) -> bool {
        self.leap > 0 || self.placed || self.boundless
    }

    /// Returns `true` if sprites move in the direction that they face, along the grid, until something turns them.
    pub(super) fn is_steady(&self) -> bool {
        self.goes_ahead && !self.turns && !self.boundless && !self.directions.meets(Directions::ASKEW)
    }
}

impl Model<'_> {
    /// Returns a type's mobility, disregarding the influence of other types.
    pub(super) fn alone(&self, stype: SpriteType) -> Mobility {
        use ClassFamily as Family;
        use SpriteClass as C;
        let info = self.info(stype);
        let traits = &info.traits;
        let Some(class) = info.class else { return Mobility::default() };
        let own = self.born(stype);
        let facing = match (class, class.family()) {
            // These classes turn by angles, or lose a component of their orientation when they jump.
            (C::AimedAvatar | C::BirdAvatar | C::PlatformerAvatar | C::WizardAvatar, _) => Directions::ALL,
            (_, Family::Walker) => Directions::ALL,
            (C::OngoingAvatar | C::OngoingShootAvatar | C::OngoingTurningAvatar, _) => {
                own.with(Directions::FOUR)
            }
            (_, Family::Thing | Family::Resource | Family::Flicker | Family::Missile) => own,
            (_, Family::Npc | Family::Producer | Family::Avatar) => own,
        };
        let walks = class.is_a(C::RandomNPC) || class.is_a(C::Walker) || class == C::RandomBomber;
        let active = class.is_avatar() || walks;
        Mobility {
            facing,
            moved: Directions::UNSET,
            top: traits.speed.abs().max(if class.is_a(C::Walker) { traits.max_speed.abs() } else { 0.0 }),
            backwards: traits.speed < 0.0,
            off_grid: self.is_scaled(stype) || traits.speed.fract() != 0.0,
            waits: !active && traits.is_first_tick,
            // Passive movement follows the sprite's orientation, and some avatars face the direction of their last
            // move.
            straight: !traits.continuous && (!active || faces(class) || is_driven(class)),
            goes_ahead: !traits.continuous && (!active || is_driven(class)),
            // The avatar leaves a sprite at its previous position.
            goes_back: class == C::OngoingTurningAvatar,
            turns: is_driven(class) && class != C::MissileAvatar,
            ..Mobility::default()
        }
    }

    /// Returns the possible directions of a new sprite of the type, unless something else determines them.
    pub(super) fn born(&self, stype: SpriteType) -> Directions {
        if self.draws(stype) { Directions::FOUR } else { Directions::of(self.info(stype).traits.orientation) }
    }

    /// Returns `true` if sprites of the type draw their direction in their first update. Until then, their
    /// orientation is [`Direction::NIL`], which is diagonal.
    fn draws(&self, stype: SpriteType) -> bool {
        let info = self.info(stype);
        info.class == Some(SpriteClass::RandomMissile) && info.traits.orientation == Direction::NIL
    }

    /// Returns the orientations that a sprite of the type can have when it collides, possibly before its first
    /// update.
    pub(super) fn facing_in_collision(&self, stype: SpriteType) -> Directions {
        let facing = self.of_type(stype).facing;
        // The sprites that a level places are updated before their first collision.
        let draws_later = self.draws(stype) && self.made[stype.index()];
        if draws_later { facing.with(Directions::ASKEW) } else { facing }
    }

    /// Computes how far and in which directions a type's own update moves its sprites.
    pub(super) fn move_by_itself(&mut self, stype: SpriteType) {
        use ClassFamily as Family;
        use SpriteClass as C;
        let info = self.info(stype);
        let traits = &info.traits;
        let Some(class) = info.class else { return };
        let mut own = self.mobility[stype.index()];
        let oriented = traits.is_oriented || self.takes_orientation[stype.index()];
        let drifts = !traits.is_static && !traits.only_active;
        let always = class == C::RandomMissile || is_driven(class);
        let walker = class.is_a(C::Walker);
        let passive = if class.is_avatar() { always || traits.off_grid } else { always || drifts };
        let passive = passive && (class.is_avatar() || !info.is_idle());
        let steered = match (class, class.family()) {
            (C::HorizontalAvatar | C::FlakAvatar, _) => Directions::LEFT.with(Directions::RIGHT),
            (C::VerticalAvatar, _) => Directions::UP.with(Directions::DOWN),
            (C::NullAvatar | C::ShootOnlyAvatar, _) => Directions::NONE,
            (C::AimedAvatar | C::SpaceshipAvatar | C::CarAvatar | C::LanderAvatar, _) => Directions::ANY,
            (C::BirdAvatar | C::PlatformerAvatar | C::WizardAvatar, _) => Directions::ANY,
            _ if always => Directions::NONE,
            (C::RandomBomber, _) | (_, Family::Avatar | Family::Npc) => Directions::FOUR,
            (_, Family::Walker) => Directions::ANY,
            (_, Family::Thing | Family::Resource | Family::Flicker) => Directions::NONE,
            (_, Family::Missile | Family::Producer) => Directions::NONE,
        };
        // Sprites of parent types are never updated, but the player's avatar always is.
        let updated = info.order.is_some() || class.is_avatar();
        let (passive, steered) = (passive && updated, if updated { steered } else { Directions::NONE });
        let accelerates = traits.continuous && (steered != Directions::NONE || self.forced[stype.index()]);
        let walks = steered != Directions::NONE && !traits.stationary;
        let mut directions = Directions::NONE;
        if traits.continuous {
            if accelerates {
                own.facing = Directions::ALL;
                let limit = traits.max_speed.abs();
                own.top = if traits.max_speed == -1.0 { f64::INFINITY } else { own.top.max(limit) };
            }
            if passive || steered != Directions::NONE {
                // Friction above 1 reverses a movement, and friction above 2 makes it faster in every tick.
                let reverses = !(0.0..=1.0).contains(&traits.friction);
                directions = if accelerates || reverses { Directions::ANY } else { own.facing };
                if !(0.0..=2.0).contains(&traits.friction) {
                    own.top = f64::INFINITY;
                }
            }
            own.off_grid |= directions != Directions::NONE;
        } else {
            if passive && oriented {
                directions = directions.with(own.facing);
            }
            if walks {
                directions = directions.with(steered);
                if traits.rotate_in_place {
                    own.facing = own.facing.with(steered);
                }
                own.facing = if faces(class) { own.facing.with(steered) } else { own.facing };
                // In active movement, a speed of 0 means 1. A car has a fixed speed.
                own.top = own.top.max(if class == C::CarAvatar { 5.0 } else { 1.0 });
            }
        }
        // A passive speed of −1 means 1.
        if own.backwards {
            directions = directions.with(directions.mirrored());
        }
        directions = directions.without(Directions::UNSET);
        own.off_grid |= directions.meets(Directions::ASKEW);
        // With grid physics, these classes treat forces as directions of any length.
        let jumps = matches!(class, C::BirdAvatar | C::PlatformerAvatar | C::WizardAvatar) || walker;
        let leaps = jumps && !traits.continuous && walks;
        let hop = if jumps { 5.0 / self.block } else { 0.0 };
        let distance = if traits.continuous { own.top / self.block + hop } else { own.top };
        if own.top == 0.0 && !walks {
            directions = Directions::NONE;
        }
        own.directions = directions;
        own.moved = own.moved.with(directions);
        if directions == Directions::NONE {
            self.mobility[stype.index()] = own;
            return;
        }
        let (stride, leap) = self.stride(distance);
        let own = &mut own;
        (own.stride, own.leap) = (stride, leap);
        let askew = directions.meets(Directions::ASKEW) && distance > MAX_STRIDE;
        own.boundless |= leaps || askew || self.is_out_of_range(distance);
        self.mobility[stype.index()] = *own;
    }
}

/// Returns `true` if a push goes in the direction of the pusher's move, so that the pusher must face that
/// direction.
pub(super) fn pushes_straight(pusher: &Mobility) -> bool {
    !pusher.placed && (pusher.facing == Directions::UNSET || pusher.straight)
}

/// Returns `true` for avatars that face the direction of their last move.
fn faces(class: SpriteClass) -> bool {
    use SpriteClass as C;
    matches!(class, C::OrientedAvatar | C::ShootAvatar | C::AimedAvatar | C::BirdAvatar)
}

/// Returns `true` for avatars that always move ahead.
fn is_driven(class: SpriteClass) -> bool {
    use SpriteClass as C;
    matches!(class, C::MissileAvatar | C::OngoingAvatar | C::OngoingShootAvatar | C::OngoingTurningAvatar)
}

/// Returns `true` if an effect, at the edge or with a partner, stops every sprite of the type, regardless of
/// the sprite's resources.
pub(super) fn is_stop(meeting: &Meeting<'_>, summary: &Summary) -> bool {
    let stops = |effect: &EffectSummary| matches!(effect, EffectSummary::Stop | EffectSummary::Undo(_));
    let runs = meeting.with != With::Edge || !summary.needs_partner;
    meeting.with != With::NoPartner && runs && summary.effects.iter().any(stops)
}
