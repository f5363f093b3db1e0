//! What is said to a process, a line of JSON each (`docs/agents.md`).

use crate::encoding::direction_name;
use engine::{Action, Observation, Outcome};
use serde::Serialize;
use std::collections::BTreeMap;

/// The version of the protocol: bumped when an agent that was written for an older one could misread a message.
pub const PROTOCOL: u32 = 1;

/// A message to the process.
#[derive(Debug, Serialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub(super) enum Message<'a> {
    /// The first: what stands for the whole episode. No answer is expected.
    Hello {
        /// [`PROTOCOL`].
        protocol: u32,
        /// The rules in plain English.
        rules: &'a str,
        /// What the symbols of the grid mean.
        legend: BTreeMap<char, Vec<&'a str>>,
        /// All actions.
        actions: &'a [Action],
        /// Columns of the board.
        columns: usize,
        /// Rows of the board.
        rows: usize,
        /// Decisions at most.
        step_limit: u64,
    },
    /// What is seen now: `{"action": …}` is expected, unless the turn is past.
    Turn {
        /// Decisions before this one.
        turn: u64,
        #[serde(flatten)]
        seen: Seen<'a>,
        /// What can be chosen.
        actions: &'a [Action],
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        past: Option<Past>,
    },
    /// The last answer was none; another one is expected.
    Invalid {
        /// Of the turn.
        turn: u64,
        /// What is wrong with it.
        message: String,
    },
    /// The last: what has come of it. No answer is expected.
    End {
        /// Decisions that were made.
        turn: u64,
        #[serde(flatten)]
        seen: Seen<'a>,
        /// `won`, `lost`, `ended` or a reason to stop; `ongoing` if the limit of steps was met.
        outcome: Outcome,
    },
}

/// A turn that was played before an interruption.
#[derive(Debug, Serialize)]
pub(super) struct Past {
    /// True: nothing is asked.
    pub(super) past: bool,
    /// What was played.
    pub(super) action: Action,
}

/// What is seen.
#[derive(Debug, Serialize)]
pub(super) struct Seen<'a> {
    /// The board, a string of symbols for each row, from the top.
    grid: Vec<String>,
    /// Everything visible on it, by name.
    sprites: Vec<Sprites<'a>>,
    /// You, while you are on the board.
    avatar: Option<Avatar<'a>>,
    /// What you hold.
    resources: BTreeMap<&'a str, i32>,
    /// Your score.
    score: f64,
    /// By how much the score has changed with the last action.
    reward: f64,
    /// Ticks played.
    tick: u32,
}

/// The sprites of one name.
#[derive(Debug, Serialize)]
struct Sprites<'a> {
    name: &'a str,
    /// Column and row of the cells that they touch, row by row; a cell once for each of them.
    cells: Vec<(usize, usize)>,
}

/// Where the avatar is.
#[derive(Debug, Serialize)]
struct Avatar<'a> {
    name: &'a str,
    /// Health points; 0 in games without.
    health: i32,
    /// Column and row.
    cell: (i32, i32),
    /// `up`, `left`, `down`, `right`; none for any other.
    facing: Option<&'static str>,
}

impl<'a> Seen<'a> {
    /// An observation with its grid and what the last action gained.
    pub(super) fn of(observation: &'a Observation, grid: Vec<String>, reward: f64) -> Seen<'a> {
        let mut cells: BTreeMap<&str, Vec<(usize, usize)>> = BTreeMap::new();
        for (at, names) in observation.cells.iter().enumerate() {
            for name in names {
                cells.entry(name).or_default().push((at % observation.columns, at / observation.columns));
            }
        }
        Seen {
            grid,
            sprites: cells.into_iter().map(|(name, cells)| Sprites { name, cells }).collect(),
            avatar: observation.avatar.as_ref().map(|avatar| Avatar {
                name: &avatar.name,
                health: avatar.health,
                cell: (avatar.column, avatar.row),
                facing: direction_name(avatar.facing),
            }),
            resources: observation.resources.iter().map(|(name, amount)| (name.as_str(), *amount)).collect(),
            score: observation.score,
            reward,
            tick: observation.ticks,
        }
    }
}
