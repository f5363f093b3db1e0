//! Tests the sentences of `describe` by playing. A row names a template, the sentence that it gives in a
//! small game, and what happens in that game. If a sentence could be read in two ways, the episodes of its
//! row distinguish the two meanings.

mod templates;

use base::Seed;
use engine::describe::describe;
use engine::{Action, Game, Outcome, State};
use std::fmt::Write as _;

/// The rows, one per paragraph: the templates that the sentence is made from, followed by fields.
///
/// - `says`: the sentence, a line of the description.
/// - `sprites`: the types other than the avatar, which is a MovingAvatar unless it is listed. The level
///   character of a type is the first letter of its name, and `A` is the avatar.
/// - `rules`: the interactions.
/// - `only`: the types other than the avatar that levels can place; by default all.
/// - `header`: more parameters of the first line.
/// - `counters`: the number of counters; by default one.
/// - `ends`: the terminations; by default the game does not end.
/// - `play`: the level, the keys (`u`, `d`, `l`, `r`, `s` for use, `.` for no key) and the result in the
///   format of [`shown`].
///
/// Lines that start with `#` give the reading that an episode rules out.
const FILES: [&str; 4] = [
    include_str!("effects.txt"),
    include_str!("sprites.txt"),
    include_str!("course.txt"),
    include_str!("endings.txt"),
];

/// A sentence, and the episodes that test it.
#[derive(Default)]
struct Row {
    of: Vec<&'static str>,
    says: &'static str,
    sprites: &'static str,
    rules: &'static str,
    counters: &'static str,
    header: &'static str,
    only: &'static str,
    ends: &'static str,
    /// The level, the keys and the result of each episode.
    plays: Vec<[&'static str; 3]>,
}

fn rows() -> impl Iterator<Item = Row> {
    FILES.iter().flat_map(|file| file.split("\n\n")).map(row).filter(|row| !row.of.is_empty())
}

fn row(text: &'static str) -> Row {
    let mut row = Row::default();
    for line in text.lines().filter(|line| !line.starts_with('#') && !line.is_empty()) {
        match line.split_once(": ").filter(|_| line.starts_with("  ")) {
            Some(("  says", says)) => row.says = says,
            Some(("  sprites", sprites)) => row.sprites = sprites,
            Some(("  rules", rules)) => row.rules = rules,
            Some(("  only", only)) => row.only = only,
            Some(("  header", header)) => row.header = header,
            Some(("  counters", counters)) => row.counters = counters,
            Some(("  ends", ends)) => row.ends = ends,
            Some(("  play", play)) => {
                let parts: Vec<&str> = play.split(" | ").collect();
                row.plays.push(parts.try_into().unwrap_or_else(|_| panic!("{line}")));
            }
            Some(_) => panic!("{line}"),
            None => row.of.push(line),
        }
    }
    row
}

/// Each sentence is part of the description, and each episode ends as the row says.
#[test]
fn sentences_hold_in_play() {
    let mut problems = String::new();
    for row in rows() {
        let game = match game(&row) {
            Ok(game) => game,
            Err(problem) => {
                problems += &problem;
                continue;
            }
        };
        let text = describe(&game);
        if !text.lines().any(|line| line.trim() == row.says) {
            _ = writeln!(problems, "not said: {}\nbut:\n{text}", row.says);
        }
        for template in &row.of {
            if !templates::fits(template, row.says) {
                _ = writeln!(problems, "`{}` is not made from `{template}`", row.says);
            }
        }
        for [level, keys, expected] in row.plays {
            let seen = play(&game, level, keys);
            if seen != expected {
                _ = writeln!(problems, "{}\n  play: {level} | {keys} | {seen}\n  not {expected}", row.says);
            }
        }
    }
    assert!(problems.is_empty(), "{problems}");
}

/// Returns the game of a row. Its levels have cells of 10 pixels.
fn game(row: &Row) -> Result<Game, String> {
    let mut types: Vec<&str> = row.sprites.split("; ").filter(|line| !line.trim().is_empty()).collect();
    if !row.sprites.contains("Avatar") {
        types.push("avatar > MovingAvatar");
    }
    let mut mapping = String::new();
    let mapped = |name: &str| row.only.is_empty() || row.only.split(' ').any(|only| only == name);
    for line in &types {
        let (name, class) = line.trim().split_once('>').unwrap_or((line, ""));
        let name = name.trim();
        if class.contains("Avatar") && !mapping.contains("A > ") {
            _ = writeln!(mapping, "    A > {name}");
        } else if !class.trim().is_empty() && mapped(name) {
            _ = writeln!(mapping, "    {} > {name}", &name[..1]);
        }
    }
    let indented =
        |lines: &str| lines.split(';').map(|line| format!("    {}\n", line.trim())).collect::<String>();
    let sprites: String = types.iter().map(|line| format!("    {line}\n")).collect();
    let ends = if row.ends.is_empty() { "Timeout limit=99 win=False" } else { row.ends };
    let source = format!(
        "BasicGame square_size=10 {} no_counters={}\n  SpriteSet\n{sprites}  LevelMapping\n{mapping}  InteractionSet\n{}  TerminationSet\n{}",
        row.header,
        if row.counters.is_empty() { "1" } else { row.counters },
        indented(row.rules),
        indented(ends),
    );
    Game::from_source(&source).map_err(|problems| format!("{source}\n{problems}"))
}

fn play(game: &Game, level: &str, keys: &str) -> String {
    let level = game
        .level(&level.replace('/', "\n").replace('.', " "))
        .unwrap_or_else(|problems| panic!("{level}\n{problems}"));
    let mut state = game.start(&level, Seed::from_text("sentences"));
    for key in keys.chars() {
        let action = match key {
            'u' => Action::Up,
            'd' => Action::Down,
            'l' => Action::Left,
            'r' => Action::Right,
            's' => Action::Use,
            _ => Action::Nil,
        };
        game.step(&mut state, action);
    }
    shown(game, &state, level.columns())
}

/// Returns the board as first letters, with `/` between rows, followed by `+2` for a score, `k3` for the
/// avatar's resources, and the outcome. Empty cells are dots. A sprite between two cells is in both cells,
/// and a dead avatar is `x`.
fn shown(game: &Game, state: &State, columns: usize) -> String {
    let seen = game.observe(state);
    let mut board = vec![vec!['.'; columns]; seen.rows];
    let mut records = game.records(state);
    records.sort_by_key(|record| (record.flags & 2, record.id));
    let mut told = String::new();
    for record in records {
        let name = game.name(game.sprite_types().nth(usize::from(record.stype)).expect("a type"));
        let is_avatar = record.flags & 2 != 0;
        let letter = match name.chars().next() {
            _ if is_avatar && record.flags & 1 != 0 => 'x',
            _ if is_avatar => 'A',
            letter => letter.unwrap_or('?'),
        };
        let rect = record.rect;
        let cells = |from: i32, size: i32| from.div_euclid(10)..=(from + size - 1).div_euclid(10);
        for row in cells(rect.y, rect.h) {
            for column in cells(rect.x, rect.w) {
                let cell = usize::try_from(row).ok().and_then(|row| board.get_mut(row));
                if let Some(cell) = cell.and_then(|row| row.get_mut(usize::try_from(column).ok()?)) {
                    *cell = letter;
                }
            }
        }
        if is_avatar {
            for (resource, amount) in record.resources {
                let name = game.name(game.sprite_types().nth(usize::from(resource)).expect("a type"));
                _ = write!(told, " {}{amount}", &name[..1]);
            }
            if record.health != 0 {
                _ = write!(told, " h{}", record.health);
            }
        }
    }
    let rows: Vec<String> = board.into_iter().map(|row| row.into_iter().collect()).collect();
    let score = if seen.score == 0.0 { String::new() } else { format!(" {:+}", seen.score) };
    let outcome = match state.outcome() {
        Outcome::Ongoing => String::new(),
        outcome => format!(" {outcome:?}"),
    };
    format!("{}{score}{told}{outcome}", rows.join("/"))
}
