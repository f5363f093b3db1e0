//! Reads a study from results folders.

use crate::client::{ModelSettings, Prices, Usage, Usd};
use crate::error::EvaluationError;
use crate::log::Event;
use crate::mask;
use crate::metrics::EpisodeMetrics;
use crate::run::{Entrant, Evaluation, Settings, Task};
use crate::study::games::mirror;
use crate::study::players::person::{PersonResults, told_apart};
use crate::study::{Player, Study, StudyGame};
use crate::subject::{Subject, SubjectLevel};
use base::MessagePath;
use engine::{Game, StateHash};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

impl Study {
    /// Reads a study from results folders. Every episode is replayed from its log.
    ///
    /// Results of the same person in several folders are merged. Persons are the same if their name, mode,
    /// aids, prompts, decoding and served version are equal.
    ///
    /// Two variants of a game with the same ID count as one game in two cases. Either their rules are equal
    /// except for names, and their levels start in the same states, or their rules and levels are mirrored.
    /// Results on the two variants belong to separate players.
    ///
    /// Cost: one [`replay`](crate::metrics::replay) per episode, on the threads of the current rayon pool.
    ///
    /// # Errors
    /// Returns an error if a folder or log cannot be read, or if a replay differs from its log. Also returns
    /// an error if two folders contain the same episode of the same player, or if different games or levels
    /// have the same name.
    pub fn read(folders: &[PathBuf]) -> Result<Study, EvaluationError> {
        let mut results: Vec<PersonResults> = Vec::new();
        let mut names = Names::default();
        let (mut notes, mut seeds, mut origins) = (Vec::new(), BTreeSet::new(), Vec::new());
        let mut is_mirrored = false;
        for (place, folder) in folders.iter().enumerate() {
            let evaluation = Evaluation::open(folder)?;
            let player = Player::from(&evaluation.settings.entrant);
            let mut surfaces: BTreeMap<&str, Surface> = BTreeMap::new();
            for subject in &evaluation.subjects {
                surfaces.insert(&subject.id, names.add(subject, folder)?);
            }
            is_mirrored |= surfaces.values().any(|surface| *surface == Surface::Mirrored);
            seeds.insert(evaluation.settings.seed.clone());
            let tasks = evaluation.tasks();
            evaluation.check_logs(&tasks)?;
            // Episodes that were not started are dropped.
            let measure = |task| measured(&evaluation, task, EpisodeMetrics::of).transpose();
            let measured = tasks.par_iter().filter_map(measure);
            let mut measured = measured.collect::<Result<Vec<EpisodeMetrics>, EvaluationError>>()?;
            measured.iter_mut().for_each(|episode| episode.folder = Some(place));
            price(&evaluation.settings.entrant, &mut measured);
            let open = tasks.len() - measured.len();
            if evaluation.settings.adaptive.is_some() {
                notes.push(format!(
                    "The levels of {} were chosen based on its earlier results (--adaptive), so its win rate is \
                     not a valid measure; use `arcade study scale` to place the player on a scale.",
                    player.label()
                ));
            } else if open > 0 {
                notes.push(format!(
                    "{open} of {} episodes of {} were not started.",
                    tasks.len(),
                    player.label()
                ));
            }
            notes.extend(
                evaluation.settings.out_of_reach().map(|warning| format!("{}: {warning}.", player.label())),
            );
            let mut parted: BTreeMap<Surface, Vec<EpisodeMetrics>> = BTreeMap::new();
            for episode in measured {
                parted.entry(surfaces[episode.game.as_str()]).or_default().push(episode);
            }
            if parted.is_empty() {
                parted.extend(surfaces.values().min().map(|&surface| (surface, Vec::new())));
            }
            for (surface, episodes) in parted {
                let parts = PersonResults::of(&evaluation.settings.entrant, surface.words(), episodes);
                origins.extend(parts.iter().map(|_| folder));
                results.extend(parts);
            }
        }
        let results = told_apart(results);
        for ((player, episodes), folder) in results.iter().zip(origins) {
            names.claim(player, episodes.iter(), folder)?;
        }
        let mut study = Study::new(results, names.games());
        study.notes.extend(notes);
        study.notes.extend(names.unpaired());
        if is_mirrored {
            let note = "Mirrored games have their own randomness, so their episodes are not paired with \
                        those of the originals.";
            study.notes.push(note.to_owned());
        }
        if seeds.len() > 1 {
            study.notes.push(
                "Players had different random seeds (--seed): their episodes are not paired.".to_owned(),
            );
        }
        Ok(study)
    }
}

/// Computes the costs of a model's episodes, if the embedded price table lists the model.
fn price(entrant: &Entrant, episodes: &mut [EpisodeMetrics]) {
    let model = entrant.details.get("model").cloned();
    let model = model.and_then(|model| serde_json::from_value::<ModelSettings>(model).ok());
    let Some(price) = model.and_then(|own| Prices::embedded().find(own.provider, &own.model)) else { return };
    for EpisodeMetrics { spending, cost, .. } in episodes {
        let usage = Usage {
            input_tokens: spending.input_tokens,
            cached_input_tokens: spending.cached_input_tokens,
            output_tokens: spending.output_tokens,
            ..Usage::default()
        };
        *cost = price.cost(&usage).map(Usd::dollars);
    }
}

/// The games and episodes in the folders read so far, by name.
#[derive(Default)]
struct Names {
    games: Vec<KnownGame>,
    episodes: BTreeMap<(Player, String, usize, u64), PathBuf>,
}

/// A game in the folders read so far.
struct KnownGame {
    game: StudyGame,
    rules: Game,
    /// The levels' canonical texts, by level number.
    levels: BTreeMap<usize, String>,
    /// The hashes of the levels' first states under a fixed seed, by level number.
    starts: BTreeMap<usize, StateHash>,
}

/// A game's relation to a game in an earlier folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Surface {
    /// The game is identical to the earlier game, or is the first game with its ID.
    Own,
    /// The game is identical except for its names, and its levels start in the same states.
    Renamed,
    /// The game is the left-right mirror image.
    Mirrored,
}

impl Surface {
    /// Returns a phrase describing the difference from the earlier game, or `None` if there is no difference.
    fn words(self) -> Option<&'static str> {
        match self {
            Surface::Own => None,
            Surface::Renamed => Some("under other names"),
            Surface::Mirrored => Some("mirrored"),
        }
    }
}

impl KnownGame {
    /// Returns the relation of the game to a different game with the same ID. If the games are unrelated,
    /// returns a description of the difference.
    fn surface(&self, subject: &Subject, levels: &BTreeMap<usize, String>) -> Result<Surface, String> {
        let differing = |image: fn(&str) -> String| {
            let mut shared =
                levels.iter().filter_map(|(number, text)| Some((number, text, self.levels.get(number)?)));
            shared.find(|(_, text, known)| image(known) != **text).map(|(number, ..)| *number)
        };
        let is_same = self.rules.digest() == subject.game.digest();
        let differs = match differing(str::to_owned) {
            None if is_same => return Ok(Surface::Own),
            Some(level) if is_same => format!("level {level} of"),
            _ => "game".to_owned(),
        };
        let starts = |level: &SubjectLevel| {
            self.starts.get(&level.number).is_none_or(|start| *start == subject.first_state(level))
        };
        let nameless = |game: &Game| mask::nameless(game.description());
        if !is_same && nameless(&self.rules) == nameless(&subject.game) && subject.levels.iter().all(starts) {
            return Ok(Surface::Renamed);
        }
        if mirror::is_image(&self.rules, &subject.game) && differing(mirror::level).is_none() {
            return Ok(Surface::Mirrored);
        }
        Err(differs)
    }
}

impl Names {
    /// Adds a game, and returns its relation to the game with the same ID in an earlier folder.
    fn add(&mut self, subject: &Subject, folder: &Path) -> Result<Surface, EvaluationError> {
        let levels = subject.levels.iter().map(|level| (level.number, level.level.to_string())).collect();
        let start = |level: &SubjectLevel| (level.number, subject.first_state(level));
        let starts: BTreeMap<usize, StateHash> = subject.levels.iter().map(start).collect();
        let Some(known) = self.games.iter_mut().find(|known| known.game.id == subject.id) else {
            let (game, rules) = (StudyGame::from(subject), subject.game.clone());
            self.games.push(KnownGame { game, rules, levels, starts });
            return Ok(Surface::Own);
        };
        let surface = known.surface(subject, &levels).map_err(|differs| {
            let what = format!("its {differs} `{}` differs from that in an earlier folder", subject.id);
            EvaluationError::malformed(folder, format!("{what}; report on the folders separately"))
        })?;
        if surface != Surface::Mirrored {
            for (number, start) in starts {
                known.starts.entry(number).or_insert(start);
            }
        }
        if surface != Surface::Renamed {
            let is_image = surface == Surface::Mirrored;
            for (number, text) in levels {
                let text = if is_image { mirror::level(&text) } else { text };
                known.levels.entry(number).or_insert(text);
            }
        }
        for level in StudyGame::from(subject).levels {
            if known.game.levels.iter().all(|own| own.number != level.number) {
                known.game.levels.push(level);
            }
        }
        known.game.levels.sort_by_key(|level| level.number);
        for mark in &subject.facts.marks {
            if !known.game.marks.contains(mark) {
                known.game.marks.push(mark.clone());
            }
        }
        for ceiling in &subject.facts.ceilings {
            if !known.game.ceilings.contains(ceiling) {
                known.game.ceilings.push(ceiling.clone());
            }
        }
        Ok(surface)
    }

    /// Checks that no other folder contains the given episodes of the player.
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
                    other.in_message()
                );
                return Err(EvaluationError::malformed(folder, what));
            }
        }
        Ok(())
    }

    fn games(&self) -> Vec<StudyGame> {
        self.games.iter().map(|known| known.game.clone()).collect()
    }

    /// Returns a note if not all players have played the same episodes.
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
            "Not every player has played every level the same number of times; means over all levels are \
             comparable only between players that have."
                .to_owned()
        })
    }
}

/// The players in results folders, each with its episodes, and each folder's evaluation settings. Here a player
/// includes its configuration, such as its mode and aids. Unlike in a study, games from different folders may have
/// the same ID.
pub(crate) type Persons = (Vec<(Player, Vec<EpisodeMetrics>)>, Vec<Settings>);

/// Reads the persons in results folders. A difference in configuration makes two persons, as in [`Study::read`].
/// Practice episodes are omitted. The metrics of all other episodes are computed by [`EpisodeMetrics::of_course`].
///
/// # Errors
/// Returns an error if a folder or log cannot be read, or if a replay differs from its log.
pub(crate) fn persons(folders: &[PathBuf]) -> Result<Persons, EvaluationError> {
    let (mut results, mut settings) = (Vec::new(), Vec::new());
    for (place, folder) in folders.iter().enumerate() {
        let evaluation = Evaluation::open(folder)?;
        let tasks = evaluation.tasks();
        evaluation.check_logs(&tasks)?;
        let measure = |task| measured(&evaluation, task, EpisodeMetrics::of_course).transpose();
        let measured = tasks.par_iter().filter_map(measure);
        let mut measured = measured.collect::<Result<Vec<EpisodeMetrics>, EvaluationError>>()?;
        measured.retain(|episode| !episode.is_practice());
        measured.iter_mut().for_each(|episode| episode.folder = Some(place));
        results.extend(PersonResults::of(&evaluation.settings.entrant, None, measured));
        settings.push(evaluation.settings);
    }
    let mut persons: Vec<(Player, Vec<EpisodeMetrics>)> = Vec::new();
    for (player, episodes) in told_apart(results) {
        match persons.iter_mut().find(|(known, _)| *known == player) {
            Some((_, known)) => known.extend(episodes),
            None => persons.push((player, episodes)),
        }
    }
    Ok((persons, settings))
}

/// Returns an episode's metrics, or `None` if the episode was not started.
fn measured(
    evaluation: &Evaluation,
    task: &Task<'_>,
    measure: fn(&Subject, &[Event]) -> Result<EpisodeMetrics, EvaluationError>,
) -> Result<Option<EpisodeMetrics>, EvaluationError> {
    let log = evaluation.events(task)?;
    if log.is_empty() {
        return Ok(None);
    }
    evaluation.checked(task, &log, || measure(task.subject, &log)).map(Some)
}
