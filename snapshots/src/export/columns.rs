//! The columns of an export: their names, their types and the sources of their values. All formats, the dataset card
//! and the page (`docs/export.md`) follow this table.

use super::item::Item;
use forge::card::{LevelCard, Origin};
use validators::{PlayerResult, Rate};

/// The type of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnKind {
    /// A text, never null.
    Text,
    /// A text, or null.
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
    /// A list of records, possibly empty: the fields with their types, none of which is a list.
    Records(&'static [(&'static str, ColumnKind)]),
}

impl ColumnKind {
    /// The name of the type in `docs/export.md`.
    pub fn name(self) -> String {
        let fields = |fields: &[(&str, ColumnKind)]| {
            let told: Vec<String> =
                fields.iter().map(|(name, kind)| format!("{name}: {}", kind.name())).collect();
            format!("list of {{{}}}", told.join(", "))
        };
        match self {
            ColumnKind::Text => "string".to_owned(),
            ColumnKind::MaybeText => "string or null".to_owned(),
            ColumnKind::Integer => "int64".to_owned(),
            ColumnKind::MaybeInteger => "int64 or null".to_owned(),
            ColumnKind::Number => "float64".to_owned(),
            ColumnKind::MaybeNumber => "float64 or null".to_owned(),
            ColumnKind::Flag => "bool".to_owned(),
            ColumnKind::Texts => "list of string".to_owned(),
            ColumnKind::Records(named) => fields(named),
        }
    }
}

/// The value of a row in a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// Null.
    Missing,
    /// A value of [`ColumnKind::Text`] or [`ColumnKind::MaybeText`].
    Text(String),
    /// A value of [`ColumnKind::Integer`] or [`ColumnKind::MaybeInteger`].
    Integer(i64),
    /// A value of [`ColumnKind::Number`] or [`ColumnKind::MaybeNumber`].
    Number(f64),
    /// A value of [`ColumnKind::Flag`].
    Flag(bool),
    /// A value of [`ColumnKind::Texts`]: each element is a text.
    Texts(Vec<Value>),
    /// A value of [`ColumnKind::Records`]: the fields in their order.
    Records(Vec<Vec<Value>>),
}

/// A column.
#[derive(Clone, Copy)]
pub struct Column {
    /// The name.
    pub name: &'static str,
    /// The type of its values.
    pub kind: ColumnKind,
    of: fn(&Item<'_>) -> Value,
}

impl Column {
    pub(super) const fn new(name: &'static str, kind: ColumnKind, of: fn(&Item<'_>) -> Value) -> Column {
        Column { name, kind, of }
    }

    /// The value of an item in this column.
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

/// The columns of every export.
const PLAIN: &[Column] = &[
    Column::new("item_id", ColumnKind::Text, |item| text(item.id())),
    Column::new("release", ColumnKind::Text, |item| text(&item.manifest.name)),
    Column::new("release_root", ColumnKind::Text, |item| text(item.manifest.root)),
    Column::new("split", ColumnKind::Text, |_| text(super::SPLIT)),
    Column::new("twin", ColumnKind::MaybeText, |item| item.twin.map_or(Value::Missing, text)),
    Column::new("game_id", ColumnKind::Text, |item| text(&item.card.id)),
    Column::new("level", ColumnKind::Integer, |item| count(item.number)),
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
        Origin::Corpus { .. } => Value::Texts(Vec::new()),
        Origin::Generated { patterns, .. } => Value::Texts(patterns.iter().map(text).collect()),
    }),
    Column::new("title", ColumnKind::Text, |item| text(&item.exported.title)),
    Column::new("description", ColumnKind::Text, |item| text(&item.exported.description)),
    Column::new("goal", ColumnKind::Text, |item| text(&item.exported.goal)),
    Column::new("rules", ColumnKind::Text, |item| text(&item.exported.rules)),
    Column::new("vgdl", ColumnKind::Text, |item| text(&item.exported.source)),
    Column::new("level_text", ColumnKind::Text, |item| text(&item.exported_level().text)),
    Column::new("columns", ColumnKind::Integer, |item| count(item.exported_level().level.columns())),
    Column::new("rows", ColumnKind::Integer, |item| count(item.exported_level().level.rows())),
    Column::new("legend", ColumnKind::Records(LEGEND), |item| {
        let line = |(symbol, sprites): &(char, String)| vec![text(symbol), text(sprites)];
        Value::Records(item.exported.legend.iter().map(line).collect())
    }),
    Column::new("kind", ColumnKind::Text, |item| text(&item.card.kind)),
    Column::new("goal_kind", ColumnKind::Text, |item| text(item.exported.kind.goal.name())),
    Column::new("avatar_kind", ColumnKind::Text, |item| text(item.exported.kind.avatar.name())),
    Column::new("chance", ColumnKind::Text, |item| text(item.exported.kind.chance.name())),
    Column::new("real_time", ColumnKind::Flag, |item| Value::Flag(item.card.real_time)),
    Column::new("deterministic", ColumnKind::Flag, |item| Value::Flag(item.card.deterministic)),
    Column::new("difficulty", ColumnKind::MaybeText, |item| {
        let label = item.level().ladder.as_ref().map(|ladder| ladder.difficulty.to_string());
        label.map_or(Value::Missing, |label| text(label.replace(' ', "_")))
    }),
    Column::new("ease", ColumnKind::MaybeNumber, |item| {
        maybe(item.level().ladder.as_ref().and_then(|ladder| ladder.ease))
    }),
    Column::new("difficulty_asked", ColumnKind::Number, |item| Value::Number(item.level().difficulty)),
    Column::new("ladder", ColumnKind::Records(LADDER), |item| ladder(item.level())),
    Column::new("tree_search_win_rate", ColumnKind::MaybeNumber, |item| rate(&item.level().mcts)),
    Column::new("random_win_rate", ColumnKind::MaybeNumber, |item| rate(&item.level().random)),
    Column::new("idle_win_rate", ColumnKind::MaybeNumber, |item| rate(&item.level().idle)),
    Column::new("witness_ticks", ColumnKind::Integer, |item| count(item.level().witness_ticks)),
    Column::new("witness_score", ColumnKind::Number, |item| Value::Number(item.level().witness_score)),
    Column::new("optimal_ticks", ColumnKind::MaybeInteger, |item| {
        item.level().optimal_ticks.map_or(Value::Missing, count)
    }),
    Column::new("level_generator", ColumnKind::Text, |item| text(&item.level().generator)),
    Column::new("game_digest", ColumnKind::Text, |item| text(item.exported.game.digest())),
    Column::new("level_digest", ColumnKind::Text, |item| text(item.exported_level().level.digest())),
    Column::new("rules_digest", ColumnKind::Text, |item| text(item.exported.form)),
    Column::new("semantics", ColumnKind::Integer, |item| Value::Integer(i64::from(item.manifest.semantics))),
    Column::new("generation", ColumnKind::Integer, |item| {
        Value::Integer(i64::from(item.manifest.generation))
    }),
    Column::new("canary", ColumnKind::Text, |item| text(&item.manifest.canary)),
];

/// The additional columns of an export with solutions, after the others.
const SOLUTIONS: &[Column] = &[
    Column::new("solution", ColumnKind::Texts, |item| {
        let actions = item.exported_level().witness.iter().flat_map(|episode| &episode.actions);
        Value::Texts(actions.map(text).collect())
    }),
    Column::new("solution_seed", ColumnKind::MaybeText, |item| {
        item.exported_level().witness.as_ref().map_or(Value::Missing, |episode| text(episode.seed))
    }),
];

/// The columns of an export, in order.
pub fn columns(solutions: bool) -> Vec<Column> {
    PLAIN.iter().chain(if solutions { SOLUTIONS } else { &[] }).copied().collect()
}

fn text(shown: impl ToString) -> Value {
    Value::Text(shown.to_string())
}

/// Counts of a release are below its limits, far from 2^63.
fn count(number: usize) -> Value {
    Value::Integer(i64::try_from(number).unwrap_or(i64::MAX))
}

fn maybe(number: Option<f64>) -> Value {
    number.map_or(Value::Missing, Value::Number)
}

fn rate(rate: &Rate) -> Value {
    maybe((rate.plays > 0).then(|| rate.wins as f64 / rate.plays as f64))
}

fn ladder(level: &LevelCard) -> Value {
    let whole = |number: u64| Value::Integer(i64::try_from(number).unwrap_or(i64::MAX));
    let record = |result: &PlayerResult, held_out: bool| {
        vec![
            text(&result.player),
            Value::Flag(result.looks_ahead),
            Value::Flag(held_out),
            whole(result.rate.plays),
            whole(result.rate.wins),
            rate(&result.rate),
            maybe(result.reward),
        ]
    };
    let Some(ladder) = &level.ladder else { return Value::Records(Vec::new()) };
    let rungs = ladder.rungs.iter().map(|result| record(result, false));
    Value::Records(rungs.chain(ladder.held_out.iter().map(|result| record(result, true))).collect())
}
