//! The hostile set: games that would exhaust, confuse or crash a careless engine, as files in `tests/suite/hostile/`.
//!
//! A case is `name.vgdl`, usually with a level `name.txt`, and `name.expect`, whose lines are
//!
//! ```text
//! # why the case is there
//! actions: RRDX      letters of the actions, repeated; nothing is done without this line
//! strict: lost after 2001 ticks
//! reference: refused too-large
//! ```
//!
//! The last two lines state the result for each of the two loading policies: the distinct diagnostic codes, or the
//! outcome and the number of ticks played.

use crate::{workspace_files, workspace_root};
use base::Seed;
use engine::{Action, Diagnostics, Game, MAX_TICKS};
use std::fs;
use std::path::PathBuf;

/// The folder of the set, relative to the workspace root.
const FOLDER: &str = "tests/suite/hostile";

/// A case in the hostile set.
#[derive(Clone, Debug)]
pub struct Case {
    /// The file name without its extension.
    pub name: String,
    /// The game's text.
    pub source: String,
    /// The level's text, if the game is expected to load.
    pub level: Option<String>,
    /// The expectation, as lines of text.
    pub expect: String,
}

impl Case {
    /// Returns all cases, sorted by name.
    ///
    /// # Panics
    ///
    /// Panics if a file cannot be read.
    pub fn all() -> Vec<Case> {
        let files = workspace_files().into_iter();
        let games = files.filter(|file| {
            file.starts_with(FOLDER) && file.extension().is_some_and(|extension| extension == "vgdl")
        });
        games.map(|file| Case::load(workspace_root().join(file))).collect()
    }

    fn load(game: PathBuf) -> Case {
        let read = |extension: &str| {
            let file = game.with_extension(extension);
            fs::read_to_string(&file).map_err(|error| format!("{}: {error}", file.display()))
        };
        let must = |extension: &str| read(extension).unwrap_or_else(|error| panic!("{error}"));
        let name = game.file_stem().expect("a case has a name").to_string_lossy().into_owned();
        Case { name, source: must("vgdl"), level: read("txt").ok(), expect: must("expect") }
    }

    /// Writes the case's result into its expectation.
    ///
    /// # Panics
    ///
    /// Panics if the file cannot be written.
    pub fn bless(&self) {
        let file = workspace_root().join(FOLDER).join(&self.name).with_extension("expect");
        fs::write(&file, self.got()).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    }

    /// Returns the expectation, with its results replaced by the actual ones.
    pub fn got(&self) -> String {
        let lines = self.expect.lines().map(|line| match line.split_once(':') {
            Some(("strict", _)) => format!("strict: {}\n", self.end(false)),
            Some(("reference", _)) => format!("reference: {}\n", self.end(true)),
            _ => format!("{line}\n"),
        });
        lines.collect()
    }

    /// Loads the case with one of the two loading policies, and plays it. Returns the result in the form used in
    /// `name.expect`.
    pub fn end(&self, as_reference: bool) -> String {
        let load = if as_reference { Game::from_source_as_reference } else { Game::from_source };
        let game = match load(&self.source) {
            Ok(game) => game,
            Err(problems) => return format!("refused {}", codes(&problems)),
        };
        let Some(level) = &self.level else { return "loads".to_owned() };
        let level = match game.level(level) {
            Ok(level) => level,
            Err(problems) => return format!("level refused {}", codes(&problems)),
        };
        let mut state = game.start(&level, Seed::from_text("hostile"));
        for action in self.actions().into_iter().cycle() {
            // The case is played one tick beyond the reference's limit, so that an endless game is noticed.
            if state.is_over() || state.tick() > MAX_TICKS {
                break;
            }
            game.step(&mut state, action);
        }
        assert_eq!(state.state_hash(), state.state_hash_from_scratch(), "{}", self.name);
        state.recount(&game).unwrap_or_else(|found| panic!("{}: {found}", self.name));
        let outcome = format!("{:?}", state.outcome()).to_lowercase();
        format!("{outcome} after {} ticks", state.tick() + 1)
    }

    /// Returns the player's actions, as an endlessly repeating sequence.
    fn actions(&self) -> Vec<Action> {
        let given = self.expect.lines().find_map(|line| line.strip_prefix("actions: "));
        let letters = given.unwrap_or("N").chars();
        letters
            .map(|letter| match letter {
                'U' => Action::Up,
                'L' => Action::Left,
                'D' => Action::Down,
                'R' => Action::Right,
                'X' => Action::Use,
                _ => Action::Nil,
            })
            .collect()
    }
}

/// Returns the distinct codes in order of position.
fn codes(problems: &Diagnostics) -> String {
    assert!(Diagnostics::has_errors(&problems.0), "refused without an error");
    let mut codes: Vec<&str> = Vec::new();
    for problem in &problems.0 {
        if !codes.contains(&problem.code) {
            codes.push(problem.code);
        }
    }
    codes.join(", ")
}
