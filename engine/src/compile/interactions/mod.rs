//! Compiles the InteractionSet into a flat program: effects, edge passes, and pair passes in execution order (`spec/01`
//! §1.8).

mod arguments;
mod line;

use super::{Names, Setting, too_many};
use crate::diagnostic::Diagnostic;
use crate::limits::MAX_INTERACTIONS;
use crate::rules::effects::{Moves, SpeedEffect};
use crate::rules::{EffectInfo, Pass, SpriteType, Timed, TypeInfo};
use crate::syntax::{Description, InteractionLine, Word};
pub(super) use arguments::{NO_KEYWORD, number_of};
use line::Built;
pub(super) use line::{COMMON, Reader};
use std::collections::{BTreeMap, BTreeSet};

#[derive(Default)]
pub(super) struct Program {
    pub(super) effects: Vec<EffectInfo>,
    pub(super) edge: Vec<(SpriteType, u16)>,
    pub(super) passes: Vec<Pass>,
    pub(super) timed: Vec<Timed>,
}

impl Program {
    /// Returns the types whose sprites can gain speed from some effect.
    pub(super) fn given_speed(&self, types: &[TypeInfo]) -> BTreeSet<SpriteType> {
        let pairs = self.passes.iter().map(|pass| (pass.first, pass.effect));
        let timed = self.timed.iter().map(|timed| (timed.target.unwrap_or(SpriteType::NONE), timed.effect));
        let executed = pairs.chain(self.edge.iter().copied()).chain(timed);
        let given = executed.filter_map(|(one, effect)| {
            let summary = &self.effects[usize::from(effect)].summary;
            let info = types.get(summary.gives_speed(one)?.index())?;
            Some((info, summary.speed == Some(SpeedEffect::Force)))
        });
        let taken = |stype: &SpriteType, forced: bool| !forced || types[stype.index()].traits.continuous;
        given
            .flat_map(|(info, forced)| info.tree.iter().filter(move |stype| taken(stype, forced)).copied())
            .collect()
    }

    /// Returns the effects whose score depends on an earlier execution. These effects may leave their memory
    /// ([`memory`](crate::rules::memory)) unchanged, because the collected sprite is not a resource, or
    /// because there is no partner at the edge.
    pub(super) fn remembering(&self, types: &[TypeInfo]) -> Vec<u16> {
        let collects = |index: u16| self.effects[usize::from(index)].summary.collects();
        let other = |&stype: &SpriteType| {
            let info = &types[stype.index()];
            info.class.is_some() && !info.traits.is_resource
        };
        let others = |pass: &&Pass| collects(pass.effect) && types[pass.first.index()].tree.iter().any(other);
        let mut paired = vec![false; self.effects.len()];
        self.passes.iter().for_each(|pass| paired[usize::from(pass.effect)] = true);
        let paired = |effect: &u16| paired[usize::from(*effect)];
        let at_edge = self.edge.iter().map(|(_, effect)| *effect).filter(paired);
        let mut found: Vec<u16> =
            self.passes.iter().filter(others).map(|pass| pass.effect).chain(at_edge).collect();
        found.sort_unstable();
        found.dedup();
        found
    }
}

pub(super) fn program(
    description: &Description,
    names: Names<'_>,
    setting: Setting,
    problems: &mut Vec<Diagnostic>,
) -> Program {
    let mut program = Program::default();
    // A pair executes at the position of its first line, regardless of the lines in between.
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
        // A disabled line never runs, but it keeps its position in the order of the pairs.
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
                    problems.push(problem.help("write a sprite before it: `sprite EOS > …`"));
                }
            }
        }
    }
    // If a type has n lines, all its effects run n times, in the same order each time (`spec/03` §4.4).
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

/// The meaning of a name before the arrow.
#[derive(Clone, Copy)]
pub(super) enum Partner {
    Sprite(SpriteType),
    Edge,
    Clock,
    Unknown,
}

/// Returns the target, if any, of a timed line, which is `sprite TIME` or `TIME sprite` (`spec/03` §6). The
/// outer option is `None` if the line is not timed.
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
                problems.push(problem.help("write a separate line: `sprite TIME > …`"));
            }
            return None;
        }
    };
    if seconds.len() > 1 {
        let message = "a line with TIME acts on only one sprite; the other sprites are ignored";
        let problem = Diagnostic::error("bad-interaction", line.second[1].span, message);
        problems.push(problem.help("write one line for each sprite"));
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
            problem.help("separate names with spaces: one name before, partners after")
        }
        _ => problem,
    });
    Partner::Unknown
}
