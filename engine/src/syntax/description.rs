//! The syntax tree of a game file: what is written, nothing resolved.

use crate::diagnostic::Span;

/// A word and where it stands.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Word {
    /// As written.
    pub text: String,
    /// Where; nowhere in trees that generators build.
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

/// `key=value`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Param {
    /// Before the equals sign.
    pub key: Word,
    /// After it, as written.
    pub value: Word,
}

impl Param {
    /// A parameter that a generator writes.
    pub fn new(key: &str, value: impl ToString) -> Param {
        Param { key: key.into(), value: value.to_string().into() }
    }

    /// From the key to the value.
    pub fn span(&self) -> Span {
        Span::new(self.key.span.start, self.value.span.end)
    }
}

/// Comments that belong to a line; kept by `arcade fmt`, absent from digests.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Trivia {
    /// Whole-line comments above, without the `#`.
    pub above: Vec<String>,
    /// The comment at the end of the line, without the `#`.
    pub beside: Option<String>,
}

/// The first line: `BasicGame key=value …`.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Header {
    /// `BasicGame`, or `GameSpace`.
    pub class: Word,
    /// Its parameters.
    pub params: Vec<Param>,
    /// Its comments.
    pub trivia: Trivia,
}

/// `name > Class key=value …` and the lines indented below it.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct SpriteLine {
    /// The sprite type.
    pub name: Word,
    /// The class, if written here.
    pub class: Option<Word>,
    /// The parameters written here.
    pub params: Vec<Param>,
    /// Sprite types that inherit from this one.
    pub children: Vec<SpriteLine>,
    /// Its comments.
    pub trivia: Trivia,
}

/// `c > name name …`.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct MappingLine {
    /// The level character.
    pub symbol: char,
    /// Where it stands.
    pub span: Span,
    /// The sprites placed, in order.
    pub names: Vec<Word>,
    /// Its comments.
    pub trivia: Trivia,
}

/// `first second … > effect key=value …`.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct InteractionLine {
    /// The sprite acted upon.
    pub first: Word,
    /// Its partners.
    pub second: Vec<Word>,
    /// What happens.
    pub effect: Word,
    /// With which parameters.
    pub params: Vec<Param>,
    /// Its comments.
    pub trivia: Trivia,
}

/// `Class key=value …`.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct TerminationLine {
    /// The termination class.
    pub class: Word,
    /// With which parameters.
    pub params: Vec<Param>,
    /// Its comments.
    pub trivia: Trivia,
}

/// `NAME > values=min:step:max value=x`, of a `GameSpace`.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct ParameterLine {
    /// The parameter: other lines have it for a value.
    pub name: Word,
    /// `values`, `value` and `string`.
    pub params: Vec<Param>,
    /// Its comments.
    pub trivia: Trivia,
}

/// A whole game file.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Description {
    /// The first line.
    pub header: Header,
    /// SpriteSet, as a forest.
    pub sprites: Vec<SpriteLine>,
    /// LevelMapping.
    pub mapping: Vec<MappingLine>,
    /// InteractionSet.
    pub interactions: Vec<InteractionLine>,
    /// TerminationSet.
    pub terminations: Vec<TerminationLine>,
    /// Which sections the file has, in the order of [`Section::ALL`].
    pub has: [bool; 4],
    /// The comments of the lines that name the sections, in the same order; those of the ParameterSet are the last ones.
    pub section_trivia: [Trivia; 5],
    /// Comments below the last line.
    pub tail: Vec<String>,
    /// ParameterSet, of a `GameSpace`.
    pub parameters: Vec<ParameterLine>,
    /// The sections in the order of the file, each with how many lines of it the reference reads; what comes after a fault
    /// is missing for it.
    pub order: Vec<(Section, usize)>,
    /// Messages that the reference would have logged while reading the lines.
    pub messages: u32,
}

impl Description {
    /// Every sprite line in pre-order, each with its depth.
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
}

/// The sections of a game file, in canonical order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Section {
    /// What exists.
    SpriteSet,
    /// Which level character places what.
    LevelMapping,
    /// What happens when sprites meet.
    InteractionSet,
    /// When the game ends.
    TerminationSet,
    /// What may vary, in a `GameSpace`.
    ParameterSet,
}

impl Section {
    /// Those of every game, in canonical order.
    pub const ALL: [Section; 4] =
        [Section::SpriteSet, Section::LevelMapping, Section::InteractionSet, Section::TerminationSet];

    /// As written in a file.
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
