//! Reads the results of persons (players to be placed on a scale) by level from results folders. Identical episodes
//! count once.

use crate::error::EvaluationError;
use crate::metrics::EpisodeMetrics;
use crate::run::Settings;
use crate::study::{Player, persons};
use crate::track::Track;
use base::Digest;
use base::MessagePath;
use itertools::Itertools;
use statistics::scale::Dimension;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

/// The results of a person (a player to be placed on a scale), by level.
#[derive(Clone, Debug, PartialEq)]
pub struct PersonPlays {
    /// The person (player with its settings) who played the episodes.
    pub player: Player,
    /// The person's dimension. Players that see the state are planners, and players that see only prompts are readers.
    pub dimension: Dimension,
    /// The number of episodes excluded because of their settings, by difference from the settings of the
    /// scale. The key lists the differing settings, such as `--commit 3`. `levels` does not include these
    /// episodes.
    pub left_out: BTreeMap<String, u64>,
    /// The versions of the suite that evaluated the person (player), by game digest.
    pub suites: BTreeMap<Digest, BTreeSet<String>>,
    /// The number of wins and the number of distinct episodes, by game digest and level digest.
    pub levels: BTreeMap<(Digest, Digest), (u64, u64)>,
}

/// Reads the persons' results in results folders. Persons are distinguished in the same way as in reports. Aborted
/// episodes do not count. Episodes whose track (prompt settings), commitment (actions per decision) or step limit
/// differs from that of a scale with `max_steps` do not count either, because the scale's difficulties do not apply to
/// them.
///
/// Cost: one [`replay_course`](crate::metrics::replay_course) per episode, on the threads of the current rayon pool.
///
/// # Errors
/// Returns an error if a folder or log cannot be read, if a replay differs from its log, or if two folders contain
/// different episodes of the same person, level, run and seed.
pub fn played(folders: &[PathBuf], max_steps: u64) -> Result<Vec<PersonPlays>, EvaluationError> {
    let (persons, settings) = persons(folders)?;
    let person = |(player, episodes): (Player, Vec<EpisodeMetrics>)| {
        let mut person = PersonPlays {
            player,
            dimension: Dimension::Reader,
            left_out: BTreeMap::new(),
            levels: BTreeMap::new(),
            suites: BTreeMap::new(),
        };
        let (mut courses, mut runs) = (BTreeSet::new(), BTreeMap::new());
        for episode in episodes.iter().filter(|episode| episode.counts() && !episode.is_stopped()) {
            let Some(folder) = episode.folder else { continue };
            let settings = &settings[folder];
            let Some(game) = settings.games.iter().find(|game| game.id == episode.game) else { continue };
            let Some(level) = game.levels.iter().find(|level| level.number == episode.level) else {
                continue;
            };
            if settings.entrant.details.get("planner").is_some() {
                person.dimension = Dimension::Planner;
            }
            if let Some(other) = settings.apart_from(max_steps) {
                *person.left_out.entry(other).or_default() += 1;
                continue;
            }
            let place = (game.digest, level.digest);
            let run = (place, &settings.seed, episode.run);
            let (first, course) = *runs.entry(run).or_insert((folder, episode.course));
            if first != folder && (course.is_none() || course != episode.course) {
                let what = format!(
                    "{} also played run {} of {} level {} in {}; rename one of the two players",
                    person.player.label(),
                    episode.run,
                    game.id,
                    level.number,
                    folders[first].in_message()
                );
                return Err(EvaluationError::malformed(&folders[folder], what));
            }
            person.suites.entry(game.digest).or_default().insert(settings.suite.clone());
            if episode.course.is_none_or(|course| courses.insert((place, course))) {
                let counts = person.levels.entry(place).or_default();
                counts.0 += u64::from(episode.won());
                counts.1 += 1;
            }
        }
        Ok(person)
    };
    persons.into_iter().map(person).collect()
}

impl Settings {
    /// Returns the command-line flags for the settings that differ from those of a scale with the given step
    /// limit. Returns `None` if there is no difference.
    pub fn apart_from(&self, max_steps: u64) -> Option<String> {
        let track = self.track.as_deref().and_then(|id| id.split('@').next());
        let track = track.filter(|name| *name != Track::Told.name()).map(|name| format!("--track {name}"));
        let commit = (!self.commit.is_one()).then(|| format!("--commit {}", self.commit));
        let tokens = self.max_output_tokens.map(|most| format!("--max-output-tokens {most}"));
        let steps = (self.max_steps != max_steps).then(|| format!("--max-steps {}", self.max_steps));
        let all = track.into_iter().chain(commit).chain(tokens).chain(steps).collect_vec();
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
            max_output_tokens: None,
            track: track.map(str::to_owned),
            series: 1,
            adaptive: None,
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
