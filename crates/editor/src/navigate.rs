//! Navigation between positions that refer to the same symbol.

use crate::words::{BUILT_IN, Role, Word, Words};
use engine::Span;

/// A symbol in a game to which several positions can refer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Subject<'a> {
    /// A sprite type.
    Sprite(&'a str),
    /// A level character.
    Symbol(&'a str),
    /// A parameter of a `GameSpace`.
    Parameter(&'a str),
}

impl<'a> Subject<'a> {
    /// Returns the symbol to which a word refers; `None` if the word is not a symbol.
    pub(crate) fn of(word: &Word<'a>) -> Option<Subject<'a>> {
        match word.role {
            Role::Declaration | Role::Sprite => Some(Subject::Sprite(word.text)),
            Role::Symbol => Some(Subject::Symbol(word.text)),
            Role::Parameter | Role::ParameterUse => Some(Subject::Parameter(word.text)),
            _ => None,
        }
    }

    /// Returns the words that refer to the symbol, in the order of the text.
    pub(crate) fn places<'b>(self, words: &'b Words<'a>) -> impl Iterator<Item = &'b Word<'a>> {
        words.all().filter(move |word| Subject::of(word) == Some(self))
    }
}

/// Returns the position where the sprite type, level character or `GameSpace` parameter at byte `at` is declared;
/// `None` if there is no declaration.
pub fn definition(source: &str, at: usize) -> Option<Span> {
    let words = Words::of(source);
    let subject = Subject::of(words.at(at)?)?;
    let declares = |word: &&Word<'_>| matches!(word.role, Role::Declaration | Role::Symbol | Role::Parameter);
    subject.places(&words).find(declares).map(|word| word.span)
}

/// Returns the position in a game where the character at byte `at` of a level is declared; `None` if it is not
/// declared.
pub fn level_definition(source: &str, level: &str, at: usize) -> Option<Span> {
    let (_, symbol) = symbol_at(level, at)?;
    let words = Words::of(source);
    Subject::Symbol(symbol).places(&words).next().map(|word| word.span)
}

/// Returns the character that starts at byte `at` in a level, with its span. Returns `None` for spaces and line ends.
pub(crate) fn symbol_at(level: &str, at: usize) -> Option<(Span, &str)> {
    let symbol = level.get(at..)?.chars().next().filter(|c| !c.is_whitespace())?;
    let span = Span::new(at, at + symbol.len_utf8());
    Some((span, &level[span.start..span.end]))
}

/// Returns, in the order of the text, the positions of all references to the symbol at byte `at`, including its
/// declaration.
pub fn references(source: &str, at: usize) -> Vec<Span> {
    let words = Words::of(source);
    let Some(subject) = words.at(at).and_then(Subject::of) else { return Vec::new() };
    if let Subject::Sprite(name) = subject {
        let is_known = words.sprite(name).is_some() || BUILT_IN.iter().any(|(known, _)| *known == name);
        if !is_known {
            return Vec::new();
        }
    }
    subject.places(&words).map(|word| word.span).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const GAME: &str = "BasicGame\n SpriteSet\n  fox > Missile\n  den > SpawnPoint stype=fox\n LevelMapping\n  f > fox den\n InteractionSet\n  fox wall > stepBack\n TerminationSet\n  SpriteCounter stype=fox limit=N\n";

    #[test]
    fn sprites_are_found_everywhere() {
        let at = GAME.find("stype=fox").unwrap() + 7;
        let declared = GAME.find("fox >").unwrap();
        assert_eq!(definition(GAME, at), Some(Span::new(declared, declared + 3)));
        let places = references(GAME, at);
        assert_eq!(places.len(), GAME.matches("fox").count());
        assert!(places.iter().all(|span| &GAME[span.start..span.end] == "fox"));
        assert_eq!(references(GAME, GAME.find("wall").unwrap()).len(), 1);
        assert_eq!(definition(GAME, GAME.find("wall").unwrap()), None);
        assert_eq!(references(GAME, GAME.find("Missile").unwrap()), []);
        assert_eq!(definition(GAME, GAME.len() + 9), None);
    }

    #[test]
    fn characters_of_levels_are_found_in_the_game() {
        assert_eq!(level_definition(GAME, "w f\n", 2).map(|span| span.start), GAME.find("f > fox"));
        assert_eq!(level_definition(GAME, "w f\n", 1), None);
        assert_eq!(level_definition(GAME, "w f\n", 99), None);
    }

    #[test]
    fn parameters_of_a_space_are_found() {
        let space = GAME.replace("BasicGame\n", "GameSpace\n ParameterSet\n  N > values=1:1:5 value=2\n");
        let at = space.find("limit=N").unwrap() + 6;
        assert_eq!(definition(&space, at).map(|span| span.start), space.find("N >"));
        assert_eq!(references(&space, at).len(), 2);
    }
}
