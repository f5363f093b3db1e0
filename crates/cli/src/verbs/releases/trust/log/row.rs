//! Leaderboard rows, computed from the episodes' logs.

use crate::failure::Failure;
use crate::input::text::sorted_entries;
use base::Digest;
use base::MessagePath;
use evaluation::Evaluation;
use evaluation::study::Study;
use snapshots::Manifest;
use snapshots::merkle::{self, Leaf};
use std::fs;
use std::path::Path;
use trust::log::{Entry, ResultRow};

/// Computes the row for a results folder whose release is in the log, replaying every episode.
pub(super) fn of(folder: &Path, entries: &[Entry]) -> Result<ResultRow, Failure> {
    let evaluation = Evaluation::open(folder)?;
    let settings = &evaluation.settings;
    let shown = folder.in_message();
    let Some(root) = settings.snapshot else {
        bail!("`{shown}`: these results do not belong to a release; evaluate a release folder");
    };
    let release = entries.iter().find_map(|entry| match entry {
        Entry::Root { release, root: found, .. } if *found == root => Some(release.clone()),
        _ => None,
    });
    let Some(release) = release else {
        bail!("`{shown}`: the results are on a release with root {root}, which is not in the log");
    };
    let study = Study::read(&[folder.to_path_buf()])?;
    let Some(row) = study.leaderboard.first() else { bail!("`{shown}`: no episode has been played yet") };
    let Some(rate) = row.scores.win_rate else { bail!("`{shown}`: no episode has ended yet") };
    Ok(ResultRow {
        release,
        root,
        results: digest(folder)?,
        player: study.players[row.player].label(),
        track: settings.track.clone(),
        horizon: settings.commit.to_string(),
        episodes: row.scores.episodes,
        // Episodes without a log count as open, so that nobody can hide losses by omitting their logs.
        open: (evaluation.tasks().len() as u64).saturating_sub(row.scores.episodes),
        wins: row.scores.wins,
        rate: rate.value,
        interval: (rate.low, rate.high),
        score: row.scores.score,
    })
}

/// Returns one message for each game or level file in the results that is not, byte for byte, in the release.
pub(super) fn not_of(manifest: &Manifest, folder: &Path) -> Result<Vec<String>, Failure> {
    let mut problems = Vec::new();
    for Leaf { path, digest } in leaves(folder)? {
        let is_played = path.starts_with("games/");
        if is_played && !manifest.items.iter().any(|item| item.path == path && item.digest == digest) {
            let (folder, name) = (folder.in_message(), &manifest.name);
            problems.push(format!(
                "`{folder}`: {path} does not match any file in the release `{name}`, so a different game was \
                 played"
            ));
        }
    }
    Ok(problems)
}

/// Returns a results folder's digest: the root of a tree, as for a release, over all visible files in the
/// folder.
pub(super) fn digest(folder: &Path) -> Result<Digest, Failure> {
    merkle::root(&leaves(folder)?).map_err(|error| malformed!("`{}`: {error}", folder.in_message()))
}

fn leaves(folder: &Path) -> Result<Vec<Leaf>, Failure> {
    if folder.exists() && !folder.is_dir() {
        bail!("`{}` is a file: pass the folder that `arcade evaluate --out` wrote", folder.in_message());
    }
    let mut leaves = Vec::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(next) = folders.pop() {
        for path in sorted_entries(&next)? {
            let is_hidden = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
            if is_hidden {
                continue;
            }
            let kind = fs::symlink_metadata(&path).map_err(|error| Failure::read(&path, error))?.file_type();
            if kind.is_dir() {
                folders.push(path);
                continue;
            }
            // Reading a pipe could block forever, and a link could form a cycle or lead out of the folder.
            if !kind.is_file() {
                bail!("`{}` is a link, or not a file: restore the results folder", path.in_message());
            }
            let bytes = fs::read(&path).map_err(|error| Failure::read(&path, error))?;
            let below = path.strip_prefix(folder).unwrap_or(&path).to_string_lossy().replace('\\', "/");
            leaves.push(Leaf { path: below, digest: Digest::of(&bytes) });
        }
    }
    Ok(leaves)
}
