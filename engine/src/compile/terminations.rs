//! The TerminationSet.

use super::Names;
use super::params::{Expected, Value, convert, wrong_type};
use crate::diagnostic::{Diagnostic, Span};
use crate::game::SpriteType;
use crate::ontology::terminations::{Condition, NAMES, Termination};
use crate::syntax::{Description, Param, TerminationLine};

pub(super) fn terminations(
    description: &Description,
    names: Names<'_>,
    problems: &mut Vec<Diagnostic>,
) -> Vec<Termination> {
    let mut terminations = Vec::new();
    let mut winnable = false;
    for line in &description.terminations {
        let mut reader = Reader { line, names, problems };
        winnable |=
            reader.param("win").is_some_and(|param| param.value.text.to_lowercase().starts_with("true"));
        if let Some((condition, win)) = reader.termination() {
            terminations.push(Termination { condition, win });
        }
    }
    if description.terminations.is_empty() && description.has[3] {
        let span = description.header.class.span;
        let message = "the TerminationSet is empty: only the limit of 2000 ticks ends the game";
        problems.push(Diagnostic::warning("no-win", span, message).help("add a termination with `win=True`"));
    } else if description.has[3] && !winnable {
        let span = description.terminations[0].class.span;
        let problem =
            Diagnostic::warning("no-win", span, "no termination has `win=True`: the game cannot be won");
        problems.push(problem.help("add `win=True` to one of them"));
    }
    terminations
}

struct Reader<'a> {
    line: &'a TerminationLine,
    names: Names<'a>,
    problems: &'a mut Vec<Diagnostic>,
}

impl<'a> Reader<'a> {
    fn termination(&mut self) -> Option<(Condition, bool)> {
        let name = self.line.class.text.as_str();
        let own: &[&str] = match name {
            "SpriteCounter" | "SpriteCounterMore" => &["stype"],
            "MultiSpriteCounter" | "StopCounter" => &["stype1", "stype2", "stype3", "min"],
            "MultiSpriteCounterSubTypes" => &["stype1", "subTypesNum"],
            "Timeout" => &[],
            _ => {
                let span = self.line.class.span;
                let message = format!("no termination named `{name}`");
                let problem = Diagnostic::error("unknown-termination", span, message);
                self.problems.push(problem.suggest(name, NAMES.iter().copied()));
                return None;
            }
        };
        let common = ["limit", "win", "count_score"];
        for param in &self.line.params {
            let key = param.key.text.as_str();
            if !common.contains(&key) && !own.contains(&key) {
                let message = format!("{name} has no parameter `{key}`");
                let problem = Diagnostic::error("unknown-parameter", param.key.span, message);
                self.problems.push(problem.suggest(key, common.iter().chain(own).copied()));
            }
        }
        if let Some(param) = self.param("count_score") {
            let message = "`count_score` is for games of several players";
            self.problems.push(Diagnostic::error("unsupported", param.span(), message).help("remove it"));
        }
        let limit = self.limit(name);
        let win = self.win();
        let condition = match name {
            "SpriteCounter" => Condition::SpriteCounter { stype: self.sprite("stype")?, limit },
            "SpriteCounterMore" => Condition::SpriteCounterMore { stype: self.sprite("stype")?, limit },
            "MultiSpriteCounterSubTypes" => {
                let kinds = self.int("subTypesNum", -1);
                Condition::MultiSpriteCounterSubTypes { stype: self.sprite("stype1")?, limit, kinds }
            }
            "MultiSpriteCounter" | "StopCounter" => {
                let first = self.sprite("stype1")?;
                let rest = ["stype2", "stype3"].into_iter().filter(|key| self.param(key).is_some());
                let rest: Vec<&'static str> = rest.collect();
                let rest: Vec<SpriteType> = rest.into_iter().filter_map(|key| self.sprite(key)).collect();
                let stypes = std::iter::once(first).chain(rest).collect();
                let min = self.flag("min");
                if name == "StopCounter" {
                    Condition::StopCounter { stypes, limit, min }
                } else {
                    Condition::MultiSpriteCounter { stypes, limit, min }
                }
            }
            _ => Condition::Timeout { limit },
        };
        Some((condition, win))
    }

    fn param(&self, key: &str) -> Option<&'a Param> {
        self.line.params.iter().rev().find(|param| param.key.text == key)
    }

    fn limit(&mut self, name: &str) -> i32 {
        if self.param("limit").is_none() {
            if name == "Timeout" {
                let message = "a Timeout without `limit` ends the game at once";
                let problem = Diagnostic::warning("ends-at-once", self.line.class.span, message);
                self.problems.push(problem.help("add `limit=` and a number of ticks"));
            }
            return 0;
        }
        self.int("limit", 0)
    }

    fn int(&mut self, key: &str, default: i32) -> i32 {
        let Some(param) = self.param(key) else { return default };
        let Value::Int(int) = convert(key, &param.value.text) else {
            self.problems.push(wrong_type(param, Expected::Int));
            return default;
        };
        int
    }

    /// A list with an entry a player; a missing entry is a loss.
    fn win(&mut self) -> bool {
        let Some(param) = self.param("win") else { return false };
        let first = param.value.text.split(',').next().unwrap_or_default();
        if !first.eq_ignore_ascii_case("true") && !first.eq_ignore_ascii_case("false") {
            self.problems.push(wrong_type(param, Expected::Bool));
        }
        first.eq_ignore_ascii_case("true")
    }

    fn flag(&mut self, key: &str) -> bool {
        let Some(param) = self.param(key) else { return false };
        let Value::Bool(flag) = convert(key, &param.value.text) else {
            self.problems.push(wrong_type(param, Expected::Bool));
            return false;
        };
        flag
    }

    fn sprite(&mut self, key: &str) -> Option<SpriteType> {
        let Some(param) = self.param(key) else {
            let span: Span = self.line.class.span;
            let message = format!("{} needs `{key}=`, the name of a sprite", self.line.class.text);
            let problem = Diagnostic::error("missing-parameter", span, message);
            self.problems.push(problem.help(format!("add `{key}=` and the name")));
            return None;
        };
        self.names.resolve_value(param, &param.value, self.problems)
    }
}
