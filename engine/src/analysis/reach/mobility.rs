//! How sprites of each type move, by themselves and by what others do to them: a fixed point over the rules, before any
//! level is looked at cell by cell.

use super::super::prospect::Prospect;
use super::cells::{Board, Ways};
use super::meetings::{Meeting, With};
use crate::game::{Rules, SpriteType, TypeInfo};
use crate::geometry::Direction;
use crate::ontology::class::SpriteClass;
use crate::ontology::effects::{Effect, SpeedChange};
use crate::ontology::sprites::is_idle;

/// Cells that something may cross in a tick, off the grid's axes, before it is taken to be able to be anywhere.
const MAX_STRIDE: f64 = 4.0;
/// Rounds of the fixed point at most; usual games take four.
const MAX_ROUNDS: usize = 48;

/// How sprites of a type move.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Mobility {
    /// The directions into which its own update can move it.
    pub(super) ways: Ways,
    /// The orientations that it can have.
    pub(super) facing: Ways,
    /// The directions in which it can have moved since its last update, by whatever.
    pub(super) moved: Ways,
    /// The largest speed that it can have, in the units of its physics.
    pub(super) top: f64,
    /// Its speed can be negative.
    pub(super) backwards: bool,
    /// How many cells its own update can carry it, rounded up.
    pub(super) stride: i32,
    /// How many barred cells in a row its own update can skip.
    pub(super) leap: i32,
    /// It may get anywhere that is not barred.
    pub(super) boundless: bool,
    /// It may stand between cells, or be larger or smaller than one.
    pub(super) loose: bool,
    /// Nothing ever moves it.
    pub(super) fixed: bool,
    /// Some effect puts it somewhere without a move, so that it may be moved again in the same tick.
    pub(super) placed: bool,
    /// It does not move in its first update.
    pub(super) waits: bool,
    /// It faces where it has moved, always.
    pub(super) straight: bool,
    /// It moves where it faces, always.
    pub(super) goes_ahead: bool,
    /// It turns as its player likes.
    turns: bool,
    /// Some effect can put it back to where it was.
    pub(super) goes_back: bool,
}

impl Mobility {
    /// Whether it can skip cells in a tick, so that what it is stopped by need not be the first thing on its way.
    pub(super) fn comes_from_far(&self) -> bool {
        self.leap > 0 || self.placed || self.boundless
    }

    /// Whether it moves where it faces, along the grid, until something turns it.
    pub(super) fn is_steady(&self) -> bool {
        self.goes_ahead && !self.turns && !self.boundless && !self.ways.meets(Ways::ASKEW)
    }
}

/// What is derived about all types.
pub(super) struct Model<'a> {
    pub(super) rules: &'a Rules,
    pub(super) board: Board,
    pub(super) block: f64,
    pub(super) there: &'a [bool],
    /// By type: such sprites can appear in play.
    made: &'a [bool],
    pub(super) meetings: &'a [Meeting],
    /// By type: what it makes by itself.
    pub(super) makes: Vec<Vec<SpriteType>>,
    pub(super) mobility: Vec<Mobility>,
    /// The smallest sprite, in cells.
    smallest: f64,
    /// By type: something accelerates it, apart from itself.
    forced: Vec<bool>,
    /// By type: some effect gives it an orientation even if its class has none.
    takes_orientation: Vec<bool>,
}

impl<'a> Model<'a> {
    /// None if the sizes of sprites are out of all proportion.
    pub(super) fn of(
        rules: &'a Rules,
        prospect: &'a Prospect<'_>,
        meetings: &'a [Meeting],
        board: Board,
        block: i32,
    ) -> Option<Model<'a>> {
        let block = f64::from(block);
        let present = || rules.types.iter().zip(&prospect.there).filter(|(_, there)| **there);
        let factors =
            || present().flat_map(|(info, _)| [info.traits.width_factor, info.traits.height_factor]);
        // Pixels are whole: a sprite may be a little smaller than its factor says.
        let smallest = factors().map(|factor| (factor * block).floor() / block).fold(1.0, f64::min);
        if !factors().all(|factor| factor * block >= 1.0 && factor <= 64.0) {
            return None;
        }
        let mut makes: Vec<Vec<SpriteType>> =
            (0..rules.types.len()).map(|at| prospect.makes(at).to_vec()).collect();
        for meeting in meetings {
            let Effect::UpdateSpawnType { stype, spawn_point } = meeting.effect(rules) else { continue };
            for family in &rules.types[spawn_point.index()].tree {
                let spawns = |class: SpriteClass| class.is_a(SpriteClass::SpawnPoint);
                let list = &mut makes[family.index()];
                if rules.types[family.index()].class.is_some_and(spawns) && !list.contains(stype) {
                    list.push(*stype);
                }
            }
        }
        let none = vec![false; rules.types.len()];
        let mut model = Model {
            rules,
            board,
            block,
            there: &prospect.there,
            made: &prospect.made,
            meetings,
            makes,
            mobility: vec![Mobility::default(); rules.types.len()],
            smallest,
            forced: none.clone(),
            takes_orientation: none,
        };
        model.settle().then_some(model)
    }

    pub(super) fn info(&self, stype: SpriteType) -> &'a TypeInfo {
        &self.rules.types[stype.index()]
    }

    pub(super) fn of_type(&self, stype: SpriteType) -> &Mobility {
        &self.mobility[stype.index()]
    }

    pub(super) fn types(&self) -> impl Iterator<Item = SpriteType> + use<'a> {
        let there = self.there;
        (0..there.len()).filter(|&at| there[at]).map(|at| SpriteType(at as u16))
    }

    /// How many cells around a cell that two sprites share the rest of one of them can lie.
    pub(super) fn spread(&self, stype: SpriteType) -> i32 {
        if self.of_type(stype).loose { self.rules.reach.max(1) } else { 0 }
    }

    /// Whether the fixed point was found in time.
    fn settle(&mut self) -> bool {
        let types: Vec<SpriteType> = self.types().collect();
        for &stype in &types {
            self.mobility[stype.index()] = self.alone(stype);
            self.forced[stype.index()] = self.info(stype).traits.gravity > 0.0;
        }
        for meeting in self.meetings {
            self.speed_up(meeting);
            self.note_forces(meeting);
        }
        let mut settled = false;
        for _ in 0..MAX_ROUNDS {
            let before: Vec<(Ways, Ways, bool, bool)> = self.states().collect();
            for &stype in &types {
                self.hand_on(stype);
                self.move_by_itself(stype);
            }
            for meeting in self.meetings {
                self.meet(meeting);
            }
            settled = self.states().eq(before);
            if settled {
                break;
            }
        }
        for &stype in &types {
            let mobility = &mut self.mobility[stype.index()];
            mobility.fixed = !mobility.boundless
                && !mobility.placed
                && mobility.moved.without(Ways::UNSET) == Ways::NONE
                && mobility.ways == Ways::NONE;
        }
        settled
    }

    fn states(&self) -> impl Iterator<Item = (Ways, Ways, bool, bool)> + use<'_> {
        self.mobility.iter().map(|own| (own.facing, own.moved, own.loose, own.placed))
    }

    /// What a type is without others.
    fn alone(&self, stype: SpriteType) -> Mobility {
        use SpriteClass as C;
        let info = self.info(stype);
        let traits = &info.traits;
        let Some(class) = info.class else { return Mobility::default() };
        let own = self.born(stype);
        let facing = match class {
            // They turn by angles, or lose a part of their orientation when they jump.
            C::AimedAvatar | C::BirdAvatar | C::PlatformerAvatar | C::WizardAvatar => Ways::ALL,
            C::Walker | C::WalkerJumper => Ways::ALL,
            C::OngoingAvatar | C::OngoingShootAvatar | C::OngoingTurningAvatar => own.with(Ways::FOUR),
            _ => own,
        };
        let walks = class.is_a(C::RandomNPC) || class.is_a(C::Walker) || class == C::RandomBomber;
        let active = class.is_avatar() || walks;
        Mobility {
            facing,
            moved: Ways::UNSET,
            top: traits.speed.abs().max(if class.is_a(C::Walker) { traits.max_speed.abs() } else { 0.0 }),
            backwards: traits.speed < 0.0,
            loose: self.is_odd(stype) || traits.speed.fract() != 0.0,
            waits: !active,
            // Passive movement goes where the sprite faces, and some avatars face where they went.
            straight: !traits.continuous && (!active || faces(class) || is_driven(class)),
            goes_ahead: !traits.continuous && (!active || is_driven(class)),
            turns: is_driven(class) && class != C::MissileAvatar,
            ..Mobility::default()
        }
    }

    /// The directions that a new sprite of the type can have, if nothing gives it another.
    pub(super) fn born(&self, stype: SpriteType) -> Ways {
        let info = self.info(stype);
        let draws =
            info.class == Some(SpriteClass::RandomMissile) && info.traits.orientation == Direction::NIL;
        if draws { Ways::FOUR } else { Ways::of(info.traits.orientation) }
    }

    /// What effects do to speeds.
    fn speed_up(&mut self, meeting: &Meeting) {
        let rules = self.rules;
        match meeting.effect(rules) {
            Effect::ChangeSpeed { stype, value, how } => {
                for stype in &rules.types[stype.index()].tree {
                    let own = &mut self.mobility[stype.index()];
                    own.loose |= value.fract() != 0.0;
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
                    self.mobility[one.index()].loose = true;
                }
            }
            Effect::WallStop | Effect::WallReverse => {
                // The least speed after such a collision is gravity.
                if let Some(one) = meeting.one {
                    let gravity = rules.types[one.index()].traits.gravity.max(0.2);
                    let own = &mut self.mobility[one.index()];
                    own.top = own.top.max(gravity);
                    own.loose = true;
                }
            }
            _ => {}
        }
    }

    /// The orientations that what a type makes gets from it.
    fn hand_on(&mut self, stype: SpriteType) {
        use SpriteClass as C;
        let info = self.info(stype);
        let Some(class) = info.class else { return };
        let own = self.mobility[stype.index()];
        let any = matches!(class, C::AimedAvatar | C::SpaceshipAvatar | C::WizardAvatar);
        let given = if matches!(class, C::FlakAvatar | C::OngoingTurningAvatar | C::Spreader) {
            Ways::NONE
        } else if class.is_avatar() {
            if any { Ways::ALL } else { own.facing }
        } else if info.traits.spawn_orientation != Direction::NONE {
            Ways::of(info.traits.spawn_orientation)
        } else {
            own.facing
        };
        // Shots at an angle, and those of what stands between cells, stand between cells.
        let loose = own.loose || any || (class.is_avatar() && own.facing.meets(Ways::ASKEW));
        for made in self.makes[stype.index()].clone() {
            let traits = &self.info(made).traits;
            let takes = class.is_avatar()
                || info.traits.spawn_orientation != Direction::NONE
                || traits.orientation == Direction::NONE;
            let new = &mut self.mobility[made.index()];
            new.loose |= loose;
            if takes {
                new.facing = new.facing.with(given);
            }
        }
    }

    /// Into which directions, and how far, a type's own update moves its sprites.
    fn move_by_itself(&mut self, stype: SpriteType) {
        use SpriteClass as C;
        let info = self.info(stype);
        let traits = &info.traits;
        let Some(class) = info.class else { return };
        let mut own = self.mobility[stype.index()];
        let oriented = traits.is_oriented || self.takes_orientation[stype.index()];
        let drifts = !traits.is_static && !traits.only_active;
        let always = class == C::RandomMissile || is_driven(class);
        let walker = class.is_a(C::Walker);
        let passive = if class.is_avatar() { always || traits.continuous } else { always || drifts };
        let passive = passive && !(is_idle(class, traits) && !class.is_avatar());
        let steered = match class {
            C::HorizontalAvatar | C::FlakAvatar => Ways::LEFT.with(Ways::RIGHT),
            C::VerticalAvatar => Ways::UP.with(Ways::DOWN),
            C::NullAvatar | C::ShootOnlyAvatar => Ways::NONE,
            C::AimedAvatar | C::SpaceshipAvatar | C::CarAvatar | C::LanderAvatar => Ways::ANY,
            C::BirdAvatar | C::PlatformerAvatar | C::WizardAvatar => Ways::ANY,
            _ if always => Ways::NONE,
            class if class.is_avatar() => Ways::FOUR,
            class if class.is_a(C::RandomNPC) || class == C::RandomBomber => Ways::FOUR,
            C::Walker | C::WalkerJumper => Ways::ANY,
            _ => Ways::NONE,
        };
        // Parents are never updated; the player's avatar always is.
        let updated = info.order.is_some() || class.is_avatar();
        let (passive, steered) = (passive && updated, if updated { steered } else { Ways::NONE });
        let accelerates = traits.continuous && (steered != Ways::NONE || self.forced[stype.index()]);
        let walks = steered != Ways::NONE && !traits.stationary;
        let mut ways = Ways::NONE;
        if traits.continuous {
            if accelerates {
                own.facing = Ways::ALL;
                let limit = traits.max_speed.abs();
                own.top = if traits.max_speed == -1.0 { f64::INFINITY } else { own.top.max(limit) };
                if !(0.0..=2.0).contains(&traits.friction) {
                    own.top = f64::INFINITY;
                }
            }
            if passive || steered != Ways::NONE {
                ways = if accelerates { Ways::ANY } else { own.facing };
            }
            own.loose |= ways != Ways::NONE;
        } else {
            if passive && oriented {
                ways = ways.with(own.facing);
            }
            if walks {
                ways = ways.with(steered);
                if traits.rotate_in_place {
                    own.facing = own.facing.with(steered);
                }
                own.facing = if faces(class) { own.facing.with(steered) } else { own.facing };
                // Active movement takes a speed of 0 for 1; a car has one of its own.
                own.top = own.top.max(if class == C::CarAvatar { 5.0 } else { 1.0 });
            }
        }
        // A passive speed of −1 stands for 1.
        if own.backwards {
            ways = ways.with(ways.mirrored());
        }
        ways = ways.without(Ways::UNSET);
        own.loose |= ways.meets(Ways::ASKEW);
        // On the grid these take forces for directions of any length.
        let jumps = matches!(class, C::BirdAvatar | C::PlatformerAvatar | C::WizardAvatar) || walker;
        let leaps = jumps && !traits.continuous && walks;
        let hop = if jumps { 5.0 / self.block } else { 0.0 };
        let distance = if traits.continuous { own.top / self.block + hop } else { own.top };
        if own.top == 0.0 && !walks {
            ways = Ways::NONE;
        }
        own.ways = ways;
        own.moved = own.moved.with(ways);
        if ways == Ways::NONE {
            self.mobility[stype.index()] = own;
            return;
        }
        let (stride, leap) = self.stride(distance);
        let own = &mut own;
        (own.stride, own.leap) = (stride, leap);
        let askew = ways.meets(Ways::ASKEW) && distance > MAX_STRIDE;
        own.boundless |= leaps || askew || self.is_wild(distance);
        self.mobility[stype.index()] = *own;
    }

    /// So far in a tick that pixels run out of numbers, or that is no number at all.
    fn is_wild(&self, distance: f64) -> bool {
        !(distance * self.block < 1e6)
    }

    /// For a move of so many cells: how many cells it can enter, and how many it can skip.
    pub(super) fn stride(&self, distance: f64) -> (i32, i32) {
        let most = self.board.side() + 2;
        // What moves by less than its own size and a cell overlaps every cell on its way, before or after.
        let leap = if distance >= 1.0 + self.smallest { (distance - self.smallest) as i32 } else { 0 };
        ((distance.ceil() as i32).min(most), leap.min(most))
    }

    /// How far a sprite that is moved with another's speed goes, in cells.
    pub(super) fn carried(&self, one: SpriteType, by: SpriteType) -> f64 {
        let (one, by) = (self.of_type(one), self.of_type(by));
        // A speed of 0 stands for the sprite's own, and that for 1.
        by.top.max(one.top).max(1.0)
    }

    fn note_forces(&mut self, meeting: &Meeting) {
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

    /// What an effect does to orientations, and whether it moves.
    fn meet(&mut self, meeting: &Meeting) {
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
        let face = |new: &mut Mobility, facing: Ways| {
            new.facing = new.facing.with(facing);
            new.straight = false;
        };
        match effect {
            Effect::ReverseDirection => face(&mut new, own.facing.mirrored()),
            Effect::TurnAround => {
                face(&mut new, own.facing.mirrored());
                // The steps down may be turns first.
                if self.info(one).traits.rotate_in_place {
                    face(&mut new, Ways::UP.with(Ways::DOWN));
                }
                new.goes_back = true;
                new.moved = new.moved.with(Ways::DOWN).with(Ways::UP);
                new.placed |= !self.info(one).traits.stationary;
            }
            Effect::FlipDirection => face(&mut new, Ways::FOUR),
            Effect::BounceDirection { .. } => face(&mut new, Ways::ALL),
            Effect::WallStop | Effect::WallBounce | Effect::WallReverse => {
                let more = if own.facing.meets(Ways::ASKEW) { Ways::ALL } else { Ways::UNSET };
                face(&mut new, own.facing.mirrored().with(more));
                new.goes_back = true;
                new.placed |= matches!(effect, Effect::WallStop) && self.is_odd(one);
            }
            Effect::UndoAll { spare } => {
                for (at, own) in self.mobility.iter_mut().enumerate() {
                    own.goes_back |= !spare.contains(&SpriteType(at as u16));
                }
            }
            Effect::StepBack { pixel_perfect } => {
                new.goes_back = true;
                let flush = *pixel_perfect && two.is_some();
                new.loose |= flush && (!self.is_fixed_now(&partner) || partner.loose);
                new.placed |= flush && self.is_odd(one);
            }
            Effect::Align { orient, .. } => {
                if *orient {
                    face(&mut new, partner.facing);
                }
                new.placed = true;
                new.moved = Ways::ALL;
                new.loose |= partner.loose;
            }
            Effect::AttractGaze { align, .. } => {
                face(&mut new, partner.facing);
                if *align {
                    new.placed = true;
                    new.moved = Ways::ALL;
                    new.loose |= partner.loose;
                }
            }
            Effect::BounceForward => {
                let pushed = self.pushed(&partner);
                face(&mut new, pushed.with(Ways::UNSET));
                // Continuous physics takes a push for a force: its own movement knows.
                if !self.info(one).traits.stationary && !self.info(one).traits.continuous {
                    new.moved = new.moved.with(pushed);
                    new.loose |= partner.loose || pushed.meets(Ways::ASKEW);
                    self.carry(one, two, &mut new);
                }
            }
            Effect::PullWithIt { pixel_perfect } => {
                face(&mut new, Ways::UNSET.with(own.facing));
                new.moved = new.moved.with(partner.moved);
                new.loose |= partner.loose || partner.moved.meets(Ways::ASKEW);
                new.placed |= *pixel_perfect || self.info(one).traits.continuous;
                self.carry(one, two, &mut new);
            }
            Effect::TeleportToExit => {
                let exit = two.and_then(|two| self.info(two).leads_to());
                if let Some(exit) = exit.filter(|exit| self.there[exit.index()]) {
                    let exit = self.mobility[exit.index()];
                    face(&mut new, exit.facing);
                    new.placed = true;
                    new.moved = Ways::ALL;
                    new.loose |= exit.loose;
                }
            }
            Effect::WrapAround { offset } => {
                new.placed = true;
                new.moved = Ways::ALL;
                new.loose |= *offset != 0.0;
            }
            Effect::Spawn { stype, .. } | Effect::SpawnIf { stype, .. } => self.appear(*stype, own.loose),
            Effect::SpawnIfCounterSubTypes { stype, otherwise, .. } => {
                self.appear(*stype, own.loose);
                self.appear(*otherwise, own.loose);
            }
            Effect::SpawnBeside { stype, .. } | Effect::SpawnBehind { stype, .. } => {
                self.appear(*stype, partner.loose);
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
        // What `turn` and `appear` did to the type itself stays.
        let now = &mut self.mobility[at];
        now.facing = now.facing.with(new.facing);
        now.moved = now.moved.with(new.moved);
        now.loose |= new.loose;
        now.placed |= new.placed;
        now.boundless |= new.boundless;
        now.straight &= new.straight;
        now.goes_back |= new.goes_back;
    }

    /// One type turns into another, which takes over where it was, and perhaps where it faced.
    fn turn(&mut self, from: SpriteType, to: SpriteType, force: bool) {
        let old = self.mobility[from.index()];
        let oriented = self.info(from).traits.is_oriented && self.info(to).traits.is_oriented;
        let takes = force || (oriented && self.info(to).traits.orientation == Direction::NONE);
        let new = &mut self.mobility[to.index()];
        new.loose |= old.loose;
        new.moved = new.moved.with(old.moved);
        if takes {
            new.facing = new.facing.with(old.facing);
        }
        // For a moment it has moved as the old one did, and faces as the new one does.
        new.straight = false;
    }

    fn appear(&mut self, stype: SpriteType, loose: bool) {
        self.mobility[stype.index()].loose |= loose;
    }

    /// What is moved with another's speed.
    fn carry(&self, one: SpriteType, two: Option<SpriteType>, new: &mut Mobility) {
        let distance = two.map_or(1.0, |two| self.carried(one, two));
        new.boundless |= self.is_wild(distance);
        if self.info(one).order.is_none() {
            // Nothing brings its last place up to date.
            new.placed = true;
            new.moved = Ways::ALL;
        }
    }

    /// Whether sprites of the type are larger or smaller than a cell. The first one of its type has a size of its own until
    /// it moves: it may seem to have come from somewhere.
    pub(super) fn is_odd(&self, stype: SpriteType) -> bool {
        let traits = &self.info(stype).traits;
        traits.width_factor != 1.0 || traits.height_factor != 1.0
    }

    /// Whether one sprite, stopped flush with another, stands where it would have come by itself: beside what was there,
    /// and does not move.
    pub(super) fn stops_in_order(&self, one: SpriteType, two: SpriteType) -> bool {
        let (own, partner) = (self.of_type(one), self.of_type(two));
        let stands = partner.fixed && !partner.loose && !self.made[two.index()];
        stands && !self.is_odd(one) && !own.comes_from_far()
    }

    /// Whether, as far as is known by now, sprites of a type never move.
    fn is_fixed_now(&self, mobility: &Mobility) -> bool {
        !mobility.placed && mobility.moved.without(Ways::UNSET) == Ways::NONE
    }

    /// The directions into which a sprite pushes others.
    pub(super) fn pushed(&self, pusher: &Mobility) -> Ways {
        let moved = pusher.moved.without(Ways::UNSET);
        let both = !pushes_straight(pusher) || pusher.backwards;
        if both { moved.with(moved.mirrored()) } else { moved }
    }
}

/// Whether a push goes where the pusher went: not if it can face another way.
pub(super) fn pushes_straight(pusher: &Mobility) -> bool {
    !pusher.placed && (pusher.facing == Ways::UNSET || pusher.straight)
}

/// Avatars that face where they went.
fn faces(class: SpriteClass) -> bool {
    use SpriteClass as C;
    matches!(class, C::OrientedAvatar | C::ShootAvatar | C::AimedAvatar | C::BirdAvatar)
}

/// Avatars that always move ahead.
fn is_driven(class: SpriteClass) -> bool {
    use SpriteClass as C;
    matches!(class, C::MissileAvatar | C::OngoingAvatar | C::OngoingShootAvatar | C::OngoingTurningAvatar)
}

/// Whether an effect at the edge, or with a partner, takes place for every sprite of the type whatever it holds.
pub(super) fn is_stop(meeting: &Meeting, effect: &Effect) -> bool {
    let partner = !matches!(meeting.with, With::Nobody);
    partner
        && matches!(
            effect,
            Effect::StepBack { .. }
                | Effect::TurnAround
                | Effect::WallStop
                | Effect::WallBounce
                | Effect::WallReverse
                | Effect::UndoAll { .. }
        )
}
