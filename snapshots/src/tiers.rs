//! The parts of a recipe that ask for tiers: shares of levels by what they demand, and puzzles that are made to them.

use crate::recipe::{RecipeError, wrong};
use generators::games::PushRules;
use serde::{Deserialize, Serialize};

/// The minimum side of a puzzle, and the maximum number of its cells.
const LEAST_SIDE: usize = 8;
const MOST_CELLS: usize = 128;

engine::with_defaults! {
    /// New puzzles: games that are won by pushing things, with levels made backwards from their solutions to the tiers
    /// of the recipe.
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
    pub(crate) fn check(&self, tiers: &Tiers) -> Result<(), RecipeError> {
        let known = PushRules::ALL.len() as u32;
        for (key, value, most) in [
            ("puzzles.games", self.games, known),
            ("puzzles.levels", self.levels, 20),
            ("puzzles.level_tries", self.level_tries, 100),
        ] {
            if !(1..=most).contains(&value) {
                return wrong(key, format!("is {value}; it takes 1 to {most}"));
            }
        }
        if !(1.0..=20.0).contains(&self.candidates) {
            return wrong(
                "puzzles.candidates",
                format!("is {}; it takes 1 to 20 for each game", self.candidates),
            );
        }
        for (key, (least, most)) in [("puzzles.columns", self.columns), ("puzzles.rows", self.rows)] {
            if least < LEAST_SIDE || most < least || self.columns.1.saturating_mul(self.rows.1) > MOST_CELLS {
                let help = "takes two numbers from 8, the smaller first; a board has at most 128 cells";
                return wrong(key, help);
            }
        }
        if tiers.is_empty() {
            return wrong("puzzles", "needs `tiers`, the shares of levels that are made to each");
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
        check(puzzles, "`puzzles` needs `tiers`");
        check(&format!("{puzzles}[tiers]\n4 = 0.5"), "adds up to 0.5");
        check(&format!("{puzzles}[tiers]\n5 = 1.0"), "unknown field `5`");
        check(&format!("{puzzles}columns = [10, 16]\n[tiers]\n4 = 1.0"), "at most 128 cells");
        let endless = "columns = [8, 4294967296]\nrows = [8, 4294967296]\n[tiers]\n4 = 1.0";
        check(&format!("{puzzles}{endless}"), "at most 128 cells");
        check(&format!("{}[tiers]\n4 = 1.0", puzzles.replace("= 2", "= 17")), "it takes 1 to 15");
        let recipe = Recipe::from_toml(&format!("{puzzles}[tiers]\n3 = 0.5\n4 = 0.5")).unwrap();
        assert_eq!((recipe.games(), recipe.levels(), recipe.tiers.shares()), (2, 6, [0.0, 0.0, 0.5, 0.5]));
        // Recipes that ask for neither keep their bytes.
        let plain = serde_json::to_value(Recipe::from_toml(GOOD).unwrap()).unwrap();
        assert!(plain.get("tiers").is_none() && plain.get("puzzles").is_none());
    }
}
