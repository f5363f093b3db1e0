//! The grammar of lines and values, compiled from `vgdl.pest`.

#[derive(pest_derive::Parser)]
#[grammar = "syntax/vgdl.pest"]
pub(super) struct Grammar;
