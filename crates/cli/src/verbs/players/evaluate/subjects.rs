//! An evaluation's subjects: the games in a snapshot, or games specified by the user.

use crate::ceilings;
use crate::diagnostics;
use crate::diagnostics::Named;
use crate::failure::Failure;
use crate::input;
use crate::input::embedded;
use crate::input::game_input::GameInput;
use crate::input::text::read_text;
use crate::marks;
use crate::paths;
use base::Digest;
use base::MessagePath;
use engine::{MAX_LEVEL_TEXT, MAX_SOURCE};
use evaluation::{Subject, SubjectFacts, Unreadable};
use forge::card::Card;
use snapshots::archive::{Archive, is_archive};
use snapshots::ceilings::Ceilings;
use snapshots::marks::Marks;
use snapshots::{Integrity, MANIFEST_FILE, check_integrity};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The maximum number of game names listed in a message.
const MAX_LISTED: usize = 12;

/// The maximum size of a card, in bytes. A card for a game with many levels can occupy several hundred
/// kilobytes.
const MAX_CARD: usize = 1 << 24;

/// The maximum size of a file about all levels of a release, such as its marks or its ceilings, in bytes.
const MAX_SUMMARY: usize = 1 << 26;

/// The games specified by the user, and the selection to play.
pub(crate) struct Wanted<'a> {
    pub(crate) subjects: &'a [String],
    pub(crate) games: &'a [String],
    pub(crate) levels: &'a [usize],
    pub(crate) as_reference: bool,
}

/// The games, and the snapshot's root digest if all games come from one snapshot.
pub(crate) struct Subjects {
    pub(crate) snapshot: Option<Digest>,
    /// The snapshot's name, or `None` if the games do not all come from one snapshot.
    pub(crate) release: Option<String>,
    pub(crate) games: Vec<Subject>,
}

/// Reads the specified subjects: a snapshot, or games.
pub(crate) fn read(args: &Wanted<'_>) -> Result<Subjects, Failure> {
    let (mut snapshot, mut release, mut games): (_, _, Vec<Subject>) = (None, None, Vec::new());
    let places: Vec<PathBuf> = args.subjects.iter().map(|name| paths::release(PathBuf::from(name))).collect();
    if let Some(place) = places.iter().find(|place| is_snapshot(place)) {
        if args.subjects.len() > 1 {
            bail!("{}: a snapshot is evaluated alone; remove the other games", place.in_message());
        }
        let (name, root, found) = of_snapshot(place, args)?;
        (snapshot, release, games) = (Some(root), Some(name), found);
    } else {
        let found = input::named_games(args.subjects);
        let found = match &places[..] {
            [place] => found.map_err(|error| with_release(error, place)),
            _ => found,
        };
        for input in found? {
            games.push(of_input(&input, args)?);
        }
    }
    let mut ids = BTreeSet::new();
    if let Some(twice) = games.iter().find(|subject| !ids.insert(&subject.id)) {
        bail!("two games have the id `{}`; pass only one of them", twice.id);
    }
    if let Some(unknown) = args.games.iter().find(|id| !ids.contains(*id)) {
        let help = help_with(unknown, &games);
        bail!("--games: there is no game `{unknown}`; {help}");
    }
    games.retain(|subject| args.games.is_empty() || args.games.contains(&subject.id));
    if games.iter().all(|subject| subject.levels.is_empty()) {
        bail!("there is no level to play; see --levels");
    }
    Ok(Subjects { snapshot, release, games })
}

/// Adds advice to a missing-file error if `releases/` contains a release with that name.
fn with_release(error: Failure, place: &Path) -> Failure {
    let release = Path::new("releases").join(place);
    match !place.exists() && is_snapshot(&release) {
        true => malformed!(
            "{}: there is no such file, folder or corpus game; did you mean `{}`?",
            place.in_message(),
            release.in_message()
        ),
        false => error,
    }
}

fn of_input(input: &GameInput, args: &Wanted<'_>) -> Result<Subject, Failure> {
    let id = folder_name(&input.title);
    let corpus = embedded::corpus()?;
    let known = corpus.find(&input.title);
    let (title, kind) = known.map(|known| (known.card.title.clone(), known.card.kind.clone())).unzip();
    let facts = SubjectFacts {
        title: title.unwrap_or_else(|| id.clone()),
        kind: kind.unwrap_or_default(),
        as_reference: args.as_reference,
        ..SubjectFacts::default()
    };
    let named = input.numbered_levels()?;
    if named.is_empty() {
        bail!("{}: there are no levels next to the game; pass level files after it", input.source.name);
    }
    let wanted = named.iter().filter(|(number, _)| args.wants(*number));
    let levels: Vec<_> = wanted.map(|(number, level)| (*number, level.text.clone(), None)).collect();
    let subject = Subject::read(&id, &input.source.text, &levels, facts);
    subject.map_err(|Unreadable { level, problems }| {
        let level = named.iter().find(|(number, _)| Some(*number) == level);
        let file = level.map_or(&input.source, |(_, named)| named);
        diagnostics::failure(file, &problems.0)
    })
}

/// Returns suggestions for an unknown game: a similar ID or title, a game whose name contains the word, or,
/// failing that, a list of all games.
fn help_with(unknown: &str, games: &[Subject]) -> String {
    let names =
        || games.iter().flat_map(|game| [(game.id.as_str(), game), (game.facts.title.as_str(), game)]);
    let of = |name: &str| names().find(|(known, _)| *known == name).map(|(_, game)| game.id.as_str());
    let part = |name: &str| name.to_lowercase().contains(&unknown.to_lowercase());
    let near = engine::nearest(unknown, names().map(|(name, _)| name)).and_then(of);
    let near = near.or_else(|| names().find(|(name, _)| part(name)).map(|(_, game)| game.id.as_str()));
    if let Some(near) = near.filter(|_| !unknown.is_empty()) {
        return format!("did you mean `{near}`?");
    }
    let listed: Vec<&str> = games.iter().map(|game| game.id.as_str()).take(MAX_LISTED).collect();
    let more = games.len().saturating_sub(MAX_LISTED);
    let more = if more == 0 { String::new() } else { format!(" and {more} more") };
    format!("the games are {}{more}", listed.join(", "))
}

/// Returns `true` if the path is a release: a folder with a manifest, or an archive.
fn is_snapshot(place: &Path) -> bool {
    let is_file = place.metadata().is_ok_and(|found| found.is_file());
    let is_called_archive = place.to_string_lossy().ends_with(".tar.zst");
    match is_file {
        true => is_called_archive || is_archive(place).unwrap_or(false),
        false => place.join(MANIFEST_FILE).exists(),
    }
}

enum Files<'a> {
    Folder(&'a Path),
    Archive(Box<Archive>),
}

impl<'a> Files<'a> {
    /// Opens the release at `place`, and returns it together with its problems.
    fn open(place: &'a Path) -> Result<(Integrity, Files<'a>), Failure> {
        if place.is_dir() {
            return Ok((check_integrity(place)?, Files::Folder(place)));
        }
        let archive = Archive::open(place)?;
        Ok((archive.integrity.clone(), Files::Archive(Box::new(archive))))
    }

    /// Returns `true` if the release contains a file at the path.
    fn has(&self, path: &str) -> bool {
        match self {
            Files::Folder(root) => root.join(path).is_file(),
            Files::Archive(archive) => archive.file(path).is_some(),
        }
    }

    /// Reads a text file of up to `limit` bytes in the release.
    fn text(&self, path: &str, limit: usize) -> Result<String, Failure> {
        let archive = match self {
            Files::Folder(root) => return read_text(&root.join(path), limit),
            Files::Archive(archive) => archive,
        };
        let wrong = |what: &str| malformed!("{path}, in the archive: {what}");
        let bytes = archive.file(path).ok_or_else(|| wrong("there is no such file"))?;
        if bytes.len() > limit {
            return Err(wrong(&format!("larger than {limit} bytes, the limit for such a file")));
        }
        String::from_utf8(bytes.to_vec()).map_err(|_| wrong("not a text file"))
    }
}

fn of_snapshot(place: &Path, args: &Wanted<'_>) -> Result<(String, Digest, Vec<Subject>), Failure> {
    let (integrity, files) = Files::open(place)?;
    if let Some(problem) = integrity.problems.first() {
        let place = place.in_message();
        bail!("{place}: does not verify: {problem}; `arcade verify` lists all problems");
    }
    let manifest = &integrity.manifest;
    let ids = manifest.items.iter().filter_map(|item| {
        let (id, file) = item.path.strip_prefix("games/")?.split_once('/')?;
        (file == "card.json").then_some(id)
    });
    // A sealed release withholds its marks and ceilings, and files in a different version's format cannot be read. Both
    // count as missing.
    let summary = |path: Option<String>| -> Result<Option<String>, Failure> {
        path.filter(|path| files.has(path)).map(|path| files.text(&path, MAX_SUMMARY)).transpose()
    };
    let marks = summary(Marks::path_in(manifest))?.and_then(|text| Marks::read(text.as_bytes()).ok());
    let ceilings = summary(Ceilings::path_in(manifest))?;
    let ceilings = ceilings.and_then(|text| Ceilings::read(text.as_bytes()).ok());
    let mut games = Vec::new();
    for id in ids {
        let path = |file: &str| format!("games/{id}/{file}");
        let shown = |file: &str| place.join(path(file)).in_message().to_string();
        let card = files.text(&path("card.json"), MAX_CARD)?;
        let card: Card = serde_json::from_str(&card)
            .map_err(|error| malformed!("{}: not a valid card: {error}", shown("card.json")))?;
        let source = files.text(&path("game.vgdl"), MAX_SOURCE)?;
        let mut levels = Vec::new();
        for (number, level) in card.levels.iter().enumerate().filter(|(number, _)| args.wants(*number)) {
            let text = files.text(&path(&level.file), MAX_LEVEL_TEXT)?;
            levels.push((number, text, level.optimal_ticks));
        }
        let mut facts =
            SubjectFacts { title: card.title.clone(), kind: card.kind.clone(), ..SubjectFacts::default() };
        facts.marks = marks.iter().flat_map(|marks| marks::of_game(marks, id)).collect();
        facts.marks.retain(|mark| args.wants(mark.level));
        facts.ceilings = ceilings.iter().flat_map(|ceilings| ceilings::of_game(ceilings, id)).collect();
        facts.ceilings.retain(|ceiling| args.wants(ceiling.level));
        let wins = card.levels.iter().enumerate().filter(|(number, _)| args.wants(*number));
        let wins = wins.map(|(number, level)| (number, level.optimal_ticks.unwrap_or(level.witness_ticks)));
        facts.release = Some(manifest.name.clone());
        facts.known_wins =
            wins.filter(|(_, ticks)| *ticks > 0).map(|(number, ticks)| (number, ticks as u64)).collect();
        let subject = Subject::read(id, &source, &levels, facts);
        games.push(subject.map_err(|Unreadable { level, problems }| {
            let file = level.map_or("game.vgdl", |number| &card.levels[number].file);
            let text =
                levels.iter().find(|(number, ..)| Some(*number) == level).map_or(&source, |level| &level.1);
            let named = Named { name: shown(file), text: text.clone() };
            diagnostics::failure(&named, &problems.0)
        })?);
    }
    Ok((manifest.name.clone(), manifest.root, games))
}

impl Wanted<'_> {
    fn wants(&self, level: usize) -> bool {
        self.levels.is_empty() || self.levels.contains(&level)
    }
}

/// Returns the last meaningful component of a path, made usable as a folder name.
fn folder_name(title: &str) -> String {
    let path = Path::new(title);
    let parts = path.iter().rev().filter_map(|part| part.to_str());
    let stem = |part: &str| match part.rsplit_once('.') {
        Some((stem, ending)) if ["vgdl", "txt"].iter().any(|known| ending.eq_ignore_ascii_case(known)) => {
            stem.to_owned()
        }
        _ => part.to_owned(),
    };
    let said = parts.map(stem).find(|part| part != "game" && !part.is_empty()).unwrap_or_default();
    let plain = said.replace(|c: char| !(c.is_alphanumeric() || matches!(c, '-' | '_')), "-");
    if plain.trim_matches('-').is_empty() { "game".to_owned() } else { plain }
}

#[cfg(test)]
mod tests {
    use super::folder_name;

    #[test]
    fn folders_are_named_after_games() {
        for (title, id) in [
            ("hailglass", "hailglass"),
            ("mine/pond.vgdl", "pond"),
            ("mine/pond/game.vgdl", "pond"),
            ("a b:c.txt", "a-b-c"),
            ("..", "game"),
            ("game.vgdl", "game"),
            ("gridphysics/zelda.TXT", "zelda"),
        ] {
            assert_eq!(folder_name(title), id, "{title}");
        }
    }
}
