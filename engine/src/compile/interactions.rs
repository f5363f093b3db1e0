//! The InteractionSet as a flat program: effects, edge passes, pair passes in execution order (`spec/01` §1.8).

use super::params::{Expected, Value, convert, wrong_type};
use super::{MAX_PASSES, Names};
use crate::diagnostic::{Diagnostic, Span};
use crate::game::{EffectInfo, Pass, SpriteType, Timed};
use crate::ontology::effects::{self, Arguments, Effect, Moves};
use crate::syntax::{Description, InteractionLine, Param, Word};

#[derive(Default)]
pub(super) struct Program {
    pub(super) effects: Vec<EffectInfo>,
    pub(super) edge: Vec<(SpriteType, u16)>,
    pub(super) passes: Vec<Pass>,
    pub(super) timed: Vec<Timed>,
}

/// Parameters that every effect takes.
const COMMON: &[&str] = &[
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
    problems: &mut Vec<Diagnostic>,
) -> Program {
    let mut program = Program::default();
    // Pairs execute where they first appear, whatever stands between their lines.
    let mut pairs: Vec<((SpriteType, SpriteType), Vec<u16>)> = Vec::new();
    let mut edges: Vec<SpriteType> = Vec::new();
    let mut edge_effects: Vec<(SpriteType, u16)> = Vec::new();
    let mut keywords: Vec<u16> = Vec::new();
    for (at, line) in description.interactions.iter().enumerate() {
        let timed = program.timed.len() as u16;
        let mut reader = Reader { line, names, used: Vec::new(), problems: Vec::new(), timed, planned: None };
        let built = reader.line(at);
        let clock = reader.clock();
        let planned = reader.planned.take();
        problems.append(&mut reader.problems);
        if line.second.is_empty() {
            let message = "an interaction needs a partner before the `>`";
            problems.push(Diagnostic::error("bad-interaction", line.first.span, message));
        }
        let first = partner(&line.first, names, problems);
        let seconds: Vec<_> = line.second.iter().map(|word| partner(word, names, problems)).collect();
        let Some((Some(info), keyword, repeat)) = built else { continue };
        let index = program.effects.len() as u16;
        let (score_change, apply_score) = (info.score_change, info.apply_score);
        program.effects.push(info);
        keywords.push(keyword);
        if let Some((inner, keyword, timed)) = planned {
            keywords.push(keyword);
            program.timed.push(Timed { effect: index + 1, score_change, apply_score, line: at, ..timed });
            program.effects.push(inner);
        }
        if let Some(target) = by_the_clock(line, first, &seconds, problems) {
            program.timed.push(Timed { effect: index, target, score_change, apply_score, line: at, ..clock });
            continue;
        }
        for (second, word) in seconds.into_iter().zip(&line.second) {
            match (first, second) {
                (Partner::Sprite(one), Partner::Sprite(two)) => {
                    let found = pairs.iter().position(|(pair, _)| *pair == (one, two));
                    let at = found.unwrap_or_else(|| {
                        pairs.push(((one, two), Vec::new()));
                        pairs.len() - 1
                    });
                    pairs[at].1.extend(std::iter::repeat_n(index, repeat.min(MAX_PASSES)));
                }
                (Partner::Sprite(stype), Partner::Edge) | (Partner::Edge, Partner::Sprite(stype)) => {
                    edges.push(stype);
                    edge_effects.push((stype, index));
                }
                (Partner::Unknown | Partner::Clock, _) | (_, Partner::Unknown | Partner::Clock) => {}
                (Partner::Edge, Partner::Edge) => {
                    let message = "the edge of the screen has no edge: one of the two is a sprite";
                    problems.push(Diagnostic::error("bad-interaction", word.span, message));
                }
            }
        }
    }
    // A type with n lines has all its effects executed n times, in order each time (`spec/03` §4.4).
    for stype in edges {
        program.edge.extend(edge_effects.iter().filter(|(other, _)| *other == stype));
    }
    for ((first, second), effects) in pairs {
        let disjoint =
            names.types[first.index()].tree.iter().all(|&t| !names.types[second.index()].in_tree(t));
        let ground_aware =
            names.types[first.index()].tree.iter().any(|&t| names.types[t.index()].ground_aware);
        for effect in effects {
            let info = &program.effects[usize::from(effect)];
            let either_side = match info.effect.moves() {
                _ if ground_aware || info.in_batch => false,
                Moves::Nothing => true,
                Moves::First => disjoint,
                Moves::Anything => false,
            };
            let keyword = keywords[usize::from(effect)];
            program.passes.push(Pass { first, second, effect, keyword, either_side });
        }
    }
    program
}

/// What the reference makes of a line: all of it, the partners before the first unknown one, or nothing; and how many
/// messages it logs about parameters.
pub(super) fn usable(line: &InteractionLine, names: Names<'_>) -> (Option<InteractionLine>, u32) {
    let mut reader = Reader { line, names, used: Vec::new(), problems: Vec::new(), timed: 0, planned: None };
    let built = reader.line(0);
    reader.clock();
    let fatal = |problem: &Diagnostic| super::FATAL.contains(&problem.code);
    if built.is_none() || reader.problems.iter().any(fatal) {
        return (None, 0);
    }
    let silent = reader.has_clock() || line.effect.text == "addTimer";
    let unknown = reader.problems.iter().filter(|problem| problem.code == "unknown-parameter").count() as u32;
    let passes = if line.effect.text == "transformIfCount" { 2 } else { 1 };
    let logged = if silent { 0 } else { passes * unknown };
    let known = |word: &&Word| !matches!(partner(word, names, &mut Vec::new()), Partner::Unknown);
    let by_the_clock = reader.has_clock();
    if !by_the_clock && !known(&&line.first) {
        return (None, logged);
    }
    let second: Vec<Word> =
        line.second.iter().take_while(|word| by_the_clock || known(word)).cloned().collect();
    if second.is_empty() {
        return (None, logged);
    }
    (Some(InteractionLine { second, ..line.clone() }), logged)
}

#[derive(Clone, Copy)]
enum Partner {
    Sprite(SpriteType),
    Edge,
    Clock,
    Unknown,
}

/// Whether the line runs by the clock, and then on which type: `sprite TIME` or `TIME sprite` (`spec/03` §6).
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
                let message = "TIME stands first, or first among the partners";
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

fn partner(word: &Word, names: Names<'_>, problems: &mut Vec<Diagnostic>) -> Partner {
    if let Some(stype) = names.find(&word.text) {
        return Partner::Sprite(stype);
    }
    if word.text.eq_ignore_ascii_case("EOS") {
        return Partner::Edge;
    }
    if word.text.eq_ignore_ascii_case("TIME") {
        return Partner::Clock;
    }
    problems.push(names.unknown(word, &["EOS", "TIME"]));
    Partner::Unknown
}

struct Reader<'a> {
    line: &'a InteractionLine,
    names: Names<'a>,
    used: Vec<&'a str>,
    problems: Vec<Diagnostic>,
    /// The place that a planned effect of this line will have.
    timed: u16,
    /// What addTimer plans: the effect, its keyword's place, when it runs.
    planned: Option<(EffectInfo, u16, Timed)>,
}

impl<'a> Reader<'a> {
    /// The effect (None if it never runs), its keyword's place, and how often it is repeated; None if there is no such
    /// effect.
    fn line(&mut self, at: usize) -> Option<(Option<EffectInfo>, u16, usize)> {
        let name = self.line.effect.text.as_str();
        let effect: Option<Effect> = effects::build(name, self);
        let Some(effect) = effect else {
            let message = format!("no effect named `{name}`");
            let problem = Diagnostic::error("unknown-effect", self.line.effect.span, message);
            self.problems.push(problem.suggest(name, effects::NAMES.iter().copied()));
            return None;
        };
        let keyword =
            effects::NAMES.iter().position(|known| *known == name).expect("built effects are named");
        let score_change = self.score("scoreChange");
        let apply_score = self.flag("applyScore", true);
        let repeat = self.int("repeat", 1);
        let enabled = self.flag("enabled", true);
        let batches = matches!(effect, Effect::WallBounce | Effect::WallReverse);
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
        let info = EffectInfo { effect, score_change, apply_score, in_batch, line: at };
        Some((enabled.then_some(info), keyword as u16, repeat.max(0) as usize))
    }

    fn has_clock(&self) -> bool {
        let mut words = std::iter::once(&self.line.first).chain(&self.line.second);
        words.any(|word| word.text.eq_ignore_ascii_case("TIME"))
    }

    /// When a line with TIME runs; its effect, target and score are filled in by the caller.
    fn clock(&mut self) -> Timed {
        let timer = self.int("timer", -1);
        let repeating = self.flag("repeating", false);
        // The value of `nextExecution` is not used: any but −1 means "first after `timer` ticks".
        let first_due = if self.int("nextExecution", -1) == -1 { -1 } else { timer };
        let endless = repeating && timer <= 0;
        if endless && (self.has_clock() || self.line.effect.text == "addTimer") {
            let message = "a repeating effect needs `timer=`, a number of ticks above 0";
            let problem = Diagnostic::error("endless-timer", self.line.effect.span, message);
            self.problems.push(problem.help("the reference engine would never return"));
        }
        let (effect, target, score_change, apply_score, line) = (0, None, 0, true, 0);
        let first_due = Some(first_due);
        Timed { effect, target, timer, repeating, first_due, score_change, apply_score, line }
    }

    /// Parameters that nothing has asked for.
    fn leftovers(&mut self, name: &str) {
        for param in &self.line.params {
            let key = param.key.text.as_str();
            if self.used.contains(&key) {
                continue;
            }
            if COMMON.contains(&key) {
                let message = format!("`{name}` ignores `{key}`");
                self.problems
                    .push(Diagnostic::warning("ignored-parameter", param.span(), message).help("remove it"));
                continue;
            }
            let message = format!("`{name}` has no parameter `{key}`");
            let problem = Diagnostic::error("unknown-parameter", param.key.span, message);
            let known = self.used.clone();
            self.problems.push(problem.suggest(key, known));
        }
    }

    /// The last parameter of that name counts.
    fn param(&self, key: &str) -> Option<&'a Param> {
        self.line.params.iter().rev().find(|param| param.key.text == key)
    }

    fn value(&mut self, key: &'static str) -> Option<(&'a Param, Value<'a>)> {
        self.used.push(key);
        let param = self.param(key)?;
        Some((param, convert(key, &param.value.text)))
    }

    /// A sprite that the effect makes, kills or counts.
    fn named(&mut self, text: &str, span: Span) -> Option<SpriteType> {
        self.names.resolve(&Word { text: text.to_owned(), span }, &mut self.problems)
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
            Some((_, Value::Double(double))) => double,
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
        let Some((param, _)) = self.value(key) else { return 0 };
        let first = param.value.text.split(',').next().unwrap_or_default();
        first.parse().unwrap_or_else(|_| {
            self.problems.push(wrong_type(param, Expected::Int));
            0
        })
    }

    fn sprite(&mut self, key: &'static str) -> SpriteType {
        let found = self.optional_sprite(key);
        if found.is_none() && self.param(key).is_none() {
            let effect = &self.line.effect;
            let message = format!("`{}` needs `{key}=`, the name of a sprite", effect.text);
            let problem = Diagnostic::error("missing-parameter", effect.span, message);
            self.problems.push(problem.help(format!("add `{key}=` and the name")));
        }
        let makes = matches!(
            (self.line.effect.text.as_str(), key),
            ("transformTo" | "spawn" | "spawnIfHasMore" | "spawnIfHasLess" | "spawnBehind", "stype")
                | ("spawnAbove" | "spawnBelow" | "spawnLeft" | "spawnRight", "stype")
                | ("transformToAll", "stypeTo")
        );
        if let (Some(stype), Some(param), true) = (found, self.param(key), makes) {
            self.names.instantiable(stype, &param.value, &mut self.problems);
        }
        found.unwrap_or(SpriteType(0))
    }

    fn optional_sprite(&mut self, key: &'static str) -> Option<SpriteType> {
        match self.value(key)? {
            (param, Value::Text(text)) => self.named(text, param.value.span),
            (param, _) => {
                self.problems.push(wrong_type(param, Expected::Text));
                None
            }
        }
    }

    fn sprites(&mut self, key: &'static str) -> Vec<SpriteType> {
        let Some((param, value)) = self.value(key) else { return Vec::new() };
        let Value::Text(text) = value else {
            self.problems.push(wrong_type(param, Expected::Text));
            return Vec::new();
        };
        text.split(',').filter_map(|name| self.named(name, param.value.span)).collect()
    }

    fn keyword(&mut self, key: &'static str) -> u16 {
        let Some((param, _)) = self.value(key) else {
            let effect = &self.line.effect;
            let message = format!("`{}` needs `{key}=`, the name of an effect", effect.text);
            let problem = Diagnostic::error("missing-parameter", effect.span, message);
            self.problems.push(problem.help(format!("add `{key}=` and the name")));
            return 0;
        };
        let name = param.value.text.as_str();
        let found = effects::NAMES.iter().position(|known| *known == name);
        found.unwrap_or_else(|| {
            let message = format!("no effect named `{name}`");
            let problem = Diagnostic::error("unknown-effect", param.value.span, message);
            self.problems.push(problem.suggest(name, effects::NAMES.iter().copied()));
            0
        }) as u16
    }

    fn timed(&mut self) -> u16 {
        let keyword = self.keyword("ftype");
        let name = effects::NAMES[usize::from(keyword)];
        if name == "addTimer" {
            let span = self.param("ftype").map(Param::span).unwrap_or_default();
            self.problems.push(Diagnostic::error("bad-parameter", span, "addTimer cannot plan itself"));
            return 0;
        }
        if let Some(effect) = effects::build(name, self) {
            let timed = Timed { first_due: None, ..self.clock() };
            let info = EffectInfo { effect, score_change: 0, apply_score: true, in_batch: false, line: 0 };
            self.planned = Some((info, keyword, timed));
        }
        self.timed
    }

    fn relatives(&self, stype: SpriteType) -> Box<[SpriteType]> {
        self.names.types[stype.index()].tree.iter().copied().filter(|&other| other != stype).collect()
    }
}
