//! The decreases in the reference players' win rates from one tier (difficulty class) to the next, and from one
//! commitment (number of actions per decision) to the next.

use super::{GameMarks, LevelMarks, MarksPart};
use serde::{Deserialize, Serialize};
use statistics::paired_over_games;
use validators::{Commitment, Tier};

/// The decreases in win rates, first for all players together and then for each player.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Falls {
    /// The decreases from each tier (difficulty class) to the next higher tier that exists, over all commitments.
    pub tiers: Vec<Fall<Tier>>,
    /// The decreases from each commitment (number of actions per decision) to the next longer one, over all levels.
    pub commits: Vec<Fall<Commitment>>,
}

/// The difference between two win rates, paired by game. Each game counts once, and its difficulty cancels out in the
/// difference.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fall<T> {
    /// The player; `None` for the mean of all players.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub player: Option<String>,
    /// The lower tier (difficulty class), or the smaller number of actions per decision.
    pub from: T,
    /// The higher tier (difficulty class), or the greater number of actions per decision.
    pub to: T,
    /// The number of games with levels of both kinds.
    pub games: u64,
    /// The mean win rates in these games, on the levels of each of the two kinds.
    pub rates: [f64; 2],
    /// The first rate minus the second rate.
    pub fall: f64,
    /// The 95% interval of the decrease, with games as the sampling unit.
    pub interval: [f64; 2],
}

impl Falls {
    /// Computes the decreases in win rates from the games' reference results.
    pub(super) fn of(asked: &MarksPart, games: &[GameMarks]) -> Falls {
        let has = |tier: &Tier| games.iter().flat_map(|game| &game.levels).any(|level| level.tier == *tier);
        let tiers: Vec<Tier> = Tier::ALL.into_iter().filter(has).collect();
        let mut commits: Vec<(usize, Commitment)> = asked.commits.iter().copied().enumerate().collect();
        commits.sort_by_key(|&(_, commit)| commit);
        let players = || std::iter::once(None).chain((0..asked.players.len()).map(Some));
        let mut falls = Falls::default();
        for player in players() {
            let name = player.map(|at| asked.players[at].clone());
            for pair in tiers.windows(2) {
                let of = |tier| move |level: &LevelMarks, _: usize| level.tier == tier;
                let rates = |game| {
                    Some([rate(asked, game, player, of(pair[0]))?, rate(asked, game, player, of(pair[1]))?])
                };
                falls.tiers.extend(fall(name.clone(), (pair[0], pair[1]), games.iter().filter_map(rates)));
            }
            for pair in commits.windows(2) {
                let of = |commit| move |_: &LevelMarks, at: usize| at == commit;
                let rates = |game| {
                    Some([
                        rate(asked, game, player, of(pair[0].0))?,
                        rate(asked, game, player, of(pair[1].0))?,
                    ])
                };
                falls.commits.extend(fall(
                    name.clone(),
                    (pair[0].1, pair[1].1),
                    games.iter().filter_map(rates),
                ));
            }
        }
        falls
    }
}

/// Returns the mean fraction of episodes won over the selected levels and commitments (numbers of actions per decision)
/// in a game; `None` if the selection is empty.
fn rate(
    asked: &MarksPart,
    game: &GameMarks,
    player: Option<usize>,
    is_meant: impl Fn(&LevelMarks, usize) -> bool,
) -> Option<f64> {
    let (mut won, mut of) = (0, 0);
    for level in &game.levels {
        let players =
            level.wins.iter().enumerate().filter(|(at, _)| player.is_none_or(|player| player == *at));
        for (_, wins) in players {
            for (_, wins) in wins.iter().enumerate().filter(|(at, _)| is_meant(level, *at)) {
                (won, of) = (won + wins, of + asked.plays);
            }
        }
    }
    (of > 0).then(|| won as f64 / of as f64)
}

/// Computes a decrease in win rates; `None` for fewer than two games, because a single game does not show the variance
/// between games.
fn fall<T>(
    player: Option<String>,
    (from, to): (T, T),
    rates: impl Iterator<Item = [f64; 2]>,
) -> Option<Fall<T>> {
    let rates: Vec<[f64; 2]> = rates.collect();
    let found = paired_over_games(&rates, 0.95)?;
    Some(Fall {
        player,
        from,
        to,
        games: rates.len() as u64,
        rates: found.rates,
        fall: found.difference,
        interval: [found.interval.low, found.interval.high],
    })
}

#[cfg(test)]
mod tests {
    use super::super::tests::marks;
    use super::*;

    #[test]
    fn falls_are_paired_over_games() {
        let ids = ["a", "b", "c", "d", "e", "f"];
        // On tier 1, both players win all episodes. On tier 4, the second player wins half of its episodes, except in
        // every other game, where it wins none with `all`.
        let marks = marks(&ids, |game, tier| match tier {
            Tier::One => vec![vec![2, 2], vec![2, 2]],
            _ => vec![vec![0, 0], vec![1, (game % 2) as u64]],
        });
        let Falls { tiers, commits } = &marks.falls;
        assert_eq!((tiers.len(), commits.len()), (3, 3));
        let all = &tiers[0];
        assert_eq!((&all.player, all.from, all.to, all.games), (&None, Tier::One, Tier::Four, 6));
        assert_eq!(all.rates, [1.0, 0.1875]);
        assert!(all.interval[0] > 0.7 && all.interval[1] < 0.9, "{all:?}");
        let random = &commits[1];
        assert_eq!(
            (random.player.as_deref(), random.from, random.to),
            (Some("random"), Commitment::One, Commitment::All)
        );
        assert_eq!((random.fall, commits[2].fall), (0.0, 0.125));
    }

    #[test]
    fn one_game_shows_no_fall() {
        assert!(marks(&["a"], |_, _| vec![vec![1, 0], vec![2, 2]]).falls.tiers.is_empty());
    }
}
