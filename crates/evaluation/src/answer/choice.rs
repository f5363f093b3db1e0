//! Reads answers to single-turn questions: a word from a list, or a board.

use super::read::{pattern, quoted};
use super::text::folded;
use super::{Reading, Stage, without_reasoning};
use itertools::Itertools;
use regex::Regex;
use std::sync::LazyLock;

/// The start of an answer in a player's text: a tag, `\boxed{`, or a word such as "answer" followed by a punctuation
/// mark or "is".
static MARK: LazyLock<Regex> = LazyLock::new(|| {
    pattern(
        r#"(?i)(?:<\|?(?:final[_ ]?)?answer\|?>|\\boxed\{|(?-u:\b)(?:answer|choice|option)["'*`_]{0,3}[ \t]{0,4}(?:[:=]|->|→|⇒|is(?-u:\b)))"#,
    )
});

/// The first word of an answer, after optional quotes, brackets and the word "option" or "board".
static WORD: LazyLock<Regex> = LazyLock::new(|| {
    pattern(
        r#"(?i)^[\s*`"'(\[{_$<:]{0,9}(?:(?:option|board)[ \t*`"'(\[]{1,5})?(?P<word>[a-z0-9]+)(?P<rest>[^\n]*)"#,
    )
});

/// A word alone on a line.
static ALONE: LazyLock<Regex> =
    LazyLock::new(|| pattern(r#"(?i)^[ \t*`"'(\[{_$]*(?P<word>[a-z]+)[ \t*`"'.!)\]}_$]*$"#));

/// Reads an answer that is one of `words`, such as `yes` and `no`, and returns the word's index. The requested format
/// is a last line such as `ANSWER: yes`. If the text has several such lines, the last one counts. If it has none, a
/// word alone on the last line counts. Single letters must be upper-case unless a word such as "answer" introduces
/// them. Cost: O(bytes).
pub fn read_choice(text: &str, words: &[&str]) -> Reading<usize> {
    let said = without_reasoning(text).trim();
    let Some(last) = said.lines().next_back() else {
        return Reading::Invalid { why: "it is empty".to_owned() };
    };
    let strict = last.strip_prefix("ANSWER: ").and_then(|word| words.iter().position(|known| *known == word));
    if let Some(choice) = strict {
        return Reading::Strict(choice);
    }
    let said = folded(said);
    let Some((word, rest, stage)) = stated(&said, words) else {
        return Reading::Invalid { why: "it names no answer".to_owned() };
    };
    let Some(choice) = words.iter().position(|known| known.eq_ignore_ascii_case(word)) else {
        return Reading::Invalid { why: format!("`{}` is not among the answers", quoted(word)) };
    };
    // The letter `a` can be an article, so a single letter in the rest of the line counts only if it is upper-case.
    let is_other = |other: &str| {
        let is_like =
            |known: &&str| known.eq_ignore_ascii_case(other) && (other.len() > 1 || *known == other);
        words.iter().position(is_like).is_some_and(|other| other != choice)
    };
    if rest.split(|c: char| !c.is_alphanumeric()).any(is_other) {
        return Reading::Invalid { why: "it names several answers".to_owned() };
    }
    Reading::Tolerant { choice, stage }
}

/// Returns the word that an answer states, the rest of its line, and the rule that found it.
fn stated<'a>(said: &'a str, words: &[&str]) -> Option<(&'a str, &'a str, Stage)> {
    if let Some(mark) = MARK.find_iter(said).last() {
        let found = WORD.captures(&said[mark.end()..])?;
        return Some((found.name("word")?.as_str(), found.name("rest")?.as_str(), Stage::Marker));
    }
    let word = ALONE.captures(said.lines().next_back()?)?.name("word")?.as_str();
    (word.len() > 1 || words.contains(&word)).then_some((word, "", Stage::Words))
}

/// Reads a board of the given size: the last sequence of lines with `columns` characters each, which must have `rows`
/// lines. The requested format is `ANSWER:` followed by the board. Spaces between characters, and lines around the
/// board, are ignored. Returns the board with one line per row. Cost: O(bytes).
pub fn read_board(text: &str, columns: usize, rows: usize) -> Reading<String> {
    let said = without_reasoning(text).trim();
    let mark = MARK.find_iter(said).last();
    let said = mark.map_or(said, |mark| &said[mark.end()..]);
    let packed = |line: &str| line.chars().filter(|c| !c.is_whitespace()).collect::<String>();
    let lines: Vec<String> = said.lines().map(packed).collect();
    let is_row = |line: &&String| line.chars().count() == columns && !line.starts_with("```");
    let runs = lines.iter().chunk_by(is_row);
    let runs: Vec<Vec<&String>> =
        runs.into_iter().filter(|(is_row, _)| *is_row).map(|(_, run)| run.collect()).collect();
    match runs.last() {
        Some(run) if run.len() == rows => {
            let board = run.iter().join("\n");
            match mark {
                Some(_) if said.trim() == board => Reading::Strict(board),
                Some(_) => Reading::Tolerant { choice: board, stage: Stage::Marker },
                None => Reading::Tolerant { choice: board, stage: Stage::Words },
            }
        }
        _ => Reading::Invalid { why: format!("it contains no board of {columns} columns and {rows} rows") },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LETTERS: [&str; 4] = ["A", "B", "C", "D"];

    #[test]
    fn letters_are_read_in_many_forms() {
        for text in [
            "ANSWER: B",
            "I think so.\n**ANSWER: B**",
            "answer: b",
            "The answer is (B).",
            "<answer>B</answer>",
            "\\boxed{B}",
            "{\"answer\": \"B\"}",
            "Not A.\nANSWER: B because a wall is there",
            "B",
            "(B)",
            "Final answer: Option B.",
            "<think>ANSWER: A</think>\nANSWER: B",
            "ANSWER: A\nWait.\nANSWER: B",
            "ANSWER:\nB",
        ] {
            assert_eq!(read_choice(text, &LETTERS).choice(), Some(1), "{text}");
        }
        for text in [
            "",
            "ANSWER: A or B",
            "ANSWER: E",
            "a",
            "The answer is not B.",
            "I do not know.",
            "<think>ANSWER: B</think>",
        ] {
            assert_eq!(read_choice(text, &LETTERS).choice(), None, "{text}");
        }
        assert_eq!(read_choice("ANSWER: B", &LETTERS), Reading::Strict(1));
        assert_eq!(read_choice("Yes.", &["yes", "no"]).choice(), Some(0));
        assert_eq!(read_choice("ANSWER: No, it cannot.", &["yes", "no"]).choice(), Some(1));
        assert_eq!(read_choice("ANSWER: yes and no", &["yes", "no"]).choice(), None);
    }

    #[test]
    fn boards_are_read_in_many_forms() {
        let board = "ww@\nw.w";
        for text in [
            "ANSWER:\nww@\nw.w",
            "ANSWER: ww@\nw.w",
            "So:\n```\nww@\nw.w\n```",
            "ANSWER:\n```text\nw w @\nw . w\n```\n",
            "www\nw@w\n\nANSWER:\r\nww@\r\nw.w\r\n",
        ] {
            assert_eq!(read_board(text, 3, 2).choice().as_deref(), Some(board), "{text}");
        }
        assert_eq!(read_board("ANSWER:\nww@\nw.w", 3, 2), Reading::Strict(board.to_owned()));
        for text in ["", "ANSWER:\nww@", "ANSWER:\nww@\nw.w\nwww", "ANSWER: A"] {
            assert_eq!(read_board(text, 3, 2).choice(), None, "{text}");
        }
    }
}
