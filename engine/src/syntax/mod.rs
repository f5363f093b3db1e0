//! Game text: layout, grammar, syntax tree, canonical print. `pest` does not leave this module.

mod description;
mod indents;
mod layout;
mod parse;
mod print;
mod reference;
mod repair;
mod sections;

pub use description::{
    Description, Header, InteractionLine, MappingLine, Param, ParameterLine, Section, SpriteLine,
    TerminationLine, Trivia, Word,
};
pub(crate) use layout::BYTE_ORDER_MARK;
pub(crate) use parse::{Literal, literal, parse_all};
pub use parse::{parse, parse_as_reference};
pub use print::{print, print_bare};
