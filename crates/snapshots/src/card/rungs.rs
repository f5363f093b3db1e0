//! The win rates of the ladder's reference players over a whole release, and the differences between two releases.
//!
//! A level's rate is the fraction of its episodes that were won, and all levels have the same weight. Levels of the
//! same game are correlated, so the intervals use games as the sampling unit ([`statistics::share_over_games`]). The
//! interval for a difference combines the intervals of its two sides (G. Y. Zou and A. Donner, "Construction of
//! confidence limits about effect measures: a general approach", 2008), treating the two sets of games as independent
//! samples. The results are bit-identical on every machine.

use forge::card::Card;
use serde::{Deserialize, Serialize};
use statistics::{Interval, Z95, share_over_games};
use validators::PlayerResult;

/// The difference, in standard errors, that a two-sided test at the 5% level detects with 80% power: the sum of the
/// normal quantiles at 0.975 and 0.8.
const DETECTABLE_ERRORS: f64 = Z95 + 0.8416212335729143;

/// A player's win rate over a release's games.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RungRate {
    /// The player, such as `mcts:100`.
    pub player: String,
    /// `true` if the player looks ahead.
    pub looks_ahead: bool,
    /// `true` if the player is used only for acceptance and never in a search.
    pub held_out: bool,
    /// The number of games in which the player played at least one level.
    pub games: u64,
    /// The number of levels played by the player.
    pub levels: u64,
    /// The number of episodes, across all levels.
    pub plays: u64,
    /// The number of episodes won.
    pub wins: u64,
    /// The mean over levels of the fraction of episodes won, from 0 to 1.
    pub mean: f64,
    /// The 95% interval of the mean, clustered by game.
    pub interval: [f64; 2],
    /// The standard error of the mean, clustered by game; `None` if all games have the same rate, as a single
    /// game always does.
    pub error: Option<f64>,
}

impl RungRate {
    /// Returns the smallest difference in win rate that a two-sided test at the 5% level detects with 80% power
    /// between two releases of `games` such games each. Returns `None` if there are no games, or if their variance is
    /// unknown.
    ///
    /// The estimate assumes that both releases have the same variance and number of levels per game as the
    /// release measured here.
    pub fn detectable(&self, games: u64) -> Option<f64> {
        let error = self.error.filter(|_| games > 0)?;
        let one = error * error * self.games as f64 / games as f64;
        Some(DETECTABLE_ERRORS * (2.0 * one).sqrt())
    }

    fn of(first: &PlayerResult, held_out: bool, games: &[Vec<&PlayerResult>]) -> RungRate {
        let counts = |levels: &Vec<&PlayerResult>| {
            levels.iter().map(|result| (result.rate.wins, result.rate.plays)).collect::<Vec<_>>()
        };
        let of_games: Vec<Vec<(u64, u64)>> = games.iter().map(counts).collect();
        let Clustered { games, plays, wins, mean, interval, error } = Clustered::of(&of_games);
        RungRate {
            player: first.player.clone(),
            looks_ahead: first.looks_ahead,
            held_out,
            games,
            levels: of_games.iter().map(Vec::len).sum::<usize>() as u64,
            plays,
            wins,
            mean,
            interval,
            error,
        }
    }
}

/// A win rate over equally weighted levels, with its interval, clustered by game.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Clustered {
    /// The number of games.
    pub games: u64,
    /// The number of episodes, across all levels.
    pub plays: u64,
    /// The number of episodes won.
    pub wins: u64,
    /// The mean over levels of the fraction of episodes won, from 0 to 1.
    pub mean: f64,
    /// The 95% interval of the mean, clustered by game.
    pub interval: [f64; 2],
    /// The standard error of the mean, clustered by game; `None` if all games have the same rate, as a single
    /// game always does.
    pub error: Option<f64>,
}

impl Clustered {
    /// Computes the rate over all levels, each given as its number of wins and number of episodes. At least
    /// one level is required.
    pub(crate) fn of(games: &[Vec<(u64, u64)>]) -> Clustered {
        let share = |&(wins, plays): &(u64, u64)| wins as f64 / plays as f64;
        let sum = |levels: &Vec<(u64, u64)>| (levels.iter().map(share).sum::<f64>(), levels.len() as f64);
        let sums: Vec<(f64, f64)> = games.iter().map(sum).collect();
        let all = || games.iter().flatten();
        let won: f64 = sums.iter().map(|game| game.0).sum();
        let mean = (won / all().count() as f64).clamp(0.0, 1.0);
        // A single game reveals nothing about the variance between games.
        let found = share_over_games(&sums, 0.95);
        let interval = found.map_or(Interval { low: 0.0, high: 1.0 }, |found| found.interval);
        Clustered {
            games: games.len() as u64,
            plays: all().map(|(_, plays)| plays).sum(),
            wins: all().map(|(wins, _)| wins).sum(),
            mean,
            interval: [interval.low.clamp(0.0, mean), interval.high.clamp(mean, 1.0)],
            error: found.and_then(|found| found.error),
        }
    }

    /// Returns the mean of `self` minus the mean of `other`, with the interval of the difference. The two
    /// sets of games are treated as independent samples.
    pub(crate) fn minus(&self, other: &Clustered) -> (f64, [f64; 2]) {
        difference((self.mean, self.interval), (other.mean, other.interval))
    }
}

/// Returns the difference between two rates, with its interval. Each rate is given with its interval.
fn difference((ours, own): (f64, [f64; 2]), (theirs, other): (f64, [f64; 2])) -> (f64, [f64; 2]) {
    let below = apart(ours - own[0], other[1] - theirs);
    let above = apart(own[1] - ours, theirs - other[0]);
    let difference = ours - theirs;
    (difference, [(difference - below).max(-1.0), (difference + above).min(1.0)])
}

fn apart(x: f64, y: f64) -> f64 {
    (x * x + y * y).sqrt()
}

/// Returns the win rate of each reference player over some games. The players on the ladder come first, from weakest to
/// strongest in the first ladder's order, followed by the held-out players. Levels without a ladder are skipped.
pub fn rates(cards: &[Card]) -> Vec<RungRate> {
    let ladders = || cards.iter().flat_map(|card| &card.levels).filter_map(|level| level.ladder.as_ref());
    let mut players: Vec<(&PlayerResult, bool)> = Vec::new();
    for held_out in [false, true] {
        for result in ladders().flat_map(|ladder| if held_out { &ladder.held_out } else { &ladder.rungs }) {
            let known =
                players.iter().any(|(known, held)| known.player == result.player && *held == held_out);
            if !known {
                players.push((result, held_out));
            }
        }
    }
    let rate = |(first, held_out): (&PlayerResult, bool)| {
        let of_game = |card| played(card, &first.player, held_out);
        let mut games: Vec<Vec<&PlayerResult>> = cards.iter().map(of_game).collect();
        games.retain(|levels| !levels.is_empty());
        (!games.is_empty()).then(|| RungRate::of(first, held_out, &games))
    };
    players.into_iter().filter_map(rate).collect()
}

/// Returns a player's results on those levels of a game that the player played.
fn played<'a>(card: &'a Card, player: &str, held_out: bool) -> Vec<&'a PlayerResult> {
    let ladders = card.levels.iter().filter_map(|level| level.ladder.as_ref());
    let find = ladders.filter_map(|ladder| {
        let players = if held_out { &ladder.held_out } else { &ladder.rungs };
        players.iter().find(|result| result.player == player && result.rate.plays > 0)
    });
    find.collect()
}

/// The difference in a player's win rate between two releases.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RungDifference {
    /// The win rate in the first release.
    pub ours: RungRate,
    /// The win rate in the second release.
    pub theirs: RungRate,
    /// The mean of `ours` minus the mean of `theirs`, from −1 to 1.
    pub difference: f64,
    /// The 95% interval of the difference, clustered by game.
    pub interval: [f64; 2],
    /// The smallest difference that a two-sided test at the 5% level detects with 80% power between two releases of
    /// these sizes; `None` if all games of either release have the same rate.
    pub detectable: Option<f64>,
}

impl RungDifference {
    /// Returns `true` if the interval contains 0, which means that the player may be equally good in both releases.
    pub fn includes_zero(&self) -> bool {
        self.interval[0] <= 0.0 && self.interval[1] >= 0.0
    }

    fn of(ours: RungRate, theirs: RungRate) -> RungDifference {
        let (difference, interval) = difference((ours.mean, ours.interval), (theirs.mean, theirs.interval));
        let errors = ours.error.zip(theirs.error);
        RungDifference {
            difference,
            interval,
            detectable: errors.map(|(ours, theirs)| DETECTABLE_ERRORS * apart(ours, theirs)),
            ours,
            theirs,
        }
    }
}

/// Returns the differences between the win rates over two sets of games, for players present in both sets, in the
/// order of [`rates`]. Cost: two calls to `rates`.
pub fn differences(ours: &[Card], theirs: &[Card]) -> Vec<RungDifference> {
    let mut others = rates(theirs);
    let pair = |ours: RungRate| {
        let same = |theirs: &RungRate| theirs.player == ours.player && theirs.held_out == ours.held_out;
        let at = others.iter().position(same)?;
        Some(RungDifference::of(ours, others.remove(at)))
    };
    rates(ours).into_iter().filter_map(pair).collect()
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use base::Digest;
    use forge::card::{LevelCard, Origin};
    use validators::{Difficulty, Ladder, Rate};

    fn result(player: &str, wins: u64, plays: u64) -> PlayerResult {
        let rate = Rate { wins, plays, interval: [0.0, 1.0], calls: 0, mean_score: 0.0 };
        let looks_ahead = player.contains(':');
        PlayerResult { player: player.to_owned(), looks_ahead, rate, win_ticks: None, reward: None }
    }

    /// Returns a game card with ten episodes per player and level. `wins` states the wins of `random` and of the
    /// held-out `olets:9` on each level.
    pub(crate) fn card(id: &str, wins: &[[u64; 2]]) -> Card {
        let level = |[random, olets]: &[u64; 2]| LevelCard {
            file: "lvl0.txt".to_owned(),
            digest: Digest::of(b""),
            columns: 9,
            rows: 9,
            generator: "g".to_owned(),
            asks: None,
            difficulty: 0.5,
            candidate: 0,
            witness_ticks: 9,
            witness_score: 1.0,
            optimal_ticks: None,
            search_calls: 1,
            mcts: result("", 0, 4).rate,
            random: result("", 0, 4).rate,
            idle: result("", 0, 4).rate,
            demand: None,
            tier: None,
            ladder: Some(Ladder {
                rungs: vec![result("random", *random, 10)],
                held_out: vec![result("olets:9", *olets, 10)],
                ease: Some(0.5),
                difficulty: Difficulty::Medium,
            }),
        };
        Card {
            canary: String::new(),
            id: id.to_owned(),
            title: id.to_owned(),
            description: String::new(),
            goal: String::new(),
            kind: String::new(),
            real_time: false,
            deterministic: true,
            digest: Digest::of(id.as_bytes()),
            origin: Origin::Corpus { name: id.to_owned() },
            rules: String::new(),
            levels: wins.iter().map(level).collect(),
        }
    }

    /// Returns the cards of forty games with three levels each. Every fourth game is always won.
    fn quarter() -> Vec<Card> {
        let wins = |game: u64| [if game.is_multiple_of(4) { 10 } else { 0 }, 10];
        (0..40).map(|game| card(&format!("g{game}"), &[wins(game); 3])).collect()
    }

    #[test]
    fn games_are_the_unit_of_resampling() {
        let found = rates(&quarter());
        let [random, olets] = &found[..] else { panic!("{found:?}") };
        assert_eq!((random.player.as_str(), random.held_out, random.looks_ahead), ("random", false, false));
        assert_eq!((random.games, random.levels, random.plays, random.wins), (40, 120, 1200, 300));
        assert_eq!(random.mean, 0.25);
        // The interval is as wide as an interval from 40 trials at a rate of 0.25 (±13 points), not one from 120
        // trials.
        let error = random.error.unwrap();
        assert!((error - (0.25 * 0.75 / 39.0_f64).sqrt()).abs() < 1e-12, "{error}");
        let [low, high] = random.interval;
        assert!((low - 0.116).abs() < 0.03 && (high - 0.384).abs() < 0.03, "{low} to {high}");
        assert_eq!((olets.player.as_str(), olets.held_out, olets.looks_ahead), ("olets:9", true, true));
        // A rate of 1 in the sample does not prove that the true rate is 1.
        let trials = statistics::rate_over_games(&[(1, 1); 40], 0.95).unwrap().interval;
        assert_eq!((olets.mean, olets.interval, olets.error), (1.0, [trials.low, 1.0], None));
        assert!((trials.low - 0.907).abs() < 1e-3, "{trials:?}");
        assert_eq!(olets.detectable(1000), None);
    }

    #[test]
    fn levels_are_weighted_equally() {
        let mut cards = vec![card("a", &[[10, 0], [0, 0]]), card("b", &[[0, 0]])];
        cards[0].levels[0].ladder.as_mut().unwrap().rungs[0].rate.plays = 1000;
        cards[0].levels[0].ladder.as_mut().unwrap().rungs[0].rate.wins = 1000;
        let unmeasured = LevelCard { ladder: None, ..cards[1].levels[0].clone() };
        cards[1].levels.push(unmeasured);
        let found = &rates(&cards)[0];
        assert_eq!((found.mean, found.levels, found.games), (1.0 / 3.0, 3, 2));
    }

    #[test]
    fn few_games_give_wide_intervals() {
        let found = &rates(&[card("a", &[[5, 5], [5, 5]])])[0];
        assert_eq!((found.mean, found.interval, found.error), (0.5, [0.0, 1.0], None));
        assert!(rates(&[]).is_empty());
        assert!(differences(&quarter(), &[]).is_empty());
    }

    #[test]
    fn equal_releases_have_no_differences() {
        for found in differences(&quarter(), &quarter()) {
            assert_eq!(found.difference, 0.0);
            assert!(found.includes_zero(), "{found:?}");
            assert!((found.interval[0] + found.interval[1]).abs() < 0.1, "{found:?}");
        }
    }

    /// The interval's width should match the normal approximation of ±1.96 √2 standard errors. With fewer
    /// than a hundred games, it is wider.
    #[test]
    fn differences_are_as_wide_as_theory_says() {
        let half: Vec<Card> =
            (0..40).map(|game| card(&format!("h{game}"), &[[10 * (game % 2), 0]; 3])).collect();
        let found = differences(&half, &quarter());
        let random = &found[0];
        assert_eq!(random.difference, 0.25);
        let error = ((0.25 + 0.25 * 0.75) / 39.0_f64).sqrt();
        for (found, expect) in random.interval.iter().zip([0.25 - Z95 * error, 0.25 + Z95 * error]) {
            assert!((found - expect).abs() < 0.03, "{random:?}, not {expect}");
        }
        assert!((random.detectable.unwrap() - 2.8015 * error).abs() < 1e-4, "{random:?}");
        // The player always wins on one side and never on the other, so 40 games per side leave no doubt.
        let olets = &found[1];
        assert_eq!((olets.difference, olets.detectable), (-1.0, None));
        assert!(olets.interval[0] == -1.0 && olets.interval[1] < -0.8 && !olets.includes_zero());
    }

    #[test]
    fn more_games_detect_smaller_differences() {
        let found = &differences(&quarter(), &quarter())[0];
        let same = found.ours.detectable(40).unwrap();
        assert!((same - found.detectable.unwrap()).abs() < 1e-12);
        assert!((found.ours.detectable(160).unwrap() - same / 2.0).abs() < 1e-12);
        assert_eq!(found.ours.detectable(0), None);
    }
}
