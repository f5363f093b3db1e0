//! `arcade recipes`: the recipes that the binary carries.

use crate::console::Console;
use crate::embedded;
use crate::failure::{Answer, Failure};
use serde_json::json;
use snapshots::Recipe;

/// Lists the recipes that come with arcade, or prints one unchanged: a starting point for your own.
///
/// Example: arcade recipes show starter > mine.toml
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(subcommand)]
    what: Option<What>,
}

#[derive(clap::Subcommand)]
enum What {
    /// Prints a recipe: the exact TOML that is minted
    ///
    /// Example: arcade recipes show starter > mine.toml
    Show {
        /// The recipe's name
        #[arg(value_name = "NAME")]
        name: String,
    },
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    match &args.what {
        None => list(console),
        Some(What::Show { name }) => show(name, console),
    }
}

fn list(console: &Console) -> Answer {
    let names = embedded::recipe_names();
    let recipe = |name: &String| parsed(name, text_of(name)?);
    let recipes = names.iter().map(recipe).collect::<Result<Vec<_>, _>>()?;
    let entry = |recipe: &Recipe| {
        json!({
            "name": recipe.name,
            "description": recipe.description.trim(),
            "games": recipe.games(),
            "levels": recipe.levels(),
        })
    };
    console.document(&json!({ "recipes": recipes.iter().map(entry).collect::<Vec<_>>() }))?;
    let width = names.iter().map(String::len).max().unwrap_or(0);
    for recipe in &recipes {
        let games = recipe.games();
        let levels = recipe.levels();
        let what = recipe.description.trim();
        console.say(format_args!("{:<width$}  {games:>3} games, {levels:>3} levels  {what}", recipe.name));
    }
    console.say("\nprint one: arcade recipes show starter; what each line means: arcade docs recipes");
    Ok(true)
}

fn show(name: &str, console: &Console) -> Answer {
    let name = name.strip_suffix(".toml").unwrap_or(name);
    let text = text_of(name)?;
    console.document(&json!({ "name": name, "text": text, "recipe": parsed(name, text)? }))?;
    console.file(text);
    Ok(true)
}

fn text_of(name: &str) -> Result<&'static str, Failure> {
    embedded::recipe(name).ok_or_else(|| {
        let known = embedded::recipe_names();
        let near = engine::nearest(name, known.iter().map(String::as_str));
        let all = || format!("there are {}", known.join(", "));
        let help = near.map_or_else(all, |near| format!("did you mean `{near}`?"));
        malformed!("no recipe named `{name}`; {help}")
    })
}

fn parsed(name: &str, text: &str) -> Result<Recipe, Failure> {
    Recipe::from_toml(text).map_err(|error| malformed!("{name}.toml in this binary: {error}"))
}
