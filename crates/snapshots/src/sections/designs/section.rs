//! The implementation of the hooks for `[designs]`.

use crate::recipe::Recipe;
use crate::recipe::error::{RecipeError, wrong};
use crate::sections::section::Section;
use serde_json::{Map, Value, json};

/// The `[designs]` section of a recipe, which takes games from a pool.
pub(crate) struct DesignsSection;

impl Section for DesignsSection {
    fn name(&self) -> &'static str {
        "designs"
    }

    fn check(&self, recipe: &Recipe) -> Result<(), RecipeError> {
        let Some(part) = &recipe.designs else { return Ok(()) };
        for (key, value, least, most) in
            [("designs.games", part.games, 1, 10_000), ("designs.levels", part.levels, 1, 20)]
        {
            if !(least..=most).contains(&value) {
                return wrong(key, format!("is {value}; the value must be from {least} to {most}"));
            }
        }
        Ok(())
    }

    fn decide(&self, recipe: &Recipe, decisive: &mut Map<String, Value>) {
        if let Some(part) = &recipe.designs {
            decisive.insert("designs".to_owned(), json!([part.levels, part.digest]));
        }
    }
}
