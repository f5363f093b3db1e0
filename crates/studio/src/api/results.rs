//! Requests for evaluation results: each player's episodes, replayed together with the messages exchanged.

use super::boards::CUT;
use crate::frames::{Frame, Frames, TileSvg, Tiles, action_name, outcome};
use crate::refusal::Refusal;
use crate::studio::Studio;
use engine::{Action, Outcome};
use evaluation::client::Role;
use evaluation::log::{Event, ReplyClass, Status};
use evaluation::run::Task;
use evaluation::{Evaluation, Validity};
use rayon::prelude::*;
use render::Looks;
use serde::Serialize;
use serde_json::{Value, json};

/// The maximum length of a prompt or a response, in characters.
const LONGEST: usize = 20_000;

/// Opens the results folders. Each folder contains one evaluation.
fn opened(studio: &Studio) -> Result<Vec<Evaluation>, Refusal> {
    if studio.workspace.results.is_empty() {
        return Err(Refusal::missing("no results are open").help("open results: `arcade studio RESULTS`"));
    }
    let folders = studio.workspace.results.iter();
    folders.map(|folder| Evaluation::open(folder).map_err(Refusal::failed)).collect()
}

pub(crate) fn results(studio: &Studio) -> Result<Value, Refusal> {
    let evaluations = opened(studio)?;
    let mut first = 0;
    let mut players = Vec::new();
    for evaluation in &evaluations {
        let tasks = evaluation.tasks();
        let listed = tasks.par_iter().enumerate().map(|(at, task)| summary(evaluation, task, first + at));
        let listed: Vec<Value> =
            listed.collect::<Result<Vec<Option<Value>>, Refusal>>()?.into_iter().flatten().collect();
        first += tasks.len();
        let entrant = &evaluation.settings.entrant;
        let name = match &entrant.mode {
            Some(mode) => format!("{} ({mode})", entrant.name),
            None => entrant.name.clone(),
        };
        players.push(json!({ "name": name, "episodes": listed }));
    }
    Ok(json!({ "players": players }))
}

/// Returns an episode's summary, or `None` if the episode has not begun.
fn summary(evaluation: &Evaluation, task: &Task<'_>, index: usize) -> Result<Option<Value>, Refusal> {
    let log = evaluation.events(task).map_err(Refusal::failed)?;
    let last = log.iter().rev().find_map(|event| match event {
        Event::Step { step, outcome, score, .. } => Some((step + 1, *outcome, *score)),
        _ => None,
    });
    let Some((steps, ended, score)) = last else { return Ok(None) };
    let is_limited = log.iter().any(|event| matches!(event, Event::End { status: Status::StepLimit, .. }));
    Ok(Some(json!({
        "index": index,
        "game": task.subject.facts.title,
        "id": task.subject.id,
        "level": task.level.number,
        "run": task.run,
        "outcome": if is_limited { "limit" } else { outcome(ended) },
        "score": score,
        "steps": steps,
    })))
}

/// The messages exchanged at a decision.
#[derive(Default, Serialize)]
struct Talk {
    /// The index of the frame that the player saw.
    frame: usize,
    /// The messages that were new to the player.
    prompt: String,
    /// The player's responses.
    answer: String,
    /// The reasoning in the responses.
    reasoning: String,
    /// The action parsed from the responses, or `None` if no action was found.
    parsed: Option<String>,
    /// The validity of the answer in words, such as `valid` or `cut off`.
    validity: &'static str,
}

/// An episode as frames, with the messages exchanged.
#[derive(Serialize)]
pub(crate) struct Replayed {
    title: String,
    player: String,
    tiles: Vec<TileSvg>,
    frames: Vec<Frame>,
    actions: Vec<String>,
    talk: Vec<Talk>,
    /// `true` if the replay agrees with the log.
    agrees: bool,
    note: Option<String>,
}

pub(crate) fn episode(studio: &Studio, index: &str) -> Result<Replayed, Refusal> {
    let unknown = || Refusal::missing("there is no such episode");
    let mut index: usize = index.parse().map_err(|_| unknown())?;
    for evaluation in &opened(studio)? {
        let tasks = evaluation.tasks();
        match tasks.get(index) {
            Some(task) => return replayed(evaluation, task),
            None => index -= tasks.len(),
        }
    }
    Err(unknown())
}

fn replayed(evaluation: &Evaluation, task: &Task<'_>) -> Result<Replayed, Refusal> {
    let log = evaluation.events(task).map_err(Refusal::failed)?;
    let looks = Looks::of(&task.subject.analysis);
    let chance = log.iter().find_map(|event| match event {
        Event::Start { seed, .. } => Some(*seed),
        _ => None,
    });
    let game = &task.subject.game;
    let mut state = game.start(&task.level.level, chance.unwrap_or_else(|| task.chance()));
    let mut tiles = Tiles::default();
    let mut frames = Frames::new();
    frames.push(Frame::with_looks(&looks, &state, 0, &mut tiles)?);
    let mut actions = Vec::new();
    let mut note = None;
    let mut differs = None;
    for event in &log {
        let Event::Step { action, hash, .. } = event else { continue };
        game.step(&mut state, *action);
        if differs.is_none() && state.state_hash() != *hash {
            differs = Some(actions.len() + 1);
        }
        if !frames.push(Frame::with_looks(&looks, &state, actions.len() + 1, &mut tiles)?) {
            note = Some(CUT.to_owned());
            break;
        }
        actions.push(action_name(*action));
        if state.outcome() != Outcome::Ongoing {
            break;
        }
    }
    let title = format!("{}, level {}, run {}", task.subject.facts.title, task.level.number, task.run);
    Ok(Replayed {
        title,
        player: evaluation.settings.entrant.name.clone(),
        tiles: tiles.fresh(),
        frames: frames.finish(),
        actions,
        talk: talks(&log),
        agrees: differs.is_none(),
        note: differs.map(|tick| format!("the replay differs from the log after tick {tick}")).or(note),
    })
}

/// Returns the messages for each decision that has any.
fn talks(log: &[Event]) -> Vec<Talk> {
    let (mut talks, mut current, mut step) = (Vec::new(), Talk::default(), 0);
    let mut shown: Vec<(u32, String)> = Vec::new();
    let flush = |current: &mut Talk, talks: &mut Vec<Talk>| {
        let done = std::mem::take(current);
        if !done.prompt.is_empty() || !done.answer.is_empty() {
            talks.push(done);
        }
    };
    for event in log {
        match event {
            Event::Message { id, role, text, image } if *role != Role::Assistant => {
                let picture = if image.is_some() { "[an image of the board]\n" } else { "" };
                shown.push((*id, format!("{picture}{text}")));
            }
            Event::Request { messages, .. } => {
                // If a conversation continues, the log repeats the texts of earlier levels. The repetitions are
                // omitted here.
                let is_shown = |id: &u32| [messages.first(), messages.last()].contains(&Some(id));
                for (_, text) in shown.drain(..).filter(|(id, _)| is_shown(id)) {
                    add(&mut current.prompt, &text);
                }
            }
            Event::Reply(reply) => {
                add(&mut current.answer, &reply.text);
                if let Some(reasoning) = &reply.reasoning {
                    add(&mut current.reasoning, reasoning);
                }
                current.parsed = match (&reply.action, &reply.plan) {
                    (Some(action), _) => Some(action_name(*action)),
                    (None, Some(plan)) => {
                        let names: Vec<String> =
                            plan.iter().map(|&action: &Action| action_name(action)).collect();
                        Some(names.join(" "))
                    }
                    (None, None) => None,
                };
                current.validity = match reply.class {
                    ReplyClass::Strict => "valid",
                    ReplyClass::Tolerant => "read with tolerance",
                    ReplyClass::Invalid => "invalid",
                    ReplyClass::Refused => "refused",
                    ReplyClass::Truncated => "cut off",
                };
            }
            Event::Step { validity, .. } => {
                current.frame = step;
                step += 1;
                match validity {
                    Validity::Valid => {}
                    Validity::Invalid => current.validity = "invalid",
                    Validity::Refused => current.validity = "refused",
                    Validity::Truncated => current.validity = "cut off",
                }
                flush(&mut current, &mut talks);
            }
            _ => {}
        }
    }
    // The final question comes after the last decision.
    current.frame = step;
    flush(&mut current, &mut talks);
    talks
}

/// Appends a text to a message, up to the length limit.
fn add(to: &mut String, text: &str) {
    if !to.is_empty() {
        to.push_str("\n\n");
    }
    let room = LONGEST.saturating_sub(to.chars().count());
    match text.char_indices().nth(room) {
        None => to.push_str(text),
        Some((end, _)) => {
            to.push_str(&text[..end]);
            to.push_str(" …");
        }
    }
}
