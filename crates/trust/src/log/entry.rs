//! The entries of a log: what a publisher states, in the order in which it was stated.

use crate::beacon::{Proof, check_source};
use crate::error::TrustError;
use crate::key_set::canonical;
use base::Digest;
use base::canonical::to_canonical_json;
use serde::{Deserialize, Serialize};

/// An entry of a log: canonical JSON.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Entry {
    /// A set of keys.
    Keys {
        /// The number of the set.
        version: u32,
        /// The digest of its file.
        digest: Digest,
        /// The digest of the set before.
        previous: Option<Digest>,
    },
    /// The commitment to a secret, before the release is minted.
    Commitment {
        /// The name of the release.
        release: String,
        /// The commitment, which covers the recipe.
        commitment: Digest,
        /// The digest of the recipe that it covers.
        recipe: Digest,
        /// The root of the release before.
        parent: Option<Digest>,
        /// The public randomness that the recipe names, and that nobody knows yet.
        beacon: Option<Round>,
    },
    /// Public randomness, once it is known.
    Beacon {
        /// The source and the round.
        round: Round,
        /// The 32 bytes.
        value: Digest,
        /// The signature of the round, which a value of drand needs.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        proof: Option<Proof>,
    },
    /// A release.
    Root {
        /// The name of the release.
        release: String,
        /// Its root.
        root: Digest,
        /// The root of the release before.
        parent: Option<Digest>,
        /// The commitment of a sealed release.
        commitment: Option<Digest>,
        /// The value of the beacon that is mixed into its seed.
        beacon: Option<Digest>,
        /// The digest of the signed statement about it.
        statement: Option<Digest>,
    },
    /// The secret of a sealed release.
    Reveal(Revealed),
    /// Difficulties of a release on the scale.
    Calibration {
        /// The name of the release.
        release: String,
        /// Its root.
        root: Digest,
        /// The digest of the file.
        file: Digest,
    },
    /// The result of a player: a row of the leaderboard.
    Result(ResultRow),
}

/// A value that a source of randomness publishes in a round.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Round {
    /// The source, such as `drand quicknet`.
    pub source: String,
    /// The number of the round.
    pub round: u64,
}

/// The secret of a sealed release, published.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Revealed {
    /// The name of the release.
    pub release: String,
    /// Its root.
    pub root: Digest,
    /// The text that the seed is derived from.
    pub seed: String,
    /// The nonce.
    pub nonce: Digest,
    /// The digest of the recipe that the secret was drawn for.
    pub recipe: Digest,
}

/// A row of the leaderboard, which anybody can compute again from the logs of its episodes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ResultRow {
    /// The name of the release.
    pub release: String,
    /// The root of the release.
    pub root: Digest,
    /// The digest over the files of the results folder.
    pub results: Digest,
    /// The player.
    pub player: String,
    /// The track with its version; `None` for players that read no prompts, or prompts put together by hand.
    pub track: Option<String>,
    /// The actions that an answer commits to: a number, or `all`.
    pub horizon: String,
    /// The number of episodes that ended.
    pub episodes: u64,
    /// The number of episodes that were aborted, or not finished, or not played.
    pub open: u64,
    /// The number of episodes that were won.
    pub wins: u64,
    /// The share of episodes that were won.
    pub rate: f64,
    /// The interval of this share, 95 %.
    pub interval: (f64, f64),
    /// The mean score.
    pub score: Option<f64>,
}

/// The greatest difference between numbers of two machines: the logarithm of intervals is that of the platform.
const ROUNDING: f64 = 1e-9;

impl ResultRow {
    /// The fields in which another row for the same results differs, each with both values.
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
                found.push(format!("`{key}` is {stated} in the log, and {now} by the episodes"));
            }
        }
        let (stated, now) = (numbers(self), numbers(again));
        if stated.len() != now.len() {
            found.push("`score` is in one of the two only".to_owned());
        }
        for ((key, stated), (_, now)) in stated.into_iter().zip(now) {
            // A number that is not finite differs from all.
            let is_same = (stated - now).abs() <= ROUNDING * stated.abs().max(1.0);
            if !is_same {
                found.push(format!("`{key}` is {stated} in the log, and {now} by the episodes"));
            }
        }
        found
    }
}

impl Entry {
    /// Reads an entry.
    ///
    /// # Errors
    /// It is none that this arcade knows, or its text is not the canonical one.
    pub fn parse(bytes: &[u8], place: &str) -> Result<Entry, TrustError> {
        canonical(bytes, place)
    }

    /// The bytes of the entry.
    ///
    /// # Errors
    /// A number is not finite, or the entry is larger than a log takes.
    pub fn to_bytes(&self) -> Result<Vec<u8>, TrustError> {
        let text = to_canonical_json(self).map_err(|error| TrustError::Refused(error.to_string()))?;
        match text.len() <= super::tiles::MAX_ENTRY {
            true => Ok(text.into_bytes()),
            false => Err(TrustError::Refused("the entry is larger than 65535 bytes".to_owned())),
        }
    }

    /// A line for people.
    pub fn line(&self) -> String {
        match self {
            Entry::Keys { version, .. } => format!("keys         {version}"),
            Entry::Commitment { release, beacon: Some(round), .. } => {
                format!("commitment   {release}, with round {} of {}", round.round, round.source)
            }
            Entry::Commitment { release, .. } => format!("commitment   {release}"),
            Entry::Beacon { round, proof, .. } => {
                let is_signed = proof.is_some() && check_source(&round.source) == Ok(true);
                let known = if is_signed { "signed by the network" } else { "as the log states it" };
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

    /// The name of the release that it is about.
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
