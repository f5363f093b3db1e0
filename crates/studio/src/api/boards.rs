//! Requests for boards and recordings.

use crate::compiled::Compiled;
use crate::frames::{Frame, Frames, TileSvg, Tiles, action_name};
use crate::positions;
use crate::refusal::Refusal;
use crate::studio::Studio;
use base::Seed;
use engine::{Diagnostics, Episode, Level, MAX_TICKS};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

/// A request for a board: a level of a game.
#[derive(Deserialize)]
pub(crate) struct Board {
    source: String,
    level: String,
}

pub(crate) fn board(studio: &Studio, asked: Board) -> Result<Value, Refusal> {
    let compiled = studio.compiled.need(&asked.source)?;
    let level = match compiled.game.level(&asked.level) {
        Ok(level) => level,
        Err(Diagnostics(problems)) => {
            let problems: Vec<Value> =
                problems.iter().map(|problem| positions::problem(&asked.level, problem)).collect();
            return Ok(json!({ "tiles": [], "frame": null, "cells": null, "problems": problems }));
        }
    };
    let state = compiled.game.start(&level, Seed::from_text("board"));
    let mut tiles = Tiles::default();
    let frame = Frame::of(&compiled, &state, 0, &mut tiles)?;
    let types = |symbol: &u8| {
        let names: Vec<&str> =
            compiled.game.places(*symbol).iter().map(|&stype| compiled.game.name(stype)).collect();
        names.join(" ")
    };
    let cells: Vec<Vec<String>> =
        level.cells().chunks(level.columns().max(1)).map(|row| row.iter().map(types).collect()).collect();
    let problems: Vec<Value> =
        level.warnings().iter().map(|problem| positions::problem(&asked.level, problem)).collect();
    Ok(json!({ "tiles": tiles.fresh(), "frame": frame, "cells": cells, "problems": problems }))
}

/// A request for a recorded episode on a level of a game.
#[derive(Deserialize)]
pub(crate) struct Replay {
    source: String,
    level: String,
    episode: Episode,
}

/// The note that frames have been omitted.
pub(crate) const CUT: &str = "the boards change too much to show the whole episode";

/// A recording as frames. It is serialised directly, because JSON values would take many times as much
/// memory.
#[derive(Serialize)]
pub(crate) struct Replayed {
    tiles: Vec<TileSvg>,
    frames: Vec<Frame>,
    actions: Vec<String>,
    /// `true` if the replay agrees with the recording.
    agrees: bool,
    note: Option<String>,
}

pub(crate) fn replay(studio: &Studio, asked: Replay) -> Result<Replayed, Refusal> {
    let compiled = studio.compiled.need(&asked.source)?;
    let level = compiled.level(&asked.level)?;
    let divergence = asked.episode.replay(&compiled.game, &level).err();
    let note = divergence.as_ref().map(ToString::to_string);
    Replayed::of(&compiled, &level, &asked.episode, divergence.is_none(), note)
}

impl Replayed {
    /// Plays an episode's actions, and draws each tick.
    pub(crate) fn of(
        compiled: &Compiled,
        level: &Level,
        episode: &Episode,
        agrees: bool,
        mut note: Option<String>,
    ) -> Result<Replayed, Refusal> {
        let mut tiles = Tiles::default();
        let mut state = compiled.game.start(level, episode.seed);
        let mut frames = Frames::new();
        frames.push(Frame::of(compiled, &state, 0, &mut tiles)?);
        let mut actions = Vec::new();
        for &action in episode.actions.iter().take(MAX_TICKS.unsigned_abs() as usize + 1) {
            if state.is_over() {
                break;
            }
            compiled.game.step(&mut state, action);
            if !frames.push(Frame::of(compiled, &state, actions.len() + 1, &mut tiles)?) {
                note.get_or_insert_with(|| CUT.to_owned());
                break;
            }
            actions.push(action_name(action));
        }
        let (tiles, frames) = (tiles.fresh(), frames.finish());
        Ok(Replayed { tiles, frames, actions, agrees, note })
    }
}
