//! The content and form of prompts. Every aid is a switch, so that its effect can be measured.

use serde::{Deserialize, Serialize};
use serde_json::Value;

/// The settings of a prompt. The defaults give the zero-shot prompt of the suite.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PromptSettings {
    /// The composition of the prompt.
    pub style: PromptStyle,
    /// The handling of earlier turns.
    pub mode: Mode,
    /// The form of the rules.
    pub rules: Rules,
    /// `true` if sprite types have meaningless names in rules, legend and boards.
    pub masked_names: bool,
    /// `true` if all types, including walls and the avatar, have meaningless names and characters, which are drawn
    /// for each game.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub neutral_names: bool,
    /// `true` to show the meaning of the board's characters.
    pub legend: bool,
    /// `true` to show the effects of the keys for this avatar.
    pub action_meanings: bool,
    /// `true` to show the avatar's position, type and direction.
    pub position: bool,
    /// `true` to show the result of the previous action; by default, it is shown only in contextual mode.
    pub feedback: Option<bool>,
    /// The forms in which the state is shown.
    pub encodings: Encodings,
    /// `true` if each state of the avatar has its own character on the board, and no character is marked as the
    /// player's.
    pub identity_tracking: bool,
    /// The number from which shuffled characters for the board are drawn; `None` to keep the original characters.
    pub shuffled_symbols: Option<u64>,
    /// Advice that is inserted verbatim.
    pub strategy: Option<String>,
    /// The maximum number of tokens in a conversation, according to a local count. If it is exceeded, the oldest
    /// turns are dropped.
    pub history_tokens: u64,
}

impl Default for PromptSettings {
    fn default() -> PromptSettings {
        PromptSettings {
            style: PromptStyle::Standard,
            mode: Mode::ZeroShot,
            rules: Rules::Described,
            masked_names: false,
            neutral_names: false,
            legend: true,
            action_meanings: true,
            position: true,
            feedback: None,
            encodings: Encodings::default(),
            identity_tracking: false,
            shuffled_symbols: None,
            strategy: None,
            history_tokens: 20_000,
        }
    }
}

impl PromptSettings {
    /// Returns the sorted differences from the default, except for the mode: `no-legend`, `rules=vgdl`, `json`.
    /// Advice appears only as `strategy`.
    pub fn aids(&self) -> Vec<String> {
        self.aids_beyond(&PromptSettings::default())
    }

    /// Returns the differences from the given settings, in the form of [`aids`](PromptSettings::aids).
    pub fn aids_beyond(&self, usual: &PromptSettings) -> Vec<String> {
        let flat = |settings: &PromptSettings| {
            let mut all = serde_json::to_value(settings).expect("plain data");
            let all = all.as_object_mut().expect("a struct");
            let encodings = all.remove("encodings");
            all.extend(encodings.and_then(|encodings| encodings.as_object().cloned()).unwrap_or_default());
            all.remove("mode");
            std::mem::take(all)
        };
        let (own, usual) = (flat(self), flat(usual));
        let differing = own.into_iter().filter(|(name, value)| usual.get(name) != Some(value));
        let mut aids: Vec<String> = differing
            .map(|(name, value)| match (name.replace('_', "-"), value) {
                (name, Value::Bool(true)) => name,
                (name, Value::Bool(false)) => format!("no-{name}"),
                (name, Value::String(_)) if name == "strategy" => name,
                (name, Value::String(value)) => format!("{name}={value}"),
                (name, value) => format!("{name}={value}"),
            })
            .collect();
        aids.sort();
        aids
    }

    /// Returns `true` if the result of the previous action is shown.
    pub fn has_feedback(&self) -> bool {
        self.feedback.unwrap_or(self.mode == Mode::Contextual)
    }
}

/// The composition of a prompt.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PromptStyle {
    /// The composition of this suite.
    #[default]
    Standard,
    /// The composition of the reference's pipeline (`spec/06` §1.4), reworded: the same parts in the same order,
    /// numbered actions, and a list of every cell. The switches for legend, meanings, position, feedback and
    /// encodings have no effect.
    Reference,
    /// The composition of [`Track::Discover`](crate::Track::Discover): no rules, no score, visible events. It shows
    /// the board with rulers under neutral names. The switches for legend, meanings, position, feedback and encodings
    /// have no effect.
    Discover,
}

base::named_enum! {
    /// The handling of earlier turns.
    #[derive(Default)]
    pub enum Mode {
        /// Every turn is independent, and no earlier turns are shown.
        #[default]
        ZeroShot = "zero-shot",
        /// The conversation continues, within its token budget.
        Contextual = "contextual",
    }
}

/// The form of the rules.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rules {
    /// English sentences from `engine::describe`.
    #[default]
    Described,
    /// VGDL, as the canonical print of the game without comments.
    Vgdl,
    /// No rules.
    None,
}

/// The forms in which a state is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Encodings {
    /// One character per cell, and a list of the cells that hold several things.
    pub grid: bool,
    /// Spaces between the characters of a row. They cost more tokens, but make each character a separate token for
    /// most models.
    pub spaced: bool,
    /// The first thing in each direction from the avatar, and the nearest things of each type.
    pub grounding: bool,
    /// All things with their positions, including walls.
    pub coordinates: bool,
    /// A second copy of the grid, rotated by a quarter turn.
    pub rotated: bool,
    /// The observation as one line of JSON.
    pub json: bool,
    /// An image, for multimodal models.
    pub image: bool,
    /// The maximum number of pixels per cell of the image, from 4 to 40. Large boards use fewer.
    pub image_cell: u32,
}

impl Default for Encodings {
    fn default() -> Encodings {
        Encodings {
            grid: true,
            spaced: false,
            grounding: true,
            coordinates: false,
            rotated: false,
            json: false,
            image: false,
            image_cell: 32,
        }
    }
}
