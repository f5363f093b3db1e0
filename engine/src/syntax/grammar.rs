//! The grammar of a line and of a value, `vgdl.pest`, as code.

#[derive(pest_derive::Parser)]
#[grammar = "syntax/vgdl.pest"]
pub(super) struct Grammar;
