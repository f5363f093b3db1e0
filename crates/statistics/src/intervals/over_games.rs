//! Intervals for win rates and for their differences. The intervals apply to games similar to the ones played. Games
//! are the sampling unit, because episodes of the same game are similar, and different games suit different players.
//! Both intervals keep their coverage with six or more games (`cargo xtask simulate`).

use super::wilson::{Interval, score_interval};
use crate::student::{student_p, student_quantile};

/// A rate over several games, with its interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateOverGames {
    /// The total number of successes divided by the total number of trials.
    pub rate: f64,
    /// The effective sample size: the number of independent trials that would be equally informative.
    pub effective: f64,
    /// The rate's standard error, or `None` if all games have the same rate.
    pub error: Option<f64>,
    /// The rate's confidence interval.
    pub interval: Interval,
}

/// Returns the fraction of successes among all trials, with a confidence interval that applies to similar
/// games. `games` contains each game's numbers of successes and trials. Games without trials are ignored.
///
/// The method follows E. L. Korn and B. I. Graubard ("Confidence intervals for proportions with small expected number
/// of positive counts estimated from survey data", 1998). However, it uses Wilson's interval, computed from the
/// effective number of trials and a quantile of Student's t. The degrees of freedom are the number of games minus
/// one.
///
/// The effective number of trials follows from the variance between games (W. G. Cochran, *Sampling
/// Techniques*, 1977, §3.12). If all games have the same rate, the variance is unknown, and the effective
/// number of trials is the number of games. For example, if no episode is won in six games of 25 episodes
/// each, rates up to 0.52 remain possible.
///
/// Returns `None` if there are fewer than two games, if a game has more successes than trials, or if `level`
/// is not within 0..1. Cost: O(games).
///
/// ```
/// use infinite_arcade_statistics::rate_over_games;
/// let never = rate_over_games(&[(0, 25); 6], 0.95).unwrap();
/// assert_eq!((never.interval.low, never.effective), (0.0, 6.0));
/// assert!((never.interval.high - 0.5242).abs() < 1e-4);
/// ```
pub fn rate_over_games(games: &[(u64, u64)], level: f64) -> Option<RateOverGames> {
    let games: Vec<(f64, f64)> = games.iter().map(|&(won, of)| (won as f64, of as f64)).collect();
    share_over_games(&games, level)
}

/// Returns the mean of fractions from several games, with a confidence interval that applies to similar games. The
/// fractions can be the win rates of equally weighted levels, for example. The method is the same as in
/// [`rate_over_games`]. `games` contains the sum and the number of fractions for each game. Returns `None` if fewer
/// than two games have fractions, if a sum is out of range, or if `level` is not within 0..1.
///
/// ```
/// use infinite_arcade_statistics::share_over_games;
/// // Each game has three levels. The sum of the levels' win rates is 2.5 in one game and 0.5 in the other.
/// let found = share_over_games(&[(2.5, 3.0), (0.5, 3.0)], 0.95).unwrap();
/// assert_eq!((found.rate, found.error), (0.5, Some(1.0 / 3.0)));
/// ```
pub fn share_over_games(games: &[(f64, f64)], level: f64) -> Option<RateOverGames> {
    let played: Vec<(f64, f64)> = games.iter().copied().filter(|game| game.1 > 0.0).collect();
    let possible = played.iter().all(|(won, of)| (0.0..=*of).contains(won)) && level > 0.0 && level < 1.0;
    if played.len() < 2 || !possible {
        return None;
    }
    let count = played.len() as f64;
    let (won, of) = played.iter().fold((0.0, 0.0), |sum, game| (sum.0 + game.0, sum.1 + game.1));
    let rate = won / of;
    let squares: f64 = played
        .iter()
        .map(|(won, of)| {
            let apart = won - rate * of;
            apart * apart
        })
        .sum();
    let variance = squares * count / (count - 1.0) / (of * of);
    let error = (variance > 1e-18).then(|| variance.sqrt());
    let effective = error.map_or(count, |_| (rate * (1.0 - rate) / variance).clamp(1.0, of));
    let interval = score_interval(rate, effective, student_quantile(1.0 - level, count - 1.0));
    Some(RateOverGames { rate, effective, error, interval })
}

/// A comparison of two players over the games that both played.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairedOverGames {
    /// The two players' rates, as means over the games.
    pub rates: [f64; 2],
    /// The first player's rate minus the second player's rate.
    pub difference: f64,
    /// The difference's confidence interval.
    pub interval: Interval,
    /// The difference's two-sided p-value.
    pub p: f64,
}

/// Compares two players by their rates on each game, with a t test on the paired differences ("Student", "The
/// probable error of a mean", 1908). Each game counts once, regardless of its number of episodes. The difficulty of a
/// game cancels out in its difference.
///
/// For g games, the p-value is at least 2 · 2⁻ᵍ, which is the minimum p-value of the exact sign test (R. A. Fisher,
/// *The Design of Experiments*, 1935, §21). Fewer than six games therefore cannot prove a difference at the 5% level.
///
/// If the difference is the same on all games, its variance is unknown. In that case, the p-value is 2 · 2⁻ᵍ, or 1 if
/// the difference is zero. The interval is Newcombe's, computed from the Wilson intervals for the two rates, with the
/// games as trials.
///
/// Returns `None` if there are fewer than two games, if a rate is not a proportion, or if `level` is not
/// within 0..1. Cost: O(games).
///
/// ```
/// use infinite_arcade_statistics::paired_over_games;
/// let games = [[0.4, 0.2], [0.8, 0.4], [1.0, 0.8], [0.2, 0.0], [0.0, 0.2], [0.6, 0.2]];
/// let found = paired_over_games(&games, 0.95).unwrap();
/// assert!((found.difference - 0.2).abs() < 1e-12 && (found.p - 0.0756).abs() < 1e-4);
/// ```
pub fn paired_over_games(games: &[[f64; 2]], level: f64) -> Option<PairedOverGames> {
    let possible =
        games.iter().flatten().all(|rate| (0.0..=1.0).contains(rate)) && level > 0.0 && level < 1.0;
    if games.len() < 2 || !possible {
        return None;
    }
    let count = games.len() as f64;
    let rates = [0, 1].map(|side: usize| games.iter().map(|game| game[side]).sum::<f64>() / count);
    let differences: Vec<f64> = games.iter().map(|[ours, theirs]| ours - theirs).collect();
    let difference = differences.iter().sum::<f64>() / count;
    let squares: f64 = differences.iter().map(|one| (one - difference) * (one - difference)).sum();
    let error = (squares / (count - 1.0) / count).sqrt();
    let quantile = student_quantile(1.0 - level, count - 1.0);
    let least = least_p(games.len());
    let (interval, p) = if error > 1e-9 {
        let half = quantile * error;
        let interval = Interval { low: (difference - half).max(-1.0), high: (difference + half).min(1.0) };
        (interval, student_p(difference / error, count - 1.0).max(least))
    } else {
        let [ours, theirs] = rates.map(|rate| score_interval(rate.clamp(0.0, 1.0), count, quantile));
        let apart = |x: f64, y: f64| (x * x + y * y).sqrt();
        let low = difference - apart(rates[0] - ours.low, theirs.high - rates[1]);
        let high = difference + apart(ours.high - rates[0], rates[1] - theirs.low);
        let p = if difference.abs() > 1e-9 { least } else { 1.0 };
        (Interval { low: low.max(-1.0), high: high.min(1.0) }, p)
    };
    Some(PairedOverGames { rates, difference, interval, p })
}

/// Returns the minimum two-sided p-value of a sign test on the given number of differences.
pub(crate) fn least_p(games: usize) -> f64 {
    (0..games.min(1000)).fold(2.0, |least: f64, _| least / 2.0).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Z95;
    use crate::wilson;

    #[track_caller]
    fn close(found: f64, expect: f64) {
        assert!((found - expect).abs() < 1e-9, "{found}, not {expect}");
    }

    /// The expected values combine the variance of the ratio with Wilson's formula.
    #[test]
    fn a_rate_worked_by_hand() {
        let found = rate_over_games(&[(0, 10), (5, 10), (10, 10)], 0.95).unwrap();
        // The sum of the squares is 25 + 0 + 25, which is multiplied by 3/2 and divided by 900. The variance is 1/12,
        // so three games are worth three trials.
        close(found.rate, 0.5);
        close(found.effective, 3.0);
        let t: f64 = 4.302652729911275;
        let half = t * (0.25 / 3.0 + t * t / 36.0).sqrt() / (1.0 + t * t / 3.0);
        close(found.interval.low, 0.5 - half);
        close(found.interval.high, 0.5 + half);
    }

    /// If games differ no more than chance explains, all episodes count.
    #[test]
    fn equal_games_keep_their_episodes() {
        let games: Vec<(u64, u64)> = (0..400).map(|game| (10 + game % 2, 25)).collect();
        let found = rate_over_games(&games, 0.95).unwrap();
        close(found.effective, 10000.0);
        let plain = wilson(4200, 10000, Z95);
        assert!(
            (found.interval.low - plain.low).abs() < 1e-4 && (found.interval.high - plain.high).abs() < 1e-4
        );
    }

    /// Even if a player always wins or never wins, some uncertainty about the rate remains.
    #[test]
    fn games_that_agree_leave_doubt() {
        for games in 2..40 {
            for won in [0, 25] {
                let found = rate_over_games(&vec![(won, 25); games], 0.95).unwrap();
                let width = found.interval.high - found.interval.low;
                assert!(width > 0.09, "{games} games: {found:?}");
            }
            let none = paired_over_games(&vec![[0.0, 0.0]; games], 0.95).unwrap();
            assert!(none.interval.low < -0.09 && none.interval.high > 0.09 && none.p == 1.0, "{none:?}");
        }
    }

    /// The expected p-value was computed with scipy.stats.ttest_rel.
    #[test]
    fn a_paired_test() {
        let games = [[0.4, 0.2], [0.8, 0.4], [1.0, 0.8], [0.2, 0.0], [0.0, 0.2], [0.6, 0.2]];
        let found = paired_over_games(&games, 0.95).unwrap();
        close(found.rates[0], 0.5);
        close(found.rates[1], 0.3);
        close(found.p, 0.07558681842161248);
        let mirrored = games.map(|[a, b]| [b, a]);
        let back = paired_over_games(&mirrored, 0.95).unwrap();
        close(back.difference, -found.difference);
        close(back.interval.low, -found.interval.high);
        close(back.p, found.p);
    }

    /// If a player wins everything, the p-value is the minimum for the number of games. Five games prove
    /// nothing.
    #[test]
    fn few_games_prove_little() {
        for (games, p) in [(2, 0.5), (5, 0.0625), (6, 0.03125), (12, 0.00048828125)] {
            close(paired_over_games(&vec![[1.0, 0.0]; games], 0.95).unwrap().p, p);
        }
        let found = paired_over_games(&[[1.0, 0.0]; 6], 0.95).unwrap();
        assert!(
            found.interval.low > 0.2 && found.interval.low < 0.3 && found.interval.high == 1.0,
            "{found:?}"
        );
    }

    #[test]
    fn nothing_known() {
        assert_eq!(rate_over_games(&[(1, 2)], 0.95), None);
        assert_eq!(rate_over_games(&[(1, 2), (0, 0)], 0.95), None);
        assert_eq!(rate_over_games(&[(3, 2), (0, 1)], 0.95), None);
        assert_eq!(rate_over_games(&[(1, 2), (1, 2)], 1.0), None);
        assert_eq!(paired_over_games(&[[0.5, 0.5]], 0.95), None);
        assert_eq!(paired_over_games(&[[0.5, f64::NAN], [0.0, 0.0]], 0.95), None);
    }
}
