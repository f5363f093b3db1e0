//! The parts of a recipe that determine which games are minted: corpus games, generated games, and their kinds.

use generators::games::Kind;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use validators::Criteria;
use validators::measures::{AvatarKind, GoalKind};

base::with_defaults! {
    /// New levels for corpus games, under a new theme.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct CorpusPart {
        /// The number of games.
        pub games: u32 = 0,
        /// The number of levels per game, ordered from easiest to hardest.
        pub levels: u32 = 3,
        /// The maximum number of attempts to make a set of levels for one game.
        pub game_tries: u32 = 8,
        /// The maximum number of attempts to make each level.
        pub level_tries: u32 = 12,
        /// The number of candidate games per selected game.
        pub candidates: f64 = 1.5,
        /// The criteria for the levels of corpus games, if they differ from the criteria for new games. Hand-made
        /// games are scarcer than games that can be generated.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub criteria: Option<Criteria> = None,
    }
}

base::with_defaults! {
    /// New games from kernels (hand-written designs).
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct GeneratedPart {
        /// The number of games.
        pub games: u32 = 0,
        /// The number of levels per game, ordered from easiest to hardest.
        pub levels: u32 = 3,
        /// The maximum number of attempts to make a game for one candidate.
        pub game_tries: u32 = 48,
        /// The maximum number of attempts to make each level.
        pub level_tries: u32 = 12,
        /// The number of candidate games per selected game.
        pub candidates: f64 = 1.25,
        /// The weights of the generation methods. Earlier versions searched for games from kernels, but this version
        /// only draws them, so weights other than `constructive` must be 0.
        pub mix: Mix = Mix::default(),
        /// The kinds of games; if empty, all kinds.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        pub kinds: Vec<Kind> = Vec::new(),
        /// The minimum number of interactions in a game.
        pub least_interactions: usize = 7,
        /// The minimum number of distinct interactions that the wins on a game's levels execute in total.
        pub least_mechanics: usize = 3,
    }
}

base::with_defaults! {
    /// Invented games. Their rules merge several mechanics, and a search finds boards for them.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct InventedPart {
        /// The number of games.
        pub games: u32 = 0,
        /// The number of levels per game, ordered from easiest to hardest.
        pub levels: u32 = 3,
        /// The maximum number of attempts at a rule set for one candidate.
        pub game_tries: u32 = 16,
        /// The maximum number of searches for each level's board.
        pub level_tries: u32 = 3,
        /// The number of candidate games per selected game.
        pub candidates: f64 = 2.0,
        /// The weights of the methods among the candidates.
        pub mix: Mix = Mix::default(),
    }
}

/// The weights of the generation methods.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mix {
    /// The weight of randomly drawn games.
    #[serde(default)]
    pub constructive: f64,
    /// The weight of games found by search.
    #[serde(default)]
    pub search: f64,
    /// The weight of games evolved in archives.
    #[serde(default)]
    pub evolutionary: f64,
}

impl Default for Mix {
    fn default() -> Mix {
        Mix { constructive: 1.0, search: 0.0, evolutionary: 0.0 }
    }
}

/// Quotas for the kinds of games in a release.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Taxonomy {
    /// The minimum and maximum fraction of games with each goal.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub goals: BTreeMap<GoalKind, (f64, f64)>,
    /// The minimum and maximum fraction of games with each avatar.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub avatars: BTreeMap<AvatarKind, (f64, f64)>,
    /// The maximum fraction of games with the same goal and avatar.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crowd: Option<f64>,
}
