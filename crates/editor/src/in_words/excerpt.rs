//! The lines around a problem, cropped to a readable width.

use engine::line_and_column;
use miette::{MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};

/// The maximum number of characters to show from a line.
const MAX_WIDTH: usize = 160;
/// The number of characters to keep before the problem's position if the line is cropped on the left.
const BEFORE: usize = 40;
/// The replacement for omitted characters.
const CUT: char = '…';
/// The replacement for a tab, which counts as one column.
const TAB: char = '→';

/// The line with a problem and the lines above and below it, cropped around the problem's position. Tabs are made
/// visible.
pub(super) struct Excerpt {
    name: String,
    text: String,
    /// The index of the first line of `text` in the file.
    first: usize,
    /// The number of lines in `text`.
    count: usize,
    /// The problem's line in the file, counted from 0.
    line: usize,
    /// The problem's column in the file, counted from 0.
    column: usize,
    /// The start of the problem in `text`, and its length.
    span: (usize, usize),
}

impl Excerpt {
    /// Creates the excerpt around the bytes `start..end` of a text. If a problem spans several lines, only
    /// the part on the first line is marked.
    pub(super) fn of(name: &str, source: &str, start: usize, end: usize) -> Excerpt {
        let boundary = |mut at: usize| {
            at = at.min(source.len());
            while !source.is_char_boundary(at) {
                at -= 1;
            }
            at
        };
        let start = boundary(start);
        let end = boundary(end).max(start);
        let (line, column) = line_and_column(source, start);
        let mut excerpt = Excerpt {
            name: name.to_owned(),
            text: String::new(),
            first: line.saturating_sub(2),
            count: 0,
            line: line - 1,
            column: column - 1,
            span: (0, 0),
        };
        let from = source[..start].rfind('\n').map_or(0, |newline| newline + 1);
        let to = source[start..].find('\n').map_or(source.len(), |newline| start + newline);
        if from > 0 {
            let above = source[..from - 1].rfind('\n').map_or(0, |newline| newline + 1);
            excerpt.push(&source[above..from - 1], 0);
        }
        let marked = source[start..end.min(to)].chars().count();
        let shown = excerpt.push(&source[from..to], column - 1);
        // The length covers the visible characters of the line from the position onwards.
        let visible = excerpt.text[shown..].trim_end_matches('\n');
        let length = visible.chars().take(marked).map(char::len_utf8).sum();
        excerpt.span = (shown, length);
        if to < source.len() {
            let below = source[to + 1..].find('\n').map_or(source.len(), |newline| to + 1 + newline);
            if below > to + 1 {
                excerpt.push(&source[to + 1..below], 0);
            }
        }
        excerpt
    }

    /// Adds a line, cropped around a column. Returns the position of that column in the text.
    fn push(&mut self, line: &str, column: usize) -> usize {
        let line = line.strip_suffix('\r').unwrap_or(line);
        let skipped = if column >= MAX_WIDTH - BEFORE { column - BEFORE } else { 0 };
        if skipped > 0 {
            self.text.push(CUT);
        }
        let mut place = None;
        let mut rest = line.chars().skip(skipped);
        for at in skipped..skipped + MAX_WIDTH {
            if at == column {
                place = Some(self.text.len());
            }
            let Some(character) = rest.next() else { break };
            self.text.push(match character {
                '\t' => TAB,
                character if character.is_control() => '\u{fffd}',
                character => character,
            });
        }
        if rest.next().is_some() {
            self.text.push(CUT);
        }
        let place = place.unwrap_or(self.text.len());
        self.text.push('\n');
        self.count += 1;
        place
    }

    /// Returns the problem's position within the displayed text.
    pub(super) fn span(&self) -> SourceSpan {
        self.span.into()
    }
}

impl SourceCode for Excerpt {
    /// Returns the whole excerpt, or the problem's position if no context lines are requested.
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        before: usize,
        _after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let name = self.name.clone();
        Ok(Box::new(match before {
            0 => {
                let data = self.text.as_bytes().get(span.offset()..span.offset() + span.len());
                let data = data.ok_or(MietteError::OutOfBounds)?;
                MietteSpanContents::new_named(name, data, *span, self.line, self.column, 1)
            }
            _ => {
                let all = (0, self.text.len()).into();
                MietteSpanContents::new_named(name, self.text.as_bytes(), all, self.first, 0, self.count)
            }
        }))
    }
}
