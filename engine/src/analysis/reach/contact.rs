//! The effects of makers and collisions on the movement of sprites of a type.

use super::cells::Directions;
use super::meetings::Meeting;
use super::mobility::Mobility;
use super::model::Model;
use crate::game::SpriteType;
use crate::geometry::Direction;
use crate::ontology::class::SpriteClass;
use crate::ontology::effects::{Effect, SpeedChange};

impl Model<'_> {
    /// Applies the effects on speeds.
    pub(super) fn speed_up(&mut self, meeting: &Meeting<'_>) {
        let rules = self.rules;
        match meeting.effect(rules) {
            Effect::ChangeSpeed { stype, value, how } => {
                for stype in &rules.types[stype.index()].tree {
                    let own = &mut self.mobility[stype.index()];
                    own.off_grid |= value.fract() != 0.0;
                    match how {
                        SpeedChange::Set => own.top = own.top.max(value.abs()),
                        SpeedChange::Increase if *value == 0.0 => {}
                        SpeedChange::Decrease if *value >= 0.0 => {}
                        SpeedChange::Increase | SpeedChange::Decrease => own.top = f64::INFINITY,
                    }
                    own.backwards |= *value < 0.0;
                }
            }
            Effect::HalfSpeed => {
                if let Some(one) = meeting.one {
                    self.mobility[one.index()].off_grid = true;
                }
            }
            Effect::WallStop | Effect::WallReverse => {
                // The smallest speed after such a collision is gravity.
                if let Some(one) = meeting.one {
                    let gravity = rules.types[one.index()].traits.gravity.max(0.2);
                    let own = &mut self.mobility[one.index()];
                    own.top = own.top.max(gravity);
                    own.off_grid = true;
                }
            }
            _ => {}
        }
    }

    /// Passes on the orientations that the sprites made by a type get from it.
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
        // Shots at an angle, and those of sprites that stand between cells, stand between cells.
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
        let effect = meeting.effect(self.rules);
        if let Effect::TransformToSingleton { stype, take_orientation: true, .. } = effect {
            self.takes_orientation[stype.index()] = true;
        }
        let forces = matches!(
            effect,
            Effect::BounceForward | Effect::WaterPhysics | Effect::WallBounce | Effect::TurnAround
        );
        if let (Some(one), true) = (meeting.one, forces) {
            self.forced[one.index()] = true;
        }
    }

    pub(super) fn note_push(&mut self, meeting: &Meeting<'_>) {
        let carries = matches!(
            meeting.effect(self.rules),
            Effect::BounceForward | Effect::PullWithIt { .. } | Effect::TurnAround
        );
        if let (Some(one), true) = (meeting.one, carries) {
            let far = 2 * self.stride(self.carried(one, meeting.two().unwrap_or(one))).0;
            let most = &mut self.pushed_far[one.index()];
            *most = far.max(*most);
        }
    }

    /// Applies the effect on orientations, and on the ability to move.
    pub(super) fn meet(&mut self, meeting: &Meeting<'_>) {
        let rules = self.rules;
        let effect = meeting.effect(rules);
        if let Effect::TransformToAll { stype, to, force_orientation, .. } = effect {
            return self.turn(*stype, *to, *force_orientation);
        }
        let Some(one) = meeting.one else { return };
        let at = one.index();
        let two = meeting.two();
        let partner = two.map_or_else(Mobility::default, |two| self.mobility[two.index()]);
        let own = self.mobility[at];
        let mut new = own;
        let face = |new: &mut Mobility, facing: Directions| {
            new.facing = new.facing.with(facing);
            new.straight = false;
        };
        match effect {
            Effect::ReverseDirection => face(&mut new, own.facing.mirrored()),
            Effect::TurnAround => {
                face(&mut new, own.facing.mirrored());
                // The steps down may start with turns.
                if self.info(one).traits.rotate_in_place {
                    face(&mut new, Directions::UP.with(Directions::DOWN));
                }
                new.goes_back = true;
                new.moved = new.moved.with(Directions::DOWN).with(Directions::UP);
                new.placed |= !self.info(one).traits.stationary;
            }
            Effect::FlipDirection => face(&mut new, Directions::FOUR),
            Effect::BounceDirection { .. } => face(&mut new, Directions::ALL),
            Effect::WallStop | Effect::WallBounce | Effect::WallReverse => {
                let more =
                    if own.facing.meets(Directions::ASKEW) { Directions::ALL } else { Directions::UNSET };
                face(&mut new, own.facing.mirrored().with(more));
                new.goes_back = true;
                // Both move back, unless the effect stops only the first one.
                if let Some(two) = two.filter(|_| !matches!(effect, Effect::WallStop)) {
                    self.mobility[two.index()].goes_back = true;
                }
                new.placed |= matches!(effect, Effect::WallStop) && self.is_scaled(one);
            }
            Effect::StepBack { pixel_perfect } => {
                new.goes_back = true;
                let flush = *pixel_perfect && two.is_some();
                new.off_grid |= flush && (!self.is_fixed_now(&partner) || partner.off_grid);
                new.placed |= flush && self.is_scaled(one);
            }
            Effect::Align { orient, .. } => {
                if *orient {
                    face(&mut new, partner.facing);
                }
                (new.placed, new.moved_any_distance) = (true, true);
                new.moved = Directions::ALL;
                new.off_grid |= partner.off_grid;
            }
            Effect::AttractGaze { align, .. } => {
                face(&mut new, partner.facing);
                if *align {
                    (new.placed, new.moved_any_distance) = (true, true);
                    new.moved = Directions::ALL;
                    new.off_grid |= partner.off_grid;
                }
            }
            Effect::BounceForward => {
                let pushed = self.pushed(&partner);
                face(&mut new, pushed.with(Directions::UNSET));
                // Continuous physics treats a push as a force, which the type's own movement accounts for.
                if !self.info(one).traits.stationary && !self.info(one).traits.continuous {
                    new.moved = new.moved.with(pushed);
                    new.off_grid |= partner.off_grid || pushed.meets(Directions::ASKEW);
                    self.carry(one, two, &mut new);
                }
            }
            Effect::PullWithIt { pixel_perfect } => {
                face(&mut new, Directions::UNSET.with(own.facing));
                new.moved = new.moved.with(partner.moved);
                new.off_grid |= partner.off_grid || partner.moved.meets(Directions::ASKEW);
                let onto = *pixel_perfect || self.info(one).traits.off_grid;
                (new.placed, new.moved_any_distance) = (new.placed | onto, new.moved_any_distance | onto);
                self.carry(one, two, &mut new);
            }
            Effect::TeleportToExit => {
                let exits = two.map_or(&[][..], |two| &self.exits[two.index()]);
                for exit in exits.iter().filter(|exit| self.exists[exit.index()]) {
                    let exit = self.mobility[exit.index()];
                    face(&mut new, exit.facing);
                    (new.placed, new.moved_any_distance) = (true, true);
                    new.moved = Directions::ALL;
                    new.off_grid |= exit.off_grid;
                }
            }
            Effect::WrapAround { offset } => {
                (new.placed, new.moved_any_distance) = (true, true);
                new.moved = Directions::ALL;
                new.off_grid |= *offset != 0.0;
            }
            Effect::Spawn { stype, .. } | Effect::SpawnIf { stype, .. } => self.appear(*stype, own.off_grid),
            Effect::SpawnIfCounterSubTypes { stype, otherwise, .. } => {
                self.appear(*stype, own.off_grid);
                self.appear(*otherwise, own.off_grid);
            }
            Effect::SpawnBeside { stype, .. } | Effect::SpawnBehind { stype, .. } => {
                self.appear(*stype, partner.off_grid);
                // Equivalent to moving back: a sprite that it leaves behind is at its old position.
                if let Some(two) = two {
                    self.mobility[two.index()].goes_back = true;
                }
            }
            Effect::TransformTo { stype, force_orientation, .. } => {
                self.turn(one, *stype, *force_orientation);
            }
            Effect::TransformIfCount(rule) => {
                for to in std::iter::once(rule.stype).chain(rule.otherwise) {
                    self.turn(one, to, rule.force_orientation);
                }
            }
            Effect::TransformToRandomChild { options, force_orientation, .. } => {
                options.iter().for_each(|&to| self.turn(one, to, *force_orientation));
            }
            Effect::TransformToSingleton { stype, other, take_orientation } => {
                self.turn(one, *stype, true);
                self.turn(*stype, *other, true);
                if *take_orientation {
                    let next = &mut self.mobility[stype.index()];
                    next.facing = next.facing.with(partner.facing.mirrored());
                }
            }
            _ => {}
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

    /// One type turns into another, which takes over its position, and perhaps its orientation.
    fn turn(&mut self, from: SpriteType, to: SpriteType, force: bool) {
        // A sprite that is transformed again and then moved back returns to its original position.
        self.mobility[from.index()].goes_back |= self.mobility[to.index()].goes_back;
        let old = self.mobility[from.index()];
        let oriented = self.info(from).traits.is_oriented && self.info(to).traits.is_oriented;
        let takes = force || (oriented && self.info(to).traits.orientation == Direction::NONE);
        let new = &mut self.mobility[to.index()];
        new.off_grid |= old.off_grid;
        new.moved = new.moved.with(old.moved);
        if takes {
            new.facing = new.facing.with(old.facing);
        }
        // For a moment its last move is that of the old type, and its orientation that of the new one.
        (new.straight, new.moved_any_distance) = (false, true);
    }

    fn appear(&mut self, stype: SpriteType, off_grid: bool) {
        self.mobility[stype.index()].off_grid |= off_grid;
    }

    /// Accounts for moving with another sprite's speed.
    fn carry(&self, one: SpriteType, two: Option<SpriteType>, new: &mut Mobility) {
        let distance = two.map_or(1.0, |two| self.carried(one, two));
        new.boundless |= self.is_out_of_range(distance);
        if self.info(one).order.is_none() {
            // Its last position is never updated.
            (new.placed, new.moved_any_distance) = (true, true);
            new.moved = Directions::ALL;
        }
    }
}
