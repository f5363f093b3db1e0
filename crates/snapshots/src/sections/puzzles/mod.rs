//! The puzzle sections of recipes: pushing (`[puzzles]`), locks (`[locks]`), carrying parcels among carts (`[yards]`),
//! and pushing among wandering deadly sprites (`[strays]`). Levels are constructed backwards from their solutions, so
//! that they meet the recipe's tiers.

mod make;
mod section;

pub(crate) use make::{Request, make};

use crate::recipe::error::{RecipeError, wrong};
use crate::sections::tiers::Tiers;
use engine::Game;
use generators::games::{LockRules, PushRules, YardRules};
use serde::{Deserialize, Serialize};
use validators::novelty::GameForm;

/// The minimum side length of a puzzle board, in cells.
const LEAST_SIDE: usize = 8;

/// The properties in which the kinds of puzzles differ.
struct Facts {
    /// The name used in job names and seed steps.
    name: &'static str,
    /// The noun for a game of this kind.
    noun: &'static str,
    /// The section's name.
    section: &'static str,
    /// The section's keys.
    keys: [&'static str; 7],
    /// The number of rule sets. No two of them are near-duplicates.
    rules: usize,
    /// The maximum number of cells per board.
    cells: usize,
    /// The maximum number of pushable objects per board.
    things: u32,
    /// The cost per requested level in core seconds, measured with `frontier` up to the highest tiers.
    seconds: f64,
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
            concat!($section, ".things"),
        ]
    };
}

base::with_defaults! {
    /// New puzzles, which are won by pushing things. Levels are constructed backwards from their solutions, so that
    /// they meet the recipe's tiers. The sections of locks, yards and strays use the same fields.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct PuzzlePart {
        /// The number of games.
        pub games: u32 = 0,
        /// The number of levels per game.
        pub levels: u32 = 3,
        /// The maximum number of attempts to make each level.
        pub level_tries: u32 = 3,
        /// The number of candidate games per selected game.
        pub candidates: f64 = 1.25,
        /// The number of things to push in tiers 3 and 4, from 3 to 5. Only `[puzzles]` uses this field.
        pub things: u32 = 3,
        /// The minimum and maximum number of columns.
        pub columns: (usize, usize) = (10, 11),
        /// The minimum and maximum number of rows.
        pub rows: (usize, usize) = (10, 11),
    }
}

/// A kind of puzzle, with its own section in recipes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum PuzzleKind {
    /// Puzzles about pushing objects.
    Pushing,
    /// Puzzles in which doors use up keys.
    Locks,
    /// Puzzles in which the player carries parcels between carts.
    Yards,
    /// Puzzles about pushing objects among strays, which are deadly sprites that wander at random.
    Strays,
}

impl PuzzleKind {
    /// All kinds, in job order.
    pub const ALL: [PuzzleKind; 4] =
        [PuzzleKind::Pushing, PuzzleKind::Locks, PuzzleKind::Yards, PuzzleKind::Strays];

    fn facts(self) -> Facts {
        match self {
            PuzzleKind::Pushing => Facts {
                name: "puzzle",
                noun: "new puzzle",
                section: "puzzles",
                keys: keys!("puzzles"),
                rules: PushRules::ALL.len(),
                cells: 128,
                things: 5,
                seconds: 24.0,
            },
            PuzzleKind::Locks => Facts {
                name: "locks",
                noun: "new lock puzzle",
                section: "locks",
                keys: keys!("locks"),
                rules: LockRules::ALL.len(),
                cells: 256,
                things: 3,
                seconds: 14.0,
            },
            PuzzleKind::Yards => Facts {
                name: "yards",
                noun: "new yard",
                section: "yards",
                keys: keys!("yards"),
                rules: YardRules::ALL.len(),
                cells: 196,
                things: 3,
                seconds: 17.0,
            },
            PuzzleKind::Strays => Facts {
                name: "strays",
                noun: "new stray puzzle",
                section: "strays",
                keys: keys!("strays"),
                rules: PushRules::AMONG_STRAYS.len(),
                cells: 132,
                things: 3,
                seconds: 4.0,
            },
        }
    }

    /// Returns the kind's name in job names and seed steps.
    pub(crate) fn name(self) -> &'static str {
        self.facts().name
    }

    /// Returns the noun for a game of this kind, such as `new yard`.
    pub fn noun(self) -> &'static str {
        self.facts().noun
    }

    /// Returns the name of the kind's section in recipes.
    pub(crate) fn section(self) -> &'static str {
        self.facts().section
    }

    /// Returns the number of rule sets. No two of them are near-duplicates.
    pub(crate) fn rules(self) -> usize {
        self.facts().rules
    }

    /// Returns the cost per requested level in core seconds, measured with `frontier` up to the highest
    /// tiers.
    pub(crate) fn seconds(self) -> f64 {
        self.facts().seconds
    }

    /// Returns a rule set without a theme, with its name.
    fn plain(self, at: usize) -> (Game, String) {
        match self {
            PuzzleKind::Pushing => (PushRules::ALL[at].game(), PushRules::ALL[at].name()),
            PuzzleKind::Locks => (LockRules::ALL[at].game(), LockRules::ALL[at].name()),
            PuzzleKind::Yards => (YardRules::ALL[at].game(), YardRules::ALL[at].name()),
            PuzzleKind::Strays => (PushRules::AMONG_STRAYS[at].game(), PushRules::AMONG_STRAYS[at].name()),
        }
    }

    /// Returns the form of a rule set.
    pub(crate) fn form(self, at: usize) -> GameForm {
        GameForm::of(&self.plain(at).0)
    }

    /// Checks the values of this kind's section.
    ///
    /// # Errors
    /// Returns an error for the first value that is out of range, or if the recipe requests no tiers.
    pub(crate) fn check(self, part: &PuzzlePart, tiers: &Tiers) -> Result<(), RecipeError> {
        let Facts { keys, rules, cells, things: most_things, .. } = self.facts();
        let [games, levels, level_tries, candidates, columns, rows, things] = keys;
        for (key, value, most) in [
            (games, part.games, rules as u32),
            (levels, part.levels, 20),
            (level_tries, part.level_tries, 100),
        ] {
            if !(1..=most).contains(&value) {
                return wrong(key, format!("is {value}; the value must be from 1 to {most}"));
            }
        }
        if !(1.0..=20.0).contains(&part.candidates) {
            return wrong(
                candidates,
                format!("is {}; the value must be from 1 to 20 for each game", part.candidates),
            );
        }
        if !(3..=most_things).contains(&part.things) {
            let help = match most_things {
                3 => "applies only to `[puzzles]`: omit it".to_owned(),
                most => format!("is {}; the value must be from 3 to {most}", part.things),
            };
            return wrong(things, help);
        }
        for (key, (least, most)) in [(columns, part.columns), (rows, part.rows)] {
            if least < LEAST_SIDE || most < least || part.columns.1.saturating_mul(part.rows.1) > cells {
                let help = format!(
                    "takes two numbers, each at least 8, in ascending order; a board has at most {cells} cells"
                );
                return wrong(key, help);
            }
        }
        if tiers.is_empty() {
            return wrong(games, "needs `tiers`, the fractions of levels of each tier");
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
        check(
            &format!("{}[tiers]\n4 = 1.0", puzzles.replace("= 2", "= 17")),
            "the value must be from 1 to 15",
        );
        let locks = format!("{}[tiers]\n4 = 1.0", puzzles.replace("[puzzles]", "[locks]"));
        check(
            &locks.replace("games = 2", "games = 2\nthings = 4"),
            "`locks.things` applies only to `[puzzles]`",
        );
        check(
            &format!("{puzzles}things = 6\n[tiers]\n4 = 1.0"),
            "`puzzles.things` is 6; the value must be from 3 to 5",
        );
        check(&locks.replace("= 2", "= 5"), "`locks.games` is 5; the value must be from 1 to 3");
        check(
            &locks.replace("games = 2", "games = 2\nrows = [16, 17]\ncolumns = [16, 16]"),
            "at most 256 cells",
        );
        assert_eq!(Recipe::from_toml(&locks).unwrap().games(), 2);
        let yards = locks.replace("[locks]", "[yards]");
        check(&yards.replace("= 2", "= 5"), "`yards.games` is 5; the value must be from 1 to 2");
        check(
            &yards.replace("games = 2", "games = 2\nrows = [14, 15]\ncolumns = [14, 14]"),
            "at most 196 cells",
        );
        let strays = locks.replace("[locks]", "[strays]");
        check(&strays.replace("= 2", "= 12"), "`strays.games` is 12; the value must be from 1 to 10");
        let recipe = Recipe::from_toml(&format!("{puzzles}[tiers]\n3 = 0.5\n4 = 0.5")).unwrap();
        assert_eq!((recipe.games(), recipe.levels(), recipe.tiers.shares()), (2, 6, [0.0, 0.0, 0.5, 0.5]));
        // Recipes without either section are serialised as before.
        let plain = serde_json::to_value(Recipe::from_toml(GOOD).unwrap()).unwrap();
        assert!(["tiers", "puzzles", "locks", "yards", "strays"].iter().all(|key| plain.get(key).is_none()));
    }
}
