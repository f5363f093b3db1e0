//! Reads an interaction line's parameters as its effect requires.

use super::super::Policy;
use super::super::params::{Expected, Value, convert, missing_name, wrong_type};
use super::line::Reader;
use crate::diagnostic::{Diagnostic, Span};
use crate::keywords;
use crate::rules::effects::{self, Arguments, Undeclared};
use crate::rules::{EffectInfo, SpriteType};
use crate::syntax::{Param, Word};

/// The index that stands for unknown keywords. A shield against an unknown keyword has no effect.
pub(in crate::compile) const NO_KEYWORD: u16 = u16::MAX;

/// Returns a keyword's index among all effect keywords; `None` for an unknown keyword.
pub(in crate::compile) fn number_of(keyword: &str) -> Option<u16> {
    keywords::EFFECTS.iter().position(|known| *known == keyword).map(|at| at as u16)
}

impl<'a> Reader<'a> {
    /// Returns the parameter with this name; `None` if the line does not contain it. If the name is duplicated, returns
    /// the last parameter.
    pub(super) fn param(&self, key: &str) -> Option<&'a Param> {
        self.line.params.iter().rev().find(|param| param.key.text == key)
    }

    fn value(&mut self, key: &'static str) -> Option<(&'a Param, Value<'a>)> {
        self.used.push(key);
        let param = self.param(key)?;
        Some((param, convert(key, &param.value.text)))
    }

    /// Returns the sprite type in a parameter that the effect requires.
    fn required(&mut self, key: &'static str, undeclared: Undeclared) -> SpriteType {
        let found = self.optional_sprite(key, undeclared);
        if found.is_none() && self.param(key).is_none() {
            self.lacks(key, "a sprite");
        }
        let makes = matches!(
            (self.line.effect.text.as_str(), key),
            ("transformTo" | "spawn" | "spawnIfHasMore" | "spawnIfHasLess" | "spawnBehind", "stype")
                | ("spawnAbove" | "spawnBelow" | "spawnLeft" | "spawnRight", "stype")
                | ("transformToSingleton" | "transformIfCount" | "spawnIfCounterSubTypes", "stype")
                | ("transformToSingleton", "stype_other")
                | ("spawnIfCounterSubTypes", "estype")
                | ("transformToAll", "stypeTo")
        );
        let made = found.filter(|&stype| makes && stype != SpriteType::NONE);
        if let (Some(stype), Some(param)) = (made, self.param(key)) {
            self.names.instantiable(stype, &param.value, &mut self.problems);
        }
        self.failed |= found.is_none();
        found.unwrap_or(SpriteType(0))
    }

    /// Returns a list with one entry per counter. Missing entries are copies of the first entry.
    pub(super) fn amounts(&mut self, key: &'static str) -> Box<[Option<i32>]> {
        let nothing = std::iter::repeat_n(Some(0), self.setting.counters);
        let Some((param, value)) = self.value(key) else { return nothing.collect() };
        let Value::Text(text) = value else {
            let value = &param.value.text;
            let message =
                format!("`{key}` takes a list with one whole number for each counter, not `{value}`");
            let problem = Diagnostic::error("wrong-type", param.value.span, message);
            let list = format!("write `{key}={value},{value}`: the reference engine ignores a single number");
            let problem = problem.help(list);
            self.problems.push(match value.parse::<i32>() {
                Ok(_) => problem.replace(param.value.span, &format!("{value},{value}")),
                Err(_) => problem,
            });
            return nothing.collect();
        };
        let entries: Vec<Option<i32>> =
            text.trim_end_matches(',').split(',').map(|entry| entry.parse().ok()).collect();
        if entries.iter().any(Option::is_none) {
            self.problems.push(wrong_type(param, Expected::Int));
        }
        (0..self.setting.counters).map(|at| *entries.get(at).unwrap_or(&entries[0])).collect()
    }

    /// Reports that the effect lacks the parameter `key`, which specifies `thing`.
    pub(super) fn lacks(&mut self, key: &str, thing: &str) {
        let effect = &self.line.effect;
        self.problems.push(missing_name(&format!("`{}`", effect.text), effect.span, key, thing));
    }

    /// Reports a problem at which the reference stops reading the file.
    pub(super) fn fail(&mut self, problem: Diagnostic) {
        self.failed = true;
        self.problems.push(problem);
    }
}

impl Arguments for Reader<'_> {
    fn int(&mut self, key: &'static str, default: i32) -> i32 {
        match self.value(key) {
            None => default,
            Some((_, Value::Int(int))) => int,
            Some((param, _)) => {
                self.problems.push(wrong_type(param, Expected::Int));
                default
            }
        }
    }

    fn number(&mut self, key: &'static str, default: f64) -> f64 {
        match self.value(key) {
            None => default,
            Some((_, Value::Int(int))) => f64::from(int),
            Some((param, Value::Double(double))) => {
                if !double.is_finite() {
                    self.problems.push(wrong_type(param, Expected::Number));
                }
                double
            }
            Some((param, _)) => {
                self.problems.push(wrong_type(param, Expected::Number));
                default
            }
        }
    }

    fn flag(&mut self, key: &'static str, default: bool) -> bool {
        match self.value(key) {
            None => default,
            Some((_, Value::Bool(bool))) => bool,
            Some((param, _)) => {
                self.problems.push(wrong_type(param, Expected::Bool));
                default
            }
        }
    }

    fn score(&mut self, key: &'static str) -> i32 {
        let Some((param, value)) = self.value(key) else { return 0 };
        let Value::Text(text) = value else {
            // The reference drops a value that names a constant.
            self.problems.push(wrong_type(param, Expected::Int));
            return 0;
        };
        let first = text.split(',').next().unwrap_or_default();
        first.parse().unwrap_or_else(|_| {
            self.problems.push(wrong_type(param, Expected::Int));
            self.score_faults[usize::from(key != "scoreChange")] = true;
            0
        })
    }

    fn sprite(&mut self, key: &'static str) -> SpriteType {
        self.required(key, Undeclared::Fails)
    }

    fn sprite_or_none(&mut self, key: &'static str) -> SpriteType {
        self.required(key, Undeclared::Void)
    }

    fn optional_sprite(&mut self, key: &'static str, undeclared: Undeclared) -> Option<SpriteType> {
        let (param, value) = self.value(key)?;
        let Value::Text(text) = value else {
            self.problems.push(wrong_type(param, Expected::Text));
            return None;
        };
        let word = Word { text: text.to_owned(), span: param.value.span };
        let found = self.names.resolve(&word, &mut self.problems);
        match undeclared {
            Undeclared::Void => Some(found.unwrap_or(SpriteType::NONE)),
            Undeclared::Fails | Undeclared::Absent => {
                self.failed |= found.is_none() && undeclared == Undeclared::Fails;
                found
            }
        }
    }

    fn numbered(&mut self, key: &'static str) -> Option<SpriteType> {
        if self.setting.policy != Policy::Reference {
            return None;
        }
        let number = self.int(key, -1);
        let known = usize::try_from(number).is_ok_and(|number| number < self.names.types.len());
        (number != -1).then_some(if known { SpriteType(number as u16) } else { SpriteType::NONE })
    }

    fn sprites(&mut self, key: &'static str) -> Vec<SpriteType> {
        let Some((param, value)) = self.value(key) else { return Vec::new() };
        let Value::Text(text) = value else {
            self.problems.push(wrong_type(param, Expected::Text));
            return Vec::new();
        };
        let mut start = param.value.span.start;
        let entries = text.split(',').map(|name| {
            let span = Span::new(start, start + name.len());
            start = span.end + 1;
            Word { text: name.to_owned(), span }
        });
        entries.filter_map(|word| self.names.resolve(&word, &mut self.problems)).collect()
    }

    fn keyword(&mut self, key: &'static str) -> u16 {
        let value = self.value(key);
        let Some((param, Value::Text(name))) = value else {
            self.failed = true;
            self.lacks(key, "an effect");
            return NO_KEYWORD;
        };
        let found = number_of(name);
        if found.is_none() {
            self.unknown_effect(&param.value);
        }
        found.unwrap_or(NO_KEYWORD)
    }

    fn timed(&mut self) -> u16 {
        let keyword = self.keyword("ftype");
        let Some(&name) = keywords::EFFECTS.get(usize::from(keyword)) else {
            self.failed = true;
            return 0;
        };
        if name == "addTimer" {
            let span = self.param("ftype").map(Param::span).unwrap_or_default();
            let problem = Diagnostic::error("bad-parameter", span, "addTimer cannot schedule itself");
            self.fail(problem.help("choose another effect"));
            return 0;
        }
        // Read the line again, the way the scheduled effect does.
        self.used.extend(["timer", "repeating"]);
        if let Some(effect) = effects::build(name, self) {
            self.planned = Some((EffectInfo::of(effect), keyword));
        }
        self.timed
    }

    fn relatives(&self, stype: SpriteType) -> Box<[SpriteType]> {
        self.names.types[stype.index()].tree.iter().copied().filter(|&other| other != stype).collect()
    }
}
