//! The template data for a turn.

use super::{Encodings, PromptSettings, PromptStyle, Rules};
use crate::direction::direction_name;
use crate::encoding;
use crate::legend::{Entry, Legend};
use crate::turn::{Played, Turn};
use engine::describe::plural;
use engine::{Action, AvatarView, Observation};
use itertools::Itertools;
use render::EMPTY;
use serde_json::{Value, json};

/// A turn, and the data needed to render it.
pub(super) struct View<'a> {
    /// The data about the end of the previous level, if any.
    pub(super) previous: Option<Value>,
    /// The highest possible score, if it is known.
    pub(super) most_points: Option<i64>,
    pub(super) legend: &'a Legend,
    pub(super) settings: &'a PromptSettings,
    /// The actions listed in the static part.
    pub(super) actions: &'a [Action],
    /// `true` if the game has resources that the avatar can hold.
    pub(super) holding: bool,
    pub(super) turn: &'a Turn<'a>,
    /// The observation with the names shown to the player.
    pub(super) now: &'a Observation,
    pub(super) before: Option<&'a Observation>,
    /// The last actions played, oldest first.
    pub(super) recent: Vec<Action>,
}

impl View<'_> {
    pub(super) fn data(&self) -> Value {
        let (now, turn) = (self.now, self.turn);
        let last = u64::from(now.ticks) + turn.limit.saturating_sub(turn.number);
        // A prompt without rules must not reveal when a Timeout ends the game.
        let limit = match self.settings.rules {
            Rules::None => u64::MAX,
            Rules::Described | Rules::Vgdl => turn.subject.game.time_limit(),
        };
        let mut data = json!({
            "settings": self.settings,
            "tick": now.ticks,
            "last_tick": last.min(limit),
            "score": now.score.to_string(),
            "most_points": self.most_points,
            "avatar": now.avatar.as_ref().map(avatar),
            "holds": self.holding.then(|| holds(now)),
            "reward": turn.before.map(|before| signed(before.reward)),
        });
        let more = match self.settings.style {
            PromptStyle::Standard => self.standard(),
            PromptStyle::Reference => self.reference(),
            PromptStyle::Discover => self.discover(),
        };
        if let (Value::Object(data), Value::Object(more)) = (&mut data, more) {
            data.extend(more);
        }
        data
    }

    fn standard(&self) -> Value {
        let (now, legend) = (self.now, self.legend);
        let Encodings { grid, spaced, grounding, coordinates, rotated, json, image, .. } =
            self.settings.encodings;
        let offered = |action: &&Action| self.turn.actions.contains(action);
        let actions: Vec<String> = self.actions.iter().filter(offered).map(ToString::to_string).collect();
        // Forecasts reveal rules.
        let has_rules = self.settings.rules != Rules::None;
        json!({
            // No actions are offered after the end of an episode.
            "actions_now": (!actions.is_empty() && actions.len() < self.actions.len()).then_some(actions),
            "feedback": (self.settings.has_feedback() && self.turn.commit.is_one()).then(|| self.feedback()).flatten(),
            "played": if self.turn.commit.is_one() { Vec::new() } else { self.played() },
            "grid": grid.then(|| board(encoding::grid(now, legend), spaced)),
            "stacks": if grid { encoding::stacks(now, legend) } else { Vec::new() },
            "grounding": if grounding { encoding::grounding(now, legend) } else { Vec::new() },
            "directions": if grounding { encoding::directions(now, legend) } else { Vec::new() },
            "soon": if grounding && has_rules { encoding::soon(now, legend) } else { Vec::new() },
            "coordinates": if coordinates { encoding::coordinates(now, legend) } else { Vec::new() },
            "rotated": rotated.then(|| board(encoding::rotated(now, legend), spaced)),
            "json": json.then(|| encoding::json(now, legend)),
            "image": image,
        })
    }

    /// Returns the data about the previous action's result.
    fn feedback(&self) -> Option<Value> {
        let (before, played) = (self.before?, self.turn.before?);
        let (from, to) = (before.avatar.as_ref(), self.now.avatar.as_ref());
        let both = from.zip(to);
        let facing = |avatar: &AvatarView| direction_name(avatar.facing);
        Some(json!({
            "action": played.action.to_string(),
            "from": from.map(avatar),
            "moved": both.is_some_and(|(from, to)| (from.column, from.row) != (to.column, to.row)),
            "turned": both.filter(|(from, to)| from.facing != to.facing).and_then(|(_, to)| facing(to)),
            "became": both.filter(|(from, to)| from.name != to.name).map(|(_, to)| to.name.clone()),
            "gone": from.is_some() && to.is_none(),
        }))
    }

    /// Describes the result of each action since the last decision, as in `right (4,2)`,
    /// `use as nil (4,2), score +1` or `up: you died`.
    fn played(&self) -> Vec<String> {
        let told = |played: &Played| {
            let nil = if played.is_unavailable { " as nil" } else { "" };
            let place =
                played.avatar.map_or(": you died".to_owned(), |(column, row)| format!(" ({column},{row})"));
            let score = (played.reward != 0.0).then(|| format!(", score {}", signed(played.reward)));
            format!("{}{nil}{place}{}", played.asked, score.unwrap_or_default())
        };
        self.turn.played.iter().map(told).collect()
    }

    /// Returns the template data for prompts without rules.
    fn discover(&self) -> Value {
        let (now, legend, turn) = (self.now, self.legend, self.turn);
        let offered = |action: &&Action| turn.actions.contains(action);
        let actions: Vec<String> = self.actions.iter().filter(offered).map(ToString::to_string).collect();
        let events = self.before.zip(turn.before);
        json!({
            // The end of the previous level is described only in the first turn.
            "previous": self.previous.as_ref().filter(|_| turn.number == 0),
            "place": turn.series.map(|series| series.place),
            "actions_now": (!actions.is_empty() && actions.len() < self.actions.len()).then_some(actions),
            "events": events.map(|(before, played)| encoding::events(before, now, played.action, legend)),
            "grid": encoding::ruled(&encoding::grid(now, legend)),
            "stacks": encoding::stacks(now, legend),
        })
    }

    /// Returns the template data for prompts in the reference style.
    fn reference(&self) -> Value {
        let (now, legend) = (self.now, self.legend);
        let grid = encoding::grid(now, legend);
        let cells: Vec<Value> = grid
            .lines()
            .enumerate()
            .flat_map(|(row, line)| {
                line.chars().enumerate().map(move |(column, symbol)| json!([row, column, symbol.to_string()]))
            })
            .collect();
        let names = |entry: &Entry| json!([entry.name, entry.symbol.to_string()]);
        let told = legend.entries().iter().filter(|entry| entry.symbol != EMPTY);
        json!({
            "mapping": told.map(names).collect::<Vec<Value>>(),
            "grid": grid,
            "cells": cells,
            "last_grid": self.before.map(|before| encoding::grid(before, legend)),
            "last_avatar": self.before.and_then(|before| before.avatar.as_ref()).map(avatar),
            "recent": self.recent.iter().map(ToString::to_string).collect::<Vec<String>>(),
        })
    }
}

fn avatar(avatar: &AvatarView) -> Value {
    json!({
        "name": avatar.name,
        "column": avatar.column,
        "row": avatar.row,
        "facing": direction_name(avatar.facing),
        "health": avatar.health,
    })
}

/// Returns a board, optionally with spaces between the characters of each row.
fn board(rows: String, spaced: bool) -> String {
    if !spaced {
        return rows;
    }
    rows.lines().map(|row| row.chars().join(" ")).join("\n")
}

/// Formats the avatar's resources, such as `2 keys, 1 gem`, or `nothing` if there are none.
fn holds(seen: &Observation) -> String {
    let held = seen.resources.iter().filter(|(_, amount)| *amount != 0);
    let held = held
        .map(|(name, amount)| match amount {
            1 => format!("1 {name}"),
            _ => format!("{amount} {}", plural(name)),
        })
        .join(", ");
    if held.is_empty() { "nothing".to_owned() } else { held }
}

/// Formats a reward with its sign, such as `+2`, `-1` or `0`.
fn signed(reward: f64) -> String {
    if reward > 0.0 { format!("+{reward}") } else { reward.to_string() }
}
