//! Checks for the files that describe a whole release: `README.md` and `CARD.json`.

use crate::card::{ReleaseCard, Rung, counted, generator};
use crate::contents::Contents;
use crate::error::SnapshotError;
use crate::format::canary::carries;
use crate::format::layout::{README_FILE, RELEASE_CARD_FILE};
use crate::format::manifest::Manifest;
use crate::format::plausible::CARD_AND_CANARY_SINCE;
use forge::card::{Card, Origin};
use generators::GENERATION;
use report::Quantiles;
use serde_json::Value;

/// Returns the problems with both files, given the games' cards.
pub(super) fn problems(
    contents: &Contents,
    manifest: &Manifest,
    cards: &[&Card],
) -> Result<Vec<String>, SnapshotError> {
    let mut problems = Vec::new();
    let read = |path: &str| manifest.item(path).map(|item| contents.read(&item.path)).transpose();
    match read(README_FILE)? {
        None => problems.push(format!("{README_FILE}: missing, but required in every release")),
        Some(text) if !carries(&text, &manifest.canary) => {
            problems.push(format!("{README_FILE}: the release's canary is missing"));
        }
        Some(_) => {}
    }
    match read(RELEASE_CARD_FILE)? {
        None if manifest.generation < CARD_AND_CANARY_SINCE => {}
        None => problems.push(format!("{RELEASE_CARD_FILE}: missing, but required in every release")),
        Some(text) => problems.extend(
            of_card(&text, manifest, cards).into_iter().map(|what| format!("{RELEASE_CARD_FILE}: {what}")),
        ),
    }
    Ok(problems)
}

/// Returns the problems with a release's card. The layout is known only for cards of the current generation.
/// For other generations, only the counts common to all generations are compared.
fn of_card(text: &[u8], manifest: &Manifest, cards: &[&Card]) -> Vec<String> {
    let value: Value = match serde_json::from_slice(text) {
        Ok(value @ Value::Object(_)) => value,
        Ok(_) => return vec!["not a valid release card: not a JSON object".to_owned()],
        Err(error) => return vec![format!("not a valid release card: {error}")],
    };
    let mut problems = Vec::new();
    if value.get("canary").and_then(Value::as_str) != Some(&manifest.canary) {
        problems.push("the canary differs from the release's canary".to_owned());
    }
    let is_new = |card: &&&Card| matches!(card.origin, Origin::Generated { .. });
    let levels = cards.iter().map(|card| card.levels.len()).sum::<usize>();
    let counts =
        [("games", cards.len()), ("levels", levels), ("new_games", cards.iter().filter(is_new).count())];
    for (key, found) in counts {
        let stated = &value[key];
        if stated.as_u64() != Some(found as u64) {
            problems.push(format!("the card's `{key}` is {stated}, but the release has {found}"));
        }
    }
    if manifest.generation != GENERATION || !problems.is_empty() {
        return problems;
    }
    match serde_json::from_value::<ReleaseCard>(value) {
        Ok(card) => problems.extend(of_known_card(&card, cards)),
        Err(error) => problems.push(format!("not a valid release card: {error}")),
    }
    problems
}

/// Compares a release's card with the cards of its games.
fn of_known_card(card: &ReleaseCard, cards: &[&Card]) -> Vec<String> {
    let mut problems = Vec::new();
    let mut expect = |key: &str, holds: bool| {
        if !holds {
            problems.push(format!("the card's `{key}` does not match the games' cards"));
        }
    };
    let levels = || cards.iter().flat_map(|card| &card.levels);
    let ladders = levels().filter_map(|level| level.ladder.as_ref());
    expect(
        "difficulty",
        card.difficulty == counted(ladders.map(|found| found.difficulty.to_string().replace(' ', "_"))),
    );
    expect("generators", card.generators == counted(cards.iter().map(|card| generator(card))));
    let patterns = cards.iter().flat_map(|card| card.origin.mechanics()).map(str::to_owned);
    expect("patterns", card.patterns == counted(patterns));
    let games = cards.len() as u64;
    expect("goals", card.goals.values().sum::<u64>() == games);
    expect("avatars", card.avatars.values().sum::<u64>() == games);
    let ticks: Vec<f64> = levels().map(|level| level.witness_ticks as f64).collect();
    expect("witness_ticks", card.witness_ticks == Quantiles::of(&ticks));
    let is_share = |share: f64| (0.0..=1.0).contains(&share);
    let sensible = |rung: &Rung| {
        let rate = &rung.rate;
        rate.wins <= rate.plays && is_share(rate.mean) && rate.interval.into_iter().all(is_share)
    };
    expect("ladder", card.ladder.iter().all(sensible));
    problems
}
