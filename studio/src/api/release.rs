//! A release: its games, its verification, its comparison with another.

use super::workspace::first_board;
use crate::answers::Asked;
use crate::lines::{Ended, Lines};
use crate::refusal::Refusal;
use crate::studio::Studio;
use engine::Digest;
use rayon::prelude::*;
use serde::Deserialize;
use serde_json::{Value, json};
use snapshots::diff::{Diff, Status};
use snapshots::folder::{self, Limits};
use snapshots::released::Released;
use snapshots::{Verification, Witnesses, verify};
use std::path::Path;
use std::sync::Arc;

/// The opened release.
fn opened(studio: &Studio) -> Result<(&Path, &Arc<Released>), Refusal> {
    let workspace = &studio.workspace;
    let found = workspace.root.as_deref().zip(workspace.released.as_ref());
    found.ok_or_else(|| Refusal::missing("no release is open").help("open one: `arcade studio SNAPSHOT`"))
}

pub(crate) fn release(studio: &Studio) -> Result<Value, Refusal> {
    let (_, released) = opened(studio)?;
    let games: Vec<Value> = released.games.par_iter().map(|game| listed(studio, game)).collect();
    let manifest = &released.manifest;
    Ok(json!({
        "name": manifest.name,
        "root": manifest.root,
        "parent": manifest.parent,
        "format": manifest.format,
        "semantics": manifest.semantics,
        "generation": manifest.generation,
        "version": manifest.version,
        "sealed": manifest.kind == snapshots::ReleaseKind::Sealed,
        "games": games,
    }))
}

fn listed(studio: &Studio, game: &snapshots::released::ReleasedGame) -> Value {
    let card = &game.card;
    let board = studio.workspace.game(&card.id).ok().and_then(|entry| first_board(studio, &entry));
    let (tiles, frame) = board.map_or((Vec::new(), None), |(tiles, frame)| (tiles, Some(frame)));
    let levels = card.levels.iter().zip(&game.levels);
    let levels: Vec<Value> = levels
        .map(|(level, read)| {
            json!({
                "name": level.file.trim_end_matches(".txt"),
                "tier": level.tier,
                "difficulty": level.ladder.as_ref().map(|ladder| ladder.difficulty),
                "width": level.columns,
                "height": level.rows,
                "ticks": level.witness_ticks,
                "witness": read.witness.is_some(),
            })
        })
        .collect();
    json!({
        "id": card.id, "title": card.title, "kind": card.kind, "goal": card.goal, "levels": levels,
        "tiles": tiles, "frame": frame,
    })
}

/// A question without details.
#[derive(Deserialize)]
pub(crate) struct Nothing {}

pub(crate) fn verified(studio: &Studio, _: Asked<Nothing>, lines: &Lines) -> Result<(), Ended> {
    let (root, released) = opened(studio)?;
    // Of an archive, the verification reads all files at once.
    if root.is_dir() {
        let items = &released.manifest.items;
        for (done, item) in items.iter().enumerate() {
            let content = folder::read(root, &item.path, Limits::SNAPSHOT.file_bytes);
            let ok = content.is_ok_and(|bytes| Digest::of(&bytes) == item.digest);
            let (done, total) = (done + 1, items.len());
            lines.send(
                &json!({ "stage": "file", "path": item.path, "ok": ok, "done": done, "total": total }),
            )?;
        }
    }
    lines.check()?;
    let verification = verify(root).map_err(Refusal::failed)?;
    let same = verification.root == released.manifest.root;
    let mut said = words(&verification);
    if !same {
        said.insert(0, "the release changed since the studio opened it: open it again".to_owned());
    }
    let ok = verification.problems.is_empty() && same;
    lines.send(&json!({ "stage": "verdict", "ok": ok, "lines": said, "root": verification.root }))?;
    Ok(())
}

fn words(found: &Verification) -> Vec<String> {
    if !found.problems.is_empty() {
        return found.problems.clone();
    }
    let Verification { files, games, levels, .. } = found;
    let mut said =
        vec![format!("{files} files, {games} games, {levels} levels: every digest and the root are right")];
    said.push(match &found.witnesses {
        Witnesses::Replayed(count) => format!("{count} recorded wins were replayed, state by state"),
        Witnesses::Held => "sealed: its wins are withheld until the reveal".to_owned(),
        Witnesses::NotReplayed { semantics } => {
            format!("its wins need semantics {semantics} of the engine and were not replayed")
        }
    });
    said.push(format!("root {}: compare it with a published one", found.root));
    said
}

/// The most nearest neighbours that are shown.
const NEAREST: usize = 1000;

pub(crate) fn compare(studio: &Studio) -> Result<Value, Refusal> {
    let (_, released) = opened(studio)?;
    let Some((_, other)) = &studio.workspace.against else {
        return Err(Refusal::missing("no release to compare with").help("name one with --against"));
    };
    let diff = Diff::of(other, released, NEAREST);
    let ids = |statuses: &[Status]| -> Vec<&str> {
        let each = diff.games.each.iter().filter(|change| statuses.contains(&change.status));
        each.map(|change| change.id.as_str()).collect()
    };
    // The nearest earlier game of each later one: pairs come in the order of their distance.
    let mut seen = std::collections::BTreeSet::new();
    let nearest = diff.neighbours.closest.iter().filter(|pair| seen.insert(pair.after.as_str()));
    let nearest: Vec<Value> = nearest
        .map(|pair| json!({ "id": pair.after, "other": pair.before, "distance": pair.distance }))
        .collect();
    Ok(json!({
        "other": diff.before.name,
        "new": ids(&[Status::New]),
        "gone": ids(&[Status::Gone]),
        "kept": ids(&[Status::Kept]),
        "changed": ids(&[Status::Changed]),
        "nearest": nearest,
    }))
}
