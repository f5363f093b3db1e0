//! The choice of levels. The expected error is computed for planned episodes, and the next level is chosen by its
//! information at the current ability.

use super::ability::{ABILITY_SD, PlayedGame, SIDE, STEP, TAIL, kernel, nodes};
use super::logistic::logistic;

/// Returns the expected standard error of an ability after the planned episodes. In `games`, `of` is the planned number
/// of episodes on each level, and `won` is unused. `mismatch` is the standard deviation of the player's match effects,
/// which state how well each game suits the player. `link` is the standard error that the difficulties of all levels
/// share.
///
/// The information from a game's episodes is the sum over the game's levels, reduced because all levels of a game share
/// one match effect. Cost: O(levels).
///
/// ```
/// use infinite_arcade_statistics::scale::{PlayedGame, PlayedLevel, expected_error};
/// let level = PlayedLevel { difficulty: 0.0, own: 0.0, won: 0.0, of: 1.0 };
/// let game = PlayedGame { common: 0.0, levels: vec![level] };
/// // Without match effects, an episode with even odds provides an information of 1/4.
/// let error = expected_error(&vec![game; 100], 0.0, 0.0, 0.0);
/// assert!((error - 0.2).abs() < 0.001);
/// ```
pub fn expected_error(games: &[PlayedGame], ability: f64, mismatch: f64, link: f64) -> f64 {
    let of_game = |game: &PlayedGame| {
        let variance = mismatch * mismatch + game.common * game.common;
        let levels = game.levels.iter().filter(|level| level.of > 0.0);
        let each = levels.map(|level| information(ability - level.difficulty, variance, level.own, level.of));
        shared(each.sum(), variance)
    };
    let information = games.iter().map(of_game).sum::<f64>() + 1.0 / (ABILITY_SD * ABILITY_SD);
    (1.0 / information + link * link).sqrt()
}

/// Returns the information that a level's episodes provide about the player's ability in the game. `variance` is the
/// logit's variance, and `own` is the standard error of the difficulty.
fn information(logit: f64, variance: f64, own: f64, of: f64) -> f64 {
    let sd = (variance + own * own).sqrt();
    let mean: f64 = nodes()
        .map(|(z, weight)| {
            let chance = logistic(logit + sd * z);
            weight * chance * (1.0 - chance)
        })
        .sum();
    1.0 / (1.0 / (of * mean).max(1e-300) + own * own)
}

/// Converts information about the ability in one game to information about the general ability.
fn shared(within: f64, variance: f64) -> f64 {
    within / (1.0 + variance * within)
}

/// An adaptive choice of levels. Each chosen level is the most informative one at the ability estimated from the
/// episodes recorded so far. The choice depends only on those episodes, so it can be reproduced from them.
#[derive(Clone, Debug)]
pub struct Selection {
    /// The levels by game, where `of` is the number of recorded episodes.
    games: Vec<PlayedGame>,
    /// The number of chosen episodes, by game and level.
    chosen: Vec<Vec<f64>>,
    mismatch: f64,
    runs: f64,
    /// The log posterior density at each node of the ability grid.
    logs: Vec<f64>,
    /// Each game's contribution to the log density.
    parts: Vec<Vec<f64>>,
}

/// A chosen level, and the ability estimated before the level is played.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chosen {
    /// The game's index.
    pub game: usize,
    /// The level's index in the game.
    pub level: usize,
    /// The ability estimated from the previous episodes.
    pub ability: f64,
    /// The ability's standard error, excluding the error of the month's position on the scale.
    pub error: f64,
}

impl Selection {
    /// Creates a selection without any episodes. `games` contains the difficulties of the levels. Each level can be
    /// chosen `runs` times.
    pub fn new(games: &[PlayedGame], mismatch: f64, runs: u64) -> Selection {
        let mut games = games.to_vec();
        for level in games.iter_mut().flat_map(|game| &mut game.levels) {
            (level.won, level.of) = (0.0, 0.0);
        }
        let log = |node: i32| {
            let at = f64::from(node) * STEP / ABILITY_SD;
            -0.5 * at * at
        };
        let logs: Vec<f64> = (-SIDE..=SIDE).map(log).collect();
        let parts = games.iter().map(|_| vec![0.0; logs.len()]).collect();
        let chosen = games.iter().map(|game| vec![0.0; game.levels.len()]).collect();
        Selection { games, chosen, mismatch, runs: runs as f64, logs, parts }
    }

    /// Returns the ability estimated from the recorded episodes. The second value is the standard error, excluding the
    /// error of the month's position on the scale.
    pub fn ability(&self) -> (f64, f64) {
        let most = self.logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let weights: Vec<f64> = self.logs.iter().map(|log| libm::exp(log - most)).collect();
        let total: f64 = weights.iter().sum();
        let at = |place: usize| (place as f64 - f64::from(SIDE)) * STEP;
        let mean = weights.iter().enumerate().map(|(place, weight)| at(place) * weight).sum::<f64>() / total;
        let square = |place: usize| (at(place) - mean) * (at(place) - mean);
        let variance =
            weights.iter().enumerate().map(|(place, weight)| square(place) * weight).sum::<f64>() / total;
        (mean, variance.sqrt())
    }

    /// Chooses the level whose next episode adds the most information about the ability, given the episodes chosen so
    /// far. Ties are broken by the order of games and levels. Returns `None` once all levels are exhausted. Cost:
    /// O(levels).
    pub fn choose(&mut self) -> Option<Chosen> {
        let (ability, error) = self.ability();
        let mut best: Option<(f64, usize, usize)> = None;
        for (at, game) in self.games.iter().enumerate() {
            let variance = self.mismatch * self.mismatch + game.common * game.common;
            // The variance includes the uncertainty about the ability itself.
            let wide = variance + error * error;
            let of = |level: usize, plays: f64| {
                let one = &game.levels[level];
                if plays > 0.0 { information(ability - one.difficulty, wide, one.own, plays) } else { 0.0 }
            };
            let within: f64 = (0..game.levels.len()).map(|level| of(level, self.chosen[at][level])).sum();
            let before = shared(within, variance);
            for level in (0..game.levels.len()).filter(|&level| self.chosen[at][level] < self.runs) {
                let plays = self.chosen[at][level];
                let gain = shared(within - of(level, plays) + of(level, plays + 1.0), variance) - before;
                if best.is_none_or(|(most, ..)| gain > most) {
                    best = Some((gain, at, level));
                }
            }
        }
        let (_, game, level) = best?;
        self.chosen[game][level] += 1.0;
        Some(Chosen { game, level, ability, error })
    }

    /// Records the result of an episode on a level.
    pub fn record(&mut self, game: usize, level: usize, won: bool) {
        let played = &mut self.games[game].levels[level];
        played.of += 1.0;
        played.won += f64::from(u8::from(won));
        let game_played = &self.games[game];
        let sd =
            (self.mismatch * self.mismatch + game_played.common * game_played.common).sqrt().max(STEP / TAIL);
        let reach = SIDE + (TAIL * sd / STEP) as i32 + 1;
        let (likelihoods, kernel) = (game_played.likelihoods(reach), kernel(sd));
        let half = kernel.len() / 2;
        for (at, part) in self.parts[game].iter_mut().enumerate() {
            let first = at + (reach - SIDE) as usize - half;
            let window = &likelihoods[first..first + kernel.len()];
            let mean: f64 = window.iter().zip(&kernel).map(|(value, weight)| value * weight).sum();
            let log = libm::log(mean);
            self.logs[at] += log - *part;
            *part = log;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scale::{MismatchPrior, PlayedLevel, ability};

    /// Returns games that each have an easy, a medium and a hard level.
    fn games(count: usize) -> Vec<PlayedGame> {
        let level = |difficulty: f64| PlayedLevel { difficulty, own: 0.3, won: 0.0, of: 0.0 };
        vec![PlayedGame { common: 0.2, levels: [-3.0, 0.0, 3.0].map(level).to_vec() }; count]
    }

    /// A player with a very low ability gets easy levels. The first choices include one level from each game.
    #[test]
    fn choices_go_where_the_player_is() {
        let mut selection = Selection::new(&games(20), 1.0, 1);
        let mut chosen = Vec::new();
        for _ in 0..20 {
            let one = selection.choose().unwrap();
            selection.record(one.game, one.level, one.level == 0 && one.game.is_multiple_of(2));
            chosen.push(one);
        }
        let mut played: Vec<usize> = chosen.iter().map(|one| one.game).collect();
        assert!(chosen[10..].iter().all(|one| one.level == 0), "{chosen:?}");
        played.sort_unstable();
        played.dedup();
        assert_eq!(played.len(), 20, "{chosen:?}");
        assert!(chosen[19].error < 0.5 * chosen[0].error && chosen[19].ability < -2.0);
        // The remaining choices are exactly the remaining levels.
        assert_eq!(std::iter::from_fn(|| selection.choose()).count(), 40);
    }

    /// The ability estimated by a selection agrees with the ability estimated on the scale. The selection is given the
    /// mismatch (the standard deviation of the match effects), and the scale estimates it. The expected errors agree as
    /// well.
    #[test]
    fn errors_are_those_of_the_scale() {
        let mut played = games(60);
        let mut selection = Selection::new(&played, 1.0, 1);
        for (at, game) in played.iter_mut().enumerate() {
            for (place, level) in game.levels.iter_mut().enumerate() {
                // The player is one logit above the mean. Some games suit the player, and others do not.
                let won = [at % 10 != 0, at % 3 != 0, at % 9 == 0][place];
                (level.won, level.of) = (f64::from(u8::from(won)), 1.0);
                selection.record(at, place, won);
            }
        }
        let found = ability(&played, MismatchPrior { median: 1.0, log_sd: 0.05 }, 0.0).unwrap();
        let (value, error) = selection.ability();
        assert!(
            (value - found.value).abs() < 0.02 && (error / found.error - 1.0).abs() < 0.03,
            "{value} {error} {found:?}"
        );
        let expected = expected_error(&played, found.value, 1.0, 0.0);
        assert!((expected / found.error - 1.0).abs() < 0.15, "{expected}, {found:?}");
    }
}
