//! The result of a validator.

use crate::evidence::Evidence;
use crate::measures::ladder::{Ladder, Rate};
use engine::Episode;
use serde::{Deserialize, Serialize};

/// A verdict, and the observations and measurements behind it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// The validator's verdict.
    #[serde(flatten)]
    pub verdict: Verdict,
    /// The measured players' win rate, or `None` if no player was measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measured: Option<Rate>,
    /// The number of forward-model calls made by a search, in addition to those in the measured episodes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub searched: Option<u64>,
    /// The number of ticks in the shortest win, if it is proven to be the shortest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub optimal: Option<usize>,
    /// The value that a gate measured, for tables.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub figure: Option<f64>,
    /// The names of the placed types that are not needed to win, if `necessity` was checked.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub idle_types: Vec<String>,
    /// The observations, in report order.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub evidence: Vec<Evidence>,
    /// The results of the ladder (reference players of increasing strength), if a ladder was played.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ladder: Option<Ladder>,
    /// The episodes played, which show the rules that are used in play.
    #[serde(skip)]
    pub episodes: Vec<Episode>,
}

impl From<Verdict> for Finding {
    fn from(verdict: Verdict) -> Finding {
        Finding {
            verdict,
            measured: None,
            searched: None,
            optimal: None,
            figure: None,
            idle_types: Vec::new(),
            evidence: Vec::new(),
            ladder: None,
            episodes: Vec::new(),
        }
    }
}

impl Finding {
    /// Returns the total number of forward-model calls in measured episodes, in searches, and by the players on a
    /// ladder.
    pub fn calls(&self) -> u64 {
        let ladder = self.ladder.iter().flat_map(|ladder| ladder.rungs.iter().chain(&ladder.held_out));
        let ladder: u64 = ladder.map(|result| result.rate.calls).sum();
        self.searched.unwrap_or(0) + self.measured.as_ref().map_or(0, |rate| rate.calls) + ladder
    }

    /// Adds a measured win rate to the finding.
    #[must_use]
    pub fn measured(self, rate: Rate) -> Finding {
        Finding { measured: Some(rate), ..self }
    }

    /// Adds evidence to the finding.
    #[must_use]
    pub fn seen(mut self, evidence: impl IntoIterator<Item = Evidence>) -> Finding {
        self.evidence.extend(evidence);
        self
    }

    /// Adds played episodes to the finding.
    #[must_use]
    pub fn played(mut self, episodes: impl IntoIterator<Item = Episode>) -> Finding {
        self.episodes.extend(episodes);
        self
    }
}

/// A validator's answer.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "verdict", rename_all = "lowercase")]
pub enum Verdict {
    /// The criterion is met.
    Pass {
        /// An episode that demonstrates the pass, or `None` if no single episode can.
        #[serde(skip)]
        witness: Option<Episode>,
    },
    /// The criterion is not met.
    Fail {
        /// The reason for the failure.
        reason: Reason,
        /// An episode that demonstrates the failure, or `None` if no single episode can.
        #[serde(skip)]
        witness: Option<Episode>,
    },
    /// The budget ran out before the answer was known.
    Unknown {
        /// The number of forward-model calls spent.
        spent: u64,
    },
}

impl Verdict {
    /// Returns a pass without a witness.
    pub fn pass() -> Verdict {
        Verdict::Pass { witness: None }
    }

    /// Returns a failure with a reason.
    pub fn fail(reason: impl Into<String>) -> Verdict {
        Verdict::Fail { reason: Reason(reason.into()), witness: None }
    }

    /// Returns a failure with an episode that demonstrates it.
    pub fn fail_with(reason: impl Into<String>, witness: Episode) -> Verdict {
        Verdict::Fail { reason: Reason(reason.into()), witness: Some(witness) }
    }

    /// Returns `true` if the verdict is a pass.
    pub fn is_pass(&self) -> bool {
        matches!(self, Verdict::Pass { .. })
    }
}

/// The reason for a failure, worded so that designers can act on it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Reason(pub String);
