//! Simulations of the exact memory tests.

use super::{Args, rows, share};
use report::{Table, TableCell};
use statistics::memory_simulation::MemoryTrial;
use statistics::{Memoriser, Spread};

const ALPHA: f64 = 0.01;

/// Simulates two kinds of players: players that replay the published witness on a fraction of the levels, and
/// players without memory that play worse after a renaming.
pub(super) fn memory(args: &Args) -> Table {
    let trials = args.trials.unwrap_or(10_000);
    let cases: Vec<(f64, f64)> = [(0.0, 0.0), (0.0, 0.7), (0.0, 1.0), (0.0, 2.0)]
        .into_iter()
        .chain([0.1, 0.2, 0.3, 0.5].map(|known| (known, 0.0)))
        .collect();
    let note = format!(
        "{trials} players each, flagged at p ≤ {ALPHA}; clean win rate 0.27, on levels that are known 0.9. Siblings: an episode on each side \
         of a pair of games, which has one coin however many levels; names hurt one side more than the other with a standard deviation of 0.5 logit. Prefixes: an episode on \
         each level, which begins as either witness in 7% by chance."
    );
    let columns = [
        "levels known",
        "hurt by other names",
        "siblings, 100 pairs",
        "siblings, 200 pairs",
        "40 games of 5 levels",
        "120 games of 5 levels",
        "prefixes, 200 levels",
    ];
    let mut table = Table::new("memory", "Players flagged by exact tests of memory", &note, &columns);
    table.rows = rows(args, &cases, |(known, hurt), seed| {
        let player = Memoriser { share: known, known: 0.9, clean: 0.27 };
        let trial = MemoryTrial { player, hurt, names: 0.5, spread: Spread::default() };
        let siblings = [100, 200].map(|pairs| share(trial.siblings(pairs, ALPHA, trials, seed)));
        let games = [40, 120].map(|games| share(trial.sibling_games(&vec![5; games], ALPHA, trials, seed)));
        let prefixes = share(trial.prefixes(200, 0.07, ALPHA, trials, seed));
        let place = [TableCell::number(known, 1), TableCell::number(hurt, 1)];
        place.into_iter().chain(siblings).chain(games).chain([prefixes]).collect()
    });
    table
}
