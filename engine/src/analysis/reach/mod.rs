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

mod cells;
mod events;
mod flood;
mod jump;
mod meetings;
mod mobility;

use super::attain::is_mortal;
use super::goal::Condition;
use super::prospect::{Prospect, Start};
use super::{Analysis, Goal};
use crate::game::SpriteType;
use crate::level::Level;
use cells::{Board, Cells};
use events::{Events, Placed};
use flood::Flood;
use mobility::Model;

/// Cells looked at, at most; with more the answer is coarse. Usual levels take some ten thousands.
const BUDGET: u64 = 1 << 24;

/// Where in one level sprites of each type can be: see the [module](self) for what is exact and what is generous.
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
    unreachable: Vec<usize>,
    coarse: bool,
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

    /// The terminations, as indices into [`Analysis::goals`], that can never hold in this level: too many of the sprites
    /// that must go can never be ended, or too few can ever be there.
    pub fn unreachable_goals(&self) -> &[usize] {
        &self.unreachable
    }

    /// Whether the rules or the level were too much to follow: then every type that can come about is everywhere, and no
    /// termination counts as unreachable.
    pub fn is_coarse(&self) -> bool {
        self.coarse
    }

    fn inner(&self, cell: usize) -> usize {
        let columns = self.board.columns as usize;
        self.board.at((cell % columns) as i32, (cell / columns) as i32)
    }

    fn on_board<'a>(&'a self, cells: &'a Cells) -> impl Iterator<Item = usize> + 'a {
        let inner = cells.iter().filter(|&cell| !self.board.is_ring(cell));
        inner.map(|cell| {
            let (x, y) = self.board.place(cell);
            (y * self.board.columns + x) as usize
        })
    }
}

impl Analysis {
    /// Where in a level sprites of each type can be. Cost: O(types × cells + meetings × cells), times the rounds in which
    /// locks open one behind the other; some milliseconds for usual levels. What would take more than a fixed amount of
    /// work gets a [coarse](Reach::is_coarse) answer.
    pub fn reach(&self, level: &Level) -> Reach {
        let rules = &*self.game.0;
        let board = Board { columns: level.columns() as i32, rows: level.rows() as i32 };
        let mut placed: Placed = vec![Vec::new(); rules.types.len()];
        for (at, &symbol) in level.cells().iter().enumerate() {
            let cell = board.at((at % level.columns()) as i32, (at / level.columns()) as i32);
            for &stype in self.game.places(symbol) {
                match placed[stype.index()].last_mut() {
                    Some((last, count)) if *last == cell => *count += 1,
                    _ => placed[stype.index()].push((cell, 1)),
                }
            }
        }
        let there = self.game.sprite_types().filter(|stype| !placed[stype.index()].is_empty()).collect();
        let held = Some(vec![false; rules.types.len()]);
        let start = Start { there, planned: Start::planned(rules), held, ..Start::default() };
        let prospect = Prospect::of(rules, &self.facts, &self.encounters, start);
        self.follow(&prospect, &placed, board, self.game.block(level))
            .unwrap_or_else(|| self.everything(&prospect, board))
    }

    fn follow(&self, prospect: &Prospect<'_>, placed: &Placed, board: Board, block: i32) -> Option<Reach> {
        let rules = &*self.game.0;
        let meetings = meetings::meetings(rules, prospect)?;
        let model = Model::of(rules, prospect, &meetings, board, block)?;
        let mut flood = Flood::of(&model);
        for stype in self.game.sprite_types().filter(|stype| rules.types[stype.index()].class.is_some()) {
            for &(cell, _) in &placed[stype.index()] {
                flood.place(stype, cell);
            }
        }
        let mut events = Events::of(flood, placed);
        if !events.settle(BUDGET) {
            return None;
        }
        let Flood { regions, ended, made, .. } = events.flood;
        let never = |goal: &Goal| {
            let tally = Tally { analysis: self, model: &model, placed, ended: &ended, made: &made };
            tally.never_holds(goal)
        };
        let unreachable = (0..self.goals.len()).filter(|&at| never(&self.goals[at])).collect();
        let (rest, touch) = regions.into_iter().map(|region| (region.rest, region.touch)).unzip();
        Some(Reach { board, rest, touch, avatars: self.avatar_types(), unreachable, coarse: false })
    }

    fn everything(&self, prospect: &Prospect<'_>, board: Board) -> Reach {
        let all = |&there: &bool| if there { Cells::all(board) } else { Cells::default() };
        let rest: Vec<Cells> = prospect.there.iter().map(all).collect();
        let (touch, avatars) = (rest.clone(), self.avatar_types());
        Reach { board, rest, touch, avatars, unreachable: Vec::new(), coarse: true }
    }

    fn avatar_types(&self) -> Vec<SpriteType> {
        self.avatars.iter().map(|avatar| avatar.stype).collect()
    }
}

/// How many sprites there can be in a level, at least and at most.
struct Tally<'a> {
    analysis: &'a Analysis,
    model: &'a Model<'a>,
    placed: &'a Placed,
    ended: &'a [Cells],
    made: &'a [bool],
}

impl Tally<'_> {
    fn never_holds(&self, goal: &Goal) -> bool {
        let types = goal.condition.types();
        let least: i64 = types.iter().map(|&stype| self.least(stype)).sum();
        let most: Option<i64> = types.iter().map(|&stype| self.most(stype)).sum();
        let below = |limit: i32| most.is_some_and(|most| most < i64::from(limit));
        match goal.condition {
            Condition::AtMost(_, limit) => least > i64::from(limit),
            Condition::AtLeast(_, limit) => below(limit),
            Condition::Exactly(_, limit) => least > i64::from(limit) || below(limit),
            Condition::Tick(_) => false,
        }
    }

    fn count(&self, stype: SpriteType) -> i64 {
        self.placed[stype.index()].iter().map(|(_, count)| i64::from(*count)).sum()
    }

    /// Sprites of the type that nothing ever ends.
    fn least(&self, stype: SpriteType) -> i64 {
        let rules = &*self.analysis.game.0;
        let info = &rules.types[stype.index()];
        let single = info.path.iter().any(|&stype| rules.types[stype.index()].singleton);
        if single || is_mortal(rules, stype) || !self.model.there[stype.index()] {
            return 0;
        }
        let ended = &self.ended[stype.index()];
        if !self.model.of_type(stype).fixed {
            return if ended.is_empty() { self.count(stype) } else { 0 };
        }
        let stays = self.placed[stype.index()].iter().filter(|(cell, _)| !ended.contains(*cell));
        stays.map(|(_, count)| i64::from(*count)).sum()
    }

    /// Sprites of the type that can be there at a time; none if there is no telling.
    fn most(&self, stype: SpriteType) -> Option<i64> {
        (!self.made[stype.index()]).then(|| self.count(stype))
    }
}

#[cfg(test)]
mod tests;
