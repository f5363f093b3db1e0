//! The metrics of a single episode.

use crate::commitment::Commitment;
use crate::error::EvaluationError;
use crate::log::Event;
use crate::metrics::choices::{Choices, Spending};
use crate::metrics::ending::Ending;
use crate::metrics::movement::Movement;
use crate::metrics::replay::{Replayed, replay, replay_course};
use crate::predictions::Grade;
use crate::subject::Subject;
use crate::thought::thought;
use crate::track::SeriesPlace;
use base::Digest;
use engine::Outcome;
use serde::Serialize;
use std::collections::BTreeSet;

/// The metrics of a single episode. Ratios are between 0 and 1.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EpisodeMetrics {
    /// The game's folder name.
    pub game: String,
    /// The level number.
    pub level: usize,
    /// The episode's index among the player's episodes on this level.
    pub run: u64,
    /// The reason why the episode ended.
    pub status: EpisodeStatus,
    /// The outcome after the last step.
    pub outcome: Outcome,
    /// The cause of the ending and the distance from a win. `None` for a win, and for an aborted or
    /// interrupted episode.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ending: Option<Ending>,
    /// The score after the last step.
    pub score: f64,
    /// The number of actions played.
    pub steps: u64,
    /// The maximum number of actions in the episode.
    pub max_steps: u64,
    /// The number of actions that the player commits to at each decision.
    #[serde(skip_serializing_if = "Commitment::is_one")]
    pub commit: Commitment,
    /// The maximum number of output tokens per answer, including reasoning, if the user has set it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_output_tokens: Option<u32>,
    /// The episode's track (bundle of prompt settings), with its version.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub track: Option<String>,
    /// The level's position in a series of levels played in one conversation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub series: Option<SeriesPlace>,
    /// The grade of the player's predictions after the last level in a series.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub predictions: Option<Grade>,
    /// The length of the level's shortest win in ticks, if proved optimal.
    pub optimal_ticks: Option<usize>,
    /// The meaningful step ratio: the number of meaningful steps divided by the total number of steps.
    pub meaningful: Option<f64>,
    /// The meaningful step ratio as computed by the reference code, which omits the last step. It is
    /// undefined for an episode with a single step.
    pub meaningful_as_code: Option<f64>,
    /// The metrics of the avatar's movement in the level.
    pub movement: Movement,
    /// The origins of the episode's choices.
    pub choices: Choices,
    /// The cost of the episode's choices.
    pub spending: Spending,
    /// The provider's names for the model versions that answered.
    #[serde(skip_serializing_if = "BTreeSet::is_empty")]
    pub served_by: BTreeSet<String>,
    /// The index of the episode's results folder among a study's folders.
    #[serde(skip)]
    pub folder: Option<usize>,
    /// The digest of all actions, boards, scores and outcomes, or `None` if unknown. Identical episodes have
    /// equal digests.
    #[serde(skip)]
    pub course: Option<Digest>,
    /// The amount of thought in all answers: their output tokens, or their words if no number of tokens was reported.
    /// `None` if the log contains no answers.
    #[serde(skip)]
    pub thought: Option<u64>,
    /// The price of the tokens in all answers and prompts in US dollars, if it is known.
    #[serde(skip)]
    pub cost: Option<f64>,
    /// The duration of each decision, in milliseconds.
    #[serde(skip)]
    pub decision_ms: Vec<f64>,
    /// The number of forward-model calls in each decision, for players that use the forward model.
    #[serde(skip)]
    pub calls: Vec<u64>,
}

/// The reason why an episode ended.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum EpisodeStatus {
    /// The game is over.
    Over,
    /// The episode reached its step limit without a win.
    StepLimit,
    /// The episode was aborted for the given reason. The player is not at fault, so no metric includes the
    /// episode.
    Halted(String),
    /// The log ends early, because the evaluation was interrupted. No metric includes the episode.
    Interrupted,
}

impl EpisodeMetrics {
    /// Computes an episode's metrics by replaying the episode from its log.
    ///
    /// # Errors
    /// Returns an error in the same cases as [`replay`].
    pub fn of(subject: &Subject, log: &[Event]) -> Result<EpisodeMetrics, EvaluationError> {
        Ok(EpisodeMetrics::measured(subject, log, replay(subject, log)?))
    }

    /// Computes the metrics that do not depend on meaningful steps. Costs as much as [`replay_course`].
    /// `meaningful`, `meaningful_as_code` and the rates of `movement` are `None`.
    ///
    /// # Errors
    /// Returns an error in the same cases as [`replay`].
    pub fn of_course(subject: &Subject, log: &[Event]) -> Result<EpisodeMetrics, EvaluationError> {
        Ok(EpisodeMetrics::measured(subject, log, replay_course(subject, log)?))
    }

    fn measured(subject: &Subject, log: &[Event], replayed: Replayed) -> EpisodeMetrics {
        let Some(Event::Start { level, run, max_steps, commit, max_output_tokens, track, series, .. }) =
            log.first()
        else {
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
        let status = EpisodeStatus::of(&replayed, *max_steps, log);
        EpisodeMetrics {
            game: subject.id.clone(),
            level: *level,
            run: *run,
            ending: replayed.ending.clone().filter(|_| status.aborted().is_none()),
            status,
            outcome: replayed.outcome,
            score: replayed.score,
            steps: replayed.actions.len() as u64,
            max_steps: *max_steps,
            commit: *commit,
            max_output_tokens: *max_output_tokens,
            track: track.clone(),
            series: *series,
            predictions: log.iter().find_map(|event| match event {
                Event::Predictions { grade, .. } => Some(grade.clone()),
                _ => None,
            }),
            optimal_ticks: replayed.optimal_ticks,
            meaningful: fraction(meaningful),
            meaningful_as_code: fraction(meaningful_as_code),
            movement: Movement::of(meaningful, cells),
            choices: Choices::of(log),
            spending: Spending::of(log),
            served_by: served_by(log),
            folder: None,
            course: Some(replayed.course),
            thought: thought_in(log),
            cost: None,
            decision_ms,
            calls,
        }
    }

    /// Returns the metrics of a finished episode of which only the outcome is known, as in results without
    /// logs. The score and the number of steps are 0.
    pub fn ended(game: &str, level: usize, run: u64, outcome: Outcome) -> EpisodeMetrics {
        let is_over = outcome != Outcome::Ongoing;
        EpisodeMetrics {
            game: game.to_owned(),
            level,
            run,
            status: if is_over { EpisodeStatus::Over } else { EpisodeStatus::StepLimit },
            outcome,
            ending: Ending::unknown(outcome),
            score: 0.0,
            steps: 0,
            max_steps: 0,
            commit: Commitment::ONE,
            max_output_tokens: None,
            track: None,
            series: None,
            predictions: None,
            optimal_ticks: None,
            meaningful: None,
            meaningful_as_code: None,
            movement: Movement::default(),
            choices: Choices::default(),
            spending: Spending::default(),
            served_by: BTreeSet::new(),
            folder: None,
            course: None,
            thought: None,
            cost: None,
            decision_ms: Vec::new(),
            calls: Vec::new(),
        }
    }

    /// Returns `true` if the engine stopped the episode. Such an episode provides no evidence about the
    /// player.
    pub fn is_stopped(&self) -> bool {
        self.ending.as_ref().is_some_and(|ending| ending.stop.is_some())
    }

    /// Returns `true` if the game was won. A lost game, a game that ended without a winner, and an unfinished
    /// game are not wins.
    pub fn won(&self) -> bool {
        self.outcome == Outcome::Won
    }

    /// Returns `true` if the level was played to learn the rules of a series. No result includes such an
    /// episode.
    pub fn is_practice(&self) -> bool {
        self.series.is_some_and(SeriesPlace::is_practice)
    }

    /// Returns `true` if the episode counts in results, because it ended with the game or at its step limit.
    pub fn counts(&self) -> bool {
        self.status.aborted().is_none()
    }

    /// Returns the length of the shortest win divided by the number of steps in this episode. The ratio is 1
    /// for an optimal win. Returns `None` unless the episode is a win on a level whose shortest win is proved
    /// optimal.
    pub fn optimality(&self) -> Option<f64> {
        let optimal = self.optimal_ticks.filter(|_| self.won() && self.steps > 0)?;
        Some(optimal as f64 / self.steps as f64)
    }

    /// Returns the fraction of unused steps, `1 − steps / limit`.
    pub fn unused_steps(&self) -> Option<f64> {
        (self.max_steps > 0).then(|| 1.0 - self.steps as f64 / self.max_steps as f64)
    }
}

impl EpisodeStatus {
    /// Derives the status from the episode's steps. A missing or contradictory last line in the log has no
    /// effect.
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

    /// Returns the reason why the episode does not count, or `None` if it counts.
    pub fn aborted(&self) -> Option<&str> {
        match self {
            EpisodeStatus::Over | EpisodeStatus::StepLimit => None,
            EpisodeStatus::Halted(reason) => Some(reason),
            EpisodeStatus::Interrupted => Some("interrupted"),
        }
    }
}

/// Returns the provider's names for the model versions that answered.
fn served_by(log: &[Event]) -> BTreeSet<String> {
    let replies = log.iter().filter_map(|event| match event {
        Event::Reply(reply) => reply.served_by.clone(),
        _ => None,
    });
    replies.collect()
}

/// Returns the amount of thought in a log's answers; `None` if there are no answers.
fn thought_in(log: &[Event]) -> Option<u64> {
    let each = log.iter().filter_map(|event| match event {
        Event::Reply(reply) => {
            Some(thought(reply.usage.output_tokens, &reply.text, reply.reasoning.as_deref()))
        }
        _ => None,
    });
    each.reduce(u64::saturating_add)
}

/// Returns the fraction of `true` flags; `None` without flags.
fn fraction(flags: &[bool]) -> Option<f64> {
    (!flags.is_empty()).then(|| flags.iter().filter(|flag| **flag).count() as f64 / flags.len() as f64)
}
