//! The parser's limits: texts that are not games, overlong lines and names, and sprites nested too deeply.

use super::layout::Line;
use crate::diagnostic::{Diagnostic, Span};
use crate::limits::{MAX_LINE, MAX_NAME, MAX_NESTING, MAX_SOURCE};
use crate::syntax::description::Word;

/// Returns the diagnostic for a text that cannot be read as a game, if any.
pub(crate) fn unreadable(source: &str) -> Option<Diagnostic> {
    if source.len() > MAX_SOURCE {
        let message = format!("the game is {} bytes long; the limit is {MAX_SOURCE}", source.len());
        let problem = Diagnostic::error("too-large", Span::new(0, 0), message);
        return Some(problem.help("is this a VGDL file?"));
    }
    let is_no_text = |c: char| c.is_control() && !"\t\n\r\u{b}\u{c}".contains(c);
    let (at, c) = source.char_indices().find(|&(_, c)| is_no_text(c))?;
    let message = format!("the file contains the control character `{}`", c.escape_default());
    let problem = Diagnostic::error("not-text", Span::new(at, at + c.len_utf8()), message);
    let problem =
        problem.help("remove the character, or check that this is a VGDL file, which is plain text");
    Some(problem.remove(Span::new(at, at + c.len_utf8()), &c.escape_default().to_string()))
}

/// Returns the diagnostic for an overlong line; `None` if the line is short enough.
pub(crate) fn long_line(line: &Line<'_>) -> Option<Diagnostic> {
    let length = line.text.len();
    let message = format!("this line is {length} bytes long; the limit is {MAX_LINE}");
    let problem = Diagnostic::error("too-long", line.span, message).help("is this a VGDL file?");
    (length > MAX_LINE).then_some(problem)
}

/// Returns the diagnostic for an overlong sprite name; `None` if the name is short enough.
pub(crate) fn long_name(name: &Word) -> Option<Diagnostic> {
    let length = name.text.len();
    let message = format!("this name is {length} bytes long; the limit is {MAX_NAME}");
    let problem = Diagnostic::error("too-long", name.span, message).help("choose a shorter name");
    (length > MAX_NAME).then_some(problem)
}

/// Returns the diagnostic for sprites nested too deeply.
pub(crate) fn too_deep(line: &Line<'_>) -> Diagnostic {
    let message = format!("sprites are nested more than {MAX_NESTING} deep");
    let problem = Diagnostic::error("too-deep", line.span, message);
    problem.help("indent siblings by the same amount: a line that is indented deeper is a subtype")
}
