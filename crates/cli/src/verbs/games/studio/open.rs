//! The sources that the studio can open: the corpus, the user's games, a release, or results.

use crate::failure::Failure;
use crate::input;
use crate::input::embedded;
use crate::input::episodes;
use crate::input::game_input::GameInput;
use crate::{console, paths, protected};
use base::MessagePath;
use evaluation::Evaluation;
use serde_json::json;
use snapshots::MANIFEST_FILE;
use snapshots::released::Released;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use studio::{GameEntry, Kind, NamedText, Place, WitnessEntry, Workspace};

/// Opens the specified source, or the corpus by default.
pub(crate) fn workspace(
    place: Option<&str>,
    out: Option<&Path>,
    against: Option<&Path>,
) -> Result<Workspace, Failure> {
    let copies = |otherwise: &Path| -> Result<PathBuf, Failure> {
        let folder = out.unwrap_or(otherwise).to_owned();
        if out.is_some() {
            protected::check(&folder)?;
            std::fs::create_dir_all(&folder).map_err(|error| Failure::write(&folder, error))?;
        }
        Ok(folder)
    };
    let here = Path::new(".");
    let Some(place) = place else {
        return Ok(Workspace::new(Kind::Corpus, "the corpus", copies(here)?, corpus()?));
    };
    let path = Path::new(place);
    if place == input::CORPUS && !path.exists() {
        return Ok(Workspace::new(Kind::Corpus, "the corpus", copies(here)?, corpus()?));
    }
    let public = paths::release(path.to_owned());
    if is_release(&public)? {
        return release(&public, against, copies(here)?);
    }
    if against.is_some() {
        bail!("--against compares releases, but {place} is not a release");
    }
    let results = results(path)?;
    if !results.is_empty() {
        // The results are opened immediately, so that a damaged folder is reported here.
        results.iter().try_for_each(|folder| Evaluation::open(folder).map(drop))?;
        let mut workspace = Workspace::new(Kind::Results, place, copies(here)?, Vec::new());
        workspace.results = results;
        return Ok(workspace);
    }
    if input::is_without_games(path)? {
        // The path is a folder for new games. Creating the first game creates the folder.
        protected::check(path)?;
        if let Some(near) = input::nearest_place(path)?.filter(|_| !path.exists()) {
            console::warn(format_args!("{place} does not exist yet; did you mean `{near}`?"));
        }
        return Ok(Workspace::new(Kind::Games, place, copies(path)?, Vec::new()));
    }
    let inputs = input::games(place)?;
    let games = inputs.iter().map(entry).collect::<Result<Vec<_>, Failure>>()?;
    let is_single = inputs.len() == 1 && inputs[0].path.as_deref().is_some_and(|file| is_in(file, path));
    let beside = if path.is_dir() && !is_single { path } else { path.parent().unwrap_or(here) };
    let beside = if beside.as_os_str().is_empty() || !path.exists() { here } else { beside };
    Ok(Workspace::new(Kind::Games, place, copies(beside)?, games))
}

/// Returns `true` if a file is directly in a folder, or is the specified file itself.
fn is_in(file: &Path, place: &Path) -> bool {
    file == place || file.parent() == Some(place)
}

/// Returns the evaluation results at a path: the folder itself, or the results folders inside it.
fn results(path: &Path) -> Result<Vec<PathBuf>, Failure> {
    if !path.is_dir() {
        return Ok(Vec::new());
    }
    if Evaluation::is_begun(path) {
        return Ok(vec![path.to_owned()]);
    }
    let mut folders = input::text::sorted_entries(path)?;
    folders.retain(|folder| folder.is_dir() && Evaluation::is_begun(folder));
    Ok(folders)
}

/// Returns `true` if a path is a release: a folder with a manifest, or an archive.
pub(super) fn is_release(path: &Path) -> Result<bool, Failure> {
    let Some(found) = paths::metadata(path)? else { return Ok(false) };
    if found.is_dir() {
        return Ok(path.join(MANIFEST_FILE).is_file());
    }
    let start = disk::read_start(path, 4).map_err(|error| Failure::read(path, error))?;
    Ok(start == input::text::ZSTD)
}

/// Returns the entry for a user's game. The game can be edited unless it lies in a release.
fn entry(input: &GameInput) -> Result<GameEntry, Failure> {
    let file_name = |path: &Path| path.file_name().map(|name| name.to_string_lossy().into_owned());
    let place = match &input.path {
        None => {
            let source = NamedText { name: "game.vgdl".to_owned(), text: input.source.text.clone() };
            let levels = input.levels()?.into_iter().enumerate();
            let levels = levels
                .map(|(number, level)| NamedText { name: format!("lvl{number}.txt"), text: level.text });
            Place::Texts { source, levels: levels.collect() }
        }
        Some(path) => {
            let writable = protected::check(path).is_ok();
            let is_whole =
                input.count() > 0 || path.file_stem().is_some_and(|stem| stem.eq_ignore_ascii_case("game"));
            match (is_whole, file_name(path)) {
                (true, Some(source)) => {
                    let folder = path.parent().filter(|parent| !parent.as_os_str().is_empty());
                    let folder = folder.unwrap_or(Path::new(".")).to_owned();
                    Place::Folder { folder, source, writable }
                }
                _ => Place::File { file: path.clone(), writable },
            }
        }
    };
    let id = match &input.path {
        Some(path) if matches!(place, Place::File { .. }) => file_name(path).unwrap_or_default(),
        _ => Path::new(&input.title)
            .file_name()
            .map_or("game".to_owned(), |name| name.to_string_lossy().into_owned()),
    };
    let card = card(input);
    let of_card = |field: &str| Some(card.as_ref()?.get(field)?.as_str()?.to_owned());
    let title = of_card("title").unwrap_or_else(|| id.clone());
    let summary = of_card("goal").unwrap_or_default();
    let witnesses = match &place {
        Place::Folder { folder, .. } => witnesses(folder, input.count()),
        _ => Vec::new(),
    };
    Ok(GameEntry { id, title, place, summary, card, witnesses })
}

/// Returns the card beside a game, or `None` if no readable card exists.
pub(super) fn card(input: &GameInput) -> Option<serde_json::Value> {
    let folder = input.path.as_ref()?.parent()?;
    let read = |name: &str| input::text::read_text(&folder.join(name), MAX_CARD).ok();
    let of_toml = || serde_json::to_value(read("CARD.toml")?.parse::<toml::Table>().ok()?).ok();
    let of_json = || serde_json::from_str(&read("card.json")?).ok();
    of_toml().or_else(of_json)
}

/// The maximum size of a card, in bytes.
const MAX_CARD: usize = 1 << 22;

/// Returns the winning episodes beside a game, in the format written by `arcade generate games`.
fn witnesses(folder: &Path, levels: usize) -> Vec<WitnessEntry> {
    let read = |level: usize| {
        let name = format!("lvl{level}");
        let path = folder.join("witness").join(format!("{name}.json"));
        let episode = path.is_file().then(|| episodes::read(&path).ok()).flatten()?;
        Some(WitnessEntry { name, level, episode })
    };
    (0..levels).filter_map(read).collect()
}

fn corpus() -> Result<Vec<GameEntry>, Failure> {
    let entry = |game: snapshots::CorpusGame| {
        let levels = game.levels.into_iter().enumerate();
        let levels = levels.map(|(number, text)| NamedText { name: format!("lvl{number}.txt"), text });
        GameEntry {
            id: game.name,
            title: game.card.title.clone(),
            place: Place::Texts {
                source: NamedText { name: "game.vgdl".to_owned(), text: game.source },
                levels: levels.collect(),
            },
            summary: game.card.goal.clone(),
            card: Some(json!(game.card)),
            witnesses: Vec::new(),
        }
    };
    Ok(embedded::corpus()?.games.into_iter().map(entry).collect())
}

/// Opens a release, and optionally a second release for comparison. Both are verified first.
fn release(path: &Path, against: Option<&Path>, copies: PathBuf) -> Result<Workspace, Failure> {
    let read = |path: &Path| Released::read(path).map_err(|error| unsound(path, &error));
    let mut workspace = of_release(path, read(path)?, copies);
    if let Some(other) = against {
        workspace.against = Some((other.to_owned(), Arc::new(read(other)?)));
    }
    Ok(workspace)
}

/// Returns a verified release's workspace.
pub(crate) fn of_release(path: &Path, released: Released, copies: PathBuf) -> Workspace {
    let released = Arc::new(released);
    let games = released.games.iter().map(|game| {
        let level = |(number, level): (usize, &snapshots::released::ReleasedLevel)| NamedText {
            name: format!("lvl{number}.txt"),
            text: level.text.clone(),
        };
        let witness = |(level, found): (usize, &snapshots::released::ReleasedLevel)| {
            let episode = found.witness.clone()?;
            Some(WitnessEntry { name: format!("lvl{level}"), level, episode })
        };
        GameEntry {
            id: game.card.id.clone(),
            title: game.card.title.clone(),
            place: Place::Texts {
                source: NamedText { name: "game.vgdl".to_owned(), text: game.source.clone() },
                levels: game.levels.iter().enumerate().map(level).collect(),
            },
            card: Some(json!(game.card)),
            summary: game.card.goal.clone(),
            witnesses: game.levels.iter().enumerate().filter_map(witness).collect(),
        }
    });
    let mut workspace =
        Workspace::new(Kind::Snapshot, released.manifest.name.clone(), copies, games.collect());
    workspace.root = Some(path.to_owned());
    workspace.released = Some(released.clone());
    workspace
}

pub(super) fn unsound(path: &Path, error: &snapshots::released::ReleasedError) -> Failure {
    let name = path.in_message();
    malformed!(
        "{name}: {error}; `arcade verify {name}` lists all problems, `arcade studio {name}/games` opens its \
         games without verifying them"
    )
}
