//! The messages to an external program. Each message is one line of JSON (`docs/how-to/agents.md`).

use crate::commitment::Commitment;
use crate::direction::direction_name;
use crate::track::SeriesPlace;
use crate::turn::Played;
use engine::{Action, MoverView, Observation, Outcome};
use serde::Serialize;
use std::collections::BTreeMap;

/// The protocol version. It is incremented whenever agents written for an older version might misread a
/// message.
pub const PROTOCOL: u32 = 1;

#[derive(Debug, Serialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub(super) enum Message<'a> {
    /// The first message, with the facts that apply to the entire episode. No answer is expected.
    Hello {
        /// The protocol version: [`PROTOCOL`].
        protocol: u32,
        rules: &'a str,
        /// The meanings of the grid symbols.
        legend: BTreeMap<char, Vec<&'a str>>,
        actions: &'a [Action],
        columns: usize,
        rows: usize,
        /// The maximum number of actions in the episode.
        step_limit: u64,
        /// The number of actions per answer, or `all`. If the field is missing, each answer has one action.
        #[serde(skip_serializing_if = "Commitment::is_one")]
        commit: Commitment,
        /// The maximum number of output tokens per answer, including reasoning, if there is a limit.
        #[serde(skip_serializing_if = "Option::is_none")]
        max_output_tokens: Option<u32>,
        /// The level's position in a series, if the process plays a series.
        #[serde(skip_serializing_if = "Option::is_none")]
        series: Option<SeriesPlace>,
    },
    /// The last question in a series. The answer lists the sprite types for which each fact is predicted, as
    /// in `{"kills": […], "stops": […], "goes": […], "scores": […]}`.
    Predict {
        /// The number of actions played in the last level.
        turn: u64,
        kinds: Vec<&'a str>,
    },
    /// The current observation. The answer is `{"action": …}`, or `{"actions": […]}` if the player commits to several
    /// actions. No answer is expected if the turn was played before an interruption.
    Turn {
        /// The number of actions played before this decision.
        turn: u64,
        #[serde(flatten)]
        seen: Seen<'a>,
        actions: &'a [Action],
        /// The actions since the last decision, with their results, if the player commits to several actions.
        #[serde(skip_serializing_if = "Option::is_none")]
        played: Option<Vec<Tick>>,
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        past: Option<Past>,
    },
    /// A complaint about an unusable answer. A new answer is expected.
    Invalid { turn: u64, message: String },
    /// The last message, with the episode's result. No answer is expected.
    End {
        /// The number of actions played.
        turn: u64,
        #[serde(flatten)]
        seen: Seen<'a>,
        /// The outcome: `won`, `lost`, `ended`, the reason why the engine stopped the episode, or `ongoing`
        /// if the step limit was reached.
        outcome: Outcome,
    },
}

/// The fields that mark a turn as played before an interruption.
#[derive(Debug, Serialize)]
pub(super) struct Past {
    /// Always `true`. A past turn expects no answer.
    pub(super) past: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) action: Option<Action>,
    #[serde(rename = "committed", skip_serializing_if = "Option::is_none")]
    pub(super) actions: Option<Vec<Action>>,
}

/// An action played since the last decision.
#[derive(Debug, Serialize)]
pub(super) struct Tick {
    action: Action,
    /// `true` if the action was available. If it was not, the player did nothing in this tick.
    available: bool,
    cell: Option<(i32, i32)>,
    reward: f64,
}

impl Tick {
    pub(super) fn of(played: &Played) -> Tick {
        let Played { asked, is_unavailable, avatar, reward } = *played;
        Tick { action: asked, available: !is_unavailable, cell: avatar, reward }
    }
}

#[derive(Debug, Serialize)]
pub(super) struct Seen<'a> {
    /// The board's rows from top to bottom, each as a string of symbols.
    grid: Vec<String>,
    /// All visible sprites on the board, by name.
    sprites: Vec<Sprites<'a>>,
    avatar: Option<Avatar<'a>>,
    /// The sprites that move in a direction of their own.
    movers: Vec<Mover<'a>>,
    resources: BTreeMap<&'a str, i32>,
    /// The current score, or `None` if the score is shown only at the end.
    score: Option<f64>,
    /// The change in score since the last decision.
    reward: Option<f64>,
    tick: u32,
}

#[derive(Debug, Serialize)]
struct Sprites<'a> {
    name: &'a str,
    /// The column and row of each cell that the sprites overlap, row by row. A cell is listed once per
    /// sprite.
    cells: Vec<(usize, usize)>,
}

#[derive(Debug, Serialize)]
struct Avatar<'a> {
    name: &'a str,
    /// The avatar's health points, or 0 in games without health points.
    health: i32,
    cell: (i32, i32),
    /// The direction: `up`, `left`, `down` or `right`, or `None` for other directions.
    facing: Option<&'static str>,
}

#[derive(Debug, Serialize)]
struct Mover<'a> {
    name: &'a str,
    cell: (i32, i32),
    /// The direction: `up`, `left`, `down` or `right`, or `None` for other directions.
    facing: Option<&'static str>,
}

impl<'a> Seen<'a> {
    /// Combines an observation with its grid and the change in score since the last decision. If `reward` is
    /// `None`, the score is hidden.
    pub(super) fn of(observation: &'a Observation, grid: Vec<String>, reward: Option<f64>) -> Seen<'a> {
        let mut cells: BTreeMap<&str, Vec<(usize, usize)>> = BTreeMap::new();
        for (at, names) in observation.cells.iter().enumerate() {
            for name in names {
                cells.entry(name).or_default().push((at % observation.columns, at / observation.columns));
            }
        }
        let mover = |mover: &'a MoverView| Mover {
            name: &mover.name,
            cell: (mover.column, mover.row),
            facing: direction_name(mover.facing),
        };
        Seen {
            grid,
            sprites: cells.into_iter().map(|(name, cells)| Sprites { name, cells }).collect(),
            avatar: observation.avatar.as_ref().map(|avatar| Avatar {
                name: &avatar.name,
                health: avatar.health,
                cell: (avatar.column, avatar.row),
                facing: direction_name(avatar.facing),
            }),
            movers: observation.movers.iter().map(mover).collect(),
            resources: observation.resources.iter().map(|(name, amount)| (name.as_str(), *amount)).collect(),
            score: reward.map(|_| observation.score),
            reward,
            tick: observation.ticks,
        }
    }
}
