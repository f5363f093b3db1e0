//! Reachability: the cells of a level in which sprites of each type can be.
//!
//! The reach is a fixed point over the cells of a level, computed under the game's own rules for:
//!
//! - walking in four directions, along a line, straight ahead or by forces
//! - pushing, carrying, teleporting and wrapping around
//! - shooting, spawning and transforming
//! - obstacles, which last until a key, a shot or a push removes them
//! - the resources that can be obtained
//!
//! The result is an over-approximation: it contains every cell that can be reached, and possibly more. It is
//! exact in three respects:
//!
//! - Permanent walls keep out the sprites that they stop, unless a later interaction in the same tick moves a
//!   sprite in.
//! - Pushed sprites move only away from cells where their pusher can be, if both sprites keep to whole cells
//!   and the pusher faces the direction of its move.
//! - Keys that can be taken only once are counted.
//!
//! It is inexact in these respects:
//!
//! - Time is ignored. A sprite that can ever be removed leaves its cell open from the start. Two types that
//!   can be in the same cell, each at some time, can meet there. A sprite can be in two cells at the same
//!   time.
//! - Behaviour is ignored. NPCs go wherever nothing stops them, pushed sprites are never in the way, and harm
//!   stops no sprite.
//! - With continuous physics, a sprite whose velocity is changed by forces counts as flying: it moves in any
//!   direction, as far per tick as its maximum speed allows. An avatar that falls and jumps (see `jump.rs`)
//!   rises no higher above the ground than a jump can lift it, but moves sideways in the air without limit.
//! - Keys are counted, but the cost of using them is considered only if every removal that a win requires
//!   costs some of the same resource (`payment`).
//!
//! The algorithm has four steps:
//!
//! 1. `meetings` lists the pairs of types that can collide, with the effects.
//! 2. From the collisions, `model` derives how each type can move by itself (`mobility`) and be moved by
//!    other types (`contact`). No cell is examined yet.
//! 3. `events` iterates until nothing changes. In each round, types spread over the cells (`flood`, `jump`),
//!    create other types (`makers`), and collide (`effects`).
//! 4. `tally` determines the terminations that can no longer hold.
//!
//! A round costs O(types × cells + meetings × cells / 64), and the number of rounds is about the number of
//! locks that open one after the other. Both the number of meetings and the number of examined cells are
//! limited. Beyond these limits, the result is coarse: every type that can occur is assumed to be everywhere.
//!
//! Tests in `tests/tests/it/analysis` play handwritten and random games, and check that no sprite is ever
//! outside its reach.

mod cells;
mod contact;
mod effects;
mod events;
mod flood;
mod jump;
mod makers;
mod meetings;
mod mobility;
mod model;
mod reasons;

use super::Analysis;
use super::futures::{PossibleFutures, Start};
use crate::analysis::goals::attain::Attainable;
use crate::analysis::interactions::encounter::timed_effects;
use crate::level::Level;
use crate::limits::MAX_SPRITES;
use crate::rules::SpriteType;
use crate::rules::class::SpriteClass;
use base::Seed;
use cells::{Board, Cells};
use events::{Events, Placed};
use flood::Flood;
use model::Model;
pub use reasons::cause::{Cause, Unpaid};
use reasons::chain::Chains;
pub use reasons::chain::{Blocker, Chain, Missing, Obstacle, Shortage, Source, Unreachable};
use reasons::tally::Tally;

/// For each type, the cells of one level in which its sprites can ever be. The cells are a proven
/// over-approximation: sprites are never in any other cell. Time, harm and crowding are ignored, so every
/// lock that can be opened counts as open, and obstacles that can disappear or move do not block the way.
///
/// Cells are indices into [`Level::cells`], row-major. A sprite is in every cell that it overlaps.
#[derive(Clone, Debug)]
pub struct Reach {
    board: Board,
    /// For each type, the cells in which its sprites can be between two ticks. Empty for types that cannot occur.
    rest: Vec<Cells>,
    /// For each type, the cells in which its sprites can be at some point in a tick.
    touch: Vec<Cells>,
    avatars: Vec<SpriteType>,
    impossible_goals: Vec<ImpossibleGoal>,
    can_win: bool,
    can_lose: bool,
    coarse: bool,
}

/// A termination that can never hold in a level, with the reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImpossibleGoal {
    /// The index into [`Analysis::goals`].
    pub goal: usize,
    /// The reason why the termination can never hold.
    pub cause: Cause,
}

impl Reach {
    /// Returns the columns and rows of the board. Cells are numbered row by row.
    pub fn size(&self) -> (usize, usize) {
        (self.board.columns as usize, self.board.rows as usize)
    }

    /// Returns the cells in which a sprite of the type can be between two ticks, in ascending order.
    pub fn cells(&self, stype: SpriteType) -> impl Iterator<Item = usize> + '_ {
        self.on_board(&self.rest[stype.index()])
    }

    /// Returns the cells in which a sprite of the type can be at some point in a tick, in ascending order. The result
    /// includes cells from which the sprite is moved back, and cells in which the sprite is removed.
    pub fn touched(&self, stype: SpriteType) -> impl Iterator<Item = usize> + '_ {
        self.on_board(&self.touch[stype.index()])
    }

    /// Returns `true` if a sprite of the type can be in a cell between two ticks.
    pub fn can_be(&self, stype: SpriteType, cell: usize) -> bool {
        self.rest[stype.index()].contains(self.board.of_level(cell))
    }

    /// Returns `true` if a sprite of the type can be in a cell at some point in a tick.
    pub fn can_touch(&self, stype: SpriteType, cell: usize) -> bool {
        self.touch[stype.index()].contains(self.board.of_level(cell))
    }

    /// Returns `true` if an avatar of any type can be in a cell between two ticks.
    pub fn avatar_reaches(&self, cell: usize) -> bool {
        self.avatars.iter().any(|&stype| self.can_be(stype, cell))
    }

    /// Returns `true` if an avatar of any type can be in a cell at some point in a tick, so that it touches
    /// the sprites there.
    pub fn avatar_touches(&self, cell: usize) -> bool {
        self.avatars.iter().any(|&stype| self.can_touch(stype, cell))
    }

    /// Returns, in order of priority, the terminations that provably never hold in this level, given the
    /// cells that its sprites can reach. Terminations that never hold in any level for other reasons are
    /// marked by [`Goal::attainable`](super::Goal::attainable).
    pub fn impossible_goals(&self) -> &[ImpossibleGoal] {
        &self.impossible_goals
    }

    /// Returns `false` only if winning this level is provably impossible.
    pub fn can_win(&self) -> bool {
        self.can_win
    }

    /// Returns `false` only if losing this level is provably impossible, disregarding the reference engine's
    /// own tick limit.
    pub fn can_lose(&self) -> bool {
        self.can_lose
    }

    /// Returns `true` if the rules or the level exceeded the work budget. In a coarse result, every type that
    /// can occur is assumed to be everywhere, and no termination is proven impossible.
    pub fn is_coarse(&self) -> bool {
        self.coarse
    }

    fn on_board<'a>(&'a self, cells: &'a Cells) -> impl Iterator<Item = usize> + 'a {
        let inner = cells.iter().filter(|&cell| !self.board.is_ring(cell));
        inner.map(|cell| self.board.on_level(cell))
    }
}

impl Analysis {
    /// Computes the cells of a level in which sprites of each type can ever be.
    ///
    /// Cost: O(types × cells + meetings × cells / 64) for each round in which locks open one after the other.
    /// Typical levels take less than a millisecond, and the largest levels a few hundredths of a second.
    /// Beyond a fixed amount of work, which takes a few tenths of a second, the result is
    /// [coarse](Reach::is_coarse).
    pub fn reach(&self, level: &Level) -> Reach {
        let (placed, board) = self.placed(level);
        let futures = self.prospect_of(&placed);
        let reached = self.settled(&futures, level, &placed, board, |events| self.reached(&events));
        reached.unwrap_or_else(|| self.everything(&futures, board))
    }

    /// Returns the reasons why winning terminations can never hold in a level: one chain of causes for each
    /// winning termination in [`Reach::impossible_goals`]. The result is empty if the [`Reach`] is coarse.
    /// Costs as much as [`Analysis::reach`], plus O(interactions × cells) per link.
    pub fn causes(&self, level: &Level) -> Vec<Chain> {
        let (placed, board) = self.placed(level);
        let futures = self.prospect_of(&placed);
        let chains = self.settled(&futures, level, &placed, board, |events| {
            let impossible_goals = self.reached(&events).impossible_goals.into_iter();
            let mut chains = Chains::of(self, events);
            let wins = impossible_goals.filter(|impossible_goal| self.goals[impossible_goal.goal].win);
            wins.map(|ImpossibleGoal { goal, cause }| chains.chain(goal, cause)).collect()
        });
        chains.unwrap_or_default()
    }

    /// Returns the sprites that a level places, and the level's board.
    fn placed(&self, level: &Level) -> (Placed, Board) {
        let board = Board { columns: level.columns() as i32, rows: level.rows() as i32 };
        let mut placed: Placed = vec![Vec::new(); self.game.0.types.len()];
        for (at, &symbol) in level.cells().iter().enumerate() {
            let cell = board.at((at % level.columns()) as i32, (at / level.columns()) as i32);
            for &stype in self.game.places(symbol) {
                match placed[stype.index()].last_mut() {
                    Some((last, count)) if *last == cell => *count += 1,
                    _ => placed[stype.index()].push((cell, 1)),
                }
            }
        }
        (placed, board)
    }

    /// Returns, for each type, whether its sprites may appear while the level is played.
    pub(crate) fn made_in(&self, level: &Level) -> Vec<bool> {
        self.prospect_of(&self.placed(level).0).made
    }

    fn prospect_of(&self, placed: &Placed) -> PossibleFutures<'_> {
        let rules = &*self.game.0;
        let existing = self.game.sprite_types().filter(|stype| !placed[stype.index()].is_empty()).collect();
        let held = Some(vec![false; rules.types.len()]);
        let start = Start { existing, scheduled: Start::scheduled(rules), held, ..Start::default() };
        PossibleFutures::of(rules, &self.facts, &self.encounters, start)
    }

    /// Computes the fixed point, and returns the result of `read` on it. Returns `None` if the work budget is
    /// exceeded.
    fn settled<T>(
        &self,
        futures: &PossibleFutures<'_>,
        level: &Level,
        placed: &Placed,
        board: Board,
        read: impl FnOnce(Events<'_>) -> T,
    ) -> Option<T> {
        let rules = &*self.game.0;
        let sprites: usize = placed.iter().flatten().map(|(_, count)| *count as usize).sum();
        if sprites > MAX_SPRITES {
            // If a level has too many sprites, some of them are never created.
            return None;
        }
        // The cells of a level have the same size for every seed.
        let block = self.game.start(level, Seed::from_text("reach")).block();
        let timed_effects = timed_effects(rules);
        let meetings = meetings::meetings(rules, futures, &timed_effects)?;
        let model = Model::of(rules, futures, &meetings, board, block)?;
        let mut flood = Flood::of(&model);
        for stype in self.game.sprite_types().filter(|stype| rules.types[stype.index()].class.is_some()) {
            for &(cell, _) in &placed[stype.index()] {
                flood.place(stype, cell);
            }
        }
        let mut events = Events::of(flood, placed);
        events.settle().then(|| read(events))
    }

    fn reached(&self, events: &Events<'_>) -> Reach {
        let flood = &events.flood;
        let (removable, made) = (&flood.removable, &flood.made);
        let tally =
            Tally { rules: &self.game.0, model: flood.model, placed: events.placed(), removable, made };
        let impossible_goal = |goal: usize| {
            let condition = &self.goals[goal].condition;
            let cause = tally.hinders(condition).or_else(|| self.unpaid(condition, events))?;
            Some(ImpossibleGoal { goal, cause })
        };
        let impossible_goals: Vec<ImpossibleGoal> =
            (0..self.goals.len()).filter_map(impossible_goal).collect();
        let cells = |of: fn(&flood::Region) -> &Cells| flood.regions.iter().map(of).cloned().collect();
        let (rest, touch) = (cells(|region| &region.rest), cells(|region| &region.touch));
        self.answer(flood.board, (rest, touch), impossible_goals, false)
    }

    fn everything(&self, futures: &PossibleFutures<'_>, board: Board) -> Reach {
        let all = |&exists: &bool| if exists { Cells::all(board) } else { Cells::default() };
        let rest: Vec<Cells> = futures.exists.iter().map(all).collect();
        let touch = rest.clone();
        self.answer(board, (rest, touch), Vec::new(), true)
    }

    fn answer(
        &self,
        board: Board,
        (rest, touch): (Vec<Cells>, Vec<Cells>),
        impossible_goals: Vec<ImpossibleGoal>,
        coarse: bool,
    ) -> Reach {
        // A level may place an avatar other than the one that the game intends.
        let is_avatar = |stype: &SpriteType| self.game.class(*stype).is_some_and(SpriteClass::is_avatar);
        let avatars = self.game.sprite_types().filter(is_avatar).collect();
        let hindered =
            |goal: usize| impossible_goals.iter().any(|impossible_goal| impossible_goal.goal == goal);
        let can_end = |win: bool| {
            // A termination may already hold when the level starts.
            self.can_end(win, |at, goal| goal.attainable != Attainable::Never && !hindered(at))
        };
        let (can_win, can_lose) = (can_end(true), can_end(false));
        Reach { board, rest, touch, avatars, impossible_goals, can_win, can_lose, coarse }
    }
}
