//! A level: a grid of characters, checked against one game's LevelMapping (`spec/01` §2).

use crate::Digest;
use crate::diagnostic::{Diagnostic, Diagnostics, Span};
use crate::game::{Game, SpriteType};
use crate::limits::{MAX_ATTEMPTS, MAX_CELLS, MAX_LEVEL_TEXT, MAX_SIDE, MAX_SPRITES};
use crate::syntax::BYTE_ORDER_MARK;
use std::collections::BTreeSet;
use std::fmt;

/// Problems of one kind that are reported one by one.
const MAX_REPEATS: usize = 10;

/// In levels that are loaded as the reference does: a character without a mapping.
const UNMAPPED: u8 = 0;

/// A level that fits one game: row-major characters, every one in the game's LevelMapping or a blank.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Level {
    columns: usize,
    rows: usize,
    cells: Vec<u8>,
    warnings: Vec<Diagnostic>,
    /// Messages that the reference logs when it builds the level.
    pub(crate) messages: u32,
}

impl Level {
    /// Columns of the board.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Rows of the board.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The characters, row-major, ASCII.
    pub fn cells(&self) -> &[u8] {
        &self.cells
    }

    /// What is legal but surely not meant.
    pub fn warnings(&self) -> &[Diagnostic] {
        &self.warnings
    }

    /// BLAKE3 of the canonical text: rows of equal length, each with a newline.
    pub fn digest(&self) -> Digest {
        Digest::of(self.to_string().as_bytes())
    }
}

impl fmt::Display for Level {
    /// The canonical text.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.cells.chunks(self.columns).try_for_each(|row| {
            row.iter().try_for_each(|&symbol| write!(f, "{}", char::from(symbol)))?;
            writeln!(f)
        })
    }
}

impl Game {
    /// What a level character places, in order; empty for blanks and characters without a mapping.
    pub fn places(&self, symbol: u8) -> &[SpriteType] {
        self.0.mapping.get(usize::from(symbol)).map_or(&[], |types| types)
    }

    /// Checks a level's text against this game.
    ///
    /// # Errors
    /// All problems of the text, sorted by place: characters without a mapping, no avatar or several, a size beyond
    /// [`MAX_SIDE`], [`MAX_CELLS`] or [`MAX_SPRITES`].
    pub fn level(&self, text: &str) -> Result<Level, Diagnostics> {
        let everything = Span::new(0, 0);
        let fail = |problem| Err(Diagnostics(vec![problem]));
        if text.len() > MAX_LEVEL_TEXT {
            let message =
                format!("the level is {} bytes long; at most {MAX_LEVEL_TEXT} are read", text.len());
            return fail(
                Diagnostic::error("too-large", everything, message)
                    .help("split it, or is this a level file?"),
            );
        }
        let lines = level_lines(text);
        let columns = lines.first().map_or(0, |(_, line)| line.chars().count());
        let rows = lines.len();
        if columns == 0 {
            let message = "the level's first line is empty; its length is the width of the level";
            return fail(
                Diagnostic::error("empty-level", everything, message).help("a level is rows of characters"),
            );
        }
        if columns > MAX_SIDE || rows > MAX_SIDE || columns * rows > MAX_CELLS {
            let message = format!(
                "the level has {columns} columns and {rows} rows; the limits are {MAX_SIDE} a side and {MAX_CELLS} cells"
            );
            return fail(
                Diagnostic::error("too-large", everything, message).help("make it smaller, or split it"),
            );
        }
        let mut reader = LevelReader {
            game: self,
            mapped: self.0.description.mapping.iter().map(|line| line.symbol).collect(),
            problems: Vec::new(),
            avatars: Vec::new(),
            sprites: 0,
            undefined: Vec::new(),
        };
        let mut cells = Vec::with_capacity(columns * rows);
        for (start, line) in &lines {
            reader.row(*start, line, columns, &mut cells);
        }
        reader.finish(text, columns, rows, cells)
    }
}

struct LevelReader<'a> {
    game: &'a Game,
    /// The characters that the LevelMapping has a line for.
    mapped: BTreeSet<char>,
    problems: Vec<Diagnostic>,
    avatars: Vec<Span>,
    sprites: usize,
    /// Characters without a mapping: the cell, the character, its place in the text.
    undefined: Vec<(usize, char, Span)>,
}

impl LevelReader<'_> {
    fn row(&mut self, start: usize, line: &str, columns: usize, cells: &mut Vec<u8>) {
        let length = line.chars().count();
        if length != columns && self.tells("ragged-level") {
            let message = format!("this row has {length} characters, the first one has {columns}");
            let help = if length < columns { "the rest is taken as blank" } else { "the rest is cut off" };
            let span = Span::new(start, start + line.len());
            self.problems.push(Diagnostic::warning("ragged-level", span, message).help(help));
        }
        let mut width = 0;
        for (at, symbol) in line.char_indices().take(columns) {
            width += 1;
            let span = Span::new(start + at, start + at + symbol.len_utf8());
            cells.push(self.cell(cells.len(), symbol, span));
        }
        cells.extend(std::iter::repeat_n(b' ', columns - width));
    }

    fn cell(&mut self, at: usize, symbol: char, span: Span) -> u8 {
        let rules = &self.game.0;
        let code = u8::try_from(symbol).unwrap_or(0);
        let places = self.game.places(code);
        self.sprites += places.len();
        for &stype in places {
            if rules.types[stype.index()].class.is_some_and(|class| class.is_avatar()) {
                self.avatars.push(span);
            }
        }
        if rules.unusable.contains(&symbol) {
            if self.tells("unknown-sprite") {
                let message =
                    format!("`{}` stands for a sprite that is not declared", symbol.escape_default());
                let problem = Diagnostic::error("unknown-sprite", span, message);
                self.problems.push(problem.help("the reference engine dies of it"));
            }
            return UNMAPPED;
        }
        if self.mapped.contains(&symbol) || !places.is_empty() || symbol == ' ' {
            return code;
        }
        if rules.as_reference {
            return UNMAPPED;
        }
        self.undefined.push((at, symbol, span));
        code
    }

    /// Characters without a mapping, each with the one that was most likely meant.
    fn tell_undefined(&mut self, columns: usize, cells: &[u8]) {
        let unused: Vec<char> =
            self.mapped.iter().copied().filter(|&c| !cells.contains(&(c as u8))).collect();
        let undefined = std::mem::take(&mut self.undefined);
        let same = undefined.iter().all(|&(_, symbol, _)| symbol == undefined[0].1);
        for &(at, symbol, span) in undefined.iter().take(MAX_REPEATS) {
            let swapped: String = symbol.to_lowercase().chain(symbol.to_uppercase()).collect();
            let other_case = self.mapped.iter().copied().find(|&c| swapped.contains(c));
            let avatar = self.avatar_symbol().filter(|_| self.avatars.is_empty() && undefined.len() == 1);
            let help = match (other_case.or(avatar), &unused[..], around(at, columns, cells)) {
                (Some(meant), ..) => format!("did you mean `{meant}`?"),
                (None, [unused], _) if same && undefined.len() > 1 => format!(
                    "did you mean `{unused}`, which this level never uses? or is `{symbol}` meant in the LevelMapping?"
                ),
                (None, _, Some(near)) => format!("did you mean `{near}`, as around it?"),
                _ => "add a line for it to the LevelMapping, or use a character that is there".to_owned(),
            };
            let message = format!("`{}` is not in the LevelMapping", symbol.escape_default());
            self.problems.push(Diagnostic::error("undefined-character", span, message).help(help));
        }
    }

    /// The first character of the LevelMapping that places an avatar.
    fn avatar_symbol(&self) -> Option<char> {
        let rules = &self.game.0;
        let is_avatar = |stype: &SpriteType| rules.types[stype.index()].class.is_some_and(|c| c.is_avatar());
        let places = |symbol: char| {
            u8::try_from(symbol).is_ok_and(|code| self.game.places(code).iter().any(is_avatar))
        };
        rules.description.mapping.iter().map(|line| line.symbol).find(|&symbol| places(symbol))
    }

    /// Whether a problem is reported once more, or was often enough.
    fn tells(&self, code: &str) -> bool {
        self.problems.iter().filter(|other| other.code == code).count() < MAX_REPEATS
    }

    fn finish(
        mut self,
        text: &str,
        columns: usize,
        rows: usize,
        cells: Vec<u8>,
    ) -> Result<Level, Diagnostics> {
        if !self.game.0.as_reference {
            self.tell_undefined(columns, &cells);
        }
        // The reference refuses the surplus, with a message each.
        let most = if self.game.0.as_reference { MAX_ATTEMPTS } else { MAX_SPRITES };
        if self.sprites > most {
            let message = format!("the level places {} sprites; the limit is {most}", self.sprites);
            self.problems
                .push(Diagnostic::error("too-large", Span::new(0, 0), message).help("make it smaller"));
        }
        if let [_, extra, ..] = self.avatars[..] {
            let message = format!("the level places {} avatars", self.avatars.len());
            let problem = Diagnostic::error("extra-avatars", extra, message).label("not the first one");
            self.problems.push(problem.help("keep one; the reference engine would remove all but the first"));
        }
        if self.avatars.is_empty() {
            let end = text.trim_end().len();
            let first = text.chars().next().map_or(0, char::len_utf8);
            let help = match self.avatar_symbol() {
                Some(symbol) => format!("put `{symbol}` where it starts"),
                None => "no character of the LevelMapping places one: add a line `A > avatar`".to_owned(),
            };
            let problem =
                Diagnostic::error("no-avatar", Span::new(0, end.min(first)), "the level places no avatar");
            self.problems.push(problem.help(help));
        }
        let mut messages = 0;
        if self.game.0.as_reference {
            let undefined = |&&symbol: &&u8| symbol == UNMAPPED;
            messages = cells.iter().filter(undefined).count() as u32;
            self.problems.retain(|problem| ["unknown-sprite", "too-large"].contains(&problem.code));
        }
        if !self.game.0.as_reference && !Diagnostics::has_errors(&self.problems) {
            self.problems.extend(crate::lint::over_at_start(self.game, &cells));
        }
        let problems = Diagnostics::sorted(self.problems);
        if Diagnostics::has_errors(&problems.0) {
            return Err(problems);
        }
        Ok(Level { columns, rows, cells, warnings: problems.0, messages })
    }
}

/// The printable character that most of a cell's neighbours have; those beside it count twice.
fn around(at: usize, columns: usize, cells: &[u8]) -> Option<char> {
    let (column, row) = ((at % columns) as isize, (at / columns) as isize);
    let mut weights = [0; 128];
    for (dx, dy) in [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)] {
        let (x, y) = (column + dx, row + dy);
        if x < 0 || y < 0 || x >= columns as isize {
            continue;
        }
        let found = cells.get(y as usize * columns + x as usize).copied();
        if let Some(code) = found.filter(u8::is_ascii_graphic) {
            weights[usize::from(code)] += if dx == 0 || dy == 0 { 2 } else { 1 };
        }
    }
    let code = (0..128_u8).rev().max_by_key(|&code| weights[usize::from(code)])?;
    (weights[usize::from(code)] > 0).then_some(char::from(code))
}

/// The lines of a level and where each starts; a final newline does not make another line.
fn level_lines(text: &str) -> Vec<(usize, &str)> {
    let mut lines = Vec::new();
    let mut rest = text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text);
    while !rest.is_empty() {
        let start = text.len() - rest.len();
        let end = rest.find(['\n', '\r']).unwrap_or(rest.len());
        lines.push((start, &rest[..end]));
        let pair = rest[end..].starts_with("\r\n");
        rest = &rest[(end + if pair { 2 } else { 1 }).min(rest.len())..];
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    const GAME: &str = "BasicGame\n  SpriteSet\n    wall > Immovable\n    gold > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    w > wall\n    g > gold\n    A > avatar\n  InteractionSet\n    avatar wall > stepBack\n    gold avatar > killSprite\n  TerminationSet\n    SpriteCounter stype=gold win=True\n    Timeout limit=9 win=False\n";

    fn check(text: &str, expect: Result<(usize, usize), &[&str]>) {
        let game = Game::from_source(GAME).unwrap();
        let got = game.level(text);
        let codes: Vec<&str> =
            got.as_ref().err().map_or(Vec::new(), |all| all.0.iter().map(|d| d.code).collect());
        match expect {
            Ok(size) => assert_eq!(got.map(|level| (level.columns(), level.rows())), Ok(size)),
            Err(expected) => assert_eq!(codes, expected, "{text:?}"),
        }
    }

    #[test]
    fn levels_and_their_problems() {
        check("wAg\r\nwww\r\n", Ok((3, 2)));
        check("wAg\nw\n", Ok((3, 2)));
        check("wAg\n\n", Ok((3, 2)));
        check("wAG\n", Err(&["undefined-character"]));
        check("wgw\n", Err(&["no-avatar"]));
        check("\u{feff}\n", Err(&["empty-level"]));
        check("AgA\n", Err(&["extra-avatars"]));
        check("\u{feff}wAg\n", Ok((3, 1)));
        check("", Err(&["empty-level"]));
        check(&"w".repeat(600), Err(&["too-large"]));
        check(&"x".repeat(MAX_LEVEL_TEXT + 1), Err(&["too-large"]));
        check("Aé\u{0}\n", Err(&["undefined-character", "undefined-character"]));
    }

    #[test]
    fn the_canonical_text_is_rectangular() {
        let game = Game::from_source(GAME).unwrap();
        let level = game.level("wAg\nw").unwrap();
        assert_eq!(level.to_string(), "wAg\nw  \n");
        assert_eq!(level.warnings()[0].code, "ragged-level");
        assert_eq!(game.level("wAg\nw  \n").unwrap().digest(), level.digest());
    }
}
