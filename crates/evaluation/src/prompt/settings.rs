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
    /// Sprite types have meaningless names in rules, legend and boards alike.
    pub masked_names: bool,
    /// All types, walls and the avatar included, have meaningless names and characters, drawn for each game.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub neutral_names: bool,
    /// The meaning of the board's characters is shown.
    pub legend: bool,
    /// The effects of the keys for this avatar are shown.
    pub action_meanings: bool,
    /// The position, type and direction of the avatar are shown.
    pub position: bool,
    /// The result of the previous action is shown; by default, only in contextual mode.
    pub feedback: Option<bool>,
    /// The forms in which the state is shown.
    pub encodings: Encodings,
    /// Each state of the avatar has its own character on the board, and no character is marked as the player's.
    pub identity_tracking: bool,
    /// The characters of the board are shuffled by this number.
    pub shuffled_symbols: Option<u64>,
    /// Advice that is added verbatim.
    pub strategy: Option<String>,
    /// The maximum number of tokens of a conversation, by our own count. The oldest turns are left out beyond it.
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
    /// Returns the differences from the default, apart from the mode, sorted: `no-legend`, `rules=vgdl`, `json`. Advice
    /// appears only as `strategy`.
    pub fn aids(&self) -> Vec<String> {
        self.aids_beyond(&PromptSettings::default())
    }

    /// Returns the differences from other settings, as [`aids`](PromptSettings::aids) does.
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
    /// The composition of the reference's pipeline (`spec/06` §1.4), in words of our own: the same parts in the same order,
    /// numbered actions, every cell listed. The switches for legend, meanings, position, feedback and encodings have no
    /// effect on it.
    Reference,
    /// The composition of [`Track::Discover`](crate::Track::Discover): no rules, no score, visible events. It shows the board with rulers
    /// under neutral names, and the switches for legend, meanings, position, feedback and encodings have no effect.
    Discover,
}

base::named_enum! {
    /// The handling of earlier turns.
    #[derive(Default)]
    pub enum Mode {
        /// Every turn is independent: no earlier turns are shown.
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
    /// In English, by `engine::describe`.
    #[default]
    Described,
    /// VGDL: the canonical print of the game, without comments.
    Vgdl,
    /// No rules.
    None,
}

/// The forms in which a state is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Encodings {
    /// One character per cell, and the cells that hold several things.
    pub grid: bool,
    /// The characters of a row are separated by spaces: more tokens, but for most models each character is a token of its
    /// own.
    pub spaced: bool,
    /// The first thing in each direction from the avatar, and the nearest things of each type.
    pub grounding: bool,
    /// All things by place, including walls.
    pub coordinates: bool,
    /// A second copy of the grid, rotated by a quarter turn.
    pub rotated: bool,
    /// One line of JSON.
    pub json: bool,
    /// A picture, for multimodal models.
    pub image: bool,
    /// The maximum number of pixels of a cell of the picture, 4 to 40. Large boards use fewer.
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
