//! What a number of episodes can show: before the run for what is planned, afterwards for what was played.

use crate::study::Study;
use crate::study::table::{Table, TableCell};
use serde::Serialize;
use statistics::Power;

/// What two players can be told apart by, at 5 % and in 80 of 100 evaluations.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PowerRow {
    /// On a level, on a game, on all games.
    pub grain: String,
    /// Episodes of each player.
    pub episodes: u64,
    /// The least Cohen's h that shows; above π, nothing does.
    pub h: f64,
    /// The least win rate that is told from 0.1.
    pub from_tenth: Option<f64>,
    /// The least win rate that is told from 0.5.
    pub from_half: Option<f64>,
}

/// What so many episodes of each player on a level show, with so many levels in all and on a game. Episodes are taken for
/// independent, and nothing is corrected for: a study of many comparisons shows less.
///
/// ```
/// let rows = evaluation::study::power(5, 5, 30);
/// assert_eq!(rows.iter().map(|row| row.episodes).collect::<Vec<u64>>(), [5, 25, 150]);
/// assert!(rows[1].from_tenth.is_some_and(|rate| (rate - 0.43).abs() < 0.01));
/// ```
pub fn power(runs: u64, levels_of_game: u64, levels: u64) -> Vec<PowerRow> {
    let grains =
        [("a level", runs), ("a game", runs * levels_of_game), ("all games", runs * levels)].into_iter();
    let row = |(grain, episodes): (&str, u64)| {
        let ask = Power::default();
        let above = |base: f64| ask.detectable(episodes, base)[1];
        let (from_tenth, from_half) = (above(0.1), above(0.5));
        PowerRow { grain: grain.to_owned(), episodes, h: ask.detectable_h(episodes), from_tenth, from_half }
    };
    grains.filter(|(_, episodes)| *episodes > 0).map(row).collect()
}

/// What the episodes of a study show: those of the player with the fewest.
pub(crate) fn of_study(study: &Study) -> Vec<PowerRow> {
    let fewest = |counts: &dyn Fn(usize) -> Vec<u64>| {
        (0..study.players.len()).flat_map(counts).filter(|count| *count > 0).min().unwrap_or(0)
    };
    let ended = |player: usize, game: Option<usize>, level: Option<usize>| {
        study.on(player, game, level).iter().filter(|episode| episode.metrics.counts()).count() as u64
    };
    let games = || 0..study.games.len();
    let on_levels = |player: usize| {
        let levels =
            games().flat_map(|game| study.games[game].levels.iter().map(move |level| (game, level.number)));
        levels.map(|(game, level)| ended(player, Some(game), Some(level))).collect::<Vec<u64>>()
    };
    let counts = [
        ("a level", fewest(&on_levels)),
        ("a game", fewest(&|player| games().map(|game| ended(player, Some(game), None)).collect())),
        ("all games", fewest(&|player| vec![ended(player, None, None)])),
    ];
    let row = |(grain, episodes): (&str, u64)| {
        power(episodes, 0, 0).into_iter().next().map(|row| PowerRow { grain: grain.to_owned(), ..row })
    };
    counts.into_iter().filter_map(row).collect()
}

/// As a table.
pub fn table(rows: &[PowerRow]) -> Table {
    let mut table = Table::new(
        "power",
        "What so many episodes can show",
        "The least difference of two win rates that a two-sided test at 5 % shows in 80 of 100 evaluations, by the arcsine \
         approximation (Cohen 1988). Episodes of the player with the fewest; correction for many comparisons shows less.",
        &["on", "episodes a side", "h", "0.1 against", "0.5 against"],
    );
    for row in rows {
        table.push(vec![
            TableCell::text(&row.grain),
            TableCell::Count(row.episodes),
            TableCell::number(row.h, 2),
            TableCell::number(row.from_tenth, 2),
            TableCell::number(row.from_half, 2),
        ]);
    }
    table
}
