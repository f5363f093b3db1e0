//! Tests of the metrics of episodes and of studies.

mod folders;
mod honest;
mod logs;
mod paper;
mod study;

use engine::Outcome;
use evaluation::metrics::{Choices, EpisodeMetrics, EpisodeStatus, Movement, Spending};

/// Returns an episode with a limit of 100 steps and only these values.
fn episode(game: &str, level: usize, run: u64, outcome: Outcome, score: f64, steps: u64) -> EpisodeMetrics {
    EpisodeMetrics {
        game: game.to_owned(),
        level,
        run,
        status: if outcome == Outcome::Ongoing { EpisodeStatus::StepLimit } else { EpisodeStatus::Over },
        outcome,
        score,
        steps,
        max_steps: 100,
        optimal_ticks: None,
        meaningful: None,
        meaningful_as_code: None,
        movement: Movement::default(),
        choices: Choices::default(),
        spending: Spending::default(),
        served_by: Default::default(),
        course: None,
        decision_ms: Vec::new(),
        calls: Vec::new(),
    }
}
