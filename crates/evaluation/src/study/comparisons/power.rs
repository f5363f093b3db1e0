//! The statistical power of a plan with given numbers of games, levels and runs. A plan may be a future
//! evaluation, or the episodes already played.

use crate::study::Study;
use itertools::Itertools;
use report::{Table, TableCell};
use serde::Serialize;
use statistics::{Design, Spread};

/// A plan's power, computed for the test over games at the 5% level ([`statistics::paired_over_games`]) with
/// the standard deviations in [`Spread::default`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PowerRow {
    /// A phrase that describes the plan.
    pub plan: String,
    /// The number of games.
    pub games: u64,
    /// The number of levels per game.
    pub levels: u64,
    /// The number of episodes per player and level.
    pub runs: u64,
    /// The number of episodes per player.
    pub episodes: u64,
    /// The smallest win rate distinguishable from 0.1 with 80% power.
    pub from_tenth: Option<f64>,
    /// The smallest win rate distinguishable from 0.5 with 80% power.
    pub from_half: Option<f64>,
}

/// Returns a plan's power and, for comparison, the power of plans with at most as many episodes.
///
/// ```
/// use infinite_arcade_evaluation::study::power;
/// use statistics::Design;
/// let rows = power(Design { games: 6, levels: 5, runs: 5 });
/// let episodes: Vec<(u64, u64)> = rows.iter().map(|row| (row.games, row.episodes)).collect();
/// assert_eq!(episodes, [(6, 150), (6, 30), (30, 150), (150, 150)]);
/// assert!(rows[2].from_tenth < rows[0].from_tenth, "more games show more than more runs");
/// ```
pub fn power(planned: Design) -> Vec<PowerRow> {
    let Design { games, levels, runs } = planned;
    if planned.episodes() == 0 {
        return Vec::new();
    }
    let plans = [
        ("as planned", planned),
        ("one run on each level", Design { runs: 1, ..planned }),
        (
            "the same number of episodes, with one run on more games",
            Design { games: games * runs, runs: 1, ..planned },
        ),
        (
            "the same number of episodes, each on a different game",
            Design { games: games * levels * runs, levels: 1, runs: 1 },
        ),
    ];
    plans.into_iter().unique_by(|(_, design)| *design).map(|(plan, design)| row(plan, design)).collect()
}

fn row(plan: &str, design: Design) -> PowerRow {
    let Design { games, levels, runs } = design;
    let from = |base| design.detectable(base, Spread::default(), 0.05, 0.8);
    let (from_tenth, from_half) = (from(0.1), from(0.5));
    PowerRow {
        plan: plan.to_owned(),
        games,
        levels,
        runs,
        episodes: design.episodes(),
        from_tenth,
        from_half,
    }
}

/// Returns the power of a study's episodes, using the design of the player with the fewest games.
pub(crate) fn of_study(study: &Study) -> Vec<PowerRow> {
    let played = |player: usize| {
        let ended = || study.on(player, None, None).iter().filter(|episode| episode.metrics.counts());
        let games = ended().map(|episode| episode.game).unique().count() as u64;
        let levels = ended().map(|episode| (episode.game, episode.metrics.level)).unique().count() as u64;
        let rounded = |all: u64, each: u64| (all + each / 2) / each.max(1);
        Design { games, levels: rounded(levels, games), runs: rounded(ended().count() as u64, levels) }
    };
    let designs = (0..study.players.len()).map(played).filter(|design| design.episodes() > 0);
    let fewest = designs.min_by_key(|design| (design.games, design.episodes()));
    let mut rows = fewest.map_or(Vec::new(), power);
    rows.iter_mut().take(1).for_each(|row| "as played".clone_into(&mut row.plan));
    rows
}

/// Returns the rows as a table.
pub fn table(rows: &[PowerRow]) -> Table {
    let Spread { games, levels, matches } = Spread::default();
    let note = format!(
        "The smallest win rates that can be distinguished from 0.1 and from 0.5, with a power of 80%, by the \
         paired test over games at 5%. Assumed standard deviations in logits: games {games}, levels {levels}, match of \
         player and game {matches}. A dash: no rate can be distinguished, as is always the case with fewer than \
         six games. Adding games helps more than adding runs. With a correction for many \
         comparisons, the power is lower."
    );
    Table::of(
        "power",
        "Statistical power",
        &note,
        rows,
        &[
            ("plan", &|row| TableCell::text(&row.plan)),
            ("games", &|row| TableCell::Count(row.games)),
            ("levels", &|row| TableCell::Count(row.levels)),
            ("runs", &|row| TableCell::Count(row.runs)),
            ("episodes per side", &|row| TableCell::Count(row.episodes)),
            ("0.1 against", &|row| TableCell::number(row.from_tenth, 2)),
            ("0.5 against", &|row| TableCell::number(row.from_half, 2)),
        ],
    )
}
