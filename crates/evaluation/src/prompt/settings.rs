//! Settings for the content and form of prompts. Every aid (optional part of a prompt) can be turned on or off, so that
//! its effect can be measured.

use serde::{Deserialize, Serialize};
use serde_json::Value;

/// Prompt settings. The defaults produce the standard zero-shot prompt.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PromptSettings {
    /// The prompt style, which determines the parts and their order.
    pub style: PromptStyle,
    /// The earlier turns that a prompt includes.
    pub mode: Mode,
    /// The form in which the rules are shown.
    pub rules: Rules,
    /// `true` if sprite types have meaningless names in the rules, the legend and the boards.
    pub masked_names: bool,
    /// `true` if all types, including walls and the avatar, have meaningless names and characters, drawn anew
    /// for each game.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub neutral_names: bool,
    /// `true` to show the meanings of the board's characters.
    pub legend: bool,
    /// `true` to show the effect of each key for the avatar.
    pub action_meanings: bool,
    /// `true` to show the avatar's position, type and direction.
    pub position: bool,
    /// `true` to show the result of the previous action. If `None`, the result is shown only in contextual
    /// mode.
    pub feedback: Option<bool>,
    /// The forms in which the state is shown.
    pub encodings: Encodings,
    /// `true` if each avatar state has its own character on the board, and no character is marked as the
    /// player's.
    pub identity_tracking: bool,
    /// The number that determines how the board's characters are shuffled. `None` keeps the original
    /// characters.
    pub shuffled_symbols: Option<u64>,
    /// Advice to insert verbatim into the prompt.
    pub strategy: Option<String>,
    /// The maximum number of tokens in a conversation, counted locally. If a conversation exceeds the
    /// maximum, its oldest turns are dropped.
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
    /// Returns the ways in which the settings differ from the defaults, such as `no-legend`, `rules=vgdl` or
    /// `json`, sorted. The mode is not included. Advice appears only as `strategy`.
    pub fn aids(&self) -> Vec<String> {
        self.aids_beyond(&PromptSettings::default())
    }

    /// Returns the ways in which the settings differ from the given settings, in the same format as
    /// [`aids`](PromptSettings::aids).
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

/// A prompt style, which determines the parts and their order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PromptStyle {
    /// The suite's own style.
    #[default]
    Standard,
    /// The style of the reference's pipeline (`spec/06` §1.4), in different words. The prompts have the same
    /// parts in the same order as the originals, with numbered actions and a list of every cell. The switches
    /// for legend, meanings, position, feedback and encodings have no effect.
    Reference,
    /// The style of [`Track::Discover`](crate::Track::Discover), which shows visible events but no rules and
    /// no score. The board has rulers and neutral names. The switches for legend, meanings, position,
    /// feedback and encodings have no effect.
    Discover,
}

base::named_enum! {
    /// The earlier turns that a prompt includes.
    #[derive(Default)]
    pub enum Mode {
        /// No earlier turns. Every turn is independent.
        #[default]
        ZeroShot = "zero-shot",
        /// The conversation continues from turn to turn, within its token budget.
        Contextual = "contextual",
    }
}

/// The form in which the rules are shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rules {
    /// English sentences generated by `engine::describe`.
    #[default]
    Described,
    /// The VGDL source, printed in canonical form without comments.
    Vgdl,
    /// The rules are not shown.
    None,
}

/// The forms in which the state is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Encodings {
    /// The board with one character per cell, and a list of the cells that contain several sprites.
    pub grid: bool,
    /// Spaces between the characters of each row. They cost more tokens, but make each character a separate
    /// token for most models.
    pub spaced: bool,
    /// The first sprite in each direction from the avatar, and the nearest sprites of each type.
    pub grounding: bool,
    /// All sprites with their positions, including walls.
    pub coordinates: bool,
    /// A second copy of the grid, rotated by 90 degrees.
    pub rotated: bool,
    /// The observation as one line of JSON.
    pub json: bool,
    /// An image of the board, for multimodal models.
    pub image: bool,
    /// The maximum number of pixels per cell in the image, from 4 to 40. Large boards are drawn with fewer
    /// pixels per cell.
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
