//! Four tiers of levels, by their demands.

use super::{Commitment, Demand};
use serde::{Deserialize, Serialize};
use std::fmt;

/// A level's tier, which is a difficulty class: a documented function of its [`Demand`] ([`TIERS`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "u8", into = "u8")]
pub enum Tier {
    /// Few decisions, or no trap that punishes mistakes.
    One = 1,
    /// Some decisions, and one trap that punishes hasty decisions.
    Two = 2,
    /// Many decisions, and two traps that punish short-sighted plans.
    Three = 3,
    /// Very many decisions, and three traps.
    Four = 4,
}

/// The minimum demands of a level in a tier (difficulty class).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TierBounds {
    /// The tier with these bounds.
    pub tier: Tier,
    /// The minimum number of decisions in the win.
    pub decisions: usize,
    /// The minimum number of [traps](Demand::traps).
    pub traps: usize,
}

/// The minimum demands of each tier (difficulty class). A level belongs to the highest tier whose demands it meets.
pub const TIERS: [TierBounds; 4] = [
    TierBounds { tier: Tier::One, decisions: 0, traps: 0 },
    TierBounds { tier: Tier::Two, decisions: 20, traps: 1 },
    TierBounds { tier: Tier::Three, decisions: 50, traps: 2 },
    TierBounds { tier: Tier::Four, decisions: 120, traps: 3 },
];

/// The greatest number of actions per decision at which the need to foresee counts as a trap.
const FORESIGHT: Commitment = Commitment::Five;
/// The minimum fraction of dead ends, among the states near the win, at which dead ends count as a trap.
const DEAD_ENDS: f64 = 0.03;
/// The minimum number of self-moving sprites next to the route at which the sprites count as a trap.
const MOVERS: usize = 3;
/// The minimum fraction of episodes that greedy players must lose for greed to count as a trap.
const LOSSES: f64 = 0.75;

impl Demand {
    /// Returns which of the four traps the level contains, in this order:
    ///
    /// 1. Planners with a small budget win only with short plans, if at all.
    /// 2. At least 3% of the states near the win are dead ends.
    /// 3. At least three self-moving sprites come next to the route.
    /// 4. Greedy players lose at least three of four episodes.
    pub fn traps(&self) -> [bool; 4] {
        [
            self.commitment <= FORESIGHT,
            self.dead_ends.is_some_and(|found| found.share() >= DEAD_ENDS),
            self.movers >= MOVERS,
            self.deception.share() >= LOSSES,
        ]
    }
}

impl Tier {
    /// All tiers, from lowest to highest.
    pub const ALL: [Tier; 4] = [Tier::One, Tier::Two, Tier::Three, Tier::Four];

    /// Returns the highest tier whose demands are all met.
    pub(super) fn of(demand: &Demand) -> Tier {
        let traps = demand.traps().into_iter().filter(|&there| there).count();
        let met = |bounds: &&TierBounds| demand.decisions >= bounds.decisions && traps >= bounds.traps;
        TIERS.iter().rev().find(met).map_or(Tier::One, |bounds| bounds.tier)
    }

    /// Returns the tier's minimum demands.
    pub fn bounds(self) -> TierBounds {
        TIERS[usize::from(u8::from(self)) - 1]
    }
}

impl From<Tier> for u8 {
    fn from(tier: Tier) -> u8 {
        tier as u8
    }
}

impl TryFrom<u8> for Tier {
    type Error = String;

    fn try_from(number: u8) -> Result<Tier, String> {
        let found = Tier::ALL.into_iter().find(|&tier| u8::from(tier) == number);
        found.ok_or_else(|| format!("there is no tier {number}; tiers range from 1 to 4"))
    }
}

impl fmt::Display for Tier {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", u8::from(*self))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measures::demand::{DeadEnds, Deception};

    fn check(decisions: usize, commitment: Commitment, dead: usize, lost: u64, expect: Tier) {
        let demand = Demand {
            ticks: decisions,
            decisions,
            pushes: 0,
            shortest: true,
            commitment,
            dead_ends: Some(DeadEnds { states: 100, dead, won: 0 }),
            movers: 0,
            deception: Deception { plays: 8, lost, astray: 0.0 },
        };
        assert_eq!(demand.tier(), expect, "{demand:?}");
    }

    #[test]
    fn tiers_rise_with_decisions_and_traps() {
        check(500, Commitment::All, 0, 0, Tier::One);
        check(19, Commitment::None, 9, 8, Tier::One);
        check(50, Commitment::None, 2, 5, Tier::Two);
        check(20, Commitment::All, 0, 6, Tier::Two);
        check(50, Commitment::All, 3, 6, Tier::Three);
        check(50, Commitment::Ten, 0, 5, Tier::One);
        check(119, Commitment::None, 9, 8, Tier::Three);
        check(120, Commitment::Five, 3, 6, Tier::Four);
        check(120, Commitment::Ten, 3, 6, Tier::Three);
    }

    #[test]
    fn tiers_are_numbers_in_data() {
        assert_eq!(TIERS.map(|bounds| bounds.tier), Tier::ALL);
        assert_eq!(Tier::try_from(3), Ok(Tier::Three));
        assert!(Tier::try_from(5).unwrap_err().contains("1 to 4"));
    }
}
