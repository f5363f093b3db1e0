//! Compares pairs of players: different models, one model in both modes, or one model with and without an aid (an
//! optional part of the prompt).

use crate::study::episodes::scores::{Estimate, StudyEpisode, observations};
use crate::study::players::player::{CONTEXTUAL, ZERO_SHOT};
use crate::study::{LEVEL, Study};
use itertools::Itertools;
use report::{Table, TableCell};
use serde::Serialize;
use statistics::{
    Stratum, Z95, benjamini_hochberg, cohens_h, difference, fisher, paired_over_games, stratified,
};
use std::collections::{BTreeMap, BTreeSet};

/// The comparisons of pairs of players. Each of the three lists is a separate family for the
/// Benjamini–Hochberg correction. A family includes every pair in which both players have episodes, even if
/// their results are equal, so that its size does not depend on the results.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Contrasts {
    /// Each pair's comparison on each level.
    pub by_level: Vec<Comparison>,
    /// Each pair's comparison on each game, over all levels of the game.
    pub by_game: Vec<Comparison>,
    /// Each pair's comparison over all games that both players played.
    pub overall: Vec<OverallComparison>,
}

/// A comparison of two players on a level or a game.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// The two players' indices in the study.
    pub players: [usize; 2],
    /// The game's index in the study.
    pub game: usize,
    /// The level number, or `None` for all levels of the game.
    pub level: Option<usize>,
    /// Each player's number of wins. Identical episodes count once.
    pub wins: [u64; 2],
    /// Each player's number of episodes. Identical episodes count once.
    pub episodes: [u64; 2],
    /// The two-sided p-value of Fisher's exact test.
    pub p: f64,
    /// The p-value, corrected for all comparisons in the list (Benjamini–Hochberg).
    pub q: f64,
    /// Cohen's h for the first player's win rate compared with the second player's.
    pub h: f64,
    /// The first player's win rate minus the second player's, with Newcombe's interval.
    pub difference: Estimate,
}

/// A comparison of two players on all levels that both played.
///
/// The difference, its interval, h, p and q are computed from the same two rates. Each rate is a mean over
/// games, where a game's value is the mean over its levels. The results generalise to similar games.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OverallComparison {
    /// The two players' indices in the study.
    pub players: [usize; 2],
    /// Each player's number of wins on the common levels.
    pub wins: [u64; 2],
    /// Each player's number of episodes on the common levels.
    pub episodes: [u64; 2],
    /// The number of levels that both players played.
    pub levels: u64,
    /// The number of games that both players played.
    pub games: u64,
    /// Each player's win rate.
    pub rates: [f64; 2],
    /// The first player's rate minus the second player's.
    pub difference: f64,
    /// The difference between the rates, with the interval from the paired t test over games. `None` if there
    /// are fewer than two games.
    pub over_games: Option<Estimate>,
    /// The bounds of the difference, computed as if one player had lost all of its aborted episodes and the
    /// other had won all of its own. `None` if no episode was aborted.
    pub bounds: Option<[f64; 2]>,
    /// The two-sided p-value of the paired t test over games. `None` if there are fewer than two games.
    pub p: Option<f64>,
    /// The p-value, corrected for all pairs in the list that have one (Benjamini–Hochberg).
    pub q: Option<f64>,
    /// Cohen's h, computed from the two players' rates.
    pub h: f64,
    /// The exact test within levels, which is valid for exactly the played levels rather than for similar
    /// games.
    pub within_levels: WithinLevels,
}

/// The exact stratified Cochran–Mantel–Haenszel test. Identical episodes count as one observation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WithinLevels {
    /// The two-sided p-value.
    pub p: f64,
    /// The Mantel–Haenszel common odds ratio, or `None` if it is infinite.
    pub odds_ratio: Option<f64>,
}

/// A player's results on a level.
#[derive(Clone, Copy, Default)]
struct Counts {
    /// The numbers of wins and of ended episodes.
    all: (u64, u64),
    /// The numbers of wins and of ended episodes. Identical episodes count once.
    distinct: (u64, u64),
    /// The number of aborted episodes.
    aborted: u64,
}

/// A player's results, by game index and level index.
type Results = BTreeMap<(usize, usize), Counts>;

impl Contrasts {
    pub(crate) fn of(study: &Study, pairs: &[[usize; 2]]) -> Contrasts {
        let counts = counts(study);
        let mut contrasts = Contrasts::default();
        for &players in pairs {
            let [ours, theirs] = players.map(|player| &counts[player]);
            let ended =
                |results: &Results, level: &(usize, usize)| results.get(level).is_some_and(|it| it.all.1 > 0);
            let levels: Vec<(usize, usize)> =
                ours.keys().filter(|level| ended(ours, level) && ended(theirs, level)).copied().collect();
            for &(game, level) in &levels {
                let both = [ours, theirs].map(|results| results[&(game, level)].distinct);
                contrasts.by_level.push(Comparison::of(players, game, Some(level), both));
            }
            let games: BTreeSet<usize> = levels.iter().map(|(game, _)| *game).collect();
            for game in games {
                let on = |results: &Results| {
                    let counts =
                        levels.iter().filter(|level| level.0 == game).map(|level| results[level].distinct);
                    counts.fold((0, 0), |sum, (wins, of)| (sum.0 + wins, sum.1 + of))
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
        let mut tested: Vec<&mut OverallComparison> =
            contrasts.overall.iter_mut().filter(|comparison| comparison.p.is_some()).collect();
        let q = correct(tested.iter().filter_map(|comparison| comparison.p).collect());
        tested.iter_mut().zip(q).for_each(|(comparison, q)| comparison.q = Some(q));
        contrasts
    }

    /// Compares models in the same mode with each other, and with players that are not models. A model is also compared
    /// with itself under different conditions. [`Contrasts::modes`] and [`Contrasts::aids`] compare a model's modes and
    /// aids (optional parts of the prompt).
    pub(crate) fn pairs(study: &Study) -> Contrasts {
        let players = study.players.iter().enumerate();
        let pairs = players.tuple_combinations().filter(|((_, ours), (_, theirs))| {
            let comparable = ours.mode == theirs.mode || ours.mode.is_none() || theirs.mode.is_none();
            let same = (&ours.name, &ours.conditions) == (&theirs.name, &theirs.conditions);
            comparable
                && !same
                && ours.is_comparable(theirs)
                && (ours.name != theirs.name || ours.aids == theirs.aids)
        });
        Contrasts::of(study, &pairs.map(|((a, _), (b, _))| [a, b]).collect_vec())
    }

    /// Compares each model's two modes, zero-shot mode first.
    pub(crate) fn modes(study: &Study) -> Contrasts {
        let partner = |(a, ours): (usize, &crate::study::Player)| {
            let is_partner = |theirs: &crate::study::Player| {
                (&theirs.name, &theirs.aids, &theirs.conditions) == (&ours.name, &ours.aids, &ours.conditions)
                    && theirs.mode.as_deref() == Some(CONTEXTUAL)
            };
            let b = study.players.iter().position(is_partner)?;
            (ours.mode.as_deref() == Some(ZERO_SHOT)).then_some([a, b])
        };
        let pairs: Vec<[usize; 2]> = study.players.iter().enumerate().filter_map(partner).collect();
        Contrasts::of(study, &pairs)
    }

    /// Compares each model with and without an aid (an optional part of the prompt), mode by mode. The variant without
    /// the aid comes first.
    pub(crate) fn aids(study: &Study) -> Contrasts {
        let players = study.players.iter().enumerate();
        let pairs = players.clone().cartesian_product(players).filter(|((_, without), (_, with))| {
            let of = |player: &crate::study::Player| {
                (player.name.clone(), player.mode.clone(), player.conditions.clone())
            };
            // A track (a bundle of settings) is not an aid (a single optional part of the prompt), so the results of
            // different tracks stay separate.
            let same = of(without) == of(with) && without.track() == with.track();
            let more = with.aids.len() == without.aids.len() + 1;
            same && more && without.aids.iter().all(|aid| with.aids.contains(aid))
        });
        Contrasts::of(study, &pairs.map(|((a, _), (b, _))| [a, b]).collect_vec())
    }

    /// Returns `true` if there are no comparisons.
    pub fn is_empty(&self) -> bool {
        self.overall.is_empty()
    }

    /// Returns the three lists as tables. The tables by game and by level are sorted by increasing p-value,
    /// and are truncated to `most` rows.
    pub(crate) fn tables(&self, study: &Study, id: &str, title: &str, most: usize) -> Vec<Table> {
        if self.is_empty() {
            return Vec::new();
        }
        let label = |player: usize| TableCell::text(study.players[player].label());
        let share = |wins: u64, episodes: u64| TableCell::text(format!("{wins}/{episodes}"));
        let overall = Table::of(
            &format!("{id}-overall"),
            &format!("{title}, over all levels"),
            "Difference: between the win rates (means over games of means over levels). Its 95% interval and p, \
             from the paired t-test over games, apply to games like these (other games of this kind). Fewer than \
             six games cannot show a difference at the 5% level. q: p corrected for the pairs in this table \
             (Benjamini–Hochberg). h: Cohen's effect size for the same rates (0.2 small, 0.5 medium, 0.8 large). Bounds: \
             the difference if all aborted episodes had gone against the first player, and if all had gone \
             in its favour. The last two columns apply to exactly these levels: the exact test within levels \
             (Cochran–Mantel–Haenszel) and its odds ratio, with identical episodes counted once.",
            &self.overall,
            &[
                ("first", &|found| label(found.players[0])),
                ("second", &|found| label(found.players[1])),
                ("games", &|found| TableCell::Count(found.games)),
                ("levels", &|found| TableCell::Count(found.levels)),
                ("wins", &|found| share(found.wins[0], found.episodes[0])),
                ("wins of second", &|found| share(found.wins[1], found.episodes[1])),
                ("difference", &|found| match found.over_games {
                    Some(estimate) => Estimate::cell(Some(estimate), 2),
                    None => TableCell::number(found.difference, 2),
                }),
                ("bounds", &|found| {
                    TableCell::figure(found.bounds.map(|[low, high]| format!("{low:.2} to {high:.2}")))
                }),
                ("h", &|found| TableCell::number(found.h, 2)),
                ("p", &|found| TableCell::probability(found.p)),
                ("q", &|found| TableCell::probability(found.q)),
                ("p, these levels", &|found| TableCell::Probability(found.within_levels.p)),
                ("odds ratio", &|found| TableCell::number(found.within_levels.odds_ratio, 2)),
            ],
        );
        let list = |grain: &str, list: &[Comparison]| {
            let sorted = list.iter().sorted_by(|a, b| a.p.total_cmp(&b.p)).collect_vec();
            let believed = list.iter().filter(|comparison| comparison.q <= 0.05).count();
            let note = format!(
                "Fisher's exact test, two-sided, for exactly these levels; identical episodes are counted \
                 once. q: corrected for all {} comparisons (Benjamini–Hochberg); {believed} of the \
                 corrected values are 0.05 or less. Difference: between the win rates, with Newcombe's 95% \
                 interval.{}",
                list.len(),
                if list.len() > most {
                    format!(" Only the {most} comparisons with the smallest p are shown.")
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
    fn of(players: [usize; 2], game: usize, level: Option<usize>, counts: [(u64, u64); 2]) -> Comparison {
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
        results: [&Results; 2],
    ) -> Option<OverallComparison> {
        let counts = |side: usize| levels.iter().map(move |level| results[side][level]);
        let total = |of: fn(&Counts) -> u64| [0, 1].map(|side: usize| counts(side).map(|it| of(&it)).sum());
        let games = by_game(levels, results, |it| it.all.0 as f64 / it.all.1 as f64);
        let count = games.len() as f64;
        let rates = [0, 1].map(|side: usize| games.iter().map(|game| game[side]).sum::<f64>() / count);
        let paired = paired_over_games(&games, LEVEL);
        let stratum = |level: &(usize, usize)| {
            let both = results.map(|results| results[level].distinct);
            Stratum { successes: both.map(|count| count.0), trials: both.map(|count| count.1) }
        };
        let test = stratified(&levels.iter().map(stratum).collect::<Vec<Stratum>>());
        (!games.is_empty()).then(|| OverallComparison {
            players,
            wins: total(|it| it.all.0),
            episodes: total(|it| it.all.1),
            levels: levels.len() as u64,
            games: games.len() as u64,
            rates,
            difference: rates[0] - rates[1],
            over_games: paired.map(|found| Estimate::new(found.difference, found.interval)),
            bounds: bounds(results),
            p: paired.map(|found| found.p),
            q: None,
            h: cohens_h(rates[0].clamp(0.0, 1.0), rates[1].clamp(0.0, 1.0)),
            within_levels: WithinLevels {
                p: test.p,
                odds_ratio: test.odds_ratio.filter(|ratio| ratio.is_finite()),
            },
        })
    }
}

/// Returns both players' rates on each game. Each rate is a mean over the game's levels.
fn by_game(
    levels: &[(usize, usize)],
    results: [&Results; 2],
    rate: impl Fn(&Counts) -> f64,
) -> Vec<[f64; 2]> {
    let mut games: BTreeMap<usize, Vec<[f64; 2]>> = BTreeMap::new();
    for level in levels {
        games.entry(level.0).or_default().push(results.map(|results| rate(&results[level])));
    }
    let mean = |levels: Vec<[f64; 2]>| {
        [0, 1].map(|side: usize| levels.iter().map(|rates| rates[side]).sum::<f64>() / levels.len() as f64)
    };
    games.into_values().map(mean).collect()
}

/// Returns the bounds of the difference on the levels that both players started, assuming that all aborted
/// episodes went against the first player or in its favour. Returns `None` if no episode was aborted.
fn bounds(results: [&Results; 2]) -> Option<[f64; 2]> {
    let levels: Vec<(usize, usize)> =
        results[0].keys().filter(|level| results[1].contains_key(level)).copied().collect();
    let any = levels.iter().any(|level| results.iter().any(|results| results[level].aborted > 0));
    any.then(|| {
        let rates = |all_won: bool| {
            let rate = |it: &Counts| {
                let wins = it.all.0 + if all_won { it.aborted } else { 0 };
                wins as f64 / (it.all.1 + it.aborted) as f64
            };
            by_game(&levels, results, rate)
        };
        let (lost, won) = (rates(false), rates(true));
        let mean = |ours: &[[f64; 2]], theirs: &[[f64; 2]]| {
            let sum: f64 = ours.iter().zip(theirs).map(|(ours, theirs)| ours[0] - theirs[1]).sum();
            sum / ours.len() as f64
        };
        [mean(&lost, &won), mean(&won, &lost)]
    })
}

/// Counts each player's results on each level.
fn counts(study: &Study) -> Vec<Results> {
    let mut counts = vec![Results::new(); study.players.len()];
    let key = |episode: &&StudyEpisode| (episode.player, episode.game, episode.metrics.level);
    for ((player, game, level), episodes) in &study.episodes.iter().chunk_by(key) {
        let (ended, aborted): (Vec<_>, Vec<_>) = episodes.partition(|episode| episode.metrics.counts());
        let wins = ended.iter().filter(|episode| episode.metrics.won()).count() as u64;
        counts[player].insert(
            (game, level),
            Counts {
                all: (wins, ended.len() as u64),
                distinct: observations(ended.into_iter()),
                aborted: aborted.len() as u64,
            },
        );
    }
    counts
}
