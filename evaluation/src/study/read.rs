//! Reading a study from results folders.

use crate::error::EvaluationError;
use crate::log::Event;
use crate::mask;
use crate::metrics::EpisodeMetrics;
use crate::run::{Evaluation, Task};
use crate::study::person::{PersonResults, told_apart};
use crate::study::{Player, Study, StudyGame};
use crate::subject::{Subject, SubjectLevel};
use engine::{Digest, StateHash};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The logs of episodes, each with its game.
pub type PlayedLogs<'a> = Vec<(&'a Subject, Vec<Event>)>;

impl Study {
    /// Reads a study from results folders. Every episode is replayed from its log. Folders of the same person (name, mode,
    /// aids, prompts, decoding, version served) are merged. Games of one id with the same rules under
    /// other names, and with levels that start in the same states, are one game; their results are of separate players. Cost: that of [`replay`](crate::metrics::replay) for each episode, on the threads of the
    /// current rayon pool.
    ///
    /// # Errors
    /// A folder or log cannot be read, a replay differs from its log, two folders hold the same episode of the same player,
    /// or the same name stands for different games or levels.
    pub fn read(folders: &[PathBuf]) -> Result<Study, EvaluationError> {
        let mut results: Vec<PersonResults> = Vec::new();
        let mut names = Names::default();
        let (mut notes, mut seeds, mut origins) = (Vec::new(), BTreeSet::new(), Vec::new());
        for (place, folder) in folders.iter().enumerate() {
            let evaluation = Evaluation::open(folder)?;
            let player = Player::from(&evaluation.settings.entrant);
            let mut twins: BTreeSet<&str> = BTreeSet::new();
            for subject in &evaluation.subjects {
                if names.add(subject, folder)? {
                    twins.insert(&subject.id);
                }
            }
            seeds.insert(evaluation.settings.seed.clone());
            let tasks = evaluation.tasks();
            evaluation.check_logs(&tasks)?;
            // Nothing is kept of episodes that were not started.
            let measured = tasks.par_iter().filter_map(|task| measured(&evaluation, task).transpose());
            let mut measured = measured.collect::<Result<Vec<EpisodeMetrics>, EvaluationError>>()?;
            measured.iter_mut().for_each(|episode| episode.folder = Some(place));
            let open = tasks.len() - measured.len();
            if open > 0 {
                notes.push(format!(
                    "{open} of {} episodes of {} were not started.",
                    tasks.len(),
                    player.label()
                ));
            }
            let (renamed, own): (Vec<_>, Vec<_>) =
                measured.into_iter().partition(|episode| twins.contains(episode.game.as_str()));
            for (twin, episodes) in [(false, own), (true, renamed)] {
                if !episodes.is_empty() || twin == (twins.len() == evaluation.subjects.len()) {
                    let parts = PersonResults::of(&evaluation.settings.entrant, twin, episodes);
                    origins.extend(parts.iter().map(|_| folder));
                    results.extend(parts);
                }
            }
        }
        let results = told_apart(results);
        for ((player, episodes), folder) in results.iter().zip(origins) {
            names.claim(player, episodes.iter(), folder)?;
        }
        let mut study = Study::new(results, names.games());
        study.notes.extend(notes);
        study.notes.extend(names.unpaired());
        if seeds.len() > 1 {
            study.notes.push(
                "Players had different random seeds (--seed): their episodes are not paired.".to_owned(),
            );
        }
        Ok(study)
    }

    /// Builds a study from episodes in memory: each player with its logs and their games.
    ///
    /// # Errors
    /// A replay differs from its log.
    pub fn of_logs(results: Vec<(Player, PlayedLogs<'_>)>) -> Result<Study, EvaluationError> {
        let mut games: Vec<StudyGame> = Vec::new();
        let mut measured = Vec::new();
        for (player, logs) in results {
            let mut episodes = Vec::new();
            for (subject, log) in &logs {
                if games.iter().all(|game| game.id != subject.id) {
                    games.push(StudyGame::from(*subject));
                }
                let metrics = EpisodeMetrics::of(subject, log);
                episodes.push(
                    metrics
                        .map_err(|error| EvaluationError::Malformed(format!("{}: {error}", subject.id)))?,
                );
            }
            measured.push((player, episodes));
        }
        Ok(Study::new(measured, games))
    }
}

/// The games and levels by name in the folders so far.
#[derive(Default)]
struct Names {
    games: Vec<KnownGame>,
    episodes: BTreeMap<(Player, String, usize, u64), PathBuf>,
}

/// A game of the folders so far, with the digests of its text and of the texts and first states of its levels.
struct KnownGame {
    game: StudyGame,
    digest: Digest,
    levels: BTreeMap<usize, Digest>,
    starts: BTreeMap<usize, StateHash>,
    /// The digest of the rules without names.
    nameless: Digest,
}

impl Names {
    /// Adds a game. Returns `true` if it is one of an earlier folder under other names: with the same rules, and levels that
    /// start in the same states.
    fn add(&mut self, subject: &Subject, folder: &Path) -> Result<bool, EvaluationError> {
        let levels = subject.levels.iter().map(|level| (level.number, level.level.digest()));
        let start = |level: &SubjectLevel| (level.number, subject.first_state(level));
        let starts: BTreeMap<usize, StateHash> = subject.levels.iter().map(start).collect();
        let Some(KnownGame { game, digest, levels: known, starts: begun, nameless }) =
            self.games.iter_mut().find(|known| known.game.id == subject.id)
        else {
            let (game, digest) = (StudyGame::from(subject), subject.game.digest());
            let (levels, nameless) = (levels.collect(), mask::nameless(&subject.game));
            self.games.push(KnownGame { game, digest, levels, starts, nameless });
            return Ok(false);
        };
        let differs = |what: String| {
            let what = format!("its {what} `{}` differs from that of an earlier folder", subject.id);
            EvaluationError::malformed(folder, format!("{what}; report on them separately"))
        };
        let is_twin = *digest != subject.game.digest();
        if is_twin {
            let other =
                starts.iter().find(|(number, start)| begun.get(number).is_some_and(|own| own != *start));
            if *nameless != mask::nameless(&subject.game) || other.is_some() {
                return Err(differs("game".to_owned()));
            }
        } else {
            for (number, digest) in levels {
                if *known.entry(number).or_insert(digest) != digest {
                    return Err(differs(format!("level {number} of")));
                }
            }
        }
        for (number, start) in starts {
            begun.entry(number).or_insert(start);
        }
        for level in StudyGame::from(subject).levels {
            if game.levels.iter().all(|known| known.number != level.number) {
                game.levels.push(level);
            }
        }
        game.levels.sort_by_key(|level| level.number);
        Ok(is_twin)
    }

    /// Checks that no other folder has these episodes.
    fn claim<'a>(
        &mut self,
        player: &Player,
        episodes: impl Iterator<Item = &'a EpisodeMetrics>,
        folder: &Path,
    ) -> Result<(), EvaluationError> {
        for EpisodeMetrics { game, level, run, .. } in episodes {
            let key = (player.clone(), game.clone(), *level, *run);
            if let Some(other) = self.episodes.insert(key, folder.to_owned()) {
                let what = format!(
                    "{} also played run {run} of {game} level {level} in {}; rename one of the two players",
                    player.label(),
                    other.display()
                );
                return Err(EvaluationError::malformed(folder, what));
            }
        }
        Ok(())
    }

    fn games(&self) -> Vec<StudyGame> {
        self.games.iter().map(|known| known.game.clone()).collect()
    }

    /// Returns a note if not every player has played every episode.
    fn unpaired(&self) -> Option<String> {
        let mut counts: BTreeMap<(&str, usize, u64), usize> = BTreeMap::new();
        let mut players: Vec<&Player> = Vec::new();
        for (player, game, level, run) in self.episodes.keys() {
            *counts.entry((game, *level, *run)).or_default() += 1;
            if players.last() != Some(&player) {
                players.push(player);
            }
        }
        let all = players.len();
        counts.values().any(|&count| count < all).then(|| {
            "Not every player has played every level the same number of times: means over all levels are comparable only between players that have."
                .to_owned()
        })
    }
}

/// Returns the metrics of an episode, or `None` if it was not started.
fn measured(evaluation: &Evaluation, task: &Task<'_>) -> Result<Option<EpisodeMetrics>, EvaluationError> {
    let log = evaluation.events(task)?;
    if log.is_empty() {
        return Ok(None);
    }
    evaluation.checked(task, &log, || EpisodeMetrics::of(task.subject, &log)).map(Some)
}
