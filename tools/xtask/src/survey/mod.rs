//! Surveys of game folders. `survey` judges the levels that the constructive generator creates for the games,
//! and `side-by-side` compares two groups of games.

pub(crate) mod levels;
mod missing;
pub(crate) mod side_by_side;

use anyhow::bail;
use std::path::{Path, PathBuf};

/// Returns the subfolders that contain a game, sorted by name.
fn folders(games: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let mut folders = crate::levels::folders(games, &[])?;
    folders.retain(|(_, path)| ["game.vgdl", "game.txt"].iter().any(|file| path.join(file).exists()));
    if folders.is_empty() {
        bail!("{}: contains no folder with a game", games.display());
    }
    Ok(folders.into_iter().map(|(_, folder)| folder).collect())
}
