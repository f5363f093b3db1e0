//! Corpus games for tests, and episodes with random actions.

use base::Seed;
use engine::{Action, Game, Observation, State};
use evaluation::{Before, Commitment, Subject, SubjectFacts, Turn};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Returns the corpus games, sorted by name.
pub(crate) fn corpus() -> Vec<Subject> {
    let mut folders: Vec<PathBuf> =
        fs::read_dir(root().join("corpora")).unwrap().map(|entry| entry.unwrap().path()).collect();
    folders.sort();
    let games: Vec<Subject> =
        folders.iter().filter(|folder| folder.join("game.vgdl").exists()).map(|f| read(f)).collect();
    assert!(games.len() >= 20, "{} games", games.len());
    games
}

pub(crate) fn game(name: &str) -> Subject {
    read(&root().join("corpora").join(name))
}

fn read(folder: &Path) -> Subject {
    let source = fs::read_to_string(folder.join("game.vgdl")).unwrap();
    subject(folder, &source).unwrap_or_else(|| panic!("{}: faults", folder.display()))
}

/// Builds a game from the given text and the levels in a folder. Returns `None` if the game does not compile.
fn subject(folder: &Path, source: &str) -> Option<Subject> {
    let name = folder.file_name()?.to_string_lossy().into_owned();
    let file = |number: usize| {
        let files = [format!("lvl{number}.txt"), format!("{name}_lvl{number}.txt")];
        files.iter().find_map(|file| fs::read_to_string(folder.join(file)).ok())
    };
    let levels: Vec<_> = (0..).map_while(|at| Some((at, file(at)?, None))).collect();
    Subject::read(&name, source, &levels, SubjectFacts::default()).ok()
}

/// Returns the public games next to the checkout that compile with all their levels. If there are none,
/// prints a message and returns an empty list.
#[allow(dead_code, reason = "not all tests play them")]
pub(crate) fn public_games() -> Vec<Subject> {
    let folder = root().join("../shared/gvgai/games");
    let Ok(games) = fs::read_dir(&folder) else {
        let _ = writeln!(std::io::stderr(), "SKIPPED: no games in {}", folder.display());
        return Vec::new();
    };
    let mut folders: Vec<PathBuf> = games.map(|entry| entry.unwrap().path()).collect();
    folders.sort();
    let read = |folder: &PathBuf| subject(folder, &fs::read_to_string(folder.join("game.txt")).ok()?);
    folders.iter().filter_map(read).collect()
}

/// An episode of random actions, with its observations.
pub(crate) struct Walk<'a> {
    subject: &'a Subject,
    level: usize,
    state: State,
    sampler: base::Sampler,
    number: u64,
    pub(crate) now: Observation,
    pub(crate) before: Option<(Observation, Action, f64)>,
    actions: Vec<Action>,
}

impl<'a> Walk<'a> {
    pub(crate) fn new(subject: &'a Subject, level: usize) -> Walk<'a> {
        let seed = Seed::from_text("prompts").child(&subject.id, level as u64);
        let state = subject.game.start(&subject.levels[level].level, seed);
        let now = subject.game.observe(&state);
        let sampler = seed.child("actions", 0).sampler();
        let actions = actions(&subject.game, &state);
        Walk { subject, level, state, sampler, number: 0, now, before: None, actions }
    }

    pub(crate) fn turn(&self) -> Turn<'_> {
        let before = self.before.as_ref();
        Turn {
            subject: self.subject,
            level: self.level,
            number: self.number,
            limit: 1000,
            commit: Commitment::ONE,
            played: &[],
            observation: &self.now,
            before: before.map(|(seen, action, reward)| Before {
                observation: seen,
                action: *action,
                reward: *reward,
            }),
            actions: &self.actions,
            series: None,
            cause: None,
        }
    }

    /// Plays a random action. Returns `true` if the game goes on.
    pub(crate) fn step(&mut self) -> bool {
        let action = *self.sampler.choose(&self.actions);
        self.play(action)
    }

    /// Plays the given action. Returns `true` if the game goes on.
    pub(crate) fn play(&mut self, action: Action) -> bool {
        let score = self.state.score();
        self.subject.game.step(&mut self.state, action);
        let seen = self.subject.game.observe(&self.state);
        let before = std::mem::replace(&mut self.now, seen);
        self.before = Some((before, action, self.state.score() - score));
        self.actions = actions(&self.subject.game, &self.state);
        self.number += 1;
        !self.state.is_over()
    }
}

fn actions(game: &Game, state: &State) -> Vec<Action> {
    let others = game.actions(state).iter().copied().filter(|action| *action != Action::Nil);
    std::iter::once(Action::Nil).chain(others).collect()
}
