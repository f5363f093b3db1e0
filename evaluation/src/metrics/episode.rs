//! All that is measured of an episode.

use crate::error::EvaluationError;
use crate::log::Event;
use crate::metrics::choices::{Choices, Spending};
use crate::metrics::movement::Movement;
use crate::metrics::replay::{Replayed, replay};
use crate::subject::Subject;
use engine::Outcome;
use serde::Serialize;

/// The metrics of an episode. Shares are within 0..=1.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EpisodeMetrics {
    /// The game, by the name of its folder.
    pub game: String,
    /// The level's number.
    pub level: usize,
    /// Which of the episodes on this level.
    pub run: u64,
    /// Why it has no further step.
    pub status: EpisodeStatus,
    /// How the game stands after the last step.
    pub outcome: Outcome,
    /// The score then.
    pub score: f64,
    /// Actions played.
    pub steps: u64,
    /// Actions at most.
    pub max_steps: u64,
    /// Ticks of the level's shortest win, where it is proved.
    pub optimal_ticks: Option<usize>,
    /// The meaningful step ratio: meaningful steps by steps.
    pub meaningful: Option<f64>,
    /// The same by the reference's code: it loses the last step, so that an episode of one step has none.
    pub meaningful_as_code: Option<f64>,
    /// How the level was walked.
    pub movement: Movement,
    /// How the choices came about.
    pub choices: Choices,
    /// What they cost.
    pub spending: Spending,
    /// How long each decision took, ms.
    #[serde(skip)]
    pub decision_ms: Vec<f64>,
    /// Forward-model calls of each decision, of players that make any.
    #[serde(skip)]
    pub calls: Vec<u64>,
}

/// Why an episode has no further step.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum EpisodeStatus {
    /// The game is over.
    Over,
    /// The limit of steps was met: no win.
    StepLimit,
    /// It was broken off, for this reason; not the player's fault, so that it counts in no metric.
    Halted(String),
    /// Its log just ends: the evaluation was interrupted. Counts in no metric.
    Interrupted,
}

impl EpisodeMetrics {
    /// The metrics of the episode of a log, which is played again on its game.
    ///
    /// # Errors
    /// As [`replay`].
    pub fn of(subject: &Subject, log: &[Event]) -> Result<EpisodeMetrics, EvaluationError> {
        let replayed = replay(subject, log)?;
        let Some(Event::Start { level, run, max_steps, .. }) = log.first() else {
            unreachable!("the replay began with it")
        };
        let Replayed { meaningful, meaningful_as_code, cells, .. } = &replayed;
        let (mut decision_ms, mut calls) = (Vec::new(), Vec::new());
        for event in log {
            if let Event::Step { took_ms, calls: spent, .. } = event {
                decision_ms.push(*took_ms);
                calls.extend(*spent);
            }
        }
        Ok(EpisodeMetrics {
            game: subject.id.clone(),
            level: *level,
            run: *run,
            status: EpisodeStatus::of(&replayed, *max_steps, log),
            outcome: replayed.outcome,
            score: replayed.score,
            steps: replayed.actions.len() as u64,
            max_steps: *max_steps,
            optimal_ticks: replayed.optimal_ticks,
            meaningful: share(meaningful),
            meaningful_as_code: share(meaningful_as_code),
            movement: Movement::of(meaningful, cells),
            choices: Choices::of(log),
            spending: Spending::of(log),
            decision_ms,
            calls,
        })
    }

    /// Whether the game was won. All else is no win: lost, over without a winner, or not over.
    pub fn won(&self) -> bool {
        self.outcome == Outcome::Won
    }

    /// Whether the episode counts: it ended, by the game or by the limit of steps.
    pub fn counts(&self) -> bool {
        self.status.broken_off().is_none()
    }

    /// Steps that the proved shortest win takes, by the steps of this one: 1 for a win that no other is shorter than. Only of wins
    /// on levels where the shortest is known.
    pub fn optimality(&self) -> Option<f64> {
        let optimal = self.optimal_ticks.filter(|_| self.won() && self.steps > 0)?;
        Some(optimal as f64 / self.steps as f64)
    }

    /// The steps that were left, as a share: `1 − steps / limit`.
    pub fn spared(&self) -> Option<f64> {
        (self.max_steps > 0).then(|| 1.0 - self.steps as f64 / self.max_steps as f64)
    }
}

impl EpisodeStatus {
    /// The status that follows from the steps. A last line that is missing, or says something else, changes nothing.
    fn of(replayed: &Replayed, max_steps: u64, log: &[Event]) -> EpisodeStatus {
        if replayed.outcome != Outcome::Ongoing {
            return EpisodeStatus::Over;
        }
        if replayed.actions.len() as u64 >= max_steps {
            return EpisodeStatus::StepLimit;
        }
        match log.last() {
            Some(Event::Halt { reason, .. }) => EpisodeStatus::Halted(reason.clone()),
            _ => EpisodeStatus::Interrupted,
        }
    }

    /// Why the episode counts nowhere, if so.
    pub fn broken_off(&self) -> Option<&str> {
        match self {
            EpisodeStatus::Over | EpisodeStatus::StepLimit => None,
            EpisodeStatus::Halted(reason) => Some(reason),
            EpisodeStatus::Interrupted => Some("interrupted"),
        }
    }
}

/// The share of true flags.
fn share(flags: &[bool]) -> Option<f64> {
    (!flags.is_empty()).then(|| flags.iter().filter(|flag| **flag).count() as f64 / flags.len() as f64)
}
