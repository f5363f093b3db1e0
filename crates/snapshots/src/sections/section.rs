//! The hooks of a section: all that minting and checking a release ask of it.

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

/// A file of a release: its path and its content.
pub(crate) type NewFile = (String, Vec<u8>);

/// The mint that a game is made in.
pub(crate) struct Making<'a> {
    pub(crate) recipe: &'a Recipe,
    /// The root seed of the release.
    pub(crate) root: Seed,
    /// The criteria of the judges of the game.
    pub(crate) criteria: &'a Criteria,
    pub(crate) players: Option<&'a dyn MarkPlayers>,
}

/// The cost of a job without what sections add to it.
pub(crate) struct JobCost {
    /// Seconds of one core.
    pub(crate) seconds: f64,
    /// The number of levels that the job is asked for.
    pub(crate) levels: u32,
    /// `true` if its games have no randomness.
    pub(crate) is_certain: bool,
}

/// The release that files are written for.
pub(crate) struct Writing<'a> {
    pub(crate) recipe: &'a Recipe,
    pub(crate) canary: &'a str,
    pub(crate) kind: ReleaseKind,
}

/// A file about a release as a whole.
pub(crate) struct Summary {
    pub(crate) file: NewFile,
    /// The end of the release's README; empty if nothing is said.
    pub(crate) readme: String,
}

/// The release that is checked. The digests of its files are those of its manifest.
pub(crate) struct Checking<'a> {
    pub(crate) contents: &'a Contents,
    pub(crate) manifest: &'a Manifest,
    /// The secret of a sealed release that was revealed.
    pub(crate) secret: Option<&'a Secret>,
    /// The meter for replays; `None` if the witnesses are of other semantics.
    pub(crate) meter: Option<&'a Meter>,
}

/// A game that is checked, whose rules and levels have been loaded.
pub(crate) struct CheckedGame<'a> {
    /// The name of its folder.
    pub(crate) folder: &'a str,
    pub(crate) game: &'a Game,
    /// The levels, each with its published witness if there is one.
    pub(crate) levels: &'a [(Level, Option<Episode>)],
    /// `true` if the release holds the same game twice, and this is not the first.
    pub(crate) is_again: bool,
}

/// The result of checking what a section added to a game.
#[derive(Default)]
pub(crate) struct Found {
    /// The paths of the withheld files that the release has, or should have.
    pub(crate) listed: Vec<String>,
    /// The number of episodes that replayed to a win.
    pub(crate) replayed: usize,
    /// The problems, each naming the file.
    pub(crate) problems: Vec<String>,
}

/// A section of a recipe. Every hook is called for every recipe: a hook of a section that the recipe lacks does nothing.
pub(crate) trait Section: Sync {
    /// The name of the table in a recipe.
    fn name(&self) -> &'static str;

    /// Checks the values of the section.
    ///
    /// # Errors
    /// The first value that is out of its range.
    fn check(&self, recipe: &Recipe) -> Result<(), RecipeError>;

    /// Adds what determines the results of jobs to the content of the plan's digest.
    fn decide(&self, recipe: &Recipe, decisive: &mut Map<String, Value>);

    /// Returns `true` if each level needs a tier.
    fn needs_tiers(&self, _recipe: &Recipe) -> bool {
        false
    }

    /// Changes or completes a game that a job has made, before its result is stored.
    ///
    /// # Errors
    /// It cannot be done; the message says why.
    fn complete(&self, _making: &Making<'_>, _game: &mut FrozenGame) -> Result<(), String> {
        Ok(())
    }

    /// The seconds of one core that [`Section::complete`] adds to a job.
    fn seconds(&self, _recipe: &Recipe, _job: &JobCost) -> f64 {
        0.0
    }

    /// The fault of what the section added to a game in the result of a job, in words. `root` is the seed of the plan.
    fn job_problem(
        &self,
        _recipe: &Recipe,
        _frozen: &FrozenGame,
        _game: &Game,
        _root: Seed,
    ) -> Option<String> {
        None
    }

    /// The files that a game has besides rules, levels, card and witnesses. May remove from the card what must stay secret.
    ///
    /// # Errors
    /// A file has no canonical JSON.
    fn game_files(
        &self,
        _writing: &Writing<'_>,
        _game: &mut FrozenGame,
    ) -> Result<Vec<NewFile>, SnapshotError> {
        Ok(Vec::new())
    }

    /// The file about the release as a whole, given its games without their texts and episodes.
    ///
    /// # Errors
    /// The file has no canonical JSON.
    fn summary(
        &self,
        _writing: &Writing<'_>,
        _games: &[FrozenGame],
    ) -> Result<Option<Summary>, SnapshotError> {
        Ok(None)
    }

    /// A paragraph about the section in the README of a release.
    fn readme(&self, _recipe: &Recipe) -> Option<&'static str> {
        None
    }

    /// The path of the [`Section::summary`] of a release with this manifest.
    fn summary_path(&self, _manifest: &Manifest) -> Option<String> {
        None
    }

    /// Checks the files of a game.
    ///
    /// # Errors
    /// A file cannot be read.
    fn check_game(
        &self,
        _release: &Checking<'_>,
        _game: &CheckedGame<'_>,
        _found: &mut Found,
    ) -> Result<(), SnapshotError> {
        Ok(())
    }

    /// The problems of the [`Section::summary`], given the cards of all games.
    ///
    /// # Errors
    /// The file cannot be read.
    fn check_summary(&self, _release: &Checking<'_>, _cards: &[&Card]) -> Result<Vec<String>, SnapshotError> {
        Ok(Vec::new())
    }
}
