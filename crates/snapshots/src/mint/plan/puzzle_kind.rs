//! The kinds of puzzles.

use crate::recipe::Recipe;
use crate::recipe::tiers::PuzzlePart;
use engine::Game;
use generators::games::{LockRules, PushRules, YardRules};
use validators::novelty::GameForm;

/// A kind of puzzle, with a section of its own in recipes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum PuzzleKind {
    /// Things are pushed.
    Pushing,
    /// Keys are used up by doors.
    Locks,
    /// Parcels are carried between carts.
    Yards,
    /// Things are pushed among strays.
    Strays,
}

impl PuzzleKind {
    /// All kinds, in the order of jobs.
    pub const ALL: [PuzzleKind; 4] =
        [PuzzleKind::Pushing, PuzzleKind::Locks, PuzzleKind::Yards, PuzzleKind::Strays];

    /// The name in jobs and in steps of seeds.
    pub(crate) fn name(self) -> &'static str {
        match self {
            PuzzleKind::Pushing => "puzzle",
            PuzzleKind::Locks => "locks",
            PuzzleKind::Yards => "yards",
            PuzzleKind::Strays => "strays",
        }
    }

    /// The name of the section of recipes.
    pub(crate) fn section(self) -> &'static str {
        match self {
            PuzzleKind::Pushing => "puzzles",
            PuzzleKind::Locks | PuzzleKind::Yards | PuzzleKind::Strays => self.name(),
        }
    }

    /// The section of a recipe, if it has one.
    pub(crate) fn part(self, recipe: &Recipe) -> Option<&PuzzlePart> {
        match self {
            PuzzleKind::Pushing => recipe.puzzles.as_ref(),
            PuzzleKind::Locks => recipe.locks.as_ref(),
            PuzzleKind::Yards => recipe.yards.as_ref(),
            PuzzleKind::Strays => recipe.strays.as_ref(),
        }
    }

    /// The number of rule sets, no two of which are near to each other.
    pub(crate) fn rules(self) -> usize {
        match self {
            PuzzleKind::Pushing => PushRules::ALL.len(),
            PuzzleKind::Locks => LockRules::ALL.len(),
            PuzzleKind::Yards => YardRules::ALL.len(),
            PuzzleKind::Strays => PushRules::AMONG_STRAYS.len(),
        }
    }

    /// A rule set without a theme, and its name.
    pub(crate) fn plain(self, at: usize) -> (Game, String) {
        match self {
            PuzzleKind::Pushing => (PushRules::ALL[at].game(), PushRules::ALL[at].name()),
            PuzzleKind::Locks => (LockRules::ALL[at].game(), LockRules::ALL[at].name()),
            PuzzleKind::Yards => (YardRules::ALL[at].game(), YardRules::ALL[at].name()),
            PuzzleKind::Strays => (PushRules::AMONG_STRAYS[at].game(), PushRules::AMONG_STRAYS[at].name()),
        }
    }

    /// The form of a rule set.
    pub(crate) fn form(self, at: usize) -> GameForm {
        GameForm::of(&self.plain(at).0)
    }

    /// The cost in seconds of one core per requested level, as in `frontier`, to the highest tiers.
    pub(crate) fn seconds(self) -> f64 {
        match self {
            PuzzleKind::Pushing => 24.0,
            PuzzleKind::Locks => 14.0,
            PuzzleKind::Yards => 17.0,
            PuzzleKind::Strays => 4.0,
        }
    }
}
