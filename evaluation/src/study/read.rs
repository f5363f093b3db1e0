//! Reading a study from results folders.

use crate::error::EvaluationError;
use crate::log::Event;
use crate::metrics::EpisodeMetrics;
use crate::run::{Evaluation, Task};
use crate::study::{Player, Study, StudyGame};
use crate::subject::Subject;
use engine::Digest;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The logs of episodes, each with its game.
pub type PlayedLogs<'a> = Vec<(&'a Subject, Vec<Event>)>;

impl Study {
    /// Reads a study from results folders. Every episode is replayed from its log. Folders of the same player (name, mode
    /// and aids) are merged. Cost: that of [`replay`](crate::metrics::replay) for each episode, on the threads of the
    /// current rayon pool.
    ///
    /// # Errors
    /// A folder or log cannot be read, a replay differs from its log, two folders hold the same episode of the same player,
    /// or the same name stands for different games or levels.
    pub fn read(folders: &[PathBuf]) -> Result<Study, EvaluationError> {
        let mut results: Vec<(Player, Vec<EpisodeMetrics>)> = Vec::new();
        let mut names = Names::default();
        let (mut notes, mut seeds) = (Vec::new(), BTreeSet::new());
        for folder in folders {
            let evaluation = Evaluation::open(folder)?;
            let player = Player::from(&evaluation.settings.entrant);
            evaluation.subjects.iter().try_for_each(|subject| names.add(subject, folder))?;
            seeds.insert(evaluation.settings.seed.clone());
            let tasks = evaluation.tasks();
            evaluation.check_logs(&tasks)?;
            // Nothing is kept of episodes that were not started.
            let measured = tasks.par_iter().filter_map(|task| measured(&evaluation, task).transpose());
            let measured = measured.collect::<Result<Vec<EpisodeMetrics>, EvaluationError>>()?;
            let open = tasks.len() - measured.len();
            if open > 0 {
                notes.push(format!(
                    "{open} of {} episodes of {} were not started.",
                    tasks.len(),
                    player.label()
                ));
            }
            names.claim(&player, measured.iter(), folder)?;
            results.push((player, measured));
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
    games: Vec<(StudyGame, Digest, BTreeMap<usize, Digest>)>,
    episodes: BTreeMap<(Player, String, usize, u64), PathBuf>,
}

impl Names {
    fn add(&mut self, subject: &Subject, folder: &Path) -> Result<(), EvaluationError> {
        let levels = subject.levels.iter().map(|level| (level.number, level.level.digest()));
        let Some((game, digest, known)) = self.games.iter_mut().find(|(game, ..)| game.id == subject.id)
        else {
            self.games.push((StudyGame::from(subject), subject.game.digest(), levels.collect()));
            return Ok(());
        };
        let differs = |what: String| {
            let what = format!("its {what} `{}` differs from that of an earlier folder", subject.id);
            EvaluationError::malformed(folder, format!("{what}; report on them separately"))
        };
        if *digest != subject.game.digest() {
            return Err(differs("game".to_owned()));
        }
        for (number, digest) in levels {
            if *known.entry(number).or_insert(digest) != digest {
                return Err(differs(format!("level {number} of")));
            }
        }
        for level in StudyGame::from(subject).levels {
            if game.levels.iter().all(|known| known.number != level.number) {
                game.levels.push(level);
            }
        }
        game.levels.sort_by_key(|level| level.number);
        Ok(())
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
        self.games.iter().map(|(game, ..)| game.clone()).collect()
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
