//! The number of actions that a player commits to at each decision.

use std::fmt;
use std::num::NonZeroU64;
use std::str::FromStr;

/// The number of actions that a player commits to at each decision.
///
/// The actions are played one per tick without further decisions. Their effects become visible only at the
/// next decision. The largest commitment with which a player still wins measures how far ahead it plans.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Commitment {
    /// A fixed number of actions. With a commitment of one, the player chooses each action separately.
    Actions(NonZeroU64),
    /// All remaining actions. The episode then consists of a single decision.
    All,
}

impl Commitment {
    /// A single action per decision.
    pub const ONE: Commitment = Commitment::Actions(NonZeroU64::MIN);

    /// Returns `true` if the player commits to one action per decision.
    pub fn is_one(&self) -> bool {
        *self == Commitment::ONE
    }

    /// Returns the number of actions due at a decision when the episode has `left` ticks remaining.
    pub fn due(self, left: u64) -> u64 {
        match self {
            Commitment::Actions(actions) => left.min(actions.get()),
            Commitment::All => left,
        }
    }

    /// Returns `true` if a player with this commitment can play every plan of a player that commits to `longer`, because
    /// it decides whenever that player decides.
    pub(crate) fn divides(self, longer: Commitment) -> bool {
        match (self, longer) {
            (_, Commitment::All) => true,
            (Commitment::All, Commitment::Actions(_)) => false,
            (Commitment::Actions(own), Commitment::Actions(longer)) => longer.get() % own.get() == 0,
        }
    }

    /// Returns the number of actions per decision in the notation used in results, such as `commit=10`, or `None` for
    /// the default.
    pub fn aid(self) -> Option<String> {
        (!self.is_one()).then(|| format!("commit={self}"))
    }
}

impl Default for Commitment {
    fn default() -> Commitment {
        Commitment::ONE
    }
}

impl fmt::Display for Commitment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Commitment::Actions(actions) => actions.fmt(f),
            Commitment::All => f.write_str("all"),
        }
    }
}

impl FromStr for Commitment {
    type Err = String;

    fn from_str(text: &str) -> Result<Commitment, String> {
        match text {
            "all" => Ok(Commitment::All),
            _ => text.parse().map(Commitment::Actions).map_err(|_| {
                format!(
                    "`{text}` isn't a valid number of actions to commit to: use 1 or more, or `all` for the \
                     whole episode"
                )
            }),
        }
    }
}

base::serde_as_text!(Commitment);

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(text: &str, left: u64, due: u64) {
        let commitment: Commitment = text.parse().unwrap();
        assert_eq!((commitment.due(left), commitment.to_string()), (due, text.to_owned()));
        let json = serde_json::to_string(&commitment).unwrap();
        assert_eq!(serde_json::from_str::<Commitment>(&json).unwrap(), commitment);
    }

    #[test]
    fn commitments_end_with_the_episode() {
        check("1", 200, 1);
        check("10", 200, 10);
        check("10", 7, 7);
        check("all", 200, 200);
        assert!("1".parse::<Commitment>().unwrap().is_one());
        for wrong in ["0", "-1", "ten", "", "ALL", "1.5"] {
            assert!(wrong.parse::<Commitment>().is_err(), "{wrong}");
        }
    }
}
