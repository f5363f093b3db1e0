//! Levels: grids of characters, checked against a game's LevelMapping (`spec/01` §2).

use crate::compile::{Outline, missing_image, outline};
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Span};
use crate::game::Game;
use crate::limits::{MAX_ATTEMPTS, MAX_CELLS, MAX_LEVEL_TEXT, MAX_SIDE, MAX_SPRITES};
use crate::rules::{Aliases, SpriteType};
use crate::syntax::BYTE_ORDER_MARK;
use base::Digest;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// The maximum number of problems of one kind to report individually.
const MAX_REPEATS: usize = 10;
/// The code for unmapped characters in levels loaded in reference mode.
const UNMAPPED: u8 = 0;

/// A level that fits one game: characters in row-major order, each of which is either a space or in the
/// game's LevelMapping.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Level {
    columns: usize,
    rows: usize,
    cells: Vec<u8>,
    /// The non-ASCII characters that some cell codes represent.
    aliases: Aliases,
    warnings: Vec<Diagnostic>,
    /// The number of messages that the reference logs while it builds the level.
    pub(crate) messages: u32,
}

impl Level {
    /// Returns the number of columns on the board.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Returns the number of rows on the board.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Returns the characters in row-major order, as ASCII codes. In a game loaded in reference mode, some
    /// codes stand for non-ASCII characters: see [`Game::character`].
    pub fn cells(&self) -> &[u8] {
        &self.cells
    }

    /// Returns the warnings: parts of the level that are valid but almost certainly unintended.
    pub fn warnings(&self) -> &[Diagnostic] {
        &self.warnings
    }

    /// Returns the BLAKE3 digest of the canonical text: rows of equal length, each ending in a newline.
    pub fn digest(&self) -> Digest {
        Digest::of(self.to_string().as_bytes())
    }
}

impl fmt::Display for Level {
    /// Writes the canonical text.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.cells.chunks(self.columns).try_for_each(|row| {
            if self.aliases.0.is_empty() {
                row.iter().try_for_each(|&symbol| write!(f, "{}", char::from(symbol)))?;
            } else {
                let unit =
                    |&symbol: &u8| self.aliases.of_code(symbol).map_or(symbol.into(), |alias| alias.unit);
                let units = row.iter().map(unit);
                char::decode_utf16(units).try_for_each(|decoded| {
                    write!(f, "{}", decoded.unwrap_or(char::REPLACEMENT_CHARACTER))
                })?;
            }
            writeln!(f)
        })
    }
}

impl Game {
    /// Returns the sprites that a level character places, in the order of its LevelMapping line. The result is empty
    /// for spaces and unmapped characters.
    pub fn places(&self, symbol: u8) -> &[SpriteType] {
        self.0.mapping.get(usize::from(symbol)).map_or(&[], |types| types)
    }

    /// Returns the character that a cell code represents: the ASCII character with that code or, in games
    /// loaded in reference mode, possibly a non-ASCII character.
    pub fn character(&self, symbol: u8) -> char {
        self.0.aliases.of_code(symbol).map_or(char::from(symbol), |alias| alias.character)
    }

    /// Checks a level's text against the game and builds the level.
    ///
    /// # Errors
    /// Returns all problems in the text, sorted by position: unmapped characters, no avatar or several
    /// avatars, or a size beyond [`MAX_SIDE`], [`MAX_CELLS`] or [`MAX_SPRITES`].
    pub fn level(&self, text: &str) -> Result<Level, Diagnostics> {
        let everything = Span::new(0, 0);
        let fail = |problem| Err(Diagnostics(vec![problem]));
        if text.len() > MAX_LEVEL_TEXT {
            let message =
                format!("the level is {} bytes long; the size limit is {MAX_LEVEL_TEXT}", text.len());
            return fail(
                Diagnostic::error("too-large", everything, message)
                    .help("split the level, or check that this is a level file"),
            );
        }
        let lines = level_lines(text);
        let length = |line: &str| match self.0.as_reference {
            true => line.encode_utf16().count(),
            false => line.chars().count(),
        };
        let columns = lines.first().map_or(0, |(_, line)| length(line));
        let rows = lines.len();
        if columns == 0 {
            let message = "the level's first line is empty; its length is the width of the level";
            return fail(
                Diagnostic::error("empty-level", everything, message)
                    .help("a level consists of rows of characters"),
            );
        }
        if columns > MAX_SIDE || rows > MAX_SIDE || columns * rows > MAX_CELLS {
            let message = format!(
                "the level has {columns} columns and {rows} rows; the limits are {MAX_SIDE} per side and \
                 {MAX_CELLS} cells in total"
            );
            return fail(
                Diagnostic::error("too-large", everything, message)
                    .help("make the level smaller, or split it"),
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
        reader.report_ragged(&lines, columns);
        reader.finish(text, columns, rows, cells)
    }
}

/// The LevelMapping of a faulty game, for checking the game's levels. It is available if the LevelMapping and
/// the SpriteSet can be read.
#[derive(Clone, Debug)]
pub struct LevelMapping {
    game: Game,
    knows_characters: bool,
    knows_avatars: bool,
}

impl LevelMapping {
    /// Reads the LevelMapping of a game that may have faults elsewhere. Returns `None` if the LevelMapping
    /// itself is faulty.
    pub fn of_source(source: &str) -> Option<LevelMapping> {
        let (description, Diagnostics(problems)) = crate::syntax::parse_all(source);
        if crate::dialect::is_of_several_players(&description) {
            return None;
        }
        let Outline { description, knows_characters, knows_avatars } = outline(&description, &problems)?;
        let game = Game::compile(&description).ok()?;
        Some(LevelMapping { game, knows_characters, knows_avatars })
    }

    /// Returns the problems in a level's text that do not depend on the game's faults, sorted by position.
    pub fn problems(&self, text: &str) -> Vec<Diagnostic> {
        let level = self.game.level(text);
        let mut problems = level.map_or_else(|problems| problems.0, |level| level.warnings);
        problems.retain(|problem| match problem.code {
            "undefined-character" => self.knows_characters,
            "no-avatar" | "extra-avatars" => self.knows_avatars,
            // The only termination of `self.game` does not come from the faulty game.
            "ends-at-once" => false,
            _ => true,
        });
        problems
    }
}

struct LevelReader<'a> {
    game: &'a Game,
    /// The characters that the LevelMapping maps.
    mapped: BTreeSet<char>,
    problems: Vec<Diagnostic>,
    avatars: Vec<(Span, SpriteType)>,
    sprites: usize,
    /// Unmapped characters, each with its cell and its position in the text.
    undefined: Vec<(usize, char, Span)>,
}

impl LevelReader<'_> {
    fn row(&mut self, start: usize, line: &str, columns: usize, cells: &mut Vec<u8>) {
        let end = cells.len() + columns;
        for (at, symbol) in line.char_indices() {
            let span = Span::new(start + at, start + at + symbol.len_utf8());
            // The reference reads UTF-16 code units, and some characters consist of two.
            let units = if self.game.0.as_reference { symbol.len_utf16() } else { 1 };
            for &unit in symbol.encode_utf16(&mut [0; 2]).iter().take(units) {
                if cells.len() == end {
                    return;
                }
                cells.push(self.cell(cells.len(), (symbol, unit), span));
            }
        }
        cells.resize(end, b' ');
    }

    fn cell(&mut self, at: usize, (symbol, unit): (char, u16), span: Span) -> u8 {
        let rules = &self.game.0;
        let alias = rules.aliases.of_unit(unit);
        let own = u8::try_from(unit).ok().filter(|code| code.is_ascii());
        let own = own.filter(|&code| rules.aliases.of_code(code).is_none());
        let code = alias.or(own).unwrap_or(UNMAPPED);
        let places = self.game.places(code);
        self.sprites += places.len();
        for &stype in places {
            let info = &rules.types[stype.index()];
            if info.class.is_some_and(|class| class.is_avatar()) {
                self.avatars.push((span, stype));
            }
            if info.lacks_image.is_some() {
                let problem = missing_image(&info.name, span);
                // Each type is reported only once, at its first occurrence.
                if self.problems.iter().all(|other| other.message != problem.message) {
                    self.problems.push(problem);
                }
            }
        }
        if rules.unusable.contains(&code) {
            if self.tells("unknown-sprite") {
                let message =
                    format!("`{}` stands for a sprite that is not declared", symbol.escape_default());
                let problem = Diagnostic::error("unknown-sprite", span, message);
                self.problems.push(problem.help("the reference engine crashes on it"));
            }
            return UNMAPPED;
        }
        let is_mapped = alias.is_some() || own.is_some() && self.mapped.contains(&symbol);
        if is_mapped || !places.is_empty() || symbol == ' ' {
            return code;
        }
        if rules.as_reference {
            return UNMAPPED;
        }
        self.undefined.push((at, symbol, span));
        code
    }

    /// Reports rows whose length differs from the length of the first row. If all other rows have the same
    /// length, reports only the first row.
    fn report_ragged(&mut self, lines: &[(usize, &str)], columns: usize) {
        let length = |line: &str| line.chars().count();
        let mut others = lines[1..].iter().map(|(_, line)| length(line));
        let second = others.next().filter(|&second| second != columns && lines.len() > 2);
        if let Some(second) = second.filter(|&second| others.all(|other| other == second)) {
            let span = Span::new(lines[0].0, lines[0].0 + lines[0].1.len());
            let fill = Edit::new(Span::new(span.end, span.end), " ".repeat(second.saturating_sub(columns)));
            let message = format!("the first row has {columns} characters, but all other rows have {second}");
            let others = if columns < second { "cut off" } else { "padded with spaces" };
            let help = format!(
                "the level is as wide as its first row, so the other rows are {others}: make the first \
                 row as long as the others"
            );
            let problem = Diagnostic::warning("ragged-level", span, message).help(help);
            self.problems.push(match columns < second {
                true => problem.fix("Pad the first row with spaces", vec![fill]),
                false => problem,
            });
            return;
        }
        for &(start, line) in lines.iter().filter(|(_, line)| length(line) != columns) {
            let message =
                format!("this row has {} characters, but the first row has {columns}", length(line));
            // Mark the part that is cut off, or the whole row if it is too short.
            let (from, help) = match line.char_indices().nth(columns) {
                Some((from, _)) => (from, "the rest is cut off: shorten this row, or lengthen the first row"),
                None => (
                    0,
                    "missing cells count as spaces: lengthen the row, or pad it with spaces if that is intended",
                ),
            };
            let span = Span::new(start + from, start + line.len());
            let problem = Diagnostic::warning("ragged-level", span, message).help(help);
            let missing = columns.saturating_sub(length(line));
            let fill = Edit::new(Span::new(span.end, span.end), " ".repeat(missing));
            let is_blank = line[from..].bytes().all(|byte| byte == b' ');
            self.problems.push(match missing {
                0 if is_blank => problem.fix("Remove the spaces", vec![Edit::new(span, "")]),
                0 => problem,
                _ => problem.fix("Pad the row with spaces", vec![fill]),
            });
        }
    }

    /// Reports unmapped characters, and suggests the characters that were most likely meant.
    fn report_undefined(&mut self, columns: usize, cells: &[u8]) {
        let unused: Vec<char> =
            self.mapped.iter().copied().filter(|&c| !cells.contains(&(c as u8))).collect();
        let undefined = std::mem::take(&mut self.undefined);
        let mut counts: BTreeMap<char, usize> = BTreeMap::new();
        undefined.iter().for_each(|(_, symbol, _)| *counts.entry(*symbol).or_default() += 1);
        let kinds = counts.len();
        let mut places: BTreeMap<char, Vec<Span>> = BTreeMap::new();
        undefined.iter().for_each(|(_, symbol, span)| places.entry(*symbol).or_default().push(*span));
        let avatar = self.avatar_symbol().filter(|_| self.avatars.is_empty() && undefined.len() == 1);
        for (at, symbol, span) in undefined {
            // Each character is reported only once, at its first occurrence.
            let Some(count) = counts.remove(&symbol) else { continue };
            let swapped: String = symbol.to_lowercase().chain(symbol.to_uppercase()).collect();
            let other_case = self.mapped.iter().copied().find(|&c| swapped.contains(c));
            // A letter or digit was probably meant as a separate sprite rather than as the surrounding
            // ground.
            let near = around(at, columns, cells).filter(|_| count == 1 && !symbol.is_alphanumeric());
            let shown = symbol.escape_default();
            let (meant, help) = match (other_case.or(avatar), &unused[..], near) {
                _ if symbol == '\t' => (None, "write spaces instead: a tab is a single cell".to_owned()),
                (Some(meant), ..) => (Some(meant), format!("did you mean `{meant}`?")),
                (None, &[unused], _) if kinds == 1 && count > 1 => (
                    Some(unused),
                    format!(
                        "did you mean `{unused}`, which this level never uses, or should the LevelMapping use `{shown}` instead?"
                    ),
                ),
                (None, _, Some(near)) => {
                    (Some(near), format!("did you mean `{near}`, like the cells around it?"))
                }
                _ if self.unplaced(symbol).is_some() => {
                    let name = self.unplaced(symbol).unwrap_or_default();
                    (
                        None,
                        format!(
                            "add a line `{shown} > {name}` to the LevelMapping: no character places `{name}`"
                        ),
                    )
                }
                _ if symbol.is_ascii_graphic() && symbol != '#' => (
                    None,
                    format!(
                        "add a line `{shown} > …` to the LevelMapping, or use a character from the LevelMapping"
                    ),
                ),
                _ => (None, "use a character that is in the LevelMapping".to_owned()),
            };
            let message = match count {
                _ if symbol == '#' => {
                    "`#` is not in the LevelMapping, and cannot be added, because it starts a comment"
                        .to_owned()
                }
                1 => format!("`{shown}` is not in the LevelMapping"),
                _ => format!("`{shown}` is not in the LevelMapping, and occurs {count} times in the level"),
            };
            let problem = Diagnostic::error("undefined-character", span, message).help(help);
            let own = places.remove(&symbol).unwrap_or_default();
            // If there are several avatars, each avatar except one is an error.
            let rules = &self.game.0;
            let is_avatar =
                |stype: &SpriteType| rules.types[stype.index()].class.is_some_and(|c| c.is_avatar());
            let plays = |meant: char| {
                u8::try_from(meant).is_ok_and(|code| self.game.places(code).iter().any(is_avatar))
            };
            let fits = |meant: &char| !plays(*meant) || self.avatars.len() + count == 1;
            self.problems.push(match meant.filter(fits) {
                Some(meant) => problem.fix(
                    format!("Write `{meant}`"),
                    own.into_iter().map(|span| Edit::new(span, meant)).collect(),
                ),
                None => problem,
            });
        }
    }

    /// Returns the sprite type that an unmapped character most likely stands for: the only type whose name begins with
    /// this character and that no character places. Returns `None` if there is no such type, or if there are several.
    fn unplaced(&self, symbol: char) -> Option<&str> {
        let rules = &self.game.0;
        let mapped: BTreeSet<&SpriteType> = rules.mapping.iter().flatten().collect();
        let begins = |name: &str| name.chars().next().is_some_and(|c| c.eq_ignore_ascii_case(&symbol));
        let is_free = |at: &usize| {
            let info = &rules.types[*at];
            info.leaf
                && info.class.is_some()
                && !mapped.contains(&SpriteType(*at as u16))
                && begins(&info.name)
        };
        let mut free = (0..rules.types.len()).filter(is_free).map(|at| rules.types[at].name.as_str());
        free.next().filter(|_| free.next().is_none() && symbol.is_ascii_alphanumeric())
    }

    /// Returns the first avatar-placing character in the LevelMapping; `None` if no character places an avatar.
    fn avatar_symbol(&self) -> Option<char> {
        let rules = &self.game.0;
        let is_avatar = |stype: &SpriteType| rules.types[stype.index()].class.is_some_and(|c| c.is_avatar());
        let places = |symbol: char| {
            u8::try_from(symbol).is_ok_and(|code| self.game.places(code).iter().any(is_avatar))
        };
        rules.description.mapping.iter().map(|line| line.symbol).find(|&symbol| places(symbol))
    }

    /// Reports avatars of a parent type, which the engine does not find when the level starts. Nor does it
    /// find avatars of the type that is drawn first, but that warning is reported for the game instead.
    fn report_lost_avatar(&mut self) {
        let info = |stype: SpriteType| &self.game.0.types[stype.index()];
        let Some(&(span, stype)) = self.avatars.first() else { return };
        if self.avatars.iter().any(|&(_, stype)| info(stype).order.is_some()) {
            return;
        }
        let name = &info(stype).name;
        let below = self.game.sprite_types().filter(|&other| {
            let other = info(other);
            other.leaf && other.name != *name && other.path.contains(&stype) && other.is_sought()
        });
        let below: Vec<&str> = below.map(|other| self.game.name(other)).take(MAX_REPEATS).collect();
        let help = match &below[..] {
            [] => "place a type that has no subtypes".to_owned(),
            _ => format!("place one of its subtypes: {}", below.join(", ")),
        };
        let message =
            format!("the level places no avatar that a player can control: `{name}` is a parent type");
        self.problems.push(Diagnostic::error("no-avatar", span, message).help(help));
    }

    /// Returns advice on the line that is missing from a LevelMapping that places no avatar.
    fn lacking_avatar(&self) -> String {
        let description = &self.game.0.description;
        let is_avatar = |name: &str| {
            let stype = self.game.sprite_type(name);
            stype.and_then(|stype| self.game.class(stype)).is_some_and(|class| class.is_avatar())
        };
        let own = description.sprite_lines().into_iter().map(|(_, line)| line.name.text.as_str());
        let Some(name) = own.rev().find(|name| is_avatar(name)) else {
            return "no character of the LevelMapping places one: add a line `A > avatar`".to_owned();
        };
        let line = description.mapping.iter().find(|line| line.symbol == 'A');
        let places = line.iter().flat_map(|line| &line.names).map(|name| format!("{} ", name.text));
        let line = format!("A > {}{name}", places.collect::<String>());
        format!(
            "no character of the LevelMapping places the avatar `{name}`: add it to a line, such as `{line}`"
        )
    }

    /// Returns `true` if another problem with the given code should be reported.
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
            self.report_undefined(columns, &cells);
        }
        // The reference rejects each surplus sprite with a message.
        let most = if self.game.0.as_reference { MAX_ATTEMPTS } else { MAX_SPRITES };
        if self.sprites > most {
            let message = format!("the level places {} sprites; the limit is {most}", self.sprites);
            self.problems.push(
                Diagnostic::error("too-large", Span::new(0, 0), message).help("make the level smaller"),
            );
        }
        if let [_, (extra, _), ..] = self.avatars[..] {
            let message = format!("the level places {} avatars", self.avatars.len());
            let problem = Diagnostic::error("extra-avatars", extra, message).label("not the first one");
            self.problems.push(problem.help(
                "keep one avatar: games for several players are not supported, and the reference engine \
                 would remove all avatars but the first",
            ));
        }
        if self.avatars.is_empty() {
            let end = text.trim_end().len();
            let first = text.chars().next().map_or(0, char::len_utf8);
            let help = match self.avatar_symbol() {
                Some(symbol) => format!("put `{symbol}` in the avatar's starting cell"),
                None => self.lacking_avatar(),
            };
            let problem =
                Diagnostic::error("no-avatar", Span::new(0, end.min(first)), "the level places no avatar");
            self.problems.push(problem.help(help));
        }
        self.report_lost_avatar();
        let mut messages = 0;
        if self.game.0.as_reference {
            let undefined = |&&symbol: &&u8| symbol == UNMAPPED;
            messages = cells.iter().filter(undefined).count() as u32;
            let fatal = ["unknown-sprite", "missing-image", "too-large"];
            self.problems.retain(|problem| fatal.contains(&problem.code));
        }
        if !Diagnostics::has_errors(&self.problems) {
            let aliases = self.game.0.aliases.clone();
            let mut level = Level { columns, rows, cells, aliases, warnings: Vec::new(), messages };
            if !self.game.0.as_reference {
                self.problems.extend(crate::lint::over_at_start(self.game, &level));
                self.problems.extend(crate::lint::open_border(self.game, &level));
            }
            level.warnings = Diagnostics::sorted(self.problems).shortened(text.len()).0;
            return Ok(level);
        }
        Err(Diagnostics::sorted(self.problems).shortened(text.len()))
    }
}

/// Returns the most frequent printable character around a cell; `None` if there is none. Orthogonal neighbours count
/// twice.
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

/// Returns the lines in a level, each with its start position. A final newline does not start a new line.
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
