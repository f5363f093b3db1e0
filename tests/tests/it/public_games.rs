//! The diagnostics that strict loading reports for the reference's public games, as recorded in
//! `tests/ref/strict-diagnostics.txt`.
//!
//! The games are test data outside the repository. Without the games, the test prints a note and passes.
//! `BLESS=1 cargo test -p infinite-arcade-tests --test it public_games` rewrites the file. Review the file's diff as
//! you would review code.

use engine::{Diagnostic, Game, Severity, line_and_column};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use tests::{public_games, read, workspace_root};

#[test]
fn strict_diagnostics_are_as_pinned() {
    let Some(games) = public_games() else { return };
    let mut text = String::new();
    for folder in sorted(&games) {
        let name = folder.file_name().unwrap().to_string_lossy().into_owned();
        let source = fs::read_to_string(folder.join("game.txt")).unwrap();
        let game = Game::from_source(&source);
        let problems = game.as_ref().map_or_else(|problems| problems.0.as_slice(), Game::warnings);
        report(&mut text, &format!("{name}/game.txt"), &source, problems);
        let Ok(game) = game else { continue };
        for file in sorted(&folder) {
            let file_name = file.file_name().unwrap().to_string_lossy().into_owned();
            if file_name.starts_with("lvl") {
                let source = fs::read_to_string(&file).unwrap();
                let problems =
                    game.level(&source).map_or_else(|problems| problems.0, |level| level.warnings().to_vec());
                report(&mut text, &format!("{name}/{file_name}"), &source, &problems);
            }
        }
    }
    let pinned = workspace_root().join("tests/ref/strict-diagnostics.txt");
    if std::env::var_os("BLESS").is_some() {
        fs::write(pinned, text).unwrap();
        return;
    }
    let expected = read("tests/ref/strict-diagnostics.txt");
    for (line, expected) in text.lines().zip(expected.lines()) {
        assert_eq!(line, expected);
    }
    assert_eq!(text.lines().count(), expected.lines().count());
}

#[test]
fn every_public_game_and_level_loads_as_the_reference_loads_it() {
    let Some(games) = public_games() else { return };
    let mut levels = 0;
    for folder in sorted(&games) {
        let source = fs::read_to_string(folder.join("game.txt")).unwrap();
        let game = Game::from_source_as_reference(&source)
            .unwrap_or_else(|problems| panic!("{folder:?}: {problems}"));
        for file in sorted(&folder).iter().filter(|file| file.to_string_lossy().contains("lvl")) {
            let text = fs::read_to_string(file).unwrap();
            game.level(&text).unwrap_or_else(|problems| panic!("{file:?}: {problems}"));
            levels += 1;
        }
    }
    assert!(levels > 500, "{levels} levels");
}

fn report(text: &mut String, file: &str, source: &str, problems: &[Diagnostic]) {
    for problem in problems {
        let (line, column) = line_and_column(source, problem.span.start);
        let severity = if problem.severity == Severity::Error { "error" } else { "warning" };
        writeln!(text, "{file}:{line}:{column}: {severity}[{}]: {}", problem.code, problem.message).unwrap();
    }
}

fn sorted(folder: &Path) -> Vec<PathBuf> {
    let mut paths: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}
