//! `arcade recipes`: shows the recipes embedded in the binary, and writes new recipes.

use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::input::embedded;
use crate::paths;
use crate::{protected, shell};
use base::MessagePath;
use disk::Access;
use serde_json::json;
use snapshots::Recipe;
use std::ffi::OsStr;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Lists the recipes that come with arcade, prints one, or writes a new one with comments.
///
/// Examples: arcade recipes new 2027-01,
/// arcade recipes show starter > mine.toml
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
    /// Writes NAME.toml: a recipe with comments, for a release with gates and measured difficulty
    ///
    /// `arcade docs first-month` leads from this file to a month that is sealed, signed and logged.
    ///
    /// Example: arcade recipes new 2027-01
    New {
        /// The name of the release: lower-case letters, digits and dashes
        #[arg(value_name = "NAME")]
        name: PathBuf,
    },
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    match &args.what {
        None => list(console),
        Some(What::Show { name }) => show(name, console),
        Some(What::New { name }) => new(name, console),
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
    console.say("\nprint one: arcade recipes show starter; start your own: arcade recipes new NAME; look up what each line means: arcade docs recipes");
    Ok(true)
}

fn show(name: &str, console: &Console) -> Answer {
    let name = name.strip_suffix(".toml").unwrap_or(name);
    let text = text_of(name)?;
    console.document(&json!({ "name": name, "text": text, "recipe": parsed(name, text)? }))?;
    console.file(text);
    Ok(true)
}

/// The recipe that `arcade recipes new` writes, with the placeholder `NAME` for its name.
const NEW: &str = include_str!("new-recipe.toml");

fn new(path: &Path, console: &Console) -> Answer {
    let shown = path.in_message();
    let name = path.file_name().and_then(OsStr::to_str).unwrap_or_default();
    let name = name.strip_suffix(".toml").unwrap_or(name);
    let is_plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    if !(1..=40).contains(&name.len()) || !name.chars().all(is_plain) {
        bail!(
            "`{shown}` isn't a valid release name: use 1 to 40 lower-case letters, digits and `-`, such as \
             `arcade recipes new 2027-01`"
        );
    }
    let file = path.with_file_name(format!("{name}.toml"));
    let text = NEW.replace("NAME", name);
    let recipe = parsed(name, &text)?;
    protected::check(&file)?;
    disk::create(&file, text.as_bytes(), Access::Shared).map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => {
            malformed!(
                "`{}` already exists, and recipes are never overwritten: choose another name",
                file.in_message()
            )
        }
        _ => Failure::write(&file, error),
    })?;
    let next = ["--dry-run", "", "--commit"].map(|flag| {
        let flag = Some(OsStr::new(flag)).filter(|flag| !flag.is_empty());
        shell::command([OsStr::new("release"), file.as_os_str()].into_iter().chain(flag))
    });
    console.document(&json!({ "file": paths::in_json(&file), "recipe": recipe, "next": next }))?;
    if console.is_quiet() {
        return Ok(true);
    }
    console.say(format_args!(
        "{}: a release of {} games with {} levels; the comments say what to change\n",
        file.in_message(),
        recipe.games(),
        recipe.levels()
    ));
    for (label, command) in ["show its cost:", "mint it, open:", "or seal it:"].iter().zip(next) {
        console.say(format_args!("{label:<15} {command}"));
    }
    console.say(
        "\nfor a release that follows an earlier one, add --parent with the previous release's folder to \
         each of these commands",
    );
    Ok(true)
}

fn text_of(name: &str) -> Result<&'static str, Failure> {
    embedded::recipe(name).ok_or_else(|| {
        let known = embedded::recipe_names();
        let near = engine::nearest(name, known.iter().map(String::as_str));
        let all = || format!("the recipes are {}", known.join(", "));
        let help = near.map_or_else(all, |near| format!("did you mean `{near}`?"));
        malformed!("no recipe named `{name}`; {help}")
    })
}

fn parsed(name: &str, text: &str) -> Result<Recipe, Failure> {
    Recipe::from_toml(text).map_err(|error| malformed!("{name}.toml in this binary: {error}"))
}
