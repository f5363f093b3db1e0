//! The properties that rules can require of nouns.

use std::str::FromStr;
use std::sync::LazyLock;

/// The words for an object's nature or actions, independent of its use in a game.
const WORDS: &[&str] = &[
    "hunts", "marches", "roams", "steals", "timid", "friend", "animal", "person", "eats", "sleeps",
    "tramples", "swims", "flies", "edible", "opens", "valuable", "cuts", "digs", "fuel", "lights",
    "quenches", "explodes", "thrown", "heals", "shields", "lures", "seed", "builds", "calls", "fragile",
    "heavy", "burns", "floats", "bars", "cuttable", "brittle", "living", "machine", "lever", "lamp", "shop",
    "target", "hole", "water", "plate", "soft", "bed", "bridge", "slippery", "sticky", "home", "den", "hot",
    "exit", "thin", "spark", "portable", "hatches", "trace", "reward",
];

/// A set of predicates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Predicates(u64);

impl Predicates {
    /// Returns the predicate that the nouns of all items share.
    pub(crate) fn portable() -> Predicates {
        static PORTABLE: LazyLock<Predicates> =
            LazyLock::new(|| "portable".parse().expect("the word is listed"));
        *PORTABLE
    }

    /// Returns the union of two sets.
    pub(crate) fn with(self, other: Predicates) -> Predicates {
        Predicates(self.0 | other.0)
    }

    /// Returns `true` if this set contains all predicates of the other set.
    pub(crate) fn includes(self, other: Predicates) -> bool {
        self.0 & other.0 == other.0
    }

    /// Returns the words of the predicates, in list order.
    pub(crate) fn words(self) -> impl Iterator<Item = &'static str> {
        WORDS.iter().enumerate().filter(move |(at, _)| self.0 >> at & 1 == 1).map(|(_, word)| *word)
    }
}

impl FromStr for Predicates {
    type Err = String;

    fn from_str(text: &str) -> Result<Predicates, String> {
        let bit = |word: &str| {
            let at = WORDS.iter().position(|other| *other == word);
            at.map(|at| 1 << at).ok_or_else(|| format!("`{word}` is not a predicate"))
        };
        text.split_whitespace().try_fold(0, |all, word| Ok(all | bit(word)?)).map(Predicates)
    }
}
