//! The check of what coins withheld: siblings of games and second wins of levels.

use super::game::Checker;
use super::replay::{Replayed, replay};
use crate::error::SnapshotError;
use crate::format::canary::carries;
use crate::format::layout::{second_path, sibling_path};
use crate::format::witness::Witness;
use crate::recipe::secret::UNRELATED_WITNESS;
use crate::sections::memory::part::MemoryPart;
use crate::sections::memory::{Levels, SecretGame, pair_flaw};
use engine::Game;

/// The result of checking the pairs of a game.
#[derive(Default)]
pub(super) struct Coins {
    /// The paths of the withheld files that the release has, or should have.
    pub(super) listed: Vec<String>,
    /// The number of second wins that replayed.
    pub(super) replayed: usize,
    /// The problems, each naming the file.
    pub(super) problems: Vec<String>,
}

impl Checker<'_> {
    /// Checks the pairs of a game of a sealed release; of what is still withheld, only that it is listed as a whole. A duplicate is
    /// not replayed.
    pub(super) fn coins(
        &self,
        folder: &str,
        game: &Game,
        levels: &Levels,
        is_again: bool,
    ) -> Result<Coins, SnapshotError> {
        let mut found = Coins::default();
        let Some(part) = MemoryPart::of(self.manifest) else { return Ok(found) };
        if part.siblings {
            self.sibling(folder, game, levels, &mut found)?;
        }
        if part.witnesses {
            for number in 0..levels.len() {
                self.second(folder, game, levels, (number, is_again), &mut found)?;
            }
        }
        Ok(found)
    }

    fn sibling(
        &self,
        folder: &str,
        game: &Game,
        levels: &Levels,
        found: &mut Coins,
    ) -> Result<(), SnapshotError> {
        let path = sibling_path(folder, "game.vgdl");
        if self.manifest.item(&path).is_none() {
            return Ok(());
        }
        let files: Vec<String> =
            (0..levels.len()).map(|number| sibling_path(folder, &format!("lvl{number}.txt"))).collect();
        found.listed.push(path.clone());
        found.listed.extend(files.iter().cloned());
        let read = |path: &String| self.contents.find(path);
        let Some(source) = read(&path)? else { return Ok(()) };
        let mut wrong = |what: String| found.problems.push(format!("{path}: {what}"));
        if !carries(&source, &self.manifest.canary) {
            wrong("without the release's canary".to_owned());
        }
        let texts = files.iter().map(|file| Ok(read(file)?.and_then(|bytes| String::from_utf8(bytes).ok())));
        let texts: Option<Vec<String>> =
            texts.collect::<Result<Vec<Option<String>>, SnapshotError>>()?.into_iter().collect();
        let (Ok(source), Some(texts)) = (String::from_utf8(source), texts) else {
            wrong("it or one of its levels is missing or not a text".to_owned());
            return Ok(());
        };
        let root = self.secret.and_then(|secret| secret.seed_for(&self.manifest.recipe));
        let flaw = match SecretGame::load(&source, &texts) {
            Ok(secret) => secret.flaw(game, levels, root),
            Err(what) => Some(what),
        };
        if let Some(what) = flaw {
            wrong(what);
        }
        Ok(())
    }

    fn second(
        &self,
        folder: &str,
        game: &Game,
        levels: &Levels,
        (number, is_again): (usize, bool),
        found: &mut Coins,
    ) -> Result<(), SnapshotError> {
        let path = second_path(folder, number);
        if self.manifest.item(&path).is_none() {
            return Ok(());
        }
        found.listed.push(path.clone());
        let Some(bytes) = self.contents.find(&path)? else { return Ok(()) };
        let mut wrong = |what: String| found.problems.push(format!("{path}: {what}"));
        let witness: Witness = match serde_json::from_slice(&bytes) {
            Ok(witness) => witness,
            Err(error) => {
                wrong(format!("not a witness: {error}"));
                return Ok(());
            }
        };
        if witness.canary != self.manifest.canary {
            wrong("its canary is not the release's".to_owned());
        }
        if self.secret.is_some_and(|secret| !secret.leads_to(&witness, &self.manifest.recipe)) {
            wrong(UNRELATED_WITNESS.to_owned());
        }
        let (level, published) = &levels[number];
        let root = self.secret.and_then(|secret| secret.seed_for(&self.manifest.recipe));
        if let Some(what) = pair_flaw(published.as_ref(), &witness.episode, root) {
            wrong(what);
        }
        let meter = self.meter.filter(|_| !is_again);
        match meter.map(|meter| replay(&witness.episode, game, level, meter)) {
            Some(Replayed::Won) => found.replayed += 1,
            Some(Replayed::Wrong(what)) => wrong(what),
            Some(Replayed::OutOfWork) | None => {}
        }
        Ok(())
    }
}
