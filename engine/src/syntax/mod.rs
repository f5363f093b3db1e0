//! Game text: layout, grammar, syntax tree and canonical form. `pest` is used only in this module.

mod description;
mod grammar;
mod literal;
mod parse;
mod print;
mod reference;

pub use description::{
    Description, Header, InteractionLine, MappingLine, Param, ParameterLine, Section, SpriteLine,
    TerminationLine, Trivia, Word, meaningless_names,
};
pub(crate) use literal::{Literal, literal};
pub(crate) use parse::layout::BYTE_ORDER_MARK;
pub(crate) use parse::parse_all;
pub use parse::{parse, parse_as_reference};
pub use print::{print, print_bare};
