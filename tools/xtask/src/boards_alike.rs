//! `cargo xtask boards-alike` finds boards in new games that resemble existing boards.

use anyhow::{Context, bail};
use engine::analysis::Role;
use engine::{Analysis, Game, Level};
use forge::card::Origin;
use rayon::prelude::*;
use report::{Table, TableCell};
use snapshots::released::{Released, ReleasedGame};
use std::fs;
use std::path::{Path, PathBuf};

/// Compares the levels of releases' new games with the boards that existed before, and prints the fraction of
/// similar levels.
///
/// The similarity of two boards is that of their best match. A match is one of the eight symmetries with any
/// shift at which the other board covers at least half of the board. Its similarity is the number of cells
/// that are not floor in both boards, divided by the number of cells that are not floor in at least one of
/// them. With a similarity above 0.8, the boards are equal or nearly equal.
///
/// A level is compared with the levels of all other releases, with the levels of earlier games in its own
/// release, and with the corpus. It is also compared with those drawings of the kernels that have at least 5
/// x 7 cells.
///
/// Example: cargo xtask boards-alike releases/2027-01 releases/2027-02
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Folders or archives of releases
    #[arg(value_name = "SNAPSHOT", required = true)]
    releases: Vec<PathBuf>,
    /// Folder of hand-written games
    #[arg(long, value_name = "DIR", default_value = "corpora")]
    corpora: PathBuf,
    /// Folder of kernels with drawings
    #[arg(long, value_name = "DIR", default_value = "generators/kernels")]
    kernels: PathBuf,
    /// Print each similar level, its similarity, and the board that it resembles
    #[arg(long)]
    list: bool,
}

/// The similarity above which two boards count as equal.
const ALIKE: f64 = 0.8;
/// The minimum number of rows and columns in a drawing.
const LEAST: (usize, usize) = (5, 7);

/// The kinds of existing boards with which a level is compared.
const KINDS: [&str; 3] = ["releases", "corpus", "drawings"];

/// A board, represented by the cells that are not floor.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Board {
    columns: usize,
    lines: Vec<u64>,
}

impl Board {
    fn of<'a>(lines: impl IntoIterator<Item = &'a str>, is_floor: impl Fn(char) -> bool) -> Option<Board> {
        let lines: Vec<&str> = lines.into_iter().collect();
        let columns = lines.iter().map(|line| line.chars().count()).max()?;
        let bits = |line: &&str| {
            let things = line.chars().enumerate().filter(|(_, cell)| !is_floor(*cell));
            things.fold(0u64, |bits, (at, _)| bits | 1 << at)
        };
        (columns <= 64).then(|| Board { columns, lines: lines.iter().map(bits).collect() })
    }

    fn of_level(game: &Game, level: &Level) -> Option<Board> {
        let analysis = Analysis::of(game);
        let is_floor = |cell: char| {
            let Ok(symbol) = u8::try_from(cell) else { return false };
            game.places(symbol).iter().all(|stype| analysis.role(*stype) == Role::Floor)
        };
        let text = level.to_string();
        Board::of(text.lines(), is_floor)
    }

    fn rows(&self) -> usize {
        self.lines.len()
    }

    fn has(&self, x: usize, y: usize) -> bool {
        self.lines[y] >> x & 1 == 1
    }

    /// Returns the board's eight symmetric images. Bit 0 exchanges left and right, bit 1 exchanges top and
    /// bottom, and bit 2 exchanges columns and rows.
    fn images(&self) -> impl Iterator<Item = Board> + '_ {
        (0..8).map(|symmetry| {
            let is_turned = symmetry & 4 != 0;
            let (columns, rows) =
                if is_turned { (self.rows(), self.columns) } else { (self.columns, self.rows()) };
            let line = |y: usize| {
                let cell = |x: usize| {
                    let (x, y) = if is_turned { (y, x) } else { (x, y) };
                    let x = if symmetry & 1 != 0 { self.columns - 1 - x } else { x };
                    let y = if symmetry & 2 != 0 { self.rows() - 1 - y } else { y };
                    self.has(x, y)
                };
                (0..columns).filter(|x| cell(*x)).fold(0u64, |bits, x| bits | 1 << x)
            };
            Board { columns, lines: (0..rows).map(line).collect() }
        })
    }

    /// Returns the maximum similarity over all shifts for which the other board covers at least half of this
    /// board.
    fn best_shift(&self, other: &Board) -> f64 {
        let [columns, rows, wide, high] =
            [self.columns, self.rows(), other.columns, other.rows()].map(|side| side as i64);
        let mut best = 0.0;
        for dy in 1 - high..rows {
            let (top, bottom) = (dy.max(0), (dy + high).min(rows));
            for dx in 1 - wide..columns {
                let (left, right) = (dx.max(0), (dx + wide).min(columns));
                if 2 * (bottom - top) * (right - left) < columns * rows {
                    continue;
                }
                let mask = (u64::MAX >> (64 - (right - left))) << left;
                let (mut both, mut either) = (0, 0);
                for y in top..bottom {
                    let mine = self.lines[y as usize] & mask;
                    let line = other.lines[(y - dy) as usize];
                    let theirs = if dx >= 0 { line << dx } else { line >> -dx } & mask;
                    both += (mine & theirs).count_ones();
                    either += (mine | theirs).count_ones();
                }
                if either > 0 {
                    best = f64::max(best, f64::from(both) / f64::from(either));
                }
            }
        }
        best
    }
}

/// An existing board, with its name and its eight images.
struct Known {
    name: String,
    kind: usize,
    /// The index of the board's release, and the index of its game in that release, if the board belongs to a
    /// release.
    place: Option<(usize, usize)>,
    images: Vec<Board>,
}

impl Known {
    fn new(name: String, kind: usize, place: Option<(usize, usize)>, board: &Board) -> Known {
        let mut images: Vec<Board> = Vec::new();
        board.images().for_each(|image| {
            if !images.contains(&image) {
                images.push(image);
            }
        });
        Known { name, kind, place, images }
    }

    /// Returns `true` if the board existed before the given game of a release.
    fn is_before(&self, (release, game): (usize, usize)) -> bool {
        self.place.is_none_or(|(other, at)| other != release || at < game)
    }
}

/// A level of a new game.
struct New {
    name: String,
    place: (usize, usize),
    is_invented: bool,
    board: Board,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let mut known = drawings(&args.kernels)?;
    known.extend(corpus(&args.corpora)?);
    let mut new = Vec::new();
    for (release, path) in args.releases.iter().enumerate() {
        let released = Released::read(path)?;
        for (game, content) in released.games.iter().enumerate() {
            collect((release, game), &released.manifest.name, content, &mut known, &mut new);
        }
    }
    if new.is_empty() {
        bail!("these releases have no levels of new games");
    }
    let best_of = |level: &New| {
        let mut best: Likest<'_> = [(0.0, ""); KINDS.len()];
        for other in known.iter().filter(|other| other.is_before(level.place)) {
            let found = other.images.iter().map(|image| level.board.best_shift(image)).fold(0.0, f64::max);
            if found > best[other.kind].0 {
                best[other.kind] = (found, &other.name);
            }
        }
        best
    };
    let best: Vec<Likest<'_>> = new.par_iter().map(best_of).collect();
    if args.list {
        for (level, best) in new.iter().zip(&best) {
            for (likeness, other) in best.iter().filter(|(likeness, _)| *likeness > ALIKE) {
                println!("{}: {likeness:.2} {other}", level.name);
            }
        }
    }
    println!("{}", table(args, &new, &best).to_markdown());
    Ok(())
}

/// For each kind of board, the maximum similarity to any board of that kind, and the name of the most similar
/// board.
type Likest<'a> = [(f64, &'a str); KINDS.len()];

fn table(args: &Args, new: &[New], best: &[Likest<'_>]) -> Table {
    let mut columns = vec!["release", "games", "levels"];
    columns.extend(KINDS);
    columns.push("any");
    let note = format!(
        "Fraction of levels whose similarity to a board from another or earlier release, from the corpus or \
         from a kernel exceeds {ALIKE}."
    );
    let mut table = Table::new("boards-alike", "Boards alike", &note, &columns);
    for (release, path) in args.releases.iter().enumerate() {
        for (is_invented, words) in [(true, "invented"), (false, "other new")] {
            let is_of = |level: &New| level.place.0 == release && level.is_invented == is_invented;
            let rows: Vec<_> =
                new.iter().zip(best).filter(|(level, _)| is_of(level)).map(|(_, best)| best).collect();
            if rows.is_empty() {
                continue;
            }
            let share = |is: &dyn Fn(&Likest<'_>) -> bool| {
                let alike = rows.iter().filter(|best| is(best)).count();
                TableCell::number(alike as f64 / rows.len() as f64, 3)
            };
            let mut row = vec![
                TableCell::text(path.display().to_string()),
                TableCell::text(words),
                TableCell::Count(rows.len() as u64),
            ];
            row.extend((0..KINDS.len()).map(|kind| share(&|best| best[kind].0 > ALIKE)));
            row.push(share(&|best| best.iter().any(|(likeness, _)| *likeness > ALIKE)));
            table.push(row);
        }
    }
    table
}

/// Adds the boards from a game in a release.
fn collect(
    place: (usize, usize),
    release: &str,
    game: &ReleasedGame,
    known: &mut Vec<Known>,
    new: &mut Vec<New>,
) {
    for (number, level) in game.levels.iter().enumerate() {
        let Some(board) = Board::of_level(&game.game, &level.level) else { continue };
        let name = format!("{release}/{} level {number}", game.card.id);
        known.push(Known::new(name.clone(), 0, Some(place), &board));
        if let Origin::Generated { patterns, .. } = &game.card.origin {
            let is_invented = patterns.iter().any(|pattern| pattern.starts_with("mechanic/"));
            new.push(New { name, place, is_invented, board });
        }
    }
}

/// Returns the boards from the hand-written games.
fn corpus(folder: &Path) -> anyhow::Result<Vec<Known>> {
    let mut known = Vec::new();
    for game in files(folder)?.into_iter().filter(|path| path.is_dir()) {
        let source = fs::read_to_string(game.join("game.vgdl"))?;
        let Ok(rules) = Game::from_source(&source) else { continue };
        for path in files(&game)?.into_iter().filter(|path| path.extension().is_some_and(|end| end == "txt"))
        {
            let Ok(level) = rules.level(&fs::read_to_string(&path)?) else { continue };
            if let Some(board) = Board::of_level(&rules, &level) {
                known.push(Known::new(path.display().to_string(), 1, None, &board));
            }
        }
    }
    Ok(known)
}

/// Returns the sufficiently large drawings in kernels. A drawing is any board text in a kernel file, with
/// floor written as `.`.
fn drawings(folder: &Path) -> anyhow::Result<Vec<Known>> {
    let mut known = Vec::new();
    for path in files(folder)?.into_iter().filter(|path| path.extension().is_some_and(|end| end == "toml")) {
        let kernel: toml::Table =
            fs::read_to_string(&path)?.parse().with_context(|| path.display().to_string())?;
        let pieces = kernel.get("pieces").and_then(toml::Value::as_table);
        for (name, text) in pieces.into_iter().flatten() {
            let Some(text) = text.as_str() else { continue };
            let lines = text.lines().filter(|line| !line.trim().is_empty());
            let Some(board) = Board::of(lines, |cell| matches!(cell, '.' | ' ')) else { continue };
            if board.rows() >= LEAST.0 && board.columns >= LEAST.1 {
                known.push(Known::new(format!("{} {name}", path.display()), 2, None, &board));
            }
        }
    }
    Ok(known)
}

/// Returns a folder's entries, sorted by name.
fn files(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let entries = fs::read_dir(folder).with_context(|| folder.display().to_string())?;
    let mut paths = entries.map(|entry| Ok(entry?.path())).collect::<anyhow::Result<Vec<PathBuf>>>()?;
    paths.sort();
    Ok(paths)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn board(text: &str) -> Board {
        Board::of(text.split('/'), |cell| cell == '.').unwrap()
    }

    fn likeness(one: &str, other: &str) -> f64 {
        let one = board(one);
        board(other).images().map(|image| one.best_shift(&image)).fold(0.0, f64::max)
    }

    #[test]
    fn boards_are_alike_up_to_symmetry_and_shift() {
        let drawn = "#..#/#a../###.";
        assert_eq!(likeness(drawn, drawn), 1.0);
        assert_eq!(likeness(drawn, "#..#/..b#/.###"), 1.0);
        assert_eq!(likeness(drawn, "###/#a./#../..#"), 1.0);
        // The other board has an additional margin.
        assert_eq!(likeness(drawn, "....../.#..#./.#a.../.###../......"), 1.0);
    }

    #[test]
    fn cells_that_differ_count() {
        // Eight cells are in both boards, and a ninth is in only one of them. All shifts that cover half of
        // the board include the hole.
        assert_eq!(likeness("###/###/###", "###/#.#/###"), 8.0 / 9.0);
        assert_eq!(likeness("....", "...."), 0.0);
    }

    /// A match with only a small part of a board is not evidence of similarity.
    #[test]
    fn the_other_covers_half() {
        assert_eq!(likeness("##....../........", "##"), 0.0);
    }

    #[test]
    fn boards_before_are_those_of_others_and_of_earlier_games() {
        let of = |place| Known::new(String::new(), 0, place, &board("#"));
        assert!(of(None).is_before((0, 0)));
        assert!(of(Some((1, 3))).is_before((0, 0)));
        assert!(of(Some((0, 0))).is_before((0, 1)));
        assert!(!of(Some((0, 1))).is_before((0, 1)) && !of(Some((0, 2))).is_before((0, 1)));
    }
}
