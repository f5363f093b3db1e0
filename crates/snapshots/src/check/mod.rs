//! Verification of an untrusted release folder.

mod game;
mod numbers;
mod readme_and_card;

use crate::Digest;
use crate::contents::Contents;
use crate::contents::disclose::salt_flaw;
use crate::contents::replay::Meter;
use crate::contents::unfinished::refuse_unfinished;
use crate::error::SnapshotError;
use crate::format::canary::canary;
use crate::format::layout::{HELD, README_FILE, RELEASE_CARD_FILE, SECRET_FILE, is_solution};
use crate::format::manifest::item::ReleaseKind;
use crate::format::manifest::withheld::HeldPart;
use crate::format::manifest::{MANIFEST_FILE, Manifest};
use crate::format::plausible::{CARD_AND_CANARY_SINCE, impossible};
use crate::recipe::beacon::{BEACON, BeaconPart};
use crate::recipe::known::Known;
use crate::recipe::secret::Secret;
use crate::sections::section::Checking;
use crate::sections::{SECTIONS, summary_paths};
use base::canonical::to_canonical_json;
use forge::card::Card;
use game::{Files, GameCheck};
use itertools::Itertools;
use rayon::prelude::*;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

pub use crate::contents::replay::Bounds;
pub(crate) use numbers::problems as number_problems;

/// The results of checking the witnesses.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Witnesses {
    /// The number of witnesses replayed. Failed replays are reported as problems.
    Replayed(usize),
    /// The witnesses are withheld, because the release is sealed and not yet revealed.
    Held,
    /// The release was minted under different engine semantics.
    NotReplayed {
        /// The semantics under which the witnesses must be replayed.
        semantics: u32,
    },
}

/// The result of [`verify`].
#[derive(Clone, Debug, Serialize)]
pub struct Verification {
    /// The release's name.
    pub name: String,
    /// The root digest stated in the release.
    pub root: Digest,
    /// The number of files, excluding the manifest.
    pub files: usize,
    /// The number of games.
    pub games: usize,
    /// The number of levels.
    pub levels: usize,
    /// The results of checking the witnesses.
    pub witnesses: Witnesses,
    /// `true` if the release is sealed and its secret has not been revealed.
    pub is_secret: bool,
    /// The work of the replays, in the units of [`Bounds`]. It never exceeds the bound.
    pub work: u64,
    /// The bound, if all replays together exceed it. In that case, no witness was judged, and the excess is
    /// reported as a problem.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exceeded: Option<u64>,
    /// The number of papers (documents such as the licence) stored with the release, which the root does not cover.
    pub papers: usize,
    /// The names of files that other programs left in the release folder. The content of such files is not read.
    pub ignored: Vec<String>,
    /// The problems, each with the file name; empty if the release is sound.
    pub problems: Vec<String>,
    /// The manifest in the release.
    #[serde(skip)]
    pub manifest: Manifest,
}

/// Verifies the release at `root`, a folder or an [archive](crate::contents::archive).
///
/// Paths, links, sizes, digests and the root are checked first. If they are correct, games, levels and cards must be
/// well-formed and consistent. If the release also has the current engine semantics, every witness is replayed to its
/// win, within the bounds that apply to every release ([`Bounds::RELEASE`]).
///
/// Cost: one pass over the files and a replay of every witness, on all threads of the current rayon pool.
///
/// # Errors
/// Returns an error if the manifest is missing, is broken or has a newer format, or if a file system operation fails.
pub fn verify(root: &Path) -> Result<Verification, SnapshotError> {
    verify_within(root, &Bounds::RELEASE)
}

/// Verifies a release like [`verify`], with the given bounds. A release whose replays exceed the bounds is unsound,
/// and its replays are stopped.
///
/// # Errors
/// See [`verify`].
pub fn verify_within(root: &Path, bounds: &Bounds) -> Result<Verification, SnapshotError> {
    refuse_unfinished(root)?;
    let (integrity, contents) = Contents::open(root)?;
    let manifest = integrity.manifest;
    let mut problems: Vec<String> = integrity.problems.iter().map(ToString::to_string).collect();
    let same_semantics = manifest.semantics == engine::SEMANTICS;
    let is_sealed = manifest.kind == ReleaseKind::Sealed;
    let secret = if is_sealed && problems.is_empty() { contents.find(SECRET_FILE)? } else { None };
    let held = is_sealed && secret.is_none();
    let secret = match secret.map(|bytes| serde_json::from_slice::<Secret>(&bytes)).transpose() {
        Ok(secret) => secret,
        Err(error) => {
            problems.push(format!("{SECRET_FILE}: not a valid secret: {error}"));
            None
        }
    };
    if let Some(secret) = &secret {
        problems.extend(secret.flaw(&manifest)?.map(|flaw| format!("{SECRET_FILE}: {flaw}")));
        for part in HeldPart::ALL {
            let list = contents.find(part.list())?;
            problems.extend(list.and_then(|bytes| salt_flaw(part, &bytes, secret)));
        }
    }
    let mut games = Vec::new();
    let mut work = 0;
    let mut exceeded = None;
    if problems.is_empty() {
        let folders = namesakes(game_folders(&manifest, &mut problems));
        let meter = Meter::new(bounds.of(declared_levels(&manifest)));
        let release = Checking {
            contents: &contents,
            manifest: &manifest,
            secret: secret.as_ref(),
            meter: same_semantics.then_some(&meter),
        };
        let checked: Vec<Vec<GameCheck>> =
            folders.par_iter().map(|folders| release.namesakes(folders)).collect::<Result<_, _>>()?;
        games = checked.into_iter().flatten().collect();
        exceeded = meter.exceeded();
        work = exceeded.unwrap_or(meter.spent());
        match exceeded {
            // The set of finished replays depends on thread scheduling, so no replay results are reported.
            Some(limit) => problems.push(format!(
                "games: replaying the witnesses takes more than {limit} units of work, the limit for {} levels",
                declared_levels(&manifest)
            )),
            None => problems.extend(games.iter_mut().flat_map(|game| std::mem::take(&mut game.problems))),
        }
        check_header(&manifest, &mut problems);
        check_known(&manifest, &mut problems);
        check_held(&manifest, &games, &mut problems);
        let cards: Option<Vec<&Card>> = games.iter().map(|game| game.card.as_ref()).collect();
        // The cards are compared only if no game is missing, because missing games have already been
        // reported.
        if let Some(cards) = cards {
            problems.extend(readme_and_card::problems(&contents, &manifest, &cards)?);
            for section in SECTIONS {
                problems.extend(section.check_summary(&release, &cards)?);
            }
        }
    }
    let levels = games.iter().map(|game| game.levels).sum();
    let replayed: usize = games.iter().map(|game| game.replayed).sum();
    Ok(Verification {
        root: manifest.root,
        files: manifest.files().count(),
        papers: integrity.beside.papers.len(),
        ignored: integrity.beside.ignored,
        games: games.len(),
        levels,
        witnesses: match same_semantics {
            _ if held && replayed == 0 => Witnesses::Held,
            true => Witnesses::Replayed(replayed),
            false => Witnesses::NotReplayed { semantics: manifest.semantics },
        },
        is_secret: held,
        work,
        exceeded,
        name: manifest.name.clone(),
        problems,
        manifest,
    })
}

/// Returns the number of levels that the manifest lists.
fn declared_levels(manifest: &Manifest) -> usize {
    let is_level = |path: &str| {
        path.starts_with("games/") && path.rsplit('/').next().is_some_and(|file| file.starts_with("lvl"))
    };
    manifest.items.iter().filter(|item| is_level(&item.path) && item.path.ends_with(".txt")).count()
}

/// Groups folders by the ending of their names. Folders of the same game have the same ending.
fn namesakes(folders: BTreeMap<String, Files>) -> Vec<Vec<(String, Files)>> {
    let mut by_end: BTreeMap<String, Vec<(String, Files)>> = BTreeMap::new();
    for (folder, files) in folders {
        let end = folder.char_indices().rev().nth(7).map_or(0, |(at, _)| at);
        by_end.entry(folder[end..].to_owned()).or_default().push((folder, files));
    }
    by_end.into_values().sorted_by(|one, two| one[0].0.cmp(&two[0].0)).collect_vec()
}

/// Checks that the manifest's fields agree with its recipe.
fn check_header(manifest: &Manifest, problems: &mut Vec<String>) {
    let stated = [
        ("name", Some(manifest.name.clone())),
        ("parent", manifest.parent.map(|parent| parent.to_string())),
        ("commitment", manifest.commitment.map(|commitment| commitment.to_string())),
    ];
    for (key, stated) in stated {
        let recipe = manifest.recipe.get(key).and_then(|value| value.as_str());
        if recipe != stated.as_deref() {
            problems.push(format!("{MANIFEST_FILE}: the `{key}` differs from the recipe's"));
        }
    }
    let (of, source) = match manifest.commitment {
        Some(commitment) => (Some(commitment), "commitment"),
        // The manifest could be read, so its recipe has a canonical text.
        None if manifest.generation >= CARD_AND_CANARY_SINCE => {
            (to_canonical_json(&manifest.recipe).ok().map(|text| Digest::of(text.as_bytes())), "recipe")
        }
        None => (None, ""),
    };
    if of.is_some_and(|of| manifest.canary != canary(&of)) {
        problems.push(format!("{MANIFEST_FILE}: the `canary` does not match the {source}"));
    }
    let has_beacon = manifest.recipe.get(BEACON).is_some();
    let is_known = BeaconPart::of(&manifest.recipe).is_some_and(|beacon| beacon.value.is_some());
    if has_beacon && !(is_known && manifest.commitment.is_some()) {
        problems.push(format!(
            "{MANIFEST_FILE}: the recipe has a beacon, but lacks the beacon's value or is not sealed"
        ));
    }
    if let Some(what) = impossible(&manifest.minted_by()) {
        problems.push(format!("{MANIFEST_FILE}: {what}"));
    }
}

/// Checks that the recipe's `known` is plausible for a release with this parent, or without a parent. Only
/// the parent can show whether `known` is correct: see [`chain`](crate::lineage::chain).
fn check_known(manifest: &Manifest, problems: &mut Vec<String>) {
    if manifest.generation < CARD_AND_CANARY_SINCE {
        return;
    }
    let mut wrong = |what: &str| problems.push(format!("{MANIFEST_FILE}: the recipe's `known` {what}"));
    let known = match manifest.recipe.get("known").map(|known| serde_json::from_value(known.clone())) {
        None => Known::default(),
        Some(Ok(known)) => known,
        // In a different generation, the record may contain additional data.
        Some(Err(_)) if manifest.generation != generators::GENERATION => return,
        Some(Err(error)) => return wrong(&format!("is malformed ({error})")),
    };
    let names: BTreeSet<&String> = known.releases.iter().collect();
    if names.len() < known.releases.len() || names.contains(&manifest.name) {
        wrong("lists a release twice, or lists the release itself");
    }
    match manifest.parent {
        Some(_) if known.releases.is_empty() => wrong("lists no release, but the manifest states a parent"),
        None if known != Known::default() => {
            wrong("lists earlier releases, but the manifest states no parent")
        }
        _ => {}
    }
}

/// Checks the withheld files of a sealed release: the release must commit to its secret, to a witness of every level,
/// and to no other withheld file.
fn check_held(manifest: &Manifest, games: &[GameCheck], problems: &mut Vec<String>) {
    if manifest.kind != ReleaseKind::Sealed {
        return;
    }
    let witnesses = games.iter().flat_map(|game| &game.held).map(String::as_str);
    let summaries = summary_paths(manifest);
    let summaries = summaries.iter().map(String::as_str);
    let awaited: BTreeSet<&str> = witnesses.chain([SECRET_FILE]).chain(summaries).collect();
    let listed = manifest.held();
    // Files that are still hidden are checked when they are revealed.
    let is_hidden = |path: &str| {
        let part = if is_solution(path) { HeldPart::Solutions } else { HeldPart::Rest };
        manifest.hides(part)
    };
    let absent = awaited.difference(&listed).filter(|path| !is_hidden(path));
    let absent = absent.map(|path| format!("{path}: not covered by the commitment"));
    let foreign = listed.difference(&awaited).map(|path| format!("{path}: not part of a sealed release"));
    problems.extend(absent.chain(foreign));
}

/// Returns the files in each game folder, by relative path.
fn game_folders(manifest: &Manifest, problems: &mut Vec<String>) -> BTreeMap<String, Files> {
    let mut folders: BTreeMap<String, Files> = BTreeMap::new();
    let summaries = summary_paths(manifest);
    for item in &manifest.items {
        match item.path.strip_prefix("games/").and_then(|rest| rest.split_once('/')) {
            Some((folder, file)) => {
                folders.entry(folder.to_owned()).or_default().insert(file.to_owned());
            }
            None if [README_FILE, RELEASE_CARD_FILE].contains(&item.path.as_str()) => {}
            None if summaries.contains(&item.path) => {}
            None if manifest.kind == ReleaseKind::Sealed && item.path.starts_with(HELD) => {}
            None => problems.push(format!("{}: not part of a release", item.path)),
        }
    }
    if folders.is_empty() {
        problems.push("games: the release contains no game".to_owned());
    }
    folders
}
