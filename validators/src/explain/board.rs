//! Boards drawn with characters, one per type, for reasons and reports.

use engine::{Game, SpriteType, State};
use serde::Serialize;
use std::collections::BTreeSet;

/// A state of a level, drawn as text.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Board {
    /// The rows from top to bottom, with one character per cell. Each character represents the topmost sprite in the
    /// cell.
    pub rows: Vec<String>,
    /// The type that each character on the board represents.
    pub legend: Vec<(char, String)>,
    /// The characters that do not represent their type in the LevelMapping.
    #[serde(skip)]
    stand_ins: Vec<char>,
}

impl Board {
    /// Draws a state as a player sees it. Cost: O(sprites + cells).
    pub fn of(game: &Game, state: &State) -> Board {
        let (symbols, own) = symbols(game);
        let seen = game.observe(state);
        let mut legend = BTreeSet::new();
        let symbol = |cell: &Vec<String>| {
            let name = cell.last()?;
            let (_, symbol) = symbols.iter().find(|(stype, _)| game.name(*stype) == name)?;
            legend.insert((*symbol, name.clone()));
            Some(*symbol)
        };
        let cells: Vec<char> = seen.cells.iter().map(symbol).map(|symbol| symbol.unwrap_or(' ')).collect();
        let rows = cells.chunks(seen.columns.max(1)).map(|row| row.iter().collect()).collect();
        let characters: BTreeSet<char> = legend.iter().map(|(symbol, _)| *symbol).collect();
        let stand_ins = characters.into_iter().filter(|symbol| !own.contains(symbol)).collect();
        Board { rows, legend: legend.into_iter().collect(), stand_ins }
    }

    /// Returns the legend as text: `A avatar, ~ water; not in the LevelMapping by itself: s shot`.
    pub fn key(&self) -> String {
        let (others, own): (Vec<_>, Vec<_>) =
            self.legend.iter().partition(|(symbol, _)| self.stand_ins.contains(symbol));
        let named = |list: &[&(char, String)]| {
            list.iter().map(|(symbol, name)| format!("{symbol} {name}")).collect::<Vec<_>>().join(", ")
        };
        match (&own[..], &others[..]) {
            (own, []) => named(own),
            ([], others) => format!("no character of the LevelMapping stands for: {}", named(others)),
            (own, others) => {
                format!("{}; no character of the LevelMapping stands for: {}", named(own), named(others))
            }
        }
    }
}

/// Characters for types that no level character places alone, in order of preference.
const SPARE: &str = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789@#$%&*+=?!";

/// The character for all types for which no other character is left.
const OTHER: char = '·';

/// Returns a character for every type with a class, and the subset of characters that come from the LevelMapping. A
/// type gets a character that places it on top. If there is none, it gets the first free letter of its name or, failing
/// that, the first free spare character.
fn symbols(game: &Game) -> (Vec<(SpriteType, char)>, BTreeSet<char>) {
    let mut free: BTreeSet<char> = ('!'..='~').collect();
    let mut symbols: Vec<(SpriteType, char)> = Vec::new();
    // The fewer sprites a character places, the better it represents the topmost one.
    let mut mapped: Vec<(usize, char, SpriteType)> = Vec::new();
    for symbol in '!'..='~' {
        let placed = game.places(symbol as u8);
        let top = placed.iter().max_by_key(|stype| drawn(game, **stype));
        mapped.extend(top.map(|&top| (placed.len(), symbol, top)));
    }
    mapped.sort_unstable();
    for (_, symbol, top) in mapped {
        if symbols.iter().all(|(stype, _)| *stype != top) {
            free.remove(&symbol);
            symbols.push((top, symbol));
        }
    }
    let own = symbols.iter().map(|(_, symbol)| *symbol).collect();
    for stype in game.sprite_types().filter(|&stype| game.class(stype).is_some()) {
        if symbols.iter().any(|(known, _)| *known == stype) {
            continue;
        }
        let wanted = game.name(stype).chars().chain(SPARE.chars()).find(|symbol| free.contains(symbol));
        let symbol = wanted.unwrap_or(OTHER);
        free.remove(&symbol);
        symbols.push((stype, symbol));
    }
    (symbols, own)
}

/// Returns a type's position in the drawing order.
pub(crate) fn drawn(game: &Game, stype: SpriteType) -> usize {
    game.drawing_order().iter().position(|&other| other == stype.0).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::Seed;

    #[test]
    fn sprites_on_top_are_shown_each_by_its_own_character() {
        let source = "BasicGame\n  SpriteSet\n    floor > Immovable hidden=True\n    moss > Immovable\n    plum > Immovable\n    pip > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    . > floor\n    p > floor moss plum\n    m > moss\n    A > floor avatar\n  InteractionSet\n    plum avatar > killSprite\n  TerminationSet\n    SpriteCounter stype=plum win=True\n";
        let game = Game::from_source(source).unwrap();
        let state = game.start(&game.level(".Ap\nmm.\n").unwrap(), Seed::from_text("board"));
        let board = Board::of(&game, &state);
        assert_eq!(board.rows, [" Ap", "mm "]);
        let legend = [('A', "avatar"), ('m', "moss"), ('p', "plum")];
        assert_eq!(board.legend, legend.map(|(symbol, name)| (symbol, name.to_owned())));
    }
}
