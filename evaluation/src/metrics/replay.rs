//! An episode played again from its log.

use crate::error::EvaluationError;
use crate::log::{Event, SCHEMA};
use crate::metrics::as_code::{AsCode, flags_as_code};
use crate::metrics::meaningful::{Effect, meaningful};
use crate::subject::{Subject, SubjectLevel};
use engine::{Action, Game, Outcome, SEMANTICS, State};

/// What came of an episode, as its replay has it.
#[derive(Clone, Debug, PartialEq)]
pub struct Replayed {
    /// Ticks of the level's proved shortest win.
    pub optimal_ticks: Option<usize>,
    /// What was played.
    pub actions: Vec<Action>,
    /// By how much the score changed, step by step.
    pub rewards: Vec<f64>,
    /// Which steps were meaningful.
    pub meaningful: Vec<bool>,
    /// Which were by the reference's code: one flag fewer.
    pub meaningful_as_code: Vec<bool>,
    /// The avatar's column and row before the first step and after each.
    pub cells: Vec<Option<(i32, i32)>>,
    /// How it stood after the last step.
    pub outcome: Outcome,
    /// The score then.
    pub score: f64,
}

/// Plays the episode of a log again on its game, and compares every state hash, score, outcome and place of the avatar.
///
/// Cost: per step two forward-model calls, a copy of the state and O(sprites log sprites).
///
/// # Errors
/// The log is of another game, level or version of the suite, or leads elsewhere: the message names the step.
pub fn replay(subject: &Subject, log: &[Event]) -> Result<Replayed, EvaluationError> {
    let Some(start @ Event::Start { level, run, .. }) = log.first() else {
        return Err(EvaluationError::Malformed(format!(
            "{}: a log does not begin with the start of an episode; it is damaged",
            subject.id
        )));
    };
    let complain =
        |what: String| EvaluationError::Malformed(format!("{} level {level} run {run}: {what}", subject.id));
    let (level, mut state) = begin(subject, start).map_err(complain)?;
    let mut replayed = Replayed {
        optimal_ticks: level.optimal_ticks,
        actions: Vec::new(),
        rewards: Vec::new(),
        meaningful: Vec::new(),
        meaningful_as_code: Vec::new(),
        cells: vec![cell(&subject.game, &state)],
        outcome: state.outcome(),
        score: state.score(),
    };
    let mut code = AsCode::new(&subject.game);
    let (mut effects, mut texts) = (Vec::new(), Vec::new());
    let mut seen = Seen::of(&subject.game, &state);
    let mut places = vec![seen.place()];
    for event in &log[1..] {
        match event {
            Event::Step { action, .. } => {
                texts.push(code.text(&subject.game.observe(&state)));
                let idle = (*action != Action::Nil).then(|| {
                    let mut idle = state.clone();
                    subject.game.step(&mut idle, Action::Nil);
                    (Seen::of(&subject.game, &idle), idle.outcome())
                });
                subject.game.step(&mut state, *action);
                seen = Seen::of(&subject.game, &state);
                let reward = state.score() - replayed.score;
                effects.push(effect(&seen, state.outcome(), idle, reward));
                places.push(seen.place());
                replayed.actions.push(*action);
                replayed.rewards.push(reward);
                replayed.cells.push(cell(&subject.game, &state));
                (replayed.outcome, replayed.score) = (state.outcome(), state.score());
                compare(event, &state, &replayed).map_err(complain)?;
            }
            Event::End { outcome, score, steps, .. } => {
                let found = (replayed.outcome, replayed.score, replayed.actions.len() as u64);
                if found != (*outcome, *score, *steps) {
                    return Err(complain(format!(
                        "it ends {:?} with score {} after {} steps, the log says {outcome:?} with {score} after {steps}; \
                         the log is damaged",
                        found.0, found.1, found.2
                    )));
                }
            }
            _ => {}
        }
    }
    replayed.meaningful = meaningful(&effects, &places);
    replayed.meaningful_as_code = flags_as_code(&texts, &replayed.actions, &replayed.rewards);
    Ok(replayed)
}

/// The level and the state before the first step.
fn begin<'a>(subject: &'a Subject, start: &Event) -> Result<(&'a SubjectLevel, State), String> {
    let Event::Start { schema, semantics, game_digest, level, level_digest, seed, hash, avatar, .. } = start
    else {
        unreachable!("the caller has looked")
    };
    if *schema > SCHEMA {
        return Err(format!(
            "a log of schema {schema}; this version of arcade reads up to {SCHEMA}: update it"
        ));
    }
    if *semantics != SEMANTICS {
        return Err(format!(
            "it was played under semantics {semantics}, this version of arcade has {SEMANTICS}; read it with the version \
             that wrote it"
        ));
    }
    if *game_digest != subject.game.digest() {
        let given = subject.game.digest();
        return Err(format!("it was played on game {game_digest}, not on {given}"));
    }
    let found = subject.levels.iter().find(|found| found.number == *level);
    let found = found.ok_or_else(|| format!("the game has no level {level}"))?;
    let given = found.level.digest();
    if *level_digest != given {
        return Err(format!("it was played on level {level_digest}, not on {given}"));
    }
    let state = subject.game.start(&found.level, *seed);
    if state.state_hash() != *hash || cell(&subject.game, &state) != *avatar {
        return Err("it begins in another state than recorded; the log is damaged".to_owned());
    }
    Ok((found, state))
}

/// Whether a step was recorded as it is replayed.
fn compare(event: &Event, state: &State, replayed: &Replayed) -> Result<(), String> {
    let Event::Step { step, score, hash, outcome, avatar, .. } = event else { return Ok(()) };
    let number = replayed.actions.len() as u64 - 1;
    if *step != number {
        return Err(format!("step {number} is recorded as step {step}; the log is damaged"));
    }
    if state.state_hash() != *hash {
        let got = state.state_hash();
        return Err(format!("step {step} leads to state {got}, the log says {hash}; the log is damaged"));
    }
    let found = (replayed.score, replayed.outcome, replayed.cells.last().copied().flatten());
    if found != (*score, *outcome, *avatar) {
        return Err(format!(
            "step {step} leads to {found:?}, the log says {:?}; the log is damaged",
            (score, outcome, avatar)
        ));
    }
    Ok(())
}

fn cell(game: &Game, state: &State) -> Option<(i32, i32)> {
    game.seen_avatar(state).map(|avatar| (avatar.column, avatar.row))
}

/// A sprite as it is seen: its type, and where it lies, in pixels.
type SeenSprite = (u16, i32, i32, i32, i32);

/// What is seen of a state. In pixels rather than cells: the two tell the same where sprites move from cell to cell, and where
/// they glide, cells would not tell a glide from a wall.
#[derive(Clone, Debug, PartialEq)]
struct Seen {
    avatar: Option<SeenSprite>,
    /// Sorted.
    others: Vec<SeenSprite>,
}

impl Seen {
    fn of(game: &Game, state: &State) -> Seen {
        let player = state.avatar_sprite_type().and(state.avatar_id());
        let hidden: Vec<bool> = game.sprite_types().map(|stype| game.is_hidden(stype)).collect();
        let mut seen = Seen { avatar: None, others: Vec::new() };
        for record in game.records(state) {
            let rect = record.rect;
            let sprite = (record.stype, rect.x, rect.y, rect.w, rect.h);
            if player == Some(record.id) {
                seen.avatar = Some(sprite);
            } else if !hidden[usize::from(record.stype)] {
                seen.others.push(sprite);
            }
        }
        seen.others.sort_unstable();
        seen
    }

    /// The top left corner of the avatar.
    fn place(&self) -> Option<(i32, i32)> {
        self.avatar.map(|(_, x, y, _, _)| (x, y))
    }

    fn avatar_type(&self) -> Option<u16> {
        self.avatar.map(|avatar| avatar.0)
    }
}

/// What an action did, given what doing nothing would have led to; `None` if nothing was done.
fn effect(seen: &Seen, outcome: Outcome, idle: Option<(Seen, Outcome)>, reward: f64) -> Effect {
    let Some((idle, idle_outcome)) = idle else {
        return if reward == 0.0 { Effect::Nothing } else { Effect::Acted };
    };
    let other =
        seen.others != idle.others || seen.avatar_type() != idle.avatar_type() || outcome != idle_outcome;
    match (reward != 0.0 || other, seen.avatar == idle.avatar) {
        (true, _) => Effect::Acted,
        (false, false) => Effect::Moved,
        (false, true) => Effect::Nothing,
    }
}
