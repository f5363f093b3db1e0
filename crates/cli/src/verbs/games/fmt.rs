//! `arcade fmt`: a game's canonical form.

use crate::console::Console;
use crate::diagnostics::Named;
use crate::failure::{Answer, Failure};
use crate::input;
use crate::input::game_input::GameInput;
use crate::input::text::read_text;
use crate::{diagnostics, paths, protected, shell};
use base::MessagePath;
use clap::ValueEnum;
use engine::{Diagnostics, MAX_SOURCE, dialect, syntax};
use serde_json::json;
use std::path::{Path, PathBuf};

/// Prints a game in canonical form: sections in their canonical order, indented by four spaces, with its comments.
///
/// With --from, converts a game from a different dialect. Everything with an exact equivalent is converted, and the
/// rest is listed on standard error with line numbers. Exit status 1 means that something could not be converted.
///
/// Examples: arcade fmt my-game.vgdl > tidy.vgdl, arcade fmt --from py-vgdl aliens.py --out aliens
#[derive(clap::Args)]
pub(crate) struct Args {
    /// A .vgdl or .txt file, a folder with game.vgdl or game.txt, or the name of a corpus game; with --from, also a
    /// Python file that contains a game as a string
    #[arg(value_name = "GAME")]
    game: String,
    /// Do not print the game, and exit with status 1 if the file is not in canonical form
    #[arg(long, conflicts_with = "from")]
    check: bool,
    /// The dialect that the game is written in
    #[arg(long, value_name = "DIALECT")]
    from: Option<From>,
    /// Write the converted game and its levels to this folder, as game.vgdl, lvl0.txt and so on, instead of printing
    /// it
    #[arg(long, value_name = "DIR", requires = "from")]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum From {
    /// The dialect of py-vgdl.
    PyVgdl,
    /// The dialect of EMPA's games.
    Empa,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    if args.from.is_some() {
        return convert(args, console);
    }
    let input = input::game(&args.game)?;
    if input.asked()?.is_some() {
        let game = shell::quoted(&input.source.name);
        bail!("{}: this is a level, not a game; its game is {game}: arcade fmt {game}", args.game);
    }
    let source = input.source;
    let (description, problems) = syntax::parse(&source.text);
    if Diagnostics::has_errors(&problems) {
        // A line that cannot be parsed has no canonical form. Printing only the other lines would lose it.
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

fn convert(args: &Args, console: &Console) -> Answer {
    let (source, own_levels) = dialect_source(&args.game)?;
    let converted = dialect::convert(&source.text);
    let levels = if converted.levels.is_empty() { own_levels } else { converted.levels };
    let draft = args.out.as_deref().map(protected::draft).transpose()?;
    if let Some(draft) = draft {
        draft.write("game.vgdl", converted.text.as_bytes())?;
        for (number, level) in levels.iter().enumerate() {
            draft.write(&format!("lvl{number}.txt"), level.as_bytes())?;
        }
        draft.commit()?;
    }
    let (name, left) = (&source.name, &converted.problems);
    let marked = Named { name: name.clone(), text: converted.source };
    let changes = converted.changes.iter();
    let changed: Vec<_> =
        changes.map(|change| json!({ "line": change.line, "from": change.from, "to": change.to })).collect();
    console.document(&json!({
        "file": name,
        "text": converted.text,
        "levels": levels,
        "changes": changed,
        "left": diagnostics::placed(&marked, left),
        "out": args.out.as_deref().map(paths::in_json),
    }))?;
    for change in &converted.changes {
        console.remark(format_args!("{name}:{}: `{}` becomes: {}", change.line, change.from, change.to));
    }
    for problem in left {
        let line = engine::line_and_column(&marked.text, problem.span.start).0;
        let help = problem.help.as_ref().map_or(String::new(), |help| format!("; {help}"));
        console.remark(format_args!("{name}:{line}: not converted: {}{help}", problem.message));
    }
    match &args.out {
        Some(out) => {
            let out = out.in_message();
            console.say(format_args!("{out}: the game and {} of its levels", levels.len()));
        }
        None => {
            console.file(&converted.text);
            if !levels.is_empty() && Path::new(&args.game).is_file() {
                console.remark(format_args!(
                    "the levels are not printed; --out DIR writes the game and its levels ({})",
                    levels.len()
                ));
            }
        }
    }
    Ok(left.is_empty())
}

/// Converts a game's text from a different dialect, together with the levels beside it.
fn dialect_source(name: &str) -> Result<(Named, Vec<String>), Failure> {
    let path = Path::new(name);
    if path.is_file() {
        let text = read_text(path, MAX_SOURCE)?;
        if dialect::python_file(&text).is_some() {
            return Ok((Named { name: name.to_owned(), text }, Vec::new()));
        }
    }
    let input: GameInput = input::game(name)?;
    let levels = input.levels()?.into_iter().map(|level| level.text).collect();
    Ok((input.source, levels))
}
