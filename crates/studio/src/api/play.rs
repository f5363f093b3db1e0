//! Requests for playing games, by people and planners.

use crate::frames;
use crate::refusal::Refusal;
use crate::sessions::{Session, Shown};
use crate::studio::Studio;
use agents::PLANNERS;
use engine::Episode;
use serde::Deserialize;
use serde_json::{Value, json};

/// A request to begin a game.
#[derive(Deserialize)]
pub(crate) struct Begin {
    source: String,
    level: String,
    #[serde(default)]
    seed: String,
}

pub(crate) fn begin(studio: &Studio, asked: Begin) -> Result<Value, Refusal> {
    let compiled = studio.compiled.need(&asked.source)?;
    let level = compiled.level(&asked.level)?;
    let mut session = Session::begin(compiled, level, &asked.seed);
    let Shown { tiles, frame, .. } = session.show(None)?;
    Ok(json!({ "session": studio.sessions.add(session), "tiles": tiles, "frame": frame }))
}

/// A request to play a tick, either with an action or with a planner's choice.
#[derive(Deserialize)]
pub(crate) struct Act {
    session: String,
    action: Option<String>,
    planner: Option<String>,
}

pub(crate) fn act(studio: &Studio, asked: Act) -> Result<Value, Refusal> {
    let given = asked.action.as_deref().map(frames::action).transpose()?;
    studio.sessions.with(&asked.session, |session| {
        let action = match (given, &asked.planner) {
            (Some(action), _) => action,
            (None, Some(planner)) => session.choose(planner)?,
            (None, None) => engine::Action::Nil,
        };
        session.act(action);
        let Shown { tiles, frame, action } = session.show(Some(action))?;
        Ok(json!({ "tiles": tiles, "frame": frame, "action": action }))
    })
}

/// A request to jump to a tick.
#[derive(Deserialize)]
pub(crate) struct Seek {
    session: String,
    tick: usize,
}

pub(crate) fn seek(studio: &Studio, asked: Seek) -> Result<Value, Refusal> {
    studio.sessions.with(&asked.session, |session| {
        session.seek(asked.tick);
        let Shown { tiles, frame, .. } = session.show(None)?;
        Ok(json!({ "tiles": tiles, "frame": frame }))
    })
}

/// A request about a session.
#[derive(Deserialize)]
pub(crate) struct Named {
    session: String,
}

pub(crate) fn episode(studio: &Studio, asked: Named) -> Result<Episode, Refusal> {
    studio.sessions.with(&asked.session, |session| Ok(session.episode()))
}

pub(crate) fn planners(_: &Studio) -> Result<Value, Refusal> {
    let help = |name: &str| match name {
        "do-nothing" => "never acts",
        "random-with-nil" => "any action, or none",
        "random" => "any action",
        "one-step-score" => "the action with the best score after one tick",
        "one-step" => "the best action after one tick, according to the rules' targets",
        "nearest-goal" => "the shortest way to the nearest target",
        "random-search" => "the best of many random action sequences",
        "rhea" => "evolves an action sequence at every tick",
        "mcts" => "Monte-Carlo tree search",
        "width" => "looks far ahead, and prefers new situations",
        "guided-mcts" => "tree search that follows the rules' targets",
        "olets" => "open-loop tree search",
        _ => "",
    };
    let listed: Vec<Value> =
        PLANNERS.iter().map(|&name| json!({ "name": name, "help": help(name) })).collect();
    Ok(json!(listed))
}
