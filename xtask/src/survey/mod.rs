//! Surveys of folders of games: the levels that the constructive generator makes for them (`survey`), and two groups of games
//! compared (`side-by-side`).

pub(crate) mod levels;
mod missing;
pub(crate) mod side_by_side;

use anyhow::{Context, bail};
use std::fs;
use std::path::{Path, PathBuf};

/// The folders of games in a folder, by name.
fn folders(games: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let mut folders: Vec<PathBuf> = fs::read_dir(games)
        .with_context(|| games.display().to_string())?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<_, _>>()?;
    folders.retain(|path| ["game.vgdl", "game.txt"].iter().any(|file| path.join(file).exists()));
    folders.sort();
    if folders.is_empty() {
        bail!("{}: no folder with a game there", games.display());
    }
    Ok(folders)
}

fn name_of(folder: &Path) -> String {
    folder.file_name().unwrap_or_default().to_string_lossy().into_owned()
}
