//! Tasks: a masked game, the recordings for the examined player, and the held-out recordings.

use super::masked::MaskedGame;
use super::recording::{Recording, record};
use super::seen::Viewer;
use crate::error::EvaluationError;
use crate::subject::Subject;
use base::Seed;
use engine::syntax::SpriteLine;
use engine::{EFFECTS, SpriteClass, TERMINATIONS};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

base::named_enum! {
    /// The level of help: the words of VGDL that the examined player is given.
    pub enum Hints {
        /// The classes, effects and terminations that the game uses.
        Used = "used",
        /// All deterministic classes, effects and terminations of the language, as candidates.
        Candidates = "candidates",
        /// No words.
        None = "none",
    }
}

/// The settings of tasks. Together with a game, they determine a task.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WorldModelSettings {
    /// The level of help.
    pub hints: Hints,
    /// The number of held-out episodes. Unless the examined player explores the game itself, it is shown the same
    /// number of other episodes.
    pub episodes: u64,
    /// The number of actions that the examined player may use to explore the game. If it is 0, the player is shown
    /// recordings instead.
    pub actions: usize,
    /// The maximum number of actions in an episode.
    pub steps: usize,
    /// The text from which the seeds are derived.
    pub seed: String,
}

/// A task for one game.
#[derive(Clone, Debug)]
pub struct WorldModelTask {
    /// The game's ID in logs and tables.
    pub id: String,
    pub(super) hints: Hints,
    /// The number of actions that the examined player may use to explore the game.
    pub(super) actions: usize,
    pub(super) masked: MaskedGame,
    /// The masked names of the game's sprite types. Boards refer to them by their indices.
    pub(super) names: Vec<String>,
    pub(super) recorded: Vec<Recording>,
    pub(super) held_out: Vec<Recording>,
}

/// The VGDL words that are given to the examined player.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Words {
    pub(super) classes: BTreeSet<String>,
    pub(super) effects: BTreeSet<String>,
    pub(super) terminations: BTreeSet<String>,
}

impl WorldModelTask {
    /// Prepares the task for a game. Cost: two forward-model calls for each recorded step.
    ///
    /// # Errors
    /// Returns an error if no level of the game is deterministic, or if the game has faults that only the reference
    /// tolerates.
    pub fn new(subject: &Subject, settings: &WorldModelSettings) -> Result<WorldModelTask, EvaluationError> {
        let masked = MaskedGame::of(subject)?;
        let names: Vec<String> =
            masked.game.sprite_types().map(|stype| masked.game.name(stype).to_owned()).collect();
        let viewer = Viewer::new(&masked.game, &names);
        let seed = Seed::from_text(&settings.seed).child(&subject.game.digest().to_string(), 0);
        let record = |purpose: &str, episodes: u64| {
            record(&masked, &viewer, episodes, settings.steps, seed.child(purpose, 0))
        };
        let shown = if settings.actions == 0 { settings.episodes } else { 0 };
        let (recorded, held_out) = (record("recorded", shown), record("held out", settings.episodes));
        Ok(WorldModelTask {
            id: subject.id.clone(),
            hints: settings.hints,
            actions: settings.actions,
            masked,
            names,
            recorded,
            held_out,
        })
    }

    /// Returns the source text of the masked true game, which scores 100%.
    pub fn true_game(&self) -> &str {
        &self.masked.source
    }

    /// Returns the words that the examined player is given, or `None` if it is given none.
    pub(super) fn words(&self) -> Option<Words> {
        match self.hints {
            Hints::Used => Some(self.used_words()),
            Hints::Candidates => Some(candidates()),
            Hints::None => None,
        }
    }

    fn used_words(&self) -> Words {
        fn classes(lines: &[SpriteLine], found: &mut BTreeSet<String>) {
            for line in lines {
                found.extend(line.class.iter().map(|class| class.text.clone()));
                classes(&line.children, found);
            }
        }
        let description = self.masked.game.description();
        let mut words = Words::default();
        classes(&description.sprites, &mut words.classes);
        for line in &description.interactions {
            let planned = line.params.iter().filter(|param| param.key.text == "ftype");
            words.effects.extend(planned.map(|param| param.value.text.clone()));
            words.effects.insert(line.effect.text.clone());
        }
        words.terminations = description.terminations.iter().map(|line| line.class.text.clone()).collect();
        words
    }
}

/// Returns all VGDL words that involve no random numbers.
pub(super) fn candidates() -> Words {
    let is_random = |name: &str| name.contains("Random") || name.contains("Erratic");
    let classes = SpriteClass::ALL.iter().map(|class| class.name()).filter(|name| !is_random(name));
    let all = |words: &[&str]| words.iter().map(|&word| word.to_owned()).collect();
    Words {
        classes: classes.map(str::to_owned).collect(),
        effects: all(EFFECTS),
        terminations: all(TERMINATIONS),
    }
}
