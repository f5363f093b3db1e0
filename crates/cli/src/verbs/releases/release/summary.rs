//! The human-readable answer of `arcade release`.

use crate::shell;
use base::MessagePath;
use base::count;
use forge::card::{Card, Origin};
use itertools::Itertools;
use snapshots::mint::Minted;
use snapshots::{Manifest, Recipe};
use std::ffi::OsStr;
use std::fmt::Write;
use std::path::Path;

/// Returns a description of the minted release.
pub(super) fn summary(minted: &Minted, recipe: &Recipe, out: &Path, seconds: Option<f64>) -> String {
    let Minted { manifest, cards, card } = minted;
    let tally = &card.tally;
    let levels: usize = cards.iter().map(|card| card.levels.len()).sum();
    let mut text = String::new();
    let (made, with) = (count(cards.len(), "game"), count(levels, "level"));
    let _ = writeln!(text, "{}: {made}, {with}, each with a winning episode\n", manifest.name);
    let width = cards.iter().map(|card| card.title.chars().count()).max().unwrap_or(0);
    for card in cards {
        let origin = match card.origin {
            Origin::Generated { .. } => "new game",
            Origin::Corpus { .. } => "new levels",
        };
        let Card { title, kind, goal, levels, .. } = card;
        let ticks = levels.iter().map(|level| level.witness_ticks).join(", ");
        let _ = writeln!(text, "  {title:<width$}  {kind:<18} {origin:<11} won in {ticks} ticks");
        let _ = writeln!(text, "  {:<width$}  {goal}", "");
    }
    if let Some(board) = example_board(minted, out) {
        let _ = writeln!(text, "\n{board}");
    }
    for bin in &card.planned {
        let _ = writeln!(text, "{}: {} (planned {} to {})", bin.name, bin.there, bin.least, bin.most);
    }
    let time = seconds.map_or(String::new(), |seconds| format!("{seconds:.0} s; "));
    let (games, tried) = (tally.games_tried, tally.levels_tried);
    let _ = writeln!(
        text,
        "\n{time}{games} games and {tried} levels tried for {} and {levels}; {:.1} million forward-model calls",
        cards.len(),
        tally.calls as f64 / 1e6,
    );
    if !tally.rejections.is_empty() {
        let _ = writeln!(text, "rejected: {}", tally.reasons());
    }
    let _ = writeln!(text, "\nroot {}\nin   {}", manifest.root, out.in_message());
    for caveat in recipe.caveats() {
        let _ = writeln!(text, "note: {caveat}");
    }
    let public = if manifest.commitment.is_some() { out.join("public") } else { out.to_owned() };
    let of_release = |verb: &str| shell::command([OsStr::new(verb), public.as_os_str()]);
    let _ = writeln!(text, "check it:       {}", of_release("verify"));
    if manifest.commitment.is_none() {
        let pool = if recipe.designs.is_some() { " --designs DIR" } else { "" };
        let _ = writeln!(text, "mint it again:  {}{pool}", of_release("regenerate"));
    }
    let entered = [OsStr::new("--release"), public.as_os_str()];
    let beacon = ["--beacon", "FILE"].map(OsStr::new);
    let beacon = beacon.into_iter().filter(|_| recipe.beacon.is_some());
    let _ = writeln!(text, "to publish it, sign it:  {}", sign_command(&public));
    let _ = writeln!(text, "then append it to a log:  {}", log_command(beacon.chain(entered)));
    if manifest.commitment.is_some() {
        let _ = writeln!(text, "then publish:   {}", public.in_message());
        let _ = writeln!(text, "keep private until the reveal: {}", out.join("held").in_message());
    }
    text
}

/// Returns the command that signs a release with its publisher's key.
pub(crate) fn sign_command(release: &Path) -> String {
    let flags = ["--secret", "NAME.key"].map(OsStr::new);
    shell::command([OsStr::new("trust"), OsStr::new("sign"), release.as_os_str()].into_iter().chain(flags))
}

/// Returns the command that appends an item to the log in the folder `log`. A new log also requires an
/// origin.
pub(super) fn log_command<'a>(what: impl IntoIterator<Item = &'a OsStr>) -> String {
    let origin = ["--origin", "example.org/arcade"].into_iter().filter(|_| !Path::new("log").exists());
    let command = ["trust", "log", "append", "log", "--secret", "log.key"].into_iter().chain(origin);
    shell::command(command.map(OsStr::new).chain(what))
}

/// Returns the shortest answer: the release's contents, root and path.
pub(super) fn in_short(minted: &Minted, out: &Path) -> String {
    let levels: usize = minted.cards.iter().map(|card| card.levels.len()).sum();
    let (games, levels) = (count(minted.cards.len(), "game"), count(levels, "level"));
    let Manifest { name, root, .. } = &minted.manifest;
    format!("{name}: {games}, {levels}; root {root} in {}", out.in_message())
}

/// Returns one of the new levels as text, as an example; `None` if there is no new level.
fn example_board(minted: &Minted, out: &Path) -> Option<String> {
    let new = |card: &&Card| matches!(card.origin, Origin::Generated { .. });
    let card = minted.cards.iter().find(new).or_else(|| minted.cards.first())?;
    let last = card.levels.last()?;
    let root = if minted.manifest.commitment.is_some() { out.join("public") } else { out.to_owned() };
    let board = std::fs::read_to_string(root.join("games").join(&card.id).join(&last.file)).ok()?;
    let rows: Vec<String> = board.lines().map(|row| format!("    {row}")).collect();
    Some(format!("  {}, level {}:\n{}", card.title, card.levels.len() - 1, rows.join("\n")))
}
