//! Renaming of sprite types and level characters.

use crate::navigate::Subject;
use crate::words::{BUILT_IN, EDGES, SECTIONS, Words};
use engine::limits::MAX_NAME;
use engine::{Diagnostics, EFFECTS, Edit, Game, Span, SpriteClass, TERMINATIONS};
use std::fmt;

/// The characters that place `wall` and `avatar` in levels of games that do not map these characters.
const BUILT_IN_SYMBOLS: [&str; 2] = ["w", "A"];

/// The reason for rejecting a new name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RenameError {
    /// The position contains neither a sprite type nor a level character.
    Nothing,
    /// The old or new name has a built-in meaning.
    BuiltIn(String),
    /// The new name is a VGDL keyword.
    Keyword(String),
    /// A different type or character already has the new name.
    Taken(String),
    /// The new name would not parse as a name.
    Illegal(String),
}

impl fmt::Display for RenameError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RenameError::Nothing => f.write_str("only sprite types and level characters can be renamed"),
            RenameError::BuiltIn(name) => {
                write!(f, "`{name}` is reserved by the engine, so it cannot be renamed or used as a new name")
            }
            RenameError::Keyword(name) => write!(f, "`{name}` is a word of VGDL; choose another name"),
            RenameError::Taken(name) => write!(f, "`{name}` is already taken; choose another name"),
            RenameError::Illegal(name) => {
                let name = name.escape_debug();
                write!(
                    f,
                    "`{name}` isn't a valid name; use letters, such as `red_fox`, or a single character for \
                     a level character"
                )
            }
        }
    }
}

impl std::error::Error for RenameError {}

/// Returns the span of the name at byte `at`, provided that the name can be changed.
///
/// # Errors
///
/// Returns [`RenameError::Nothing`] or [`RenameError::BuiltIn`].
pub fn renamable(source: &str, at: usize) -> Result<Span, RenameError> {
    let words = Words::of(source);
    let word = words.at(at).ok_or(RenameError::Nothing)?;
    match Subject::of(word).ok_or(RenameError::Nothing)? {
        Subject::Sprite(name) if is_built_in(name) => Err(RenameError::BuiltIn(name.to_owned())),
        Subject::Parameter(_) => Err(RenameError::Nothing),
        Subject::Sprite(_) | Subject::Symbol(_) => Ok(word.span),
    }
}

/// Returns the edits that rename the sprite type or level character at byte `at` everywhere in the game. If a
/// character is renamed, the levels must be changed accordingly: see [`rename_in_level`].
///
/// # Errors
///
/// Returns a [`RenameError`] if the renaming is not possible.
pub fn rename(source: &str, at: usize, name: &str) -> Result<Vec<Edit>, RenameError> {
    renamable(source, at)?;
    let words = Words::of(source);
    let subject = words.at(at).and_then(Subject::of).ok_or(RenameError::Nothing)?;
    match subject {
        Subject::Sprite(old) => {
            let taken = || words.all().any(|word| Subject::of(word) == Some(Subject::Sprite(name)));
            if is_built_in(name) {
                return Err(RenameError::BuiltIn(name.to_owned()));
            } else if is_keyword(name) {
                return Err(RenameError::Keyword(name.to_owned()));
            } else if name != old && taken() {
                return Err(RenameError::Taken(name.to_owned()));
            } else if !is_name(name) {
                return Err(RenameError::Illegal(name.to_owned()));
            }
        }
        Subject::Symbol(old) => {
            let taken = || words.mapping().any(|(symbol, _)| symbol.text == name);
            if name != old && (taken() || BUILT_IN_SYMBOLS.contains(&name)) {
                return Err(RenameError::Taken(name.to_owned()));
            } else if !is_symbol(name) {
                return Err(RenameError::Illegal(name.to_owned()));
            }
        }
        Subject::Parameter(_) => return Err(RenameError::Nothing),
    }
    Ok(subject.places(&words).map(|word| Edit::new(word.span, name)).collect())
}

/// Returns the edits that rename a level character in a level's text.
pub fn rename_in_level(level: &str, old: char, new: char) -> Vec<Edit> {
    let places = level.char_indices().filter(|&(_, c)| c == old);
    places.map(|(at, c)| Edit::new(Span::new(at, at + c.len_utf8()), new)).collect()
}

fn is_built_in(name: &str) -> bool {
    BUILT_IN.iter().any(|(known, _)| *known == name)
}

fn is_keyword(name: &str) -> bool {
    SpriteClass::from_name(name).is_some()
        || EFFECTS.contains(&name)
        || TERMINATIONS.contains(&name)
        || SECTIONS.iter().any(|section| section.name() == name)
        || ["BasicGame", "GameSpace"].contains(&name)
        || EDGES.iter().any(|edge| edge.eq_ignore_ascii_case(name))
}

/// Returns `true` if the engine allows a sprite type with the given name to be declared, placed, used in
/// interactions, listed and counted.
fn is_name(name: &str) -> bool {
    if name.is_empty()
        || name.len() > MAX_NAME
        || name.contains(|c: char| c.is_whitespace() || ",=#>".contains(c))
    {
        return false;
    }
    let source = format!(
        "BasicGame\n SpriteSet\n  {name} > Immovable\n  o > SpawnPointMultiSprite stypes={name},{name}\n LevelMapping\n  o > {name} o\n InteractionSet\n  {name} o > transformTo stype={name}\n TerminationSet\n  SpriteCounter stype={name} win=True\n"
    );
    is_sound(&source, |words| words.sprites.first().is_some_and(|sprite| sprite.name == name))
}

/// Returns `true` if the engine allows the given level character to be declared.
fn is_symbol(symbol: &str) -> bool {
    if !(symbol.len() == 1 && symbol.bytes().all(|byte| byte.is_ascii_graphic())) {
        return false;
    }
    let source = format!(
        "BasicGame\n SpriteSet\n  o > Immovable\n LevelMapping\n  {symbol} > o\n InteractionSet\n TerminationSet\n  Timeout limit=5\n"
    );
    is_sound(&source, |words| words.mapping().next().is_some_and(|(word, _)| word.text == symbol))
}

fn is_sound(source: &str, reads: impl Fn(&Words<'_>) -> bool) -> bool {
    let found = Game::from_source(source).map_or_else(|problems| problems.0, |_| Vec::new());
    !Diagnostics::has_errors(&found) && reads(&Words::of(source))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problems::applied;

    const GAME: &str = "BasicGame obs=fox\n SpriteSet\n  fox > Missile # a fox\n  o > SpawnPoint stype=fox\n LevelMapping\n  f > fox o\n  g > o\n InteractionSet\n  fox wall > addTimer ftype=killAll stype=fox\n TerminationSet\n  MultiSpriteCounter stype1=o stype2=fox\n";

    fn renamed(of: &str, name: &str) -> Result<String, RenameError> {
        rename(GAME, GAME.find(of).unwrap(), name).map(|edits| applied(GAME, &edits))
    }

    #[test]
    fn a_type_is_renamed_wherever_it_is_named() {
        let expect = GAME.replace("fox", "wolf").replace("a wolf", "a fox");
        assert_eq!(renamed("fox >", "wolf").as_ref(), Ok(&expect));
        assert_eq!(renamed("fox wall", "wolf"), Ok(expect));
        assert_eq!(renamed("f > fox", "x"), Ok(GAME.replace("f > fox", "x > fox")));
        assert_eq!(applied("fa\nf", &rename_in_level("fa\nf", 'f', 'x')), "xa\nx");
    }

    #[test]
    fn names_that_mean_something_else_are_refused() {
        let check = |name: &str, error: fn(String) -> RenameError| {
            assert_eq!(renamed("fox >", name), Err(error(name.to_owned())), "{name}");
        };
        check("killAll", RenameError::Keyword);
        check("Missile", RenameError::Keyword);
        check("eos", RenameError::Keyword);
        check("SpriteSet", RenameError::Keyword);
        check("o", RenameError::Taken);
        check("wall", RenameError::BuiltIn);
        for name in ["", "a b", "a=b", "a,b", "#", ">", "3", "True", "RED", "UP", "//x", "a\n"] {
            check(name, RenameError::Illegal);
        }
        assert_eq!(renamed("wall", "x"), Err(RenameError::BuiltIn("wall".to_owned())));
        assert_eq!(renamed("killAll", "x"), Err(RenameError::Nothing));
        for (name, taken) in
            [("g", true), ("A", true), ("#", false), ("", false), ("é", false), ("ab", false)]
        {
            let refused = renamed("f > fox", name).unwrap_err();
            assert_eq!(matches!(refused, RenameError::Taken(_)), taken, "{name}");
        }
    }
}
