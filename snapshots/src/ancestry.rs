//! The releases before: what a new one must not hold again.

use crate::card::{Card, Origin};
use crate::folder::{self, Limits};
use crate::integrity::check_integrity;
use crate::recipe::{Known, Recipe};
use crate::{Digest, SnapshotError};
use engine::{Analysis, Game, Seed, syntax};
use generators::games::Masked;
use generators::levels::Likeness;
use std::path::Path;
use validators::novelty::GameForm;

/// Why a release cannot follow another.
#[derive(Debug, thiserror::Error)]
pub enum AncestryError {
    /// The recipe names another parent.
    #[error("the recipe's parent is {asked}, but the root of `{name}` is {found}")]
    OtherParent {
        /// In the recipe.
        asked: Digest,
        /// Of the folder.
        found: Digest,
        /// Of the folder.
        name: String,
    },
    /// The parent is damaged.
    #[error("the parent does not verify: {0}")]
    Damaged(String),
    /// What the parent tells of its own ancestors is of another version.
    #[error(
        "what the parent knows of the releases before it cannot be read ({0}): use the arcade that minted it"
    )]
    Unreadable(serde_json::Error),
    /// A release of the same name is among the ancestors.
    #[error("a release named `{0}` came before: a release needs a name of its own")]
    SameName(String),
    /// The folder cannot be read.
    #[error(transparent)]
    Snapshot(#[from] SnapshotError),
}

/// The canonical item, rules and level, that a level of a game is: equal for the same but for names, the order of rules and the
/// symmetries of the board.
pub(crate) fn item(form: &GameForm, likeness: &Likeness, level: &engine::Level) -> Digest {
    Digest::of(format!("{} {}", form.digest(), likeness.digest(level)).as_bytes())
}

/// Lets a recipe follow the release in `parent`: the recipe names its root, and holds what it and all before it hold.
///
/// Cost: one pass over the files, and some milliseconds a game.
///
/// # Errors
/// The parent is not the one that the recipe names, or not sound.
pub fn follow(recipe: &mut Recipe, parent: &Path) -> Result<(), AncestryError> {
    let integrity = check_integrity(parent)?;
    let manifest = &integrity.manifest;
    if let Some(problem) = integrity.problems.first() {
        return Err(AncestryError::Damaged(problem.to_string()));
    }
    if let Some(asked) = recipe.parent.filter(|asked| *asked != manifest.root) {
        return Err(AncestryError::OtherParent { asked, found: manifest.root, name: manifest.name.clone() });
    }
    // Of the recipe this part alone, so that recipes with keys of other versions can be followed.
    let mut known: Known = match manifest.recipe.get("known") {
        None => Known::default(),
        Some(known) => serde_json::from_value(known.clone()).map_err(AncestryError::Unreadable)?,
    };
    known.releases.push(manifest.name.clone());
    if known.releases.contains(&recipe.name) {
        return Err(AncestryError::SameName(recipe.name.clone()));
    }
    let damaged = |path: &str| AncestryError::Damaged(format!("{path}: not what a release has there"));
    let read = |path: &str| -> Result<String, AncestryError> {
        let bytes = folder::read(parent, path, Limits::SNAPSHOT.file_bytes)?;
        String::from_utf8(bytes).map_err(|_| damaged(path))
    };
    for path in manifest.items.iter().map(|item| &item.path).filter(|path| path.ends_with("/card.json")) {
        let card: Card = serde_json::from_str(&read(path)?).map_err(|_| damaged(path))?;
        let source = format!("games/{}/game.vgdl", card.id);
        let game = Game::from_source(&read(&source)?).map_err(|_| damaged(&source))?;
        let form = GameForm::of(&game);
        if matches!(card.origin, Origin::Generated { .. }) {
            let bare = Masked::of(game.description(), Seed::from_text(&card.id));
            known.games.push(syntax::print(bare.description()));
            continue;
        }
        let likeness = Likeness::of(&Analysis::of(&game));
        for level in &card.levels {
            let path = format!("games/{}/{}", card.id, level.file);
            let level = game.level(&read(&path)?).map_err(|_| damaged(&path))?;
            known.items.insert(item(&form, &likeness, &level));
        }
    }
    recipe.parent = Some(manifest.root);
    recipe.known = known;
    Ok(())
}
