//! The plays of persons on levels, from results folders: identical episodes count once.

use crate::error::EvaluationError;
use crate::run::Evaluation;
use crate::study::{Player, Study};
use engine::Digest;
use statistics::scale::Dimension;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

/// The plays of a person by level.
#[derive(Clone, Debug, PartialEq)]
pub struct PersonPlays {
    /// The person.
    pub player: Player,
    /// Planners see the state; all others read.
    pub dimension: Dimension,
    /// The limits of steps of its evaluations.
    pub max_steps: BTreeSet<u64>,
    /// Won and all different episodes, by the digests of game and level.
    pub levels: BTreeMap<(Digest, Digest), (u64, u64)>,
}

/// Reads results folders, of whose persons each is told apart as in reports. Aborted episodes do not count.
///
/// # Errors
/// The same as those of [`Study::read`].
pub fn played(folders: &[PathBuf]) -> Result<Vec<PersonPlays>, EvaluationError> {
    let study = Study::read(folders)?;
    let settings = folders
        .iter()
        .map(|folder| Evaluation::open(folder).map(|found| found.settings))
        .collect::<Result<Vec<_>, EvaluationError>>()?;
    let person = |(at, player): (usize, &Player)| {
        let (mut levels, mut max_steps): (BTreeMap<_, (u64, u64)>, _) = (BTreeMap::new(), BTreeSet::new());
        let mut dimension = Dimension::Reader;
        let mut seen = BTreeSet::new();
        for episode in study.on(at, None, None).iter().filter(|episode| episode.metrics.counts()) {
            let Some(settings) = episode.metrics.folder.map(|folder| &settings[folder]) else { continue };
            let Some(game) = settings.games.iter().find(|game| game.id == episode.metrics.game) else {
                continue;
            };
            let level = game.levels.iter().find(|level| level.number == episode.metrics.level);
            let Some(level) = level else { continue };
            if settings.entrant.details.get("planner").is_some() {
                dimension = Dimension::Planner;
            }
            max_steps.insert(settings.max_steps);
            let place = (game.digest, level.digest);
            let course = episode.metrics.course;
            if course.is_none_or(|course| seen.insert((place, course))) {
                let counts = levels.entry(place).or_default();
                counts.0 += u64::from(episode.metrics.won());
                counts.1 += 1;
            }
        }
        PersonPlays { player: player.clone(), dimension, max_steps, levels }
    };
    Ok(study.players.iter().enumerate().map(person).collect())
}
