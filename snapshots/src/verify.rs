//! Verifying a release folder: nothing in it is trusted.

use crate::card::Card;
use crate::contents::Contents;
use crate::manifest::{Kind, Manifest};
use crate::mint::RELEASE_CARD_FILE;
use crate::sealed::{HELD, SECRET_FILE, STRANGER, Secret, held_witness};
use crate::witness::Witness;
use crate::{Digest, MANIFEST_FILE, SnapshotError, canary};
use engine::{Game, Outcome};
use rayon::prelude::*;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// What was found out about the witnesses.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Witnesses {
    /// So many were replayed; those that failed are among the problems.
    Replayed(usize),
    /// The release is sealed: they are held back until it is revealed.
    Held,
    /// The release was minted under other semantics of the engine.
    NotReplayed {
        /// The semantics that the witnesses need.
        semantics: u32,
    },
}

/// The answer of [`verify`].
#[derive(Clone, Debug, Serialize)]
pub struct Verification {
    /// Name of the release.
    pub name: String,
    /// Its root digest, as stated.
    pub root: Digest,
    /// Files, the manifest apart.
    pub files: usize,
    /// Games.
    pub games: usize,
    /// Levels.
    pub levels: usize,
    /// What was found out about the witnesses.
    pub witnesses: Witnesses,
    /// Papers beside the release, which its root does not cover.
    pub papers: usize,
    /// What other programs left beside the release, by name; not looked at.
    pub ignored: Vec<String>,
    /// All that is wrong, each naming the file; empty if the release is sound.
    pub problems: Vec<String>,
    /// The manifest as stated.
    #[serde(skip)]
    pub manifest: Manifest,
}

/// Checks paths, links, sizes, digests and the root; if these hold, that games, levels and cards are well-formed and
/// fit together; and, under the same semantics, replays every witness to its win. `root` is the release's folder or its
/// [archive](crate::archive).
///
/// Cost: one pass over the files and a replay of every witness, on all threads of the current rayon pool.
///
/// # Errors
/// There is no manifest, it is of a newer format or broken, or the file system refuses.
pub fn verify(root: &Path) -> Result<Verification, SnapshotError> {
    refuse_unfinished(root)?;
    let (integrity, contents) = Contents::open(root)?;
    let manifest = integrity.manifest;
    let mut problems: Vec<String> = integrity.problems.iter().map(ToString::to_string).collect();
    let same_semantics = manifest.semantics == engine::SEMANTICS;
    let is_sealed = manifest.kind == Kind::Sealed;
    let secret = if is_sealed && problems.is_empty() { contents.find(SECRET_FILE)? } else { None };
    let held = is_sealed && secret.is_none();
    let mut games = Vec::new();
    let secret = match secret.map(|bytes| serde_json::from_slice::<Secret>(&bytes)).transpose() {
        Ok(secret) => secret,
        Err(error) => {
            problems.push(format!("{SECRET_FILE}: not a secret: {error}"));
            None
        }
    };
    if let Some(secret) = &secret {
        problems.extend(secret.flaw(&manifest)?.map(|flaw| format!("{SECRET_FILE}: {flaw}")));
    }
    if problems.is_empty() {
        let folders = game_folders(&manifest, &mut problems);
        let checked: Vec<GameCheck> = folders
            .into_par_iter()
            .map(|(folder, files)| {
                check_game(&contents, &manifest, &folder, &files, same_semantics, secret.as_ref())
            })
            .collect::<Result<_, _>>()?;
        games = checked;
        problems.extend(games.iter_mut().flat_map(|game| std::mem::take(&mut game.problems)));
        check_header(&manifest, &mut problems);
        check_held(&manifest, &games, &mut problems);
        for path in ["README.md", RELEASE_CARD_FILE] {
            let listed = manifest.items.iter().any(|item| item.path == path);
            if listed && !carries(&contents.read(path)?, &manifest.canary) {
                problems.push(format!("{path}: without the release's canary"));
            }
        }
    }
    let levels = games.iter().map(|game| game.levels).sum();
    Ok(Verification {
        root: manifest.root,
        files: manifest.items.len(),
        papers: integrity.beside.papers.len(),
        ignored: integrity.beside.ignored,
        games: games.len(),
        levels,
        witnesses: match same_semantics {
            _ if held => Witnesses::Held,
            true => Witnesses::Replayed(games.iter().map(|game| game.replayed).sum()),
            false => Witnesses::NotReplayed { semantics: manifest.semantics },
        },
        name: manifest.name.clone(),
        problems,
        manifest,
    })
}

/// Whether what the manifest states of itself is what its recipe says.
fn check_header(manifest: &Manifest, problems: &mut Vec<String>) {
    let stated = [
        ("name", Some(manifest.name.clone())),
        ("parent", manifest.parent.map(|parent| parent.to_string())),
        ("commitment", manifest.commitment.map(|commitment| commitment.to_string())),
    ];
    for (key, stated) in stated {
        let recipe = manifest.recipe.get(key).and_then(|value| value.as_str());
        if recipe != stated.as_deref() {
            problems.push(format!("{MANIFEST_FILE}: its `{key}` is not that of its recipe"));
        }
    }
    if manifest.commitment.is_some_and(|commitment| manifest.canary != canary(&commitment)) {
        problems.push(format!("{MANIFEST_FILE}: its `canary` is not that of its commitment"));
    }
}

/// Whether a sealed release commits to its secret and to a witness of every level, and to nothing else that nobody sees.
fn check_held(manifest: &Manifest, games: &[GameCheck], problems: &mut Vec<String>) {
    if manifest.kind != Kind::Sealed {
        return;
    }
    let witnesses = games.iter().flat_map(|game| &game.held).map(String::as_str);
    let awaited: BTreeSet<&str> = witnesses.chain([SECRET_FILE]).collect();
    let listed = manifest.items.iter().map(|item| item.path.as_str());
    let listed: BTreeSet<&str> = listed.filter(|path| path.starts_with(HELD)).collect();
    let absent = awaited.difference(&listed).map(|path| format!("{path}: not committed to"));
    let foreign =
        listed.difference(&awaited).map(|path| format!("{path}: a sealed release has no such file"));
    problems.extend(absent.chain(foreign));
}

/// Whether the release's mark is in a file.
fn carries(content: &[u8], canary: &str) -> bool {
    content.windows(canary.len()).any(|part| part == canary.as_bytes())
}

/// What is called `.partial`, and what is inside, may be complete but for its publication: it is no release.
fn refuse_unfinished(root: &Path) -> Result<(), SnapshotError> {
    let real = std::fs::canonicalize(root).map_err(|source| match source.kind() {
        std::io::ErrorKind::NotFound => SnapshotError::NotASnapshot { path: root.to_path_buf() },
        _ => SnapshotError::Io { action: "examine", path: root.to_path_buf(), source },
    })?;
    // Far above, the name alone tells little: there has to be a draft.
    let is_draft = |folder: &Path| folder.join(".lock").exists() && folder.join("tree").exists();
    let unfinished = real.ancestors().enumerate().any(|(above, folder)| {
        folder.extension().is_some_and(|end| end == "partial") && (above < 2 || is_draft(folder))
    });
    if unfinished { Err(SnapshotError::Unfinished { path: root.to_path_buf() }) } else { Ok(()) }
}

/// The files of each game folder, by path below it.
fn game_folders(manifest: &Manifest, problems: &mut Vec<String>) -> BTreeMap<String, Vec<String>> {
    let mut folders: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for item in &manifest.items {
        match item.path.strip_prefix("games/").and_then(|rest| rest.split_once('/')) {
            Some((folder, file)) => folders.entry(folder.to_owned()).or_default().push(file.to_owned()),
            None if ["README.md", RELEASE_CARD_FILE].contains(&item.path.as_str()) => {}
            None if manifest.kind == Kind::Sealed && item.path.starts_with(HELD) => {}
            None => problems.push(format!("{}: a release has no such file", item.path)),
        }
    }
    if folders.is_empty() {
        problems.push("games: the release holds no game".to_owned());
    }
    folders
}

struct GameCheck {
    levels: usize,
    replayed: usize,
    /// Where a sealed release has its witnesses.
    held: Vec<String>,
    problems: Vec<String>,
}

fn check_game(
    contents: &Contents,
    manifest: &Manifest,
    folder: &str,
    files: &[String],
    replay: bool,
    secret: Option<&Secret>,
) -> Result<GameCheck, SnapshotError> {
    let mut check = GameCheck { levels: 0, replayed: 0, held: Vec::new(), problems: Vec::new() };
    let path = |file: &str| format!("games/{folder}/{file}");
    // The digests hold, so every listed file can be read as a text of its size; what is in it is another matter.
    let read = |file: &str| -> Result<Option<String>, SnapshotError> {
        if !files.iter().any(|known| known == file) {
            return Ok(None);
        }
        let bytes = contents.read(&path(file))?;
        Ok(String::from_utf8(bytes).ok())
    };
    let mut wrong = |file: &str, what: String| check.problems.push(format!("{}: {what}", path(file)));

    let Some(source) = read("game.vgdl")? else {
        wrong("game.vgdl", "missing or not a text".to_owned());
        return Ok(check);
    };
    if !carries(source.as_bytes(), &manifest.canary) {
        wrong("game.vgdl", "without the release's canary".to_owned());
    }
    let game = match Game::from_source(&source) {
        Ok(game) => game,
        Err(problems) => {
            wrong("game.vgdl", format!("not a game: {problems}"));
            return Ok(check);
        }
    };
    let card: Card = match read("card.json")?.map(|text| serde_json::from_str(&text)) {
        Some(Ok(card)) => card,
        Some(Err(error)) => {
            wrong("card.json", format!("not a card: {error}"));
            return Ok(check);
        }
        None => {
            wrong("card.json", "missing or not a text".to_owned());
            return Ok(check);
        }
    };
    if card.id != folder || card.digest != game.digest() || !folder.ends_with(&game.digest().short()) {
        wrong("card.json", "card, folder name and game do not belong together".to_owned());
    }
    if card.canary != manifest.canary {
        wrong("card.json", "its canary is not the release's".to_owned());
    }
    if card.levels.is_empty() {
        wrong("card.json", "the game has no levels".to_owned());
    }
    let mut known = vec!["game.vgdl".to_owned(), "card.json".to_owned()];
    let (mut levels, mut replayed) = (0, 0);
    let mut held = Vec::new();
    for (number, level_card) in card.levels.iter().enumerate() {
        let (file, witness_file) = (format!("lvl{number}.txt"), format!("witness/lvl{number}.json"));
        let is_sealed = manifest.kind == Kind::Sealed;
        if is_sealed {
            held.push(held_witness(folder, number));
        }
        let level = match read(&file)?.map(|text| game.level(&text)) {
            Some(Ok(level)) => level,
            Some(Err(problems)) => {
                wrong(&file, format!("not a level of this game: {problems}"));
                continue;
            }
            None => {
                wrong(&file, "missing or not a text".to_owned());
                continue;
            }
        };
        levels += 1;
        if level_card.file != file || level_card.digest != level.digest() {
            wrong(&file, "card and level do not belong together".to_owned());
        }
        let witness = match is_sealed {
            true => {
                let bytes = contents.find(&held_witness(folder, number))?;
                bytes.and_then(|bytes| String::from_utf8(bytes).ok())
            }
            false => read(&witness_file)?,
        };
        match witness.map(|text| serde_json::from_str::<Witness>(&text)) {
            Some(Ok(witness)) if witness.canary != manifest.canary => {
                wrong(&witness_file, "its canary is not the release's".to_owned());
            }
            Some(Ok(witness)) if secret.is_some_and(|secret| !secret.leads_to(&witness)) => {
                wrong(&witness_file, STRANGER.to_owned());
            }
            Some(Ok(witness)) if replay => match witness.episode.replay(&game, &level) {
                Ok(end) if end.outcome() == Outcome::Won => {
                    replayed += 1;
                    if witness.episode.actions.len() != level_card.witness_ticks
                        || end.score() != level_card.witness_score
                    {
                        wrong(
                            "card.json",
                            format!("not the ticks and score of the episode that wins {file}"),
                        );
                    }
                }
                Ok(_) => wrong(&witness_file, "the episode does not win".to_owned()),
                Err(divergence) => wrong(&witness_file, divergence.to_string()),
            },
            Some(Ok(_)) => {}
            Some(Err(error)) => wrong(&witness_file, format!("not a witness: {error}")),
            // Whether all that is held back is there has been looked at.
            None if is_sealed => {}
            None => wrong(&witness_file, "missing or not a text".to_owned()),
        }
        known.push(file);
        if !is_sealed {
            known.push(witness_file);
        }
    }
    for file in files.iter().filter(|file| !known.contains(file)) {
        wrong(file, "a game has no such file".to_owned());
    }
    (check.levels, check.replayed, check.held) = (levels, replayed, held);
    Ok(check)
}
