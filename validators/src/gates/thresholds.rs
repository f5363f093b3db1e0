//! The thresholds of the gates.

use serde::{Deserialize, Serialize};

base::with_defaults! {
    /// The thresholds of the gates: the `[criteria.gates]` table of a recipe. The page `docs/reference/gates.md` gives the source of each.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct Gates {
        /// `open-ground`: the share of the ground that may be narrow, on average over the levels.
        pub narrow: f64 = 0.45,
        /// `not-instant`: ticks that the shortest known win of a level after the first takes at least.
        pub least_win: usize = 25,
        /// `not-instant`: periods of the slowest spawner on the level that it takes at least.
        pub spawn_periods: f64 = 1.5,
        /// `not-instant`: plays of the nearest-goal player on a level.
        pub bot_plays: u32 = 4,
        /// `not-instant`: the greatest share of them that it may win.
        pub bot_wins: f64 = 0.5,
        /// `not-instant`: the share of the levels after the first that may be an exception, at most.
        pub instant_levels: f64 = 0.25,
        /// `not-instant`: the time limit as a multiple of the longest known win, at least and at most.
        pub time_limit: (f64, f64) = (1.2, 6.5),
        /// `no-dead-time`: the longest stretch without progress, as a share of the win, at most …
        pub dead_share: f64 = 0.25,
        /// … and the ticks that such a stretch may take in any case.
        pub dead_ticks: usize = 12,
        /// `drama`: the drama of the game at least.
        pub drama: f64 = 0.12,
        /// `progression`: how often a level brings mechanics that no earlier one needed, at least.
        pub growth: usize = 1,
        /// `progression`: the share of all mechanics that the last level needs at least.
        pub last_share: f64 = 0.5,
        /// `progression`: by how much the last level may be easier than each of the first two.
        pub easier: f64 = 0.2,
        /// `actors-matter`: cells that a sprite that moves by itself sweeps on average, at least.
        pub sweep: f64 = 5.0,
        /// `actors-matter`: the share of the levels with such sprites on which they come next to the player, at least.
        pub met_levels: f64 = 0.5,
        /// `actors-matter`: the share of the losses of careless players that deadly foes cause, at least.
        pub foe_losses: f64 = 0.1,
        /// `tight`: the share of the consumables that a win leaves on average, at least and at most.
        pub spare: (f64, f64) = (0.0, 0.5),
        /// `tight`, `progression`, `actors-matter`, `necessity`: plays of careless players on a level.
        pub careless_plays: u32 = 8,
        /// The share of the ticks in which a careless player presses a random key.
        pub careless_slips: f64 = 0.25,
        /// `tight`: the greatest share of careless plays that may be won.
        pub careless_wins: f64 = 0.5,
        /// `necessity`: the change in the length of a win, or in the share of careless plays that end otherwise, that counts.
        pub plan_change: f64 = 0.15,
        /// `necessity`: the share of the levels of a rule or type on which it has to matter.
        pub needed_levels: f64 = 0.5,
        /// `necessity`: the share of the rules and types that has to matter.
        pub needed_share: f64 = 0.55,
        /// `necessity`: forward-model calls of a search without a rule or type on one level.
        pub needed_calls: u64 = 10_000,
    }
}

impl Gates {
    /// Returns `true` for the default thresholds, which files need not say.
    pub(crate) fn are_default(&self) -> bool {
        *self == Gates::default()
    }

    /// Stricter thresholds for what chance has a say in: who makes games by these makes games that other dice confirm by the
    /// thresholds as they are.
    #[must_use]
    pub fn with_margin(&self) -> Gates {
        Gates {
            drama: (1.2 * self.drama).min(1.0),
            easier: 0.5 * self.easier,
            foe_losses: (2.0 * self.foe_losses).min(1.0),
            careless_wins: 0.8 * self.careless_wins,
            needed_share: (self.needed_share + 0.05).min(1.0),
            ..self.clone()
        }
    }

    /// Laxer thresholds for some of the levels of a game: they need not bring new mechanics, and half the drama will do.
    #[must_use]
    pub fn for_some_levels(&self) -> Gates {
        Gates { growth: 0, drama: self.drama / 2.0, ..self.clone() }
    }

    /// Returns the first value that is out of its range: its key and the reason.
    pub(crate) fn problem(&self) -> Option<(&'static str, String)> {
        let shares = [
            ("gates.narrow", self.narrow),
            ("gates.bot_wins", self.bot_wins),
            ("gates.instant_levels", self.instant_levels),
            ("gates.dead_share", self.dead_share),
            ("gates.drama", self.drama),
            ("gates.last_share", self.last_share),
            ("gates.easier", self.easier),
            ("gates.met_levels", self.met_levels),
            ("gates.foe_losses", self.foe_losses),
            ("gates.spare", self.spare.0),
            ("gates.spare", self.spare.1),
            ("gates.careless_slips", self.careless_slips),
            ("gates.careless_wins", self.careless_wins),
            ("gates.plan_change", self.plan_change),
            ("gates.needed_levels", self.needed_levels),
            ("gates.needed_share", self.needed_share),
        ];
        let share = shares.into_iter().find(|(_, share)| !(0.0..=1.0).contains(share));
        let share = share.map(|(key, share)| (key, format!("is {share}; it takes a share from 0 to 1")));
        let factors = [
            ("gates.spawn_periods", self.spawn_periods),
            ("gates.time_limit", self.time_limit.0),
            ("gates.time_limit", self.time_limit.1),
            ("gates.sweep", self.sweep),
        ];
        let factor = factors.into_iter().find(|(_, factor)| !(0.0..=1000.0).contains(factor));
        let factor =
            factor.map(|(key, factor)| (key, format!("is {factor}; it takes a number from 0 to 1000")));
        let counts = [
            ("gates.bot_plays", u64::from(self.bot_plays), 1000),
            ("gates.careless_plays", u64::from(self.careless_plays), 1000),
            ("gates.needed_calls", self.needed_calls, 1_000_000_000),
        ];
        let count = counts.into_iter().find(|(_, count, most)| *count == 0 || count > most);
        let count = count.map(|(key, count, most)| (key, format!("is {count}; it takes 1 to {most}")));
        let pairs = [("gates.time_limit", self.time_limit), ("gates.spare", self.spare)];
        let pair = pairs.into_iter().find(|(_, (least, most))| least > most);
        let pair = pair.map(|(key, (least, most))| (key, format!("has {least} above {most}")));
        share.or(factor).or(count).or(pair)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_margin_is_stricter_and_in_range() {
        for share in [0.0, 0.12, 0.5, 0.97, 1.0] {
            let gates = Gates {
                drama: share,
                easier: share,
                foe_losses: share,
                careless_wins: share,
                needed_share: share,
                ..Gates::default()
            };
            let strict = gates.with_margin();
            assert!(strict.drama >= gates.drama && strict.foe_losses >= gates.foe_losses, "{share}");
            assert!(strict.easier <= gates.easier && strict.careless_wins <= gates.careless_wins, "{share}");
            assert!(strict.needed_share >= gates.needed_share && strict.problem().is_none(), "{share}");
        }
        assert_ne!(Gates::default().with_margin(), Gates::default());
    }
}
