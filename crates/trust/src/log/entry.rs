//! Log entries: a publisher's statements in chronological order.

use crate::beacon::{Proof, check_source};
use crate::error::TrustError;
use crate::key_set::canonical;
use base::Digest;
use base::canonical::to_canonical_json;
use serde::{Deserialize, Serialize};

/// A log entry, stored as canonical JSON.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Entry {
    /// A new key set.
    Keys {
        /// The set's number.
        version: u32,
        /// The digest of the set's file.
        digest: Digest,
        /// The digest of the previous set; `None` for the first set.
        previous: Option<Digest>,
    },
    /// A commitment to a release's secret. The commitment must be logged before the release is minted.
    Commitment {
        /// The release's name.
        release: String,
        /// The commitment, which covers the recipe.
        commitment: Digest,
        /// The digest of the recipe covered by the commitment.
        recipe: Digest,
        /// The previous release's root; `None` for the first release.
        parent: Option<Digest>,
        /// The round of public randomness that the recipe uses; `None` if it uses none. The round's value must still be
        /// unknown when the commitment is logged.
        beacon: Option<Round>,
    },
    /// A published public random value.
    Beacon {
        /// The value's source and round.
        round: Round,
        /// The 32-byte random value.
        value: Digest,
        /// The round's signature, required for drand values; `None` for other sources.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        proof: Option<Proof>,
    },
    /// A minted release.
    Root {
        /// The release's name.
        release: String,
        /// The release's root.
        root: Digest,
        /// The previous release's root; `None` for the first release.
        parent: Option<Digest>,
        /// The release's commitment, if the release is sealed (its seed and witnesses are withheld).
        commitment: Option<Digest>,
        /// The public random value from which the release's seed was also derived; `None` if no such value was used.
        beacon: Option<Digest>,
        /// The digest of the signed statement about the release, if any.
        statement: Option<Digest>,
    },
    /// A sealed release's revealed secret.
    Reveal(Revealed),
    /// A release's calibration, which places the release on the scale.
    Calibration {
        /// The release's name.
        release: String,
        /// The release's root.
        root: Digest,
        /// The digest of the calibration file.
        file: Digest,
    },
    /// A player's result: a row in the leaderboard.
    Result(ResultRow),
}

/// A round in which a source of randomness publishes a value.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Round {
    /// The source, such as `drand quicknet`.
    pub source: String,
    /// The round number.
    pub round: u64,
}

/// A sealed release's published secret.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Revealed {
    /// The release's name.
    pub release: String,
    /// The release's root.
    pub root: Digest,
    /// The text from which the release's seed is derived.
    pub seed: String,
    /// The commitment's nonce.
    pub nonce: Digest,
    /// The digest of the recipe for which the secret was drawn.
    pub recipe: Digest,
}

/// A leaderboard row, which anyone can recompute from the episodes' logs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ResultRow {
    /// The release's name.
    pub release: String,
    /// The release's root.
    pub root: Digest,
    /// The digest of the files in the results folder.
    pub results: Digest,
    /// The player's label.
    pub player: String,
    /// The track (bundle of prompt settings) with its version, or `None` for custom prompts and for players that read
    /// no prompts.
    pub track: Option<String>,
    /// The number of actions per answer, or `all`.
    pub horizon: String,
    /// The number of finished episodes.
    pub episodes: u64,
    /// The number of aborted, unfinished and unplayed episodes.
    pub open: u64,
    /// The number of won episodes.
    pub wins: u64,
    /// The fraction of won episodes.
    pub rate: f64,
    /// The 95% interval of the win rate.
    pub interval: (f64, f64),
    /// The mean score; `None` without finished episodes.
    pub score: Option<f64>,
}

/// The maximum relative difference between results from two machines. Results can differ because intervals
/// use the platform's logarithm.
const ROUNDING: f64 = 1e-9;

impl ResultRow {
    /// Returns the fields in which a row recomputed from the same results differs, each with both values.
    pub fn differences(&self, again: &ResultRow) -> Vec<String> {
        let texts = |row: &ResultRow| {
            let track = row.track.clone().unwrap_or_default();
            let ResultRow { release, root, results, player, horizon, episodes, open, wins, .. } = row;
            [
                ("release", release.clone()),
                ("root", root.to_string()),
                ("results", results.to_string()),
                ("player", player.clone()),
                ("track", track),
                ("horizon", horizon.clone()),
                ("episodes", episodes.to_string()),
                ("open", open.to_string()),
                ("wins", wins.to_string()),
            ]
        };
        let numbers = |row: &ResultRow| {
            [("rate", row.rate), ("interval.low", row.interval.0), ("interval.high", row.interval.1)]
                .into_iter()
                .chain(row.score.map(|score| ("score", score)))
                .collect::<Vec<_>>()
        };
        let mut found = Vec::new();
        for ((key, stated), (_, now)) in texts(self).into_iter().zip(texts(again)) {
            if stated != now {
                found.push(format!("`{key}` is {stated} in the log, but {now} according to the episodes"));
            }
        }
        let (stated, now) = (numbers(self), numbers(again));
        if stated.len() != now.len() {
            found.push("`score` is missing either from the log or from the episodes".to_owned());
        }
        for ((key, stated), (_, now)) in stated.into_iter().zip(now) {
            // A non-finite number differs from every number.
            let is_same = (stated - now).abs() <= ROUNDING * stated.abs().max(1.0);
            if !is_same {
                found.push(format!("`{key}` is {stated} in the log, but {now} according to the episodes"));
            }
        }
        found
    }
}

impl Entry {
    /// Parses an entry.
    ///
    /// # Errors
    /// Returns an error if this version of arcade does not know the kind of entry, or if the bytes are not in
    /// canonical form.
    pub fn parse(bytes: &[u8], place: &str) -> Result<Entry, TrustError> {
        canonical(bytes, place)
    }

    /// Returns the entry's bytes.
    ///
    /// # Errors
    /// Returns an error if a number is not finite, or if the entry is larger than a log allows.
    pub fn to_bytes(&self) -> Result<Vec<u8>, TrustError> {
        let text = to_canonical_json(self).map_err(|error| TrustError::Refused(error.to_string()))?;
        match text.len() <= super::tiles::MAX_ENTRY {
            true => Ok(text.into_bytes()),
            false => Err(TrustError::Refused("the entry is larger than 65535 bytes".to_owned())),
        }
    }

    /// Formats the entry as one human-readable line.
    pub fn line(&self) -> String {
        match self {
            Entry::Keys { version, .. } => format!("keys         {version}"),
            Entry::Commitment { release, beacon: Some(round), .. } => {
                format!("commitment   {release}, with round {} of {}", round.round, round.source)
            }
            Entry::Commitment { release, .. } => format!("commitment   {release}"),
            Entry::Beacon { round, proof, .. } => {
                let is_signed = proof.is_some() && check_source(&round.source) == Ok(true);
                let known = if is_signed { "signed by the network" } else { "as stated in the log" };
                format!("beacon       round {} of {}, {known}", round.round, round.source)
            }
            Entry::Root { release, root, .. } => format!("root         {release}  {root}"),
            Entry::Reveal(revealed) => format!("reveal       {}", revealed.release),
            Entry::Calibration { release, .. } => format!("calibration  {release}"),
            Entry::Result(row) => format!(
                "result       {}  {}, horizon {}: {} of {} won, {:.3} ({:.3} to {:.3})",
                row.release,
                row.player,
                row.horizon,
                row.wins,
                row.episodes,
                row.rate,
                row.interval.0,
                row.interval.1
            ),
        }
    }

    /// Returns the name of the entry's release, if any.
    pub fn release(&self) -> Option<&str> {
        match self {
            Entry::Keys { .. } | Entry::Beacon { .. } => None,
            Entry::Commitment { release, .. }
            | Entry::Root { release, .. }
            | Entry::Calibration { release, .. } => Some(release),
            Entry::Reveal(revealed) => Some(&revealed.release),
            Entry::Result(row) => Some(&row.release),
        }
    }
}
