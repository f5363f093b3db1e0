//! `arcade fmt`: the canonical print of a game.

use crate::console::Console;
use crate::failure::Answer;
use crate::{diagnostics, input};
use engine::{Diagnostics, syntax};
use serde_json::json;

/// Prints a game in canonical form: sections in order, an indent of four blanks, comments kept.
///
/// Example: arcade fmt my-game.vgdl > tidy.vgdl
#[derive(clap::Args)]
pub(crate) struct Args {
    /// A .vgdl or .txt file, a folder with game.vgdl or game.txt, or the name of a corpus game
    #[arg(value_name = "GAME")]
    game: String,
    /// Print nothing; exit status 1 if the file is not in canonical form
    #[arg(long)]
    check: bool,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let source = input::game(&args.game)?.source;
    let (description, problems) = syntax::parse(&source.text);
    if Diagnostics::has_errors(&problems) {
        // A line that cannot be parsed has no canonical form: printing the rest would lose it.
        return Err(diagnostics::failure(&source, &problems));
    }
    let text = syntax::print(&description);
    let canonical = text == source.text;
    console.document(&json!({ "file": source.name, "canonical": canonical, "text": text }))?;
    match (args.check, canonical) {
        (false, _) => console.file(&text),
        (true, false) => console.say(format_args!("{}: not in canonical form", source.name)),
        (true, true) => {}
    }
    Ok(canonical || !args.check)
}
