//! Measures and similarity of the levels that games come with: our own and, if they are available, public ones.

use engine::{Analysis, Game, Level};
use generators::levels::{LevelMeasures, LevelSimilarity};
use std::path::{Path, PathBuf};

/// The folders in a folder beside this crate, sorted; empty, with a message, if it is missing.
#[allow(clippy::print_stderr, reason = "a skipped test says so")]
fn folders(path: &str) -> Vec<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    let Ok(entries) = std::fs::read_dir(&path) else {
        eprintln!("SKIPPED: there is no folder {}", path.display());
        return Vec::new();
    };
    let mut folders: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    folders.sort();
    folders
}

/// The game in a folder with its levels, if the engine can play it.
fn game_in(folder: &Path) -> Option<(Game, Vec<Level>)> {
    let sources = ["game.vgdl", "game.txt"].map(|name| std::fs::read_to_string(folder.join(name)));
    let game = Game::from_source(&sources.into_iter().find_map(Result::ok)?).ok()?;
    let texts = (0..5).filter_map(|at| std::fs::read_to_string(folder.join(format!("lvl{at}.txt"))).ok());
    let levels = texts.filter_map(|text| game.level(&text).ok()).collect();
    Some((game, levels))
}

/// A level after a quarter turn.
fn turned(game: &Game, level: &Level) -> Option<Level> {
    let row = |x: usize| {
        (0..level.rows()).map(move |y| level.cells()[(level.rows() - 1 - y) * level.columns() + x])
    };
    let rows: Vec<String> = (0..level.columns()).map(|x| row(x).map(char::from).collect()).collect();
    game.level(&rows.join("\n")).ok()
}

fn check(folders: Vec<PathBuf>) {
    for folder in folders {
        let Some((game, levels)) = game_in(&folder) else { continue };
        let analysis = Analysis::of(&game);
        let likeness = LevelSimilarity::of(&analysis);
        let name = folder.display();
        for level in &levels {
            if let Some(measures) = LevelMeasures::new(&analysis) {
                let measures = measures.of(level);
                assert!(measures.iter().all(|measure| (0.0..=1.0).contains(measure)), "{name}: {measures:?}");
            }
            if let Some(turned) = turned(&game, level) {
                assert_eq!(likeness.digest(level), likeness.digest(&turned), "{name}");
                assert_eq!(likeness.distance(level, &turned), 0.0, "{name}");
            }
        }
        for (at, one) in levels.iter().enumerate() {
            for two in &levels[..at] {
                let distance = likeness.distance(one, two);
                assert!((0.0..=1.0).contains(&distance), "{name}: {distance}");
                assert_eq!(distance, likeness.distance(two, one), "{name}");
                if likeness.digest(one) == likeness.digest(two) {
                    assert_eq!(distance, 0.0, "{name}");
                }
            }
        }
    }
}

#[test]
fn levels_of_our_own_games() {
    check(folders("../corpora"));
}

#[test]
fn levels_of_public_games() {
    check(folders("../../shared/gvgai/games"));
}
