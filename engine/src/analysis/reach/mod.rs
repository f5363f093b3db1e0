//! Where in a level sprites of each type can be.
//!
//! A fixed point over the cells of a level, under the movement of the game itself: what walks in four ways, along a line,
//! straight ahead or by forces, what is pushed, carried, teleported or wrapped around, what is shot, spawned and
//! transformed into; what blocks whom until a key, a shot or a push ends it; what resources can be got.
//!
//! The answer is an over-approximation: what can happen is in it, and perhaps more. It is exact in these respects: walls
//! that nothing ends keep out what they stop (unless a later interaction of the same tick moves it in), what has to be
//! pushed moves only away from where its pusher can be (if both keep to whole cells and the pusher faces where it goes),
//! keys that are used up by taking are counted. It is generous in these:
//!
//! - Time does not count: what can be ended, some time, opens its cell from the start; two types that can be in a cell,
//!   each at some time, can meet there. A sprite that has to be at two places at once can be.
//! - What others do is not weighed: NPCs go wherever they are not stopped, pushed things are never in the way, and
//!   harm keeps nobody from going on.
//! - Continuous physics: what has a velocity that forces change goes in any direction, as far in a tick as its
//!   greatest speed allows: it flies. An avatar that falls and jumps (see `jump.rs`) gets no higher above what is solid
//!   than a jump lifts it, but in the air as far sideways as there is room.
//! - Keys are counted, but not what opening costs.
//!
//! How it is found: `meetings` lists which types can meet with what effect; `model` derives from that how each type moves
//! (`mobility` by itself, `contact` by others), before any cell is looked at. Then `events` goes round: types spread over
//! the cells (`flood`, `jump`), make others (`makers`), and meet (`effects`), until nothing is new; `tally` tells which
//! terminations that leaves impossible. A round costs O(types × cells + meetings × cells / 64), and there are about as
//! many rounds as locks open one behind the other. All of it is bounded: meetings by their number, the rounds by cells
//! looked at. What is more than that gets a coarse answer: everything that can come about is everywhere.
//!
//! That nothing is ever outside its reach is tested by playing (`tests/tests/analysis`): games that somebody wrote, and
//! games that nobody would.

mod cells;
mod chain;
mod contact;
mod effects;
mod events;
mod flood;
mod jump;
mod makers;
mod meetings;
mod mobility;
mod model;
mod tally;

use super::Analysis;
use super::attain::Attainable;
use super::encounter::clockwork;
use super::prospect::{Prospect, Start};
use crate::Seed;
use crate::game::SpriteType;
use crate::level::Level;
use crate::limits::MAX_SPRITES;
use cells::{Board, Cells};
use chain::Chains;
pub use chain::{Apart, Chain, Closed, Lack, Obstacle, Shortage, Source};
use events::{Events, Placed};
use flood::Flood;
use model::Model;
use tally::Tally;

/// Where in one level sprites of each type can ever be: too much rather than too little, so that what is left out is
/// proved. Time, harm and crowds are not weighed: what can be opened is open, and nothing is in the way for long.
///
/// Cells are indices into [`Level::cells`], row-major. A sprite is in every cell that it overlaps.
#[derive(Clone, Debug)]
pub struct Reach {
    board: Board,
    /// By type: between two ticks; empty for types that cannot come about.
    rest: Vec<Cells>,
    /// By type: at some moment of a tick.
    touch: Vec<Cells>,
    avatars: Vec<SpriteType>,
    hindrances: Vec<Hindrance>,
    can_win: bool,
    can_lose: bool,
    coarse: bool,
}

/// A termination that can never hold in a level, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hindrance {
    /// Index into [`Analysis::goals`].
    pub goal: usize,
    /// Why not.
    pub cause: Cause,
}

/// Why a termination can never hold in a level.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Cause {
    /// These sprites, each with the cell that the level places it in, can never be ended, and are too many.
    Stay(Vec<(SpriteType, usize)>),
    /// There can never be more sprites of its types than so many.
    AtMost(i64),
}

impl Reach {
    /// The cells in which a sprite of the type can be between two ticks, in order.
    pub fn cells(&self, stype: SpriteType) -> impl Iterator<Item = usize> + '_ {
        self.on_board(&self.rest[stype.index()])
    }

    /// The cells in which a sprite of the type can be at some moment of a tick, in order: also those that it is thrown
    /// back from, and those in which it ends.
    pub fn touched(&self, stype: SpriteType) -> impl Iterator<Item = usize> + '_ {
        self.on_board(&self.touch[stype.index()])
    }

    /// Whether a sprite of the type can be in a cell between two ticks.
    pub fn can_be(&self, stype: SpriteType, cell: usize) -> bool {
        self.rest[stype.index()].contains(self.inner(cell))
    }

    /// Whether a sprite of the type can be in a cell at some moment of a tick.
    pub fn can_touch(&self, stype: SpriteType, cell: usize) -> bool {
        self.touch[stype.index()].contains(self.inner(cell))
    }

    /// Whether an avatar, of whatever type, can be in a cell between two ticks.
    pub fn avatar_reaches(&self, cell: usize) -> bool {
        self.avatars.iter().any(|&stype| self.can_be(stype, cell))
    }

    /// Whether an avatar, of whatever type, can be in a cell at some moment of a tick, so that it meets what is there.
    pub fn avatar_touches(&self, cell: usize) -> bool {
        self.avatars.iter().any(|&stype| self.can_touch(stype, cell))
    }

    /// The terminations that are proved never to hold in this level, by where its sprites can be; in order. (Some hold in
    /// no level, for other reasons: see [`Goal::attainable`](super::Goal::attainable).)
    pub fn hindrances(&self) -> &[Hindrance] {
        &self.hindrances
    }

    /// Whether this level can be won. False only if it is proved that it cannot.
    pub fn can_win(&self) -> bool {
        self.can_win
    }

    /// Whether this level can be lost, the reference's own limit of ticks apart. False only if it is proved that it cannot.
    pub fn can_lose(&self) -> bool {
        self.can_lose
    }

    /// Whether the rules or the level were too much to follow: then every type that can come about is everywhere, and no
    /// termination is hindered.
    pub fn is_coarse(&self) -> bool {
        self.coarse
    }

    fn inner(&self, cell: usize) -> usize {
        let columns = self.board.columns as usize;
        self.board.at((cell % columns) as i32, (cell / columns) as i32)
    }

    fn on_board<'a>(&'a self, cells: &'a Cells) -> impl Iterator<Item = usize> + 'a {
        let inner = cells.iter().filter(|&cell| !self.board.is_ring(cell));
        inner.map(|cell| self.board.on_level(cell))
    }
}

impl Analysis {
    /// Where in a level sprites of each type can be, from its start on. Cost: O(types × cells + meetings × cells / 64) for
    /// each round in which locks open one behind the other: below a millisecond for usual levels, some hundredths of a
    /// second for the largest ones. What would take more than a fixed amount of work, a few tenths of a second, gets a
    /// [coarse](Reach::is_coarse) answer.
    pub fn reach(&self, level: &Level) -> Reach {
        let (placed, board) = self.placed(level);
        let prospect = self.prospect_of(&placed);
        let reached = self.settled(&prospect, level, &placed, board, |events| self.reached(&events));
        reached.unwrap_or_else(|| self.everything(&prospect, board))
    }

    /// Why terminations that win can never hold in a level, a chain of causes for each of [`Reach::hindrances`] that wins; none
    /// where the [`Reach`] is coarse. Cost: that of [`Analysis::reach`], and O(interactions × cells) for each link.
    pub fn causes(&self, level: &Level) -> Vec<Chain> {
        let (placed, board) = self.placed(level);
        let prospect = self.prospect_of(&placed);
        let chains = self.settled(&prospect, level, &placed, board, |events| {
            let hindrances = self.reached(&events).hindrances.into_iter();
            let mut chains = Chains::of(self, events);
            let wins = hindrances.filter(|hindrance| self.goals[hindrance.goal].win);
            wins.map(|Hindrance { goal, cause }| chains.chain(goal, cause)).collect()
        });
        chains.unwrap_or_default()
    }

    /// The sprites that the level places, and its board.
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

    fn prospect_of(&self, placed: &Placed) -> Prospect<'_> {
        let rules = &*self.game.0;
        let there = self.game.sprite_types().filter(|stype| !placed[stype.index()].is_empty()).collect();
        let held = Some(vec![false; rules.types.len()]);
        let start = Start { there, planned: Start::planned(rules), held, ..Start::default() };
        Prospect::of(rules, &self.facts, &self.encounters, start)
    }

    /// Follows all that can happen until nothing is new, and reads an answer off; none if that is too much.
    fn settled<T>(
        &self,
        prospect: &Prospect<'_>,
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
        // Whatever the seed, the cells of a level have the same size.
        let block = self.game.start(level, Seed::from_text("reach")).block();
        let clockwork = clockwork(rules);
        let meetings = meetings::meetings(rules, prospect, &clockwork)?;
        let model = Model::of(rules, prospect, &meetings, board, block)?;
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
        let (ended, made) = (&flood.ended, &flood.made);
        let tally = Tally { rules: &self.game.0, model: flood.model, placed: events.placed(), ended, made };
        let hindrance =
            |goal: usize| Some(Hindrance { goal, cause: tally.hinders(&self.goals[goal].condition)? });
        let hindrances: Vec<Hindrance> = (0..self.goals.len()).filter_map(hindrance).collect();
        let cells = |of: fn(&flood::Region) -> &Cells| flood.regions.iter().map(of).cloned().collect();
        let (rest, touch) = (cells(|region| &region.rest), cells(|region| &region.touch));
        self.answer(flood.board, (rest, touch), hindrances, false)
    }

    fn everything(&self, prospect: &Prospect<'_>, board: Board) -> Reach {
        let all = |&there: &bool| if there { Cells::all(board) } else { Cells::default() };
        let rest: Vec<Cells> = prospect.there.iter().map(all).collect();
        let touch = rest.clone();
        self.answer(board, (rest, touch), Vec::new(), true)
    }

    fn answer(
        &self,
        board: Board,
        (rest, touch): (Vec<Cells>, Vec<Cells>),
        hindrances: Vec<Hindrance>,
        coarse: bool,
    ) -> Reach {
        let avatars = self.avatars.iter().map(|avatar| avatar.stype).collect();
        let hindered = |goal: usize| hindrances.iter().any(|hindrance| hindrance.goal == goal);
        let can_end = |win: bool| {
            // A level may start so that a termination holds.
            self.can_end(win, |at, goal| goal.attainable != Attainable::Never && !hindered(at))
        };
        let (can_win, can_lose) = (can_end(true), can_end(false));
        Reach { board, rest, touch, avatars, hindrances, can_win, can_lose, coarse }
    }
}

#[cfg(test)]
mod tests;
