//! The power of the memory tests. It depends only on which levels are played, so it can be computed before
//! any result is known.

use super::coins::Coins;
use serde::Serialize;
use statistics::memory_simulation::MemoryTrial;
use statistics::{Memoriser, Spread, coin_power};

/// The combined significance level of all memory tests.
pub const ALPHA: f64 = 0.01;
/// The assumed fractions of levels known to the player.
pub const SHARES: [f64; 5] = [0.1, 0.2, 0.3, 0.5, 1.0];
/// The assumed win rate of a player on levels that it knows.
const KNOWN: f64 = 0.9;
/// The assumed win rate of a player on levels that it does not know.
const CLEAN: f64 = 0.27;
/// The fraction of episodes that happen to begin like a win. The value was measured for `reflex`, and is the
/// highest among all measured players.
const BY_CHANCE: f64 = 0.07;
/// The standard deviation, in logits, of the difference between the effects of two sets of names on a
/// player's results.
const NAMES: f64 = 0.5;
/// The number of simulated players for each power value of the game test.
const TRIALS: u64 = 1000;
/// The seed of the power simulation.
const SEED: u64 = 32;

/// The power of both tests against a player that knows a given fraction of the levels.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Power {
    /// The fraction of levels known to the player.
    pub share: f64,
    /// The solution test's power, or `None` if no level with two wins is played.
    pub solutions: Option<f64>,
    /// The game test's power, or `None` if no game with a sibling (withheld renamed copy) is played.
    pub games: Option<f64>,
}

impl Power {
    /// Returns the power of a design in which each test has significance level `alpha`. Each of `levels` levels with
    /// two wins is played once. `pairs` contains the number of episode pairs for each game with a sibling (withheld
    /// renamed copy).
    pub fn of(levels: u64, pairs: &[u64], alpha: f64) -> Vec<Power> {
        let of = |share: f64| {
            let player = Memoriser { share, known: KNOWN, clean: CLEAN };
            let (more, less) = player.prefix_chances(BY_CHANCE);
            let trial = MemoryTrial { player, hurt: 0.0, names: NAMES, spread: Spread::default() };
            Power {
                share,
                solutions: (levels > 0).then(|| coin_power(levels, more, less, alpha)),
                games: (!pairs.is_empty()).then(|| trial.sibling_games(pairs, alpha, TRIALS, SEED)),
            }
        };
        SHARES.into_iter().map(of).collect()
    }
}

/// Returns the design in which every level is played once in the published game and once in its sibling (the withheld
/// renamed copy). The result is the number of levels with two wins, and the number of episode pairs for each game with
/// a sibling.
pub fn design(coins: &Coins) -> (u64, Vec<u64>) {
    let (_, levels) = coins.counts();
    let paired = coins.games.iter().filter(|game| game.withheld.is_some());
    (levels as u64, paired.map(|game| game.levels.len() as u64).filter(|pairs| *pairs > 0).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The designs come from the review of scores: 200 levels, and 100 games.
    #[test]
    fn power_is_that_of_the_page() {
        let found = Power::of(200, &[1; 100], ALPHA);
        assert!(found[1].solutions.is_some_and(|power| power > 0.99), "{found:?}");
        assert!(found[3].games.is_some_and(|power| power > 0.95), "{found:?}");
        assert!(found[0].games.is_some_and(|power| power < 0.2), "{found:?}");
        let none = Power::of(0, &[], ALPHA);
        assert!(none.iter().all(|power| power.solutions.is_none() && power.games.is_none()));
    }
}
