//! What of the game is shown, and how: every aid is a switch, so that its worth can be measured.

use serde::{Deserialize, Serialize};
use serde_json::Value;

/// The settings of a prompt. Their defaults are the zero-shot prompt of the suite.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PromptSettings {
    /// Whose composition it has.
    pub style: PromptStyle,
    /// Whether earlier turns are shown.
    pub mode: Mode,
    /// How the rules are told.
    pub rules: Rules,
    /// Sprite types go by names that tell nothing, in rules, legend and boards alike.
    pub masked_names: bool,
    /// What the characters of the board stand for.
    pub legend: bool,
    /// What the keys do for this avatar.
    pub action_meanings: bool,
    /// Where the avatar is, what it is and where it faces.
    pub position: bool,
    /// What came of the action before; unless it is said, in contextual mode only.
    pub feedback: Option<bool>,
    /// In which forms the state is shown.
    pub encodings: Encodings,
    /// Each state of the avatar has its own character on the board, and no character is told to be the player's.
    pub identity_tracking: bool,
    /// The characters of the board are drawn, by this number.
    pub shuffled_symbols: Option<u64>,
    /// Advice that is added word by word.
    pub strategy: Option<String>,
    /// Tokens of a conversation at most, by our own count: the oldest turns are left out beyond it.
    pub history_tokens: u64,
}

impl Default for PromptSettings {
    fn default() -> PromptSettings {
        PromptSettings {
            style: PromptStyle::Standard,
            mode: Mode::ZeroShot,
            rules: Rules::Described,
            masked_names: false,
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
    /// What differs from the default, apart from the mode, sorted: `no-legend`, `rules=vgdl`, `json`. Of an advice only that
    /// there is one.
    pub fn aids(&self) -> Vec<String> {
        let flat = |settings: &PromptSettings| {
            let mut all = serde_json::to_value(settings).expect("plain data");
            let all = all.as_object_mut().expect("a struct");
            let encodings = all.remove("encodings");
            all.extend(encodings.and_then(|encodings| encodings.as_object().cloned()).unwrap_or_default());
            all.remove("mode");
            std::mem::take(all)
        };
        let (own, usual) = (flat(self), flat(&PromptSettings::default()));
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

    /// Whether what came of the action before is told.
    pub fn has_feedback(&self) -> bool {
        self.feedback.unwrap_or(self.mode == Mode::Contextual)
    }
}

/// Whose composition a prompt has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PromptStyle {
    /// That of this suite.
    #[default]
    Standard,
    /// That of the reference's pipeline (`spec/06` §1.4), in words of our own: the same parts in the same order, numbered
    /// actions, every cell listed. The switches for legend, meanings, position, feedback and encodings have no effect on it.
    Reference,
}

/// Whether earlier turns are shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mode {
    /// No turn remembers another.
    #[default]
    ZeroShot,
    /// The conversation goes on, as far as its budget of tokens reaches.
    Contextual,
}

/// How the rules are told.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rules {
    /// In English, by `engine::describe`.
    #[default]
    Described,
    /// As VGDL: the canonical print of the game, without comments.
    Vgdl,
    /// Not at all.
    None,
}

/// The forms in which a state is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Encodings {
    /// A character a cell, and the cells that hold several things.
    pub grid: bool,
    /// The characters of a row have a blank between them: more tokens, and to most models each character one of its own.
    pub spaced: bool,
    /// What lies in each direction of the avatar, and the nearest things of each type.
    pub grounding: bool,
    /// All things by place, walls included.
    pub coordinates: bool,
    /// The grid once more, turned by a quarter.
    pub rotated: bool,
    /// A line of JSON.
    pub json: bool,
    /// A picture, for models that see.
    pub image: bool,
    /// Pixels of a cell of the picture at most, 4 to 40; on large boards there are fewer.
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
