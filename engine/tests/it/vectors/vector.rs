//! A board with cells of 10 pixels and a few sprites, played tick by tick.

use engine::{Action, Chance, Game, Rect, SpriteRecord, State};

/// The number of columns and rows of the board.
const BOARD: (usize, usize) = (30, 8);

/// A game under test and its state.
pub(crate) struct Vector {
    pub(crate) game: Game,
    pub(crate) state: State,
}

impl Vector {
    /// Starts a game. `sprites` are lines of the SpriteSet, including the avatar's line. `placed` gives
    /// sprite types and their positions in pixels.
    pub(crate) fn new(sprites: &str, rules: &str, placed: &[(&str, i32, i32)], seed: i64) -> Vector {
        let source = source("square_size=10", sprites, rules, placed);
        let game = Game::from_source(&source).unwrap_or_else(|problems| panic!("{problems}\n{source}"));
        Vector::of_game(game, placed, seed)
    }

    /// Does the same as [`Vector::new`], for a game that only loads in reference mode.
    pub(crate) fn as_reference(sprites: &str, rules: &str, placed: &[(&str, i32, i32)], seed: i64) -> Vector {
        let source = source("square_size=10", sprites, rules, placed);
        assert!(Game::from_source(&source).is_err(), "strict loading must refuse this:\n{source}");
        let game = Game::from_source_as_reference(&source).unwrap_or_else(|problems| panic!("{problems}"));
        Vector::of_game(game, placed, seed)
    }

    /// Does the same as [`Vector::new`], with a given header, and in strict or reference mode. Positions are
    /// still multiples of ten.
    pub(crate) fn headed(
        header: &str,
        sprites: &str,
        rules: &str,
        placed: &[(&str, i32, i32)],
        seed: i64,
    ) -> Vector {
        let source = source(header, sprites, rules, placed);
        let game = Game::from_source_as_reference(&source).unwrap_or_else(|problems| panic!("{problems}"));
        Vector::of_game(game, placed, seed)
    }

    fn of_game(game: Game, placed: &[(&str, i32, i32)], seed: i64) -> Vector {
        let mut board = vec![vec![b' '; BOARD.0]; BOARD.1];
        for (name, x, y) in placed {
            board[(y / 10) as usize][(x / 10) as usize] = symbol(placed, name) as u8;
        }
        let text: String = board.iter().map(|row| String::from_utf8_lossy(row) + "\n").collect();
        let level = game.level(&text).unwrap_or_else(|problems| panic!("{problems}\n{text}"));
        let state = game.start_with(&level, Chance::from_java(seed));
        Vector { game, state }
    }

    pub(crate) fn step(&mut self, action: Action) {
        self.game.step(&mut self.state, action);
        assert_eq!(self.state.state_hash(), self.state.state_hash_from_scratch());
    }

    /// Plays one tick per key: `U`, `L`, `D`, `R`, `X` to use, and `.` for no key.
    pub(crate) fn play(&mut self, keys: &str) {
        actions(keys).for_each(|action| self.step(action));
    }

    /// Returns the position of a sprite after each key.
    pub(crate) fn places(&mut self, name: &str, keys: &str) -> Vec<(i32, i32)> {
        let place = |action| {
            self.step(action);
            self.place(name)
        };
        actions(keys).map(place).collect()
    }

    /// Returns the sprites of a type, in order of creation.
    pub(crate) fn all(&self, name: &str) -> Vec<SpriteRecord> {
        let stype = self.game.sprite_type(name).unwrap().0;
        self.game.records(&self.state).into_iter().filter(|record| record.stype == stype).collect()
    }

    /// Returns the positions of the sprites of a type.
    pub(crate) fn spots(&self, name: &str) -> Vec<(i32, i32)> {
        self.all(name).iter().map(|record| corner(record.rect)).collect()
    }

    /// Returns the only sprite of its type.
    pub(crate) fn one(&self, name: &str) -> SpriteRecord {
        let all = self.all(name);
        assert_eq!(all.len(), 1, "{name} at tick {}", self.state.tick());
        all[0].clone()
    }

    pub(crate) fn place(&self, name: &str) -> (i32, i32) {
        corner(self.one(name).rect)
    }
}

fn corner(rect: Rect) -> (i32, i32) {
    (rect.x, rect.y)
}

pub(crate) fn actions(keys: &str) -> impl Iterator<Item = Action> + '_ {
    keys.chars().map(|key| match key {
        'U' => Action::Up,
        'L' => Action::Left,
        'D' => Action::Down,
        'R' => Action::Right,
        'X' => Action::Use,
        _ => Action::Nil,
    })
}

/// Returns the level character of a sprite type: a letter, in the order of the names.
fn symbol(placed: &[(&str, i32, i32)], name: &str) -> char {
    let mut names: Vec<&str> = placed.iter().map(|(name, ..)| *name).collect();
    names.sort_unstable();
    names.dedup();
    char::from(b'a' + names.iter().position(|other| *other == name).unwrap() as u8)
}

fn source(header: &str, sprites: &str, rules: &str, placed: &[(&str, i32, i32)]) -> String {
    let mut mapping: Vec<String> =
        placed.iter().map(|(name, ..)| format!("    {} > {name}\n", symbol(placed, name))).collect();
    mapping.sort_unstable();
    mapping.dedup();
    let mapping = mapping.concat();
    let indented = |text: &str| -> String { text.lines().map(|line| format!("    {line}\n")).collect() };
    let (sprites, rules) = (indented(sprites), indented(rules));
    format!(
        "BasicGame {header}\n  SpriteSet\n{sprites}  LevelMapping\n{mapping}  InteractionSet\n    avatar wall > stepBack\n{rules}  TerminationSet\n    Timeout limit=500 win=False\n"
    )
}
