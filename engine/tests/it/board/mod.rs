//! Small games for test vectors: sprites at given pixels of a board with cells of 10 pixels, loaded in reference mode.

use engine::{Action, Chance, Game, Outcome, SpriteRecord, State};

/// The size of a cell in pixels.
const BLOCK: i32 = 10;

/// The lines of a game, and the size of its board.
pub(crate) struct Setup<'a> {
    header: &'a str,
    sprites: &'a str,
    rules: &'a str,
    ends: &'a str,
    columns: usize,
    rows: usize,
    seed: i64,
}

/// A game in progress.
pub(crate) struct Board {
    pub(crate) game: Game,
    pub(crate) state: State,
}

/// Returns a game with these sprites and interactions, one per line, on a board of 12 by 6 cells.
pub(crate) fn setup<'a>(sprites: &'a str, rules: &'a str) -> Setup<'a> {
    let (header, ends) = ("", "Timeout limit=500 win=True");
    Setup { header, sprites, rules, ends, columns: 12, rows: 6, seed: 1 }
}

impl<'a> Setup<'a> {
    /// Sets the parameters of the first line.
    pub(crate) fn header(self, header: &'a str) -> Setup<'a> {
        Setup { header, ..self }
    }

    /// Sets the terminations.
    pub(crate) fn ends(self, ends: &'a str) -> Setup<'a> {
        Setup { ends, ..self }
    }

    pub(crate) fn size(self, columns: usize, rows: usize) -> Setup<'a> {
        Setup { columns, rows, ..self }
    }

    /// Returns the game file, and the level that places the sprites given by name and pixels.
    pub(crate) fn texts(&self, placed: &[(&str, i32, i32)]) -> (String, String) {
        let mut cells: Vec<((i32, i32), Vec<&str>)> = Vec::new();
        for &(name, x, y) in placed {
            let place = (x / BLOCK, y / BLOCK);
            match cells.iter_mut().find(|(known, _)| *known == place) {
                Some((_, names)) => names.push(name),
                None => cells.push((place, vec![name])),
            }
        }
        let mut level = vec![vec![b' '; self.columns]; self.rows];
        let mut mapping = String::new();
        for (((column, row), names), symbol) in cells.iter().zip(b'a'..) {
            level[*row as usize][*column as usize] = symbol;
            mapping += &format!("    {} > {}\n", char::from(symbol), names.join(" "));
        }
        let lines = |text: &str| text.lines().map(|line| format!("    {line}\n")).collect::<String>();
        let source = format!(
            "BasicGame square_size=10 {}\n  SpriteSet\n{}  LevelMapping\n{mapping}  InteractionSet\n{}  TerminationSet\n{}",
            self.header,
            lines(self.sprites),
            lines(self.rules),
            lines(self.ends)
        );
        let level = level.iter().map(|row| String::from_utf8_lossy(row) + "\n").collect();
        (source, level)
    }

    #[track_caller]
    pub(crate) fn place(self, placed: &[(&str, i32, i32)]) -> Board {
        let (source, level) = self.texts(placed);
        let game = Game::from_source_as_reference(&source);
        let game = game.unwrap_or_else(|problems| panic!("{problems}\n{source}"));
        let level = game.level(&level).unwrap_or_else(|problems| panic!("{problems}\n{level}"));
        let state = game.start_with(&level, Chance::from_java(self.seed));
        Board { game, state }
    }

    /// Returns the codes of the problems that strict loading finds in the file.
    pub(crate) fn problems(&self, placed: &[(&str, i32, i32)]) -> Vec<&'static str> {
        let problems = Game::from_source(&self.texts(placed).0).err();
        problems.map_or(Vec::new(), |all| all.0.iter().map(|problem| problem.code).collect())
    }
}

impl Board {
    /// Plays one tick per key: `U`, `L`, `D`, `R`, `X` for use, and any other character for no action.
    pub(crate) fn play(&mut self, keys: &str) -> &mut Board {
        for key in keys.chars() {
            let action = match key {
                'U' => Action::Up,
                'L' => Action::Left,
                'D' => Action::Down,
                'R' => Action::Right,
                'X' => Action::Use,
                _ => Action::Nil,
            };
            self.game.step(&mut self.state, action);
        }
        let hash = self.state.state_hash_from_scratch();
        assert_eq!(self.state.state_hash(), hash, "the running hash");
        self
    }

    /// Plays one tick without an action.
    pub(crate) fn wait(&mut self) -> &mut Board {
        self.play(".")
    }

    /// Returns the sprites of a type, in order of creation.
    pub(crate) fn all(&self, name: &str) -> Vec<SpriteRecord> {
        let stype = self.game.sprite_type(name).unwrap_or_else(|| panic!("no type `{name}`")).0;
        self.game.records(&self.state).into_iter().filter(|record| record.stype == stype).collect()
    }

    pub(crate) fn count(&self, name: &str) -> usize {
        self.all(name).len()
    }

    /// Returns the only sprite of a type.
    #[track_caller]
    pub(crate) fn one(&self, name: &str) -> SpriteRecord {
        let all = self.all(name);
        assert_eq!(all.len(), 1, "`{name}` at tick {}", self.state.tick());
        all[0].clone()
    }

    #[track_caller]
    pub(crate) fn at(&self, name: &str) -> (i32, i32) {
        let rect = self.one(name).rect;
        (rect.x, rect.y)
    }

    /// Returns the creation numbers of the sprites of a type.
    pub(crate) fn ids(&self, name: &str) -> Vec<u32> {
        self.all(name).iter().map(|record| record.id).collect()
    }

    /// Returns the resources that the avatar holds.
    pub(crate) fn held(&self) -> Vec<(String, i32)> {
        self.game.held_by_avatar(&self.state)
    }

    pub(crate) fn score(&self) -> i32 {
        self.state.score() as i32
    }

    pub(crate) fn messages(&self) -> u32 {
        self.state.messages()
    }

    /// Returns `true` if the reference would have crashed.
    pub(crate) fn died(&self) -> bool {
        matches!(self.state.outcome(), Outcome::Stopped(_))
    }

    /// Returns the number of raw draws since the seed, up to a maximum.
    pub(crate) fn draws(&self, seed: i64) -> usize {
        let mut chance = Chance::from_java(seed);
        let drawn = (0..1000).position(|_| {
            let found = chance.state() == self.state.chance().state();
            chance.float();
            found
        });
        drawn.expect("the chance is not that far")
    }
}
