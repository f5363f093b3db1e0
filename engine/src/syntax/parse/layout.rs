//! The layout pass: splits a text into logical lines with their indents, and separates the comments (`spec/01` §1.1).

use crate::diagnostic::{Edit, Span};

/// The byte order mark, which some editors put at the start of a file.
pub(crate) const BYTE_ORDER_MARK: char = '\u{feff}';

/// A line that contains more than spaces and a comment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Line<'a> {
    /// The number of columns before the first character. A tab counts as one column.
    pub(crate) indent: usize,
    /// `true` if the indent contains a tab.
    pub(crate) tabbed: bool,
    /// The text, excluding indent, comment and trailing spaces.
    pub(crate) text: &'a str,
    /// The position of `text`.
    pub(crate) span: Span,
    /// The position of the whole line, without its terminator.
    pub(crate) whole: Span,
    /// The comment lines above the line.
    pub(crate) above: Vec<&'a str>,
    /// The comment at the end of the line, if there is one.
    pub(crate) beside: Option<&'a str>,
}

impl Line<'_> {
    /// Returns the position of the indent, whose characters are one byte each.
    pub(crate) fn indentation(&self) -> Span {
        Span::new(self.span.start - self.indent, self.span.start)
    }

    /// Returns an edit that indents the line by the given number of columns.
    pub(crate) fn indented(&self, columns: usize) -> Edit {
        Edit::new(self.indentation(), " ".repeat(columns))
    }

    /// Returns the position of a part of `text`.
    pub(crate) fn span_of(&self, part: &str) -> Span {
        let start = self.span.start + (part.as_ptr() as usize - self.text.as_ptr() as usize);
        Span::new(start, start + part.len())
    }
}

/// Returns the lines of `source`, and the comments below the last line. Terminators are `\n`, `\r\n` and `\r`.
pub(crate) fn lines(source: &str) -> (Vec<Line<'_>>, Vec<&str>) {
    let mut lines = Vec::new();
    let mut above = Vec::new();
    let mut start = 0;
    for raw in source.split(['\n', '\r']) {
        let (code, comment) = match raw.split_once('#') {
            Some((code, comment)) => (code, Some(comment.trim())),
            None => (raw, None),
        };
        // Some editors put a byte order mark at the start of the file.
        let code = code.strip_prefix(BYTE_ORDER_MARK).filter(|_| start == 0).unwrap_or(code);
        let text = code.trim_matches(|c: char| c <= ' ');
        if text.is_empty() {
            above.extend(comment);
        } else {
            let blanks = || code.chars().take_while(|&c| c <= ' ');
            let (indent, tabbed) = (blanks().count(), blanks().any(|c| c == '\t'));
            let at = start + (text.as_ptr() as usize - raw.as_ptr() as usize);
            let span = Span::new(at, at + text.len());
            lines.push(Line {
                indent,
                tabbed,
                text,
                span,
                whole: Span::new(start, start + raw.len()),
                above: std::mem::take(&mut above),
                beside: comment,
            });
        }
        start += raw.len() + 1;
    }
    (lines, above)
}

/// Finds the first line that consists only of `#` characters and starts in the first column; `None` if there is no such
/// line. The reference crashes on such a line (`spec/01` §1.1).
pub(crate) fn bare_hashes(source: &str) -> Option<Span> {
    let mut start = 0;
    source.split(['\n', '\r']).find_map(|raw| {
        let span = Span::new(start, start + raw.len());
        start = span.end + 1;
        (!raw.is_empty() && raw.bytes().all(|byte| byte == b'#')).then_some(span)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_indents_and_spans() {
        let source = "# top\r\nBasicGame # game\n\n\t a > B  \n# end";
        let (lines, tail) = lines(source);
        assert_eq!(lines.len(), 2);
        assert_eq!((lines[0].text, lines[0].indent), ("BasicGame", 0));
        assert_eq!((lines[0].above.as_slice(), lines[0].beside), (["top"].as_slice(), Some("game")));
        assert_eq!((lines[1].text, lines[1].indent), ("a > B", 2));
        assert_eq!(&source[lines[1].span.start..lines[1].span.end], "a > B");
        assert_eq!(tail, ["end"]);
    }
}
