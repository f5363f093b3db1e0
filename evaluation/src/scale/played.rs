//! The plays of persons on levels, from results folders: identical episodes count once.

use crate::error::EvaluationError;
use crate::run::{Evaluation, Settings};
use crate::study::{Player, Study};
use crate::track::Track;
use engine::Digest;
use itertools::Itertools;
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
    /// Episodes with settings that the scale was not calibrated with, by what differs: `--commit 3`. They are not among `levels`.
    pub left_out: BTreeMap<String, u64>,
    /// Won and all different episodes, by the digests of game and level.
    pub levels: BTreeMap<(Digest, Digest), (u64, u64)>,
}

/// Reads results folders, of whose persons each is told apart as in reports. Aborted episodes do not count, nor do those with
/// another track, commitment or limit of steps than a scale of `max_steps`: the difficulty of its levels is not that for them.
///
/// # Errors
/// The same as those of [`Study::read`].
pub fn played(folders: &[PathBuf], max_steps: u64) -> Result<Vec<PersonPlays>, EvaluationError> {
    let study = Study::read(folders)?;
    let settings = folders
        .iter()
        .map(|folder| Evaluation::open(folder).map(|found| found.settings))
        .collect::<Result<Vec<_>, EvaluationError>>()?;
    let person = |(at, player): (usize, &Player)| {
        let (mut levels, mut left_out): (BTreeMap<_, (u64, u64)>, _) = (BTreeMap::new(), BTreeMap::new());
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
            if let Some(other) = settings.apart_from(max_steps) {
                *left_out.entry(other).or_default() += 1;
                continue;
            }
            let place = (game.digest, level.digest);
            let course = episode.metrics.course;
            if course.is_none_or(|course| seen.insert((place, course))) {
                let counts = levels.entry(place).or_default();
                counts.0 += u64::from(episode.metrics.won());
                counts.1 += 1;
            }
        }
        PersonPlays { player: player.clone(), dimension, left_out, levels }
    };
    Ok(study.players.iter().enumerate().map(person).collect())
}

impl Settings {
    /// Returns by what flags it differs from the settings of a scale with this limit of steps; `None` if by none.
    fn apart_from(&self, max_steps: u64) -> Option<String> {
        let track = self.track.as_deref().and_then(|id| id.split('@').next());
        let track = track.filter(|name| *name != Track::Told.name()).map(|name| format!("--track {name}"));
        let commit = (!self.commit.is_one()).then(|| format!("--commit {}", self.commit));
        let steps = (self.max_steps != max_steps).then(|| format!("--max-steps {}", self.max_steps));
        let all = track.into_iter().chain(commit).chain(steps).collect_vec();
        (!all.is_empty()).then(|| all.join(" "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Commitment;
    use crate::run::{Entrant, FORMAT};

    #[track_caller]
    fn check(track: Option<&str>, commit: &str, max_steps: u64, expect: Option<&str>) {
        let name = "m".to_owned();
        let settings = Settings {
            format: FORMAT,
            semantics: engine::SEMANTICS,
            suite: String::new(),
            snapshot: None,
            entrant: Entrant { name, mode: None, aids: Vec::new(), details: serde_json::Value::Null },
            seed: String::new(),
            runs: 1,
            max_steps,
            commit: commit.parse::<Commitment>().unwrap(),
            track: track.map(str::to_owned),
            series: 1,
            games: Vec::new(),
        };
        assert_eq!(settings.apart_from(500).as_deref(), expect);
    }

    #[test]
    fn a_scale_is_of_one_track_commitment_and_limit() {
        check(None, "1", 500, None);
        check(Some("told@1"), "1", 500, None);
        check(Some("told@1"), "10", 500, Some("--commit 10"));
        check(Some("masked@1"), "all", 40, Some("--track masked --commit all --max-steps 40"));
    }
}
