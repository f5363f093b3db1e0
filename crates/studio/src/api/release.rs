//! Requests about a release: its games, its verification, and its comparison with another release.

use super::workspace::first_board;
use crate::answers::Asked;
use crate::lines::{Ended, Lines};
use crate::refusal::Refusal;
use crate::studio::Studio;
use crate::workspace::Workspace;
use base::Digest;
use base::MessagePath;
use rayon::prelude::*;
use serde::Deserialize;
use serde_json::{Value, json};
use snapshots::chain::Link;
use snapshots::diff::{Diff, Status};
use snapshots::folder::{self, Limits};
use snapshots::lineage::{Ancestor, trace};
use snapshots::released::Released;
use snapshots::{Verification, Witnesses, verify};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Returns the opened release.
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
        // A revealed release is no longer sealed.
        "sealed": released.games.iter().flat_map(|game| &game.levels).any(|level| level.witness.is_none()),
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

/// The body of a request without parameters.
#[derive(Deserialize)]
pub(crate) struct Nothing {}

pub(crate) fn verified(studio: &Studio, _: Asked<Nothing>, lines: &Lines) -> Result<(), Ended> {
    let (root, released) = opened(studio)?;
    // Verifying an archive reads all files at once.
    if root.is_dir() {
        let items: Vec<_> = released.manifest.files().collect();
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
    let mut problems = verification.problems.clone();
    if verification.root != released.manifest.root {
        problems
            .insert(0, "The release changed after the studio opened it: open the release again.".to_owned());
    }
    let is_sound = problems.is_empty();
    let mut said = if is_sound { words(&verification) } else { Vec::new() };
    match &studio.vouch {
        Some(vouch) => match vouch(&verification) {
            Ok(signed) => said.push(signed),
            Err(unsigned) => problems.extend(unsigned),
        },
        None => said.push(format!(
            "Root {}: compare this root with the published root, or pass the publisher's key with --key.",
            verification.root
        )),
    }
    // If a release is not sound, its parent is unknown.
    if is_sound {
        let (before, found) = parents(studio, Link::of(&verification.manifest, root), lines)?;
        said.extend(before);
        problems.extend(found);
    }
    let ok = problems.is_empty();
    problems.extend(said);
    lines.send(&json!({
        "stage": "verdict", "ok": ok, "sound": is_sound, "lines": problems, "root": verification.root,
    }))?;
    Ok(())
}

/// Follows the parents of the opened release as far back as they can be found, and sends each of them. Returns
/// sentences about the parents, and the problems with them.
fn parents(studio: &Studio, start: Link, lines: &Lines) -> Result<(Vec<String>, Vec<String>), Ended> {
    let mut child = start.name.clone();
    let tell = &mut |ancestor: &Ancestor| {
        let Ancestor { root, link, problems } = ancestor;
        let text = match (link, problems.as_slice()) {
            (None, []) => format!("Pass its location with --chain to check what `{child}` follows."),
            (Some(_), []) => {
                format!("Every file agrees with this root, which `{child}` states as its parent.")
            }
            (_, [only]) => only.clone(),
            (_, [first, rest @ ..]) => format!("{first}; and {} more", rest.len()),
        };
        let ok = match (link, problems.is_empty()) {
            (None, true) => None,
            (_, ok) => Some(ok),
        };
        let name = link.as_ref().map(|link| link.name.clone());
        let place = link.as_ref().map(|link| base_name(&link.place));
        child = name.clone().unwrap_or_default();
        let line = json!({ "stage": "ancestor", "name": name, "root": root, "place": place, "ok": ok, "text": text });
        lines.send(&line).is_ok()
    };
    let lineage = trace(&start, &places(&studio.workspace), tell).map_err(Refusal::failed)?;
    lines.check()?;
    let is_damaged = |ancestor: &&Ancestor| !ancestor.problems.is_empty();
    let sound = lineage.ancestors.iter().filter(|ancestor| ancestor.link.is_some() && !is_damaged(ancestor));
    let Link { name, .. } = &start;
    let mut said = Vec::new();
    match (lineage.complete, sound.count()) {
        (true, 0) => said.push(format!("`{name}` has no parent, so it is the first release of its chain.")),
        (true, count) => said.push(format!(
            "{} before `{name}`, back to the first, and each has the root that its successor states.",
            releases(count)
        )),
        // The altered release is reported instead.
        (false, _) if lineage.ancestors.iter().any(|ancestor| is_damaged(&ancestor)) => {}
        (false, 0) => said.push(format!("The releases before `{name}` were not found.")),
        (false, count) => said.push(format!(
            "{} before `{name}`, and each has the root that its successor states; older releases were not \
             found.",
            releases(count)
        )),
    }
    // Unreadable paths matter only if a release is missing.
    if lineage.ancestors.iter().any(|ancestor| ancestor.link.is_none()) {
        said.extend(
            lineage.unread.iter().map(|place| format!("Not read: {}", nameless(place, &studio.workspace))),
        );
    }
    let damaged = lineage.ancestors.iter().filter(is_damaged);
    let mut problems: Vec<String> = damaged
        .map(|ancestor| match &ancestor.link {
            Some(link) => {
                format!("The earlier release `{}` was altered: its files do not match its root.", link.name)
            }
            None => "The chain of parents is circular.".to_owned(),
        })
        .collect();
    problems.extend(lineage.problems.iter().map(|problem| nameless(problem, &studio.workspace)));
    Ok((said, problems))
}

/// Returns the paths in which to search for the predecessors of the opened release. These are the paths specified by
/// the user, the release to compare with, and the parent folders of both releases.
fn places(workspace: &Workspace) -> Vec<PathBuf> {
    let against = workspace.against.as_ref().map(|(place, _)| place.clone());
    let beside: Vec<PathBuf> =
        workspace.root.iter().chain(&against).filter_map(|place| folder_of(place)).collect();
    workspace.chain.iter().cloned().chain(against).chain(beside).collect()
}

/// Returns the folder that contains a release. For the `public` folder of a sealed release, returns the
/// folder that contains the whole sealed release.
fn folder_of(release: &Path) -> Option<PathBuf> {
    let real = fs::canonicalize(release).ok()?;
    let parent = real.parent()?;
    let is_public = real.file_name().is_some_and(|name| name == "public");
    Some(if is_public { parent.parent().unwrap_or(parent) } else { parent }.to_owned())
}

/// Removes the paths of local folders from a message.
fn nameless(message: &str, workspace: &Workspace) -> String {
    let mut message = message.to_owned();
    for folder in places(workspace) {
        message = message.replace(&format!("{}/", folder.in_message()), "");
    }
    message
}

fn base_name(place: &Path) -> String {
    place.file_name().unwrap_or(place.as_os_str()).to_string_lossy().into_owned()
}

fn counted(count: usize, of: &str) -> String {
    format!("{count} {of}{}", if count == 1 { "" } else { "s" })
}

fn releases(count: usize) -> String {
    format!("{} {}", counted(count, "release"), if count == 1 { "comes" } else { "come" })
}

/// Returns sentences about the verification of a sound release.
fn words(found: &Verification) -> Vec<String> {
    let Verification { files, games, levels, .. } = found;
    let [files, games, levels] =
        [(*files, "file"), (*games, "game"), (*levels, "level")].map(|(count, of)| counted(count, of));
    let said = format!("{files}, {games}, {levels}: every digest and the root are correct.");
    let wins = match &found.witnesses {
        Witnesses::Replayed(1) => "1 recorded win was replayed, state by state.".to_owned(),
        Witnesses::Replayed(count) => format!("{count} recorded wins were replayed, state by state."),
        Witnesses::Held => "Sealed: the wins are withheld until the reveal.".to_owned(),
        Witnesses::NotReplayed { semantics } => {
            format!("The wins need semantics {semantics} of the engine, so they were not replayed.")
        }
    };
    vec![said, wins]
}

/// The maximum number of nearest neighbours to show.
const NEAREST: usize = 1000;

pub(crate) fn compare(studio: &Studio) -> Result<Value, Refusal> {
    let (_, released) = opened(studio)?;
    let Some((_, other)) = &studio.workspace.against else {
        return Err(Refusal::missing("there is no release to compare with").help("pass one with --against"));
    };
    let diff = Diff::of(other, released, NEAREST);
    let ids = |statuses: &[Status]| -> Vec<&str> {
        let each = diff.games.each.iter().filter(|change| statuses.contains(&change.status));
        each.map(|change| change.id.as_str()).collect()
    };
    // Pairs are sorted by distance, so each later game's first pair contains its nearest earlier game.
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
