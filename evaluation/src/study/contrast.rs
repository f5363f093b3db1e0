//! Comparisons of two players: different models, a model in both modes, and a model with and without an aid.

use crate::study::Study;
use crate::study::player::{CONTEXTUAL, ZERO_SHOT};
use crate::study::scores::Estimate;
use crate::study::{LEVEL, RESAMPLES, seed};
use itertools::Itertools;
use report::{Table, TableCell};
use serde::Serialize;
use statistics::{
    Stratum, Z95, benjamini_hochberg, clustered_difference, cohens_h, difference, fisher, stratified,
};
use std::collections::{BTreeMap, BTreeSet};

/// Comparisons of pairs of players. Each of the three lists is a separate family for the correction of Benjamini and
/// Hochberg: all pairs on all levels, on all games, and over all. It includes every pair with episodes on both sides, even
/// ties, so that the family does not depend on the results.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Contrasts {
    /// A comparison for each pair and level.
    pub by_level: Vec<Comparison>,
    /// A comparison for each pair and game, with all its levels together.
    pub by_game: Vec<Comparison>,
    /// A comparison for each pair over all levels that both played, stratified by level.
    pub overall: Vec<OverallComparison>,
}

/// A comparison of two players on a level or a game.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// The indices into the players of the study.
    pub players: [usize; 2],
    /// The index into the games of the study.
    pub game: usize,
    /// The level's number, or `None` for all levels.
    pub level: Option<usize>,
    /// The wins of each player.
    pub wins: [u64; 2],
    /// The episodes of each player.
    pub episodes: [u64; 2],
    /// The p-value of Fisher's exact test, two-sided.
    pub p: f64,
    /// The p-value corrected for all comparisons of the list, by Benjamini and Hochberg.
    pub q: f64,
    /// Cohen's h of the first player's win rate against the second's.
    pub h: f64,
    /// The first player's win rate minus the second's, with Newcombe's interval.
    pub difference: Estimate,
}

/// A comparison of two players on all levels that both played.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OverallComparison {
    /// The indices into the players of the study.
    pub players: [usize; 2],
    /// The wins of each player on these levels.
    pub wins: [u64; 2],
    /// The episodes of each player on these levels.
    pub episodes: [u64; 2],
    /// The number of levels that both played.
    pub levels: u64,
    /// The p-value of the exact stratified test (Cochran, Mantel, Haenszel), two-sided. It refers to these levels only.
    pub p: f64,
    /// The p-value corrected for all pairs of the list, by Benjamini and Hochberg.
    pub q: f64,
    /// Cohen's h of the pooled win rates.
    pub h: f64,
    /// The mean difference of the win rates over the levels, weighted by their episodes.
    pub difference: f64,
    /// The difference of the pooled win rates with a confidence interval from a bootstrap over whole games: it generalises
    /// to games like these. Missing with fewer than two games.
    pub by_game: Option<Estimate>,
    /// The common odds ratio of Mantel and Haenszel; missing if infinite.
    pub odds_ratio: Option<f64>,
}

/// Numbers of wins and episodes.
type Counts = (u64, u64);

impl Contrasts {
    pub(crate) fn of(study: &Study, pairs: &[[usize; 2]]) -> Contrasts {
        let counts = counts(study);
        let mut contrasts = Contrasts::default();
        for &players in pairs {
            let [ours, theirs] = players.map(|player| &counts[player]);
            let levels: Vec<(usize, usize)> =
                ours.keys().filter(|level| theirs.contains_key(level)).copied().collect();
            for &(game, level) in &levels {
                let both = [ours[&(game, level)], theirs[&(game, level)]];
                contrasts.by_level.push(Comparison::of(players, game, Some(level), both));
            }
            let games: BTreeSet<usize> = levels.iter().map(|(game, _)| *game).collect();
            for game in games {
                let on = |counts: &BTreeMap<(usize, usize), Counts>| {
                    let levels = levels.iter().filter(|level| level.0 == game);
                    levels.fold((0, 0), |sum, level| (sum.0 + counts[level].0, sum.1 + counts[level].1))
                };
                contrasts.by_game.push(Comparison::of(players, game, None, [on(ours), on(theirs)]));
            }
            contrasts.overall.extend(OverallComparison::of(players, &levels, [ours, theirs]));
        }
        let correct = |p: Vec<f64>| benjamini_hochberg(&p);
        for list in [&mut contrasts.by_level, &mut contrasts.by_game] {
            let q = correct(list.iter().map(|comparison| comparison.p).collect());
            list.iter_mut().zip(q).for_each(|(comparison, q)| comparison.q = q);
        }
        let q = correct(contrasts.overall.iter().map(|comparison| comparison.p).collect());
        contrasts.overall.iter_mut().zip(q).for_each(|(comparison, q)| comparison.q = q);
        contrasts
    }

    /// Compares models in the same mode with each other, and with players that are not models. Variants of one model are
    /// compared in [`Contrasts::modes`] and [`Contrasts::aids`].
    pub(crate) fn pairs(study: &Study) -> Contrasts {
        let players = study.players.iter().enumerate();
        let pairs = players.tuple_combinations().filter(|((_, ours), (_, theirs))| {
            let comparable = ours.mode == theirs.mode || ours.is_reference() || theirs.is_reference();
            comparable && ours.name != theirs.name
        });
        Contrasts::of(study, &pairs.map(|((a, _), (b, _))| [a, b]).collect_vec())
    }

    /// Compares the two modes of the same model: zero-shot first, contextual second.
    pub(crate) fn modes(study: &Study) -> Contrasts {
        let partner = |(a, ours): (usize, &super::Player)| {
            let is_partner = |theirs: &super::Player| {
                (&theirs.name, &theirs.aids) == (&ours.name, &ours.aids)
                    && theirs.mode.as_deref() == Some(CONTEXTUAL)
            };
            let b = study.players.iter().position(is_partner)?;
            (ours.mode.as_deref() == Some(ZERO_SHOT)).then_some([a, b])
        };
        let pairs: Vec<[usize; 2]> = study.players.iter().enumerate().filter_map(partner).collect();
        Contrasts::of(study, &pairs)
    }

    /// Compares the same model in the same mode without and with one aid: without it first.
    pub(crate) fn aids(study: &Study) -> Contrasts {
        let players = study.players.iter().enumerate();
        let pairs = players.clone().cartesian_product(players).filter(|((_, without), (_, with))| {
            let same = (&without.name, &without.mode) == (&with.name, &with.mode);
            let more = with.aids.len() == without.aids.len() + 1;
            same && more && without.aids.iter().all(|aid| with.aids.contains(aid))
        });
        Contrasts::of(study, &pairs.map(|((a, _), (b, _))| [a, b]).collect_vec())
    }

    /// Returns `true` if there are no comparisons.
    pub fn is_empty(&self) -> bool {
        self.overall.is_empty()
    }

    /// Returns the three lists as tables, by increasing p. At most the first `most` rows of the longer ones are included.
    pub(crate) fn tables(&self, study: &Study, id: &str, title: &str, most: usize) -> Vec<Table> {
        if self.is_empty() {
            return Vec::new();
        }
        let label = |player: usize| TableCell::text(study.players[player].label());
        let share = |wins: u64, episodes: u64| TableCell::text(format!("{wins}/{episodes}"));
        let overall = Table::of(
            &format!("{id}-overall"),
            &format!("{title}, over all levels"),
            "p: exact test within levels (Cochran, Mantel, Haenszel). q: corrected for the pairs of this table (Benjamini, Hochberg). \
             h: Cohen's effect size (0.2 small, 0.5 medium, 0.8 large). The difference of win rates, with a bootstrap \
             interval over whole games.",
            &self.overall,
            &[
                ("first", &|found| label(found.players[0])),
                ("second", &|found| label(found.players[1])),
                ("levels", &|found| TableCell::Count(found.levels)),
                ("wins", &|found| share(found.wins[0], found.episodes[0])),
                ("wins of second", &|found| share(found.wins[1], found.episodes[1])),
                ("difference", &|found| match found.by_game {
                    Some(estimate) => Estimate::cell(Some(estimate), 2),
                    None => TableCell::number(found.difference, 2),
                }),
                ("odds ratio", &|found| TableCell::number(found.odds_ratio, 2)),
                ("h", &|found| TableCell::number(found.h, 2)),
                ("p", &|found| TableCell::Probability(found.p)),
                ("q", &|found| TableCell::Probability(found.q)),
            ],
        );
        let list = |grain: &str, list: &[Comparison]| {
            let sorted = list.iter().sorted_by(|a, b| a.p.total_cmp(&b.p)).collect_vec();
            let believed = list.iter().filter(|comparison| comparison.q <= 0.05).count();
            let note = format!(
                "Fisher's exact test, two-sided; q: corrected for all {} comparisons (Benjamini, Hochberg), of which {believed} have at \
                 most 0.05. The difference of win rates with Newcombe's 95 % interval.{}",
                list.len(),
                if list.len() > most {
                    format!(" Only the {most} with the smallest p are shown.")
                } else {
                    String::new()
                }
            );
            Table::of(
                &format!("{id}-by-{grain}"),
                &format!("{title}, by {grain}"),
                &note,
                &sorted[..sorted.len().min(most)],
                &[
                    ("first", &|found| label(found.players[0])),
                    ("second", &|found| label(found.players[1])),
                    (grain, &|found| TableCell::text(study.place(found.game, found.level))),
                    ("wins", &|found| share(found.wins[0], found.episodes[0])),
                    ("wins of second", &|found| share(found.wins[1], found.episodes[1])),
                    ("difference", &|found| Estimate::cell(Some(found.difference), 2)),
                    ("h", &|found| TableCell::number(found.h, 2)),
                    ("p", &|found| TableCell::Probability(found.p)),
                    ("q", &|found| TableCell::Probability(found.q)),
                ],
            )
        };
        vec![overall, list("game", &self.by_game), list("level", &self.by_level)]
    }
}

impl Comparison {
    fn of(players: [usize; 2], game: usize, level: Option<usize>, counts: [Counts; 2]) -> Comparison {
        let (wins, episodes) = (counts.map(|count| count.0), counts.map(|count| count.1));
        let rates = [0, 1].map(|side: usize| wins[side] as f64 / episodes[side] as f64);
        let p = fisher(wins, episodes);
        let interval = difference(wins, episodes, Z95);
        Comparison {
            players,
            game,
            level,
            wins,
            episodes,
            p,
            q: p,
            h: cohens_h(rates[0], rates[1]),
            difference: Estimate::new(rates[0] - rates[1], interval),
        }
    }
}

impl OverallComparison {
    fn of(
        players: [usize; 2],
        levels: &[(usize, usize)],
        counts: [&BTreeMap<(usize, usize), Counts>; 2],
    ) -> Option<OverallComparison> {
        let stratum = |level: &(usize, usize)| {
            let both = counts.map(|counts| counts[level]);
            Stratum { successes: both.map(|count| count.0), trials: both.map(|count| count.1) }
        };
        let strata: Vec<Stratum> = levels.iter().map(stratum).collect();
        let test = stratified(&strata);
        let total =
            |of: fn(&Stratum) -> [u64; 2]| [0, 1].map(|side: usize| strata.iter().map(|s| of(s)[side]).sum());
        let (wins, episodes): ([u64; 2], [u64; 2]) = (total(|s| s.successes), total(|s| s.trials));
        let rates = [0, 1].map(|side: usize| wins[side] as f64 / episodes[side].max(1) as f64);
        // The wins and losses of each game on either side.
        let mut games: BTreeMap<usize, (Vec<f64>, Vec<f64>)> = BTreeMap::new();
        for ((game, _), stratum) in levels.iter().zip(&strata) {
            let sides = games.entry(*game).or_default();
            for (side, values) in [&mut sides.0, &mut sides.1].into_iter().enumerate() {
                let (won, of) = (stratum.successes[side], stratum.trials[side]);
                values.extend((0..of).map(|episode| f64::from(u8::from(episode < won))));
            }
        }
        let games: Vec<(Vec<f64>, Vec<f64>)> = games.into_values().collect();
        let place = players[0] << 16 | players[1];
        let interval =
            clustered_difference(&games, RESAMPLES, LEVEL, seed("pairs", place)).filter(|_| games.len() > 1);
        Some(OverallComparison {
            players,
            wins,
            episodes,
            levels: levels.len() as u64,
            p: test.p,
            q: test.p,
            h: cohens_h(rates[0], rates[1]),
            difference: test.difference?,
            by_game: interval.map(|interval| Estimate::new(rates[0] - rates[1], interval)),
            odds_ratio: test.odds_ratio.filter(|ratio| ratio.is_finite()),
        })
    }
}

/// Counts the wins and ended episodes of each player on each level.
fn counts(study: &Study) -> Vec<BTreeMap<(usize, usize), Counts>> {
    let mut counts = vec![BTreeMap::<(usize, usize), Counts>::new(); study.players.len()];
    for episode in study.episodes.iter().filter(|episode| episode.metrics.counts()) {
        let count = counts[episode.player].entry((episode.game, episode.metrics.level)).or_default();
        count.0 += u64::from(episode.metrics.won());
        count.1 += 1;
    }
    counts
}
