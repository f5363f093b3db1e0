//! Text positions in the units that pages use: UTF-16 code units from 0, and lines and columns from 1.

use editor::Problem;
use editor::positions::utf16_of_byte;
use engine::{Diagnostic, Edit, Span, line_and_column};
use serde_json::{Value, json};

/// Returns a span's range in UTF-16 code units.
pub(crate) fn range(text: &str, span: Span) -> (usize, usize) {
    (utf16_of_byte(text, span.start), utf16_of_byte(text, span.end))
}

/// Returns an edit in the page's format.
pub(crate) fn edit(text: &str, edit: &Edit) -> Value {
    let (start, end) = range(text, edit.span);
    json!({ "start": start, "end": end, "text": edit.text })
}

/// Returns a problem with its fixes, in the page's format.
pub(crate) fn problem(text: &str, diagnostic: &Diagnostic) -> Value {
    let Problem { code, severity, message, label, help, span, fixes } = Problem::of(diagnostic.clone(), text);
    let (start, end) = range(text, span);
    let (line, column) = line_and_column(text, span.start);
    let fixes = fixes.iter().map(|fix| {
        let edits: Vec<Value> = fix.edits.iter().map(|made| edit(text, made)).collect();
        json!({ "title": fix.title, "edits": edits })
    });
    let fixes: Vec<Value> = fixes.collect();
    json!({
        "code": code, "severity": severity, "message": message, "label": label, "help": help,
        "start": start, "end": end, "line": line, "column": column, "fixes": fixes, "page": code,
    })
}
