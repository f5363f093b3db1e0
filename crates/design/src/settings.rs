//! The settings of a run, which determine everything except the designer's answers.

use crate::brief::Brief;
use crate::references::Reference;
use base::canonical::canonical_digest;
use base::{Digest, Seed};
use evaluation::client::Price;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use validators::{Criteria, CriterionSet};

/// The version of the draft folder format.
pub const FORMAT: u32 = 1;

/// The settings of a run. They are stored in its folder, and a resumed run must have the same settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DesignSettings {
    /// The version of the folder's format: [`FORMAT`].
    pub format: u32,
    /// The version of the engine's semantics ([`engine::SEMANTICS`]).
    pub semantics: u32,
    /// The version of the program that created the folder.
    pub suite: String,
    /// The designer's name in results.
    pub designer: String,
    /// The designer's own settings, such as the model and its decoding.
    pub details: Value,
    /// The price of the model's tokens, if known.
    pub price: Option<Price>,
    /// The number of drafts.
    pub drafts: u64,
    /// The text from which the seeds are derived.
    pub seed: String,
    /// The assignment that the model receives.
    pub brief: Brief,
    /// The criteria that a game must meet.
    pub criteria: Criteria,
    /// The digest of the games that were known when the run began, from which all games must differ.
    pub known: Digest,
}

impl DesignSettings {
    /// Returns the criteria for accepted games: those for releases, with all gates. `budget` is the number of
    /// forward-model calls per level for finding a win.
    pub fn criteria(budget: u64) -> Criteria {
        let criteria = Criteria::default();
        Criteria { budget, ask: criteria.ask.with(CriterionSet::GATES), ..criteria }
    }

    /// Returns the settings' digest. Distinct settings have distinct digests.
    ///
    /// # Panics
    /// Panics if the criteria contain a number that JSON cannot represent, which checked criteria never do.
    pub fn digest(&self) -> Digest {
        canonical_digest(self).expect("checked settings are plain data")
    }

    /// Returns the reference designer that wrote the drafts, or `None` if the designer answers questions.
    pub fn reference(&self) -> Option<Reference> {
        serde_json::from_value(self.details.get("reference")?.clone()).ok()
    }

    /// Returns the seed of a draft.
    pub(crate) fn draft_seed(&self, number: u64) -> Seed {
        Seed::from_text(&self.seed).child("draft", number)
    }
}
