//! The statistical power of a number of episodes: planned before the run, or played.

use crate::study::Study;
use report::{Table, TableCell};
use serde::Serialize;
use statistics::Power;

/// The smallest differences between two players that are detected at a level of 5 % with a power of 80 %.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PowerRow {
    /// The unit: a level, a game, or all games.
    pub grain: String,
    /// The number of episodes of each player.
    pub episodes: u64,
    /// The smallest Cohen's h that is detected; above π, none is.
    pub h: f64,
    /// The smallest win rate that is distinguished from 0.1.
    pub from_tenth: Option<f64>,
    /// The smallest win rate that is distinguished from 0.5.
    pub from_half: Option<f64>,
}

/// Computes the power of `runs` episodes of each player on a level, with `levels_of_game` levels per game and `levels` in
/// all. Episodes are treated as independent, without a correction for multiple comparisons, so that a study of many
/// comparisons detects less.
///
/// ```
/// use infinite_arcade_evaluation::study::power;
/// let rows = power(5, 5, 30);
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

/// Computes the power of the episodes of a study: those of the player with the fewest.
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

/// Returns the rows as a table.
pub fn table(rows: &[PowerRow]) -> Table {
    Table::of(
        "power",
        "Statistical power",
        "The smallest difference of two win rates that a two-sided test at 5 % detects with a power of 80 %, by the arcsine \
         approximation (Cohen 1988). Episodes of the player with the fewest; with correction for many comparisons, the power is lower.",
        rows,
        &[
            ("on", &|row| TableCell::text(&row.grain)),
            ("episodes a side", &|row| TableCell::Count(row.episodes)),
            ("h", &|row| TableCell::number(row.h, 2)),
            ("0.1 against", &|row| TableCell::number(row.from_tenth, 2)),
            ("0.5 against", &|row| TableCell::number(row.from_half, 2)),
        ],
    )
}
