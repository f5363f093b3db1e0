//! The source of a row in an export: a level with its game, or with a twin of the game (the same rules with a different
//! surface).

use crate::format::manifest::Manifest;
use crate::released::{ReleasedGame, ReleasedLevel};
use crate::twin::{Twin, TwinError, TwinGame};
use base::Digest;
use engine::{Analysis, Episode, Game};
use forge::card::{Card, LevelCard};
use std::borrow::Cow;
use validators::{GameForm, GameKind};

/// A game as it is exported: unchanged, or as a twin (the same rules with a different surface).
pub(super) struct ExportedGame<'a> {
    pub(super) title: String,
    pub(super) description: String,
    pub(super) goal: String,
    /// The rules in plain English.
    pub(super) rules: String,
    pub(super) source: String,
    pub(super) game: Game,
    pub(super) levels: Cow<'a, [ReleasedLevel]>,
    /// The names of the types placed by each character, sorted by character.
    pub(super) legend: Vec<(char, String)>,
    pub(super) kind: GameKind,
    /// The digest of the rules, which does not depend on names or order.
    pub(super) form: Digest,
}

impl<'a> ExportedGame<'a> {
    pub(super) fn own(released: &'a ReleasedGame) -> ExportedGame<'a> {
        let ReleasedGame { card, source, game, levels, .. } = released;
        ExportedGame {
            title: card.title.clone(),
            description: card.description.clone(),
            goal: card.goal.clone(),
            rules: card.rules.clone(),
            source: source.clone(),
            levels: Cow::Borrowed(levels),
            legend: legend(game),
            kind: GameKind::of(&Analysis::of(game)),
            form: GameForm::of(game).digest(),
            game: game.clone(),
        }
    }

    pub(super) fn of_twin(twin: TwinGame) -> Result<ExportedGame<'a>, TwinError> {
        let game = Game::from_source(&twin.text).map_err(TwinError::Game)?;
        let level = |(number, (text, witness)): (usize, (String, Option<Episode>))| {
            let level = game.level(&text).map_err(|problems| TwinError::Level { number, problems })?;
            Ok(ReleasedLevel { text, level, witness, second: None })
        };
        let levels = twin.levels.into_iter().zip(twin.witnesses).enumerate().map(level);
        let levels: Vec<ReleasedLevel> = levels.collect::<Result<_, TwinError>>()?;
        Ok(ExportedGame {
            title: twin.title,
            description: twin.description,
            goal: twin.goal,
            rules: engine::describe(&game),
            source: twin.text,
            levels: Cow::Owned(levels),
            legend: legend(&game),
            kind: GameKind::of(&Analysis::of(&game)),
            form: GameForm::of(&game).digest(),
            game,
        })
    }
}

/// Returns the names of the types placed by each character in the LevelMapping, sorted by character.
pub(super) fn legend(game: &Game) -> Vec<(char, String)> {
    let line = |symbol: u8| {
        let names: Vec<&str> = game.places(symbol).iter().map(|&stype| game.name(stype)).collect();
        (!names.is_empty()).then(|| (char::from(symbol), names.join(" ")))
    };
    (0..128).filter_map(line).collect()
}

/// The source of a row.
pub(super) struct Item<'a> {
    pub(super) manifest: &'a Manifest,
    pub(super) card: &'a Card,
    pub(super) exported: &'a ExportedGame<'a>,
    /// The level's number, from 0.
    pub(super) number: usize,
    /// The kind of twin (surface change) that is exported; `None` for the game itself.
    pub(super) twin: Option<Twin>,
}

impl Item<'_> {
    /// Returns the item's ID, unique among the items of all releases and their twins.
    pub(super) fn id(&self) -> String {
        let twin = self.twin.map(|twin| format!("+{twin}")).unwrap_or_default();
        format!("{}/{}/lvl{}{twin}", self.manifest.name, self.card.id, self.number)
    }

    pub(super) fn level(&self) -> &LevelCard {
        &self.card.levels[self.number]
    }

    pub(super) fn exported_level(&self) -> &ReleasedLevel {
        &self.exported.levels[self.number]
    }
}
