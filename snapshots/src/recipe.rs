//! A recipe: what a release is minted from, in a TOML file of `seeds/`.

use engine::{Digest, Seed};
use serde::{Deserialize, Serialize};
use validators::{Criteria, CriteriaError};

/// Bytes of a recipe that are read.
pub const MAX_RECIPE: usize = 1 << 16;

/// Everything that decides the bytes of a release.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Recipe {
    /// Name of the release: lower-case letters, digits, `-`.
    pub name: String,
    /// What the release is, for its README.
    pub description: String,
    /// The text that the seed comes from; public, so the release is open.
    pub seed: String,
    /// Root digest of the release before.
    #[serde(default)]
    pub parent: Option<Digest>,
    /// New levels for corpus games.
    #[serde(default)]
    pub corpus: Part,
    /// New games with levels.
    #[serde(default)]
    pub generated: Part,
    /// How large the boards are.
    #[serde(default)]
    pub board: Board,
    /// What a level must show.
    #[serde(default)]
    pub criteria: Criteria,
}

/// How much of one kind a release holds, and how hard the mint tries.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Part {
    /// Games.
    pub games: u32,
    /// Levels of each game, from the easiest to the hardest.
    pub levels: u32,
    /// Games that are tried for one place, at most.
    pub game_tries: u32,
    /// Levels that are tried for one place, at most.
    pub level_tries: u32,
}

impl Default for Part {
    fn default() -> Part {
        Part { games: 0, levels: 3, game_tries: 20, level_tries: 12 }
    }
}

/// The sizes that boards are drawn from, in cells, both ends included.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Board {
    /// Columns.
    pub columns: (usize, usize),
    /// Rows.
    pub rows: (usize, usize),
}

impl Default for Board {
    fn default() -> Board {
        Board { columns: (10, 16), rows: (8, 11) }
    }
}

/// What is wrong with a recipe.
#[derive(Debug, thiserror::Error)]
pub enum RecipeError {
    /// Not TOML, or not of this shape. The message names line, column and key.
    #[error("{0}")]
    Syntax(Box<toml::de::Error>),
    /// A value out of its range.
    #[error("`{key}` {message}")]
    Value {
        /// The key, dotted.
        key: &'static str,
        /// What it must be.
        message: String,
    },
    /// A criterion out of its range.
    #[error("`criteria.{}` {}", .0.key, .0.message)]
    Criteria(#[from] CriteriaError),
    /// Longer than [`MAX_RECIPE`].
    #[error("the recipe is larger than {MAX_RECIPE} bytes")]
    TooLarge,
}

impl Recipe {
    /// Reads and checks a recipe.
    ///
    /// # Errors
    /// The first thing that is wrong, with its place or key.
    pub fn from_toml(text: &str) -> Result<Recipe, RecipeError> {
        if text.len() > MAX_RECIPE {
            return Err(RecipeError::TooLarge);
        }
        let recipe: Recipe = toml::from_str(text).map_err(|error| RecipeError::Syntax(Box::new(error)))?;
        recipe.check()?;
        Ok(recipe)
    }

    /// Checks the values.
    ///
    /// # Errors
    /// The first value that is out of its range.
    pub fn check(&self) -> Result<(), RecipeError> {
        let wrong = |key, message: String| Err(RecipeError::Value { key, message });
        let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
        if self.name.is_empty() || self.name.len() > 40 || !self.name.chars().all(plain) {
            return wrong("name", "takes 1 to 40 lower-case letters, digits and `-`".to_owned());
        }
        if self.seed.trim().is_empty() || self.seed.len() > 200 {
            return wrong("seed", "takes a text of 1 to 200 bytes".to_owned());
        }
        if self.corpus.games + self.generated.games == 0 {
            return wrong(
                "generated.games",
                "and `corpus.games` are both 0: there is nothing to mint".to_owned(),
            );
        }
        for (part, [games, levels, game_tries, level_tries]) in [
            (&self.corpus, ["corpus.games", "corpus.levels", "corpus.game_tries", "corpus.level_tries"]),
            (
                &self.generated,
                ["generated.games", "generated.levels", "generated.game_tries", "generated.level_tries"],
            ),
        ] {
            for (key, value, least, most) in [
                (games, part.games, 0, 10_000),
                (levels, part.levels, 1, 20),
                (game_tries, part.game_tries, 1, 10_000),
                (level_tries, part.level_tries, 1, 10_000),
            ] {
                if !(least..=most).contains(&value) {
                    return wrong(key, format!("is {value}; it takes {least} to {most}"));
                }
            }
        }
        for (key, (least, most)) in [("board.columns", self.board.columns), ("board.rows", self.board.rows)] {
            if least < 5 || most < least || most > 100 {
                return wrong(
                    key,
                    format!("is [{least}, {most}]; it takes two numbers from 5 to 100, the smaller first"),
                );
            }
        }
        self.criteria.check()?;
        // What the cards show.
        if let Some(missing) =
            ["not-idle", "not-random", "winnable"].into_iter().find(|name| !self.criteria.asks(name))
        {
            return wrong("criteria.ask", format!("lacks `{missing}`, which every card shows"));
        }
        Ok(())
    }

    /// The seed that everything in the release comes from.
    pub fn root_seed(&self) -> Seed {
        Seed::from_text(&self.seed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = "name = 'small'\ndescription = 'a test'\nseed = 'x'\n[generated]\ngames = 2\n";

    fn check(text: &str, expect: &str) {
        let error = Recipe::from_toml(text).unwrap_err().to_string();
        assert!(error.contains(expect), "{error}");
    }

    /// The page's example is a recipe, and shows the defaults.
    #[test]
    fn the_example_in_the_docs() {
        let page = include_str!("../../docs/recipes.md");
        let example = page.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
        let recipe = Recipe::from_toml(&example.replace("parent = \"…\"", "#")).unwrap();
        assert_eq!(recipe.criteria, Criteria::default());
        assert_eq!(recipe.board, Board::default());
        assert_eq!(recipe.generated, Part { games: 12, ..Part::default() });
        assert_eq!(recipe.corpus, Part { games: 6, ..Part::default() });
    }

    #[test]
    fn recipes_and_their_problems() {
        assert_eq!(Recipe::from_toml(GOOD).unwrap().generated.levels, 3);
        check(&GOOD.replace("games", "gamse"), "unknown field `gamse`");
        check(&GOOD.replace("'x'", "7"), "invalid type");
        check(&GOOD.replace("small", "Small One"), "`name`");
        check(&GOOD.replace("= 2", "= 0"), "nothing to mint");
        check(&format!("{GOOD}levels = 0"), "`generated.levels` is 0");
        check(&format!("{GOOD}[criteria]\ndepths = []"), "`criteria.depths`");
        check(&format!("{GOOD}[criteria]\nask = ['winnable']"), "lacks `not-idle`");
        check(&format!("{GOOD}[criteria]\nask = ['winable']"), "did you mean `winnable`?");
        check(&format!("{GOOD}[board]\ncolumns = [9, 4]"), "`board.columns`");
        check("name = ", "expected");
        check(&"#".repeat(MAX_RECIPE + 1), "larger than");
    }
}
