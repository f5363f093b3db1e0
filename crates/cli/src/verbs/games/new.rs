//! `arcade new`: creates a starting point for a new game.

use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::paths;
use crate::{protected, shell};
use base::MessagePath;
use clap::builder::{PossibleValue, PossibleValuesParser};
use serde_json::json;
use std::ffi::OsStr;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use studio::{TEMPLATES, Template};

/// Writes a new game to start from: a folder with about twenty lines of commented rules and two levels.
///
/// The game is immediately playable, and its comments explain the language. `arcade docs first-game` explains how to
/// turn it into a game of your own.
///
/// Example: arcade new river-post --like crossing
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The game's folder, which must be new or empty
    #[arg(value_name = "NAME")]
    name: PathBuf,
    /// The kind of game to start from
    #[arg(long, value_name = "GENRE", value_parser = genres(), default_value = TEMPLATES[0].genre)]
    like: String,
}

fn genres() -> PossibleValuesParser {
    TEMPLATES.map(|Template { genre, about, .. }| PossibleValue::new(genre).help(about)).into()
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let folder = &args.name;
    let template = Template::of(&args.like).expect("the parser admits the genres only");
    check_name(folder)?;
    protected::check(folder)?;
    template.begin(folder).map_err(|error| refused(folder, error))?;
    let next = ["play", "validate", "studio"]
        .map(|verb| (verb, shell::command([OsStr::new(verb), folder.as_os_str()])));
    let files = template.files.map(|(name, _)| folder.join(name).in_message().to_string());
    console.document(&json!({
        "game": paths::in_json(folder), "genre": template.genre, "files": files,
        "next": next.iter().map(|(_, command)| command).collect::<Vec<_>>(),
    }))?;
    if console.is_quiet() {
        return Ok(true);
    }
    let [first, second, game] = files;
    console.say(format_args!("{game}: {}", template.about));
    console.say(format_args!(
        "its levels are {first} and {second}; the comments in {game} explain every section\n"
    ));
    for ((_, command), label) in next.iter().zip(["play it:", "check it:", "change it:"]) {
        console.say(format_args!("{label:<11} {command}"));
    }
    Ok(true)
}

/// Rejects a name that is unsuitable for a game folder, or that the suggested next commands would not accept.
fn check_name(folder: &Path) -> Result<(), Failure> {
    let shown = folder.in_message();
    let Some(name) = folder.file_name().map(OsStr::to_string_lossy) else {
        bail!("`{shown}` isn't a valid name for a new game: choose one, such as `arcade new river-post`");
    };
    if let Some(stem) = [".vgdl", ".txt", ".toml"].iter().find_map(|end| name.strip_suffix(end)) {
        let stem = if stem.is_empty() { "river-post" } else { stem };
        let command = shell::command(["new", &folder.with_file_name(stem).to_string_lossy()]);
        bail!("`{shown}` is the name of a file, but a game is a folder: {command}");
    }
    let first = folder.to_string_lossy().chars().next();
    if !name.chars().any(char::is_alphanumeric) || name.chars().any(char::is_control) || first == Some('-') {
        bail!(
            "`{shown}` isn't a valid name for a new game: use letters, digits and dashes, and begin with a \
             letter or digit, such as `arcade new river-post`"
        );
    }
    Ok(())
}

fn refused(folder: &Path, error: std::io::Error) -> Failure {
    let shown = folder.in_message();
    match error.kind() {
        ErrorKind::AlreadyExists if folder.is_dir() => malformed!(
            "`{shown}` exists and is not empty, and existing files are never overwritten: choose another \
             name; `{}` opens the existing folder",
            shell::command([OsStr::new("studio"), folder.as_os_str()])
        ),
        ErrorKind::AlreadyExists => {
            malformed!("`{shown}` is a file, and existing files are never overwritten: choose another name")
        }
        ErrorKind::NotFound | ErrorKind::NotADirectory => malformed!(
            "the folder above `{shown}` does not exist: create it first, or choose a name without `/`"
        ),
        ErrorKind::InvalidFilename => malformed!("`{shown}` is too long or invalid: choose a shorter name"),
        _ => Failure::environment(error, format_args!("cannot write `{shown}`")),
    }
}
