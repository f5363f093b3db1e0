//! Python files that contain a game, and often its levels, as triple-quoted strings.

use crate::syntax::{self, Section};
use std::collections::BTreeSet;

/// The first game of a Python file, and its levels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PythonFile {
    /// The game, preceded by one empty line for each line before it in the file, so that its line numbers
    /// match those of the file.
    pub game: String,
    /// The line with the game's opening quotes.
    pub line: usize,
    /// The levels, in file order.
    pub levels: Vec<String>,
    /// The lines with the opening quotes of further games.
    pub others: Vec<usize>,
}

/// A triple-quoted string.
struct Quoted {
    line: usize,
    text: String,
}

/// Returns the games in a Python file's strings, or `None` if there is no game.
pub fn python_file(source: &str) -> Option<PythonFile> {
    let (games, others): (Vec<Quoted>, Vec<Quoted>) =
        quoted(source).into_iter().partition(|quoted| is_game(&quoted.text));
    let (first, further) = games.split_first()?;
    let game = format!("{}{}", "\n".repeat(first.line - 1), first.text);
    let (description, _) = syntax::parse(&game);
    let symbols: BTreeSet<char> =
        description.mapping.iter().map(|line| line.symbol).chain(['w', 'A', ' ']).collect();
    let rows = |text: &str| -> String {
        text.lines().map(str::trim_end).filter(|row| !row.is_empty()).map(|row| format!("{row}\n")).collect()
    };
    let levels = others.iter().map(|quoted| rows(&quoted.text));
    let is_level =
        |text: &String| !text.is_empty() && text.chars().all(|c| c == '\n' || symbols.contains(&c));
    let levels = levels.filter(is_level).collect();
    Some(PythonFile {
        game,
        line: first.line,
        levels,
        others: further.iter().map(|quoted| quoted.line).collect(),
    })
}

/// Returns `true` if a text contains at least two section names, each on a line of its own.
fn is_game(text: &str) -> bool {
    let is_name = |line: &&str| Section::ALL.iter().any(|section| section.name() == line.trim());
    text.lines().filter(is_name).count() > 1
}

/// Returns the triple-quoted strings, with the escapes that occur in games and levels resolved.
fn quoted(source: &str) -> Vec<Quoted> {
    let mut found = Vec::new();
    let (mut rest, mut line) = (source, 1);
    while let Some(at) = rest.find(['#', '"', '\'']) {
        line += rest[..at].matches('\n').count();
        let is_raw = rest[..at].ends_with(['r', 'R']);
        rest = &rest[at..];
        let mark = ["\"\"\"", "'''"].into_iter().find(|mark| rest.starts_with(mark));
        let Some(mark) = mark else {
            // Skip a comment or a single-line string.
            let quote = &rest[..1];
            let end = rest.find('\n').unwrap_or(rest.len());
            let closing = |body: &str| {
                let mut escaped = false;
                body.find(|c: char| {
                    let ends = !escaped && quote.starts_with(c);
                    escaped = !escaped && c == '\\';
                    ends
                })
            };
            let end = match quote {
                "#" => end,
                _ => closing(&rest[1..end]).map_or(end, |at| at + 2),
            };
            rest = &rest[end..];
            continue;
        };
        let body = &rest[mark.len()..];
        let end = body.find(mark).unwrap_or(body.len());
        let text = match is_raw {
            true => body[..end].to_owned(),
            // A line continuation keeps its newline, so that the numbers of later lines stay the same.
            false => body[..end].replace("\\\r\n", "\n").replace("\\\n", "\n").replace("\\\\", "\\"),
        };
        found.push(Quoted { line, text });
        line += body[..end].matches('\n').count();
        rest = body.get(end + mark.len()..).unwrap_or_default();
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    const GAME: &str =
        "BasicGame\n    SpriteSet\n        a > MovingAvatar\n    LevelMapping\n        \\\\ > a\n";

    #[test]
    fn games_and_levels_are_found_in_strings() {
        let source = format!(
            "# it's \"\"\"no string\"\"\"\n'''A file.'''\nx = 'a\\'\"\"\"'\nlevel = \"\"\"\nww\nw\\\\\n\n\"\"\"\ngame = r'''{GAME}'''\ngame = \"\"\"\\\n{GAME}\"\"\"\n"
        );
        let file = python_file(&source).unwrap();
        assert_eq!((file.line, &file.others[..]), (9, &[15][..]));
        assert_eq!(file.game.lines().nth(8), Some("BasicGame"));
        assert!(file.game.contains("\\\\ > a"), "a raw string keeps its escapes");
        let plain = python_file(&source.replace("r'''", "'''")).unwrap();
        assert_eq!(plain.levels, ["ww\nw\\\n"]);
    }

    #[test]
    fn any_text_is_read() {
        for source in ["", "\"", "'''", "\"\"\"\"", "#", "'\\", "\"\"\"\\", GAME, "r'''é"] {
            assert_eq!(python_file(source), None, "{source}");
        }
        assert!(python_file(&format!("'''{GAME}")).is_some());
    }
}
