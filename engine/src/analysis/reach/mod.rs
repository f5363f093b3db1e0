//! Reachability: the cells of a level where sprites of each type can be.
//!
//! A fixed point over the cells of a level, under the movement rules of the game itself: walking in four directions,
//! along a line, straight ahead or by forces; pushing, carrying, teleporting and wrapping around; shooting, spawning
//! and transforming; obstacles until a key, a shot or a push removes them; and the resources that can be obtained.
//!
//! The answer is an over-approximation: it contains everything that can happen, and perhaps more. It is exact in these
//! respects: walls that nothing removes keep out the sprites that they stop (unless a later interaction of the same
//! tick moves one in); pushed sprites move only away from cells where their pusher can be (if both keep to whole cells
//! and the pusher faces the direction of its move); keys that are used up by taking are counted. It over-approximates
//! in these:
//!
//! - Time is ignored: a sprite that can ever be removed leaves its cell open from the start; two types that can be in a
//!   cell, each at some time, can meet there. A sprite that has to be at two places at once can be.
//! - The behaviour of others is ignored: NPCs go wherever they are not stopped, pushed sprites are never in the way,
//!   and harm stops no sprite.
//! - Continuous physics: a sprite whose velocity is changed by forces moves in any direction, as far in a tick as its
//!   greatest speed allows: it flies. An avatar that falls and jumps (see `jump.rs`) gets no higher above the ground
//!   than a jump lifts it, but in the air it moves sideways without limit.
//! - Keys are counted, and the cost of opening only where every removal that a win needs takes some of one resource
//!   (`payment`).
//!
//! Algorithm: `meetings` lists which types can meet with what effect; `model` derives from that the movement of each
//! type (`mobility` by itself, `contact` by others), before any cell is examined. Then `events` iterates: types spread
//! over the cells (`flood`, `jump`), make others (`makers`), and meet (`effects`), until nothing is new; `tally`
//! determines the terminations that this makes impossible. A round costs O(types × cells + meetings × cells / 64), and
//! there are about as many rounds as locks that open one after the other. All of it is bounded: the meetings by their
//! number, the rounds by the number of cells examined. Beyond that the answer is coarse: every type that can occur is
//! everywhere.
//!
//! Tests check by playing (`tests/tests/it/analysis`) that nothing is ever outside its reach, in handwritten and in random
//! games.

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

/// The cells of one level where sprites of each type can ever be. This is an over-approximation: it is proved that
/// sprites are never anywhere else. Time, harm and crowding are ignored: whatever can be opened is open, and nothing is
/// in the way for long.
///
/// Cells are indices into [`Level::cells`], row-major. A sprite is in every cell that it overlaps.
#[derive(Clone, Debug)]
pub struct Reach {
    board: Board,
    /// By type: between two ticks; empty for types that cannot occur.
    rest: Vec<Cells>,
    /// By type: at some moment of a tick.
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
    /// Index into [`Analysis::goals`].
    pub goal: usize,
    /// The reason.
    pub cause: Cause,
}

impl Reach {
    /// The columns and rows of the board; cells are numbered by rows.
    pub fn size(&self) -> (usize, usize) {
        (self.board.columns as usize, self.board.rows as usize)
    }

    /// The cells in which a sprite of the type can be between two ticks, in order.
    pub fn cells(&self, stype: SpriteType) -> impl Iterator<Item = usize> + '_ {
        self.on_board(&self.rest[stype.index()])
    }

    /// The cells in which a sprite of the type can be at some moment of a tick, in order, including those that it is
    /// moved back from and those in which it is removed.
    pub fn touched(&self, stype: SpriteType) -> impl Iterator<Item = usize> + '_ {
        self.on_board(&self.touch[stype.index()])
    }

    /// Returns `true` if a sprite of the type can be in a cell between two ticks.
    pub fn can_be(&self, stype: SpriteType, cell: usize) -> bool {
        self.rest[stype.index()].contains(self.board.of_level(cell))
    }

    /// Returns `true` if a sprite of the type can be in a cell at some moment of a tick.
    pub fn can_touch(&self, stype: SpriteType, cell: usize) -> bool {
        self.touch[stype.index()].contains(self.board.of_level(cell))
    }

    /// Returns `true` if an avatar of any type can be in a cell between two ticks.
    pub fn avatar_reaches(&self, cell: usize) -> bool {
        self.avatars.iter().any(|&stype| self.can_be(stype, cell))
    }

    /// Returns `true` if an avatar of any type can be in a cell at some moment of a tick, so that it meets the sprites
    /// there.
    pub fn avatar_touches(&self, cell: usize) -> bool {
        self.avatars.iter().any(|&stype| self.can_touch(stype, cell))
    }

    /// The terminations that are proved never to hold in this level, given the cells that its sprites can reach; in
    /// order. (Some hold in no level, for other reasons: see [`Goal::attainable`](super::Goal::attainable).)
    pub fn impossible_goals(&self) -> &[ImpossibleGoal] {
        &self.impossible_goals
    }

    /// Returns `false` only if it is proved that this level cannot be won.
    pub fn can_win(&self) -> bool {
        self.can_win
    }

    /// Returns `false` only if it is proved that this level cannot be lost, the reference's own limit of ticks apart.
    pub fn can_lose(&self) -> bool {
        self.can_lose
    }

    /// Returns `true` if the rules or the level exceeded the work budget: then every type that can occur is everywhere,
    /// and no termination is hindered.
    pub fn is_coarse(&self) -> bool {
        self.coarse
    }

    fn on_board<'a>(&'a self, cells: &'a Cells) -> impl Iterator<Item = usize> + 'a {
        let inner = cells.iter().filter(|&cell| !self.board.is_ring(cell));
        inner.map(|cell| self.board.on_level(cell))
    }
}

impl Analysis {
    /// Returns the cells of a level where sprites of each type can be, from its start on. Cost: O(types × cells +
    /// meetings × cells / 64) for each round in which locks open one after the other: below a millisecond for usual
    /// levels, some hundredths of a second for the largest ones. Beyond a fixed amount of work, a few tenths of a
    /// second, the answer is [coarse](Reach::is_coarse).
    pub fn reach(&self, level: &Level) -> Reach {
        let (placed, board) = self.placed(level);
        let futures = self.prospect_of(&placed);
        let reached = self.settled(&futures, level, &placed, board, |events| self.reached(&events));
        reached.unwrap_or_else(|| self.everything(&futures, board))
    }

    /// Returns the reasons why winning terminations can never hold in a level: a chain of causes for each winning one
    /// of [`Reach::impossible_goals`]; none if the [`Reach`] is coarse. Cost: that of [`Analysis::reach`], and O(interactions
    /// × cells) for each link.
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

    /// Returns the sprites that the level places, and its board.
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

    /// By type: sprites of it may appear in play on a level.
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

    /// Runs the fixed point to the end and reads an answer off; none if it exceeds the work budget.
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
            // Not all of them are made.
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
        // A level may place another avatar than the game has in mind.
        let is_avatar = |stype: &SpriteType| self.game.class(*stype).is_some_and(SpriteClass::is_avatar);
        let avatars = self.game.sprite_types().filter(is_avatar).collect();
        let hindered =
            |goal: usize| impossible_goals.iter().any(|impossible_goal| impossible_goal.goal == goal);
        let can_end = |win: bool| {
            // A level may start with a termination that already holds.
            self.can_end(win, |at, goal| goal.attainable != Attainable::Never && !hindered(at))
        };
        let (can_win, can_lose) = (can_end(true), can_end(false));
        Reach { board, rest, touch, avatars, impossible_goals, can_win, can_lose, coarse }
    }
}
