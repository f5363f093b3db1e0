//! The columns of an export: their names, their types and the sources of their values. All formats, the
//! dataset card and the documentation page (`docs/how-to/export.md`) are based on this table.

use super::item::Item;
use forge::card::{LevelCard, Origin};
use serde_json::Value;
use validators::{PlayerResult, Rate};

/// The type of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnKind {
    /// Text, never null.
    Text,
    /// Text, or null.
    MaybeText,
    /// A 64-bit integer, never null.
    Integer,
    /// A 64-bit integer, or null.
    MaybeInteger,
    /// A 64-bit float, never null.
    Number,
    /// A 64-bit float, or null.
    MaybeNumber,
    /// A boolean, never null.
    Flag,
    /// A list of texts, possibly empty.
    Texts,
    /// A list of records, possibly empty. The variant's value lists the fields of a record with their types. A field
    /// cannot be a list.
    Records(&'static [(&'static str, ColumnKind)]),
}

impl ColumnKind {
    /// Returns the type's name in `docs/how-to/export.md`.
    pub fn name(self) -> String {
        match self {
            ColumnKind::Texts => "list of string".to_owned(),
            ColumnKind::Records(fields) => {
                let fields = fields.iter().map(|(name, kind)| format!("{name}: {}", kind.name()));
                format!("list of {{{}}}", fields.collect::<Vec<String>>().join(", "))
            }
            single => format!("{}{}", single.data_type(), if single.is_optional() { " or null" } else { "" }),
        }
    }

    /// Returns the type name of a single value.
    pub(super) fn data_type(self) -> &'static str {
        match self {
            ColumnKind::Text | ColumnKind::MaybeText => "string",
            ColumnKind::Integer | ColumnKind::MaybeInteger => "int64",
            ColumnKind::Number | ColumnKind::MaybeNumber => "float64",
            ColumnKind::Flag => "bool",
            ColumnKind::Texts | ColumnKind::Records(_) => unreachable!("a list is no single value"),
        }
    }

    /// Returns `true` if a value can be null.
    pub(super) fn is_optional(self) -> bool {
        matches!(self, ColumnKind::MaybeText | ColumnKind::MaybeInteger | ColumnKind::MaybeNumber)
    }
}

/// A column of an export.
#[derive(Clone, Copy)]
pub struct Column {
    /// The column's name.
    pub name: &'static str,
    /// The type of its values.
    pub kind: ColumnKind,
    of: fn(&Item<'_>) -> Value,
}

impl Column {
    pub(super) const fn new(name: &'static str, kind: ColumnKind, of: fn(&Item<'_>) -> Value) -> Column {
        Column { name, kind, of }
    }

    /// Returns the column's value for an item.
    pub(super) fn value(&self, item: &Item<'_>) -> Value {
        (self.of)(item)
    }
}

const LEGEND: &[(&str, ColumnKind)] = &[("symbol", ColumnKind::Text), ("sprites", ColumnKind::Text)];

const LADDER: &[(&str, ColumnKind)] = &[
    ("player", ColumnKind::Text),
    ("looks_ahead", ColumnKind::Flag),
    ("held_out", ColumnKind::Flag),
    ("plays", ColumnKind::Integer),
    ("wins", ColumnKind::Integer),
    ("win_rate", ColumnKind::MaybeNumber),
    ("reward", ColumnKind::MaybeNumber),
];

/// The columns that every export contains.
const PLAIN: &[Column] = &[
    Column::new("item_id", ColumnKind::Text, |item| text(item.id())),
    Column::new("release", ColumnKind::Text, |item| text(&item.manifest.name)),
    Column::new("release_root", ColumnKind::Text, |item| text(item.manifest.root)),
    Column::new("split", ColumnKind::Text, |_| text(super::options::SPLIT)),
    Column::new("twin", ColumnKind::MaybeText, |item| item.twin.map_or(Value::Null, text)),
    Column::new("game_id", ColumnKind::Text, |item| text(&item.card.id)),
    Column::new("level", ColumnKind::Integer, |item| Value::from(item.number)),
    Column::new("origin", ColumnKind::Text, |item| {
        text(match item.card.origin {
            Origin::Corpus { .. } => "corpus",
            Origin::Generated { .. } => "generated",
        })
    }),
    Column::new("origin_name", ColumnKind::Text, |item| match &item.card.origin {
        Origin::Corpus { name } | Origin::Generated { generator: name, .. } => text(name),
    }),
    Column::new("patterns", ColumnKind::Texts, |item| match &item.card.origin {
        Origin::Corpus { .. } => Value::Array(Vec::new()),
        Origin::Generated { patterns, .. } => patterns.iter().map(text).collect(),
    }),
    Column::new("title", ColumnKind::Text, |item| text(&item.exported.title)),
    Column::new("description", ColumnKind::Text, |item| text(&item.exported.description)),
    Column::new("goal", ColumnKind::Text, |item| text(&item.exported.goal)),
    Column::new("rules", ColumnKind::Text, |item| text(&item.exported.rules)),
    Column::new("vgdl", ColumnKind::Text, |item| text(&item.exported.source)),
    Column::new("level_text", ColumnKind::Text, |item| text(&item.exported_level().text)),
    Column::new("columns", ColumnKind::Integer, |item| Value::from(item.exported_level().level.columns())),
    Column::new("rows", ColumnKind::Integer, |item| Value::from(item.exported_level().level.rows())),
    Column::new("legend", ColumnKind::Records(LEGEND), |item| {
        let line = |(symbol, sprites): &(char, String)| vec![text(symbol), text(sprites)];
        item.exported.legend.iter().map(line).collect()
    }),
    Column::new("kind", ColumnKind::Text, |item| text(&item.card.kind)),
    Column::new("goal_kind", ColumnKind::Text, |item| text(item.exported.kind.goal.name())),
    Column::new("avatar_kind", ColumnKind::Text, |item| text(item.exported.kind.avatar.name())),
    Column::new("chance", ColumnKind::Text, |item| text(item.exported.kind.chance.name())),
    Column::new("real_time", ColumnKind::Flag, |item| Value::from(item.card.real_time)),
    Column::new("deterministic", ColumnKind::Flag, |item| Value::from(item.card.deterministic)),
    Column::new("difficulty", ColumnKind::MaybeText, |item| {
        let label = item.level().ladder.as_ref().map(|ladder| ladder.difficulty.to_string());
        label.map_or(Value::Null, |label| text(label.replace(' ', "_")))
    }),
    Column::new("ease", ColumnKind::MaybeNumber, |item| {
        Value::from(item.level().ladder.as_ref().and_then(|ladder| ladder.ease))
    }),
    Column::new("difficulty_asked", ColumnKind::Number, |item| Value::from(item.level().difficulty)),
    Column::new("ladder", ColumnKind::Records(LADDER), |item| ladder(item.level())),
    Column::new("tree_search_win_rate", ColumnKind::MaybeNumber, |item| rate(&item.level().mcts)),
    Column::new("random_win_rate", ColumnKind::MaybeNumber, |item| rate(&item.level().random)),
    Column::new("idle_win_rate", ColumnKind::MaybeNumber, |item| rate(&item.level().idle)),
    Column::new("witness_ticks", ColumnKind::Integer, |item| Value::from(item.level().witness_ticks)),
    Column::new("witness_score", ColumnKind::Number, |item| Value::from(item.level().witness_score)),
    Column::new("optimal_ticks", ColumnKind::MaybeInteger, |item| Value::from(item.level().optimal_ticks)),
    Column::new("level_generator", ColumnKind::Text, |item| text(&item.level().generator)),
    Column::new("game_digest", ColumnKind::Text, |item| text(item.exported.game.digest())),
    Column::new("level_digest", ColumnKind::Text, |item| text(item.exported_level().level.digest())),
    Column::new("rules_digest", ColumnKind::Text, |item| text(item.exported.form)),
    Column::new("semantics", ColumnKind::Integer, |item| Value::from(item.manifest.semantics)),
    Column::new("generation", ColumnKind::Integer, |item| Value::from(item.manifest.generation)),
    Column::new("canary", ColumnKind::Text, |item| text(&item.manifest.canary)),
];

/// The additional columns of exports with solutions, which follow the plain columns.
const SOLUTIONS: &[Column] = &[
    Column::new("solution", ColumnKind::Texts, |item| {
        let actions = item.exported_level().witness.iter().flat_map(|episode| &episode.actions);
        actions.map(text).collect()
    }),
    Column::new("solution_seed", ColumnKind::MaybeText, |item| {
        item.exported_level().witness.as_ref().map_or(Value::Null, |episode| text(episode.seed))
    }),
];

/// Returns the columns of an export, in the table's order.
pub fn columns(solutions: bool) -> Vec<Column> {
    PLAIN.iter().chain(if solutions { SOLUTIONS } else { &[] }).copied().collect()
}

fn text(shown: impl ToString) -> Value {
    Value::String(shown.to_string())
}

fn rate(rate: &Rate) -> Value {
    Value::from((rate.plays > 0).then(|| rate.wins as f64 / rate.plays as f64))
}

fn ladder(level: &LevelCard) -> Value {
    let record = |result: &PlayerResult, held_out: bool| {
        vec![
            text(&result.player),
            Value::from(result.looks_ahead),
            Value::from(held_out),
            Value::from(result.rate.plays),
            Value::from(result.rate.wins),
            rate(&result.rate),
            Value::from(result.reward),
        ]
    };
    let Some(ladder) = &level.ladder else { return Value::Array(Vec::new()) };
    let rungs = ladder.rungs.iter().map(|result| record(result, false));
    rungs.chain(ladder.held_out.iter().map(|result| record(result, true))).collect()
}
