//! The secret random choices ("coins") of a release, in the form that the memory tests require. Each decided which of
//! two equivalent items is published.

use base::Digest;
use engine::Action;

/// The random choices ("coins") for a release's games and levels. Each decided which of two equivalent games or winning
/// episodes was published, and which was withheld.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Coins {
    /// The release's games.
    pub games: Vec<GameCoin>,
}

/// A published game, with its sibling (the withheld renamed copy).
#[derive(Clone, Debug, PartialEq)]
pub struct GameCoin {
    /// The game's folder name.
    pub id: String,
    /// The digest of the published game.
    pub published: Digest,
    /// The digest of the withheld sibling (renamed copy), if any.
    pub withheld: Option<Digest>,
    /// The game's levels.
    pub levels: Vec<LevelCoin>,
}

/// A level, with the same level in the game's sibling (the withheld renamed copy), and with the level's two winning
/// episodes.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelCoin {
    /// The level's digest in the published game.
    pub published: Digest,
    /// The level's digest in the game's withheld sibling (renamed copy), if any.
    pub withheld: Option<Digest>,
    /// The first actions of the published win and of the withheld win. The two sequences differ but have the
    /// same length. `None` unless both wins exist.
    pub beginnings: Option<[Vec<Action>; 2]>,
}

/// The two items of a random choice: the published item and the withheld item.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Side {
    /// The item that was published.
    Published,
    /// The item that was withheld.
    Withheld,
}

impl Coins {
    /// Returns the number of games with a withheld sibling (renamed copy), and the number of levels with two wins.
    pub fn counts(&self) -> (usize, usize) {
        let siblings = self.games.iter().filter(|game| game.withheld.is_some()).count();
        let levels = self.games.iter().flat_map(|game| &game.levels);
        (siblings, levels.filter(|level| level.beginnings.is_some()).count())
    }

    /// Finds the game and the level with the given digests. Returns their indices, and states whether the game is
    /// published or withheld.
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
