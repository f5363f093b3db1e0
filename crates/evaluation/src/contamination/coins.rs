//! The coins of a release, in the form that the tests need.

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
    /// The name of the game's folder.
    pub id: String,
    /// The digest of the published game.
    pub published: Digest,
    /// The digest of the withheld sibling, if there is one.
    pub withheld: Option<Digest>,
    /// The levels.
    pub levels: Vec<LevelCoin>,
}

/// A level with its sibling and its two wins.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelCoin {
    /// The digest of the published game's level.
    pub published: Digest,
    /// The digest of the withheld sibling's level, if there is one.
    pub withheld: Option<Digest>,
    /// The beginnings of the published and the withheld win, which differ and have the same length; `None` unless
    /// both wins exist.
    pub beginnings: Option<[Vec<Action>; 2]>,
}

/// The side of a coin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Side {
    /// The published side.
    Published,
    /// The withheld side.
    Withheld,
}

impl Coins {
    /// Returns the number of games with a sibling, and the number of levels with two wins.
    pub fn counts(&self) -> (usize, usize) {
        let siblings = self.games.iter().filter(|game| game.withheld.is_some()).count();
        let levels = self.games.iter().flat_map(|game| &game.levels);
        (siblings, levels.filter(|level| level.beginnings.is_some()).count())
    }

    /// Returns the indices of a game and its level with these digests, and their side.
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
