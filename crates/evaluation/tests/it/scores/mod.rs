//! Tests of the metrics of episodes and studies.

mod ceilings;
mod endings;
mod folders;
mod honest;
mod horizons;
mod logs;
mod paper;
mod study;
mod thinking;

use engine::Outcome;
use evaluation::metrics::EpisodeMetrics;

/// Returns an episode with the given values and a limit of 100 steps. All other values are as in
/// [`EpisodeMetrics::ended`].
fn episode(game: &str, level: usize, run: u64, outcome: Outcome, score: f64, steps: u64) -> EpisodeMetrics {
    EpisodeMetrics { score, steps, max_steps: 100, ..EpisodeMetrics::ended(game, level, run, outcome) }
}
