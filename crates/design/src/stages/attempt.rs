//! The best attempt at a level, as text.

use agents::{Budget, Limits, NearestGoal, play};
use base::Seed;
use engine::{Episode, Game, Level, Outcome};
use itertools::Itertools;
use std::fmt::Write;
use validators::{Board, Report};

/// The maximum number of ticks in the attempt that is played in addition to the judges' attempts.
const TICKS: usize = 200;
/// The maximum number of groups of equal consecutive actions to list.
const MOST_GROUPS: usize = 60;

/// Returns the best attempt at a level, which is the judges' shortest win if there is one. Otherwise, compares the
/// judges' episodes and one episode of a player that walks to the nearest goal. Wins rank first, then higher scores, and
/// then longer episodes. Cost: one episode.
pub(super) fn best(game: &Game, level: &Level, report: &Report, seed: Seed) -> Episode {
    if let Some(win) = &report.witness {
        return win.clone();
    }
    let limits = Limits { ticks: TICKS, ..Limits::default() };
    let planner = &mut NearestGoal::new(0.0, seed.child("planner", 0));
    let own = play(game, level, planner, Budget(0), seed.child("game", 0), limits).episode;
    let better = |best: Episode, next: Episode| {
        let rank =
            |episode: &Episode| (episode.outcome == Outcome::Won, episode.score, episode.actions.len());
        if rank(&next) > rank(&best) { next } else { best }
    };
    report.episodes().into_iter().fold(own, better)
}

/// Describes an attempt: its result, its actions, and the board at its end.
pub(super) fn in_words(game: &Game, level: &Level, name: &str, episode: &Episode) -> String {
    let result = match episode.outcome {
        Outcome::Won => "wins",
        Outcome::Lost => "loses",
        _ => "does not end",
    };
    let ticks = base::count(episode.actions.len(), "tick");
    let mut text = format!("{name}: the best attempt {result} after {ticks} with score {}.\n", episode.score);
    let groups = episode.actions.iter().chunk_by(|action| **action);
    let groups = groups.into_iter().map(|(action, same)| match same.count() {
        1 => action.to_string(),
        count => format!("{action}*{count}"),
    });
    let groups: Vec<String> = groups.collect();
    let more = if groups.len() > MOST_GROUPS { " …" } else { "" };
    let _ = writeln!(text, "Its actions: {}{more}", groups.iter().take(MOST_GROUPS).join(" "));
    if let Ok(state) = episode.replay(game, level) {
        let board = Board::of(game, &state);
        let _ = writeln!(text, "The board at its end:");
        for row in &board.rows {
            let _ = writeln!(text, "    {}", row.trim_end());
        }
        let _ = writeln!(text, "    ({})", board.key());
    }
    text
}
