//! The settings file `evaluation.json`, written before the first episode.

use crate::commitment::Commitment;
use crate::error::EvaluationError;
use crate::run::text::{RESTORE, read_text};
use crate::subject::{Subject, SubjectFacts, Unreadable};
use crate::track::Track;
use base::Digest;
use engine::{MAX_LEVEL_TEXT, MAX_SOURCE};
use itertools::Itertools;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The version of the results folder format.
pub const FORMAT: u32 = 1;
/// The name of the settings file in a results folder.
pub const SETTINGS_FILE: &str = "evaluation.json";

/// The maximum number of episodes in an evaluation, counted over all levels.
pub const MAX_EPISODES: u64 = 1_000_000;
/// The maximum number of actions per episode that can be requested. No game lasts longer.
pub const MAX_DECISIONS: u64 = 1_000_000;
/// The maximum size of [`SETTINGS_FILE`], in bytes.
pub(crate) const MAX_SETTINGS: usize = 1 << 26;

/// An evaluation's settings: exactly the inputs that determine its results. Resuming an evaluation requires
/// the same settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// The format version ([`FORMAT`]).
    pub format: u32,
    /// The version of the engine's semantics ([`engine::SEMANTICS`]).
    pub semantics: u32,
    /// The version of the suite that created the folder.
    pub suite: String,
    /// The root digest of the games' snapshot, if the games come from a snapshot.
    pub snapshot: Option<Digest>,
    /// The evaluation's player.
    pub entrant: Entrant,
    /// The text from which the seeds of all episodes are derived. Each seed depends only on this text, the
    /// game, the level and the run.
    pub seed: String,
    /// The number of episodes per level.
    pub runs: u64,
    /// The maximum number of actions per episode.
    pub max_steps: u64,
    /// The number of actions that the player commits to at each decision.
    #[serde(default, skip_serializing_if = "Commitment::is_one")]
    pub commit: Commitment,
    /// The maximum number of output tokens per answer, including reasoning, if the user has set it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_output_tokens: Option<u32>,
    /// The track (bundle of prompt settings) with its version, such as `masked@1`, or `None` for custom prompts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub track: Option<String>,
    /// The maximum number of levels of a game that are played in one conversation.
    #[serde(default = "alone", skip_serializing_if = "is_alone")]
    pub series: u64,
    /// The settings for adaptive level selection, or `None` to play all levels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub adaptive: Option<Adaptive>,
    /// The games in the evaluation.
    pub games: Vec<SubjectEntry>,
}

/// The settings for adaptive level selection. The scale and the recorded outcomes of earlier episodes
/// determine the next levels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Adaptive {
    /// The scale file's digest.
    pub scale: Digest,
    /// The maximum number of episodes.
    pub episodes: u64,
    /// The target standard error of the ability, if set. The evaluation ends when it is reached.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error: Option<f64>,
    /// The number of episodes chosen per batch.
    pub batch: u64,
}

/// Returns the length of a series with a single level, which is 1.
fn alone() -> u64 {
    1
}

fn is_alone(series: &u64) -> bool {
    *series == alone()
}

/// The player and the settings of its observations.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entrant {
    /// The player's name in tables.
    pub name: String,
    /// The mode, `zero-shot` or `contextual`, or `None` for players that are not models.
    pub mode: Option<String>,
    /// The differences between the player's prompts and the default prompts, as sorted flags. They identify
    /// the variants in an ablation.
    pub aids: Vec<String>,
    /// All inputs that determine the player's requests and answers, such as the model, the server, the
    /// decoding, the prompt settings and their digests.
    pub details: serde_json::Value,
}

/// A game in an evaluation.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SubjectEntry {
    /// The name of the game's folder in `games/`.
    pub id: String,
    /// The game's digest.
    pub digest: Digest,
    /// The known facts about the game.
    pub facts: SubjectFacts,
    /// The levels to play.
    pub levels: Vec<LevelEntry>,
}

/// A level in an evaluation.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LevelEntry {
    /// The level's number in the game.
    pub number: usize,
    /// The level's digest.
    pub digest: Digest,
    /// The length of the shortest win in ticks, if it was proved to be optimal.
    pub optimal_ticks: Option<usize>,
}

impl Settings {
    /// Returns a warning, such as `38 of 54 levels have no known win within 40 steps`, if some levels have no known win
    /// within the step limit.
    pub fn out_of_reach(&self) -> Option<String> {
        let of_level = |game: &SubjectEntry, number: usize| game.facts.known_wins.get(&number).copied();
        let levels = self.games.iter().flat_map(|game| game.levels.iter().map(move |level| (game, level)));
        let (all, wins): (Vec<_>, Vec<_>) =
            levels.map(|(game, level)| ((), of_level(game, level.number))).unzip();
        let beyond = wins.iter().flatten().filter(|&&ticks| ticks > self.max_steps);
        let (count, longest) = (beyond.clone().count(), beyond.max()?);
        let (all, limit) = (all.len(), self.max_steps);
        let limit_in_words = if limit == 1 { "1 step".to_owned() } else { format!("{limit} steps") };
        let have = if all == 1 { "level has" } else { "levels have" };
        Some(format!(
            "{count} of {all} {have} no known win within {limit_in_words}; the shortest known wins take up to {longest} steps"
        ))
    }

    /// Sets the track (bundle of prompt settings) and its series length, and adds the track to the differences that
    /// distinguish the player in tables.
    ///
    /// # Errors
    /// Returns an error if a game has too few levels for a series.
    pub fn on_track(mut self, track: Track) -> Result<Settings, String> {
        (self.track, self.series) = (Some(track.id()), track.series());
        self.entrant.aids.push(track.aid());
        self.entrant.aids.sort();
        match self.games.iter().find(|game| track.series() > 1 && game.levels.len() < 2) {
            Some(game) => Err(format!(
                "the track `{}` requires at least two levels per game, one of them for practice; `{}` has \
                 {}: choose other games or levels with --games and --levels",
                track.name(),
                game.id,
                game.levels.len()
            )),
            None => Ok(self),
        }
    }

    /// Checks that the settings stay within their limits, and that every game and level is listed only once.
    /// The limits bound the size of results folders, to protect programs that read them.
    ///
    /// # Errors
    /// Returns a message that states the value that is out of range, or the game or level that is listed
    /// twice.
    pub fn check(&self) -> Result<(), String> {
        let levels: u64 = self.games.iter().map(|game| game.levels.len() as u64).sum();
        let episodes = self.runs.checked_mul(levels).filter(|&episodes| episodes <= MAX_EPISODES);
        if self.runs == 0 || self.runs > MAX_EPISODES || episodes.is_none() {
            let runs = self.runs;
            return Err(format!(
                "`runs` is {runs} on {levels} levels, but an evaluation must have 1 to {MAX_EPISODES} episodes in total"
            ));
        }
        if !(1..=MAX_DECISIONS).contains(&self.max_steps) {
            let max_steps = self.max_steps;
            return Err(format!("`max_steps` is {max_steps}, but must be from 1 to {MAX_DECISIONS}"));
        }
        if let Some(id) = self.games.iter().map(|game| &game.id).duplicates().next() {
            return Err(format!("the game `{id}` is listed twice"));
        }
        for game in &self.games {
            if let Some(number) = game.levels.iter().map(|level| level.number).duplicates().next() {
                return Err(format!("level {number} of `{}` is listed twice", game.id));
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

    /// Reads the game from its texts in a results folder.
    ///
    /// # Errors
    /// Returns an error if the texts are missing, do not compile, or differ from the texts that were played.
    pub(crate) fn read(&self, results: &Path) -> Result<Subject, EvaluationError> {
        let folder = results.join("games").join(&self.id);
        let source = read_text(&folder.join("game.vgdl"), MAX_SOURCE, RESTORE)?;
        let level = |level: &LevelEntry| {
            let text = read_text(&folder.join(format!("lvl{}.txt", level.number)), MAX_LEVEL_TEXT, RESTORE)?;
            Ok((level.number, text, level.optimal_ticks))
        };
        let levels = self.levels.iter().map(level).collect::<Result<Vec<_>, EvaluationError>>()?;
        let changed = |what: &str| {
            let what = format!(
                "{what} has changed since this evaluation started; restore the results folder, or start a new \
                 evaluation"
            );
            EvaluationError::malformed(&folder, what)
        };
        let unreadable = |Unreadable { level, .. }: Unreadable| {
            changed(&level.map_or("game.vgdl".to_owned(), |number| format!("lvl{number}.txt")))
        };
        let subject = Subject::read(&self.id, &source, &levels, self.facts.clone()).map_err(unreadable)?;
        if subject.game.digest() != self.digest {
            return Err(changed("game.vgdl"));
        }
        let mut levels = self.levels.iter().zip(&subject.levels);
        match levels.find(|(entry, level)| entry.digest != level.level.digest()) {
            Some((entry, _)) => Err(changed(&format!("lvl{}.txt", entry.number))),
            None => Ok(subject),
        }
    }
}
