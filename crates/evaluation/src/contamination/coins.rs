//! The coins of a release, as the tests need them.

use base::Digest;
use engine::Action;

/// The games and witnesses that the coins of a release published and withheld.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Coins {
    /// The games.
    pub games: Vec<GameCoin>,
}

/// A game with its sibling.
#[derive(Clone, Debug, PartialEq)]
pub struct GameCoin {
    /// The name of its folder.
    pub id: String,
    /// The digest of the published game.
    pub published: Digest,
    /// The digest of the withheld sibling, if there is one.
    pub withheld: Option<Digest>,
    /// The levels.
    pub levels: Vec<LevelCoin>,
}

/// A level with its sibling and two wins.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelCoin {
    /// The digest of the level of the published game.
    pub published: Digest,
    /// The digest of the level of the withheld sibling, if there is one.
    pub withheld: Option<Digest>,
    /// The beginnings of the published win and of the withheld one, of equal length and different, if there are two.
    pub beginnings: Option<[Vec<Action>; 2]>,
}

/// The side of a coin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Side {
    /// The one published.
    Published,
    /// The one withheld.
    Withheld,
}

impl Coins {
    /// The number of games with a sibling, and of levels with two wins.
    pub fn counts(&self) -> (usize, usize) {
        let siblings = self.games.iter().filter(|game| game.withheld.is_some()).count();
        let levels = self.games.iter().flat_map(|game| &game.levels);
        (siblings, levels.filter(|level| level.beginnings.is_some()).count())
    }

    /// The place of a level among the games and their levels, by the digests of game and level, and its side.
    pub(super) fn place(&self, game: Digest, level: Digest) -> Option<(usize, usize, Side)> {
        self.games.iter().enumerate().find_map(|(at, of)| {
            let side = match () {
                () if of.published == game => Side::Published,
                () if of.withheld == Some(game) => Side::Withheld,
                () => return None,
            };
            let is_it = |own: &LevelCoin| match side {
                Side::Published => own.published == level,
                Side::Withheld => own.withheld == Some(level),
            };
            Some((at, of.levels.iter().position(is_it)?, side))
        })
    }
}
