//! Turning the selected games into files and a manifest.

use super::plan::Plan;
use crate::Digest;
use crate::card::ReleaseCard;
use crate::contents::disclose::withhold;
use crate::error::SnapshotError;
use crate::format::layout::{RELEASE_CARD_FILE, SECRET_FILE, second_path, sibling_path, witness_path};
use crate::format::manifest::item::{Item, ReleaseKind};
use crate::format::manifest::{FORMAT, Manifest};
use crate::format::witness::Witness;
use crate::mint::error::MintError;
use crate::recipe::Recipe;
use crate::recipe::secret::Secret;
use crate::sections::frozen::FrozenGame;
use crate::sections::marks::{GameMarks, LevelMarks, Marks, Wins};
use crate::sections::memory::SecondWin;
use engine::syntax;
use forge::card::{Card, LevelCard, Origin};
use forge::games::marked;
use report::canonical::to_canonical_json;
use std::fmt::Write;
use validators::Tier;

/// Receives the files of a release as they are made: relative path and content.
pub type Sink<'a> = dyn FnMut(&str, &[u8]) -> Result<(), SnapshotError> + 'a;

/// A release that is being written: files go to a sink, and the data for the manifest is kept.
pub(super) struct Folder<'a, 'b> {
    sink: &'a mut Sink<'b>,
    canary: String,
    kind: ReleaseKind,
    items: Vec<Item>,
    pub(super) cards: Vec<Card>,
    marks: Vec<GameMarks>,
}

impl<'a, 'b> Folder<'a, 'b> {
    pub(super) fn new(plan: &Plan<'_>, sink: &'a mut Sink<'b>) -> Folder<'a, 'b> {
        Folder {
            sink,
            canary: plan.canary(),
            kind: if plan.is_sealed() { ReleaseKind::Sealed } else { ReleaseKind::Open },
            items: Vec::new(),
            cards: Vec::new(),
            marks: Vec::new(),
        }
    }

    fn file(&mut self, path: String, content: &[u8]) -> Result<(), SnapshotError> {
        (self.sink)(&path, content)?;
        self.items.push(Item::of(path, content));
        Ok(())
    }

    /// Writes the files of a game.
    pub(super) fn game(&mut self, frozen: FrozenGame) -> Result<(), SnapshotError> {
        let FrozenGame { text, mut card, levels, witnesses, paths, marks, sibling, seconds, .. } = frozen;
        let folder = format!("games/{}", card.id);
        card.canary = self.canary.clone();
        // Where one of two wins is withheld, the length of the shortest would tell which of the two was published.
        for (level, second) in card.levels.iter_mut().zip(&seconds) {
            level.optimal_ticks = level.optimal_ticks.filter(|_| second.is_none());
        }
        let text = marked(&syntax::parse(&text).0, &self.canary);
        self.file(format!("{folder}/game.vgdl"), text.as_bytes())?;
        self.file(format!("{folder}/card.json"), &json(&card)?)?;
        let won = levels.iter().zip(witnesses).zip(paths).enumerate();
        for (number, ((level, episode), path)) in won {
            self.file(format!("{folder}/lvl{number}.txt"), level.as_bytes())?;
            // The seed of an open release is known, and everything follows from it.
            let path = if self.kind == ReleaseKind::Sealed { path } else { Vec::new() };
            let witness = Witness { canary: self.canary.clone(), episode, path };
            self.file(witness_path(self.kind, &card.id, number), &json(&witness)?)?;
        }
        if let Some(sibling) = sibling {
            let text = marked(&syntax::parse(&sibling.text).0, &self.canary);
            self.file(sibling_path(&card.id, "game.vgdl"), text.as_bytes())?;
            for (number, level) in sibling.levels.iter().enumerate() {
                self.file(sibling_path(&card.id, &format!("lvl{number}.txt")), level.as_bytes())?;
            }
        }
        for (number, second) in seconds.into_iter().enumerate() {
            let Some(SecondWin { episode, path }) = second else { continue };
            let witness = Witness { canary: self.canary.clone(), episode, path };
            self.file(second_path(&card.id, number), &json(&witness)?)?;
        }
        if !marks.is_empty() {
            let of_level =
                |(card, wins): (&LevelCard, Wins)| LevelMarks { tier: card.tier.unwrap_or(Tier::One), wins };
            let levels = card.levels.iter().zip(marks).map(of_level).collect();
            self.marks.push(GameMarks { id: card.id.clone(), levels });
        }
        self.cards.push(card);
        Ok(())
    }

    /// Writes the files about the release as a whole, and returns its manifest, which the caller must write.
    pub(super) fn finish(
        mut self,
        recipe: &Recipe,
        secret: Option<&Secret>,
        lockfile: Digest,
        card: &ReleaseCard,
    ) -> Result<(Manifest, Vec<Card>), MintError> {
        let mut text = readme(recipe, &self.canary, &self.cards, card);
        if let Some(asked) = &recipe.marks {
            let marks = Marks::of(&self.canary, asked, std::mem::take(&mut self.marks));
            self.file(Marks::path(self.kind), &json(&marks)?)?;
            if self.kind == ReleaseKind::Open {
                text = format!("{text}\n{}", marks.in_words());
            }
        }
        self.file("README.md".to_owned(), text.as_bytes())?;
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
        Ok((manifest, self.cards))
    }
}

fn json(value: &impl serde::Serialize) -> Result<Vec<u8>, SnapshotError> {
    Ok(to_canonical_json(value)?.into_bytes())
}

/// The release's own README: its content and how to check it.
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
    if recipe.memory.is_some() {
        text += "Of two renamings of a game, or of two wins of a level, a coin publishes one; the other is committed to and withheld \
                 until the reveal, to tell who has seen what was published (`arcade contamination`).\n\n";
    }
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
