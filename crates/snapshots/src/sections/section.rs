//! The hooks of a section, which minting and checking call.

use super::frozen::FrozenGame;
use super::marks::MarkPlayers;
use crate::contents::Contents;
use crate::contents::replay::Meter;
use crate::error::SnapshotError;
use crate::format::manifest::Manifest;
use crate::format::manifest::item::ReleaseKind;
use crate::recipe::Recipe;
use crate::recipe::error::RecipeError;
use crate::recipe::secret::Secret;
use base::Seed;
use engine::{Episode, Game, Level};
use forge::card::Card;
use serde_json::{Map, Value};
use validators::Criteria;

/// The path and content of a file in a release.
pub(crate) type NewFile = (String, Vec<u8>);

/// The context in which a game is generated.
pub(crate) struct Making<'a> {
    pub(crate) recipe: &'a Recipe,
    /// The release's root seed.
    pub(crate) root: Seed,
    /// The criteria of the game's judges.
    pub(crate) criteria: &'a Criteria,
    pub(crate) players: Option<&'a dyn MarkPlayers>,
}

/// The cost of a job without the additions of sections.
pub(crate) struct JobCost {
    /// The cost in core seconds.
    pub(crate) seconds: f64,
    /// The number of levels that the job has to generate.
    pub(crate) levels: u32,
    /// `true` if the job's games have no randomness.
    pub(crate) is_certain: bool,
}

/// A release whose files are being written.
pub(crate) struct Writing<'a> {
    pub(crate) recipe: &'a Recipe,
    pub(crate) canary: &'a str,
    pub(crate) kind: ReleaseKind,
}

/// A section's file about the release as a whole, and the section's text for the README.
pub(crate) struct Summary {
    pub(crate) file: NewFile,
    /// The text at the end of the release's README. May be empty.
    pub(crate) readme: String,
}

/// A release that is being checked. The digests of its files match its manifest.
pub(crate) struct Checking<'a> {
    pub(crate) contents: &'a Contents,
    pub(crate) manifest: &'a Manifest,
    /// The secret of a revealed sealed release.
    pub(crate) secret: Option<&'a Secret>,
    /// The meter for replays; `None` if the witnesses were recorded under different semantics.
    pub(crate) meter: Option<&'a Meter>,
}

/// A game that is being checked, with its rules and levels loaded.
pub(crate) struct CheckedGame<'a> {
    /// The name of the game's folder.
    pub(crate) folder: &'a str,
    pub(crate) game: &'a Game,
    /// The levels, each with its published witness if one exists.
    pub(crate) levels: &'a [(Level, Option<Episode>)],
    /// `true` if the game equals an earlier game in the release.
    pub(crate) is_again: bool,
}

/// The result of checking a section's additions to a game.
#[derive(Default)]
pub(crate) struct Found {
    /// The paths of the withheld files that exist, or should exist.
    pub(crate) listed: Vec<String>,
    /// The number of episodes that replayed to a win.
    pub(crate) replayed: usize,
    /// The problems, each with the file name.
    pub(crate) problems: Vec<String>,
}

/// A recipe section. Every hook is called for every recipe, and does nothing if the section is missing from the
/// recipe.
pub(crate) trait Section: Sync {
    /// Returns the name of the section's table in a recipe.
    fn name(&self) -> &'static str;

    /// Checks the section's values.
    ///
    /// # Errors
    /// Returns an error for the first value that is out of range.
    fn check(&self, recipe: &Recipe) -> Result<(), RecipeError>;

    /// Adds the values that determine the results of jobs to the content covered by the plan's digest.
    fn decide(&self, recipe: &Recipe, decisive: &mut Map<String, Value>);

    /// Returns `true` if each level needs a tier (difficulty class).
    fn needs_tiers(&self, _recipe: &Recipe) -> bool {
        false
    }

    /// Changes or completes a job's game before the job's result is stored.
    ///
    /// # Errors
    /// Returns a message if the game cannot be completed.
    fn complete(&self, _making: &Making<'_>, _game: &mut FrozenGame) -> Result<(), String> {
        Ok(())
    }

    /// Estimates the core seconds that [`Section::complete`] adds to a job.
    fn seconds(&self, _recipe: &Recipe, _job: &JobCost) -> f64 {
        0.0
    }

    /// Returns a sentence about the problem with the section's additions to a game in a job's result; `None` if there
    /// is no problem. `root` is the plan's seed.
    fn job_problem(
        &self,
        _recipe: &Recipe,
        _frozen: &FrozenGame,
        _game: &Game,
        _root: Seed,
    ) -> Option<String> {
        None
    }

    /// Returns a game's files other than its rules, levels, card and witnesses. May also remove facts from the card
    /// that would reveal secrets.
    ///
    /// # Errors
    /// Returns an error if a file cannot be written as canonical JSON.
    fn game_files(
        &self,
        _writing: &Writing<'_>,
        _game: &mut FrozenGame,
    ) -> Result<Vec<NewFile>, SnapshotError> {
        Ok(Vec::new())
    }

    /// Returns the section's file about the release as a whole. The games are passed without their texts and
    /// episodes.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written as canonical JSON.
    fn summary(
        &self,
        _writing: &Writing<'_>,
        _games: &[FrozenGame],
    ) -> Result<Option<Summary>, SnapshotError> {
        Ok(None)
    }

    /// Returns a paragraph about the section for a release's README; `None` if the README has none.
    fn readme(&self, _recipe: &Recipe) -> Option<&'static str> {
        None
    }

    /// Returns the path of the file that [`Section::summary`] creates for a release with the given manifest; `None` if
    /// it creates no file. In a sealed release, the file must be in `held/`, because every other file is public.
    fn summary_path(&self, _manifest: &Manifest) -> Option<String> {
        None
    }

    /// Checks a game's files.
    ///
    /// # Errors
    /// Returns an error if a file cannot be read.
    fn check_game(
        &self,
        _release: &Checking<'_>,
        _game: &CheckedGame<'_>,
        _found: &mut Found,
    ) -> Result<(), SnapshotError> {
        Ok(())
    }

    /// Returns the problems with the file from [`Section::summary`], given the cards of all games.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read.
    fn check_summary(&self, _release: &Checking<'_>, _cards: &[&Card]) -> Result<Vec<String>, SnapshotError> {
        Ok(Vec::new())
    }
}
