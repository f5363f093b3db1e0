//! Normalises an answer's text: removes the reasoning, and maps all variants of a symbol to one spelling.

use super::read::pattern;
use regex::Regex;
use std::sync::LazyLock;

/// The tag names that models use for their reasoning.
const REASONING: &str =
    "(?:seed:)?(?:think|thinking|thought|thoughts|reasoning|analysis|scratchpad|reflection)";

/// The end of the reasoning: a closing tag, or the marker of gpt-oss's final channel.
static CLOSING: LazyLock<Regex> = LazyLock::new(|| {
    pattern(&format!(
        r"(?i)</{REASONING}>|\[/think\]|◁/think▷|<\|end_thinking\|>|<\|end_of_thought\|>|<\|channel\|>final[^<\n]{{0,40}}<\|message\|>"
    ))
});

static OPENING: LazyLock<Regex> = LazyLock::new(|| {
    pattern(&format!(
        r"(?i)<{REASONING}>|\[think\]|◁think▷|<\|start_thinking\|>|<\|begin_of_thought\|>|<\|channel\|>(?:analysis|commentary)"
    ))
});

/// LaTeX commands that change only the appearance of a word.
static LATEX: LazyLock<Regex> =
    LazyLock::new(|| pattern(r"\\(?:text(?:bf|tt|it|rm)?|math(?:bf|tt|it|rm))\{"));

/// Returns an answer without its reasoning. Drops all text before the last closing tag, and all text after an
/// unclosed opening tag. Cost: O(bytes).
pub fn without_reasoning(text: &str) -> &str {
    let end = CLOSING.find_iter(text).last().map_or(0, |tag| tag.end());
    let rest = &text[end..];
    OPENING.find(rest).map_or(rest, |tag| &rest[..tag.start()])
}

/// Removes zero-width characters from a text, and converts spaces, quotation marks and full-width characters
/// to ASCII.
pub(super) fn folded(text: &str) -> String {
    let fold = |c: char| {
        Some(match c {
            '\u{a0}' | '\u{2000}'..='\u{200a}' | '\u{202f}' | '\u{205f}' | '\u{3000}' => ' ',
            '\u{85}' | '\u{2028}' | '\u{2029}' => '\n',
            '\u{ad}' | '\u{200b}'..='\u{200f}' | '\u{2060}'..='\u{2064}' | '\u{fe0f}' | '\u{feff}' => {
                return None;
            }
            '\u{ff01}'..='\u{ff5e}' => char::from_u32(u32::from(c) - 0xfee0)?,
            '“' | '”' | '„' | '«' | '»' => '"',
            '‘' | '’' => '\'',
            '【' | '「' => '[',
            '】' | '」' => ']',
            '。' => '.',
            '、' => ',',
            '∶' | '꞉' => ':',
            other => other,
        })
    };
    let text: String = text.chars().filter_map(fold).collect();
    LATEX.replace_all(&text, "{").into_owned()
}

/// Returns the last character boundary at or before `at`.
pub(crate) fn boundary(text: &str, at: usize) -> usize {
    (0..=at.min(text.len())).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0)
}
