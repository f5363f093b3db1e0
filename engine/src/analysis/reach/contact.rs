//! The effects of sprite creation and collisions on the mobility of types.

use super::cells::Directions;
use super::meetings::Meeting;
use super::mobility::Mobility;
use super::model::Model;
use crate::numbers::geometry::Direction;
use crate::rules::SpriteType;
use crate::rules::class::SpriteClass;
use crate::rules::effects::{Displacement, SpeedChange, SpeedEffect, Spot, Turn};

impl Model<'_> {
    /// Applies a collision's effect on speeds.
    pub(super) fn speed_up(&mut self, meeting: &Meeting<'_>) {
        let rules = self.rules;
        match meeting.summary(rules).speed {
            Some(SpeedEffect::OfAll { stype, value, how }) => {
                for stype in &rules.types[stype.index()].tree {
                    let own = &mut self.mobility[stype.index()];
                    own.off_grid |= value.fract() != 0.0;
                    match how {
                        SpeedChange::Set => own.top = own.top.max(value.abs()),
                        SpeedChange::Increase if value == 0.0 => {}
                        SpeedChange::Decrease if value >= 0.0 => {}
                        SpeedChange::Increase | SpeedChange::Decrease => own.top = f64::INFINITY,
                    }
                    own.backwards |= value < 0.0;
                }
            }
            Some(SpeedEffect::Half) => {
                if let Some(one) = meeting.one {
                    self.mobility[one.index()].off_grid = true;
                }
            }
            Some(SpeedEffect::AtLeastGravity) => {
                // After such a collision, the sprite's speed is at least its gravity.
                if let Some(one) = meeting.one {
                    let gravity = rules.types[one.index()].traits.gravity.max(0.2);
                    let own = &mut self.mobility[one.index()];
                    own.top = own.top.max(gravity);
                    own.off_grid = true;
                }
            }
            Some(SpeedEffect::Force) | None => {}
        }
    }

    /// Passes on the orientations that a type's sprites give to the sprites that they create.
    pub(super) fn pass_orientation(&mut self, stype: SpriteType) {
        use SpriteClass as C;
        let info = self.info(stype);
        let Some(class) = info.class else { return };
        let own = self.mobility[stype.index()];
        let any = matches!(class, C::AimedAvatar | C::SpaceshipAvatar | C::WizardAvatar);
        let given = if matches!(class, C::FlakAvatar | C::OngoingTurningAvatar | C::Spreader) {
            Directions::NONE
        } else if class.is_avatar() {
            if any { Directions::ALL } else { own.facing }
        } else if info.traits.spawn_orientation != Direction::NONE {
            Directions::of(info.traits.spawn_orientation)
        } else {
            own.facing
        };
        // Shots fired at an angle, or by sprites between cells, are themselves between cells.
        let off_grid = own.off_grid || any || (class.is_avatar() && own.facing.meets(Directions::ASKEW));
        for (made, _) in self.makes[stype.index()].clone() {
            let traits = &self.info(made).traits;
            let takes = class.is_avatar()
                || info.traits.spawn_orientation != Direction::NONE
                || traits.orientation == Direction::NONE;
            let new = &mut self.mobility[made.index()];
            new.off_grid |= off_grid;
            if takes {
                new.facing = new.facing.with(given);
            }
        }
    }

    pub(super) fn note_forces(&mut self, meeting: &Meeting<'_>) {
        let summary = meeting.summary(self.rules);
        if summary.takes_orientation {
            for to in summary.becomes() {
                self.takes_orientation[to.index()] = true;
            }
        }
        if let (Some(one), Some(SpeedEffect::Force)) = (meeting.one, summary.speed) {
            self.forced[one.index()] = true;
        }
    }

    pub(super) fn note_push(&mut self, meeting: &Meeting<'_>) {
        let carries = matches!(
            meeting.summary(self.rules).displacement,
            Some(Displacement::Pushed | Displacement::Carried { .. } | Displacement::BackAndDown)
        );
        if let (Some(one), true) = (meeting.one, carries) {
            let far = 2 * self.stride(self.carried(one, meeting.two().unwrap_or(one))).0;
            let most = &mut self.pushed_far[one.index()];
            *most = far.max(*most);
        }
    }

    /// Applies a collision's effect on orientation and on the ability to move.
    pub(super) fn meet(&mut self, meeting: &Meeting<'_>) {
        let summary = meeting.summary(self.rules);
        let all = summary.becomes_all();
        let Some(one) = meeting.one else {
            if let Some((from, to)) = all.filter(|_| !summary.needs_partner) {
                self.turn(from, to, summary.forces_orientation);
            }
            return;
        };
        let at = one.index();
        let two = meeting.two();
        let partner = two.map_or_else(Mobility::default, |two| self.mobility[two.index()]);
        let partner_facing = two.map_or_else(Directions::default, |two| self.facing_in_collision(two));
        let own = self.mobility[at];
        let mut new = own;
        if let Some(turn) = summary.turn {
            self.face(one, two, turn, &mut new);
        }
        if let Some(displacement) = summary.displacement {
            self.displace(one, two, displacement, &mut new);
        }
        if let Some(spot) = summary.spot {
            let (off_grid, leaves) = match spot {
                Spot::AtFirst => (own.off_grid, None),
                Spot::Beside { .. } | Spot::Behind => (partner.off_grid, two),
            };
            for stype in summary.spawns() {
                self.mobility[stype.index()].off_grid |= off_grid;
            }
            // The effect is equivalent to moving back: the sprite that it leaves behind is at the partner's old
            // position.
            if let Some(two) = leaves {
                self.mobility[two.index()].goes_back = true;
            }
        }
        for to in summary.becomes() {
            self.turn(one, to, summary.forces_orientation);
            if summary.takes_orientation {
                let next = &mut self.mobility[to.index()];
                next.facing = next.facing.with(partner_facing.mirrored());
            }
        }
        if let Some((from, to)) = all {
            self.turn(from, to, summary.forces_orientation);
        }
        // The changes that `turn` and `appear` made to the type itself remain.
        let now = &mut self.mobility[at];
        now.facing = now.facing.with(new.facing);
        now.moved = now.moved.with(new.moved);
        now.off_grid |= new.off_grid;
        now.placed |= new.placed;
        now.moved_any_distance |= new.moved_any_distance;
        now.boundless |= new.boundless;
        now.straight &= new.straight;
        now.goes_back |= new.goes_back;
    }

    /// Applies a turn to a sprite of type `one`. `two` is the type of the sprite that it collides with, if
    /// any.
    fn face(&self, one: SpriteType, two: Option<SpriteType>, turn: Turn, new: &mut Mobility) {
        let own = self.facing_in_collision(one);
        let partner = two.map_or_else(Mobility::default, |two| *self.of_type(two));
        let facing = match turn {
            Turn::Back => own.mirrored(),
            Turn::AnyOfFour => Directions::FOUR,
            Turn::Any => Directions::ALL,
            Turn::OffWall if own.meets(Directions::ASKEW) => Directions::ALL,
            Turn::OffWall => own.mirrored().with(Directions::UNSET),
            Turn::OfPartner => two.map_or(Directions::NONE, |two| self.facing_in_collision(two)),
            Turn::OfPush => self.pushed(&partner).with(Directions::UNSET),
            Turn::OfRide => Directions::UNSET.with(own),
            Turn::OfExit => {
                let mut exits = self.exits_of(two).peekable();
                if exits.peek().is_none() {
                    return;
                }
                exits.fold(Directions::NONE, |all, exit| all.with(self.facing_in_collision(exit)))
            }
        };
        new.facing = new.facing.with(facing);
        new.straight = false;
    }

    /// Applies a displacement to a sprite of type `one`. `two` is the type of the sprite that it collides
    /// with, if any.
    fn displace(
        &mut self,
        one: SpriteType,
        two: Option<SpriteType>,
        displacement: Displacement,
        new: &mut Mobility,
    ) {
        let partner = two.map_or_else(Mobility::default, |two| *self.of_type(two));
        let traits = &self.info(one).traits;
        let put = |new: &mut Mobility, off_grid: bool| {
            (new.placed, new.moved_any_distance) = (true, true);
            new.moved = Directions::ALL;
            new.off_grid |= off_grid;
        };
        match displacement {
            Displacement::Back => new.goes_back = true,
            Displacement::Flush => {
                new.goes_back = true;
                let flush = two.is_some();
                new.off_grid |= flush && (!self.is_fixed_now(&partner) || partner.off_grid);
                new.placed |= flush && self.is_scaled(one);
            }
            Displacement::Stop => {
                new.goes_back = true;
                new.placed |= self.is_scaled(one);
            }
            Displacement::Apart => {
                new.goes_back = true;
                if let Some(two) = two {
                    self.mobility[two.index()].goes_back = true;
                }
            }
            Displacement::BackAndDown => {
                // The sprite may have to turn before it steps down.
                if traits.rotate_in_place {
                    new.facing = new.facing.with(Directions::UP).with(Directions::DOWN);
                    new.straight = false;
                }
                new.goes_back = true;
                new.moved = new.moved.with(Directions::DOWN).with(Directions::UP);
                new.placed |= !traits.stationary;
                new.boundless |= !traits.stationary && self.is_out_of_range(self.of_type(one).top);
            }
            Displacement::OppositeEdge { offset } => put(new, offset != 0.0),
            Displacement::OntoPartner | Displacement::InLine => put(new, partner.off_grid),
            Displacement::Pushed => {
                let pushed = self.pushed(&partner);
                // Continuous physics treats a push as a force, which the type's own movement accounts for.
                if !traits.stationary && !traits.continuous {
                    new.moved = new.moved.with(pushed);
                    new.off_grid |= partner.off_grid || pushed.meets(Directions::ASKEW);
                    self.carry(one, two, new);
                }
            }
            Displacement::Carried { onto } => {
                new.moved = new.moved.with(partner.moved);
                new.off_grid |= partner.off_grid || partner.moved.meets(Directions::ASKEW);
                let onto = onto || traits.off_grid;
                (new.placed, new.moved_any_distance) = (new.placed | onto, new.moved_any_distance | onto);
                self.carry(one, two, new);
            }
            Displacement::Exit => self.exits_of(two).for_each(|exit| put(new, self.of_type(exit).off_grid)),
        }
    }

    /// Returns the exits to which a type leads.
    fn exits_of(&self, two: Option<SpriteType>) -> impl Iterator<Item = SpriteType> {
        let exits = two.map_or(&[][..], |two| &self.exits[two.index()]);
        exits.iter().copied().filter(|exit| self.exists[exit.index()])
    }

    /// Turns one type into another, which inherits its position and optionally its orientation.
    fn turn(&mut self, from: SpriteType, to: SpriteType, force: bool) {
        // A sprite that is transformed a second time and then moved back returns to its original position.
        self.mobility[from.index()].goes_back |= self.mobility[to.index()].goes_back;
        let (old, old_facing) = (self.mobility[from.index()], self.facing_in_collision(from));
        let oriented = self.info(from).traits.is_oriented && self.info(to).traits.is_oriented;
        let takes = force || (oriented && self.info(to).traits.orientation == Direction::NONE);
        let new = &mut self.mobility[to.index()];
        new.off_grid |= old.off_grid;
        new.moved = new.moved.with(old.moved);
        if takes {
            new.facing = new.facing.with(old_facing);
        }
        // For a moment, the sprite combines the last move of the old type with the orientation of the new
        // type.
        (new.straight, new.moved_any_distance) = (false, true);
    }

    /// Applies the effect of a sprite being carried at another sprite's speed.
    fn carry(&self, one: SpriteType, two: Option<SpriteType>, new: &mut Mobility) {
        let distance = two.map_or(1.0, |two| self.carried(one, two));
        new.boundless |= self.is_out_of_range(distance);
        if self.info(one).order.is_none() {
            // The last position of a carried sprite is never updated.
            (new.placed, new.moved_any_distance) = (true, true);
            new.moved = Directions::ALL;
        }
    }
}
