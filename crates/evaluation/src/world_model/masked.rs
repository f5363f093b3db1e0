//! Games with masked names and masked level characters.

use crate::error::EvaluationError;
use crate::mask::Mask;
use crate::subject::Subject;
use base::Seed;
use engine::syntax::{MappingLine, print_bare};
use engine::{Game, Level};
use std::collections::{BTreeMap, BTreeSet};

/// The characters of masked levels. The characters `w` and `A` are excluded, because they have default meanings.
const CHARACTERS: &str = "abcdefghijklmnopqrstuvxyzBCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";

/// The maximum number of levels in a masked game. More levels would make prompts longer without showing new rules.
const MAX_LEVELS: usize = 3;

/// A game whose names and level characters are meaningless. It behaves like the original game.
#[derive(Clone, Debug)]
pub(super) struct MaskedGame {
    /// The source text of the masked game, which is the perfect answer.
    pub(super) source: String,
    pub(super) game: Game,
    /// The lines of the LevelMapping for the characters in the levels, sorted by character.
    pub(super) mapping: Vec<String>,
    /// The deterministic levels, of which there are at most [`MAX_LEVELS`].
    pub(super) levels: Vec<MaskedLevel>,
}

/// A level written with masked characters.
#[derive(Clone, Debug)]
pub(super) struct MaskedLevel {
    pub(super) number: usize,
    pub(super) text: String,
    pub(super) level: Level,
}

impl MaskedGame {
    /// Masks a game and its deterministic levels.
    ///
    /// # Errors
    /// Returns an error if no level is deterministic, or if the game has faults that only the reference tolerates.
    pub(super) fn of(subject: &Subject) -> Result<MaskedGame, EvaluationError> {
        let wrong = |what: &str| EvaluationError::Malformed(format!("`{}` {what}", subject.id));
        let is_exact = |level: &&crate::SubjectLevel| subject.analysis.is_deterministic_in(&level.level);
        let levels: Vec<_> = subject.levels.iter().filter(is_exact).take(MAX_LEVELS).collect();
        if levels.is_empty() {
            return Err(wrong(
                "has no deterministic level, so its transitions cannot be reproduced; choose another game",
            ));
        }
        let used: BTreeSet<char> = levels.iter().flat_map(|level| level.text.chars()).collect();
        let mut description = Mask::of(&subject.game)?.game.description().clone();
        for (symbol, name) in [('w', "wall"), ('A', "avatar")] {
            if !description.mapping.iter().any(|line| line.symbol == symbol) {
                description.mapping.push(MappingLine {
                    symbol,
                    names: vec![name.into()],
                    ..MappingLine::default()
                });
            }
        }
        description.has = [true; 4];
        description.mapping.retain(|line| used.contains(&line.symbol));
        let symbols = symbols(&description.mapping, Mask::neutral_characters(&subject.game));
        description.mapping.iter_mut().for_each(|line| line.symbol = symbols[&line.symbol]);
        description.mapping.sort_by_key(|line| line.symbol);
        let names =
            |line: &MappingLine| line.names.iter().map(|name| format!(" {}", name.text)).collect::<String>();
        let mapping =
            description.mapping.iter().map(|line| format!("{} >{}", line.symbol, names(line))).collect();
        let source = print_bare(&description);
        let game = Game::from_source(&source).map_err(|problems| {
            wrong(&format!("has faults that only the reference tolerates: {problems}"))
        })?;
        let mask = |level: &crate::SubjectLevel| {
            let text: String = level.text.chars().map(|own| *symbols.get(&own).unwrap_or(&own)).collect();
            let read = game
                .level(&text)
                .map_err(|problems| wrong(&format!("has an unreadable level: {problems}")))?;
            Ok(MaskedLevel { number: level.number, text, level: read })
        };
        let levels = levels.into_iter().map(mask).collect::<Result<_, EvaluationError>>()?;
        Ok(MaskedGame { source, game, mapping, levels })
    }
}

/// Returns a masked character, drawn at random, for each level character.
fn symbols(mapping: &[MappingLine], number: u64) -> BTreeMap<char, char> {
    let mut pool: Vec<char> = CHARACTERS.chars().collect();
    Seed::from_text("world model").child("characters", number).sampler().shuffle(&mut pool);
    let own: BTreeSet<char> = mapping.iter().map(|line| line.symbol).collect();
    let spare = ('\u{C0}'..=char::MAX).filter(|symbol| symbol.is_alphabetic());
    own.into_iter().zip(pool.into_iter().chain(spare)).collect()
}
