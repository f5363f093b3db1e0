//! What is measured of episodes, and what a study makes of it.

mod folders;
mod logs;
mod paper;
mod study;

use engine::Outcome;
use evaluation::metrics::{Choices, EpisodeMetrics, EpisodeStatus, Movement, Spending};

/// An episode of 100 steps at most, of which nothing is known but this.
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
        decision_ms: Vec::new(),
        calls: Vec::new(),
    }
}
