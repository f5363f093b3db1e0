//! A release's ancestors, whose games and levels a new release must not repeat.

use crate::Digest;
use crate::contents::Contents;
use crate::error::SnapshotError;
use crate::format::manifest::Manifest;
use crate::recipe::Recipe;
use crate::recipe::known::{Known, item};
use base::Seed;
use engine::{Analysis, Game, syntax};
use forge::card::{Card, Origin};
use generators::games::Masked;
use generators::invention::Census;
use generators::levels::LevelSimilarity;
use std::collections::BTreeMap;
use std::path::Path;
use validators::novelty::GameForm;

/// A reason why a release cannot follow the given parent.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum AncestryError {
    /// The recipe states a parent other than the given release.
    #[error("the recipe's parent is {asked}, but the root of `{name}` is {found}")]
    OtherParent {
        /// The root stated in the recipe.
        asked: Digest,
        /// The given release's root.
        found: Digest,
        /// The given release's name.
        name: String,
    },
    /// The parent is damaged.
    #[error("the parent does not verify: {0}")]
    Damaged(String),
    /// The parent's record of its own ancestors is in a different version's format.
    #[error(
        "the parent's list of earlier releases cannot be read ({0}): use the version of arcade that minted the parent"
    )]
    Unreadable(serde_json::Error),
    /// An ancestor has the same name.
    #[error("an earlier release is named `{0}`: choose another name")]
    SameName(String),
    /// The folder cannot be read.
    #[error(transparent)]
    Snapshot(#[from] SnapshotError),
}

/// The games and levels of a release, which later releases must not repeat.
#[derive(Debug, Default)]
pub(crate) struct Holdings {
    /// The rules of the release's generated games, with all names removed, in the order of the manifest's items.
    games: Vec<String>,
    /// The use counts of the mechanics, endings and merged pairs of ports in the release's invented games.
    census: Census,
    /// The digests of the generated games' forms, each with the game's folder.
    pub(crate) forms: BTreeMap<Digest, String>,
    /// The digests of the canonical items in the release's corpus games, each with the path of its level.
    pub(crate) items: BTreeMap<Digest, String>,
}

impl Holdings {
    /// Reads the games and levels of a sound release. Cost: one pass over the release's games, and a few milliseconds
    /// per game.
    ///
    /// # Errors
    /// Returns an error if a card, a game or a level is malformed or cannot be read.
    pub(crate) fn read(contents: &Contents, manifest: &Manifest) -> Result<Holdings, AncestryError> {
        let damaged = |path: &str| AncestryError::Damaged(format!("{path}: not valid content for this path"));
        let read = |path: &str| -> Result<String, AncestryError> {
            String::from_utf8(contents.read(path)?).map_err(|_| damaged(path))
        };
        let mut found = Holdings::default();
        let cards = manifest.items.iter().map(|item| &item.path).filter(|path| path.ends_with("/card.json"));
        for path in cards {
            let card: Card = serde_json::from_str(&read(path)?).map_err(|_| damaged(path))?;
            let source = format!("games/{}/game.vgdl", card.id);
            let game = Game::from_source(&read(&source)?).map_err(|_| damaged(&source))?;
            let form = GameForm::of(&game);
            if let Origin::Generated { patterns, .. } = &card.origin {
                found.census.count(patterns.iter().map(String::as_str));
                let bare = Masked::of(game.description(), Seed::from_text(&card.id));
                found.games.push(syntax::print(bare.description()));
                found.forms.insert(form.digest(), card.id);
                continue;
            }
            let likeness = LevelSimilarity::of(&Analysis::of(&game));
            for level in &card.levels {
                let path = format!("games/{}/{}", card.id, level.file);
                let level = game.level(&read(&path)?).map_err(|_| damaged(&path))?;
                found.items.insert(item(&form, &likeness, &level), path);
            }
        }
        Ok(found)
    }

    /// Returns the `known` field for a release that follows the release described by `manifest`, whose games and
    /// levels `self` must contain.
    ///
    /// # Errors
    /// Returns an error if the manifest's own `known` field has a different version's format.
    pub(crate) fn known_after(&self, manifest: &Manifest) -> Result<Known, AncestryError> {
        // Only this part of the recipe is read, so that recipes with keys from other versions can be followed.
        let mut known: Known = match manifest.recipe.get("known") {
            None => Known::default(),
            Some(known) => serde_json::from_value(known.clone()).map_err(AncestryError::Unreadable)?,
        };
        known.releases.push(manifest.name.clone());
        known.games.extend(self.games.iter().cloned());
        known.items.extend(self.items.keys());
        for (pattern, uses) in self.census.all() {
            *known.patterns.entry(pattern.to_owned()).or_default() += uses;
        }
        Ok(known)
    }
}

/// Makes a recipe follow the release at `parent`, a folder or an archive. The recipe then states the parent's
/// root, and lists the games and levels of the parent and of all its ancestors.
///
/// Cost: one pass over the files, and a few milliseconds per game.
///
/// # Errors
/// Returns an error if the parent differs from the parent stated in the recipe, or if the parent is unsound.
pub fn follow(recipe: &mut Recipe, parent: &Path) -> Result<(), AncestryError> {
    let (integrity, contents) = Contents::open(parent)?;
    let manifest = &integrity.manifest;
    if let Some(problem) = integrity.problems.first() {
        return Err(AncestryError::Damaged(problem.to_string()));
    }
    if let Some(asked) = recipe.parent.filter(|asked| *asked != manifest.root) {
        return Err(AncestryError::OtherParent { asked, found: manifest.root, name: manifest.name.clone() });
    }
    let known = Holdings::read(&contents, manifest)?.known_after(manifest)?;
    if known.releases.contains(&recipe.name) {
        return Err(AncestryError::SameName(recipe.name.clone()));
    }
    recipe.parent = Some(manifest.root);
    recipe.known = known;
    Ok(())
}
