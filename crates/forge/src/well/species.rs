//! Counts of game parts, where each game counts a part once. They yield the unseen probability mass and the most
//! frequent part.

use super::month::Top;
use std::collections::BTreeMap;

/// The number of games that contain each part.
#[derive(Debug, Default)]
pub(super) struct Species {
    counts: BTreeMap<String, u64>,
}

impl Species {
    /// Counts the parts of one game.
    pub(super) fn count<'a>(&mut self, parts: impl IntoIterator<Item = &'a str>) {
        for part in parts {
            *self.counts.entry(part.to_owned()).or_default() += 1;
        }
    }

    /// Returns the estimated probability that the next part drawn is new; `None` without parts.
    pub(super) fn unseen(&self) -> Option<f64> {
        good_turing(self.counts.values().copied())
    }

    /// Returns the part that occurs in the most games, with its fraction of `games`. Ties go to the name that comes
    /// first alphabetically. Returns `None` if no part was counted.
    pub(super) fn top(&self, games: u32) -> Option<Top> {
        let most = self.counts.values().max()?;
        let (name, count) = self.counts.iter().find(|(_, count)| *count == most)?;
        Some(Top { name: name.clone(), share: *count as f64 / f64::from(games.max(1)) })
    }
}

/// Returns the number of counts that are 1, divided by the sum of all counts. This quotient estimates the probability
/// that the next observation is new (I. J. Good, "The population frequencies of species and the estimation of
/// population parameters", Biometrika 40, 1953). Returns `None` if nothing was observed.
pub(super) fn good_turing(counts: impl Iterator<Item = u64>) -> Option<f64> {
    let (once, all) =
        counts.fold((0u64, 0u64), |(once, all), count| (once + u64::from(count == 1), all + count));
    (all > 0).then(|| once as f64 / all as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_seen_once_is_the_unseen_mass() {
        let mut species = Species::default();
        assert_eq!((species.unseen(), species.top(0)), (None, None));
        species.count(["lock", "feed"]);
        species.count(["lock", "crush"]);
        assert_eq!(species.unseen(), Some(0.5));
        assert_eq!(species.top(2), Some(Top { name: "lock".to_owned(), share: 1.0 }));
    }
}
