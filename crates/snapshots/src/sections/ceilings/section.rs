//! The implementation of the hooks for `[ceilings]`, the highest known win rates.

use super::check::{problems, shape_problem};
use super::measure::{of_game, seconds};
use super::{Ceilings, CeilingsPart, GameCeilings};
use crate::error::SnapshotError;
use crate::format::manifest::Manifest;
use crate::format::manifest::item::ReleaseKind;
use crate::recipe::Recipe;
use crate::recipe::error::RecipeError;
use crate::sections::frozen::FrozenGame;
use crate::sections::section::{Checking, JobCost, Making, Section, Summary, Writing};
use base::Seed;
use base::canonical::to_canonical_json;
use engine::Game;
use forge::card::Card;
use serde_json::{Map, Value, json};

/// The `[ceilings]` section of a recipe, which requests the highest known win rates.
pub(crate) struct CeilingsSection;

impl Section for CeilingsSection {
    fn name(&self) -> &'static str {
        "ceilings"
    }

    fn check(&self, recipe: &Recipe) -> Result<(), RecipeError> {
        recipe.ceilings.map_or(Ok(()), CeilingsPart::check)
    }

    fn decide(&self, recipe: &Recipe, decisive: &mut Map<String, Value>) {
        if let Some(ceilings) = recipe.ceilings {
            decisive.insert("ceilings".to_owned(), json!(ceilings));
        }
    }

    fn complete(&self, making: &Making<'_>, game: &mut FrozenGame) -> Result<(), String> {
        if let Some(asked) = making.recipe.ceilings {
            game.ceilings = of_game(game, asked, making.root)?;
        }
        Ok(())
    }

    fn seconds(&self, recipe: &Recipe, job: &JobCost) -> f64 {
        let asked = recipe.ceilings.filter(|_| !job.is_certain);
        f64::from(job.levels) * asked.map_or(0.0, seconds)
    }

    fn job_problem(&self, recipe: &Recipe, frozen: &FrozenGame, _: &Game, _: Seed) -> Option<String> {
        shape_problem(&frozen.ceilings, frozen.levels.len(), recipe.ceilings)
    }

    fn summary(&self, writing: &Writing<'_>, games: &[FrozenGame]) -> Result<Option<Summary>, SnapshotError> {
        let Some(asked) = writing.recipe.ceilings else { return Ok(None) };
        let of_game =
            |game: &FrozenGame| GameCeilings { id: game.card.id.clone(), levels: game.ceilings.clone() };
        let ceilings = Ceilings::of(writing.canary, asked, games.iter().map(of_game).collect());
        let readme = match writing.kind {
            ReleaseKind::Open => ceilings.in_words(),
            ReleaseKind::Sealed => String::new(),
        };
        let file = (Ceilings::path(writing.kind), to_canonical_json(&ceilings)?.into_bytes());
        Ok(Some(Summary { file, readme }))
    }

    fn summary_path(&self, manifest: &Manifest) -> Option<String> {
        Ceilings::path_in(manifest)
    }

    fn check_summary(&self, release: &Checking<'_>, cards: &[&Card]) -> Result<Vec<String>, SnapshotError> {
        problems(release.contents, release.manifest, cards)
    }
}
