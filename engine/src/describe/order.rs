//! Describes the course of a tick in plain English.

use super::phrases::Phrase;
use super::rules::way;
use super::sprites::{chase, distance, is_updated_at_once};
use super::words::list;
use crate::analysis::{Analysis, Condition, EffectSummary, Encounter, Goal, Motion, Side};
use crate::rules::SpriteType;
use crate::rules::class::SpriteClass;
use crate::rules::effects::Gives;

/// Returns the facts about ticks that matter in a game.
pub(super) fn order(analysis: &Analysis) -> Vec<String> {
    let movers: Vec<SpriteType> = possible(analysis)
        .filter(|&stype| !matches!(analysis.facts(stype).motion, Motion::Still | Motion::Steered))
        .collect();
    let traits = |stype: SpriteType| &analysis.game().0.types[stype.index()].traits;
    let acts = |stype: SpriteType| {
        let facts = analysis.facts(stype);
        facts.motion != Motion::Steered
            && (facts.motion != Motion::Still
                || analysis.is_set_off(stype)
                || facts.fleeting
                || !facts.makes.is_empty())
    };
    let others = possible(analysis).any(acts);
    let first = if others { Phrase::YouThenOthers } else { Phrase::YouThenContacts };
    let lines = [first, Phrase::Touch];
    let mut lines: Vec<String> = lines.into_iter().map(|phrase| phrase.with(&[])).collect();
    let paced: Vec<SpriteType> = movers.iter().copied().filter(|&stype| traits(stype).cooldown > 1).collect();
    if !paced.is_empty() {
        let sooner = paced.iter().filter(|&&stype| is_updated_at_once(analysis, stype).0);
        let names: Vec<&str> = sooner.map(|&stype| analysis.game().name(stype)).collect();
        let sooner = if names.is_empty() {
            String::new()
        } else {
            Phrase::Sooner.with(&[("names", &list(&names, "and"))])
        };
        lines.push(Phrase::Period.with(&[("sooner", &sooner)]));
    }
    let rests = |stype: &SpriteType| {
        matches!(analysis.facts(*stype).motion, Motion::Straight(_)) && traits(*stype).cooldown < 2
    };
    let resting: Vec<SpriteType> = movers.iter().copied().filter(rests).collect();
    if !resting.is_empty() {
        // A shot is already updated in the tick in which it appears.
        let is_soon = resting.iter().any(|&stype| is_updated_at_once(analysis, stype).0);
        let phrase = if is_soon { Phrase::RestFirst } else { Phrase::Rest };
        lines.push(phrase.with(&[]));
    }
    let glides = |&stype: &SpriteType| {
        let (pace, traits) = (analysis.facts(stype).pace, traits(stype));
        traits.continuous || (pace > 0.0 && traits.speed > 0.0 && traits.speed.fract() != 0.0)
    };
    if possible(analysis).any(|stype| glides(&stype)) {
        lines.push(Phrase::Glide.with(&[]));
    }
    if analysis.has_timed_effects() {
        lines.push(Phrase::Clock.with(&[]));
    }
    if blocking_matters(analysis) {
        lines.push(Phrase::PutBack.with(&[]));
    }
    let reopened = reopens(analysis);
    if reopened || lingers(analysis) {
        let reopened = if reopened { Phrase::Reopened.text() } else { "" };
        lines.push(Phrase::Lingers.with(&[("reopened", reopened)]));
    }
    let gives = |what: fn(Gives) -> bool| {
        analysis.game().0.effects.iter().any(|info| info.summary.gives.is_some_and(what))
    };
    let is_collected = |stype: &SpriteType| analysis.facts(*stype).is_resource;
    let counts_collected =
        || analysis.goals().iter().any(|goal| goal.condition.types().iter().any(is_collected));
    let collects = gives(|gives| matches!(gives, Gives::First { .. }));
    if collects && counts_collected() {
        lines.push(Phrase::HeldUncounted.with(&[]));
    }
    if collects {
        lines.push(Phrase::AtLimit.with(&[]));
    }
    if gives(|gives| matches!(gives, Gives::Amount { value, .. } if value > 0)) {
        lines.push(Phrase::TooMuch.with(&[]));
    }
    lines.extend(pursuit(analysis, &movers));
    lines.extend(tie(analysis));
    lines
}

fn possible(analysis: &Analysis) -> impl Iterator<Item = SpriteType> + '_ {
    analysis.game().sprite_types().filter(|&stype| analysis.facts(stype).possible)
}

fn pursuit(analysis: &Analysis, movers: &[SpriteType]) -> Vec<String> {
    let game = analysis.game();
    let motions = || movers.iter().map(|&stype| analysis.facts(stype).motion);
    let mut lines = Vec::new();
    let by_steps = |stype: &SpriteType| {
        let class = game.0.types[stype.index()].class;
        matches!(analysis.facts(*stype).motion, Motion::Chasing(_)) && chase(class) != Phrase::Follows
    };
    if movers.iter().any(by_steps) {
        lines.push(Phrase::ChaseStep.with(&[]));
    }
    let by_paths = |stype: &SpriteType| {
        let class = game.0.types[stype.index()].class;
        matches!(analysis.facts(*stype).motion, Motion::Chasing(_)) && chase(class) == Phrase::Follows
    };
    if game.0.finds_paths && movers.iter().any(by_paths) {
        lines.push(paths(analysis));
    }
    if motions().any(|motion| matches!(motion, Motion::Fleeing(_))) {
        lines.push(Phrase::FleeStep.with(&[]));
    }
    // Without a target, sprites that follow paths stay where they are.
    let steps_at_random = |stype: &SpriteType| {
        let class = game.0.types[stype.index()].class;
        class.is_some_and(|class| class.is_a(SpriteClass::Chaser) && class != SpriteClass::PathChaser)
    };
    let follows = |stype: &SpriteType| match analysis.facts(*stype).motion {
        Motion::Chasing(target) | Motion::Fleeing(target) => {
            let far = distance(analysis, &game.0.types[stype.index()].traits).is_some();
            let you = analysis.avatars().iter().any(|avatar| analysis.applies(target, avatar.stype));
            (far || !you).then_some(far)
        }
        _ => None,
    };
    let lost: Vec<bool> = movers.iter().filter(|stype| steps_at_random(stype)).filter_map(follows).collect();
    if !lost.is_empty() {
        let near = if lost.contains(&true) { " in reach" } else { "" };
        lines.push(Phrase::NoTarget.with(&[("near", near)]));
    }
    lines
}

/// Returns the sentence about the obstacles that paths avoid. The engine marks obstacles once per level, and
/// ignores hidden ones.
fn paths(analysis: &Analysis) -> String {
    let game = analysis.game();
    let is_marked = |stype: &SpriteType| {
        let facts = analysis.facts(*stype);
        facts.possible && !facts.symbols.is_empty() && !game.0.types[stype.index()].traits.hidden
    };
    let marked = game.sprite_types().filter(|stype| game.0.obstacles.contains(stype) && is_marked(stype));
    let names: Vec<&str> = marked.map(|stype| game.name(stype)).collect();
    match names[..] {
        [] => Phrase::PathsFree.with(&[]),
        _ => Phrase::Paths.with(&[("obstacles", &format!("the {}", list(&names, "and")))]),
    }
}

/// Returns `true` if two encounters can involve the same two sprites, in either order.
fn same_pair(analysis: &Analysis, one: &Encounter, other: &Encounter) -> bool {
    let alike = |a: SpriteType, b: SpriteType| {
        possible(analysis).any(|stype| analysis.applies(a, stype) && analysis.applies(b, stype))
    };
    let (Some(second), Some(other_second)) = (one.second, other.second) else { return false };
    (alike(one.first, other.first) && alike(second, other_second))
        || (alike(one.first, other_second) && alike(second, other.first))
}

/// Returns `true` if, for some pair, one line moves a sprite back, and it matters whether another line comes
/// before or after that line.
fn blocking_matters(analysis: &Analysis) -> bool {
    let encounters = analysis.encounters();
    let blockers = encounters.iter().filter(|encounter| encounter.blocks());
    let counts = |other: &Encounter| !other.blocks() && !other.does(|effect| *effect == EffectSummary::Turn);
    blockers
        .into_iter()
        .any(|blocker| encounters.iter().any(|other| counts(other) && same_pair(analysis, blocker, other)))
}

/// Returns `true` if the player can remove a blocking sprite in the same tick in which it blocks.
fn reopens(analysis: &Analysis) -> bool {
    let is_you = |stype: SpriteType| analysis.avatars().iter().any(|a| analysis.applies(stype, a.stype));
    let encounters = analysis.encounters();
    encounters.iter().filter(|encounter| encounter.blocks() && is_you(encounter.first)).any(|blocker| {
        encounters.iter().any(|other| {
            let removes = (other.ends(Side::First) && other.second.is_some_and(is_you))
                || (other.ends(Side::Second) && is_you(other.first));
            removes && other.line < blocker.line && same_pair(analysis, blocker, other)
        })
    })
}

/// Returns `true` if any sprites that vanish on their own affect other sprites.
fn lingers(analysis: &Analysis) -> bool {
    let acts = |stype: SpriteType| {
        let touched =
            |encounter: &Encounter| encounter.second.is_some_and(|second| analysis.applies(second, stype));
        analysis.encounters().iter().any(touched)
    };
    possible(analysis).any(|stype| analysis.facts(stype).fleeting && acts(stype))
}

/// Returns the sentence about ticks in which several terminations hold; `None` if no sentence is needed.
fn tie(analysis: &Analysis) -> Option<String> {
    let goals = analysis.goals();
    let decided_by = |goal: &Goal| analysis.game().0.terminations[goal.line].decided_by;
    // The score and the counters decide both terminations in the same way.
    let alike = |one: &Goal, two: &Goal| one.is_open() && decided_by(one) == decided_by(two);
    let pairs =
        || goals.iter().enumerate().flat_map(|(at, one)| goals[at + 1..].iter().map(move |two| (one, two)));
    let pairs = || pairs().filter(|(one, two)| !alike(one, two));
    let wins_first = pairs().any(|(one, two)| one.win && two.can_lose());
    let loses_first = pairs().any(|(one, two)| one.can_lose() && two.win);
    let told = |goals: &[Goal], word: &str| {
        let ways: Vec<String> = goals.iter().map(|goal| way(analysis, goal)).collect();
        list(&ways, word)
    };
    let first_win = goals.iter().position(|goal| goal.win)?;
    let last_win = goals.iter().rposition(|goal| goal.win)?;
    let is_run = goals[first_win..=last_win].iter().all(|goal| goal.win);
    Some(match (wins_first, loses_first) {
        (false, false) => return None,
        (false, true) => Phrase::TieLost.with(&[]),
        (true, false) => Phrase::TieWon.with(&[]),
        (true, true) if is_run && !goals.iter().any(Goal::is_open) => {
            let ways = told(&goals[..first_win], "or");
            let is_time = |goal: &Goal| matches!(goal.condition, Condition::Tick(_));
            let only_time_is_later =
                !goals[..=last_win].iter().any(is_time) && goals[last_win + 1..].iter().all(is_time);
            if ways == Phrase::Gone.text() {
                Phrase::TieUnlessDead.with(&[])
            } else if only_time_is_later {
                Phrase::TieUnlessTime.with(&[])
            } else {
                Phrase::TieMixed.with(&[("ways", &ways)])
            }
        }
        (true, true) => {
            let each = goals.iter().map(|goal| {
                let verb = match (goal.win, goal.can_lose()) {
                    (true, true) => "you win or lose",
                    (true, false) => "you win",
                    (false, _) => "you lose",
                };
                format!("{verb} {}", way(analysis, goal))
            });
            Phrase::TieOrder.with(&[("ways", &each.collect::<Vec<String>>().join("; "))])
        }
    })
}
