//! The prompt parts that only the track without rules uses: the end of a level, and the last question.

use super::{Attempt, Past, Prompt, PromptStyle, Prompter, data};
use crate::encoding;
use crate::legend::{EntryRole, Legend, LegendOptions};
use crate::predictions::{self, Predicted};
use crate::turn::{LevelEnd, Turn};
use base::Seed;
use engine::{Analysis, Level, Observation, Outcome};
use itertools::Itertools;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};

impl Prompter {
    /// Returns `true` if the prompts ask for predictions after the last level of a series.
    pub fn asks_predictions(&self) -> bool {
        self.settings.style == PromptStyle::Discover
    }

    /// Returns the conversation that ends with the last question in a series. The question follows the last
    /// turn of the last level, and asks what touching each of the given sprite types does. `kinds` contains
    /// the game's own names. The question uses the names shown in prompts.
    pub fn question(&self, last: &Turn<'_>, kinds: &[String], past: &[Past], attempts: &[Attempt]) -> Prompt {
        let end = LevelEnd {
            last: last.observation.clone(),
            before: last.before.map(|before| (before.observation.clone(), before.action)),
            steps: last.number,
        };
        let Value::Object(mut told) = self.told_end(&end) else {
            unreachable!("the end is encoded as an object")
        };
        told.insert("kinds".to_owned(), json!(self.listed(kinds)));
        let shown = self.render("discover_question.j2", data(Value::Object(told)));
        self.conversation(shown.trim_end().to_owned(), None, past, attempts)
    }

    /// Reads the answer to the last question in a series.
    ///
    /// # Errors
    /// Returns an error if the answer is not in the required format. The message is a clause whose subject is
    /// the answer.
    pub fn read_predictions(&self, answer: &str, kinds: &[String]) -> Result<Predicted, String> {
        predictions::read(answer, &self.asked(kinds))
    }

    /// Returns the message about an unusable answer to the last question.
    pub fn question_complaint(&self, why: &str, kinds: &[String]) -> String {
        let kinds = self.listed(kinds);
        self.render("discover_complaint.j2", data(json!({ "why": why, "kinds": kinds })))
            .trim_end()
            .to_owned()
    }

    /// Returns the names that prompts use for sprite types, sorted by number.
    fn listed(&self, kinds: &[String]) -> Vec<String> {
        self.asked(kinds).into_keys().sorted_by_key(|name| (name.len(), name.clone())).collect()
    }

    /// Returns a map from the names in prompts to the game's own names.
    fn asked(&self, kinds: &[String]) -> BTreeMap<String, String> {
        let shown = |own: &String| match &self.mask {
            Some(mask) => mask.name(own).to_owned(),
            None => own.clone(),
        };
        kinds.iter().map(|own| (shown(own), own.clone())).collect()
    }

    /// Returns the template data about the end of a level.
    pub(super) fn told_end(&self, end: &LevelEnd) -> Value {
        let LevelEnd { last, before, steps } = end;
        let masked = |seen: &Observation| match &self.mask {
            Some(mask) => mask.observation(seen),
            None => seen.clone(),
        };
        let is = match last.outcome {
            Outcome::Won => "You have won",
            Outcome::Lost => "You have lost",
            Outcome::Ended | Outcome::Stopped(_) => "It is over without a winner",
            Outcome::Ongoing => "The limit of actions was reached, which is not a win",
        };
        let events = before
            .as_ref()
            .map(|(before, action)| encoding::events(&masked(before), &masked(last), *action, &self.legend));
        let actions = if *steps == 1 { "action" } else { "actions" };
        json!({
            "end": format!("{is}. The score is {}, after {steps} {actions}.", last.score),
            "events": events.unwrap_or_default(),
        })
    }

    /// Returns the legend's lines. In prompts without rules, the lines are sorted so that their order reveals
    /// nothing.
    pub(super) fn legend_lines(&self) -> Vec<String> {
        let mut lines = self.legend.lines();
        if self.mask.is_some() && (self.settings.neutral_names || self.asks_predictions()) {
            lines.sort();
        }
        lines
    }
}

/// Returns the sprite types about which the last question in a series asks: the visible types present at the
/// start of the given levels, except avatars and floors. They are sorted by the game's own names.
pub(crate) fn kinds_at_start<'a>(
    analysis: &Analysis,
    levels: impl Iterator<Item = &'a Level>,
) -> Vec<String> {
    let (game, legend) = (analysis.game(), Legend::new(analysis, &LegendOptions::default()));
    let mut kinds = BTreeSet::new();
    for level in levels {
        let seen = game.observe(&game.start(level, Seed::from_text("start")));
        kinds.extend(seen.cells.into_iter().flatten());
    }
    let is_asked = |name: &String| {
        let entry = legend.entry(name);
        entry.is_some_and(|entry| !matches!(entry.role, EntryRole::Avatar | EntryRole::Floor))
    };
    kinds.into_iter().filter(is_asked).collect()
}
