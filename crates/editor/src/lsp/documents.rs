//! The open documents, and the files beside them.

use super::uri;
use crate::positions::{Lines, Position, Unit};
use engine::{MAX_LEVEL_TEXT, MAX_SOURCE, Span};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// A document's kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A game's text.
    Game,
    /// A level's text.
    Level,
    /// A document of any other kind.
    Other,
}

impl Kind {
    /// Returns a document's kind, based on its name and on the language, if the client specifies one.
    fn of(uri: &str, language: &str) -> Kind {
        let name = uri::path(uri).unwrap_or_else(|| PathBuf::from(uri));
        let name = name.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        match name {
            name if is_level(name) => Kind::Level,
            name if name.ends_with(".vgdl")
                || name.eq_ignore_ascii_case("game.txt")
                || language == "vgdl" =>
            {
                Kind::Game
            }
            _ => Kind::Other,
        }
    }
}

fn is_level(name: &str) -> bool {
    engine::layout::level_number(name).is_some()
}

/// A text and the positions of its lines.
#[derive(Clone, Debug)]
pub(super) struct Text {
    pub(super) text: String,
    lines: Lines,
}

impl Text {
    pub(super) fn new(text: String) -> Text {
        let lines = Lines::of(&text);
        Text { text, lines }
    }

    /// Returns the byte offset for a position in the protocol's format; `None` for a malformed position.
    pub(super) fn byte(&self, position: &Value, unit: Unit) -> Option<usize> {
        let count = |name: &str| {
            position.get(name)?.as_u64().map(|count| usize::try_from(count).unwrap_or(usize::MAX))
        };
        let position = Position { line: count("line")?, column: count("character")? };
        Some(self.lines.byte(&self.text, position, unit))
    }

    /// Converts a span of bytes to a range in the protocol's format.
    pub(super) fn range(&self, span: Span, unit: Unit) -> Value {
        let position = |at: usize| {
            let Position { line, column } = self.lines.position(&self.text, at, unit);
            json!({ "line": line, "character": column })
        };
        json!({ "start": position(span.start), "end": position(span.end) })
    }

    /// Converts a range in the protocol's format to a span of bytes; `None` for a malformed range.
    pub(super) fn span(&self, range: &Value, unit: Unit) -> Option<Span> {
        let (start, end) = (self.byte(range.get("start")?, unit)?, self.byte(range.get("end")?, unit)?);
        Some(Span::new(start.min(end), start.max(end)))
    }

    /// Applies a change in the protocol's format, which replaces a range or the whole text; `None` for a malformed
    /// change.
    fn change(&mut self, change: &Value, unit: Unit) -> Option<()> {
        let text = change.get("text")?.as_str()?;
        match change.get("range") {
            None | Some(Value::Null) => self.text = text.to_owned(),
            Some(range) => {
                let span = self.span(range, unit)?;
                self.text.replace_range(span.start..span.end, text);
            }
        }
        self.lines = Lines::of(&self.text);
        Some(())
    }
}

/// An open document.
#[derive(Clone, Debug)]
pub(super) struct Document {
    pub(super) kind: Kind,
    pub(super) text: Text,
    pub(super) version: Value,
    /// `true` if the document's problems need to be published again.
    pub(super) is_changed: bool,
}

/// The open documents by URI.
#[derive(Clone, Debug, Default)]
pub(super) struct Documents(pub(super) BTreeMap<String, Document>);

impl Documents {
    pub(super) fn open(&mut self, item: &Value) -> Option<()> {
        let uri = item.get("uri")?.as_str()?;
        let language = item.get("languageId").and_then(Value::as_str).unwrap_or_default();
        let text = Text::new(item.get("text")?.as_str()?.to_owned());
        let version = item.get("version").cloned().unwrap_or(Value::Null);
        let document = Document { kind: Kind::of(uri, language), text, version, is_changed: true };
        self.0.insert(uri.to_owned(), document);
        self.touch_levels(uri);
        Some(())
    }

    pub(super) fn change(&mut self, params: &Value, unit: Unit) -> Option<()> {
        let uri = params.pointer("/textDocument/uri")?.as_str()?;
        let document = self.0.get_mut(uri)?;
        for change in params.get("contentChanges")?.as_array()? {
            document.text.change(change, unit)?;
        }
        document.version = params.pointer("/textDocument/version").cloned().unwrap_or(Value::Null);
        document.is_changed = true;
        self.touch_levels(uri);
        Some(())
    }

    /// Marks a game's levels as changed.
    pub(super) fn touch_levels(&mut self, game: &str) {
        let folder = uri::path(game).and_then(|path| path.parent().map(Path::to_owned));
        let levels = self.0.iter_mut().filter(|(_, document)| document.kind == Kind::Level);
        for (level, document) in levels {
            let own = uri::path(level).and_then(|path| path.parent().map(Path::to_owned));
            document.is_changed |= own.is_some() && own == folder;
        }
    }

    /// Returns a level's game and the game's URI. The text comes from the open document if there is one, and
    /// otherwise from disk.
    pub(super) fn game_of(&self, level: &str) -> Option<(String, Text)> {
        let path = uri::path(level)?;
        let (folder, name) = (path.parent()?, path.file_name()?.to_str()?);
        let names = self.names_in(folder);
        let game = engine::layout::game_of(name, names.iter().map(String::as_str))?;
        self.text_at(&folder.join(game), MAX_SOURCE)
    }

    /// Returns a game's levels with their URIs, from open documents and from files on disk.
    pub(super) fn levels_of(&self, game: &str) -> Vec<(String, Text)> {
        let Some(path) = uri::path(game) else { return Vec::new() };
        let (Some(folder), Some(name)) = (path.parent(), path.file_name().and_then(|name| name.to_str()))
        else {
            return Vec::new();
        };
        let names = self.names_in(folder);
        let levels = engine::layout::levels(name, names.iter().map(String::as_str));
        levels.iter().filter_map(|(_, level)| self.text_at(&folder.join(level), MAX_LEVEL_TEXT)).collect()
    }

    /// Returns the names of the files in a folder that are open or on disk.
    fn names_in(&self, folder: &Path) -> BTreeSet<String> {
        let open =
            self.0.keys().filter_map(|uri| uri::path(uri)).filter(|path| path.parent() == Some(folder));
        let open = open.filter_map(|path| Some(path.file_name()?.to_str()?.to_owned()));
        let files = std::fs::read_dir(folder).into_iter().flatten().flatten();
        open.chain(files.filter_map(|entry| entry.file_name().into_string().ok())).collect()
    }

    /// Returns a file's text, from the open document if there is one, and otherwise from disk.
    fn text_at(&self, path: &Path, most: usize) -> Option<(String, Text)> {
        let open = self.0.iter().find(|(uri, _)| uri::path(uri).as_deref() == Some(path));
        if let Some((uri, document)) = open {
            return Some((uri.clone(), document.text.clone()));
        }
        // One byte more than the limit is read, so that a larger file is reported as too large.
        let bytes = disk::read_start(path, most as u64 + 1).ok()?;
        Some((uri::of_path(path), Text::new(String::from_utf8(bytes).ok()?)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn documents_are_told_apart_by_their_names() {
        for (uri, language, kind) in [
            ("file:///a/game.vgdl", "", Kind::Game),
            ("file:///a/game.txt", "plaintext", Kind::Game),
            ("file:///a/lvl12.txt", "vgdl", Kind::Level),
            ("file:///a/zelda_lvl2.txt", "", Kind::Level),
            ("file:///a/lvl.txt", "", Kind::Other),
            ("file:///a/notes.txt", "plaintext", Kind::Other),
            ("untitled:Untitled-1", "vgdl", Kind::Game),
            ("nonsense", "", Kind::Other),
        ] {
            assert_eq!(Kind::of(uri, language), kind, "{uri}");
        }
    }

    #[test]
    fn changes_are_made_in_order() {
        let mut text = Text::new("a😀b\n".to_owned());
        let range = |start: usize, end: usize| json!({ "start": { "line": 0, "character": start }, "end": { "line": 0, "character": end } });
        assert_eq!(text.change(&json!({ "range": range(1, 3), "text": "" }), Unit::Utf16), Some(()));
        assert_eq!(text.text, "ab\n");
        // The range is reversed and extends beyond the text.
        assert_eq!(text.change(&json!({ "range": range(99, 1), "text": "cd" }), Unit::Utf16), Some(()));
        assert_eq!(text.text, "acd\n");
        assert_eq!(text.change(&json!({ "text": "x" }), Unit::Byte), Some(()));
        assert_eq!(text.text, "x");
        assert_eq!(text.change(&json!({ "range": 5, "text": "x" }), Unit::Byte), None);
    }
}
