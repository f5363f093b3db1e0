//! The InteractionSet as a flat program: effects, edge passes, pair passes in execution order (`spec/01` §1.8).

use super::params::{Expected, Value, convert, missing_name, wrong_type};
use super::{Names, Policy, Setting, too_many};
use crate::diagnostic::{Diagnostic, Span};
use crate::keywords;
use crate::limits::MAX_INTERACTIONS;
use crate::rules::effects::{self, Arguments, Moves, Undeclared};
use crate::rules::{Counting, EffectInfo, Pass, SpriteType, Timed, TypeInfo};
use crate::syntax::{Description, InteractionLine, Param, Word};
use std::collections::{BTreeMap, BTreeSet};

#[derive(Default)]
pub(super) struct Program {
    pub(super) effects: Vec<EffectInfo>,
    pub(super) edge: Vec<(SpriteType, u16)>,
    pub(super) passes: Vec<Pass>,
    pub(super) timed: Vec<Timed>,
}

/// The number of an unknown keyword: a shield against it has no effect.
pub(super) const NO_KEYWORD: u16 = u16::MAX;

impl Program {
    /// The types to whose sprites some effect can give speed.
    pub(super) fn given_speed(&self, types: &[TypeInfo]) -> BTreeSet<SpriteType> {
        let pairs = self.passes.iter().map(|pass| (pass.first, pass.effect));
        let timed = self.timed.iter().map(|timed| (timed.target.unwrap_or(SpriteType::NONE), timed.effect));
        let executed = pairs.chain(self.edge.iter().copied()).chain(timed);
        // An edge pass of an undeclared type stops the game and has no effect.
        let given = executed
            .filter_map(|(one, effect)| self.effects.get(usize::from(effect))?.summary.gives_speed(one));
        let families = given.filter_map(|stype| types.get(stype.index()));
        families.flat_map(|info| info.tree.iter().copied()).collect()
    }

    /// Effects whose score depends on an earlier execution: an execution may leave the remembered flags alone, because
    /// the collected sprite is not a resource, or because there is no partner at the edge.
    pub(super) fn remembering(&self, types: &[TypeInfo]) -> Vec<u16> {
        let collects = |index: u16| self.effects[usize::from(index)].summary.collects();
        let other = |&stype: &SpriteType| {
            let info = &types[stype.index()];
            info.class.is_some() && !info.traits.is_resource
        };
        let others = |pass: &&Pass| collects(pass.effect) && types[pass.first.index()].tree.iter().any(other);
        let mut paired = vec![false; self.effects.len()];
        self.passes.iter().for_each(|pass| paired[usize::from(pass.effect)] = true);
        let paired = |effect: &u16| paired.get(usize::from(*effect)) == Some(&true);
        let at_edge = self.edge.iter().map(|(_, effect)| *effect).filter(paired);
        let mut found: Vec<u16> =
            self.passes.iter().filter(others).map(|pass| pass.effect).chain(at_edge).collect();
        found.sort_unstable();
        found.dedup();
        found
    }
}

/// Parameters that every effect takes.
pub(super) const COMMON: &[&str] = &[
    "scoreChange",
    "applyScore",
    "repeat",
    "enabled",
    "inBatch",
    "prob",
    "counter",
    "counterElse",
    "count",
    "countElse",
    "is_kill_effect",
    "is_stochastic",
    "sequential",
];

pub(super) fn program(
    description: &Description,
    names: Names<'_>,
    setting: Setting,
    problems: &mut Vec<Diagnostic>,
) -> Program {
    let mut program = Program::default();
    // A pair executes at the place of its first line, whatever lines are in between.
    let mut pairs: Vec<((SpriteType, SpriteType), Vec<u16>)> = Vec::new();
    let mut places: BTreeMap<(SpriteType, SpriteType), usize> = BTreeMap::new();
    let mut edges: Vec<SpriteType> = Vec::new();
    let mut edge_effects: BTreeMap<SpriteType, Vec<u16>> = BTreeMap::new();
    let mut total = 0usize;
    let mut keywords: Vec<u16> = Vec::new();
    for (at, line) in description.interactions.iter().enumerate() {
        let timed = program.timed.len() as u16;
        let mut reader = Reader::new(line, names, setting, timed);
        reader.reported = problems.len();
        let built = reader.line(at);
        let clock = reader.clock();
        let planned = reader.planned.take();
        problems.append(&mut reader.problems);
        if line.second.is_empty() {
            let message = format!("`{}` has no partner", line.first.text);
            problems.push(Diagnostic::error("bad-interaction", line.first.span, message));
        }
        let first = partner(&line.first, names, problems);
        let seconds: Vec<_> = line.second.iter().map(|word| partner(word, names, problems)).collect();
        let Some(Built { info, keyword, repeat, enabled }) = built else { continue };
        let index = program.effects.len() as u16;
        let (score_change, apply_score) = (info.score_change, info.apply_score);
        let own = Timed { effect: index, wrapper: index, score_change, apply_score, line: at, ..clock };
        let target = by_the_clock(line, first, &seconds, problems);
        // A disabled line never runs, but it has its place in the order of the pairs.
        let index = enabled.then_some(index);
        if enabled {
            program.effects.push(EffectInfo { steady: target.is_some(), ..info });
            keywords.push(keyword);
        }
        if let Some((inner, keyword)) = planned.filter(|_| enabled) {
            keywords.push(keyword);
            program.timed.push(Timed { effect: own.effect + 1, first_due: None, ..own });
            program.effects.push(inner);
        }
        if let Some(target) = target.filter(|_| enabled) {
            program.timed.push(Timed { target, ..own });
        }
        for (second, word) in seconds.into_iter().zip(&line.second) {
            match (first, second) {
                (Partner::Sprite(one), Partner::Sprite(two)) => {
                    let at = *places.entry((one, two)).or_insert(pairs.len());
                    if at == pairs.len() {
                        pairs.push(((one, two), Vec::new()));
                    }
                    let copies = index.map_or(0, |_| repeat);
                    total = total.saturating_add(copies);
                    if total <= MAX_INTERACTIONS {
                        pairs[at].1.extend(std::iter::repeat_n(own.effect, copies));
                    }
                }
                (Partner::Sprite(stype), Partner::Edge) | (Partner::Edge, Partner::Sprite(stype)) => {
                    edges.push(stype);
                    edge_effects.entry(stype).or_default().extend(index);
                }
                (Partner::Unknown | Partner::Clock, _) | (_, Partner::Unknown | Partner::Clock) => {}
                (Partner::Edge, Partner::Edge) => {
                    let message = "the edge of the screen does not meet itself";
                    let problem = Diagnostic::error("bad-interaction", word.span, message);
                    problems.push(problem.help("name a sprite before it: `sprite EOS > …`"));
                }
            }
        }
    }
    // A type with n lines has all its effects executed n times, in order each time (`spec/03` §4.4).
    for stype in edges {
        total = total.saturating_add(edge_effects[&stype].len());
        if total <= MAX_INTERACTIONS {
            program.edge.extend(edge_effects[&stype].iter().map(|&effect| (stype, effect)));
        }
    }
    if total > MAX_INTERACTIONS {
        problems.push(too_many(description, "interactions with their repeats", total, MAX_INTERACTIONS));
    }
    for ((first, second), effects) in pairs {
        let (one, two) = (&names.types[first.index()], &names.types[second.index()]);
        let disjoint = one.tree.iter().all(|&t| !two.in_tree(t));
        let ground_aware = one.tree.iter().any(|&t| names.types[t.index()].ground_aware);
        let repeats = two.repeats();
        let one_by_one = ground_aware || one.repeats() || repeats;
        for effect in effects {
            let info = &program.effects[usize::from(effect)];
            let either_side = match info.summary.moves {
                _ if one_by_one || info.in_batch => false,
                Moves::Nothing => true,
                Moves::First => disjoint,
                Moves::Anything => false,
            };
            let keyword = keywords[usize::from(effect)];
            program.passes.push(Pass { first, second, effect, keyword, repeats, either_side });
        }
    }
    program
}

/// The meaning of a name in front of the arrow.
#[derive(Clone, Copy)]
pub(super) enum Partner {
    Sprite(SpriteType),
    Edge,
    Clock,
    Unknown,
}

/// `Some` if the line runs by the clock, with its target if it has one: `sprite TIME` or `TIME sprite` (`spec/03` §6).
fn by_the_clock(
    line: &InteractionLine,
    first: Partner,
    seconds: &[Partner],
    problems: &mut Vec<Diagnostic>,
) -> Option<Option<SpriteType>> {
    let other = match (first, seconds) {
        (Partner::Clock, [other, ..]) => *other,
        (other, [Partner::Clock, ..]) => other,
        _ => {
            if let Some(at) = seconds.iter().position(|second| matches!(second, Partner::Clock)) {
                let message = "TIME must come first, or first among the partners";
                let problem = Diagnostic::error("bad-interaction", line.second[at].span, message);
                problems.push(problem.help("write a line of its own: `sprite TIME > …`"));
            }
            return None;
        }
    };
    if seconds.len() > 1 {
        let message = "a line with TIME acts on one sprite only; the others are ignored";
        let problem = Diagnostic::error("bad-interaction", line.second[1].span, message);
        problems.push(problem.help("write a line for each"));
    }
    match other {
        Partner::Sprite(stype) => Some(Some(stype)),
        _ => Some(None),
    }
}

pub(super) fn partner(word: &Word, names: Names<'_>, problems: &mut Vec<Diagnostic>) -> Partner {
    if let Some(stype) = names.find(&word.text) {
        return Partner::Sprite(stype);
    }
    if word.text.eq_ignore_ascii_case("EOS") {
        return Partner::Edge;
    }
    if word.text.eq_ignore_ascii_case("TIME") {
        return Partner::Clock;
    }
    let problem = names.unknown(word, &["EOS", "TIME"], problems.len());
    problems.push(match word.text.split_once(',') {
        Some((one, _)) if names.find(one).is_some() => {
            problem.help("separate names by blanks: one name before, partners after")
        }
        _ => problem,
    });
    Partner::Unknown
}

/// The number of a keyword among those of all effects.
pub(super) fn number_of(keyword: &str) -> Option<u16> {
    keywords::EFFECTS.iter().position(|known| *known == keyword).map(|at| at as u16)
}

/// Reads a line.
pub(super) struct Reader<'a> {
    line: &'a InteractionLine,
    names: Names<'a>,
    setting: Setting,
    used: Vec<&'a str>,
    pub(super) problems: Vec<Diagnostic>,
    /// The number of problems of the lines before.
    reported: usize,
    /// `true` if the reference makes no effect of the line and stops reading.
    pub(super) failed: bool,
    /// `true` for each of `scoreChange` and `scoreChangeIfKilled` that is not a number.
    score_faults: [bool; 2],
    /// The place that a planned effect of this line will have.
    timed: u16,
    /// The effect that addTimer plans, and the number of its keyword.
    planned: Option<(EffectInfo, u16)>,
}

/// A line made into an effect.
pub(super) struct Built {
    info: EffectInfo,
    /// The number of the keyword.
    keyword: u16,
    /// The number of times that the pass is repeated in a tick.
    repeat: usize,
    enabled: bool,
}

impl<'a> Reader<'a> {
    pub(super) fn new(
        line: &'a InteractionLine,
        names: Names<'a>,
        setting: Setting,
        timed: u16,
    ) -> Reader<'a> {
        let (used, problems) = (Vec::new(), Vec::new());
        let (failed, score_faults, planned) = (false, [false; 2], None);
        Reader { line, names, setting, used, problems, reported: 0, failed, score_faults, timed, planned }
    }

    /// Compiles the line; `None` if there is no such effect.
    pub(super) fn line(&mut self, at: usize) -> Option<Built> {
        let name = self.line.effect.text.as_str();
        let Some(built) = effects::build(name, self).map(EffectInfo::of) else {
            self.unknown_effect(&self.line.effect);
            return None;
        };
        let keyword = number_of(name).expect("built effects are named");
        let score_change = self.score("scoreChange");
        let apply_score = self.flag("applyScore", true);
        let repeat = self.int("repeat", 1).max(0) as usize;
        let enabled = self.flag("enabled", true);
        let counting = self.counting();
        let batches = built.summary.batch.is_some();
        let in_batch = self.flag("inBatch", batches);
        if in_batch && !batches {
            let message = "`inBatch=True` switches an effect off that has no batch form";
            let span = self.param("inBatch").map(Param::span).unwrap_or_default();
            self.problems.push(Diagnostic::error("bad-parameter", span, message).help("remove it"));
        }
        if self.has_clock() {
            self.used.extend(["timer", "nextExecution", "repeating"]);
        }
        self.leftovers(name);
        let score_faults = self.score_faults;
        let info =
            EffectInfo { score_change, apply_score, score_faults, counting, in_batch, line: at, ..built };
        Some(Built { info, keyword, repeat, enabled })
    }

    fn unknown_effect(&mut self, name: &Word) {
        let message = format!("no effect named `{}`", name.text);
        let problem = Diagnostic::error("unknown-effect", name.span, message);
        let problem = problem.help("see `arcade docs effects` for all effects");
        let reported = self.reported + self.problems.len();
        self.problems.push(problem.suggest_after(reported, &name.text, keywords::EFFECTS.iter().copied()));
    }

    /// Reports that the effect lacks a parameter with the name of a thing.
    fn lacks(&mut self, key: &str, thing: &str) {
        let effect = &self.line.effect;
        self.problems.push(missing_name(&format!("`{}`", effect.text), effect.span, key, thing));
    }

    /// Tests whether the line is written with TIME: on the left, or first on the right.
    fn has_clock(&self) -> bool {
        let mut words = std::iter::once(&self.line.first).chain(self.line.second.first());
        words.any(|word| word.text.eq_ignore_ascii_case("TIME"))
    }

    /// Tests whether the reference overlooks unknown parameters: it does so on lines with TIME or addTimer.
    pub(super) fn is_silent(&self) -> bool {
        let line = self.line;
        let words = line.second.iter().chain([&line.first, &line.effect]);
        let mut words = words.chain(line.params.iter().flat_map(|param| [&param.key, &param.value]));
        self.has_clock() || words.any(|word| word.text.contains("addTimer"))
    }

    /// `counter` and `counterElse`, if the game has counters and the line changes them.
    fn counting(&mut self) -> Option<Box<Counting>> {
        if self.setting.counters == 0 {
            return None;
        }
        let counting = Counting {
            count: self.flag("count", true),
            count_else: self.flag("countElse", true),
            counter: self.amounts("counter"),
            counter_else: self.amounts("counterElse"),
        };
        let mut amounts = counting.counter.iter().chain(&counting.counter_else);
        amounts.any(|amount| *amount != Some(0)).then(|| Box::new(counting))
    }

    /// A list with an entry for each counter; missing entries are copies of the first.
    fn amounts(&mut self, key: &'static str) -> Box<[Option<i32>]> {
        let nothing = std::iter::repeat_n(Some(0), self.setting.counters);
        let Some((param, value)) = self.value(key) else { return nothing.collect() };
        let Value::Text(text) = value else {
            let value = &param.value.text;
            let message =
                format!("`{key}` takes a list of whole numbers, an entry for each counter, not `{value}`");
            let problem = Diagnostic::error("wrong-type", param.value.span, message);
            let list = format!("write `{key}={value},{value}`: the reference engine ignores a single number");
            self.problems.push(problem.help(list));
            return nothing.collect();
        };
        let entries: Vec<Option<i32>> =
            text.trim_end_matches(',').split(',').map(|entry| entry.parse().ok()).collect();
        if entries.iter().any(Option::is_none) {
            self.problems.push(wrong_type(param, Expected::Int));
        }
        (0..self.setting.counters).map(|at| *entries.get(at).unwrap_or(&entries[0])).collect()
    }

    /// A problem that makes the reference give up.
    fn fail(&mut self, problem: Diagnostic) {
        self.failed = true;
        self.problems.push(problem);
    }

    /// The timing of a line with TIME; the caller fills in effect, target and score.
    fn clock(&mut self) -> Timed {
        let timer = self.int("timer", -1);
        let repeating = self.flag("repeating", false);
        // The value of `nextExecution` is not used: any but −1 means "first after `timer` ticks".
        let first_due = if self.int("nextExecution", -1) == -1 { -1 } else { timer };
        let endless = repeating && timer <= 0;
        if endless && (self.has_clock() || self.line.effect.text == "addTimer") {
            let span = self.param("timer").map_or(self.line.effect.span, Param::span);
            let message = "an effect that repeats needs a `timer=` above 0, or its tick never ends";
            let problem = Diagnostic::error("endless-timer", span, message);
            self.problems
                .push(problem.help("write `timer=` and the number of ticks between two of its runs"));
        }
        let (effect, wrapper, target, score_change, apply_score, line) = (0, 0, None, 0, true, 0);
        let first_due = Some(first_due);
        Timed { effect, target, timer, repeating, first_due, wrapper, score_change, apply_score, line }
    }

    /// Reports the parameters that no getter has read.
    fn leftovers(&mut self, name: &str) {
        for param in &self.line.params {
            let key = param.key.text.as_str();
            if self.used.contains(&key) {
                continue;
            }
            if self.setting.policy == Policy::Reference && self.is_internal(key) {
                continue;
            }
            if COMMON.contains(&key) {
                let message = format!("`{name}` ignores `{key}`");
                let problem = Diagnostic::warning("ignored-parameter", param.span(), message);
                self.problems.push(match key.starts_with("count") {
                    true => problem.help("give the game counters: `no_counters=1` on its first line"),
                    false => problem.help("remove it"),
                });
                continue;
            }
            let message = format!("`{name}` has no parameter `{key}`");
            let problem = Diagnostic::error("unknown-parameter", param.key.span, message);
            let known = self.used.clone();
            let own: Vec<&str> = known.iter().filter(|known| !COMMON.contains(known)).copied().collect();
            let problem = problem.help(match own[..] {
                [] => format!("remove it: `{name}` has no parameters of its own"),
                _ => format!("remove it, or write one of its own: {}", own.join(", ")),
            });
            let reported = self.reported + self.problems.len();
            self.problems.push(problem.suggest_after(reported, key, known));
        }
    }

    /// Tests whether the reference's effects have a field of that name that is not a parameter.
    fn is_internal(&self, key: &str) -> bool {
        let computed_from = match key {
            "hashCode" => return true,
            "itype" => "stype",
            "resourceId" => "resource",
            "iftype" => "ftype",
            _ => return false,
        };
        self.used.contains(&computed_from)
    }

    /// The parameter of that name; of several, the last one.
    fn param(&self, key: &str) -> Option<&'a Param> {
        self.line.params.iter().rev().find(|param| param.key.text == key)
    }

    fn value(&mut self, key: &'static str) -> Option<(&'a Param, Value<'a>)> {
        self.used.push(key);
        let param = self.param(key)?;
        Some((param, convert(key, &param.value.text)))
    }

    /// A sprite type that the effect requires.
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
            // The value is the name of a constant: the reference drops it.
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
            let problem = Diagnostic::error("bad-parameter", span, "addTimer cannot plan itself");
            self.fail(problem.help("name another effect"));
            return 0;
        }
        // The line as the planned effect reads it.
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
