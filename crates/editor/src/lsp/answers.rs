//! Responses to requests about documents.

use super::documents::{Document, Documents, Kind, Text};
use crate::positions::Unit;
use crate::{
    Edit, Entry, EntryKind, Item, ItemKind, LevelRules, Problem, RenameError, Severity, Span, complete,
    definition, format, hover, level_definition, level_hover, outline, problems, references, renamable,
    rename, rename_in_level,
};
use serde_json::{Map, Value, json};
use std::fmt;

/// The reason for rejecting a request.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Refusal {
    /// The request arrived before `initialize`.
    TooEarly,
    /// The request arrived after `shutdown`, or was repeated.
    TooLate,
    /// The method is unknown.
    Method(String),
    /// The parameters do not match the method, or refer to a document that is not open.
    Params,
    /// The method failed, with this message.
    Failed(String),
}

impl Refusal {
    /// Returns the protocol's error code.
    pub(super) fn code(&self) -> i64 {
        match self {
            Refusal::TooEarly => -32002,
            Refusal::TooLate => -32600,
            Refusal::Method(_) => -32601,
            Refusal::Params => -32602,
            Refusal::Failed(_) => -32803,
        }
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Refusal::TooEarly => f.write_str("the first request must be `initialize`"),
            Refusal::TooLate => f.write_str("this request is not allowed at this time"),
            Refusal::Method(method) => write!(f, "unknown method `{}`", method.escape_debug()),
            Refusal::Params => {
                f.write_str("the parameters do not match the method, or the document is not open")
            }
            Refusal::Failed(reason) => f.write_str(reason),
        }
    }
}

/// Returns the response to a request.
pub(super) fn answer(
    documents: &Documents,
    unit: Unit,
    method: &str,
    params: &Value,
) -> Result<Value, Refusal> {
    let query = || Query::of(documents, unit, params).ok_or(Refusal::Params);
    let at = |query: &Query<'_>| query.at(params).ok_or(Refusal::Params);
    match method {
        "textDocument/hover" => query().and_then(|query| Ok(query.hover(at(&query)?))),
        "textDocument/completion" => query().and_then(|query| Ok(query.completion(at(&query)?))),
        "textDocument/definition" => query().and_then(|query| Ok(query.definition(at(&query)?))),
        "textDocument/references" => query().and_then(|query| {
            let own = params.pointer("/context/includeDeclaration") != Some(&Value::Bool(false));
            Ok(query.references(at(&query)?, own))
        }),
        "textDocument/prepareRename" => query().and_then(|query| query.prepare_rename(at(&query)?)),
        "textDocument/rename" => query().and_then(|query| {
            let name = params.get("newName").and_then(Value::as_str).ok_or(Refusal::Params)?;
            query.rename(at(&query)?, name)
        }),
        "textDocument/formatting" => query().and_then(|query| query.formatting()),
        "textDocument/documentSymbol" => query().map(|query| query.symbols()),
        "textDocument/codeAction" => query().and_then(|query| query.actions(params).ok_or(Refusal::Params)),
        _ => Err(Refusal::Method(method.to_owned())),
    }
}

/// Returns a notification that publishes a document's problems.
pub(super) fn published(uri: &str, version: &Value, problems: &Value) -> Value {
    let mut params = json!({ "uri": uri, "diagnostics": problems });
    if version.is_i64() {
        params["version"] = version.clone();
    }
    json!({ "jsonrpc": "2.0", "method": "textDocument/publishDiagnostics", "params": params })
}

/// Returns an open document's problems as diagnostics in the protocol's format.
pub(super) fn diagnostics(documents: &Documents, unit: Unit, uri: &str) -> Value {
    let Some(query) = Query::at_uri(documents, unit, uri) else { return json!([]) };
    query.problems().iter().map(|problem| diagnostic(problem, &query.document.text, unit)).collect()
}

fn diagnostic(problem: &Problem, text: &Text, unit: Unit) -> Value {
    let mut message = problem.message.clone();
    if !problem.label.is_empty() {
        message += &format!(" ({})", problem.label);
    }
    if let Some(help) = &problem.help {
        message += &format!("\nhelp: {help}");
    }
    json!({
        "range": text.range(problem.span, unit),
        "severity": if problem.severity == Severity::Error { 1 } else { 2 },
        "code": problem.code,
        "source": "arcade",
        "message": message,
    })
}

/// A request about an open document.
struct Query<'a> {
    documents: &'a Documents,
    unit: Unit,
    uri: &'a str,
    document: &'a Document,
}

impl<'a> Query<'a> {
    fn of(documents: &'a Documents, unit: Unit, params: &Value) -> Option<Query<'a>> {
        Query::at_uri(documents, unit, params.pointer("/textDocument/uri")?.as_str()?)
    }

    fn at_uri(documents: &'a Documents, unit: Unit, uri: &str) -> Option<Query<'a>> {
        let (uri, document) = documents.0.get_key_value(uri)?;
        Some(Query { documents, unit, uri, document })
    }

    fn at(&self, params: &Value) -> Option<usize> {
        self.document.text.byte(params.get("position")?, self.unit)
    }

    fn text(&self) -> &str {
        &self.document.text.text
    }

    fn is_game(&self) -> bool {
        self.document.kind == Kind::Game
    }

    fn range(&self, span: Span) -> Value {
        self.document.text.range(span, self.unit)
    }

    fn problems(&self) -> Vec<Problem> {
        match self.document.kind {
            Kind::Game => problems(self.text()),
            Kind::Level => match self.documents.game_of(self.uri) {
                Some((_, game)) => LevelRules::of(&game.text).problems(self.text()),
                None => Vec::new(),
            },
            Kind::Other => Vec::new(),
        }
    }

    fn hover(&self, at: usize) -> Value {
        let found = match self.document.kind {
            Kind::Game => hover(self.text(), at),
            Kind::Level => self
                .documents
                .game_of(self.uri)
                .and_then(|(_, game)| level_hover(&game.text, self.text(), at)),
            Kind::Other => None,
        };
        found.map_or(Value::Null, |hover| {
            json!({ "contents": { "kind": "markdown", "value": hover.markdown }, "range": self.range(hover.span) })
        })
    }

    fn completion(&self, at: usize) -> Value {
        if !self.is_game() {
            return Value::Null;
        }
        let completion = complete(self.text(), at);
        let range = self.range(completion.span);
        let items = completion.items.iter().enumerate();
        let items: Vec<Value> = items.map(|(place, item)| completion_item(item, place, &range)).collect();
        json!({ "isIncomplete": false, "items": items })
    }

    fn definition(&self, at: usize) -> Value {
        match self.document.kind {
            Kind::Game => definition(self.text(), at)
                .map_or(Value::Null, |span| json!({ "uri": self.uri, "range": self.range(span) })),
            Kind::Level => {
                let game = self.documents.game_of(self.uri);
                let found = game.and_then(|(uri, game)| {
                    let span = level_definition(&game.text, self.text(), at)?;
                    Some(json!({ "uri": uri, "range": game.range(span, self.unit) }))
                });
                found.unwrap_or(Value::Null)
            }
            Kind::Other => Value::Null,
        }
    }

    fn references(&self, at: usize, with_declaration: bool) -> Value {
        if !self.is_game() {
            return Value::Null;
        }
        let declared = definition(self.text(), at).filter(|_| !with_declaration);
        let places = references(self.text(), at).into_iter().filter(|span| Some(*span) != declared);
        places.map(|span| json!({ "uri": self.uri, "range": self.range(span) })).collect()
    }

    fn prepare_rename(&self, at: usize) -> Result<Value, Refusal> {
        if !self.is_game() {
            return Err(failed(&RenameError::Nothing));
        }
        let span = renamable(self.text(), at).map_err(|error| failed(&error))?;
        let placeholder = self.text().get(span.start..span.end).unwrap_or_default();
        Ok(json!({ "range": self.range(span), "placeholder": placeholder }))
    }

    fn rename(&self, at: usize, name: &str) -> Result<Value, Refusal> {
        if !self.is_game() {
            return Err(failed(&RenameError::Nothing));
        }
        let edits = rename(self.text(), at, name).map_err(|error| failed(&error))?;
        let mut changes = Map::new();
        // When a level character is renamed, every level must change too.
        let span = renamable(self.text(), at).map_err(|error| failed(&error))?;
        let old = self.text().get(span.start..span.end).unwrap_or_default();
        let is_symbol = is_symbol_at(self.text(), span);
        if let (true, Some(old), Some(new)) = (is_symbol, old.chars().next(), name.chars().next()) {
            for (uri, level) in self.documents.levels_of(self.uri) {
                let edits = rename_in_level(&level.text, old, new);
                if !edits.is_empty() {
                    changes.insert(uri, text_edits(&edits, &level, self.unit));
                }
            }
        }
        changes.insert(self.uri.to_owned(), text_edits(&edits, &self.document.text, self.unit));
        Ok(json!({ "changes": changes }))
    }

    fn formatting(&self) -> Result<Value, Refusal> {
        if !self.is_game() {
            return Ok(Value::Null);
        }
        let text = format(self.text()).map_err(|_| {
            Refusal::Failed("some lines cannot be parsed: fix the problems before formatting".to_owned())
        })?;
        if text == self.text() {
            return Ok(json!([]));
        }
        let everything = Edit::new(Span::new(0, self.text().len()), text);
        Ok(text_edits(&[everything], &self.document.text, self.unit))
    }

    fn symbols(&self) -> Value {
        if !self.is_game() {
            return Value::Null;
        }
        outline(self.text()).iter().map(|entry| self.symbol(entry)).collect()
    }

    fn symbol(&self, entry: &Entry) -> Value {
        let kind = match entry.kind {
            EntryKind::Section => 3,
            EntryKind::Sprite => 5,
            EntryKind::Symbol => 20,
            EntryKind::Interaction => 12,
            EntryKind::Termination => 24,
            EntryKind::Parameter => 14,
        };
        json!({
            "name": if entry.name.is_empty() { "?" } else { &entry.name },
            "detail": entry.detail,
            "kind": kind,
            "range": self.range(entry.span),
            "selectionRange": self.range(entry.name_span),
            "children": entry.children.iter().map(|child| self.symbol(child)).collect::<Vec<_>>(),
        })
    }

    fn actions(&self, params: &Value) -> Option<Value> {
        let wanted = self.document.text.span(params.get("range")?, self.unit)?;
        let only = params.pointer("/context/only").and_then(Value::as_array);
        if only.is_some_and(|kinds| !kinds.iter().any(|kind| kind == "quickfix" || kind == "")) {
            return Some(json!([]));
        }
        let mut actions = Vec::new();
        let touches = |span: Span| span.start <= wanted.end && wanted.start <= span.end;
        for problem in self.problems().iter().filter(|problem| touches(problem.span)) {
            for (place, fix) in problem.fixes.iter().enumerate() {
                let edits = text_edits(&fix.edits, &self.document.text, self.unit);
                let changes = Map::from_iter([(self.uri.to_owned(), edits)]);
                actions.push(json!({
                    "title": fix.title,
                    "kind": "quickfix",
                    "diagnostics": [diagnostic(problem, &self.document.text, self.unit)],
                    "isPreferred": place == 0,
                    "edit": { "changes": changes },
                }));
            }
        }
        Some(Value::Array(actions))
    }
}

/// Returns `true` if a span is the declaration of a level character in a game's text.
fn is_symbol_at(source: &str, span: Span) -> bool {
    let symbols = outline(source).into_iter().flat_map(|section| section.children);
    symbols.into_iter().any(|entry| entry.kind == EntryKind::Symbol && entry.name_span == span)
}

fn failed(error: &RenameError) -> Refusal {
    Refusal::Failed(error.to_string())
}

fn text_edits(edits: &[Edit], text: &Text, unit: Unit) -> Value {
    let edit = |edit: &Edit| json!({ "range": text.range(edit.span, unit), "newText": edit.text });
    edits.iter().map(edit).collect()
}

/// Returns a completion item. `place` determines its rank among the completion items.
fn completion_item(item: &Item, place: usize, range: &Value) -> Value {
    let kind = match item.kind {
        ItemKind::Class => 7,
        ItemKind::Sprite => 6,
        ItemKind::Effect => 3,
        ItemKind::Termination => 23,
        ItemKind::Parameter => 10,
        ItemKind::Value => 20,
        ItemKind::Keyword => 14,
    };
    let mut value = json!({
        "label": item.label,
        "kind": kind,
        "sortText": format!("{place:04}"),
        "textEdit": { "range": range, "newText": item.insert },
    });
    if !item.detail.is_empty() {
        value["detail"] = json!(item.detail);
    }
    if !item.markdown.is_empty() {
        value["documentation"] = json!({ "kind": "markdown", "value": item.markdown });
    }
    value
}
