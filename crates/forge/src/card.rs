//! `card.json`: the description of a game of a release, its origin, and the results of its judges.

use base::Digest;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use validators::{Demand, Ladder, Rate, Tier};

/// The origin of a game.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "from", rename_all = "lowercase", deny_unknown_fields)]
pub enum Origin {
    /// A hand-written game with new levels.
    Corpus {
        /// Its folder in the corpus.
        name: String,
    },
    /// A game made by the rule generator.
    Generated {
        /// The generator.
        generator: String,
        /// The kernel, its variants and the scene, each with its kind: `kernel/one-spark`.
        patterns: Vec<String>,
        /// The index of the candidate among those for its place, from 0.
        candidate: u32,
    },
}

impl Origin {
    /// The kernel of a generated game.
    pub fn kernel(&self) -> Option<&str> {
        let Origin::Generated { patterns, .. } = self else { return None };
        patterns.iter().find_map(|pattern| pattern.strip_prefix("kernel/"))
    }

    /// The form of the kernel of a generated game; `None` for the kernel as such.
    pub fn form(&self) -> Option<&str> {
        let Origin::Generated { patterns, .. } = self else { return None };
        patterns.iter().find_map(|pattern| pattern.strip_prefix("form/"))
    }

    /// The scene of a generated game.
    pub fn scene(&self) -> Option<&str> {
        let Origin::Generated { patterns, .. } = self else { return None };
        patterns.iter().find_map(|pattern| pattern.strip_prefix("scene/"))
    }

    /// The kernel and variants of a generated game, without duplicates; of earlier generations its patterns, excluding its theme or scene,
    /// and the edits of search and shrinking.
    pub fn mechanics(&self) -> BTreeSet<&str> {
        let Origin::Generated { patterns, .. } = self else { return BTreeSet::new() };
        let kept =
            |pattern: &&str| !["edit/", "fiction/", "scene/"].iter().any(|other| pattern.starts_with(other));
        patterns.iter().map(String::as_str).filter(kept).collect()
    }
}

/// A level and the results of its judges.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LevelCard {
    /// The file beside the card.
    pub file: String,
    /// Digest of the level's canonical text.
    pub digest: Digest,
    /// Columns of the board.
    pub columns: usize,
    /// Rows of the board.
    pub rows: usize,
    /// The generator that made it.
    pub generator: String,
    /// Its question to the player, in a sentence, if it is a level of a course.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub asks: Option<String>,
    /// The difficulty that was requested, from 0 to 1.
    pub difficulty: f64,
    /// The index of the candidate among those for its place, from 0.
    pub candidate: u32,
    /// The ticks of the witness.
    pub witness_ticks: usize,
    /// The score of the witness.
    pub witness_score: f64,
    /// The ticks of the shortest win, if it is proved to be the shortest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub optimal_ticks: Option<usize>,
    /// The forward-model calls that the search for the witness took.
    #[serde(default)]
    pub search_calls: u64,
    /// The win rate of plain Monte-Carlo tree search.
    pub mcts: Rate,
    /// The win rate of random players.
    pub random: Rate,
    /// The win rate of players that do nothing.
    pub idle: Rate,
    /// The results of the players of a ladder, and the difficulty that follows from them, if the recipe asks for
    /// `skill`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ladder: Option<Ladder>,
    /// The demands of a win on a player, if the recipe asks for tiers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub demand: Option<Demand>,
    /// The tier that follows from it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tier: Option<Tier>,
}

/// A game of a release.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Card {
    /// The release's canary: text that contains it should not be trained on.
    pub canary: String,
    /// The folder in `games/`.
    pub id: String,
    /// The title under the game's own theme.
    pub title: String,
    /// A description for people.
    pub description: String,
    /// The goal in words, for people.
    pub goal: String,
    /// The kind of game.
    pub kind: String,
    /// `true` if something moves even if the player does not act.
    pub real_time: bool,
    /// `true` if chance plays no part.
    pub deterministic: bool,
    /// The digest of the game's canonical text without comments.
    pub digest: Digest,
    /// The origin of the game.
    pub origin: Origin,
    /// The rules in plain English.
    pub rules: String,
    /// The levels, in order of the requested difficulty, from the easiest to the hardest.
    pub levels: Vec<LevelCard>,
}
