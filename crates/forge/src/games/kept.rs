//! Attempt results as text. They are saved to disk so that an interrupted run can resume and produce identical bytes.

use super::attempt::Attempted;
use super::candidate::MadeGame;
use super::found_level::FoundLevel;
use crate::card::Card;
use crate::tally::Tally;
use base::Seed;
use engine::{Episode, Game};
use serde::{Deserialize, Serialize};
use validators::Report;

/// The result of an attempt: a game, or the reasons why there is no game.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Kept {
    /// The accepted game; `None` if the judges accepted no game.
    pub game: Option<KeptGame>,
    /// The counts of all candidates tried.
    pub tally: Tally,
}

/// A finished game in text form.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KeptGame {
    /// The rules, headed by the title and the release's canary (its identifier in text corpora).
    pub text: String,
    /// The game card.
    pub card: Card,
    /// The level texts.
    pub levels: Vec<String>,
    /// The winning episode of each level.
    pub witnesses: Vec<Episode>,
}

impl Kept {
    /// Converts an attempt's result to text.
    pub(super) fn of(attempted: &Attempted) -> Kept {
        let game = attempted.made.as_ref().map(|made| KeptGame {
            text: made.text.clone(),
            card: made.card.clone(),
            levels: made.levels.iter().map(|found| found.level.to_string()).collect(),
            witnesses: made.witnesses.clone(),
        });
        Kept { game, tally: attempted.tally.clone() }
    }

    /// Restores the result; `None` if the texts do not form a game. The judges' reports are lost.
    pub(super) fn restored(self) -> Option<Attempted> {
        let made = match self.game {
            Some(game) => Some(game.restored()?),
            None => None,
        };
        Some(Attempted { made, tally: self.tally })
    }
}

impl KeptGame {
    fn restored(self) -> Option<MadeGame> {
        let KeptGame { text, card, levels, witnesses } = self;
        let game = Game::from_source(&text).ok()?;
        let places = levels.iter().zip(&card.levels).zip(&witnesses);
        let found = |((text, card), witness): ((&String, &crate::card::LevelCard), &Episode)| {
            Some(FoundLevel {
                level: game.level(text).ok()?,
                report: Report { judgements: Vec::new(), witness: Some(witness.clone()) },
                generator: "course",
                asks: card.asks.clone(),
                difficulty: card.difficulty,
                candidate: card.candidate,
                seed: Seed::from_text("kept").into(),
                demand: card.demand.clone(),
            })
        };
        let levels = places.map(found).collect::<Option<Vec<FoundLevel>>>()?;
        let seed = Seed::from_text("kept").into();
        Some(MadeGame { game, text, card, levels, together: Vec::new(), witnesses, seed })
    }
}
