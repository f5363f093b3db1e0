//! The parts of a recipe that ask for tiers: shares of levels by what they demand, and puzzles that are made to them, of
//! pushed things, of locks, of yards or of strays.

use crate::recipe::error::{RecipeError, wrong};
use generators::games::{LockRules, PushRules, YardRules};
use serde::{Deserialize, Serialize};

/// The minimum side of a puzzle.
const LEAST_SIDE: usize = 8;

/// The parts of a section that depend on the kind of the puzzles: its keys, the number of different rules, and the maximum
/// number of cells of a board.
pub(crate) struct PuzzleSection {
    keys: [&'static str; 6],
    rules: usize,
    cells: usize,
    thing_key: &'static str,
    /// The most things to push.
    things: u32,
}

macro_rules! keys {
    ($section:literal) => {
        [
            concat!($section, ".games"),
            concat!($section, ".levels"),
            concat!($section, ".level_tries"),
            concat!($section, ".candidates"),
            concat!($section, ".columns"),
            concat!($section, ".rows"),
        ]
    };
}

impl PuzzleSection {
    /// Puzzles of pushed things.
    pub(crate) const PUZZLES: PuzzleSection = PuzzleSection {
        keys: keys!("puzzles"),
        rules: PushRules::ALL.len(),
        cells: 128,
        thing_key: "puzzles.things",
        things: 5,
    };
    /// Puzzles of locks.
    pub(crate) const LOCKS: PuzzleSection = PuzzleSection {
        keys: keys!("locks"),
        rules: LockRules::ALL.len(),
        cells: 256,
        thing_key: "locks.things",
        things: 3,
    };
    /// Puzzles of yards.
    pub(crate) const YARDS: PuzzleSection = PuzzleSection {
        keys: keys!("yards"),
        rules: YardRules::ALL.len(),
        cells: 196,
        thing_key: "yards.things",
        things: 3,
    };
    /// Puzzles of pushed things among strays.
    pub(crate) const STRAYS: PuzzleSection = PuzzleSection {
        keys: keys!("strays"),
        rules: PushRules::AMONG_STRAYS.len(),
        cells: 132,
        thing_key: "strays.things",
        things: 3,
    };
}

base::with_defaults! {
    /// New puzzles: games that are won by pushing things, with levels made backwards from their solutions to the tiers
    /// of the recipe; or, in sections of their own, games of locks, of yards and of strays.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct PuzzlePart {
        /// The number of games.
        pub games: u32 = 0,
        /// The number of levels of each game.
        pub levels: u32 = 3,
        /// The maximum number of levels that are tried for one place.
        pub level_tries: u32 = 3,
        /// The number of candidate games per selected game.
        pub candidates: f64 = 1.25,
        /// The number of things to push in tiers 3 and 4: 3 to 5. For `[puzzles]` only.
        pub things: u32 = 3,
        /// The minimum and maximum number of columns.
        pub columns: (usize, usize) = (10, 11),
        /// The minimum and maximum number of rows.
        pub rows: (usize, usize) = (10, 11),
    }
}

/// Shares of levels by tier.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Tiers {
    /// The share of tier 1.
    #[serde(rename = "1", skip_serializing_if = "is_zero")]
    pub one: f64,
    /// The share of tier 2.
    #[serde(rename = "2", skip_serializing_if = "is_zero")]
    pub two: f64,
    /// The share of tier 3.
    #[serde(rename = "3", skip_serializing_if = "is_zero")]
    pub three: f64,
    /// The share of tier 4.
    #[serde(rename = "4", skip_serializing_if = "is_zero")]
    pub four: f64,
}

fn is_zero(share: &f64) -> bool {
    *share == 0.0
}

impl Tiers {
    /// Returns `true` if no tier is asked for.
    pub fn is_empty(&self) -> bool {
        *self == Tiers::default()
    }

    /// Checks that the shares add up.
    ///
    /// # Errors
    /// They do not.
    pub(crate) fn check(&self) -> Result<(), RecipeError> {
        let total: f64 = self.shares().iter().sum();
        let are_shares = self.shares().iter().all(|share| (0.0..=1.0).contains(share));
        if self.is_empty() || are_shares && (total - 1.0).abs() < 1e-6 {
            return Ok(());
        }
        wrong("tiers", format!("adds up to {total}; it takes shares that add up to 1"))
    }

    /// The shares, from tier 1 to tier 4.
    pub fn shares(&self) -> [f64; 4] {
        [self.one, self.two, self.three, self.four]
    }
}

impl PuzzlePart {
    /// Checks the values.
    ///
    /// # Errors
    /// The first value that is out of its range; no tier is asked for.
    pub(crate) fn check(&self, section: &PuzzleSection, tiers: &Tiers) -> Result<(), RecipeError> {
        let [games, levels, level_tries, candidates, columns, rows] = section.keys;
        for (key, value, most) in [
            (games, self.games, section.rules as u32),
            (levels, self.levels, 20),
            (level_tries, self.level_tries, 100),
        ] {
            if !(1..=most).contains(&value) {
                return wrong(key, format!("is {value}; it takes 1 to {most}"));
            }
        }
        if !(1.0..=20.0).contains(&self.candidates) {
            return wrong(candidates, format!("is {}; it takes 1 to 20 for each game", self.candidates));
        }
        if !(3..=section.things).contains(&self.things) {
            let help = match section.things {
                3 => "is for `[puzzles]` only: omit it".to_owned(),
                most => format!("is {}; it takes 3 to {most}", self.things),
            };
            return wrong(section.thing_key, help);
        }
        let cells = section.cells;
        for (key, (least, most)) in [(columns, self.columns), (rows, self.rows)] {
            if least < LEAST_SIDE || most < least || self.columns.1.saturating_mul(self.rows.1) > cells {
                let help =
                    format!("takes two numbers from 8, the smaller first; a board has at most {cells} cells");
                return wrong(key, help);
            }
        }
        if tiers.is_empty() {
            return wrong(games, "needs `tiers`, the shares of levels that are made to each");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use crate::recipe::Recipe;
    use crate::recipe::tests::{GOOD, check};

    #[test]
    fn puzzles_are_made_to_tiers() {
        let puzzles = "name = 'small'\ndescription = 'a test'\nseed = 'x'\n[puzzles]\ngames = 2\n";
        check(puzzles, "`puzzles.games` needs `tiers`");
        check(&format!("{puzzles}[tiers]\n4 = 0.5"), "adds up to 0.5");
        check(&format!("{puzzles}[tiers]\n5 = 1.0"), "unknown field `5`");
        check(&format!("{puzzles}columns = [10, 16]\n[tiers]\n4 = 1.0"), "at most 128 cells");
        let endless = "columns = [8, 4294967296]\nrows = [8, 4294967296]\n[tiers]\n4 = 1.0";
        check(&format!("{puzzles}{endless}"), "at most 128 cells");
        check(&format!("{}[tiers]\n4 = 1.0", puzzles.replace("= 2", "= 17")), "it takes 1 to 15");
        let locks = format!("{}[tiers]\n4 = 1.0", puzzles.replace("[puzzles]", "[locks]"));
        check(&locks.replace("games = 2", "games = 2\nthings = 4"), "`locks.things` is for `[puzzles]` only");
        check(&format!("{puzzles}things = 6\n[tiers]\n4 = 1.0"), "`puzzles.things` is 6; it takes 3 to 5");
        check(&locks.replace("= 2", "= 5"), "`locks.games` is 5; it takes 1 to 3");
        check(
            &locks.replace("games = 2", "games = 2\nrows = [16, 17]\ncolumns = [16, 16]"),
            "at most 256 cells",
        );
        assert_eq!(Recipe::from_toml(&locks).unwrap().games(), 2);
        let yards = locks.replace("[locks]", "[yards]");
        check(&yards.replace("= 2", "= 5"), "`yards.games` is 5; it takes 1 to 2");
        check(
            &yards.replace("games = 2", "games = 2\nrows = [14, 15]\ncolumns = [14, 14]"),
            "at most 196 cells",
        );
        let strays = locks.replace("[locks]", "[strays]");
        check(&strays.replace("= 2", "= 12"), "`strays.games` is 12; it takes 1 to 10");
        let recipe = Recipe::from_toml(&format!("{puzzles}[tiers]\n3 = 0.5\n4 = 0.5")).unwrap();
        assert_eq!((recipe.games(), recipe.levels(), recipe.tiers.shares()), (2, 6, [0.0, 0.0, 0.5, 0.5]));
        // Recipes that ask for neither keep their bytes.
        let plain = serde_json::to_value(Recipe::from_toml(GOOD).unwrap()).unwrap();
        assert!(["tiers", "puzzles", "locks", "yards", "strays"].iter().all(|key| plain.get(key).is_none()));
    }
}
