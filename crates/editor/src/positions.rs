//! Positions in the units that editors use: UTF-16 code units instead of bytes, or lines and columns.

/// The unit in which columns are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// UTF-8 bytes.
    Byte,
    /// UTF-16 code units, as in JavaScript and the Language Server Protocol.
    Utf16,
}

impl Unit {
    fn of(self, c: char) -> usize {
        match self {
            Unit::Byte => c.len_utf8(),
            Unit::Utf16 => c.len_utf16(),
        }
    }

    fn length(self, text: &str) -> usize {
        match self {
            Unit::Byte => text.len(),
            Unit::Utf16 => text.encode_utf16().count(),
        }
    }

    /// Returns the byte offset that is `count` units after the start of `text`. The offset is at most the
    /// text's length, and never inside a character.
    fn byte(self, text: &str, count: usize) -> usize {
        let mut passed = 0;
        for (at, c) in text.char_indices() {
            passed += self.of(c);
            if passed > count {
                return at;
            }
        }
        text.len()
    }
}

/// Returns the number of UTF-16 code units before byte `at`.
pub fn utf16_of_byte(text: &str, at: usize) -> usize {
    Unit::Utf16.length(&text[..boundary(text, at)])
}

/// Returns the byte offset of the UTF-16 code unit `at`. The offset is at most the text's length, and never inside a
/// character.
pub fn byte_of_utf16(text: &str, at: usize) -> usize {
    Unit::Utf16.byte(text, at)
}

/// Returns the start of the character that contains byte `at`, or the end of the text if `at` is beyond it.
fn boundary(text: &str, at: usize) -> usize {
    let at = at.min(text.len());
    (0..=at).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0)
}

/// A line and a column, both counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Position {
    /// The line, counted from 0.
    pub line: usize,
    /// The column, counted from 0 in the chosen [`Unit`].
    pub column: usize,
}

/// The lines of a text, for converting between bytes and positions. Terminators are `\n`, `\r\n` and `\r`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lines {
    /// The offset of the first byte of each line.
    starts: Vec<usize>,
}

impl Lines {
    /// Finds the lines in a text. Cost: linear in the text's length.
    pub fn of(text: &str) -> Lines {
        let bytes = text.as_bytes();
        let mut starts = vec![0];
        for (at, &byte) in bytes.iter().enumerate() {
            if byte == b'\n' || byte == b'\r' && bytes.get(at + 1) != Some(&b'\n') {
                starts.push(at + 1);
            }
        }
        Lines { starts }
    }

    /// Returns the number of lines, which is at least one.
    pub fn count(&self) -> usize {
        self.starts.len()
    }

    /// Returns the position of byte `at` in the text.
    pub fn position(&self, text: &str, at: usize, unit: Unit) -> Position {
        let at = boundary(text, at);
        let line = self.starts.partition_point(|&start| start <= at).saturating_sub(1);
        Position { line, column: unit.length(&text[self.starts[line]..at]) }
    }

    /// Returns the byte offset of a position in the text. A column beyond the end of the line counts as the end of
    /// the line, and a line beyond the last one counts as the end of the text.
    pub fn byte(&self, text: &str, position: Position, unit: Unit) -> usize {
        let Some(&start) = self.starts.get(position.line) else { return text.len() };
        let end = self.starts.get(position.line + 1).copied().unwrap_or(text.len());
        let line = text[start..end].trim_end_matches(['\n', '\r']);
        start + unit.byte(line, position.column)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "a😀é\r\nb\rc\n";

    #[test]
    fn places_convert_there_and_back() {
        for (at, _) in TEXT.char_indices().chain([(TEXT.len(), ' ')]) {
            assert_eq!(byte_of_utf16(TEXT, utf16_of_byte(TEXT, at)), at);
            for unit in [Unit::Byte, Unit::Utf16] {
                let lines = Lines::of(TEXT);
                let position = lines.position(TEXT, at, unit);
                // A position between `\r` and `\n` is mapped to the position before the `\r`.
                let back = lines.byte(TEXT, position, unit);
                assert!(back == at || TEXT.as_bytes()[at - 1] == b'\r', "{at} {position:?} {back}");
            }
        }
    }

    #[test]
    fn columns_are_counted_in_units() {
        let lines = Lines::of(TEXT);
        assert_eq!(lines.count(), 4);
        let at = TEXT.find('é').unwrap();
        assert_eq!(lines.position(TEXT, at, Unit::Utf16), Position { line: 0, column: 3 });
        assert_eq!(lines.position(TEXT, at, Unit::Byte), Position { line: 0, column: 5 });
        assert_eq!(
            lines.position(TEXT, TEXT.find('c').unwrap(), Unit::Byte),
            Position { line: 2, column: 0 }
        );
        assert_eq!(lines.byte(TEXT, Position { line: 0, column: 99 }, Unit::Utf16), at + 2);
        assert_eq!(lines.byte(TEXT, Position { line: 9, column: 0 }, Unit::Utf16), TEXT.len());
        // The position is inside a surrogate pair, or inside a character.
        assert_eq!(lines.byte(TEXT, Position { line: 0, column: 2 }, Unit::Utf16), 1);
        assert_eq!(lines.byte(TEXT, Position { line: 0, column: 3 }, Unit::Byte), 1);
    }
}
