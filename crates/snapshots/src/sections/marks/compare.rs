//! The differences between the reference results of two releases.

use super::{MarkRate, Marks};
use crate::card::rungs::Clustered;
use serde::{Deserialize, Serialize};
use validators::{Commitment, Tier};

/// The difference between a reference player's win rates in two releases.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MarkDifference {
    /// The tier (difficulty class); `None` for all levels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tier: Option<Tier>,
    /// The reference player.
    pub player: String,
    /// The number of actions that the player commits to at each decision.
    pub commit: Commitment,
    /// The win rate in the first release.
    pub ours: Clustered,
    /// The win rate in the second release.
    pub theirs: Clustered,
    /// The mean of `ours` minus the mean of `theirs`, from −1 to 1.
    pub difference: f64,
    /// The 95% interval of the difference, clustered by game.
    pub interval: [f64; 2],
}

/// Returns the differences between the reference results that both releases contain, in the order of
/// [`Marks::rates`]. Empty if the episodes of the two releases have different limits and therefore cannot be
/// compared.
pub fn mark_differences(ours: &Marks, theirs: &Marks) -> Vec<MarkDifference> {
    if ours.asked.max_steps != theirs.asked.max_steps {
        return Vec::new();
    }
    let of = |ours: &MarkRate| {
        let is_same = |theirs: &&MarkRate| {
            (theirs.tier, &theirs.player, theirs.commit) == (ours.tier, &ours.player, ours.commit)
        };
        let theirs = theirs.rates.iter().find(is_same)?;
        let (difference, interval) = ours.rate.minus(&theirs.rate);
        Some(MarkDifference {
            tier: ours.tier,
            player: ours.player.clone(),
            commit: ours.commit,
            ours: ours.rate.clone(),
            theirs: theirs.rate.clone(),
            difference,
            interval,
        })
    };
    ours.rates.iter().filter_map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::super::tests::marks;
    use super::*;

    #[test]
    fn marks_of_two_releases_are_compared() {
        let ids = ["a", "b", "c", "d", "e", "f", "g", "h"];
        let old = marks(&ids, |_, _| vec![vec![0, 0], vec![2, 2]]);
        let new = marks(&ids, |_, _| vec![vec![2, 0], vec![2, 2]]);
        let found = mark_differences(&new, &old);
        assert_eq!(found.len(), new.rates.len());
        let random = found.iter().find(|one| one.tier.is_none() && one.player == "random").unwrap();
        assert_eq!((random.difference, random.interval[1]), (1.0, 1.0));
        assert!(random.interval[0] > 0.3, "{random:?}");
        let mut longer = old.clone();
        longer.asked.max_steps += 1;
        assert!(mark_differences(&new, &longer).is_empty());
        let mut fewer = old;
        fewer.rates.retain(|rate| rate.player == "random");
        assert!(mark_differences(&new, &fewer).iter().all(|one| one.player == "random"));
    }
}
