//! The memory tests, and their findings on each player.

use super::coins::{Coins, Side};
use super::power::{ALPHA, Power};
use super::read::{PlayedEpisode, PlayerEpisodes};
use serde::Serialize;
use statistics::coin_test;
use std::collections::BTreeMap;

/// The findings on the players of a release.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Contamination {
    /// The combined significance level of all tests.
    pub alpha: f64,
    /// The number of tests. Each test's significance level is the combined level divided by this number.
    pub tests: u64,
    /// The minimum number of random choices between two items with which a test can be significant at its level.
    pub needed: u64,
    /// The findings on each player.
    pub players: Vec<PlayerMemory>,
}

/// The findings on one player.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlayerMemory {
    /// The player's name.
    pub player: String,
    /// The power of the tests, for several assumed fractions of levels known to the player.
    pub power: Vec<Power>,
    /// The test of whether the player's episodes begin like published wins rather than withheld wins.
    pub solutions: Option<SideTest>,
    /// The test of whether the player wins published games more often than their withheld siblings (renamed copies).
    pub games: Option<SideTest>,
    /// The conclusion from both tests.
    pub evidence: Evidence,
    /// The number of episodes on levels outside the release.
    pub unknown: u64,
}

/// The result of a test over the random choices that decided which of two items was published.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SideTest {
    /// The number of random choices for which the player has results.
    pub coins: u64,
    /// The number of random choices whose two items have different results. Equal results are not evidence.
    pub informative: u64,
    /// The number of episodes, or, in the game test, the number of episode pairs.
    pub episodes: u64,
    /// The total for the published items: the number of wins, or the number of episodes that begin like the published
    /// win.
    pub published: u64,
    /// The total for the withheld items.
    pub withheld: u64,
    /// The test's exact p-value.
    pub p: f64,
    /// The p-value multiplied by the number of tests (Bonferroni correction).
    pub corrected: f64,
}

impl SideTest {
    fn is_found(&self) -> bool {
        self.corrected <= ALPHA
    }
}

/// The conclusion from a player's tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Evidence {
    /// No test was possible. The player has played no level with two wins, and no game together with its sibling (the
    /// withheld renamed copy).
    Untested,
    /// No test has enough random choices between two items to be significant, whatever the player knows.
    CannotTell,
    /// No test was significant.
    ConsistentWithNotHavingSeen,
    /// The player's episodes begin like published wins rather than withheld wins.
    HasSeenTheSolutions,
    /// The player wins published games more often than their withheld siblings (renamed copies).
    HasSeenTheGames,
    /// Both tests were significant.
    HasSeenTheSolutionsAndTheGames,
}

impl Evidence {
    /// Returns the conclusion as a phrase.
    pub fn words(self) -> &'static str {
        match self {
            Evidence::Untested => "not tested",
            Evidence::CannotTell => "cannot tell",
            Evidence::ConsistentWithNotHavingSeen => "consistent with not having seen",
            Evidence::HasSeenTheSolutions => "has seen the solutions",
            Evidence::HasSeenTheGames => "has seen the games",
            Evidence::HasSeenTheSolutionsAndTheGames => "has seen the solutions and the games",
        }
    }

    /// Returns `true` if a test shows that the player has seen games or solutions.
    pub fn is_seen(self) -> bool {
        !matches!(self, Evidence::Untested | Evidence::CannotTell | Evidence::ConsistentWithNotHavingSeen)
    }

    fn of(solutions: Option<&SideTest>, games: Option<&SideTest>, needed: u64) -> Evidence {
        let Some(coins) = solutions.into_iter().chain(games).map(|test| test.coins).max() else {
            return Evidence::Untested;
        };
        if coins < needed {
            return Evidence::CannotTell;
        }
        let is_found = |test: Option<&SideTest>| test.is_some_and(SideTest::is_found);
        match (is_found(solutions), is_found(games)) {
            (false, false) => Evidence::ConsistentWithNotHavingSeen,
            (true, false) => Evidence::HasSeenTheSolutions,
            (false, true) => Evidence::HasSeenTheGames,
            (true, true) => Evidence::HasSeenTheSolutionsAndTheGames,
        }
    }
}

/// A player's results on the two items of one random choice (published and withheld).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct CoinResults {
    episodes: u64,
    published: u64,
    withheld: u64,
}

/// Tests each player. The combined level of all tests is [`ALPHA`].
pub fn contamination(coins: &Coins, players: &[PlayerEpisodes]) -> Contamination {
    let results: Vec<_> = players.iter().map(|player| Results::of(coins, player)).collect();
    let made = |part: &[CoinResults]| u64::from(!part.is_empty());
    let tests: u64 = results.iter().map(|results| made(&results.solutions) + made(&results.games)).sum();
    let alpha = ALPHA / tests.max(1) as f64;
    let needed = needed(alpha);
    let of = |(player, results): (&PlayerEpisodes, Results)| {
        let [solutions, games] = [&results.solutions, &results.games].map(|part| tested(part, tests));
        let pairs: Vec<u64> = results.games.iter().map(|game| game.episodes).collect();
        PlayerMemory {
            player: player.player.label(),
            power: Power::of(results.solutions.len() as u64, &pairs, alpha),
            evidence: Evidence::of(solutions.as_ref(), games.as_ref(), needed),
            solutions,
            games,
            unknown: results.unknown,
        }
    };
    Contamination { alpha: ALPHA, tests, needed, players: players.iter().zip(results).map(of).collect() }
}

/// Returns the minimum number of random choices for which the p-value can reach `alpha`. The test is one-sided, so the
/// p-value is lowest if the player does better on the published item for all choices.
fn needed(alpha: f64) -> u64 {
    let (mut coins, mut p) = (0, 1.0);
    while p > alpha {
        (coins, p) = (coins + 1, p / 2.0);
    }
    coins
}

fn tested(results: &[CoinResults], tests: u64) -> Option<SideTest> {
    if results.is_empty() {
        return None;
    }
    let differences: Vec<i64> =
        results.iter().map(|coin| coin.published as i64 - coin.withheld as i64).collect();
    let found = coin_test(&differences);
    let sum = |of: fn(&CoinResults) -> u64| results.iter().map(of).sum();
    Some(SideTest {
        coins: results.len() as u64,
        informative: found.informative as u64,
        episodes: sum(|coin| coin.episodes),
        published: sum(|coin| coin.published),
        withheld: sum(|coin| coin.withheld),
        p: found.p,
        corrected: (found.p * tests as f64).min(1.0),
    })
}

/// One player's results, by random choice.
struct Results {
    solutions: Vec<CoinResults>,
    games: Vec<CoinResults>,
    unknown: u64,
}

impl Results {
    fn of(coins: &Coins, player: &PlayerEpisodes) -> Results {
        let mut unknown = 0;
        let mut sides: BTreeMap<(usize, usize, u64), BTreeMap<Side, &PlayedEpisode>> = BTreeMap::new();
        for ((game, level, run), episode) in &player.episodes {
            match coins.place(*game, *level) {
                Some((game, level, side)) => {
                    sides.entry((game, level, *run)).or_default().insert(side, episode);
                }
                None => unknown += 1,
            }
        }
        let (mut solutions, mut games) = (BTreeMap::new(), BTreeMap::new());
        for ((game, level, _), sides) in &sides {
            let (published, withheld) = (sides.get(&Side::Published), sides.get(&Side::Withheld));
            if let (Some(published), Some(withheld)) = (published, withheld) {
                let coin: &mut CoinResults = games.entry(*game).or_default();
                coin.episodes += 1;
                coin.published += u64::from(published.won);
                coin.withheld += u64::from(withheld.won);
            }
            let beginnings = &coins.games[*game].levels[*level].beginnings;
            if let (Some(episode), Some([published, withheld])) = (published, beginnings) {
                let coin: &mut CoinResults = solutions.entry((*game, *level)).or_default();
                coin.episodes += 1;
                coin.published += u64::from(episode.beginning.starts_with(published));
                coin.withheld += u64::from(episode.beginning.starts_with(withheld));
            }
        }
        Results {
            solutions: solutions.into_values().collect(),
            games: games.into_values().collect(),
            unknown,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::coins::{GameCoin, LevelCoin};
    use super::*;
    use crate::study::Player;
    use base::Digest;
    use engine::Action;
    use engine::Action::{Down, Left, Right, Up};

    const GAMES: usize = 10;
    const BEGINNINGS: [&[Action]; 2] = [&[Up, Left], &[Down, Right]];

    fn digest(what: &str, game: usize, side: usize) -> Digest {
        Digest::of(format!("{what} {game} {side}").as_bytes())
    }

    /// Returns the random choices for games with one level each. Bit `game` of `fall` decides which of that game's two
    /// copies is published.
    fn coins(fall: usize) -> Coins {
        let game = |game: usize| {
            let side = fall >> game & 1;
            let of = |what, side| digest(what, game, side);
            let level = LevelCoin {
                published: of("level", side),
                withheld: Some(of("level", 1 - side)),
                beginnings: Some([side, 1 - side].map(|side| BEGINNINGS[side].to_vec())),
            };
            let (published, withheld) = (of("game", side), Some(of("game", 1 - side)));
            GameCoin { id: format!("game-{game}"), published, withheld, levels: vec![level] }
        };
        Coins { games: (0..GAMES).map(game).collect() }
    }

    /// Returns a player with one episode on each of a game's two copies. `of` determines whether the player wins an
    /// episode, and how the episode begins.
    fn player(of: impl Fn(usize, usize) -> (bool, &'static [Action])) -> PlayerEpisodes {
        let sides = (0..GAMES).flat_map(|game| [(game, 0), (game, 1)]);
        let episode = |(game, side)| {
            let (won, beginning) = of(game, side);
            let episode = PlayedEpisode { won, beginning: beginning.to_vec() };
            ((digest("game", game, side), digest("level", game, side), 0), episode)
        };
        PlayerEpisodes { player: Player::reference("x"), episodes: sides.map(episode).collect() }
    }

    fn evidence(fall: usize, player: PlayerEpisodes) -> Evidence {
        contamination(&coins(fall), &[player]).players[0].evidence
    }

    /// For a player that does not know the random choices, p ≤ x holds in at most a fraction x of all outcomes of these
    /// choices. The bound holds even if the player is better at some games, or prefers some first actions to others.
    #[test]
    fn the_level_is_exact() {
        let clean = player(|game, side| (side == 0 || game % 3 == 0, BEGINNINGS[usize::from(game < 7)]));
        let mut found: [Vec<f64>; 2] = Default::default();
        for fall in 0..1 << GAMES {
            let results = Results::of(&coins(fall), &clean);
            for (p, part) in found.iter_mut().zip([&results.solutions, &results.games]) {
                p.push(tested(part, 1).unwrap().p);
            }
        }
        for p in found {
            let most = |x: f64| p.iter().filter(|p| **p <= x).count() as f64 / p.len() as f64;
            assert!(p.iter().all(|x| most(*x) <= x + 1e-12));
            assert!(p.iter().any(|x| *x < 0.05), "the test can find something");
        }
    }

    #[test]
    fn evidence_tells_what_was_seen() {
        let fall = 0b0110100101;
        let side = |game: usize| fall >> game & 1;
        let solutions = player(|game, _| (true, BEGINNINGS[side(game)]));
        assert_eq!(evidence(fall, solutions), Evidence::HasSeenTheSolutions);
        let games = player(|game, own| (own == side(game), &[Left, Left]));
        assert_eq!(evidence(fall, games.clone()), Evidence::HasSeenTheGames);
        let both = player(|game, own| (own == side(game), BEGINNINGS[side(game)]));
        assert_eq!(evidence(fall, both), Evidence::HasSeenTheSolutionsAndTheGames);
        let neither = player(|_, own| (own == 0, BEGINNINGS[0]));
        assert_eq!(evidence(fall, neither), Evidence::ConsistentWithNotHavingSeen);
        // Results on a different release, and results on withheld copies alone, are not evidence.
        let mut foreign = games.clone();
        foreign
            .episodes
            .retain(|(game, ..), _| (0..GAMES).any(|at| digest("game", at, 1 - side(at)) == *game));
        assert_eq!(evidence(fall, foreign), Evidence::Untested);
        let found = contamination(&Coins::default(), &[games]);
        assert_eq!((found.tests, found.players[0].unknown), (0, 2 * GAMES as u64));
        assert_eq!(found.players[0].evidence, Evidence::Untested);
    }

    /// With too few random choices, the conclusion is [`Evidence::CannotTell`].
    #[test]
    fn too_few_coins_cannot_tell() {
        assert_eq!([1, 2, 4].map(|tests| needed(ALPHA / f64::from(tests))), [7, 8, 9]);
        let few = |count: usize| {
            let mut seen = player(|_, own| (own == 0, BEGINNINGS[0]));
            seen.episodes.retain(|(game, ..), _| {
                (0..count).any(|at| [0, 1].iter().any(|&side| digest("game", at, side) == *game))
            });
            contamination(&coins(0), &[seen])
        };
        assert_eq!((few(7).needed, few(7).players[0].evidence), (8, Evidence::CannotTell));
        assert!(few(8).players[0].evidence.is_seen());
    }

    /// Ten random choices are weak evidence if the significance level is shared among many tests.
    #[test]
    fn tests_are_corrected() {
        let fall = 0;
        let seen = player(|game, own| (own == 0, BEGINNINGS[fall >> game & 1]));
        let found = contamination(&coins(fall), &vec![seen; 6]);
        assert_eq!(found.tests, 12);
        let games = found.players[0].games.as_ref().unwrap();
        assert_eq!((games.p, games.corrected), (1.0 / 1024.0, 12.0 / 1024.0));
        assert!(found.players.iter().all(|player| !player.evidence.is_seen()), "{found:?}");
    }
}
