//! The play of one episode, from its first tick or an interruption to its end.

use crate::error::EvaluationError;
use crate::log::{Event, Journal, SCHEMA, Status};
use crate::player::{Choice, Contestant, Halt, Validity};
use crate::run::clock::Stopwatch;
use crate::subject::{Subject, SubjectLevel};
use crate::turn::{Turn, choices};
use agents::{Planner, Player};
use engine::{Action, Game, Observation, Outcome, SEMANTICS, Seed, State};

/// An episode to play.
#[derive(Clone, Copy, Debug)]
pub struct Task<'a> {
    /// The game.
    pub subject: &'a Subject,
    /// The level.
    pub level: &'a SubjectLevel,
    /// The index of the episode among those on this level.
    pub run: u64,
    /// The seed of the whole evaluation.
    pub seed: Seed,
    /// The maximum number of decisions.
    pub max_steps: u64,
}

impl Task<'_> {
    /// Returns the seed of the game's chance. It depends only on the initial state and the run: it is the same for every
    /// player, and for a game under other names, whose states are the same.
    pub fn chance(&self) -> Seed {
        let start = self.subject.first_state(self.level);
        self.seed.child(&start.to_string(), 0).child("run", self.run)
    }

    /// Returns the seed by which results were played that are older than shared chance: it depends on the names too.
    fn chance_by_name(&self) -> Seed {
        let game = self.seed.child(&self.subject.game.digest().to_string(), 0);
        game.child(&self.level.level.digest().to_string(), 0).child("run", self.run)
    }

    /// The maximum number of decisions that can be made: a Timeout may end the episode before `max_steps`.
    pub fn most_steps(&self) -> u64 {
        self.max_steps.min(self.subject.game.time_limit())
    }

    /// Compares the first line of a log with the task. A replay compares the rest of the log with the game.
    pub(crate) fn compare_start(&self, start: &Event) -> Result<(), String> {
        let Event::Start { game, level, run, seed, max_steps, .. } = start else { return Ok(()) };
        let fields = [
            ("game", game.clone(), self.subject.id.clone()),
            ("level", level.to_string(), self.level.number.to_string()),
            ("run", run.to_string(), self.run.to_string()),
            ("an episode with `max_steps`", max_steps.to_string(), self.max_steps.to_string()),
        ];
        if let Some((what, found, requested)) = fields.iter().find(|(_, found, requested)| found != requested)
        {
            return Err(format!("the log is of {what} {found}, but {requested} was requested"));
        }
        match *seed == self.chance() || *seed == self.chance_by_name() {
            true => Ok(()),
            false => Err("the log is of an episode with another `seed` than requested".to_owned()),
        }
    }

    /// The name of its log file in `episodes/`.
    pub fn file_name(&self) -> String {
        format!("{}-lvl{}-run{}.jsonl", self.subject.id, self.level.number, self.run)
    }
}

/// The final status of an episode in a run.
#[derive(Clone, Debug, PartialEq)]
pub enum PlayResult {
    /// The episode has ended.
    Ended(Outcome),
    /// The episode was aborted.
    Halted(Halt),
}

/// Plays an episode to its end, or resumes it at the end of its log. Every step in the log is replayed and its state hash
/// compared. A planner's interrupted episode is restarted, which costs nothing but time.
///
/// # Errors
/// The log is of another episode, or cannot be written.
pub fn play(
    task: &Task<'_>,
    contestant: &mut Contestant,
    journal: &mut Journal,
) -> Result<PlayResult, EvaluationError> {
    play_watched(task, contestant, journal, &|_| None)
}

/// Plays an episode as [`play`] does. `watch` is told the validity of each new decision, and can abort the episode.
pub(crate) fn play_watched(
    task: &Task<'_>,
    contestant: &mut Contestant,
    journal: &mut Journal,
    watch: &dyn Fn(Validity) -> Option<Halt>,
) -> Result<PlayResult, EvaluationError> {
    if let Some(Event::End { outcome, .. }) = journal.events().last() {
        return Ok(PlayResult::Ended(*outcome));
    }
    if matches!(contestant, Contestant::Planner { .. }) && !journal.events().is_empty() {
        journal.clear()?;
    }
    let mut play = Playing::start(task, contestant);
    match journal.events().first() {
        None => journal.push(play.start_event())?,
        Some(first) if *first == play.start_event() => {}
        Some(_) => return Err(journal.malformed("this is the log of another episode; use another folder")),
    }
    if let Some(halt) = play.replay_log(journal)? {
        return Ok(PlayResult::Halted(halt));
    }
    while !play.is_over() {
        let halt = match play.decide(journal)? {
            Ok(validity) => watch(validity).filter(|_| !play.is_over()),
            Err(halt) => Some(halt),
        };
        if let Some(halt) = halt {
            if let Some(event) = halt.event() {
                journal.push(event)?;
            }
            return Ok(PlayResult::Halted(halt));
        }
    }
    play.finish();
    let outcome = play.state.outcome();
    let status = if play.state.is_over() { Status::Over } else { Status::StepLimit };
    journal.push(Event::End { status, outcome, score: play.state.score(), steps: play.steps })?;
    Ok(PlayResult::Ended(outcome))
}

struct Playing<'a> {
    task: &'a Task<'a>,
    contestant: &'a mut Contestant,
    /// The planner's memory between decisions.
    player: Option<Player>,
    state: State,
    steps: u64,
    seen: Observation,
    /// The observation before the last action, the action and its reward.
    before: Option<(Observation, Action, f64)>,
}

impl<'a> Playing<'a> {
    fn start(task: &'a Task<'a>, contestant: &'a mut Contestant) -> Playing<'a> {
        let state = task.subject.game.start(&task.level.level, task.chance());
        let player = match contestant {
            Contestant::Planner { spec, .. } => Some(spec.player(task.chance().child(spec.name(), 0))),
            Contestant::Agent(_) => None,
        };
        let seen = task.subject.game.observe(&state);
        Playing { task, contestant, player, state, steps: 0, seen, before: None }
    }

    fn game(&self) -> &'a Game {
        &self.task.subject.game
    }

    fn is_over(&self) -> bool {
        self.state.is_over() || self.steps >= self.task.max_steps
    }

    /// Returns the first line of the log.
    fn start_event(&self) -> Event {
        let Task { subject, level, run, max_steps, .. } = *self.task;
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
            hash: self.state.state_hash(),
            avatar: place(&self.seen),
        }
    }

    /// Replays the steps in the log, and shows them to the agent.
    fn replay_log(&mut self, journal: &mut Journal) -> Result<Option<Halt>, EvaluationError> {
        journal.set_step(1, None);
        let mut from = 1;
        while let Some((at, action, validity)) = step_after(journal.events(), from) {
            journal.set_step(from, Some(at));
            let recorded = journal.events()[at].clone();
            let choice = Choice { action, validity };
            let (actions, before) = (choices(self.game(), &self.state), self.before.take());
            let turn = Turn::of(self.task, self.steps, &self.seen, &before, &actions);
            if let Contestant::Agent(agent) = &mut *self.contestant
                && let Err(halt) = agent.recall(&turn, journal, &choice)
            {
                return Ok(Some(halt));
            }
            let Event::Step { calls, took_ms, .. } = recorded else { unreachable!("it was found as a step") };
            if self.step(choice, calls, took_ms) != recorded {
                let step = self.steps - 1;
                return Err(journal.malformed(&format!(
                    "step {step} differs from the log when it is replayed; the log is damaged or was written by another version of arcade"
                )));
            }
            from = at + 1;
        }
        journal.set_step(from, None);
        Ok(None)
    }

    /// Makes the contestant decide, plays the action and records it.
    fn decide(&mut self, journal: &mut Journal) -> Result<Result<Validity, Halt>, EvaluationError> {
        let (game, started) = (self.game(), Stopwatch::start());
        let decided = match (&mut *self.contestant, &mut self.player) {
            (Contestant::Planner { spec, budget }, Some(player)) => {
                let budget = spec.budget().unwrap_or(*budget);
                let (action, calls) = player.plan(game, &self.state, budget);
                Ok((Choice { action, validity: Validity::Valid }, Some(calls)))
            }
            (Contestant::Agent(agent), _) => {
                let actions = choices(game, &self.state);
                let turn = Turn::of(self.task, self.steps, &self.seen, &self.before, &actions);
                agent.act(&turn, journal).map(|choice| (choice, None))
            }
            (Contestant::Planner { .. }, None) => unreachable!("planners are made at the start"),
        };
        match decided {
            Ok((choice, calls)) => {
                let event = self.step(choice, calls, started.milliseconds());
                journal.push(event)?;
                let played = journal.events().len();
                journal.set_step(played, None);
                Ok(Ok(choice.validity))
            }
            Err(halt) => Ok(Err(halt)),
        }
    }

    /// Shows the agent the final state.
    fn finish(&mut self) {
        if let Contestant::Agent(agent) = &mut *self.contestant {
            agent.end(&Turn::of(self.task, self.steps, &self.seen, &self.before, &[]));
        }
    }

    /// Plays an action and returns the event that records it.
    fn step(&mut self, choice: Choice, calls: Option<u64>, took_ms: f64) -> Event {
        let score = self.state.score();
        self.game().step(&mut self.state, choice.action);
        let seen = std::mem::replace(&mut self.seen, self.task.subject.game.observe(&self.state));
        self.before = Some((seen, choice.action, self.state.score() - score));
        let step = self.steps;
        self.steps += 1;
        Event::Step {
            step,
            action: choice.action,
            validity: choice.validity,
            score: self.state.score(),
            hash: self.state.state_hash(),
            outcome: self.state.outcome(),
            avatar: place(&self.seen),
            calls,
            took_ms,
        }
    }
}

/// Returns the first step at or after `from`, with its action and validity.
fn step_after(events: &[Event], from: usize) -> Option<(usize, Action, Validity)> {
    events.iter().enumerate().skip(from).find_map(|(at, event)| match event {
        Event::Step { action, validity, .. } => Some((at, *action, *validity)),
        _ => None,
    })
}

fn place(seen: &Observation) -> Option<(i32, i32)> {
    seen.avatar.as_ref().map(|avatar| (avatar.column, avatar.row))
}
