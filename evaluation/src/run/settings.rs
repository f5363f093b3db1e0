//! `evaluation.json`: what was asked, written before the first episode.

use crate::error::EvaluationError;
use crate::subject::{Subject, SubjectFacts, Unreadable};
use engine::Digest;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The version of the results folder.
pub const FORMAT: u32 = 1;
/// The file with the settings in a results folder.
pub const SETTINGS_FILE: &str = "evaluation.json";

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
        let read = |name: &str| {
            let path = folder.join(name);
            std::fs::read_to_string(&path).map_err(EvaluationError::io("read", &path))
        };
        let source = read("game.vgdl")?;
        let level = |level: &LevelEntry| {
            Ok((level.number, read(&format!("lvl{}.txt", level.number))?, level.optimal_ticks))
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
