//! The implementation of the hooks for `[memory]`.

use super::pairs::shape_problem;
use super::toss::toss;
use super::verify::check_pairs;
use crate::error::SnapshotError;
use crate::format::layout::{second_path, sibling_path};
use crate::format::manifest::item::ReleaseKind;
use crate::format::witness::Witness;
use crate::recipe::Recipe;
use crate::recipe::error::RecipeError;
use crate::sections::frozen::FrozenGame;
use crate::sections::section::{CheckedGame, Checking, Found, JobCost, Making, NewFile, Section, Writing};
use base::Seed;
use base::canonical::to_canonical_json;
use engine::{Game, syntax};
use forge::games::marked;
use serde_json::{Map, Value, json};

/// The relative cost that searching for second wins adds to a job, as measured on twelve games.
const SECOND_WINS: f64 = 0.2;

/// The `[memory]` section of a recipe.
pub(crate) struct MemorySection;

impl Section for MemorySection {
    fn name(&self) -> &'static str {
        "memory"
    }

    fn check(&self, recipe: &Recipe) -> Result<(), RecipeError> {
        recipe.memory.as_ref().map_or(Ok(()), |part| part.check(recipe.commitment))
    }

    fn decide(&self, recipe: &Recipe, decisive: &mut Map<String, Value>) {
        if let Some(memory) = recipe.memory {
            decisive.insert("memory".to_owned(), json!(memory));
        }
    }

    fn complete(&self, making: &Making<'_>, game: &mut FrozenGame) -> Result<(), String> {
        if let Some(part) = making.recipe.memory {
            toss(game, making.root, part, making.criteria);
        }
        Ok(())
    }

    fn seconds(&self, recipe: &Recipe, job: &JobCost) -> f64 {
        if recipe.memory.is_some_and(|part| part.witnesses) { SECOND_WINS * job.seconds } else { 0.0 }
    }

    fn job_problem(&self, _: &Recipe, frozen: &FrozenGame, game: &Game, root: Seed) -> Option<String> {
        shape_problem(frozen, game, root)
    }

    fn game_files(
        &self,
        writing: &Writing<'_>,
        game: &mut FrozenGame,
    ) -> Result<Vec<NewFile>, SnapshotError> {
        let mut files = Vec::new();
        // If one of two wins is withheld, stating the length of the shortest win would reveal which win was
        // published.
        for (level, second) in game.card.levels.iter_mut().zip(&game.seconds) {
            level.optimal_ticks = level.optimal_ticks.filter(|_| second.is_none());
        }
        let id = &game.card.id;
        if let Some(sibling) = game.sibling.take() {
            let text = marked(&syntax::parse(&sibling.text).0, writing.canary);
            files.push((sibling_path(id, "game.vgdl"), text.into_bytes()));
            for (number, level) in sibling.levels.into_iter().enumerate() {
                files.push((sibling_path(id, &format!("lvl{number}.txt")), level.into_bytes()));
            }
        }
        for (number, second) in std::mem::take(&mut game.seconds).into_iter().enumerate() {
            let Some(second) = second else { continue };
            let canary = writing.canary.to_owned();
            let witness = Witness { canary, episode: second.episode, path: second.path };
            files.push((second_path(id, number), to_canonical_json(&witness)?.into_bytes()));
        }
        Ok(files)
    }

    fn readme(&self, recipe: &Recipe) -> Option<&'static str> {
        recipe.memory.map(|_| {
            "Of two renamings of a game, or of two wins of a level, a coin publishes one; the other is committed to and withheld \
             until the reveal, to tell who has seen what was published (`arcade study contamination`).\n\n"
        })
    }

    fn check_game(
        &self,
        release: &Checking<'_>,
        game: &CheckedGame<'_>,
        found: &mut Found,
    ) -> Result<(), SnapshotError> {
        match release.manifest.kind {
            ReleaseKind::Sealed => check_pairs(release, game, found),
            ReleaseKind::Open => Ok(()),
        }
    }
}
