//! The mobility of all types, computed as a fixed point over the rules before any level is examined cell by
//! cell.

use super::super::futures::PossibleFutures;
use super::cells::{Board, Directions};
use super::meetings::Meeting;
use super::mobility::{Mobility, pushes_straight};
use crate::rules::class::SpriteClass;
use crate::rules::effects::{Displacement, EffectSummary, Redirection};
use crate::rules::{Rules, SpriteType, TypeInfo};
use std::collections::BTreeSet;

/// The maximum number of collisions to process in all rounds of the fixed point. Typical games require a few
/// hundred.
const MAX_STEPS: usize = 1 << 21;

/// The mobility and related facts of all types, derived from the rules.
pub(super) struct Model<'a> {
    pub(super) rules: &'a Rules,
    pub(super) board: Board,
    pub(super) block: f64,
    pub(super) exists: &'a [bool],
    /// For each type, whether its sprites can appear during an episode.
    pub(super) made: &'a [bool],
    pub(super) meetings: &'a [Meeting<'a>],
    /// For each type, the types that its sprites create on their own, each with the required ammunition.
    pub(super) makes: Vec<Vec<(SpriteType, Option<SpriteType>)>>,
    /// For each type, the types to which its sprites lead when touched.
    pub(super) exits: Vec<Vec<SpriteType>>,
    /// For each type, whether sprites can hold it as a resource beyond its limit.
    pub(super) unlimited: Vec<bool>,
    pub(super) mobility: Vec<Mobility>,
    /// The size of the smallest sprite, in cells.
    pub(super) smallest: f64,
    /// `true` if some sprite is larger or smaller than a cell.
    pub(super) scales: bool,
    /// For each type, the maximum number of cells by which other sprites can move its sprites in a tick.
    pub(super) pushed_far: Vec<i32>,
    /// For each type, whether its sprites can be accelerated by anything other than themselves.
    pub(super) forced: Vec<bool>,
    /// For each type, whether some effect gives it an orientation even if its class has no orientation.
    pub(super) takes_orientation: Vec<bool>,
}

impl<'a> Model<'a> {
    /// Builds the model. Returns `None` if the sizes of sprites are extreme, or if the fixed point takes too many
    /// steps.
    pub(super) fn of(
        rules: &'a Rules,
        futures: &'a PossibleFutures<'_>,
        meetings: &'a [Meeting<'a>],
        board: Board,
        block: i32,
    ) -> Option<Model<'a>> {
        let block = f64::from(block);
        let present = || rules.types.iter().zip(&futures.exists).filter(|(_, exists)| **exists);
        let factors =
            || present().flat_map(|(info, _)| [info.traits.width_factor, info.traits.height_factor]);
        // Sizes are whole pixels: a sprite may be slightly smaller than its factor implies.
        let smallest = factors().map(|factor| (factor * block).floor() / block).fold(1.0, f64::min);
        if !factors().all(|factor| factor * block >= 1.0 && factor <= 64.0) {
            return None;
        }
        let mut makes: Vec<_> = (0..rules.types.len()).map(|at| futures.makes(at)).collect();
        let spawns = |class: SpriteClass| class.is_a(SpriteClass::SpawnPoint);
        let exits = |info: &TypeInfo| {
            // A spawner leads to whichever type it creates in the current tick.
            let made = info.class.is_some_and(spawns).then_some(&info.traits.stypes[..]);
            let exits = info.leads_to().into_iter().chain(made.unwrap_or_default().iter().copied());
            exits.filter(|&exit| exit != SpriteType::NONE).collect::<Vec<SpriteType>>()
        };
        let mut exits: Vec<Vec<_>> = rules.types.iter().map(exits).collect();
        for meeting in meetings {
            let Some(Redirection { spawn_point, to: stype }) = meeting.summary(rules).redirects else {
                continue;
            };
            for family in &rules.types[spawn_point.index()].tree {
                let new = !exits[family.index()].contains(&stype);
                if rules.types[family.index()].class.is_some_and(spawns) && new {
                    makes[family.index()].push((stype, None));
                    exits[family.index()].push(stype);
                }
            }
        }
        let none = vec![false; rules.types.len()];
        let mut model = Model {
            rules,
            board,
            block,
            exists: &futures.exists,
            made: &futures.made,
            meetings,
            makes,
            exits,
            unlimited: (0u16..).take(none.len()).map(|at| futures.is_unlimited(SpriteType(at))).collect(),
            mobility: vec![Mobility::default(); rules.types.len()],
            smallest,
            pushed_far: vec![0; none.len()],
            scales: factors().any(|factor| factor != 1.0),
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
        let exists = self.exists;
        (0..exists.len()).filter(|&at| exists[at]).map(|at| SpriteType(at as u16))
    }

    /// Returns the maximum number of cells by which two sprites of the type in the same cell can extend
    /// beyond that cell.
    pub(super) fn spread(&self, stype: SpriteType) -> i32 {
        if self.of_type(stype).off_grid { self.rules.reach.max(1) } else { 0 }
    }

    /// Runs the fixed point. Returns `true` if it converged within the limit.
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
        let undoing = self.meetings.iter().map(|meeting| meeting.effect).collect::<BTreeSet<u16>>();
        for effect in undoing {
            let Some(spare) = self.rules.effects[usize::from(effect)].summary.undoes() else { continue };
            for &stype in &types {
                self.mobility[stype.index()].goes_back |= !spare.contains(&stype);
            }
        }
        let (mut settled, mut steps) = (false, 0);
        while !settled && steps < MAX_STEPS {
            let before: Vec<_> = self.states().collect();
            for &stype in &types {
                self.pass_orientation(stype);
                self.move_by_itself(stype);
            }
            for meeting in self.meetings {
                self.meet(meeting);
            }
            settled = self.states().eq(before);
            steps += self.meetings.iter().map(|meeting| self.size(meeting)).sum::<usize>() + types.len();
        }
        for &stype in &types {
            let mobility = &mut self.mobility[stype.index()];
            mobility.fixed = !mobility.boundless
                && !mobility.placed
                && mobility.moved.without(Directions::UNSET) == Directions::NONE
                && mobility.directions == Directions::NONE;
        }
        for meeting in self.meetings {
            self.note_push(meeting);
        }
        settled
    }

    /// Returns the number of types involved in a collision.
    fn size(&self, meeting: &Meeting<'_>) -> usize {
        let summary = meeting.summary(self.rules);
        if summary.displacement == Some(Displacement::Exit) {
            return meeting.two().map_or(1, |two| self.exits[two.index()].len());
        }
        let options = summary.effects.iter().find_map(|effect| {
            let EffectSummary::BecomeAny(options) = effect else { return None };
            Some(options.len())
        });
        options.unwrap_or(1)
    }

    /// Returns the maximum number of cells by which other sprites can move a sprite of the type in a tick.
    pub(super) fn pushed_far(&self, stype: SpriteType) -> i32 {
        self.pushed_far[stype.index()]
    }

    fn states(&self) -> impl Iterator<Item = (Directions, Directions, [bool; 3])> + use<'_> {
        self.mobility.iter().map(|own| (own.facing, own.moved, [own.off_grid, own.placed, own.goes_back]))
    }

    /// Returns `true` if a distance per tick is NaN or too large for pixel coordinates.
    pub(super) fn is_out_of_range(&self, distance: f64) -> bool {
        distance.is_nan() || distance * self.block >= 1e6
    }

    /// Returns the maximum number of cells that a move over the given distance can enter, and the maximum
    /// number that it can skip.
    pub(super) fn stride(&self, distance: f64) -> (i32, i32) {
        let most = self.board.side() + 2;
        // A sprite that moves by less than its own size plus one cell overlaps every cell on its way, either
        // before or after the move.
        let leap = if distance >= 1.0 + self.smallest { (distance - self.smallest) as i32 } else { 0 };
        ((distance.ceil() as i32).min(most), leap.min(most))
    }

    /// Returns the distance, in cells, of a move in which a sprite is carried at another sprite's speed.
    pub(super) fn carried(&self, one: SpriteType, by: SpriteType) -> f64 {
        let (one, by) = (self.of_type(one), self.of_type(by));
        // A speed of 0 stands for the sprite's own speed. If the sprite's own speed is 0 as well, a speed of
        // 1 is used.
        by.top.max(one.top).max(1.0)
    }

    /// Returns `true` if sprites of the type are larger or smaller than a cell. The first sprite of such a type is
    /// not scaled until it moves, so it may appear to have come from a different cell.
    pub(super) fn is_scaled(&self, stype: SpriteType) -> bool {
        let traits = &self.info(stype).traits;
        traits.width_factor != 1.0 || traits.height_factor != 1.0
    }

    /// Returns `true` if a sprite that stops flush against another sprite ends where its own movement would
    /// have taken it. This requires the other sprite to be there from the start and not to move.
    pub(super) fn stops_in_order(&self, one: SpriteType, two: SpriteType) -> bool {
        let (own, partner) = (self.of_type(one), self.of_type(two));
        let stands = partner.fixed && !partner.off_grid && !self.made[two.index()];
        stands && !self.is_scaled(one) && !own.comes_from_far()
    }

    /// Returns `true` if the facts derived so far imply that sprites with this mobility never move.
    pub(super) fn is_fixed_now(&self, mobility: &Mobility) -> bool {
        !mobility.placed && mobility.moved.without(Directions::UNSET) == Directions::NONE
    }

    /// Returns the directions in which a sprite pushes other sprites.
    pub(super) fn pushed(&self, pusher: &Mobility) -> Directions {
        let moved = pusher.moved.without(Directions::UNSET);
        let both = !pushes_straight(pusher) || pusher.backwards;
        if both { moved.with(moved.mirrored()) } else { moved }
    }
}
