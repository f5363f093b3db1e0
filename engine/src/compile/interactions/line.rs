//! Compiles an InteractionSet line into an effect, including the parameters that all lines accept.

use super::super::{Names, Policy, Setting};
use super::arguments::number_of;
use crate::diagnostic::Diagnostic;
use crate::keywords;
use crate::limits::MAX_PROBLEMS;
use crate::meanings::Place;
use crate::rules::effects::{self, Arguments};
use crate::rules::{Counting, EffectInfo, Timed};
use crate::syntax::{InteractionLine, Param, Word};

/// The parameters that every effect accepts.
pub(in crate::compile) const COMMON: &[&str] = &[
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

/// The state of the compiler for one line.
pub(in crate::compile) struct Reader<'a> {
    pub(super) line: &'a InteractionLine,
    pub(super) names: Names<'a>,
    pub(super) setting: Setting,
    pub(super) used: Vec<&'a str>,
    pub(in crate::compile) problems: Vec<Diagnostic>,
    /// The number of problems on earlier lines.
    pub(super) reported: usize,
    /// `true` if the reference builds no effect from the line and stops reading the file.
    pub(in crate::compile) failed: bool,
    /// For each of `scoreChange` and `scoreChangeIfKilled`, `true` if the value is not a number.
    pub(super) score_faults: [bool; 2],
    /// The index, among the timed effects, of the effect that this line schedules.
    pub(super) timed: u16,
    /// The effect that addTimer schedules, and the index of the effect's keyword; `None` for any other effect.
    pub(super) planned: Option<(EffectInfo, u16)>,
}

/// A line compiled into an effect.
pub(in crate::compile) struct Built {
    pub(super) info: EffectInfo,
    /// The keyword's index.
    pub(super) keyword: u16,
    /// The number of times that the pass runs per tick.
    pub(super) repeat: usize,
    pub(super) enabled: bool,
}

impl<'a> Reader<'a> {
    pub(in crate::compile) fn new(
        line: &'a InteractionLine,
        names: Names<'a>,
        setting: Setting,
        timed: u16,
    ) -> Reader<'a> {
        let (used, problems) = (Vec::new(), Vec::new());
        let (failed, score_faults, planned) = (false, [false; 2], None);
        Reader { line, names, setting, used, problems, reported: 0, failed, score_faults, timed, planned }
    }

    /// Compiles the line. Returns `None` if its effect does not exist.
    pub(in crate::compile) fn line(&mut self, at: usize) -> Option<Built> {
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
            let message = "`inBatch=True` switches off an effect that has no batch form";
            let span = self.param("inBatch").map(Param::span).unwrap_or_default();
            let problem = Diagnostic::error("bad-parameter", span, message).help("remove the parameter");
            self.problems.push(problem.remove(span, "inBatch"));
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

    pub(super) fn unknown_effect(&mut self, name: &Word) {
        let message = format!("no effect named `{}`", name.text);
        let problem = Diagnostic::error("unknown-effect", name.span, message);
        let problem = problem.help("see `arcade docs effects` for all effects");
        let reported = self.reported + self.problems.len();
        let effects = keywords::EFFECTS.iter().copied();
        self.problems.push(problem.mean_after(reported, Place::Effect, &name.text, effects));
    }

    /// Returns `true` if the line contains TIME on the left, or first on the right.
    fn has_clock(&self) -> bool {
        let mut words = std::iter::once(&self.line.first).chain(self.line.second.first());
        words.any(|word| word.text.eq_ignore_ascii_case("TIME"))
    }

    /// Returns `true` if the reference ignores unknown parameters on this line, as it does on lines with TIME
    /// or addTimer.
    pub(in crate::compile) fn is_silent(&self) -> bool {
        let line = self.line;
        let words = line.second.iter().chain([&line.first, &line.effect]);
        let mut words = words.chain(line.params.iter().flat_map(|param| [&param.key, &param.value]));
        self.has_clock() || words.any(|word| word.text.contains("addTimer"))
    }

    /// Returns `counter` and `counterElse`, if the game has counters and the line changes their values.
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

    /// Returns the timing of a line with TIME. The caller sets the effect, the target and the score.
    pub(super) fn clock(&mut self) -> Timed {
        let timer = self.int("timer", -1);
        let repeating = self.flag("repeating", false);
        // The value of `nextExecution` itself is not used: any value other than −1 means that the effect
        // first runs after `timer` ticks.
        let first_due = if self.int("nextExecution", -1) == -1 { -1 } else { timer };
        let endless = repeating && timer <= 0;
        if endless && (self.has_clock() || self.line.effect.text == "addTimer") {
            let span = self.param("timer").map_or(self.line.effect.span, Param::span);
            let message = "a repeated effect needs a `timer=` above 0, or the tick never ends";
            let problem = Diagnostic::error("endless-timer", span, message);
            self.problems
                .push(problem.help("write `timer=` and the number of ticks between two repetitions"));
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
                    false => problem.help("remove the parameter").remove(param.span(), key),
                });
                continue;
            }
            let message = format!("`{name}` has no parameter `{key}`");
            let problem = Diagnostic::error("unknown-parameter", param.key.span, message);
            let known = self.used.clone();
            let own: Vec<&str> = known.iter().filter(|known| !COMMON.contains(known)).copied().collect();
            let problem = problem.help(match own[..] {
                [] => format!("remove the parameter: `{name}` has no parameters of its own"),
                _ => format!("remove the parameter, or use a parameter of this effect: {}", own.join(", ")),
            });
            let reported = self.reported + self.problems.len();
            let problem = problem.mean_after(reported, Place::EffectParameter, key, known);
            self.problems.push(match reported < MAX_PROBLEMS {
                true => problem.or_remove(param.span(), key),
                false => problem,
            });
        }
    }

    /// Returns `true` if effects in the reference have a field with this name that is not a parameter.
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
}
