//! Game text: layout, grammar, syntax tree, canonical print. `pest` does not leave this module.

mod bounds;
mod description;
mod grammar;
mod indents;
mod layout;
mod lines;
mod literal;
mod parse;
mod print;
mod reference;
mod repair;
mod sections;
mod tokens;

pub use description::{
    Description, Header, InteractionLine, MappingLine, Param, ParameterLine, Section, SpriteLine,
    TerminationLine, Trivia, Word, meaningless_names,
};
pub(crate) use layout::BYTE_ORDER_MARK;
pub(crate) use literal::{Literal, literal};
pub(crate) use parse::parse_all;
pub use parse::{parse, parse_as_reference};
pub use print::{print, print_bare};
