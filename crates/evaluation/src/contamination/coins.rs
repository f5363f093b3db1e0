//! A release's coins, in the form that the memory tests require. A coin is a random decision about which of
//! two equivalent items is published.

use base::Digest;
use engine::Action;

/// The coins of a release's games and levels. Each coin decided which of two equivalent games or winning
/// episodes was published, and which was withheld.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Coins {
    /// The release's games.
    pub games: Vec<GameCoin>,
}

/// A published game, with its withheld sibling.
#[derive(Clone, Debug, PartialEq)]
pub struct GameCoin {
    /// The game's folder name.
    pub id: String,
    /// The digest of the published game.
    pub published: Digest,
    /// The withheld sibling's digest, if any.
    pub withheld: Option<Digest>,
    /// The game's levels.
    pub levels: Vec<LevelCoin>,
}

/// A level, with its sibling and its two winning episodes.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelCoin {
    /// The level's digest in the published game.
    pub published: Digest,
    /// The level's digest in the withheld sibling, if any.
    pub withheld: Option<Digest>,
    /// The first actions of the published win and of the withheld win. The two sequences differ but have the
    /// same length. `None` unless both wins exist.
    pub beginnings: Option<[Vec<Action>; 2]>,
}

/// The two sides of a coin: the published item and the withheld item.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Side {
    /// The published side of a coin.
    Published,
    /// The withheld side of a coin.
    Withheld,
}

impl Coins {
    /// Returns the number of games with a sibling, and the number of levels with two wins.
    pub fn counts(&self) -> (usize, usize) {
        let siblings = self.games.iter().filter(|game| game.withheld.is_some()).count();
        let levels = self.games.iter().flat_map(|game| &game.levels);
        (siblings, levels.filter(|level| level.beginnings.is_some()).count())
    }

    /// Finds the game and the level with the given digests. Returns their indices, and the side of the coin
    /// on which they lie.
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
