//! Positions in texts as a page counts them: UTF-16 code units from 0, lines and columns from 1.

use engine::{Diagnostic, Span, line_and_column};
use serde_json::{Value, json};

/// Returns the number of UTF-16 code units before a byte. Cost: O(offset).
pub(crate) fn units(text: &str, byte: usize) -> usize {
    let mut end = byte.min(text.len());
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    text[..end].encode_utf16().count()
}

/// Returns the range of a span in UTF-16 code units.
pub(crate) fn range(text: &str, span: Span) -> (usize, usize) {
    (units(text, span.start), units(text, span.end))
}

/// Returns a problem as the page shows it.
pub(crate) fn problem(text: &str, diagnostic: &Diagnostic) -> Value {
    let (start, end) = range(text, diagnostic.span);
    let (line, column) = line_and_column(text, diagnostic.span.start);
    json!({
        "code": diagnostic.code,
        "severity": diagnostic.severity,
        "message": diagnostic.message,
        "label": diagnostic.label,
        "help": diagnostic.help,
        "start": start, "end": end, "line": line, "column": column,
        "fixes": [],
        "page": diagnostic.code,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_count_code_units() {
        let text = "aé😀b";
        let at = |part: &str| units(text, text.find(part).unwrap());
        assert_eq!([at("a"), at("é"), at("😀"), at("b"), units(text, 100)], [0, 1, 2, 4, 5]);
        // Inside a character: its start.
        assert_eq!(units(text, 5), 2);
    }
}
