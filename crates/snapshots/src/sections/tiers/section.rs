//! The implementation of the hooks for `[tiers]`, the requested fractions of levels by difficulty class.

use crate::recipe::Recipe;
use crate::recipe::error::RecipeError;
use crate::sections::section::Section;
use serde_json::{Map, Value, json};

/// The `[tiers]` section of a recipe.
pub(crate) struct TiersSection;

impl Section for TiersSection {
    fn name(&self) -> &'static str {
        "tiers"
    }

    fn check(&self, recipe: &Recipe) -> Result<(), RecipeError> {
        recipe.tiers.check()
    }

    fn decide(&self, recipe: &Recipe, decisive: &mut Map<String, Value>) {
        decisive.insert("tiers".to_owned(), json!(recipe.tiers));
    }

    fn needs_tiers(&self, recipe: &Recipe) -> bool {
        !recipe.tiers.is_empty()
    }
}
