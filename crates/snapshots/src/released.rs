//! The parsed games of a verified release, which are the input for exports and comparisons.

use crate::Digest;
use crate::check::{Verification, verify};
use crate::contents::Contents;
use crate::contents::integrity::Integrity;
use crate::error::SnapshotError;
use crate::format::layout::{second_path, sibling_path, witness_path};
use crate::format::manifest::{MANIFEST_FILE, Manifest};
use crate::format::witness::Witness;
use crate::sections::marks::Marks;
use crate::sections::memory::{PREFIX, SecretGame};
use engine::{Action, Episode, Game, Level};
use forge::card::Card;
use rayon::prelude::*;
use std::path::Path;

/// A verified release, with its games parsed.
#[derive(Clone, Debug)]
pub struct Released {
    /// The release's manifest.
    pub manifest: Manifest,
    /// The games, sorted by the bytes of their folder names.
    pub games: Vec<ReleasedGame>,
    /// The reference results, if the release contains them in a known format and they are not withheld.
    pub marks: Option<Marks>,
}

/// A game in a release.
#[derive(Clone, Debug)]
pub struct ReleasedGame {
    /// The card, with the game's description and its judges' results.
    pub card: Card,
    /// The text, as released.
    pub source: String,
    /// The game compiled from the released text.
    pub game: Game,
    /// The levels, in card order.
    pub levels: Vec<ReleasedLevel>,
    /// The game's sibling: a renamed copy. A secret random choice decided which of the two was withheld. `None` if
    /// there is no sibling, or if it has not been revealed.
    pub sibling: Option<ReleasedSibling>,
}

/// A game's sibling: the same rules and levels under different names.
#[derive(Clone, Debug)]
pub struct ReleasedSibling {
    /// The text, as released.
    pub source: String,
    /// The game compiled from the sibling's text.
    pub game: Game,
    /// The levels, with their texts as released.
    pub levels: Vec<(String, Level)>,
}

/// A level in a release.
#[derive(Clone, Debug)]
pub struct ReleasedLevel {
    /// The text, as released.
    pub text: String,
    /// The level, parsed from its text.
    pub level: Level,
    /// A winning episode, if the release contains one.
    pub witness: Option<Episode>,
    /// The second win, which was withheld by a secret random choice. `None` if it does not exist or has not been
    /// revealed.
    pub second: Option<Episode>,
}

impl ReleasedLevel {
    /// Returns the first actions of the published win and of the withheld win. The two lists differ, and have the
    /// same length of at most [`PREFIX`] actions. Returns `None` if either win is missing.
    pub fn beginnings(&self) -> Option<[Vec<Action>; 2]> {
        let (published, withheld) = (&self.witness.as_ref()?.actions, &self.second.as_ref()?.actions);
        let common = PREFIX.min(published.len()).min(withheld.len());
        Some([published, withheld].map(|actions| actions[..common].to_vec()))
    }
}

/// A reason why a release cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReleasedError {
    /// The path is not a release, or cannot be read.
    #[error(transparent)]
    Snapshot(#[from] SnapshotError),
    /// The release failed verification.
    #[error("{} does not verify: {}", .0.name, .0.problems.first().map_or("", String::as_str))]
    Unsound(Box<Verification>),
    /// A file changed between verification and reading.
    #[error("`{0}` changed while it was being read: try again")]
    Changed(String),
}

impl Released {
    /// Verifies the release at `root`, which is a folder or an archive, and reads it.
    ///
    /// Cost: one [`verify()`], plus a second pass over the files.
    ///
    /// # Errors
    /// Returns an error if the release does not verify or cannot be read.
    pub fn read(root: &Path) -> Result<Released, ReleasedError> {
        let verification = verify(root)?;
        if !verification.problems.is_empty() {
            return Err(ReleasedError::Unsound(Box::new(verification)));
        }
        let (Integrity { manifest, .. }, contents) = Contents::open(root)?;
        if manifest.root != verification.root {
            return Err(ReleasedError::Changed(MANIFEST_FILE.to_owned()));
        }
        let folder_of = |path: &str| path.strip_suffix("/card.json").map(str::to_owned);
        let folders: Vec<String> = manifest.items.iter().filter_map(|item| folder_of(&item.path)).collect();
        let games = folders.into_par_iter().map(|folder| read_game(&contents, &manifest, &folder));
        let games = games.collect::<Result<_, _>>()?;
        let path = Marks::path_in(&manifest);
        let text = path.map(|path| contents.find(&path)).transpose()?.flatten();
        let marks = text.and_then(|text| Marks::read(&text).ok());
        Ok(Released { manifest, games, marks })
    }

    /// Returns the total number of levels in all games.
    pub fn levels(&self) -> usize {
        self.games.iter().map(|game| game.levels.len()).sum()
    }
}

fn read_game(contents: &Contents, manifest: &Manifest, folder: &str) -> Result<ReleasedGame, ReleasedError> {
    // All files were well-formed when they were verified, and their digests reveal later changes.
    let read = |path: String| -> Result<Option<String>, ReleasedError> {
        let Some(item) = manifest.item(&path) else { return Ok(None) };
        // A listed file is absent only if it is withheld.
        let Some(bytes) = contents.find(&path)? else { return Ok(None) };
        if Digest::of(&bytes) != item.digest {
            return Err(ReleasedError::Changed(path));
        }
        String::from_utf8(bytes).map(Some).map_err(|_| ReleasedError::Changed(path))
    };
    let changed = |file: &str| ReleasedError::Changed(format!("{folder}/{file}"));
    let need = |file: &str| read(format!("{folder}/{file}"))?.ok_or_else(|| changed(file));
    let card: Card = serde_json::from_str(&need("card.json")?).map_err(|_| changed("card.json"))?;
    let source = need("game.vgdl")?;
    let game = Game::from_source(&source).map_err(|_| changed("game.vgdl"))?;
    let level = |number: usize| {
        let file = format!("lvl{number}.txt");
        let witness = witness_path(manifest.kind, &card.id, number);
        let text = need(&file)?;
        let level = game.level(&text).map_err(|_| changed(&file))?;
        let episode = |path: String| -> Result<Option<Episode>, ReleasedError> {
            let parse = |text: String| serde_json::from_str::<Witness>(&text);
            let witness = read(path.clone())?.map(parse).transpose();
            Ok(witness.map_err(|_| ReleasedError::Changed(path))?.map(|witness| witness.episode))
        };
        let (witness, second) = (episode(witness)?, episode(second_path(&card.id, number))?);
        Ok(ReleasedLevel { text, level, witness, second })
    };
    let levels: Vec<ReleasedLevel> =
        (0..card.levels.len()).map(level).collect::<Result<_, ReleasedError>>()?;
    let path = sibling_path(&card.id, "game.vgdl");
    let sibling = match read(path.clone())? {
        None => None,
        Some(source) => {
            let text = |number| {
                let path = sibling_path(&card.id, &format!("lvl{number}.txt"));
                read(path.clone())?.ok_or(ReleasedError::Changed(path))
            };
            let texts: Vec<String> = (0..levels.len()).map(text).collect::<Result<_, ReleasedError>>()?;
            let secret = SecretGame::load(&source, &texts).map_err(|_| ReleasedError::Changed(path))?;
            Some(ReleasedSibling { source, game: secret.game, levels: secret.levels })
        }
    };
    Ok(ReleasedGame { card, source, game, levels, sibling })
}
