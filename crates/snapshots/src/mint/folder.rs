//! Converts the selected games into files and a manifest.

use super::plan::Plan;
use crate::Digest;
use crate::card::ReleaseCard;
use crate::contents::disclose::withhold;
use crate::error::SnapshotError;
use crate::format::layout::{README_FILE, RELEASE_CARD_FILE, SECRET_FILE, witness_path};
use crate::format::manifest::item::{Item, ReleaseKind};
use crate::format::manifest::{FORMAT, Manifest};
use crate::format::witness::Witness;
use crate::mint::error::MintError;
use crate::recipe::Recipe;
use crate::recipe::secret::Secret;
use crate::sections::SECTIONS;
use crate::sections::frozen::FrozenGame;
use crate::sections::section::{Summary, Writing};
use base::canonical::to_canonical_json;
use engine::syntax;
use forge::card::{Card, Origin};
use forge::games::marked;
use std::fmt::Write;

/// A function called with the relative path and the content of each release file as soon as the file has been
/// created.
pub type Sink<'a> = dyn FnMut(&str, &[u8]) -> Result<(), SnapshotError> + 'a;

/// A release that is being written. Its files are sent to a sink, and only the data for the manifest is
/// retained.
pub(super) struct Folder<'a, 'b> {
    sink: &'a mut Sink<'b>,
    recipe: &'a Recipe,
    canary: String,
    kind: ReleaseKind,
    items: Vec<Item>,
    /// The games written so far, without their texts and episodes.
    games: Vec<FrozenGame>,
}

impl<'a, 'b> Folder<'a, 'b> {
    pub(super) fn new(plan: &Plan<'a>, sink: &'a mut Sink<'b>) -> Folder<'a, 'b> {
        Folder {
            sink,
            recipe: plan.recipe,
            canary: plan.canary(),
            kind: if plan.is_sealed() { ReleaseKind::Sealed } else { ReleaseKind::Open },
            items: Vec::new(),
            games: Vec::new(),
        }
    }

    /// Returns the cards of the written games.
    pub(super) fn cards(&self) -> Vec<Card> {
        self.games.iter().map(|game| game.card.clone()).collect()
    }

    fn file(&mut self, path: String, content: &[u8]) -> Result<(), SnapshotError> {
        (self.sink)(&path, content)?;
        self.items.push(Item::of(path, content));
        Ok(())
    }

    /// Writes a game's files.
    pub(super) fn game(&mut self, mut game: FrozenGame) -> Result<(), SnapshotError> {
        game.card.canary = self.canary.clone();
        for section in SECTIONS {
            let writing = Writing { recipe: self.recipe, canary: &self.canary, kind: self.kind };
            for (path, content) in section.game_files(&writing, &mut game)? {
                self.file(path, &content)?;
            }
        }
        let folder = format!("games/{}", game.card.id);
        let text = marked(&syntax::parse(&std::mem::take(&mut game.text)).0, &self.canary);
        self.file(format!("{folder}/game.vgdl"), text.as_bytes())?;
        self.file(format!("{folder}/card.json"), &json(&game.card)?)?;
        let (levels, paths) = (std::mem::take(&mut game.levels), std::mem::take(&mut game.paths));
        let won = levels.into_iter().zip(std::mem::take(&mut game.witnesses)).zip(paths).enumerate();
        for (number, ((level, episode), path)) in won {
            self.file(format!("{folder}/lvl{number}.txt"), level.as_bytes())?;
            // The paths are needed only in sealed releases. The seed of an open release is public, and all other
            // seeds are derived from it.
            let path = if self.kind == ReleaseKind::Sealed { path } else { Vec::new() };
            let witness = Witness { canary: self.canary.clone(), episode, path };
            self.file(witness_path(self.kind, &game.card.id, number), &json(&witness)?)?;
        }
        self.games.push(game);
        Ok(())
    }

    /// Writes the files that describe the release as a whole, and returns its manifest. The caller must write
    /// the manifest.
    pub(super) fn finish(
        mut self,
        secret: Option<&Secret>,
        lockfile: Digest,
        cards: &[Card],
        card: &ReleaseCard,
    ) -> Result<Manifest, MintError> {
        let recipe = self.recipe;
        let mut text = readme(recipe, &self.canary, cards, card);
        for section in SECTIONS {
            let writing = Writing { recipe, canary: &self.canary, kind: self.kind };
            let Some(Summary { file: (path, content), readme }) = section.summary(&writing, &self.games)?
            else {
                continue;
            };
            self.file(path, &content)?;
            if !readme.is_empty() {
                text = format!("{text}\n{readme}");
            }
        }
        self.file(README_FILE.to_owned(), text.as_bytes())?;
        self.file(RELEASE_CARD_FILE.to_owned(), &json(card)?)?;
        if let (ReleaseKind::Sealed, Some(secret)) = (self.kind, secret) {
            self.file(SECRET_FILE.to_owned(), &json(secret)?)?;
        }
        let mut manifest = Manifest {
            format: FORMAT,
            name: recipe.name.clone(),
            kind: self.kind,
            semantics: engine::SEMANTICS,
            generation: generators::GENERATION,
            version: Some(crate::format::version::CURRENT.number.to_owned()),
            parent: recipe.parent,
            canary: self.canary,
            commitment: recipe.commitment,
            lockfile,
            recipe: serde_json::to_value(recipe).expect("a recipe is plain data"),
            items: self.items,
            withheld: None,
            root: Digest::of(b""),
            checksum: Digest::of(b""),
        };
        if let (ReleaseKind::Sealed, Some(secret)) = (self.kind, secret) {
            for (path, content) in withhold(&mut manifest, secret)? {
                (self.sink)(&path, &content)?;
            }
        }
        manifest.seal_root()?;
        Ok(manifest)
    }
}

fn json(value: &impl serde::Serialize) -> Result<Vec<u8>, SnapshotError> {
    Ok(to_canonical_json(value)?.into_bytes())
}

/// Returns the text of the release's README, which describes the release's content and how to check it.
fn readme(recipe: &Recipe, canary: &str, cards: &[Card], card: &ReleaseCard) -> String {
    let levels: usize = cards.iter().map(|card| card.levels.len()).sum();
    let mut text = format!("# {}\n\n{}\n\n", recipe.name, recipe.description.trim());
    let _ = writeln!(
        text,
        "{} games, {levels} levels. Every level has a witness: an episode that wins it.\n\n\
         {}\n\n\
         Please keep this folder out of training data. Canary: `{canary}`\n",
        cards.len(),
        match recipe.commitment {
            None =>
                "Check the folder with `arcade verify DIR`, mint it again from its seed with `arcade regenerate DIR`.",
            Some(_) => {
                "The release was sealed: its seed and its witnesses were withheld when it was published, and the manifest \
                 commits to them. A folder with `held/secret.json` has been revealed. Check the folder with `arcade verify \
                 DIR`; once revealed, mint it again with `arcade regenerate DIR`."
            }
        }
    );
    SECTIONS.iter().filter_map(|section| section.readme(recipe)).for_each(|words| text += words);
    if let Some(sentence) = recipe.cited().sentence() {
        let _ = writeln!(text, "{sentence}\n");
    }
    for caveat in recipe.caveats() {
        let _ = writeln!(text, "{caveat}\n");
    }
    let _ = writeln!(text, "{}", card.in_words());
    let _ = writeln!(text, "| game | kind | levels | rules | what it is |\n|---|---|---|---|---|");
    for card in cards {
        let rules = match &card.origin {
            Origin::Corpus { name } => format!("corpus `{name}`"),
            Origin::Generated { generator, .. } => format!("new ({generator})"),
        };
        let Card { title, id, kind, description, levels, .. } = card;
        let _ = writeln!(
            text,
            "| [{title}](games/{id}/card.json) | {kind} | {} | {rules} | {} |",
            levels.len(),
            description.replace('|', "\\|"),
        );
    }
    text
}
