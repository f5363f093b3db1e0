//! Requests for judging pairs of games.

use super::boards::Replayed;
use super::release::Nothing;
use crate::answers::Asker;
use crate::judging::{Asked, Judging, Wanted};
use crate::refusal::Refusal;
use crate::studio::Studio;
use serde_json::{Value, json};

fn opened(studio: &Studio) -> Result<&Judging, Refusal> {
    let missing = || Refusal::missing("there is nothing to judge").help("pass game folders with --judge");
    studio.judging.as_deref().ok_or_else(missing)
}

pub(crate) fn next(studio: &Studio) -> Result<Value, Refusal> {
    Ok(opened(studio)?.next())
}

pub(crate) fn add(studio: &Studio, asked: Asked) -> Result<Value, Refusal> {
    opened(studio)?.add(asked)?;
    Ok(json!({}))
}

pub(crate) fn watch(studio: &Studio, wanted: Wanted, asker: &Asker) -> Result<Replayed, Refusal> {
    opened(studio)?.watch(&studio.compiled, wanted, &|| asker.is_gone())
}

pub(crate) fn report(studio: &Studio) -> Result<Value, Refusal> {
    Ok(opened(studio)?.report())
}

pub(crate) fn end(studio: &Studio, _: Nothing) -> Result<Value, Refusal> {
    opened(studio)?.end_blinding();
    Ok(json!({}))
}
