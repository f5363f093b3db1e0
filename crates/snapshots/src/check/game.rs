//! Checks that the rules, levels, card and witnesses of a released game fit together.

use super::numbers;
use crate::Digest;
use crate::contents::replay::{Replayed, replay};
use crate::error::SnapshotError;
use crate::format::canary::carries;
use crate::format::layout::witness_path;
use crate::format::manifest::item::ReleaseKind;
use crate::format::witness::Witness;
use crate::recipe::secret::UNRELATED_WITNESS;
use crate::sections::SECTIONS;
use crate::sections::section::{CheckedGame, Checking, Found};
use engine::{Analysis, Game};
use forge::card::{Card, Origin};
use forge::games::slug;
use generators::kernels::Wording;
use std::collections::{BTreeMap, BTreeSet};

/// The maximum size of a `card.json`, in bytes: 1 MiB. The card of a game with twenty levels takes up a tenth of
/// that.
const CARD_LIMIT: u64 = 1 << 20;
/// The maximum number of patterns on a card. A generated game has about ten patterns, plus the patterns of its edits.
const MAX_PATTERNS: usize = 1024;

/// The relative paths of the files in a game's folder.
pub(super) type Files = BTreeSet<String>;

/// The result of checking a game.
#[derive(Default)]
pub(super) struct GameCheck {
    /// The number of levels read.
    pub(super) levels: usize,
    /// The number of witnesses that replayed to a win.
    pub(super) replayed: usize,
    /// The paths of the game's witnesses that are withheld until the release is revealed.
    pub(super) held: Vec<String>,
    /// The card, if it is valid.
    pub(super) card: Option<Card>,
    /// The problems, each with the file name.
    pub(super) problems: Vec<String>,
}

impl Checking<'_> {
    /// Checks the folders whose names end with the same digest, in the given order. If two folders contain the same
    /// game, the second folder is reported as a problem, and its witnesses are not replayed.
    pub(super) fn namesakes(&self, folders: &[(String, Files)]) -> Result<Vec<GameCheck>, SnapshotError> {
        let mut seen = BTreeMap::new();
        folders.iter().map(|(folder, files)| self.game(folder, files, &mut seen)).collect()
    }

    /// Returns the problems with the texts and facts on a card that follow from the rules. Texts can be compared only
    /// if this version would word them identically.
    fn of_the_rules(&self, card: &Card, game: &Game) -> Vec<String> {
        let version = (self.manifest.generation, self.manifest.semantics);
        if version != (generators::GENERATION, engine::SEMANTICS) {
            return Vec::new();
        }
        let mut found = Vec::new();
        if card.rules != engine::describe(game) {
            found.push("the card's `rules` do not match game.vgdl".to_owned());
        }
        if card.deterministic == Analysis::of(game).is_stochastic() {
            found.push("the card's `deterministic` does not match game.vgdl".to_owned());
        }
        let patterns: &[String] = match &card.origin {
            Origin::Generated { patterns, .. } => patterns,
            Origin::Corpus { .. } => &[],
        };
        let wording = Wording::of(game, patterns);
        if !wording.has_goal(&card.goal) {
            found.push("the card's `goal` does not match game.vgdl".to_owned());
        }
        if !wording.has_summary(&card.description) {
            found.push("the card's `description` does not match game.vgdl".to_owned());
        }
        let comments = &game.description().header.trivia.above;
        if card.id != format!("{}-{}", slug(&card.title), game.digest().short())
            || comments.first().is_none_or(|title| title.trim() != card.title.trim())
        {
            found.push("the card's `title` does not match game.vgdl and its folder".to_owned());
        }
        found
    }

    fn game(
        &self,
        folder: &str,
        files: &Files,
        seen: &mut BTreeMap<Digest, String>,
    ) -> Result<GameCheck, SnapshotError> {
        let mut check = GameCheck::default();
        let GameCheck { levels, replayed, held, problems, .. } = &mut check;
        let canary = &self.manifest.canary;
        let path = |file: &str| format!("games/{folder}/{file}");
        // The digests match, so every listed file can be read with its stated size, although its content may
        // still be wrong.
        let read = |file: &str| -> Result<Option<String>, SnapshotError> {
            match files.contains(file) {
                true => Ok(String::from_utf8(self.contents.read(&path(file))?).ok()),
                false => Ok(None),
            }
        };
        let mut wrong = |file: &str, what: String| problems.push(format!("{}: {what}", path(file)));

        let Some(source) = read("game.vgdl")? else {
            wrong("game.vgdl", "missing or not a text file".to_owned());
            return Ok(check);
        };
        if !carries(source.as_bytes(), canary) {
            wrong("game.vgdl", "the release's canary is missing".to_owned());
        }
        let game = match Game::from_source(&source) {
            Ok(game) => game,
            Err(problems) => {
                wrong("game.vgdl", format!("not a valid game: {problems}"));
                return Ok(check);
            }
        };
        let of_card = self.manifest.item(&path("card.json"));
        if let Some(item) = of_card.filter(|item| item.size > CARD_LIMIT) {
            wrong("card.json", format!("the card has {} bytes; the limit is {CARD_LIMIT}", item.size));
            return Ok(check);
        }
        let mut card: Card = match read("card.json")?.map(|text| serde_json::from_str(&text)) {
            Some(Ok(card)) => card,
            Some(Err(error)) => {
                wrong("card.json", format!("not a valid card: {error}"));
                return Ok(check);
            }
            None => {
                wrong("card.json", "missing or not a text file".to_owned());
                return Ok(check);
            }
        };
        if card.id != folder || card.digest != game.digest() || !folder.ends_with(&game.digest().short()) {
            wrong("card.json", "the card, the folder name and the game do not match".to_owned());
        }
        if matches!(&card.origin, Origin::Generated { patterns, .. } if patterns.len() > MAX_PATTERNS) {
            wrong("card.json", format!("the card has more than {MAX_PATTERNS} patterns"));
            return Ok(check);
        }
        if card.canary != *canary {
            wrong("card.json", "the canary differs from the release's canary".to_owned());
        }
        if card.levels.is_empty() {
            wrong("card.json", "the game has no levels".to_owned());
        }
        for what in self.of_the_rules(&card, &game) {
            wrong("card.json", what);
        }
        let twin = seen.get(&game.digest());
        if let Some(other) = twin {
            wrong("game.vgdl", format!("the same game as games/{other}"));
        }
        let is_sealed = self.manifest.kind == ReleaseKind::Sealed;
        let mut known: BTreeSet<String> = ["game.vgdl", "card.json"].map(str::to_owned).into();
        let mut boards: BTreeMap<Digest, usize> = BTreeMap::new();
        let mut loaded = Vec::new();
        for (number, level_card) in card.levels.iter().enumerate() {
            let (file, witness_file) = (format!("lvl{number}.txt"), format!("witness/lvl{number}.json"));
            if is_sealed {
                held.push(witness_path(ReleaseKind::Sealed, folder, number));
            }
            let level = match read(&file)?.map(|text| game.level(&text)) {
                Some(Ok(level)) => level,
                Some(Err(problems)) => {
                    wrong(&file, format!("not a level of this game: {problems}"));
                    continue;
                }
                None => {
                    wrong(&file, "missing or not a text file".to_owned());
                    continue;
                }
            };
            *levels += 1;
            if level_card.file != file || level_card.digest != level.digest() {
                wrong(&file, "the card and the level do not match".to_owned());
            }
            for what in numbers::problems(level_card, &level) {
                wrong("card.json", format!("{file}: {what}"));
            }
            let first = *boards.entry(level.digest()).or_insert(number);
            if first != number {
                wrong(&file, format!("the same level as lvl{first}.txt"));
            }
            let is_again = first != number || twin.is_some();
            let mut won = None;
            let witness = match is_sealed {
                true => {
                    let bytes = self.contents.find(&witness_path(ReleaseKind::Sealed, folder, number))?;
                    bytes.and_then(|bytes| String::from_utf8(bytes).ok())
                }
                false => read(&witness_file)?,
            };
            match witness.map(|text| serde_json::from_str::<Witness>(&text)) {
                Some(Ok(witness)) if witness.canary != *canary => {
                    wrong(&witness_file, "the canary differs from the release's canary".to_owned());
                }
                Some(Ok(witness))
                    if self
                        .secret
                        .is_some_and(|secret| !secret.leads_to(&witness, &self.manifest.recipe)) =>
                {
                    wrong(&witness_file, UNRELATED_WITNESS.to_owned());
                }
                Some(Ok(Witness { episode, .. })) => {
                    let told = (level_card.witness_ticks, level_card.witness_score);
                    let fits = (episode.actions.len(), episode.score) == told;
                    if !fits {
                        let what =
                            format!("the ticks and score differ from those of the episode that wins {file}");
                        wrong("card.json", what);
                    }
                    // Duplicates and mismatches have already been reported, so their witnesses are not
                    // replayed.
                    let meter = self.meter.filter(|_| fits && !is_again);
                    match meter.map(|meter| replay(&episode, &game, &level, meter)) {
                        Some(Replayed::Won) => *replayed += 1,
                        Some(Replayed::Wrong(what)) => wrong(&witness_file, what),
                        Some(Replayed::OutOfWork) | None => {}
                    }
                    won = Some(episode);
                }
                Some(Err(error)) => wrong(&witness_file, format!("not a valid witness: {error}")),
                // Missing withheld files have already been reported.
                None if is_sealed => {}
                None => wrong(&witness_file, "missing or not a text file".to_owned()),
            }
            loaded.push((level, won));
            known.insert(file);
            if !is_sealed {
                known.insert(witness_file);
            }
        }
        for file in files.difference(&known) {
            wrong(file, "not part of a game".to_owned());
        }
        if loaded.len() == card.levels.len() {
            let checked = CheckedGame { folder, game: &game, levels: &loaded, is_again: twin.is_some() };
            let mut found = Found::default();
            SECTIONS.iter().try_for_each(|section| section.check_game(self, &checked, &mut found))?;
            held.extend(found.listed);
            problems.extend(found.problems);
            *replayed += found.replayed;
        }
        seen.entry(game.digest()).or_insert_with(|| folder.to_owned());
        // The texts are dropped to save memory, because the cards of all games are kept until they have been counted.
        for text in [&mut card.title, &mut card.description, &mut card.goal, &mut card.rules] {
            *text = String::new();
        }
        check.card = Some(card);
        Ok(check)
    }
}
