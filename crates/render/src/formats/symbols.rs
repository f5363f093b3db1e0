//! The characters that represent a game's sprite types on boards in text form. They are ASCII as long as there are
//! unused ASCII characters.

use crate::looks::glyph::Glyph;
use crate::looks::look::Looks;
use engine::{Analysis, SpriteType};

/// The characters for a game's sprite types. The same game always yields the same characters.
#[derive(Clone, Debug)]
pub struct Symbols(Vec<char>);

/// The character of an empty cell, or of a cell that contains only floor.
pub const EMPTY: char = '.';

/// The spare characters, for types whose level character and name letters are all taken. If these run out, letters
/// from other alphabets follow, so that no two types ever share a character.
const SPARE: &str =
    "+*%&$=~^?!:;|/ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789@<>()[]{}-_,`'\"\\";

impl Symbols {
    /// Chooses a character for each type. It is the first character in this list that is still available:
    ///
    /// 1. The level character that places the type on top of floor alone.
    /// 2. A letter in the type's name.
    /// 3. Any character.
    ///
    /// Types invisible to players, and floors without rules, get [`EMPTY`].
    pub fn of(analysis: &Analysis, looks: &Looks) -> Symbols {
        let game = analysis.game();
        let is_floor = |stype: SpriteType| {
            let scenery = || looks.look(stype).glyph == Glyph::Floor && analysis.is_scenery(stype);
            !looks.is_visible(stype) || scenery()
        };
        let mut symbols = vec![EMPTY; game.sprite_types().count()];
        let mut taken = vec![EMPTY, ' ', '#'];
        let shown: Vec<SpriteType> = looks.shown().filter(|&stype| !is_floor(stype)).collect();
        let mut left = Vec::new();
        for stype in shown {
            let alone = |symbol: &&u8| {
                let mut others = game.places(**symbol).iter().filter(|&&other| !is_floor(other));
                others.next() == Some(&stype) && others.next().is_none()
            };
            let own = analysis.facts(stype).symbols.iter().find(alone).map(|&symbol| char::from(symbol));
            match own.filter(|symbol| symbol.is_ascii_graphic() && !taken.contains(symbol)) {
                Some(symbol) => {
                    taken.push(symbol);
                    symbols[stype.index()] = symbol;
                }
                None => left.push(stype),
            }
        }
        for stype in left {
            let name = game.name(stype);
            let letters = name.chars().chain(name.chars().map(|letter| letter.to_ascii_uppercase()));
            let known = letters.chain(SPARE.chars()).filter(char::is_ascii_graphic);
            let others = ('\u{C0}'..=char::MAX).filter(|c| c.is_alphabetic());
            let symbol = known.chain(others).find(|c| !taken.contains(c)).expect("types are far fewer");
            taken.push(symbol);
            symbols[stype.index()] = symbol;
        }
        Symbols(symbols)
    }

    /// Returns a type's character.
    pub fn symbol(&self, stype: SpriteType) -> char {
        self.0[stype.index()]
    }
}
