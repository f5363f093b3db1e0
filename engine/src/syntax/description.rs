//! A game file's syntax tree, as written, before any name is resolved.

use crate::diagnostic::Span;
use base::Sampler;
use std::collections::{BTreeMap, BTreeSet};

/// A word and its position.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Word {
    /// The word's text, as written.
    pub text: String,
    /// The word's position, or the default span in trees built by generators.
    pub span: Span,
}

impl From<&str> for Word {
    fn from(text: &str) -> Word {
        Word { text: text.to_owned(), span: Span::default() }
    }
}

impl From<String> for Word {
    fn from(text: String) -> Word {
        Word { text, span: Span::default() }
    }
}

/// A parameter, `key=value`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Param {
    /// The text before the equals sign.
    pub key: Word,
    /// The text after the equals sign, as written.
    pub value: Word,
}

impl Param {
    /// Creates a parameter for generated trees, with default spans.
    pub fn new(key: &str, value: impl ToString) -> Param {
        Param { key: key.into(), value: value.to_string().into() }
    }

    /// Returns the span from the key to the value.
    pub fn span(&self) -> Span {
        Span::new(self.key.span.start, self.value.span.end)
    }
}

/// The comments attached to a line. `arcade fmt` keeps them, and digests ignore them.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Trivia {
    /// The comment lines above the line, without the `#`.
    pub above: Vec<String>,
    /// The comment at the end of the line, without the `#`, if there is one.
    pub beside: Option<String>,
}

/// The first line: `BasicGame key=value …`.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Header {
    /// The word `BasicGame` or `GameSpace`.
    pub class: Word,
    /// The game's parameters.
    pub params: Vec<Param>,
    /// The line's comments.
    pub trivia: Trivia,
}

/// A sprite line, `name > Class key=value …`, with the lines indented below it.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct SpriteLine {
    /// The sprite type.
    pub name: Word,
    /// The class, if written on this line.
    pub class: Option<Word>,
    /// The parameters written on this line.
    pub params: Vec<Param>,
    /// The sprite types that inherit from this type.
    pub children: Vec<SpriteLine>,
    /// The line's comments.
    pub trivia: Trivia,
}

/// A mapping line, `c > name name …`.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct MappingLine {
    /// The level character.
    pub symbol: char,
    /// The position of the character.
    pub span: Span,
    /// The placed sprites, in the order of the line.
    pub names: Vec<Word>,
    /// The line's comments.
    pub trivia: Trivia,
}

/// An interaction line, `first second … > effect key=value …`.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct InteractionLine {
    /// The sprite on which the effect acts.
    pub first: Word,
    /// The first sprite's partners.
    pub second: Vec<Word>,
    /// The effect's keyword.
    pub effect: Word,
    /// The effect's parameters.
    pub params: Vec<Param>,
    /// The line's comments.
    pub trivia: Trivia,
}

/// A termination line, `Class key=value …`.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct TerminationLine {
    /// The termination class.
    pub class: Word,
    /// The termination's parameters.
    pub params: Vec<Param>,
    /// The line's comments.
    pub trivia: Trivia,
}

/// A parameter line of a `GameSpace`, `NAME > values=min:step:max value=x`.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct ParameterLine {
    /// The parameter's name, which other lines contain as a value.
    pub name: Word,
    /// The parameters `values`, `value` and `string`.
    pub params: Vec<Param>,
    /// The line's comments.
    pub trivia: Trivia,
}

/// A whole game file.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Description {
    /// The first line.
    pub header: Header,
    /// The lines of the SpriteSet, as a forest.
    pub sprites: Vec<SpriteLine>,
    /// The lines of the LevelMapping.
    pub mapping: Vec<MappingLine>,
    /// The lines of the InteractionSet.
    pub interactions: Vec<InteractionLine>,
    /// The lines of the TerminationSet.
    pub terminations: Vec<TerminationLine>,
    /// For each section, in the order of [`Section::ALL`], `true` if the file contains the section.
    pub has: [bool; 4],
    /// The comments on the section name lines, in the order of [`Section::ALL`], followed by the comments on
    /// the ParameterSet's line.
    pub section_trivia: [Trivia; 5],
    /// The comments below the last line.
    pub tail: Vec<String>,
    /// The ParameterSet lines of a `GameSpace`.
    pub parameters: Vec<ParameterLine>,
    /// The sections in file order, each with the number of its lines that the reference reads. The reference
    /// reads nothing after a fault.
    pub order: Vec<(Section, usize)>,
    /// The number of messages that the reference would have logged while reading the lines.
    pub messages: u32,
}

impl Description {
    /// The names with a built-in meaning in the engine.
    pub const RESERVED_NAMES: [&str; 2] = ["wall", "avatar"];

    /// Returns every sprite line in pre-order, each with its depth.
    pub fn sprite_lines(&self) -> Vec<(usize, &SpriteLine)> {
        fn walk<'a>(lines: &'a [SpriteLine], depth: usize, out: &mut Vec<(usize, &'a SpriteLine)>) {
            for line in lines {
                out.push((depth, line));
                walk(&line.children, depth + 1, out);
            }
        }
        let mut out = Vec::new();
        walk(&self.sprites, 0, &mut out);
        out
    }

    /// Returns the names of the types that the file declares, without duplicates and without
    /// [`Description::RESERVED_NAMES`].
    pub fn own_names(&self) -> Vec<&str> {
        let mut seen = BTreeSet::from(Description::RESERVED_NAMES);
        let lines = self.sprite_lines().into_iter();
        lines.map(|(_, line)| line.name.text.as_str()).filter(|name| seen.insert(*name)).collect()
    }
}

/// Maps names to `t1`, `t2` and so on, in a random order drawn from `sampler`.
pub fn meaningless_names(names: &[&str], sampler: &mut Sampler) -> BTreeMap<String, String> {
    let mut numbers: Vec<usize> = (1..=names.len()).collect();
    sampler.shuffle(&mut numbers);
    names.iter().zip(numbers).map(|(name, number)| ((*name).to_owned(), format!("t{number}"))).collect()
}

/// The sections of a game file, in canonical order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Section {
    /// The sprite types.
    SpriteSet,
    /// The sprites that each level character places.
    LevelMapping,
    /// The effects of interactions between sprites.
    InteractionSet,
    /// The conditions that end the game.
    TerminationSet,
    /// The parameters of a `GameSpace`.
    ParameterSet,
}

impl Section {
    /// The sections of every game, in canonical order.
    pub const ALL: [Section; 4] =
        [Section::SpriteSet, Section::LevelMapping, Section::InteractionSet, Section::TerminationSet];

    /// Returns the section's name as written in files.
    pub fn name(self) -> &'static str {
        match self {
            Section::SpriteSet => "SpriteSet",
            Section::LevelMapping => "LevelMapping",
            Section::InteractionSet => "InteractionSet",
            Section::TerminationSet => "TerminationSet",
            Section::ParameterSet => "ParameterSet",
        }
    }
}
