//! `evaluation.json`: what was asked, written before the first episode.

use crate::error::EvaluationError;
use crate::run::text::read_text;
use crate::subject::{Subject, SubjectFacts, Unreadable};
use engine::{Digest, MAX_LEVEL_TEXT, MAX_SOURCE};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::path::Path;

/// The version of the results folder.
pub const FORMAT: u32 = 1;
/// The file with the settings in a results folder.
pub const SETTINGS_FILE: &str = "evaluation.json";

/// Episodes of an evaluation at most, on all levels together.
pub const MAX_EPISODES: u64 = 1_000_000;
/// Decisions of an episode that may be asked for at most. No game takes as many ticks.
pub const MAX_DECISIONS: u64 = 1_000_000;
/// Bytes of [`SETTINGS_FILE`] at most.
pub(crate) const MAX_SETTINGS: usize = 1 << 26;

/// What was asked of an evaluation: all that decides its results, and nothing else. Resuming compares it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// [`FORMAT`].
    pub format: u32,
    /// [`engine::SEMANTICS`].
    pub semantics: u32,
    /// Version of the suite.
    pub suite: String,
    /// Root digest of the snapshot that the games are from, if they are from one.
    pub snapshot: Option<Digest>,
    /// Who plays.
    pub entrant: Entrant,
    /// Text that the seeds of all episodes come from. Nothing but this, the game, the level and the run decides them.
    pub seed: String,
    /// Episodes on each level.
    pub runs: u64,
    /// Decisions of an episode at most.
    pub max_steps: u64,
    /// What is played.
    pub games: Vec<SubjectEntry>,
}

/// Who plays, and what it is shown.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entrant {
    /// What tables call it.
    pub name: String,
    /// `zero-shot` or `contextual`; none for players that are no models.
    pub mode: Option<String>,
    /// What it is shown beyond or short of the default, a flag each, sorted; for ablations.
    pub aids: Vec<String>,
    /// All that decides what it is asked and how it answers: model, server, decoding, prompt settings and digests.
    pub details: serde_json::Value,
}

/// A game of an evaluation.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SubjectEntry {
    /// Folder in `games/`.
    pub id: String,
    /// The game's digest.
    pub digest: Digest,
    /// What is known of it.
    pub facts: SubjectFacts,
    /// Its levels that are played.
    pub levels: Vec<LevelEntry>,
}

/// A level of an evaluation.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LevelEntry {
    /// Its number in the game.
    pub number: usize,
    /// The level's digest.
    pub digest: Digest,
    /// Ticks of the shortest win, where it is proved that no fewer win.
    pub optimal_ticks: Option<usize>,
}

impl Settings {
    /// Checks that what is asked for stays within limits, and names every game and level once. Whoever reads a results folder knows
    /// then how much there can be.
    ///
    /// # Errors
    /// It does not; in words, with the number that is too large.
    pub fn check(&self) -> Result<(), String> {
        let levels: u64 = self.games.iter().map(|game| game.levels.len() as u64).sum();
        let episodes = self.runs.checked_mul(levels).filter(|&episodes| episodes <= MAX_EPISODES);
        if self.runs == 0 || self.runs > MAX_EPISODES || episodes.is_none() {
            let runs = self.runs;
            return Err(format!(
                "`runs` is {runs}, on {levels} levels; an evaluation has 1 to {MAX_EPISODES} episodes in all"
            ));
        }
        if !(1..=MAX_DECISIONS).contains(&self.max_steps) {
            let max_steps = self.max_steps;
            return Err(format!("`max_steps` is {max_steps}; an episode has 1 to {MAX_DECISIONS} decisions"));
        }
        let mut ids = BTreeSet::new();
        if let Some(twice) = self.games.iter().find(|game| !ids.insert(&game.id)) {
            return Err(format!("the game `{}` is listed twice", twice.id));
        }
        for game in &self.games {
            let mut numbers = BTreeSet::new();
            if let Some(twice) = game.levels.iter().find(|level| !numbers.insert(level.number)) {
                return Err(format!("level {} of `{}` is listed twice", twice.number, game.id));
            }
        }
        Ok(())
    }
}

impl SubjectEntry {
    pub(crate) fn of(subject: &Subject) -> SubjectEntry {
        let level = |level: &crate::SubjectLevel| LevelEntry {
            number: level.number,
            digest: level.level.digest(),
            optimal_ticks: level.optimal_ticks,
        };
        SubjectEntry {
            id: subject.id.clone(),
            digest: subject.game.digest(),
            facts: subject.facts.clone(),
            levels: subject.levels.iter().map(level).collect(),
        }
    }

    /// The game again, from the texts in a results folder.
    ///
    /// # Errors
    /// They are missing, do not compile, or are not the ones that were played.
    pub(crate) fn read(&self, results: &Path) -> Result<Subject, EvaluationError> {
        let folder = results.join("games").join(&self.id);
        let source = read_text(&folder.join("game.vgdl"), MAX_SOURCE)?;
        let level = |level: &LevelEntry| {
            let text = read_text(&folder.join(format!("lvl{}.txt", level.number)), MAX_LEVEL_TEXT)?;
            Ok((level.number, text, level.optimal_ticks))
        };
        let levels = self.levels.iter().map(level).collect::<Result<Vec<_>, EvaluationError>>()?;
        let changed = |what: &str| {
            let folder = folder.display();
            EvaluationError::Malformed(format!(
                "{folder}: {what} is not the one that was played; get the results folder again"
            ))
        };
        let unreadable = |Unreadable { level, .. }: Unreadable| {
            changed(&level.map_or("game.vgdl".to_owned(), |number| format!("lvl{number}.txt")))
        };
        let subject = Subject::read(&self.id, &source, &levels, self.facts.clone()).map_err(unreadable)?;
        if subject.game.digest() != self.digest {
            return Err(changed("game.vgdl"));
        }
        let wrong = self
            .levels
            .iter()
            .zip(&subject.levels)
            .find(|(entry, level)| entry.digest != level.level.digest());
        match wrong {
            Some((entry, _)) => Err(changed(&format!("lvl{}.txt", entry.number))),
            None => Ok(subject),
        }
    }
}
