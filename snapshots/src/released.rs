//! The games of a release that verifies, read: what exports and comparisons start from.

use crate::card::Card;
use crate::contents::Contents;
use crate::integrity::Integrity;
use crate::manifest::{Kind, MANIFEST_FILE, Manifest};
use crate::sealed::held_witness;
use crate::verify::{Verification, verify};
use crate::witness::Witness;
use crate::{Digest, SnapshotError};
use engine::{Episode, Game, Level};
use rayon::prelude::*;
use std::path::Path;

/// A release that verifies.
#[derive(Clone, Debug)]
pub struct Released {
    /// What it is and holds.
    pub manifest: Manifest,
    /// Its games, by the bytes of their folders' names.
    pub games: Vec<ReleasedGame>,
}

/// A game of a release.
#[derive(Clone, Debug)]
pub struct ReleasedGame {
    /// What it is, and what its judges found.
    pub card: Card,
    /// Its text, as in the release.
    pub source: String,
    /// It.
    pub game: Game,
    /// Its levels, in the order of the card.
    pub levels: Vec<ReleasedLevel>,
}

/// A level of a release.
#[derive(Clone, Debug)]
pub struct ReleasedLevel {
    /// Its text, as in the release.
    pub text: String,
    /// It.
    pub level: Level,
    /// The episode that wins it, if the release holds one.
    pub witness: Option<Episode>,
}

/// Why a release is not read.
#[derive(Debug, thiserror::Error)]
pub enum ReleasedError {
    /// It is no release, or cannot be read.
    #[error(transparent)]
    Snapshot(#[from] SnapshotError),
    /// It does not verify.
    #[error("{} does not verify: {}", .0.name, .0.problems.first().map_or("", String::as_str))]
    Unsound(Box<Verification>),
    /// It changed between being verified and being read.
    #[error("`{path}` changed while it was read: try again")]
    Changed {
        /// The file.
        path: String,
    },
}

impl Released {
    /// Verifies the release at `root`, a folder or an archive, and reads it. Cost: that of [`verify()`], and a second pass over the
    /// files.
    ///
    /// # Errors
    /// It does not verify, or cannot be read.
    pub fn read(root: &Path) -> Result<Released, ReleasedError> {
        let verification = verify(root)?;
        if !verification.problems.is_empty() {
            return Err(ReleasedError::Unsound(Box::new(verification)));
        }
        let (Integrity { manifest, .. }, contents) = Contents::open(root)?;
        if manifest.root != verification.root {
            return Err(ReleasedError::Changed { path: MANIFEST_FILE.to_owned() });
        }
        let folder_of = |path: &str| path.strip_suffix("/card.json").map(str::to_owned);
        let folders: Vec<String> = manifest.items.iter().filter_map(|item| folder_of(&item.path)).collect();
        let games = folders.into_par_iter().map(|folder| read_game(&contents, &manifest, &folder));
        let games = games.collect::<Result<_, _>>()?;
        Ok(Released { manifest, games })
    }

    /// How many levels all games have.
    pub fn levels(&self) -> usize {
        self.games.iter().map(|game| game.levels.len()).sum()
    }
}

fn read_game(contents: &Contents, manifest: &Manifest, folder: &str) -> Result<ReleasedGame, ReleasedError> {
    // All was well-formed when the release was verified; the digest tells whether it is still the same.
    let read = |path: String| -> Result<Option<String>, ReleasedError> {
        let found = manifest.items.binary_search_by(|item| item.path.as_str().cmp(&path));
        let Ok(at) = found else { return Ok(None) };
        // Listed and not there is only what is held back.
        let Some(bytes) = contents.find(&path)? else { return Ok(None) };
        if Digest::of(&bytes) != manifest.items[at].digest {
            return Err(ReleasedError::Changed { path });
        }
        String::from_utf8(bytes).map(Some).map_err(|_| ReleasedError::Changed { path })
    };
    let changed = |file: &str| ReleasedError::Changed { path: format!("{folder}/{file}") };
    let need = |file: &str| read(format!("{folder}/{file}"))?.ok_or_else(|| changed(file));
    let card: Card = serde_json::from_str(&need("card.json")?).map_err(|_| changed("card.json"))?;
    let source = need("game.vgdl")?;
    let game = Game::from_source(&source).map_err(|_| changed("game.vgdl"))?;
    let level = |number: usize| {
        let file = format!("lvl{number}.txt");
        let witness = match manifest.kind {
            Kind::Open => format!("{folder}/witness/lvl{number}.json"),
            Kind::Sealed => held_witness(&card.id, number),
        };
        let text = need(&file)?;
        let level = game.level(&text).map_err(|_| changed(&file))?;
        let text_of_witness = read(witness.clone())?;
        let parse = |text: String| serde_json::from_str::<Witness>(&text);
        let witness =
            text_of_witness.map(parse).transpose().map_err(|_| ReleasedError::Changed { path: witness })?;
        let witness = witness.map(|witness| witness.episode);
        Ok(ReleasedLevel { text, level, witness })
    };
    let levels = (0..card.levels.len()).map(level).collect::<Result<_, ReleasedError>>()?;
    Ok(ReleasedGame { card, source, game, levels })
}
