//! Endless, reproducible sequences of verified levels, for training.
//!
//! An item depends only on the stream's seed and parameters and on the item's index. Items can therefore be made in any
//! order and by any number of processes.

mod item;
mod source;

pub use item::StreamItem;
pub use source::StreamGame;

use crate::progress::Progress;
use crate::tally::Tally;
use base::{Digest, Seed, SeedPath};
use engine::{Analysis, Game, Level};
use generators::GenerateError;
use generators::levels::LevelSimilarity;
use source::Source;
use std::collections::BTreeSet;
use validators::{Criteria, CriteriaError, Criterion, CriterionSet, Effort, LadderConfig, Panel};

/// The purpose of the first step from a stream's seed. No release derives a seed from a step with this purpose, so no
/// release shares a random decision with a stream.
pub const NAMESPACE: &str = "train";

/// The reference players that rank the levels of a game by difficulty, and their number of episodes per level.
const PLAYERS: ([&str; 2], u64) = (["mcts:30", "olets:50"], 2);

base::with_defaults! {
    /// The parameters of a stream.
    #[derive(Clone, Debug, PartialEq)]
    pub struct StreamConfig {
        /// The difficulty of each item, from 0.0 (easiest) to 1.0 (hardest); by default, items have any difficulty.
        pub difficulty: Option<f64> = None,
        /// The number of columns and the number of rows of each level; by default, the sizes of the game's own levels.
        pub size: Option<(usize, usize)> = None,
        /// The number of verified levels from which an item is chosen if a difficulty is requested.
        pub choices: usize = 3,
        /// The maximum number of levels to draw for an item from one game.
        pub attempts: u64 = 6,
        /// The criteria that each item meets.
        pub criteria: Criteria = criteria(),
        /// The number of forward-model calls to divide among the criteria, for each drawn level.
        pub calls: u64 = 200_000,
    }
}

/// Returns a release's criteria for levels, except `readable`, which depends only on the rules.
fn criteria() -> Criteria {
    let default = Criteria::default();
    Criteria { ask: default.ask.without(CriterionSet::of(&[Criterion::Readable])), ..default }
}

/// The errors of streams.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StreamError {
    /// The stream has no game.
    #[error("a stream needs at least one game")]
    NoGame,
    /// Two games have the same rules.
    #[error("`{one}` and `{other}` have the same rules: omit one of them")]
    SameGame {
        /// The name of the first game.
        one: String,
        /// The name of the second game.
        other: String,
    },
    /// The level generator does not support a game, or the size or the difficulty is invalid.
    #[error("{game}: {why}")]
    Generate {
        /// The name of the game.
        game: String,
        /// The reason why no level can be generated.
        why: GenerateError,
    },
    /// The criteria are invalid.
    #[error("the criteria: {0}")]
    Criteria(#[from] CriteriaError),
    /// No game of the stream gave a verified level for an item.
    #[error(
        "item {index} has no level, because none of {drawn} drawn levels was accepted ({why}); skip it, or add games"
    )]
    NoneAccepted {
        /// The index of the item.
        index: u64,
        /// The number of levels drawn.
        drawn: u64,
        /// The reasons why the levels were rejected.
        why: String,
    },
}

/// An endless sequence of verified levels.
pub struct Stream {
    root: SeedPath,
    sources: Vec<Source>,
    config: StreamConfig,
    panel: Panel,
    /// The players that rank levels by difficulty.
    players: LadderConfig,
    /// The form digests of the levels that no item may equal.
    avoided: BTreeSet<Digest>,
}

impl Stream {
    /// Creates the stream of some games for a seed. The order of the games and their names do not matter. No item equals
    /// one of the games' own levels. Cost: an analysis of each game and its levels.
    ///
    /// # Errors
    /// Returns an error if there is no game, if two games have the same rules, if the generator does not support a game,
    /// or if a parameter is invalid.
    pub fn new(mut games: Vec<StreamGame>, config: StreamConfig, seed: Seed) -> Result<Stream, StreamError> {
        games.sort_by_key(|game| game.game.digest());
        if let Some(same) = games.windows(2).find(|pair| pair[0].game.digest() == pair[1].game.digest()) {
            let [one, other] = [&same[0], &same[1]].map(|game| game.name.clone());
            return Err(StreamError::SameGame { one, other });
        }
        let (ladder, ladder_plays) = (PLAYERS.0.map(str::to_owned).to_vec(), PLAYERS.1);
        let players = Criteria { ladder, ladder_plays, held_out: Vec::new(), ..Criteria::default() };
        let players = players.check()?.players();
        let panel = Panel::new(config.criteria.check()?, Effort::Calls(config.calls));
        let avoided = games.iter().flat_map(|game| forms(&game.game, &game.levels)).collect();
        let sources: Vec<Source> =
            games.into_iter().map(|game| Source::new(game, &config)).collect::<Result<_, _>>()?;
        if sources.is_empty() {
            return Err(StreamError::NoGame);
        }
        let root = SeedPath::from(seed).child(NAMESPACE, 0);
        Ok(Stream { root, sources, config, panel, players, avoided })
    }

    /// Excludes levels, and all levels that equal them up to symmetry and names, from the stream. Cost: an analysis of
    /// the game.
    pub fn avoid(&mut self, game: &Game, levels: &[Level]) {
        self.avoided.extend(forms(game, levels));
    }

    /// Makes the item with the given index. If its first game does not give a verified level, the other games are tried
    /// in an order that depends only on the item. Cost: at most [`StreamConfig::attempts`] levels per game, each with
    /// about [`StreamConfig::calls`] forward-model calls. `progress` is told before each level.
    ///
    /// # Errors
    /// Returns [`StreamError::NoneAccepted`] if no game gave a verified level. The result is the same each time.
    pub fn item(&self, index: u64, progress: &dyn Progress) -> Result<StreamItem, StreamError> {
        let path = self.root.child("item", index);
        let mut order: Vec<&Source> = self.sources.iter().collect();
        path.seed().child("order", 0).sampler().shuffle(&mut order);
        let mut tally = Tally::default();
        let item = order.into_iter().zip(0..).find_map(|(source, rank)| {
            source.make(self, index, &path.child("game", rank), &mut tally, progress)
        });
        item.ok_or_else(|| StreamError::NoneAccepted {
            index,
            drawn: tally.levels_tried,
            why: tally.reasons(),
        })
    }
}

/// Returns the form digests of a game's levels, which are equal for levels that are equal up to symmetry and names.
fn forms(game: &Game, levels: &[Level]) -> Vec<Digest> {
    let likeness = LevelSimilarity::of(&Analysis::of(game));
    levels.iter().map(|level| likeness.digest(level)).collect()
}
