//! `card.json`: a released game's description, its origin, and its judges' results.

use base::Digest;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use validators::{Demand, Ladder, Rate, Tier};

/// A game's origin.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "from", rename_all = "lowercase", deny_unknown_fields)]
pub enum Origin {
    /// A hand-written game with new levels.
    Corpus {
        /// The name of the game's folder in the corpus.
        name: String,
    },
    /// A game made by a rule generator.
    Generated {
        /// The generator's name.
        generator: String,
        /// The sources of the game, each prefixed with its kind, as in `kernel/one-spark`: the kernel (a hand-written
        /// design), its variants, and the scene that supplies the nouns.
        patterns: Vec<String>,
        /// The index of the candidate among the candidates for the game's position in the release, from 0.
        candidate: u32,
    },
}

impl Origin {
    /// Returns the patterns of a generated game; empty for other games.
    pub fn patterns(&self) -> &[String] {
        match self {
            Origin::Generated { patterns, .. } => patterns,
            Origin::Corpus { .. } => &[],
        }
    }

    /// Returns the kernel (hand-written design) from which a game was generated; `None` for other games.
    pub fn kernel(&self) -> Option<&str> {
        let Origin::Generated { patterns, .. } = self else { return None };
        patterns.iter().find_map(|pattern| pattern.strip_prefix("kernel/"))
    }

    /// Returns the form of the kernel (hand-written design) from which a game was generated. A form is a variation of a
    /// kernel. Returns `None` for the unmodified kernel.
    pub fn form(&self) -> Option<&str> {
        let Origin::Generated { patterns, .. } = self else { return None };
        patterns.iter().find_map(|pattern| pattern.strip_prefix("form/"))
    }

    /// Returns the scene (theme) whose nouns a generated game uses; `None` for other games.
    pub fn scene(&self) -> Option<&str> {
        let Origin::Generated { patterns, .. } = self else { return None };
        patterns.iter().find_map(|pattern| pattern.strip_prefix("scene/"))
    }

    /// Returns the kernel (hand-written design) and the variants of a generated game, without duplicates. For games
    /// from earlier generators, returns all patterns except the theme or scene and the edits made by search and
    /// shrinking.
    pub fn mechanics(&self) -> BTreeSet<&str> {
        let Origin::Generated { patterns, .. } = self else { return BTreeSet::new() };
        let kept =
            |pattern: &&str| !["edit/", "fiction/", "scene/"].iter().any(|other| pattern.starts_with(other));
        patterns.iter().map(String::as_str).filter(kept).collect()
    }
}

/// A level and its judges' results.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LevelCard {
    /// The level's file, next to the card.
    pub file: String,
    /// The digest of the level's canonical text.
    pub digest: Digest,
    /// The number of columns of the board.
    pub columns: usize,
    /// The number of rows of the board.
    pub rows: usize,
    /// The name of the generator that made the level.
    pub generator: String,
    /// A sentence about the problem that the level poses to the player, if the level was made for a position in the
    /// game.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub asks: Option<String>,
    /// The requested difficulty, from 0 to 1.
    pub difficulty: f64,
    /// The index of the candidate among the candidates for the level's position in the game, from 0.
    pub candidate: u32,
    /// The number of ticks of the witness.
    pub witness_ticks: usize,
    /// The witness's score.
    pub witness_score: f64,
    /// The number of ticks in the shortest win, if it is proved to be the shortest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub optimal_ticks: Option<usize>,
    /// The number of forward-model calls spent on searching for the witness.
    #[serde(default)]
    pub search_calls: u64,
    /// The win rate of plain Monte Carlo tree search.
    pub mcts: Rate,
    /// The win rate of random players.
    pub random: Rate,
    /// The win rate of players that do nothing.
    pub idle: Rate,
    /// The results of the ladder, which is a list of reference players of increasing strength, and the difficulty
    /// derived from them. Present if the recipe requests `skill`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ladder: Option<Ladder>,
    /// The measured demands of a win on a player, such as the number of decisions. Present if the recipe requests
    /// tiers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub demand: Option<Demand>,
    /// The tier (difficulty class from 1 to 4) derived from the demands. Present if the demands are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tier: Option<Tier>,
}

/// The card of a game in a release.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Card {
    /// The release's canary: an identifier that shows whether a text corpus contains the release. Text that contains
    /// the canary should be excluded from training data.
    pub canary: String,
    /// The game's folder in `games/`.
    pub id: String,
    /// The title in the game's theme.
    pub title: String,
    /// A description for players.
    pub description: String,
    /// The goal in plain English, for players.
    pub goal: String,
    /// The kind of game.
    pub kind: String,
    /// `true` if sprites move even while the player does nothing.
    pub real_time: bool,
    /// `true` if the game has no randomness.
    pub deterministic: bool,
    /// The digest of the game's canonical text without comments.
    pub digest: Digest,
    /// The game's origin.
    pub origin: Origin,
    /// The rules in plain English.
    pub rules: String,
    /// The levels, ordered by requested difficulty, from easiest to hardest.
    pub levels: Vec<LevelCard>,
}
