//! Compiles the TerminationSet.

use super::params::{Expected, Value, convert, missing_name, wrong_type};
use super::{Names, Setting};
use crate::diagnostic::Diagnostic;
use crate::keywords::TERMINATIONS;
use crate::limits::MAX_PROBLEMS;
use crate::meanings::Place;
use crate::rules::SpriteType;
use crate::rules::terminations::{Condition, Decision, Termination};
use crate::syntax::{Description, Param, TerminationLine};
use smallvec::SmallVec;

/// Returns the terminations, and a flag that is `true` if they allow counters to end the game.
pub(super) fn terminations(
    description: &Description,
    names: Names<'_>,
    setting: Setting,
    problems: &mut Vec<Diagnostic>,
) -> (Vec<Termination>, bool) {
    let mut terminations = Vec::new();
    let mut winnable = false;
    let mut can_end = true;
    for line in &description.terminations {
        let mut reader = Reader { line, names, setting, problems };
        can_end = reader.flag("canEnd", can_end);
        // A value that is neither true nor false has already been reported. It may have been intended as
        // true.
        let loses = |param: &Param| param.value.text.to_lowercase().starts_with("false");
        winnable |= reader.param("win").is_some_and(|param| !loses(param));
        if let Some(termination) = reader.termination() {
            winnable |= termination.win;
            terminations.push(termination);
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
        problems.push(problem.help("add a line such as `SpriteCounter stype=GOAL limit=0 win=True`, with the type that a winner removes"));
    }
    (terminations, can_end)
}

/// Returns `true` if the reference builds a termination from the line, and the number of messages that it
/// logs about the line's parameters.
pub(super) fn usable(line: &TerminationLine, names: Names<'_>, setting: Setting) -> (bool, u32) {
    let mut problems = Vec::new();
    let built = Reader { line, names, setting, problems: &mut problems }.termination();
    let built = built.is_some();
    (built, super::unknown_parameters(&problems))
}

struct Reader<'a> {
    line: &'a TerminationLine,
    names: Names<'a>,
    setting: Setting,
    problems: &'a mut Vec<Diagnostic>,
}

impl<'a> Reader<'a> {
    /// Compiles the line. Returns `None` if the reference stops reading at this line.
    fn termination(&mut self) -> Option<Termination> {
        let name = self.line.class.text.as_str();
        let own: &[&str] = match name {
            "SpriteCounter" | "SpriteCounterMore" => &["stype"],
            "MultiSpriteCounter" | "StopCounter" => &["stype1", "stype2", "stype3", "min"],
            "MultiSpriteCounterSubTypes" => &["stype1", "subTypesNum"],
            "Timeout" => &["use_counter", "compare", "limits"],
            _ => {
                let span = self.line.class.span;
                let message = format!("no termination named `{name}`");
                let problem = Diagnostic::error("unknown-termination", span, message);
                let problem = problem.help(format!("terminations are {}", TERMINATIONS.join(", ")));
                self.problems.push(problem.mean_after(
                    self.problems.len(),
                    Place::Termination,
                    name,
                    TERMINATIONS.iter().copied(),
                ));
                return None;
            }
        };
        let common = ["limit", "win", "count_score", "canEnd"];
        for param in &self.line.params {
            let key = param.key.text.as_str();
            if !common.contains(&key) && !own.contains(&key) {
                let message = format!("{name} has no parameter `{key}`");
                let known: Vec<&str> = common.iter().chain(own).copied().collect();
                let problem = Diagnostic::error("unknown-parameter", param.key.span, message);
                let problem = problem.help(format!("its parameters are {}", known.join(", ")));
                let reported = self.problems.len();
                let problem = problem.mean_after(reported, Place::TerminationParameter, key, known);
                self.problems.push(match reported < MAX_PROBLEMS {
                    true => problem.or_remove(param.span(), key),
                    false => problem,
                });
            }
        }
        let limit = self.int("limit", 0);
        let (mut win, mut decided_by) = (self.win(), Decision::Line);
        if self.flag("count_score", false) {
            (win, decided_by) = (true, Decision::Score);
        }
        let condition = match name {
            "SpriteCounter" => Condition::SpriteCounter { stype: self.sprite("stype")?, limit },
            "SpriteCounterMore" => Condition::SpriteCounterMore { stype: self.sprite("stype")?, limit },
            "MultiSpriteCounterSubTypes" => {
                let kinds = self.int("subTypesNum", -1);
                Condition::MultiSpriteCounterSubTypes { stype: self.sprite("stype1")?, limit, kinds }
            }
            "MultiSpriteCounter" | "StopCounter" => {
                let stypes = self.sprites(["stype1", "stype2", "stype3"])?;
                let min = self.flag("min", false);
                if name == "StopCounter" {
                    Condition::StopCounter { stypes, limit, min }
                } else {
                    Condition::MultiSpriteCounter { stypes, limit, min }
                }
            }
            _ => {
                if let Some(decision) = self.by_counters() {
                    (win, decided_by) = decision;
                }
                Condition::Timeout { limit }
            }
        };
        Some(Termination { condition, win, decided_by })
    }

    /// Returns how counters decide the termination in a single-player game. The flag is `true` if that
    /// decision can win the game.
    fn by_counters(&mut self) -> Option<(bool, Decision)> {
        let (used, compared) = (self.flag("use_counter", false), self.flag("compare", false));
        let limits = self.param("limits").and_then(|param| match convert("limits", &param.value.text) {
            Value::Text(list) => Some((param, list)),
            _ => {
                let value = &param.value.text;
                let message = format!("`limits` takes a list of whole numbers, not `{value}`");
                let problem = Diagnostic::error("wrong-type", param.value.span, message);
                let help = format!("write `limits={value},0` for counters, or `limit={value}` for ticks");
                self.problems.push(problem.help(help));
                None
            }
        });
        // The reference drops a single number, which is not a list, so the list stays at 0.
        let value = limits.map_or(Ok(0), |(param, list)| {
            list.split(',').next().unwrap_or_default().parse::<i32>().map_err(|_| param)
        });
        let value = value.unwrap_or_else(|param| {
            self.problems.push(wrong_type(param, Expected::Int));
            0
        });
        match (used, compared, self.setting.counters) {
            (false, ..) => None,
            // A single counter cannot differ from another counter.
            (true, true, 0 | 1) => Some((false, Decision::Line)),
            (true, true, _) => Some((true, Decision::Difference)),
            (true, false, 1) => Some((true, Decision::Value(value))),
            // Unless there are as many counters as players, nobody wins.
            (true, false, _) => Some((false, Decision::Line)),
        }
    }

    fn param(&self, key: &str) -> Option<&'a Param> {
        self.line.params.iter().rev().find(|param| param.key.text == key)
    }

    fn int(&mut self, key: &str, default: i32) -> i32 {
        let Some(param) = self.param(key) else { return default };
        let Value::Int(int) = convert(key, &param.value.text) else {
            self.problems.push(wrong_type(param, Expected::Int));
            return default;
        };
        int
    }

    /// Returns the first entry of `win`, a list with one entry per player. A missing entry is a loss.
    fn win(&mut self) -> bool {
        let Some(param) = self.param("win") else { return false };
        let first = param.value.text.split(',').next().unwrap_or_default();
        if !first.eq_ignore_ascii_case("true") && !first.eq_ignore_ascii_case("false") {
            self.problems.push(wrong_type(param, Expected::Bool));
        }
        first.eq_ignore_ascii_case("true")
    }

    fn flag(&mut self, key: &str, default: bool) -> bool {
        let Some(param) = self.param(key) else { return default };
        let Value::Bool(flag) = convert(key, &param.value.text) else {
            self.problems.push(wrong_type(param, Expected::Bool));
            return default;
        };
        flag
    }

    fn sprite(&mut self, key: &str) -> Option<SpriteType> {
        let Some(param) = self.param(key) else {
            self.needs(key);
            return None;
        };
        let param = self.named(param)?;
        self.names.resolve_value(param, &param.value, self.problems)
    }

    /// Returns the sprite types that the parameters in `keys` name; `None` if a name is undeclared. In strict mode, the
    /// first parameter is required.
    fn sprites(&mut self, keys: [&str; 3]) -> Option<SmallVec<[SpriteType; 3]>> {
        if self.param(keys[0]).is_none() {
            self.needs(keys[0]);
        }
        let given = keys.into_iter().filter_map(|key| self.param(key)).collect::<Vec<&Param>>();
        let given: Vec<&Param> = given.into_iter().filter_map(|param| self.named(param)).collect();
        let resolve = |param: &&Param| self.names.resolve_value(param, &param.value, self.problems);
        let found: SmallVec<_> = given.iter().filter_map(resolve).collect();
        (found.len() == given.len()).then_some(found)
    }

    /// Returns the parameter unless its value looks like something other than a name.
    fn named<'b>(&mut self, param: &'b Param) -> Option<&'b Param> {
        if let Value::Text(_) = convert(&param.key.text, &param.value.text) {
            return Some(param);
        }
        self.problems.push(wrong_type(param, Expected::Text));
        None
    }

    fn needs(&mut self, key: &str) {
        let class = &self.line.class;
        self.problems.push(missing_name(&class.text, class.span, key, "a sprite"));
    }
}
