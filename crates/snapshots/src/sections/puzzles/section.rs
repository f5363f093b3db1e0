//! The implementation of the hooks for the puzzle sections.

use super::{PuzzleKind, PuzzlePart};
use crate::recipe::Recipe;
use crate::recipe::error::RecipeError;
use crate::sections::section::Section;
use serde_json::{Map, Value, json};

impl Section for PuzzleKind {
    fn name(&self) -> &'static str {
        self.section()
    }

    fn check(&self, recipe: &Recipe) -> Result<(), RecipeError> {
        recipe.puzzles_of(*self).map_or(Ok(()), |part| PuzzleKind::check(*self, part, &recipe.tiers))
    }

    fn decide(&self, recipe: &Recipe, decisive: &mut Map<String, Value>) {
        let part = recipe.puzzles_of(*self);
        let decides = part.map(|part| (part.levels, part.level_tries, part.columns, part.rows));
        // The key of the oldest section (`[puzzles]`) is always present.
        if decides.is_some() || *self == PuzzleKind::Pushing {
            decisive.insert(self.section().to_owned(), json!(decides));
        }
        if let Some(part) = part.filter(|part| part.things != PuzzlePart::default().things) {
            decisive.insert("things".to_owned(), part.things.into());
        }
    }
}
