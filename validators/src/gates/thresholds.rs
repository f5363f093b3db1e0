//! The gates' thresholds.

use serde::{Deserialize, Serialize};

base::with_defaults! {
    /// The gates' thresholds, which are the `[criteria.gates]` table of a recipe. `docs/reference/gates.md` gives the
    /// source of each threshold.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct Gates {
        /// `open-ground`: the maximum fraction of ground cells that no 2 × 2 square of ground contains, as a mean over
        /// the levels.
        pub narrow: f64 = 0.45,
        /// `not-instant`: the minimum length, in ticks, of the shortest known win on every level except the first.
        pub least_win: usize = 25,
        /// `not-instant`: the minimum length of the shortest known win, in periods of the level's slowest spawner.
        pub spawn_periods: f64 = 1.5,
        /// `not-instant`: the number of episodes that the nearest-goal player plays per level.
        pub bot_plays: u32 = 4,
        /// `not-instant`: the maximum fraction of its episodes that the nearest-goal player may win.
        pub bot_wins: f64 = 0.5,
        /// `not-instant`: the maximum fraction of the levels after the first that may be exceptions.
        pub instant_levels: f64 = 0.25,
        /// `not-instant`: the minimum and maximum time limit, as a multiple of the longest known win.
        pub time_limit: (f64, f64) = (1.2, 6.5),
        /// `no-dead-time`: the maximum length of a stretch without progress, as a fraction of the win.
        pub dead_share: f64 = 0.25,
        /// `no-dead-time`: the number of ticks that a stretch without progress may always take.
        pub dead_ticks: usize = 12,
        /// `drama`: the minimum drama of the game.
        pub drama: f64 = 0.12,
        /// `progression`: the minimum number of levels that need mechanics that no earlier level needed.
        pub growth: usize = 1,
        /// `progression`: the minimum fraction of all mechanics that the last level needs.
        pub last_share: f64 = 0.5,
        /// `progression`: the maximum amount by which the last level may be easier than each of the first two.
        pub easier: f64 = 0.2,
        /// `actors-matter`: the minimum mean number of cells swept by a sprite that moves by itself.
        pub sweep: f64 = 5.0,
        /// `actors-matter`: the minimum fraction of levels with self-moving sprites on which these sprites come next to
        /// the player.
        pub met_levels: f64 = 0.5,
        /// `actors-matter`: the minimum fraction of careless players' losses (see `careless_plays`) that must be caused
        /// by deadly sprites.
        pub foe_losses: f64 = 0.1,
        /// `tight`: the minimum and maximum fraction of the consumables that a win may leave, as a mean over the
        /// levels.
        pub spare: (f64, f64) = (0.0, 0.5),
        /// `tight`, `progression`, `actors-matter`, `necessity`: the number of episodes of careless players per level.
        /// They head for the nearest goal, but press a random key in some ticks.
        pub careless_plays: u32 = 8,
        /// The fraction of ticks in which a careless player (see `careless_plays`) presses a random key.
        pub careless_slips: f64 = 0.25,
        /// `tight`: the maximum fraction of their episodes that careless players (see `careless_plays`) may win.
        pub careless_wins: f64 = 0.5,
        /// `necessity`: the minimum relative change in the length of a win at which an element matters. An element also
        /// matters if at least this fraction of careless players' episodes (see `careless_plays`) end differently.
        pub plan_change: f64 = 0.15,
        /// `necessity`: the minimum fraction of levels on which a rule or type must matter in order to count, among the
        /// levels on which it occurs.
        pub needed_levels: f64 = 0.5,
        /// `necessity`: the minimum fraction of the rules and types that must matter.
        pub needed_share: f64 = 0.55,
        /// `necessity`: the number of forward-model calls per level in a search without a rule or type.
        pub needed_calls: u64 = 10_000,
    }
}

impl Gates {
    /// Returns `true` for the default thresholds, which files can omit.
    pub(crate) fn are_default(&self) -> bool {
        *self == Gates::default()
    }

    /// Returns stricter thresholds for the measures that involve randomness, so that games that pass them also pass the
    /// original thresholds with other seeds.
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

    /// Returns laxer thresholds for a subset of a game's levels. They require no new mechanics and only half of the
    /// drama.
    #[must_use]
    pub fn for_some_levels(&self) -> Gates {
        Gates { growth: 0, drama: self.drama / 2.0, ..self.clone() }
    }

    /// Returns the key of the first value that is out of range, and the reason; `None` if all values are valid.
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
        let share =
            share.map(|(key, share)| (key, format!("is {share}; the value must be a fraction from 0 to 1")));
        let factors = [
            ("gates.spawn_periods", self.spawn_periods),
            ("gates.time_limit", self.time_limit.0),
            ("gates.time_limit", self.time_limit.1),
            ("gates.sweep", self.sweep),
        ];
        let factor = factors.into_iter().find(|(_, factor)| !(0.0..=1000.0).contains(factor));
        let factor =
            factor.map(|(key, factor)| (key, format!("is {factor}; the value must be from 0 to 1000")));
        let counts = [
            ("gates.bot_plays", u64::from(self.bot_plays), 1000),
            ("gates.careless_plays", u64::from(self.careless_plays), 1000),
            ("gates.needed_calls", self.needed_calls, 1_000_000_000),
        ];
        let count = counts.into_iter().find(|(_, count, most)| *count == 0 || count > most);
        let count =
            count.map(|(key, count, most)| (key, format!("is {count}; the value must be from 1 to {most}")));
        let pairs = [("gates.time_limit", self.time_limit), ("gates.spare", self.spare)];
        let pair = pairs.into_iter().find(|(_, (least, most))| least > most);
        let pair = pair
            .map(|(key, (least, most))| (key, format!("has the minimum {least} above the maximum {most}")));
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
