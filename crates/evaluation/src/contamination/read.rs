//! Reads players' episodes on published games and on their withheld siblings (renamed copies).

use crate::error::EvaluationError;
use crate::log::Event;
use crate::metrics::EpisodeMetrics;
use crate::run::{Evaluation, Task};
use crate::study::Player;
use crate::study::players::person::{PersonResults, told_apart};
use base::Digest;
use engine::Action;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The maximum number of initial actions stored per episode.
const KEPT: usize = 64;

/// All finished episodes of one player.
#[derive(Clone, Debug, PartialEq)]
pub struct PlayerEpisodes {
    /// The player who played the episodes.
    pub player: Player,
    /// The finished episodes, by game digest, level digest and run.
    pub episodes: BTreeMap<(Digest, Digest, u64), PlayedEpisode>,
}

/// The result of a finished episode.
#[derive(Clone, Debug, PartialEq)]
pub struct PlayedEpisode {
    /// `true` if the episode was won.
    pub won: bool,
    /// The first actions of the episode.
    pub beginning: Vec<Action>,
}

/// An episode's location in the results folders: the folder's index, the game's name, the level number and
/// the run.
type Place = (usize, String, usize, u64);

/// Reads the episodes in results folders. As in reports, results with different configurations (such as modes or
/// aids) belong to different players, but the games' names make no difference. Every episode is replayed from its
/// log. Aborted and practice episodes do not count.
///
/// # Errors
/// Returns an error if a folder or log cannot be read, if a replay differs from its log, or if two folders
/// contain the same episode of the same player.
pub fn episodes_by_player(folders: &[PathBuf]) -> Result<Vec<PlayerEpisodes>, EvaluationError> {
    let (mut persons, mut known) = (Vec::new(), BTreeMap::new());
    for (number, folder) in folders.iter().enumerate() {
        let evaluation = Evaluation::open(folder)?;
        let tasks = evaluation.tasks();
        evaluation.check_logs(&tasks)?;
        let read = tasks.par_iter().filter_map(|task| read(&evaluation, task).transpose());
        let mut episodes = Vec::new();
        for (mut metrics, beginning) in read.collect::<Result<Vec<_>, EvaluationError>>()? {
            metrics.folder = Some(number);
            let game = evaluation.settings.games.iter().find(|game| game.id == metrics.game);
            let level = game.and_then(|game| game.levels.iter().find(|level| level.number == metrics.level));
            let (Some(game), Some(level)) = (game, level) else { continue };
            let place: Place = (number, metrics.game.clone(), metrics.level, metrics.run);
            known.insert(place, (game.digest, level.digest, beginning));
            episodes.push(metrics);
        }
        persons.extend(PersonResults::of(&evaluation.settings.entrant, None, episodes));
    }
    let mut players: BTreeMap<Player, BTreeMap<(Digest, Digest, u64), PlayedEpisode>> = BTreeMap::new();
    for (player, episodes) in told_apart(persons) {
        let own = players.entry(player.clone()).or_default();
        for metrics in episodes
            .into_iter()
            .filter(|metrics| metrics.counts() && !metrics.is_stopped() && !metrics.is_practice())
        {
            let number = metrics.folder.unwrap_or_default();
            let won = metrics.won();
            let (name, run) = (metrics.game.clone(), metrics.run);
            let place: Place = (number, metrics.game, metrics.level, metrics.run);
            let Some((game, level, beginning)) = known.remove(&place) else { continue };
            if own.insert((game, level, run), PlayedEpisode { won, beginning }).is_some() {
                return Err(twice(&player, &name, &folders[number]));
            }
        }
    }
    Ok(players.into_iter().map(|(player, episodes)| PlayerEpisodes { player, episodes }).collect())
}

fn twice(player: &Player, game: &str, folder: &Path) -> EvaluationError {
    let what = format!(
        "two folders contain the same episodes of {} on {game}; pass only one of the folders",
        player.label()
    );
    EvaluationError::malformed(folder, what)
}

/// Returns an episode's metrics and first actions, or `None` if the episode was never started.
fn read(
    evaluation: &Evaluation,
    task: &Task<'_>,
) -> Result<Option<(EpisodeMetrics, Vec<Action>)>, EvaluationError> {
    let log = evaluation.events(task)?;
    if log.is_empty() {
        return Ok(None);
    }
    let metrics = evaluation.checked(task, &log, || EpisodeMetrics::of(task.subject, &log))?;
    let actions = log.iter().filter_map(|event| match event {
        Event::Step { action, .. } => Some(*action),
        _ => None,
    });
    Ok(Some((metrics, actions.take(KEPT).collect())))
}
