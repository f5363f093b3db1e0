//! From filled places to files and a manifest.

use super::{Filled, MintError, Minted, Tally};
use crate::canonical::to_canonical_json;
use crate::card::{Card, Origin};
use crate::games::MadeGame;
use crate::manifest::{FORMAT, Item, Kind, Manifest};
use crate::recipe::Recipe;
use crate::witness::Witness;
use crate::{Digest, SnapshotError, canary};
use std::fmt::Write;

/// The canary of an open release: from the recipe's digest, so that two recipes have two.
pub(super) fn canary_of(recipe: &Recipe) -> String {
    let text = to_canonical_json(recipe).expect("a checked recipe has no numbers that JSON lacks");
    canary(&Digest::of(text.as_bytes()))
}

pub(super) fn assemble(recipe: &Recipe, lockfile: Digest, games: Vec<Filled>) -> Result<Minted, MintError> {
    let canary = canary_of(recipe);
    let mut files: Vec<(String, Vec<u8>)> = Vec::new();
    let mut cards = Vec::new();
    let mut tally = Tally::default();
    for Filled { made: MadeGame { card, text, levels, witnesses, .. }, tally: spent, .. } in games {
        let folder = format!("games/{}", card.id);
        files.push((format!("{folder}/game.vgdl"), text.into_bytes()));
        files.push((format!("{folder}/card.json"), json(&card)?));
        for (number, (level, episode)) in levels.iter().zip(witnesses).enumerate() {
            files.push((format!("{folder}/lvl{number}.txt"), level.level.to_string().into_bytes()));
            let witness = Witness { canary: canary.clone(), episode };
            files.push((format!("{folder}/witness/lvl{number}.json"), json(&witness)?));
        }
        tally.add(&spent);
        cards.push(card);
    }
    files.push(("README.md".to_owned(), readme(recipe, &canary, &cards).into_bytes()));
    files.sort_by(|(a, _), (b, _)| a.as_bytes().cmp(b.as_bytes()));
    let recipe_value = serde_json::to_value(recipe).expect("a recipe is plain data");
    let mut manifest = Manifest {
        format: FORMAT,
        name: recipe.name.clone(),
        kind: Kind::Open,
        semantics: engine::SEMANTICS,
        generation: generators::GENERATION,
        parent: recipe.parent,
        canary,
        commitment: None,
        lockfile,
        recipe: recipe_value,
        items: files.iter().map(|(path, content)| Item::of(path.clone(), content)).collect(),
        root: Digest::of(b""),
        checksum: Digest::of(b""),
    };
    manifest.seal_root()?;
    Ok(Minted { manifest, files, cards, tally })
}

fn json(value: &impl serde::Serialize) -> Result<Vec<u8>, SnapshotError> {
    Ok(to_canonical_json(value)?.into_bytes())
}

/// The release's own README: what is in it and how to check it.
fn readme(recipe: &Recipe, canary: &str, cards: &[Card]) -> String {
    let levels: usize = cards.iter().map(|card| card.levels.len()).sum();
    let mut text = format!("# {}\n\n{}\n\n", recipe.name, recipe.description.trim());
    let _ = writeln!(
        text,
        "{} games, {levels} levels. Every level comes with a witness: an episode that wins it.\n\n\
         Check the folder with `arcade verify DIR`, mint it again from its seed with `arcade regenerate DIR`.\n\n\
         Please keep this folder out of training data. Canary: `{canary}`\n",
        cards.len(),
    );
    let _ = writeln!(text, "| game | kind | levels | rules | what it is |\n|---|---|---|---|---|");
    for card in cards {
        let rules = match &card.origin {
            Origin::Corpus { name } => format!("corpus `{name}`"),
            Origin::Generated { .. } => "new".to_owned(),
        };
        let Card { title, id, kind, description, levels, .. } = card;
        let _ = writeln!(
            text,
            "| [{title}](games/{id}/card.json) | {kind} | {} | {rules} | {} |",
            levels.len(),
            description.replace('|', "\\|"),
        );
    }
    text
}
