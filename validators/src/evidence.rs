//! A validator's observations. Each is a sentence, which may come with advice, a tick, a cell, a line of the game file,
//! and a board.

use crate::explain::board::Board;
use engine::syntax::{InteractionLine, Param, SpriteLine, TerminationLine};
use engine::{Game, Span};
use serde::Serialize;
use std::fmt::Write;

/// A single observation by a validator.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Evidence {
    /// The observation, as text.
    pub text: String,
    /// The tick of the observation, counted from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tick: Option<usize>,
    /// The cell, as column and row, counted from 1 at the upper left.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cell: Option<(usize, usize)>,
    /// The line of the game file that the observation is about.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rule: Option<Line>,
    /// The board at the time of the observation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub board: Option<Board>,
    /// Advice to the designer.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub advice: Option<String>,
}

impl Evidence {
    /// Creates evidence that consists only of a sentence.
    pub fn new(text: impl Into<String>) -> Evidence {
        Evidence { text: text.into(), ..Evidence::default() }
    }

    /// Adds the line of the game file that this evidence is about.
    #[must_use]
    pub fn of_rule(self, rule: Line) -> Evidence {
        Evidence { rule: Some(rule), ..self }
    }

    /// Adds advice on how to meet the criterion.
    #[must_use]
    pub fn advise(self, advice: impl Into<String>) -> Evidence {
        Evidence { advice: Some(advice.into()), ..self }
    }
}

/// A line of a game file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Line {
    /// The line's text, in canonical spelling.
    pub text: String,
    /// The line's position in the source text; empty for games that were built rather than parsed.
    #[serde(skip)]
    pub span: Span,
    /// The line number in the source text, counted from 1. To be filled in by callers that have the source text.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<usize>,
}

impl Line {
    fn new(text: String, span: Span) -> Line {
        Line { text, span, line: None }
    }

    /// Returns the line of an interaction, by index into [`Description::interactions`](engine::Description).
    pub fn interaction(game: &Game, line: usize) -> Line {
        let InteractionLine { first, second, effect, params, .. } = &game.description().interactions[line];
        let mut text = first.text.clone();
        for word in second {
            let _ = write!(text, " {}", word.text);
        }
        Line::new(with_params(format!("{text} > {}", effect.text), params), first.span)
    }

    /// Returns the line of a termination, by index into [`Description::terminations`](engine::Description).
    pub fn termination(game: &Game, line: usize) -> Line {
        let TerminationLine { class, params, .. } = &game.description().terminations[line];
        Line::new(with_params(class.text.clone(), params), class.span)
    }

    /// Returns the SpriteSet line that declares a type; `None` for types that exist without a declaration.
    pub fn sprite(game: &Game, name: &str) -> Option<Line> {
        let lines = game.description().sprite_lines();
        let (_, line) = lines.into_iter().find(|(_, line)| line.name.text == name)?;
        let SpriteLine { name, class, params, .. } = line;
        let class = class.as_ref().map_or(String::new(), |class| format!(" {}", class.text));
        Some(Line::new(with_params(format!("{} >{class}", name.text), params), name.span))
    }

    /// Returns the LevelMapping line for a character; `None` for characters mapped by default.
    pub fn mapping(game: &Game, symbol: char) -> Option<Line> {
        let line = game.description().mapping.iter().find(|line| line.symbol == symbol)?;
        let names: Vec<&str> = line.names.iter().map(|name| name.text.as_str()).collect();
        Some(Line::new(format!("{symbol} > {}", names.join(" ")), line.span))
    }
}

fn with_params(mut text: String, params: &[Param]) -> String {
    for Param { key, value } in params {
        let _ = write!(text, " {}={}", key.text, value.text);
    }
    text
}
