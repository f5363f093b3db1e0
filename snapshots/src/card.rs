//! `card.json`: what a game of a release is, where it comes from, and what its judges found.

use engine::Digest;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use validators::{Ladder, Rate};

/// Where a game comes from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "from", rename_all = "lowercase", deny_unknown_fields)]
pub enum Origin {
    /// A hand-written game with new levels.
    Corpus {
        /// Its folder in the corpus.
        name: String,
    },
    /// A game that the rule generator made.
    Generated {
        /// The generator.
        generator: String,
        /// The patterns that were composed.
        patterns: Vec<String>,
        /// Which candidate for its place it was, counted from 0.
        candidate: u32,
    },
}

impl Origin {
    /// The patterns of mechanics that a generated game was composed of, each once: without its fiction, and without what
    /// search and shrinking did to it.
    pub fn mechanics(&self) -> BTreeSet<&str> {
        let Origin::Generated { patterns, .. } = self else { return BTreeSet::new() };
        let kept = |pattern: &&str| !["edit/", "fiction/"].iter().any(|other| pattern.starts_with(other));
        patterns.iter().map(String::as_str).filter(kept).collect()
    }
}

/// A level and what its judges found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LevelCard {
    /// File beside the card.
    pub file: String,
    /// Digest of the level's canonical text.
    pub digest: Digest,
    /// Columns of the board.
    pub columns: usize,
    /// Rows of the board.
    pub rows: usize,
    /// The generator that made it.
    pub generator: String,
    /// The difficulty that was asked for, from 0 to 1.
    pub difficulty: f64,
    /// Which candidate for its place it was, counted from 0.
    pub candidate: u32,
    /// Ticks of the witness.
    pub witness_ticks: usize,
    /// Score of the witness.
    pub witness_score: f64,
    /// Ticks of the shortest win, where it is proved that no fewer win.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub optimal_ticks: Option<usize>,
    /// Forward-model calls that it took to find the witness.
    #[serde(default)]
    pub search_calls: u64,
    /// How often plain Monte-Carlo tree search won.
    pub mcts: Rate,
    /// How random players fared.
    pub random: Rate,
    /// How players fared who did nothing.
    pub idle: Rate,
    /// How the players of a ladder fared, and how hard that makes the level, if the recipe asks for `skill`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ladder: Option<Ladder>,
}

/// A game of a release.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Card {
    /// The release's mark: text that holds it should not be trained on.
    pub canary: String,
    /// Folder in `games/`.
    pub id: String,
    /// Title in the game's own fiction.
    pub title: String,
    /// What it is, for people.
    pub description: String,
    /// How to win, for people.
    pub goal: String,
    /// Which kind of game.
    pub kind: String,
    /// Whether anything moves unless the player acts.
    pub real_time: bool,
    /// Whether chance plays no part.
    pub deterministic: bool,
    /// Digest of the game's canonical text without comments.
    pub digest: Digest,
    /// Where it comes from.
    pub origin: Origin,
    /// The rules in plain English.
    pub rules: String,
    /// Its levels, from the easiest asked for to the hardest.
    pub levels: Vec<LevelCard>,
}
