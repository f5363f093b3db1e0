//! What sprites do to where others come to: makers, and the effects of meetings.

use super::super::encounter::Provided;
use super::cells::{Board, Cells, Ways};
use super::flood::Flood;
use super::meetings::{Meeting, Order, With};
use super::mobility::pushes_straight;
use crate::game::SpriteType;
use crate::geometry::Direction;
use crate::ontology::class::SpriteClass;
use crate::ontology::effects::Effect;

/// How much of a resource can be got: more than anything asks for.
const PLENTY: i64 = i64::MAX;

/// What a level places of one type: cells, and how many in each.
pub(super) type Placed = Vec<Vec<(usize, u32)>>;

/// The effects of meetings, applied until nothing changes.
pub(super) struct Events<'a> {
    pub(super) flood: Flood<'a>,
    placed: &'a Placed,
    ring: Cells,
    /// By type: how many of it, as a resource, can be got in all.
    have: Vec<i64>,
    /// By meeting: the versions of the two regions when it was last looked at.
    seen: Vec<(u32, u32)>,
}

/// A way to get a resource: what is met, where, how much each gives, and whether it is used up by giving.
struct Gift {
    resource: SpriteType,
    giver: SpriteType,
    cells: Cells,
    each: i64,
    once: bool,
}

impl<'a> Events<'a> {
    pub(super) fn of(flood: Flood<'a>, placed: &'a Placed) -> Events<'a> {
        let ring = flood.board.ring();
        let (types, meetings) = (flood.model.there.len(), flood.model.meetings.len());
        Events { flood, placed, ring, have: vec![0; types], seen: vec![(u32::MAX, u32::MAX); meetings] }
    }

    /// Runs until nothing changes; whether that took no more than so much work.
    pub(super) fn settle(&mut self, budget: u64) -> bool {
        loop {
            let before = self.state();
            self.flood.spread();
            self.make();
            self.flood.spread();
            self.have = self.resources();
            for at in 0..self.flood.model.meetings.len() {
                self.meet(at);
                if self.flood.work > budget {
                    return false;
                }
            }
            if self.state() == before {
                return true;
            }
        }
    }

    fn state(&self) -> (u64, Vec<i64>, usize) {
        let versions = self.flood.regions.iter().map(|region| u64::from(region.version)).sum();
        let ended = self.flood.ended.iter().map(|cells| cells.iter().count()).sum();
        (versions, self.have.clone(), ended)
    }

    fn board(&self) -> Board {
        self.flood.board
    }

    fn touch(&self, stype: SpriteType) -> &Cells {
        &self.flood.regions[stype.index()].touch
    }

    fn rest(&self, stype: SpriteType) -> &Cells {
        &self.flood.regions[stype.index()].rest
    }

    fn is_there(&self, stype: SpriteType) -> bool {
        self.flood.model.there[stype.index()] && !self.touch(stype).is_empty()
    }

    /// Cells that a sprite of the type which is met in these cells can overlap.
    fn near(&mut self, stype: SpriteType, cells: &Cells) -> Cells {
        self.flood.work += self.board().size() as u64 / 64;
        let around = self.board().around(cells, self.flood.model.spread(stype));
        around.shared(self.touch(stype))
    }

    fn appear_in(&mut self, stype: SpriteType, cells: &Cells, at: Order, heading: Ways) {
        // What is larger than its maker, or stands between cells as it does, reaches over to the right and down.
        let more = self.flood.model.spread(stype);
        let grows = self.flood.model.rules.scales && more > 0;
        let cells = if grows { self.board().around(cells, more) } else { cells.clone() };
        cells.iter().for_each(|cell| self.flood.appear(stype, cell, at, heading));
    }

    /// Spawned by an effect: nothing gives it a direction.
    fn spawn_in(&mut self, stype: SpriteType, cells: &Cells, at: Order) {
        let heading = self.flood.model.born(stype);
        self.appear_in(stype, cells, at, heading);
    }

    /// Put somewhere by others, in whatever direction it can have.
    fn come_to(&mut self, stype: SpriteType, cells: &Cells, at: Order) {
        let heading = self.flood.model.of_type(stype).facing;
        cells.iter().for_each(|cell| self.flood.come(stype, cell, at, heading));
    }

    /// What types make by themselves.
    fn make(&mut self) {
        for maker in self.flood.model.types() {
            if !self.is_there(maker) {
                continue;
            }
            let traits = &self.flood.model.info(maker).traits;
            let avatar = self.flood.model.info(maker).class.is_some_and(|class| class.is_avatar());
            let kinds = self.flood.model.makes[maker.index()].clone();
            if kinds.is_empty() {
                continue;
            }
            let muzzles = self.muzzles(maker);
            for (kind, made) in kinds.into_iter().enumerate() {
                let ammo = traits.ammo.get(kind).filter(|_| avatar);
                if !self.flood.model.there[made.index()]
                    || ammo.is_some_and(|ammo| self.have[ammo.index()] <= 0)
                {
                    continue;
                }
                for (from, facing) in &muzzles {
                    let heading = self.given(maker, made, *facing);
                    self.appear_in(made, from, Order::UPDATE, heading);
                }
            }
        }
    }

    /// The directions that what is made gets, from a maker that faces one way.
    fn given(&self, maker: SpriteType, made: SpriteType, facing: Ways) -> Ways {
        let model = self.flood.model;
        let born = model.born(made);
        let traits = &model.info(maker).traits;
        match model.info(maker).class {
            Some(SpriteClass::FlakAvatar | SpriteClass::Spreader | SpriteClass::OngoingTurningAvatar) => born,
            Some(class) if class.is_avatar() => {
                if model.info(made).traits.is_oriented {
                    facing
                } else {
                    born
                }
            }
            _ if traits.spawn_orientation != Direction::NONE => Ways::of(traits.spawn_orientation),
            _ if born.meets(Ways::UNSET) => facing,
            _ => born,
        }
    }

    /// Where what a type makes appears, and which way the maker faces then.
    fn muzzles(&self, maker: SpriteType) -> Vec<(Cells, Ways)> {
        use SpriteClass as C;
        let (board, model) = (self.board(), self.flood.model);
        let own = model.of_type(maker);
        let Some(class) = model.info(maker).class else { return Vec::new() };
        let grown = if own.loose { model.rules.reach.max(1) } else { 0 };
        let around = |distance: i32| vec![(board.around(self.touch(maker), distance), Ways::ALL)];
        match class {
            // A shot at rest, from where it stands; the others have moved before they shoot.
            C::ShootAvatar | C::ShootOnlyAvatar if !model.info(maker).traits.continuous => {
                self.ahead(self.rest(maker), own.facing, grown)
            }
            C::FlakAvatar if !model.info(maker).traits.continuous => {
                vec![(self.rest(maker).clone(), own.facing)]
            }
            C::ShootAvatar | C::ShootOnlyAvatar | C::OngoingShootAvatar => {
                self.ahead(self.touch(maker), own.facing, grown)
            }
            C::AimedAvatar | C::SpaceshipAvatar => around(1 + grown),
            C::WizardAvatar => around(2 + grown),
            C::OngoingTurningAvatar => vec![(self.rest(maker).clone(), own.facing)],
            C::Spreader => self.ahead(self.touch(maker), Ways::FOUR, grown),
            _ => vec![(self.touch(maker).clone(), own.facing)],
        }
    }

    /// One body length ahead, for each of these directions.
    fn ahead(&self, from: &Cells, facing: Ways, grown: i32) -> Vec<(Cells, Ways)> {
        let board = self.board();
        if facing.meets(Ways::ASKEW) {
            return vec![(board.around(from, 1 + grown), Ways::ALL)];
        }
        // Whose size is not that of a cell shoots a little further, or less far.
        let more = if self.flood.model.rules.scales { grown } else { 0 };
        let shifted = |step: (i32, i32)| {
            let cells = Cells::of(board, from.iter().map(|cell| board.shifted(cell, step, 1)));
            (board.around(&cells, more), Ways::of_step(step))
        };
        let unset = facing.meets(Ways::UNSET).then(|| (board.around(from, more), Ways::UNSET));
        facing.steps().map(shifted).chain(unset).collect()
    }

    /// How much of each resource can be got.
    fn resources(&mut self) -> Vec<i64> {
        let mut gifts: Vec<Gift> = Vec::new();
        for meeting in self.flood.model.meetings {
            let (Some(one), Some(two)) = (meeting.one, meeting.two()) else { continue };
            if !self.is_there(one) || !self.is_there(two) || !self.can_be(meeting.provided) {
                continue;
            }
            let value = i64::from(self.flood.model.info(one).traits.value);
            let (resource, giver, each, once) = match *meeting.effect(self.flood.model.rules) {
                Effect::CollectResource { kill_resource } => (one, one, value, kill_resource),
                Effect::CollectResourceIfHeld { kill_resource, .. } => (one, one, value, kill_resource),
                Effect::ChangeResource { resource, value, kill_resource } => {
                    (resource, two, i64::from(value), kill_resource)
                }
                _ => continue,
            };
            let cells = self.met(one, two, meeting.order);
            self.flood.work += self.board().size() as u64 / 64;
            let collected = giver == one;
            let nothing = collected && !self.flood.model.info(resource).traits.is_resource;
            if each <= 0 || cells.is_empty() || nothing {
                continue;
            }
            let same = |gift: &&mut Gift| gift.resource == resource && gift.giver == giver;
            match gifts.iter_mut().find(same) {
                Some(gift) => {
                    gift.cells.add(&cells);
                    // Collecting ends what is collected; other rules may each give something, once more.
                    gift.each = if collected { gift.each.max(each) } else { gift.each.saturating_add(each) };
                    gift.once &= once;
                }
                None => gifts.push(Gift { resource, giver, cells, each, once }),
            }
        }
        let mut have = vec![0i64; self.have.len()];
        for gift in gifts {
            let at = gift.giver.index();
            let still = self.flood.model.of_type(gift.giver).fixed;
            let met = self.placed[at].iter().filter(|(cell, _)| !still || gift.cells.contains(*cell));
            let count: i64 = met.map(|(_, count)| i64::from(*count)).sum();
            let limited = gift.once && !self.flood.made[at];
            let amount = if limited { count.saturating_mul(gift.each) } else { PLENTY };
            have[gift.resource.index()] = have[gift.resource.index()].saturating_add(amount);
        }
        have
    }

    /// Whether what an effect asks for can be so.
    fn can_be(&self, provided: Provided) -> bool {
        match provided {
            Provided::Holds(_, resource, amount) => {
                let limit = self.flood.model.info(resource).resource_limit;
                amount <= 0 || (amount <= limit && self.have[resource.index()] >= i64::from(amount))
            }
            Provided::Chance(prob) => prob > 0.0,
            Provided::Always | Provided::HoldsAtMost(..) | Provided::Way => true,
        }
    }

    /// Cells that two sprites can share at that moment of a tick.
    fn met(&self, one: SpriteType, two: SpriteType, at: Order) -> Cells {
        self.flood.present(one, at, true).shared(&self.flood.present(two, at, false))
    }

    fn meet(&mut self, at: usize) {
        let meeting = self.flood.model.meetings[at];
        let version =
            |stype: Option<SpriteType>| stype.map_or(0, |stype| self.flood.regions[stype.index()].version);
        let versions = (version(meeting.one), version(meeting.two()));
        let effect = meeting.effect(self.flood.model.rules);
        // These depend on more than the two.
        let far = matches!(
            effect,
            Effect::TeleportToExit
                | Effect::TransformToAll { .. }
                | Effect::TransformToSingleton { .. }
                | Effect::UpdateSpawnType { .. }
        );
        if (self.seen[at] == versions && !far) || !self.can_be(meeting.provided) {
            return;
        }
        self.flood.work += 1 + self.board().size() as u64 / 64;
        let Some(one) = meeting.one else {
            self.seen[at] = versions;
            return self.at_large(effect, meeting.order);
        };
        if !self.is_there(one) {
            return;
        }
        let cells = match meeting.with {
            With::Sprite(two) if self.is_there(two) => self.met(one, two, meeting.order),
            With::Sprite(_) => return,
            With::Edge => self.touch(one).shared(&self.ring),
            With::Nobody => self.touch(one).clone(),
        };
        if !cells.is_empty() {
            self.seen[at] = versions;
            self.run(&meeting, one, &cells, effect);
        }
    }

    /// What an effect does that concerns all sprites of a type, wherever they are.
    fn at_large(&mut self, effect: &Effect, at: Order) {
        match effect {
            Effect::KillAll { stype } => {
                let all = Cells::all(self.board());
                self.flood.end(*stype, &all);
            }
            Effect::TransformToAll { stype, to, .. } => self.become_all(*stype, *to, at),
            Effect::SubtractHealthPoints { stype: Some(stype), .. } => self.hurt(*stype),
            _ => {}
        }
    }

    fn hurt(&mut self, family: SpriteType) {
        let all = Cells::all(self.board());
        for &stype in &self.flood.model.info(family).tree {
            self.flood.end(stype, &all);
        }
    }

    fn become_all(&mut self, from: SpriteType, to: SpriteType, at: Order) {
        if self.is_there(from) {
            let all = Cells::all(self.board());
            self.turn(from, to, &all, at);
            self.flood.end(from, &all);
        }
    }

    /// Sprites that are met in these cells turn into others.
    fn turn(&mut self, from: SpriteType, to: SpriteType, cells: &Cells, at: Order) {
        let model = self.flood.model;
        if !model.there[to.index()] {
            return;
        }
        let here = self.near(from, cells);
        let heading = model.of_type(to).facing;
        self.appear_in(to, &here, at, heading);
        if model.of_type(to).goes_back {
            // The new sprite can be put back to where the old one was before it moved.
            let own = model.of_type(from);
            let distance = if own.boundless || own.placed { self.board().side() + 2 } else { own.stride };
            let distance = distance.saturating_add(model.spread(from)).max(self.pushed_far(from));
            let before = self.board().around(cells, distance.min(self.board().side() + 2));
            let before = before.shared(self.rest(from));
            self.appear_in(to, &before, at, heading);
        }
    }

    /// How far others move a sprite in a tick, at most.
    fn pushed_far(&self, stype: SpriteType) -> i32 {
        let model = self.flood.model;
        let mut far = 0;
        for meeting in model.meetings.iter().filter(|meeting| meeting.one == Some(stype)) {
            let carries = matches!(
                meeting.effect(model.rules),
                Effect::BounceForward | Effect::PullWithIt { .. } | Effect::TurnAround
            );
            if carries {
                let by = meeting.two().unwrap_or(stype);
                far = far.max(2 * model.stride(model.carried(stype, by)).0);
            }
        }
        far
    }

    /// What an effect does to the direction of sprites that it runs on in these cells.
    fn turn_to(&mut self, one: SpriteType, cells: &Cells, effect: &Effect) {
        let model = self.flood.model;
        let own = *model.of_type(one);
        let turn = |heading: Ways| match effect {
            Effect::ReverseDirection => heading.mirrored(),
            Effect::TurnAround if !model.info(one).traits.rotate_in_place => heading.mirrored(),
            _ => own.facing,
        };
        let turns = matches!(
            effect,
            Effect::ReverseDirection
                | Effect::TurnAround
                | Effect::FlipDirection
                | Effect::BounceDirection { .. }
                | Effect::WallStop
                | Effect::WallBounce
                | Effect::WallReverse
                | Effect::Align { .. }
                | Effect::AttractGaze { .. }
                | Effect::BounceForward
                | Effect::PullWithIt { .. }
                | Effect::TeleportToExit
        );
        if !turns || !own.is_steady() {
            return;
        }
        // By the end of the tick it may be back where it came from, or wherever else it is put.
        let far = own.stride.max(self.pushed_far(one)).saturating_add(model.spread(one));
        let far = if own.placed { self.board().side() + 2 } else { far.min(self.board().side() + 2) };
        let around = self.board().around(cells, far);
        self.flood.face(one, &around, turn);
    }

    fn run(&mut self, meeting: &Meeting, one: SpriteType, cells: &Cells, effect: &Effect) {
        let at = meeting.order;
        let two = meeting.two();
        let own = self.near(one, cells);
        // By the clock, and at the edge, there is no partner; most effects then do nothing.
        let alone = two.is_none();
        let partner = two.map_or_else(Cells::default, |two| self.near(two, cells));
        self.turn_to(one, cells, effect);
        match effect {
            Effect::KillSprite
            | Effect::KillIfHasLess { .. }
            | Effect::KillIfHasMore { .. }
            | Effect::KillIfNotUpright => self.flood.end(one, &own),
            Effect::KillAll { .. } => self.at_large(effect, at),
            Effect::SubtractHealthPoints { stype, .. } => {
                self.flood.end(one, &own);
                if let Some(stype) = stype {
                    self.hurt(*stype);
                }
            }
            Effect::AddHealthPoints { kill_second, .. } | Effect::RemoveScore { kill_second, .. } => {
                if let Some(two) = two.filter(|_| *kill_second) {
                    self.flood.end(two, &partner);
                }
            }
            Effect::TurnAround => self.turn_around(one, cells, at),
            Effect::WrapAround { offset } => self.wrap(one, &own, *offset, at),
            Effect::Spawn { stype, .. } | Effect::SpawnIf { stype, .. } => self.spawn_in(*stype, &own, at),
            Effect::SpawnIfCounterSubTypes { stype, otherwise, .. } => {
                self.spawn_in(*stype, &own, at);
                self.spawn_in(*otherwise, &own, at);
            }
            Effect::CloneSprite => self.spawn_in(one, &own, at),
            Effect::TransformTo { stype, kill_second, .. } => {
                self.turn(one, *stype, cells, at);
                self.flood.end(one, &own);
                if let Some(two) = two.filter(|_| *kill_second) {
                    self.flood.end(two, &partner);
                }
            }
            Effect::TransformToRandomChild { options, kill_second, .. } => {
                options.iter().for_each(|&to| self.turn(one, to, cells, at));
                self.flood.end(one, &own);
                if let Some(two) = two.filter(|_| *kill_second) {
                    self.flood.end(two, &partner);
                }
            }
            Effect::TransformToAll { stype, to, kill_second, .. } => {
                self.become_all(*stype, *to, at);
                if let Some(two) = two.filter(|_| *kill_second) {
                    self.flood.end(two, &partner);
                }
            }
            Effect::KillIfAlive
            | Effect::KillIfFromAbove
            | Effect::KillIfFrontal { .. }
            | Effect::KillIfSpeed { .. }
            | Effect::KillIfOtherHasMore { .. } => {
                if !alone {
                    self.flood.end(one, &own);
                }
            }
            _ => {
                if let Some(two) = two {
                    self.run_on_both(at, (one, two), (cells, &own, &partner), effect);
                }
            }
        }
    }

    /// What needs a partner.
    fn run_on_both(
        &mut self,
        at: Order,
        (one, two): (SpriteType, SpriteType),
        (cells, own, partner): (&Cells, &Cells, &Cells),
        effect: &Effect,
    ) {
        match effect {
            Effect::KillBoth => {
                self.flood.end(one, own);
                self.flood.end(two, partner);
            }
            Effect::CollectResource { kill_resource }
            | Effect::CollectResourceIfHeld { kill_resource, .. } => {
                if *kill_resource && self.flood.model.info(one).traits.is_resource {
                    self.flood.end(one, own);
                }
            }
            Effect::ChangeResource { kill_resource: true, .. } => self.flood.end(two, partner),
            Effect::TransformIfCount(rule) => {
                for to in std::iter::once(rule.stype).chain(rule.otherwise) {
                    self.turn(one, to, cells, at);
                }
                self.flood.end(one, own);
                if rule.kill_second {
                    self.flood.end(two, partner);
                }
            }
            Effect::TransformToSingleton { stype, other, .. } => {
                self.become_all(*stype, *other, at);
                self.turn(one, *stype, cells, at);
                self.flood.end(one, own);
            }
            Effect::SpawnBeside { stype, shift, step_back, .. } => {
                let from = if *step_back { self.touch(two).clone() } else { partner.clone() };
                let board = self.board();
                let beside = Cells::of(board, from.iter().map(|cell| board.shifted(cell, *shift, 1)));
                self.spawn_in(*stype, &beside, at);
            }
            Effect::SpawnBehind { stype, .. } => {
                let from = self.touch(two).clone();
                self.spawn_in(*stype, &from, at);
            }
            Effect::StepBack { pixel_perfect: true } | Effect::WallStop => {
                // Flush with what moves, or with what it was inside of, it may stand where it would not have come by
                // itself.
                let model = self.flood.model;
                let inside = !cells.shared(self.rest(one)).is_empty();
                if inside || !model.stops_in_order(one, two) {
                    let reach = 2 * self.flood.model.rules.reach.max(1);
                    let flush = self.board().around(cells, reach);
                    self.come_to(one, &flush, at);
                }
            }
            Effect::Align { .. } => {
                let more = self.flood.model.spread(one);
                let there =
                    self.board().around(partner, if self.flood.model.rules.scales { more } else { 0 });
                self.come_to(one, &there, at);
            }
            Effect::AttractGaze { align: true, .. } => {
                let there = self.board().around(cells, 1 + self.flood.model.rules.reach.max(1));
                self.come_to(one, &there, at);
            }
            Effect::BounceForward => self.push((one, two), own, at),
            Effect::PullWithIt { pixel_perfect } => {
                self.pull((one, two), own, at);
                if *pixel_perfect {
                    self.come_to(one, partner, at);
                }
            }
            Effect::TeleportToExit => {
                // Without an exit it dies.
                self.flood.end(one, own);
                let exit = self.flood.model.info(two).leads_to().filter(|&exit| self.is_there(exit));
                if let Some(exit) = exit {
                    let there = self.touch(exit).clone();
                    self.come_to(one, &there, at);
                }
            }
            _ => {}
        }
    }

    /// Two steps down from where it came from.
    fn turn_around(&mut self, one: SpriteType, cells: &Cells, at: Order) {
        let model = self.flood.model;
        let (own, traits) = (*model.of_type(one), &model.info(one).traits);
        if traits.stationary || traits.continuous {
            return;
        }
        if own.boundless {
            let all = Cells::all(self.board());
            return self.come_to(one, &all, at);
        }
        let stride = model.stride(own.top.max(1.0)).0;
        let exact = !own.loose && own.top <= 1.0 && !traits.rotate_in_place;
        let board = self.board();
        let far = own.stride.saturating_add(self.pushed_far(one)).saturating_add(1 + model.spread(one));
        let straight = !own.loose && !own.ways.meets(Ways::ASKEW);
        let from = if straight && self.flood.by_itself(one, cells) == *cells {
            // Or it has stood there, and something came to it.
            let ways = own.ways.with(Ways::UP);
            let steps = ways.steps().flat_map(|step| (0..=own.stride).map(move |times| (step, -times)));
            let steps: Vec<((i32, i32), i32)> = steps.collect();
            let back = |cell: usize| steps.iter().map(move |&(step, times)| board.shifted(cell, step, times));
            Cells::of(board, cells.iter().flat_map(back))
        } else {
            // What something else has brought there in the same tick may have come from further away.
            board.around(cells, far.min(board.side() + 2))
        };
        let from = from.shared(self.rest(one));
        for cell in from.iter() {
            for down in if exact { 2..=2 } else { 1..=2 * stride } {
                let signs: &[i32] = if own.backwards { &[1, -1] } else { &[1] };
                for sign in signs {
                    let to = self.board().shifted(cell, (0, *sign), down);
                    self.flood.come(one, to, at, own.facing);
                }
            }
        }
    }

    /// To the opposite edge, along the orientation.
    fn wrap(&mut self, one: SpriteType, from: &Cells, offset: f64, at: Order) {
        let board = self.board();
        let facing = self.flood.model.of_type(one).facing;
        let facing = if facing.meets(Ways::ASKEW) { Ways::ANY } else { facing };
        let size = if self.flood.model.of_type(one).loose { self.flood.model.rules.reach.max(1) } else { 0 };
        for cell in from.iter() {
            let (x, y) = board.place(cell);
            let mut to: Vec<(i32, i32)> = Vec::new();
            let near = if offset == 0.0 { 0..=size } else { -1..=board.side() };
            for inset in near {
                for (way, place) in [
                    (Ways::RIGHT, (inset, y)),
                    (Ways::LEFT, (board.columns - 1 - inset, y)),
                    (Ways::DOWN, (x, inset)),
                    (Ways::UP, (x, board.rows - 1 - inset)),
                ] {
                    to.extend(facing.meets(way).then_some(place));
                }
            }
            to.into_iter().for_each(|(x, y)| self.flood.come(one, board.at(x, y), at, facing));
        }
    }

    /// Pushed by what comes to where it rests.
    fn push(&mut self, (one, two): (SpriteType, SpriteType), own: &Cells, at: Order) {
        let model = self.flood.model;
        let (box_, pusher) = (*model.of_type(one), *model.of_type(two));
        let traits = &model.info(one).traits;
        if traits.stationary || traits.continuous {
            return;
        }
        let board = self.board();
        let distance = model.carried(one, two);
        let (stride, leap) = model.stride(distance);
        let exact = pushes_straight(&pusher) && !pusher.backwards && !pusher.loose && !box_.loose;
        let exact = exact && !pusher.boundless && !box_.placed;
        let from = if box_.placed { own.clone() } else { own.shared(self.rest(one)) };
        let facing = box_.facing;
        let steps: Vec<(i32, i32)> = model.pushed(&pusher).steps().collect();
        let run_up = pusher.stride.max(self.pushed_far(two)).max(1);
        for cell in from.iter() {
            for &step in &steps {
                let behind = |times: i32| self.rest(two).contains(board.shifted(cell, step, -times));
                if !exact || (1..=run_up).any(behind) {
                    self.flood.go(one, cell, step, (stride, leap), (at, facing));
                }
            }
        }
    }

    /// Carried along by what stands where it is.
    fn pull(&mut self, (one, two): (SpriteType, SpriteType), own: &Cells, at: Order) {
        let model = self.flood.model;
        let (passenger, carrier) = (*model.of_type(one), *model.of_type(two));
        let continuous = model.info(one).traits.continuous;
        let distance = if continuous { carrier.top * 10.0 / model.block } else { carrier.top };
        let (stride, leap) = model.stride(distance.max(passenger.top / model.block));
        let from = if passenger.placed { own.clone() } else { own.shared(self.rest(one)) };
        if continuous || carrier.moved.meets(Ways::ASKEW) || carrier.backwards {
            // Put on top of it, too.
            let more = stride.saturating_add(1 + model.rules.reach.max(1)).min(self.board().side() + 2);
            let there = self.board().around(&from, more);
            return self.come_to(one, &there, at);
        }
        let facing = passenger.facing;
        let steps: Vec<(i32, i32)> = carrier.moved.steps().collect();
        for cell in from.iter() {
            for &step in &steps {
                self.flood.go(one, cell, step, (stride, leap), (at, facing));
            }
        }
    }
}
