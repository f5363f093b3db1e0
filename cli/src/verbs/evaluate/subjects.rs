//! What is evaluated: the games of a snapshot, or games as the user names them.

use crate::diagnostics;
use crate::embedded;
use crate::failure::Failure;
use crate::input::{self, GameInput, Named, read_text};
use crate::verbs::verify;
use engine::{Digest, MAX_LEVEL_TEXT, MAX_SOURCE};
use evaluation::{Subject, SubjectFacts, Unreadable};
use snapshots::card::Card;
use snapshots::{MANIFEST_FILE, check_integrity};
use std::collections::BTreeSet;
use std::path::Path;

/// A card of a game with many levels has some hundred kilobytes.
const MAX_CARD: usize = 1 << 24;

/// The games, and the root digest of the snapshot if all of them are from one.
pub(crate) struct Subjects {
    pub(crate) snapshot: Option<Digest>,
    pub(crate) games: Vec<Subject>,
}

/// Which part of what is named is wanted.
pub(crate) struct Choice<'a> {
    pub(crate) games: &'a [String],
    pub(crate) levels: &'a [usize],
    pub(crate) as_reference: bool,
}

/// Reads what the user names: a snapshot's folder, or games.
pub(crate) fn read(names: &[String], choice: &Choice<'_>) -> Result<Subjects, Failure> {
    let (mut snapshot, mut games): (_, Vec<Subject>) = (None, Vec::new());
    for name in names {
        let folder = Path::new(name);
        if folder.join(MANIFEST_FILE).exists() {
            if names.len() > 1 {
                return Err(Failure::malformed(format!("{name}: a snapshot is evaluated alone")));
            }
            let (root, found) = of_snapshot(folder, choice)?;
            (snapshot, games) = (Some(root), found);
        } else {
            for input in input::games(name)? {
                games.extend(of_input(&input, choice)?);
            }
        }
    }
    let mut ids = BTreeSet::new();
    if let Some(twice) = games.iter().find(|subject| !ids.insert(&subject.id)) {
        return Err(Failure::malformed(format!("two games are called `{}`; name one of them", twice.id)));
    }
    if let Some(unknown) = choice.games.iter().find(|id| !ids.contains(*id)) {
        let near = engine::nearest(unknown, ids.iter().map(|id| id.as_str()));
        let help = near.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
        return Err(Failure::malformed(format!("--games: there is no `{unknown}` among them{help}")));
    }
    games.retain(|subject| choice.games.is_empty() || choice.games.contains(&subject.id));
    if games.iter().all(|subject| subject.levels.is_empty()) {
        return Err(Failure::malformed("there is no level to play; see --levels"));
    }
    Ok(Subjects { snapshot, games })
}

fn of_input(input: &GameInput, choice: &Choice<'_>) -> Result<Option<Subject>, Failure> {
    let id = slug(&input.title);
    let title = embedded::corpus()?.find(&input.title).map(|known| known.card.title.clone());
    let facts = SubjectFacts {
        title: title.unwrap_or_else(|| id.clone()),
        as_reference: choice.as_reference,
        ..SubjectFacts::default()
    };
    let named = input.levels()?;
    if named.is_empty() {
        return Err(Failure::malformed(format!(
            "{}: the game has no levels; put lvl0.txt and so on beside a game.vgdl, and name the folder",
            input.source.name
        )));
    }
    let wanted = named.iter().enumerate().filter(|(number, _)| choice.wants(*number));
    let levels: Vec<_> = wanted.map(|(number, level)| (number, level.text.clone(), None)).collect();
    let subject = Subject::read(&id, &input.source.text, &levels, facts);
    subject.map(Some).map_err(|Unreadable { level, problems }| {
        let file = level.map_or(&input.source, |number| &named[number]);
        diagnostics::failure(file, &problems.0)
    })
}

fn of_snapshot(folder: &Path, choice: &Choice<'_>) -> Result<(Digest, Vec<Subject>), Failure> {
    let integrity = check_integrity(folder).map_err(verify::failure)?;
    if let Some(problem) = integrity.problems.first() {
        let folder = folder.display();
        return Err(Failure::malformed(format!(
            "{folder}: does not verify: {problem}; `arcade verify` tells all"
        )));
    }
    let manifest = &integrity.manifest;
    let ids = manifest.items.iter().filter_map(|item| {
        let (id, file) = item.path.strip_prefix("games/")?.split_once('/')?;
        (file == "card.json").then_some(id)
    });
    let mut games = Vec::new();
    for id in ids {
        let game = folder.join("games").join(id);
        let card = read_text(&game.join("card.json"), MAX_CARD)?;
        let card: Card = serde_json::from_str(&card)
            .map_err(|error| Failure::malformed(format!("{}: not a card: {error}", game.display())))?;
        let source = read_text(&game.join("game.vgdl"), MAX_SOURCE)?;
        let mut levels = Vec::new();
        for (number, level) in card.levels.iter().enumerate().filter(|(number, _)| choice.wants(*number)) {
            let text = read_text(&game.join(&level.file), MAX_LEVEL_TEXT)?;
            levels.push((number, text, level.optimal_ticks));
        }
        let facts = SubjectFacts { title: card.title.clone(), ..SubjectFacts::default() };
        let subject = Subject::read(id, &source, &levels, facts);
        games.push(subject.map_err(|Unreadable { level, problems }| {
            let file = level.map_or("game.vgdl", |number| &card.levels[number].file);
            let text =
                levels.iter().find(|(number, ..)| Some(*number) == level).map_or(&source, |level| &level.1);
            let named = Named { name: game.join(file).display().to_string(), text: text.clone() };
            diagnostics::failure(&named, &problems.0)
        })?);
    }
    Ok((manifest.root, games))
}

impl Choice<'_> {
    fn wants(&self, level: usize) -> bool {
        self.levels.is_empty() || self.levels.contains(&level)
    }
}

/// A name of a folder or file as the name of a folder of ours: the last part that says something.
fn slug(title: &str) -> String {
    let path = Path::new(title);
    let parts = path.iter().rev().filter_map(|part| part.to_str());
    let stem = |part: &str| part.trim_end_matches(".vgdl").trim_end_matches(".txt").to_owned();
    let said = parts.map(stem).find(|part| part != "game" && !part.is_empty()).unwrap_or_default();
    let plain: String =
        said.chars().map(|c| if c.is_alphanumeric() || matches!(c, '-' | '_') { c } else { '-' }).collect();
    if plain.trim_matches('-').is_empty() { "game".to_owned() } else { plain }
}

#[cfg(test)]
mod tests {
    use super::slug;

    #[test]
    fn folders_are_named_after_games() {
        for (title, id) in [
            ("hailglass", "hailglass"),
            ("mine/pond.vgdl", "pond"),
            ("mine/pond/game.vgdl", "pond"),
            ("a b:c.txt", "a-b-c"),
            ("..", "game"),
            ("game.vgdl", "game"),
        ] {
            assert_eq!(slug(title), id, "{title}");
        }
    }
}
