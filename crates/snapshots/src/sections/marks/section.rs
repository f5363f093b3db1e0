//! The implementation of the hooks for `[marks]`, the results of reference players.

use super::check::{problems, shape_problem};
use super::{GameMarks, LevelMarks, Marks, MarksPart};
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
use validators::Tier;

/// The `[marks]` section of a recipe, which requests the results of reference players.
pub(crate) struct MarksSection;

impl Section for MarksSection {
    fn name(&self) -> &'static str {
        "marks"
    }

    fn check(&self, recipe: &Recipe) -> Result<(), RecipeError> {
        recipe.marks.as_ref().map_or(Ok(()), MarksPart::check)
    }

    fn decide(&self, recipe: &Recipe, decisive: &mut Map<String, Value>) {
        decisive.insert("marks".to_owned(), json!(recipe.marks));
    }

    fn needs_tiers(&self, recipe: &Recipe) -> bool {
        recipe.marks.is_some()
    }

    fn complete(&self, making: &Making<'_>, game: &mut FrozenGame) -> Result<(), String> {
        let Some(asked) = &making.recipe.marks else { return Ok(()) };
        let players = making.players.ok_or_else(|| "there are no players".to_owned())?;
        game.marks = players.play(&game.text, &game.levels, asked)?;
        Ok(())
    }

    fn seconds(&self, recipe: &Recipe, job: &JobCost) -> f64 {
        let asked = recipe.marks.as_ref();
        f64::from(job.levels) * asked.map_or(0.0, |asked| asked.seconds(job.is_certain))
    }

    fn job_problem(&self, recipe: &Recipe, frozen: &FrozenGame, _: &Game, _: Seed) -> Option<String> {
        shape_problem(&frozen.marks, frozen.levels.len(), recipe.marks.as_ref())
    }

    fn summary(&self, writing: &Writing<'_>, games: &[FrozenGame]) -> Result<Option<Summary>, SnapshotError> {
        let Some(asked) = &writing.recipe.marks else { return Ok(None) };
        let marks = Marks::of(writing.canary, asked, games.iter().map(marks_of).collect());
        let readme = match writing.kind {
            ReleaseKind::Open => marks.in_words(),
            ReleaseKind::Sealed => String::new(),
        };
        let file = (Marks::path(writing.kind), to_canonical_json(&marks)?.into_bytes());
        Ok(Some(Summary { file, readme }))
    }

    fn summary_path(&self, manifest: &Manifest) -> Option<String> {
        Marks::path_in(manifest)
    }

    fn check_summary(&self, release: &Checking<'_>, cards: &[&Card]) -> Result<Vec<String>, SnapshotError> {
        problems(release.contents, release.manifest, cards)
    }
}

/// Returns a game's reference results, with its levels' tiers (difficulty classes) from its card.
fn marks_of(game: &FrozenGame) -> GameMarks {
    let levels = game.card.levels.iter().zip(&game.marks);
    let level =
        levels.map(|(card, wins)| LevelMarks { tier: card.tier.unwrap_or(Tier::One), wins: wins.clone() });
    GameMarks { id: game.card.id.clone(), levels: level.collect() }
}
