//! Replays an episode from its log.

use crate::error::EvaluationError;
use crate::log::{Event, NEXT_STEP, SCHEMA, Status};
use crate::metrics::answers::Answers;
use crate::metrics::as_code::{AsCode, flags_as_code};
use crate::metrics::commit::Commit;
use crate::metrics::ending::{Ending, LastTick};
use crate::metrics::meaningful::{Effect, meaningful};
use crate::player::Validity;
use crate::run::graded;
use crate::subject::{Subject, SubjectLevel};
use base::Digest;
use engine::{Action, Game, Outcome, SEMANTICS, State};

/// The result of replaying an episode.
#[derive(Clone, Debug, PartialEq)]
pub struct Replayed {
    /// The length of the level's shortest win in ticks, if proved optimal.
    pub optimal_ticks: Option<usize>,
    /// The episode's actions.
    pub actions: Vec<Action>,
    /// The change in score in each step.
    pub rewards: Vec<f64>,
    /// For each step, `true` if it is meaningful. Empty after [`replay_course`].
    pub meaningful: Vec<bool>,
    /// For each step except the last, `true` if the reference code considers the step meaningful. Empty after
    /// [`replay_course`].
    pub meaningful_as_code: Vec<bool>,
    /// The avatar's column and row before the first step and after each step.
    pub cells: Vec<Option<(i32, i32)>>,
    /// The outcome after the last step.
    pub outcome: Outcome,
    /// The score after the last step.
    pub score: f64,
    /// The digest of all actions, visible boards, scores and outcomes. The digest excludes the random
    /// generator's state.
    pub course: Digest,
    /// The cause of the ending and the distance from a win, if the episode was not won.
    pub ending: Option<Ending>,
}

/// Replays a logged episode on its game, and compares every state hash, score, outcome and avatar position
/// with the log.
///
/// Also checks that each step's validity agrees with the preceding answers, that the last line agrees with
/// the final state, and that the number of steps is within the limit.
///
/// Cost per step: two forward-model calls, a copy of the state and O(sprites log sprites).
///
/// # Errors
/// Returns an error if the log belongs to a different game, level or version of the suite, or contradicts
/// itself or the game. The message states the line number.
pub fn replay(subject: &Subject, log: &[Event]) -> Result<Replayed, EvaluationError> {
    replay_measured(subject, log, true)
}

/// Replays a logged episode with the same comparisons as [`replay`], but without determining which steps were
/// meaningful.
///
/// Cost per step: one forward-model call and O(sprites log sprites).
///
/// # Errors
/// Returns an error in the same cases as [`replay`].
pub fn replay_course(subject: &Subject, log: &[Event]) -> Result<Replayed, EvaluationError> {
    replay_measured(subject, log, false)
}

fn replay_measured(subject: &Subject, log: &[Event], has_effects: bool) -> Result<Replayed, EvaluationError> {
    let Some(start @ Event::Start { max_steps, commit, .. }) = log.first() else {
        return Err(EvaluationError::Malformed(format!(
            "line 1 is not the start of an episode of {}; {NEXT_STEP}",
            subject.id
        )));
    };
    let (level, mut state) = begin(subject, start).map_err(EvaluationError::Malformed)?;
    let mut replayed = Replayed {
        optimal_ticks: level.optimal_ticks,
        actions: Vec::new(),
        rewards: Vec::new(),
        meaningful: Vec::new(),
        meaningful_as_code: Vec::new(),
        cells: vec![cell(&subject.game, &state)],
        outcome: state.outcome(),
        score: state.score(),
        course: Digest::of(b""),
        ending: None,
    };
    let (started, mut tick) = (state.clone(), LastTick::default());
    let is_step = |event: &Event| matches!(event, Event::Step { .. });
    let last_step = log.iter().rposition(is_step).map(|at| at + 1);
    let mut course = blake3::Hasher::new();
    let mut code = AsCode::new(&subject.game);
    let (mut effects, mut texts) = (Vec::new(), Vec::new());
    let mut seen = Seen::of(&subject.game, &state);
    let mut places = vec![seen.place()];
    seen.absorb(&mut course);
    let mut answers = Answers::default();
    let mut plan = Commit::new(*commit, *max_steps);
    for (event, line) in log.iter().zip(1..).skip(1) {
        let malformed =
            |what: String| EvaluationError::Malformed(format!("line {line}: {what}; {NEXT_STEP}"));
        match event {
            Event::Start { .. } => return Err(malformed("the episode has a second start".to_owned())),
            Event::Plan { .. } => {
                plan.begin(event, replayed.actions.len() as u64).map_err(malformed)?;
                answers.plan(event).map_err(malformed)?;
            }
            Event::Step { action, .. } => {
                if state.is_over() || replayed.actions.len() as u64 >= *max_steps {
                    return Err(malformed("the episode has a step after its end".to_owned()));
                }
                let is_decision = plan.step(event, &subject.game, &state).map_err(malformed)?;
                if has_effects {
                    texts.push(code.text(&subject.game.observe(&state)));
                }
                let idle = (has_effects && *action != Action::Nil).then(|| {
                    let mut idle = state.clone();
                    subject.game.step(&mut idle, Action::Nil);
                    (Seen::of(&subject.game, &idle), idle.outcome())
                });
                if Some(line) == last_step {
                    subject.game.step_watched(&mut state, *action, &mut tick);
                } else {
                    subject.game.step(&mut state, *action);
                }
                seen = Seen::of(&subject.game, &state);
                let reward = state.score() - replayed.score;
                if has_effects {
                    effects.push(effect(&seen, state.outcome(), idle, reward));
                    places.push(seen.place());
                }
                replayed.actions.push(*action);
                replayed.rewards.push(reward);
                replayed.cells.push(cell(&subject.game, &state));
                (replayed.outcome, replayed.score) = (state.outcome(), state.score());
                seen.absorb(&mut course);
                course.update(format!("{action:?} {:?} {}\n", replayed.outcome, replayed.score).as_bytes());
                compare(event, &state, &replayed).map_err(malformed)?;
                if is_decision {
                    answers.step(event).map_err(malformed)?;
                }
            }
            Event::Predictions { .. } => {
                compare_predictions(event, subject, replayed.actions.len()).map_err(malformed)?;
            }
            Event::End { .. } => {
                compare_end(event, &replayed, *max_steps).map_err(malformed)?;
                if line < log.len() {
                    return Err(malformed("the log has lines after the end of the episode".to_owned()));
                }
            }
            Event::Reply(reply) => answers.reply(reply, replayed.actions.len()).map_err(malformed)?,
            Event::Request { .. } | Event::Message { .. } | Event::Halt { .. } => answers.other(event),
        }
    }
    replayed.ending = Ending::of(subject, &started, &state, tick);
    replayed.course = Digest::from_bytes(*course.finalize().as_bytes());
    replayed.meaningful = meaningful(&effects, &places);
    replayed.meaningful_as_code = flags_as_code(&texts, &replayed.actions, &replayed.rewards);
    Ok(replayed)
}

/// Returns an episode's level, and the state before its first step.
fn begin<'a>(subject: &'a Subject, start: &Event) -> Result<(&'a SubjectLevel, State), String> {
    let Event::Start { schema, semantics, game_digest, level, level_digest, seed, hash, avatar, .. } = start
    else {
        unreachable!("the caller has looked")
    };
    if *schema > SCHEMA {
        return Err(format!(
            "the log has schema {schema}, but this version of arcade reads schemas up to {SCHEMA}: update \
             arcade"
        ));
    }
    if *semantics != SEMANTICS {
        return Err(format!(
            "the episode was played under semantics {semantics}, but this version of arcade has \
             {SEMANTICS}; read the log with the version that wrote it"
        ));
    }
    if *game_digest != subject.game.digest() {
        let given = subject.game.digest();
        return Err(format!("the episode was played on game {game_digest}, not on {given}"));
    }
    let found = subject.levels.iter().find(|found| found.number == *level);
    let found = found.ok_or_else(|| format!("the game has no level {level}"))?;
    let given = found.level.digest();
    if *level_digest != given {
        return Err(format!("the episode was played on level {level_digest}, not on {given}"));
    }
    let state = subject.game.start(&found.level, *seed);
    if state.state_hash() != *hash || cell(&subject.game, &state) != *avatar {
        return Err(format!("line 1: the initial state of the level differs from the log; {NEXT_STEP}"));
    }
    Ok((found, state))
}

fn compare(event: &Event, state: &State, replayed: &Replayed) -> Result<(), String> {
    let Event::Step { step, score, hash, outcome, avatar, .. } = event else { return Ok(()) };
    let number = replayed.actions.len() as u64 - 1;
    if *step != number {
        return Err(format!("step {number} is recorded as step {step}"));
    }
    let differs = |what: &str, found: String, recorded: String| {
        Err(format!("step {step} leads to {what} {found}, but the log records {recorded}"))
    };
    if state.state_hash() != *hash {
        return differs("state", state.state_hash().to_string(), hash.to_string());
    }
    if replayed.score != *score {
        return differs("score", replayed.score.to_string(), score.to_string());
    }
    if replayed.outcome != *outcome {
        return differs("an episode that is", in_words(replayed.outcome), in_words(*outcome));
    }
    let place = |at: Option<(i32, i32)>| {
        at.map_or("nowhere".to_owned(), |(column, row)| format!("in column {column}, row {row}"))
    };
    match replayed.cells.last().copied().flatten() {
        found if found != *avatar => differs("an avatar", place(found), place(*avatar)),
        _ => Ok(()),
    }
}

/// Checks that the grade of the predictions agrees with the game's rules.
fn compare_predictions(event: &Event, subject: &Subject, steps: usize) -> Result<(), String> {
    let Event::Predictions { step, kinds, predicted, validity, grade } = event else { return Ok(()) };
    if *step != steps as u64 {
        return Err(format!("the predictions after step {steps} are recorded after step {step}"));
    }
    if predicted.is_some() != (*validity == Validity::Valid) {
        return Err(format!("the predictions are wrongly recorded as {}", validity.name()));
    }
    match graded(&subject.analysis, kinds, predicted.as_ref()) == *grade {
        true => Ok(()),
        false => {
            Err("the recorded grade of the predictions differs from the grade under the rules".to_owned())
        }
    }
}

/// Compares a log's last line with the final state.
fn compare_end(event: &Event, replayed: &Replayed, max_steps: u64) -> Result<(), String> {
    let Event::End { status, outcome, score, steps } = event else { return Ok(()) };
    let taken = replayed.actions.len() as u64;
    let is_over = replayed.outcome != Outcome::Ongoing;
    if (replayed.outcome, replayed.score, taken) != (*outcome, *score, *steps) {
        return Err(format!(
            "the episode is {} with score {} after {taken} steps, but the log records {} with score {score} after {steps}",
            in_words(replayed.outcome),
            replayed.score,
            in_words(*outcome),
        ));
    }
    match status {
        Status::Over if !is_over => {
            Err("the log records that the game is over, but the game is not over".to_owned())
        }
        Status::StepLimit if is_over => {
            Err("the log records that the step limit was reached, but the game is over".to_owned())
        }
        Status::StepLimit if taken < max_steps => Err(format!(
            "the log records that the step limit was reached, but only {taken} of {max_steps} steps were taken"
        )),
        _ => Ok(()),
    }
}

/// Returns a phrase for an outcome, such as `won` or `not over`.
fn in_words(outcome: Outcome) -> String {
    match outcome {
        Outcome::Ongoing => "not over".to_owned(),
        Outcome::Won => "won".to_owned(),
        Outcome::Lost => "lost".to_owned(),
        Outcome::Ended => "over without a winner".to_owned(),
        Outcome::Stopped(limit) => format!("stopped ({limit})"),
    }
}

fn cell(game: &Game, state: &State) -> Option<(i32, i32)> {
    game.seen_avatar(state).map(|avatar| (avatar.column, avatar.row))
}

/// A visible sprite: its type and its rectangle in pixels.
type SeenSprite = (u16, i32, i32, i32, i32);

/// The visible part of a state, in pixels rather than cells. Pixels and cells are equivalent for sprites that
/// move from cell to cell, but for gliding sprites, cells would not distinguish a short glide from a blocked
/// move.
#[derive(Clone, Debug, PartialEq)]
struct Seen {
    avatar: Option<SeenSprite>,
    /// The sprites other than the avatar, sorted.
    others: Vec<SeenSprite>,
}

impl Seen {
    fn of(game: &Game, state: &State) -> Seen {
        let player = state.avatar_type().and(state.avatar_id());
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

    /// Returns the position of the avatar's top left corner, if there is an avatar.
    fn place(&self) -> Option<(i32, i32)> {
        self.avatar.map(|(_, x, y, _, _)| (x, y))
    }

    /// Adds all sprites to a digest.
    fn absorb(&self, digest: &mut blake3::Hasher) {
        digest.update(&[u8::from(self.avatar.is_some())]);
        for (stype, x, y, w, h) in self.avatar.iter().chain(&self.others) {
            digest.update(&stype.to_le_bytes());
            for number in [x, y, w, h] {
                digest.update(&number.to_le_bytes());
            }
        }
        digest.update(&(self.others.len() as u64).to_le_bytes());
    }

    fn avatar_type(&self) -> Option<u16> {
        self.avatar.map(|avatar| avatar.0)
    }
}

/// Returns an action's effect, compared with `idle`, the result of doing nothing. `idle` is `None` if the
/// action itself was to do nothing.
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
