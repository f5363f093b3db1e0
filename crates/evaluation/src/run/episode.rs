//! Plays one episode to its end, starting at its first tick or where it was interrupted.

use crate::commitment::Commitment;
use crate::error::EvaluationError;
use crate::log::{Event, Journal, SCHEMA, Status};
use crate::metrics::EndCause;
use crate::player::{Choice, Contestant, Halt, Validity};
use crate::predictions::{Grade, Predicted, grade};
use crate::prompt::kinds_at_start;
use crate::run::clock::Stopwatch;
use crate::subject::{Subject, SubjectLevel};
use crate::track::SeriesPlace;
use crate::turn::{LevelEnd, Played, Recent, Turn, choices};
use agents::{OpenLoop, Player};
use base::Seed;
use engine::{Action, Game, Observation, Outcome, SEMANTICS, State};

/// An episode to play.
#[derive(Clone, Copy, Debug)]
pub struct Task<'a> {
    /// The game of the episode.
    pub subject: &'a Subject,
    /// The level to play.
    pub level: &'a SubjectLevel,
    /// The episode's index among the episodes on this level.
    pub run: u64,
    /// The seed of the entire evaluation.
    pub seed: Seed,
    /// The maximum number of actions in the episode.
    pub max_steps: u64,
    /// The number of actions that the player commits to at each decision.
    pub commit: Commitment,
    /// The maximum number of output tokens per answer, including reasoning, if the user has set it.
    pub max_output_tokens: Option<u32>,
    /// The track (bundle of prompt settings) with its version, if any.
    pub track: Option<&'a str>,
    /// The level's position in a series, or `None` for a level played alone.
    pub series: Option<SeriesPlace>,
}

impl Task<'_> {
    /// Returns `true` if the level is played for practice, at the start of a series. Such an episode is
    /// excluded from all results.
    pub fn is_practice(&self) -> bool {
        self.series.is_some_and(SeriesPlace::is_practice)
    }

    /// Returns the seed of the game's randomness.
    ///
    /// The seed depends only on the initial state and the run, so it is the same for all players. It is also
    /// the same for a renamed game, because the states are the same.
    pub fn chance(&self) -> Seed {
        let start = self.subject.first_state(self.level);
        self.seed.child(&start.to_string(), 0).child("run", self.run)
    }

    /// Returns the seed used by older versions, which also depended on the game's names.
    fn chance_by_name(&self) -> Seed {
        let game = self.seed.child(&self.subject.game.digest().to_string(), 0);
        game.child(&self.level.level.digest().to_string(), 0).child("run", self.run)
    }

    /// Returns the maximum number of actions in the episode. A Timeout may end the episode before
    /// `max_steps`.
    pub fn most_steps(&self) -> u64 {
        self.max_steps.min(self.subject.game.time_limit())
    }

    /// Returns the maximum number of decisions. Each decision covers the number of actions that the player
    /// commits to.
    pub fn most_decisions(&self) -> u64 {
        let steps = self.most_steps();
        steps.div_ceil(self.commit.due(steps).max(1))
    }

    /// Compares a log's first line with the task. The remaining lines are compared with the game when the
    /// episode is replayed.
    ///
    /// # Errors
    /// Returns a clause that states the first difference.
    pub fn compare_start(&self, start: &Event) -> Result<(), String> {
        let Event::Start {
            game, level, run, seed, max_steps, commit, max_output_tokens, track, series, ..
        } = start
        else {
            return Ok(());
        };
        let place = |series: Option<SeriesPlace>| {
            series.map_or("none".to_owned(), |place| format!("{} of {}", place.index + 1, place.of))
        };
        let on = |track: Option<&str>| track.unwrap_or("none").to_owned();
        let tokens = |most: Option<u32>| most.map_or("none".to_owned(), |most| most.to_string());
        let fields = [
            ("game", game.clone(), self.subject.id.clone()),
            ("level", level.to_string(), self.level.number.to_string()),
            ("run", run.to_string(), self.run.to_string()),
            ("an episode with `max_steps`", max_steps.to_string(), self.max_steps.to_string()),
            ("an episode with `commit`", commit.to_string(), self.commit.to_string()),
            (
                "an episode with `max_output_tokens`",
                tokens(*max_output_tokens),
                tokens(self.max_output_tokens),
            ),
            ("an episode with `track`", on(track.as_deref()), on(self.track)),
            ("a level with the series position", place(*series), place(self.series)),
        ];
        if let Some((what, found, requested)) = fields.iter().find(|(_, found, requested)| found != requested)
        {
            return Err(format!("the log records {what} {found}, but {requested} was requested"));
        }
        match *seed == self.chance() || *seed == self.chance_by_name() {
            true => Ok(()),
            false => Err("the `seed` of the episode in the log differs from the requested seed".to_owned()),
        }
    }

    /// Returns the name of the episode's log file in `episodes/`.
    pub fn file_name(&self) -> String {
        format!("{}-lvl{}-run{}.jsonl", self.subject.id, self.level.number, self.run)
    }
}

/// The result of playing an episode in this run.
#[derive(Clone, Debug, PartialEq)]
pub enum PlayResult {
    /// The episode ended with the given outcome.
    Ended(Outcome),
    /// The episode was aborted for the given reason.
    Halted(Halt),
}

/// Plays an episode to its end. If the log already contains events, the episode resumes where the log ends:
/// every step in the log is replayed, and its state hash is compared. A planner's interrupted episode
/// restarts from the beginning, which costs only time.
///
/// # Errors
/// Returns an error if the log belongs to a different episode, or cannot be written.
pub fn play(
    task: &Task<'_>,
    contestant: &mut Contestant,
    journal: &mut Journal,
) -> Result<PlayResult, EvaluationError> {
    if let Some(Event::End { outcome, .. }) = journal.events().last() {
        return Ok(PlayResult::Ended(*outcome));
    }
    let context = Context { previous: None, watch: &|_| None };
    play_watched(task, contestant, journal, &context).map(|(result, _)| result)
}

/// The context in which an episode is played.
pub(crate) struct Context<'a> {
    /// The end of the previous level in the series.
    pub(crate) previous: Option<&'a LevelEnd>,
    /// A function that receives the validity of each new decision, and can abort the episode.
    pub(crate) watch: &'a dyn Fn(Validity) -> Option<Halt>,
}

/// Plays an episode like [`play`]. If the episode has ended, its final state is shown to the agent, and the
/// end of the level is also returned.
pub(crate) fn play_watched(
    task: &Task<'_>,
    contestant: &mut Contestant,
    journal: &mut Journal,
    context: &Context<'_>,
) -> Result<(PlayResult, Option<LevelEnd>), EvaluationError> {
    let has_ended = matches!(journal.events().last(), Some(Event::End { .. }));
    if matches!(contestant, Contestant::Planner { .. }) && !journal.events().is_empty() && !has_ended {
        journal.clear()?;
    }
    let mut play = Playing::start(task, contestant, context.previous);
    match journal.events().first() {
        None => journal.push(play.start_event())?,
        Some(first) if *first == play.start_event() => {}
        Some(_) => {
            return Err(journal.malformed("this is the log of a different episode; use another folder"));
        }
    }
    if let Some(halt) = play.replay_log(journal)? {
        return Ok((PlayResult::Halted(halt), None));
    }
    while !play.is_over() {
        let halt = match play.decide(journal)? {
            Ok(validity) => (context.watch)(validity).filter(|_| !play.is_over()),
            Err(halt) => Some(halt),
        };
        if let Some(halt) = halt {
            return halted(halt, journal);
        }
    }
    if !has_ended && let Err(halt) = play.predict(journal)? {
        return halted(halt, journal);
    }
    play.finish(journal);
    let outcome = play.state.outcome();
    let status = if play.state.is_over() { Status::Over } else { Status::StepLimit };
    if !has_ended {
        journal.push(Event::End { status, outcome, score: play.state.score(), steps: play.steps })?;
    }
    let before = play.recent.last.map(|(seen, action, _)| (seen, action));
    Ok((PlayResult::Ended(outcome), Some(LevelEnd { last: play.seen, before, steps: play.steps })))
}

/// Records the reason for an aborted episode.
fn halted(halt: Halt, journal: &mut Journal) -> Result<(PlayResult, Option<LevelEnd>), EvaluationError> {
    if let Some(event) = halt.event() {
        journal.push(event)?;
    }
    Ok((PlayResult::Halted(halt), None))
}

struct Playing<'a> {
    task: &'a Task<'a>,
    contestant: &'a mut Contestant,
    /// The planner's memory between decisions.
    player: Option<OpenLoop<Player>>,
    state: State,
    steps: u64,
    seen: Observation,
    recent: Recent,
    /// The end of the previous level in the series, if any.
    previous: Option<&'a LevelEnd>,
}

impl<'a> Playing<'a> {
    fn start(
        task: &'a Task<'a>,
        contestant: &'a mut Contestant,
        previous: Option<&'a LevelEnd>,
    ) -> Playing<'a> {
        let state = task.subject.game.start(&task.level.level, task.chance());
        let player = match contestant {
            Contestant::Planner { spec, budget } => {
                let seed = task.chance().child(spec.name(), 0);
                Some(OpenLoop::new(spec.player(seed), spec.budget().unwrap_or(*budget), seed))
            }
            Contestant::Agent(agent) => {
                agent.begin(task);
                None
            }
        };
        let seen = task.subject.game.observe(&state);
        Playing { task, contestant, player, state, steps: 0, seen, recent: Recent::default(), previous }
    }

    fn game(&self) -> &'a Game {
        &self.task.subject.game
    }

    fn is_over(&self) -> bool {
        self.state.is_over() || self.steps >= self.task.max_steps
    }

    /// Returns the number of actions in the next decision.
    fn due(&self) -> u64 {
        self.task.commit.due(self.task.max_steps - self.steps)
    }

    /// Returns the event for the first line of the log.
    fn start_event(&self) -> Event {
        let Task { subject, level, run, max_steps, commit, max_output_tokens, track, series, .. } =
            *self.task;
        let (game, game_digest) = (subject.id.clone(), subject.game.digest());
        Event::Start {
            schema: SCHEMA,
            semantics: SEMANTICS,
            game,
            game_digest,
            level: level.number,
            level_digest: level.level.digest(),
            run,
            seed: self.task.chance(),
            max_steps,
            commit,
            max_output_tokens,
            track: track.map(str::to_owned),
            series,
            hash: self.state.state_hash(),
            avatar: place(&self.seen),
        }
    }

    /// Replays the decisions in the log, and shows them to the agent. If the last decision was interrupted,
    /// plays the rest of its actions.
    fn replay_log(&mut self, journal: &mut Journal) -> Result<Option<Halt>, EvaluationError> {
        journal.set_step(1, None);
        let mut from = 1;
        while let Some((at, choice)) = decision_after(journal.events(), from, self.task.commit) {
            journal.set_step(from, Some(at));
            let (actions, recent) = (choices(self.game(), &self.state), std::mem::take(&mut self.recent));
            let turn = Turn::of(self.task, self.steps, &self.seen, &recent, &actions, self.previous);
            if let Contestant::Agent(agent) = &mut *self.contestant
                && let Err(halt) = agent.recall(&turn, journal, &choice)
            {
                return Ok(Some(halt));
            }
            from = self.carry_out(&choice, None, 0.0, journal, at)?;
            journal.set_step(from, None);
        }
        Ok(None)
    }

    /// Requests a decision from the contestant, then plays and records its actions.
    fn decide(&mut self, journal: &mut Journal) -> Result<Result<Validity, Halt>, EvaluationError> {
        let (game, started) = (self.game(), Stopwatch::start());
        let recent = std::mem::take(&mut self.recent);
        let decided = match (&mut *self.contestant, &mut self.player) {
            (Contestant::Planner { .. }, Some(player)) => {
                let due = self.task.commit.due(self.task.max_steps - self.steps);
                let (actions, calls) = player.plan(game, &self.state, due);
                Ok((Choice::plan(actions), Some(calls)))
            }
            (Contestant::Agent(agent), _) => {
                let actions = choices(game, &self.state);
                let turn = Turn::of(self.task, self.steps, &self.seen, &recent, &actions, self.previous);
                agent.act(&turn, journal).map(|choice| (choice, None))
            }
            (Contestant::Planner { .. }, None) => unreachable!("planners are made at the start"),
        };
        match decided {
            Ok((choice, calls)) => {
                let at = journal.events().len();
                let next = self.carry_out(&choice, calls, started.milliseconds(), journal, at)?;
                journal.set_step(next, None);
                Ok(Ok(choice.validity))
            }
            Err(halt) => {
                self.recent = recent;
                Ok(Err(halt))
            }
        }
    }

    /// Plays a decision's actions, and records them starting at event index `at`. Events that already exist
    /// must match. Returns the index of the event after the decision.
    fn carry_out(
        &mut self,
        choice: &Choice,
        calls: Option<u64>,
        took_ms: f64,
        journal: &mut Journal,
        mut at: usize,
    ) -> Result<usize, EvaluationError> {
        let due = self.due();
        if !self.task.commit.is_one() {
            let actions = choice.actions.iter().take(due as usize).copied().collect();
            let plan = Event::Plan { step: self.steps, actions, validity: choice.validity };
            self.record(plan, journal, &mut at)?;
        }
        for tick in 0..due as usize {
            if self.is_over() {
                break;
            }
            // The costs of the whole decision are recorded with its first action.
            let (calls, took_ms) = if tick == 0 { (calls, took_ms) } else { (None, 0.0) };
            let (calls, took_ms) = match journal.events().get(at) {
                Some(Event::Step { calls, took_ms, .. }) => (*calls, *took_ms),
                _ => (calls, took_ms),
            };
            let event = self.step(choice.action(tick), choice.validity, calls, took_ms);
            self.record(event, journal, &mut at)?;
        }
        Ok(at)
    }

    /// Appends an event to the log, or compares it with the existing event at index `at`.
    fn record(&self, event: Event, journal: &mut Journal, at: &mut usize) -> Result<(), EvaluationError> {
        match journal.events().get(*at) {
            None => journal.push(event)?,
            Some(recorded) if *recorded == event => {}
            Some(_) => {
                let step = self.steps.saturating_sub(1);
                return Err(journal.malformed(&format!(
                    "replaying step {step} gives a result that differs from the log; the log is damaged or \
                     was written by a different version of arcade"
                )));
            }
        }
        *at += 1;
        Ok(())
    }

    /// Shows the final state to the agent.
    fn finish(&mut self, journal: &Journal) {
        if let Contestant::Agent(agent) = &mut *self.contestant {
            let action = |event: &Event| match event {
                Event::Step { action, .. } => Some(*action),
                _ => None,
            };
            let actions: Vec<Action> = journal.events().iter().filter_map(action).collect();
            let last = Turn::of(self.task, self.steps, &self.seen, &self.recent, &[], self.previous);
            agent.end(&Turn { cause: Some(EndCause::replayed(self.task, &actions)), ..last });
        }
    }

    /// Asks the agent about the rules after the last level in a series, and records the answer with its
    /// grade.
    fn predict(&mut self, journal: &mut Journal) -> Result<Result<(), Halt>, EvaluationError> {
        let is_last = self.task.series.is_some_and(SeriesPlace::is_last);
        let is_recorded = |event: &Event| matches!(event, Event::Predictions { .. });
        let Contestant::Agent(agent) = &mut *self.contestant else { return Ok(Ok(())) };
        if !is_last || journal.events().iter().any(is_recorded) {
            return Ok(Ok(()));
        }
        let analysis = &self.task.subject.analysis;
        let kinds = asked_kinds(self.task);
        let last = Turn::of(self.task, self.steps, &self.seen, &self.recent, &[], self.previous);
        let said = match agent.predict(&last, &kinds, journal) {
            Ok(Some(said)) => said,
            Ok(None) => return Ok(Ok(())),
            Err(halt) => return Ok(Err(halt)),
        };
        let (predicted, validity) = (said.predicted, said.validity);
        let grade = graded(analysis, &kinds, predicted.as_ref());
        journal.push(Event::Predictions { step: self.steps, kinds, predicted, validity, grade })?;
        Ok(Ok(()))
    }

    /// Plays an action and returns the event that records the step. An unavailable action is replaced by
    /// [`Action::Nil`].
    fn step(&mut self, asked: Action, validity: Validity, calls: Option<u64>, took_ms: f64) -> Event {
        let (game, score) = (self.game(), self.state.score());
        let action = available(game, &self.state, asked);
        game.step(&mut self.state, action);
        let seen = std::mem::replace(&mut self.seen, game.observe(&self.state));
        let reward = self.state.score() - score;
        self.recent.last = Some((seen, action, reward));
        let avatar = place(&self.seen);
        self.recent.played.push(Played { asked, is_unavailable: action != asked, avatar, reward });
        let step = self.steps;
        self.steps += 1;
        Event::Step {
            step,
            action,
            validity,
            score: self.state.score(),
            hash: self.state.state_hash(),
            outcome: self.state.outcome(),
            avatar,
            calls,
            took_ms,
        }
    }
}

/// Returns the sprite types in the last question of a series: the types present at the start of its levels.
fn asked_kinds(task: &Task<'_>) -> Vec<String> {
    let subject = task.subject;
    let at = subject.levels.iter().position(|level| level.number == task.level.number).unwrap_or_default();
    let of = task.series.map_or(1, |place| place.of as usize);
    let levels = subject.levels[(at + 1).saturating_sub(of)..=at].iter().map(|level| &level.level);
    kinds_at_start(&subject.analysis, levels)
}

/// Grades an answer to the last question in a series. Without a usable answer, no prediction is correct and the insight
/// (agreement with the rules) is 0.
pub(crate) fn graded(analysis: &engine::Analysis, kinds: &[String], predicted: Option<&Predicted>) -> Grade {
    match predicted {
        Some(predicted) => grade(analysis, kinds, predicted),
        None => {
            let grade = grade(analysis, kinds, &Predicted::new());
            Grade { right: 0, insight: grade.insight.map(|_| 0.0), ..grade }
        }
    }
}

/// Returns the action to play if a player chooses `asked`: that action, or [`Action::Nil`] if it is
/// unavailable.
pub(crate) fn available(game: &Game, state: &State, asked: Action) -> Action {
    if game.actions(state).contains(&asked) { asked } else { Action::Nil }
}

/// Returns the first decision at or after index `from`, with its index; `None` if there is no further decision.
fn decision_after(events: &[Event], from: usize, commit: Commitment) -> Option<(usize, Choice)> {
    events.iter().enumerate().skip(from).find_map(|(at, event)| match event {
        Event::Step { action, validity: Validity::Valid, .. } if commit.is_one() => {
            Some((at, Choice::of(*action)))
        }
        Event::Step { validity, .. } if commit.is_one() => Some((at, Choice::nothing(*validity))),
        Event::Plan { actions, validity, .. } => {
            Some((at, Choice { actions: actions.clone(), validity: *validity }))
        }
        _ => None,
    })
}

fn place(seen: &Observation) -> Option<(i32, i32)> {
    seen.avatar.as_ref().map(|avatar| (avatar.column, avatar.row))
}
