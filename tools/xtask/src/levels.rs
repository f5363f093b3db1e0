//! Loads games and their levels from folders.

use anyhow::Context;
use engine::{Game, Level};
use std::fs;
use std::path::{Path, PathBuf};

/// Returns the subfolders with the given names, sorted by name, or all subfolders if `only` is empty.
pub(crate) fn folders(games: &Path, only: &[String]) -> anyhow::Result<Vec<(String, PathBuf)>> {
    let mut folders: Vec<PathBuf> = fs::read_dir(games)
        .with_context(|| games.display().to_string())?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<_, _>>()?;
    folders.sort();
    let named = folders.into_iter().map(|folder| (name_of(&folder), folder));
    Ok(named.filter(|(name, _)| only.is_empty() || only.contains(name)).collect())
}

pub(crate) fn name_of(folder: &Path) -> String {
    folder.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Loads a game and its levels in the same way as the reference does.
pub(crate) fn load(folder: &Path) -> anyhow::Result<(Game, Vec<Level>)> {
    let file = ["game.vgdl", "game.txt"].map(|file| folder.join(file)).into_iter().find(|path| path.exists());
    let file =
        file.with_context(|| format!("{}: contains neither game.vgdl nor game.txt", folder.display()))?;
    let read = |path: &Path| fs::read_to_string(path).with_context(|| path.display().to_string());
    let game = Game::from_source_as_reference(&read(&file)?);
    let game = game.map_err(|problems| anyhow::anyhow!("{}: {problems:?}", file.display()))?;
    let mut levels = Vec::new();
    for number in 0.. {
        let path = folder.join(format!("lvl{number}.txt"));
        if !path.exists() {
            break;
        }
        let level = game.level(&read(&path)?);
        levels.push(level.map_err(|problems| anyhow::anyhow!("{}: {problems:?}", path.display()))?);
    }
    Ok((game, levels))
}
