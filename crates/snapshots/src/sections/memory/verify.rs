//! Checks of the withheld members of pairs, which are siblings (renamed copies) of games and second wins of levels.

use super::pairs::{SecretGame, pair_flaw};
use super::part::MemoryPart;
use crate::contents::replay::{Replayed, replay};
use crate::error::SnapshotError;
use crate::format::canary::carries;
use crate::format::layout::{second_path, sibling_path};
use crate::format::witness::Witness;
use crate::recipe::secret::UNRELATED_WITNESS;
use crate::sections::section::{CheckedGame, Checking, Found};

/// Checks a game's pairs in a sealed release: two renamings of the game, and two wins of each level. For files that are
/// still withheld, checks only that all of them are listed.
pub(super) fn check_pairs(
    release: &Checking<'_>,
    checked: &CheckedGame<'_>,
    found: &mut Found,
) -> Result<(), SnapshotError> {
    let Some(part) = MemoryPart::of(release.manifest) else { return Ok(()) };
    if part.siblings {
        check_sibling(release, checked, found)?;
    }
    if part.witnesses {
        for number in 0..checked.levels.len() {
            check_second(release, checked, number, found)?;
        }
    }
    Ok(())
}

/// Checks a game's sibling, which is its withheld renamed copy.
fn check_sibling(
    release: &Checking<'_>,
    checked: &CheckedGame<'_>,
    found: &mut Found,
) -> Result<(), SnapshotError> {
    let &CheckedGame { folder, game, levels, .. } = checked;
    let path = sibling_path(folder, "game.vgdl");
    if release.manifest.item(&path).is_none() {
        return Ok(());
    }
    let files: Vec<String> =
        (0..levels.len()).map(|number| sibling_path(folder, &format!("lvl{number}.txt"))).collect();
    found.listed.push(path.clone());
    found.listed.extend(files.iter().cloned());
    let read = |path: &String| release.contents.find(path);
    let Some(source) = read(&path)? else { return Ok(()) };
    let mut wrong = |what: String| found.problems.push(format!("{path}: {what}"));
    if !carries(&source, &release.manifest.canary) {
        wrong("the release's canary is missing".to_owned());
    }
    let texts = files.iter().map(|file| Ok(read(file)?.and_then(|bytes| String::from_utf8(bytes).ok())));
    let texts: Option<Vec<String>> =
        texts.collect::<Result<Vec<Option<String>>, SnapshotError>>()?.into_iter().collect();
    let (Ok(source), Some(texts)) = (String::from_utf8(source), texts) else {
        wrong("the sibling or a level of it is missing or not a text file".to_owned());
        return Ok(());
    };
    let root = release.secret.and_then(|secret| secret.seed_for(&release.manifest.recipe));
    let flaw = match SecretGame::load(&source, &texts) {
        Ok(secret) => secret.flaw(game, levels, root),
        Err(what) => Some(what),
    };
    if let Some(what) = flaw {
        wrong(what);
    }
    Ok(())
}

/// Checks a level's withheld win. The win of a duplicate game is not replayed.
fn check_second(
    release: &Checking<'_>,
    checked: &CheckedGame<'_>,
    number: usize,
    found: &mut Found,
) -> Result<(), SnapshotError> {
    let &CheckedGame { folder, game, levels, is_again } = checked;
    let path = second_path(folder, number);
    if release.manifest.item(&path).is_none() {
        return Ok(());
    }
    found.listed.push(path.clone());
    let Some(bytes) = release.contents.find(&path)? else { return Ok(()) };
    let mut wrong = |what: String| found.problems.push(format!("{path}: {what}"));
    let witness: Witness = match serde_json::from_slice(&bytes) {
        Ok(witness) => witness,
        Err(error) => {
            wrong(format!("not a valid witness: {error}"));
            return Ok(());
        }
    };
    if witness.canary != release.manifest.canary {
        wrong("the canary differs from the release's canary".to_owned());
    }
    if release.secret.is_some_and(|secret| !secret.leads_to(&witness, &release.manifest.recipe)) {
        wrong(UNRELATED_WITNESS.to_owned());
    }
    let (level, published) = &levels[number];
    let root = release.secret.and_then(|secret| secret.seed_for(&release.manifest.recipe));
    if let Some(what) = pair_flaw(published.as_ref(), &witness.episode, root) {
        wrong(what);
    }
    let meter = release.meter.filter(|_| !is_again);
    match meter.map(|meter| replay(&witness.episode, game, level, meter)) {
        Some(Replayed::Won) => found.replayed += 1,
        Some(Replayed::Wrong(what)) => wrong(what),
        Some(Replayed::OutOfWork) | None => {}
    }
    Ok(())
}
