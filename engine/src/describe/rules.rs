//! Describes interactions and terminations in plain English.

use super::fill::{by_the_clock, if_scored, when_they_meet};
use super::phrases::Phrase;
use super::swap::{self, Swap};
use super::words::{Party, count, list, members, plural, sentence};
use crate::analysis::{Analysis, Condition, EffectSummary, Encounter, Goal, Motion, Side};
use crate::rules::effects::{Sentence, Target};
use crate::rules::terminations::{Condition as Written, Decision, Termination};
use crate::rules::{Counting, Rules, SpriteType, Timed};

/// Returns one sentence per interaction line, in order of execution, covering all the line's partners. A line
/// runs at several positions if an earlier line already contains one of its pairs, and then gets one sentence
/// for each position. The three lines of a swap get one sentence.
pub(super) fn meetings(analysis: &Analysis) -> Vec<String> {
    by_line(analysis).into_iter().map(|(_, sentence)| sentence).collect()
}

/// Returns the sentences of one interaction line, in order of execution. A line that belongs to a swap has no
/// sentence of its own.
pub(super) fn meetings_of(analysis: &Analysis, line: usize) -> Vec<String> {
    let sentences = by_line(analysis).into_iter().filter(|(own, _)| *own == Some(line));
    sentences.map(|(_, sentence)| sentence).collect()
}

/// Returns the sentences of [`meetings`], each with its interaction line. Swaps have several lines and get `None`.
fn by_line(analysis: &Analysis) -> Vec<(Option<usize>, String)> {
    let parts = swap::parts(analysis);
    let (mut sentences, mut rest) = (Vec::new(), &parts[..]);
    while let Some(((line, encounters), others)) = rest.split_first() {
        let swap = rest.get(..SWAP).and_then(|three| Swap::of(analysis, three));
        rest = if swap.is_some() { &rest[SWAP..] } else { others };
        let own = swap.is_none().then_some(*line);
        sentences.extend(meeting(analysis, *line, encounters, swap).map(|sentence| (own, sentence)));
    }
    sentences
}

/// The number of interaction lines in a swap.
const SWAP: usize = 3;

fn meeting(
    analysis: &Analysis,
    line: usize,
    encounters: &[&Encounter],
    swap: Option<Swap>,
) -> Option<String> {
    let rules = &analysis.game().0;
    let info = rules.effects.iter().find(|info| info.line == line)?;
    let distinct = |parties: Vec<Option<SpriteType>>| {
        let mut kept: Vec<Option<SpriteType>> = Vec::new();
        for party in parties {
            if !kept.contains(&party) {
                kept.push(party);
            }
        }
        let named =
            |party: Option<SpriteType>| party.map_or_else(Party::edge, |stype| Party::of(analysis, stype));
        Party::any(&kept.into_iter().map(named).collect::<Vec<Party>>())
    };
    // An effect that needs a partner does nothing at the edge.
    let idle = |encounter: &Encounter| encounter.second.is_none() && info.summary.needs_partner;
    let all_idle = encounters.iter().all(|encounter| idle(encounter));
    let told = encounters.iter().filter(|encounter| all_idle || !idle(encounter));
    // A line that starts with the edge has several first sprites.
    let first = distinct(encounters.iter().map(|encounter| Some(encounter.first)).collect());
    let second = distinct(told.map(|encounter| encounter.second).collect());
    let partner_stays = || encounters.iter().all(|met| met.second.is_some_and(|two| stays(analysis, two)));
    let template = match swap {
        Some(Swap { one, other, .. }) => Sentence::of_swap(one, other),
        None if all_idle => Sentence::of_nothing(),
        None => info.effect.sentence_beside(partner_stays),
    };
    let mut text = sentence(&negated(when_they_meet(analysis, &template, &first, &second)));
    // Some effects decide at run time whether they give points.
    let decides = !template.if_scored.is_empty() && !info.steady;
    if info.score_change != 0 && (info.apply_score || decides) {
        let condition = if decides { if_scored(analysis, &template, &first, &second) } else { String::new() };
        text += &format!(" {}", sentence(&format!("{condition}{}", points(info.score_change))));
    }
    let if_killed = info.summary.score_if_killed;
    if if_killed != 0 {
        text += &format!(" {}", Phrase::Instead.with(&[("points", &points(if_killed))]));
    }
    if let Some(counting) = &info.counting {
        text += &counters(counting);
    }
    Some(text)
}

/// Rewords a sentence that forbids something to any member of a group: `any crate cannot enter the pit` becomes `no crate
/// can enter the pit`.
fn negated(text: String) -> String {
    let group = text.strip_prefix("any ").and_then(|rest| rest.split_once(" cannot enter "));
    match group.filter(|(name, _)| !name.contains(' ')) {
        Some((name, rest)) => format!("no {name} can enter {rest}"),
        None => text,
    }
}

/// Returns `true` if no sprite to which a rule on `written` applies is ever removed or replaced.
fn stays(analysis: &Analysis, written: SpriteType) -> bool {
    let concerned: Vec<SpriteType> =
        analysis.game().sprite_types().filter(|&stype| analysis.applies(written, stype)).collect();
    let goes = |stype: SpriteType| {
        let ends = |met: &Encounter, target: Target| match target {
            Target::Side(Side::First) => analysis.applies(met.first, stype),
            Target::Side(Side::Second) => met.second.is_some_and(|second| analysis.applies(second, stype)),
            Target::All(_) | Target::Tree(_) => true,
        };
        let ended = |met: &Encounter| {
            met.effects.iter().filter_map(EffectSummary::ending).any(|(target, _)| ends(met, target))
        };
        let facts = analysis.facts(stype);
        // A sprite that creates other sprites can disappear after creating the last of them.
        facts.fleeting || !facts.makes.is_empty() || analysis.encounters().iter().any(ended)
    };
    !analysis.has_timed_effects() && !concerned.into_iter().any(goes)
}

/// Returns the sentences about the changes that an execution makes to the counters, unless the effect itself
/// decides about the changes.
fn counters(counting: &Counting) -> String {
    let amount = |on: bool, amount: Option<i32>| if on { amount.unwrap_or(0) } else { 0 };
    let both = counting.counter.iter().zip(&counting.counter_else);
    let changes = both.map(|(&count, &other)| {
        amount(counting.count, count).saturating_add(amount(counting.count_else, other))
    });
    let changes = (1..).zip(changes).filter(|(_, change)| *change != 0);
    let told = |(number, change): (i32, i32)| {
        let (number, change) = (number.to_string(), format!("{change:+}"));
        format!(" {}", Phrase::Counter.with(&[("number", &number), ("change", &change)]))
    };
    changes.map(told).collect()
}

fn points(change: i32) -> String {
    let number = count(i64::from(change).abs(), "point");
    let phrase = if change > 0 { Phrase::Gains } else { Phrase::Loses };
    phrase.with(&[("points", &number)])
}

/// Returns the sentences about rules that a clock triggers. Rules that are never due have none.
pub(super) fn timed_effects(analysis: &Analysis) -> Vec<String> {
    let rules = &analysis.game().0;
    let line = |timed: &Timed| {
        let first = timed.first_due?;
        let text = by_the_clock(analysis, timed);
        // The first step is the reference's tick 0.
        let period = if timed.timer == 1 { "tick".to_owned() } else { count(timed.timer.into(), "tick") };
        let tick = first.max(0).saturating_add(1).to_string();
        let mut text = sentence(&match timed.repeating {
            true => Phrase::Every.with(&[("period", &period), ("first", &tick), ("planned", &text)]),
            false => Phrase::Once.with(&[("tick", &tick), ("planned", &text)]),
        });
        if timed.score_change != 0 && timed.apply_score {
            text += &format!(" {}", sentence(&points(timed.score_change)));
        }
        Some(text)
    };
    rules.timed.iter().filter_map(line).collect()
}

/// Returns one line, with all members, for each group that an interaction, a chaser or a fleeing sprite
/// refers to. A group whose own sprites can occur is one of its members.
pub(super) fn groups(analysis: &Analysis) -> Vec<String> {
    let game = analysis.game();
    let follows = |follower: SpriteType, stype: SpriteType| {
        let facts = analysis.facts(follower);
        facts.possible && [Motion::Chasing(stype), Motion::Fleeing(stype)].contains(&facts.motion)
    };
    let named = |stype: SpriteType| {
        let meets = |encounter: &Encounter| encounter.first == stype || encounter.second == Some(stype);
        analysis.encounters().iter().any(meets) || game.sprite_types().any(|other| follows(other, stype))
    };
    let group = |stype: SpriteType| {
        let members = members(analysis, stype);
        if !named(stype) || members.is_empty() || Party::of(analysis, stype).you {
            return None;
        }
        // Members of a nested group are listed only under that group.
        let path = |member: SpriteType| &game.0.types[member.index()].path;
        let inner = |member: &SpriteType| {
            members.iter().any(|other| other != member && path(*member).contains(other))
        };
        let own = Party { name: format!("the {}", game.name(stype)), you: false };
        let own = analysis.facts(stype).possible.then_some(own);
        let top = members.iter().filter(|member| !inner(member)).map(|&member| Party::of(analysis, member));
        let top: Vec<Party> = own.into_iter().chain(top).collect();
        Some(Phrase::Group.with(&[("name", game.name(stype)), ("members", &Party::any(&top).name)]))
    };
    game.sprite_types().filter_map(group).collect()
}

/// Returns one sentence for each termination that can win, or lose, in order of priority.
pub(super) fn endings(analysis: &Analysis, win: bool) -> Vec<String> {
    let rules = &analysis.game().0;
    // Without a StopCounter, if counters cannot end a game from the start, nothing ever allows them to.
    let ends =
        |goal: &&Goal| rules.can_end || can_be_stopped(rules) || matches!(goal.condition, Condition::Tick(_));
    let goals = analysis.goals().iter().filter(|goal| if win { goal.win } else { goal.can_lose() });
    goals.filter(ends).map(|one| format!("{}.", goal(analysis, one, win))).collect()
}

/// Returns a termination as a sentence about winning or losing, without its full stop.
pub(super) fn goal(analysis: &Analysis, goal: &Goal, win: bool) -> String {
    let provided = match (analysis.game().0.terminations[goal.line].decided_by, win) {
        (Decision::Line, _) => String::new(),
        (Decision::Score, true) => Phrase::UnlessZero.with(&[]),
        (Decision::Score, false) => Phrase::AndZero.with(&[]),
        (Decision::Difference, true) => Phrase::UnlessEqual.with(&[]),
        (Decision::Difference, false) => Phrase::AndEqual.with(&[]),
        (Decision::Value(value), true) => Phrase::IfCounter.with(&[("value", &value.to_string())]),
        (Decision::Value(value), false) => Phrase::AndCounter.with(&[("value", &value.to_string())]),
    };
    let verb = if win { "win" } else { "lose" };
    format!("You {verb} {}{provided}{}", ending(analysis, goal, win), held_up(analysis, goal))
}

/// Returns a termination as one of several methods to win or lose.
pub(super) fn way(analysis: &Analysis, goal: &Goal) -> String {
    ending(analysis, goal, goal.win) + &held_up(analysis, goal)
}

/// Returns `true` if some termination prevents other terminations from ending the game.
fn can_be_stopped(rules: &Rules) -> bool {
    rules.terminations.iter().any(|end| matches!(end.condition, Written::StopCounter { .. }))
}

/// Returns the condition under which a StopCounter keeps a termination from ending the game. The last
/// StopCounter before the termination decides. If there is none before it, the last of all StopCounters
/// decides, with its result from the previous tick.
fn held_up(analysis: &Analysis, goal: &Goal) -> String {
    let rules = &analysis.game().0;
    let stops = |end: &&Termination| matches!(end.condition, Written::StopCounter { .. });
    let before = rules.terminations[..goal.line].iter().rfind(stops);
    let Some(stop) = before.or_else(|| rules.terminations.iter().rfind(stops)) else { return String::new() };
    let Written::StopCounter { ref stypes, limit, min } = stop.condition else { return String::new() };
    if matches!(goal.condition, Condition::Tick(_)) {
        return String::new();
    }
    let tree = |stype: &SpriteType| rules.types[stype.index()].tree.iter().copied();
    let types = stypes.iter().flat_map(tree).filter(|stype| rules.types[stype.index()].class.is_some());
    let types: Vec<SpriteType> = types.collect();
    // If no types can be counted, the names on the line are used.
    let types = if types.is_empty() { stypes.to_vec() } else { types };
    let (are, then) = match (limit == 1, before.is_some()) {
        (true, true) => ("is", ""),
        (false, true) => ("are", ""),
        (true, false) => ("was", Phrase::Before.text()),
        (false, false) => ("were", Phrase::Before.text()),
    };
    let name =
        if limit == 1 { summed(analysis, &types, str::to_owned) } else { summed(analysis, &types, plural) };
    let phrase = if min { Phrase::HeldUpBy } else { Phrase::HeldUp };
    let limit = limit.to_string();
    let mut text = phrase.with(&[("limit", &limit), ("name", &name), ("are", are), ("then", then)]);
    if before.is_none() && !rules.can_end {
        text += Phrase::NotFirst.text();
    }
    text
}

/// Returns a termination's condition, as the end of a sentence about winning or losing.
fn ending(analysis: &Analysis, goal: &Goal, win: bool) -> String {
    let written = analysis.game().0.terminations[goal.line].counts();
    let types = goal.condition.types();
    // If no types can be counted, the names on the line are used.
    let types = if types.is_empty() { written } else { types };
    let when = condition(analysis, &goal.condition, types, win);
    match goal.kinds {
        None => when,
        Some(kinds) => when + &Phrase::OfKinds.with(&[("kinds", &count(kinds.into(), "kind"))]),
    }
}

fn condition(analysis: &Analysis, condition: &Condition, types: &[SpriteType], win: bool) -> String {
    let one = counted(analysis, types, str::to_owned);
    let none = || {
        let names = counted_names(analysis, types, str::to_owned);
        match names.split_last() {
            Some((last, rest)) if !rest.is_empty() => format!("{} and no {last}", rest.join(", no ")),
            _ => one.name.clone(),
        }
    };
    let limited = |phrase: Phrase, limit: i32| {
        let (name, are) = match limit {
            1 => (summed(analysis, types, str::to_owned), "is"),
            _ => (summed(analysis, types, plural), "are"),
        };
        phrase.with(&[("limit", &limit.to_string()), ("name", &name), ("are", are)])
    };
    match condition {
        Condition::AtMost(_, 0) | Condition::Exactly(_, 0) if one.you => Phrase::Gone.with(&[]),
        Condition::AtMost(_, 0) | Condition::Exactly(_, 0) => Phrase::NoneLeft.with(&[("name", &none())]),
        Condition::AtMost(_, limit) => limited(Phrase::AtMost, *limit),
        Condition::AtLeast(_, limit) => limited(Phrase::AtLeast, *limit),
        // The count starts above the limit and never grows.
        Condition::Exactly(_, limit) if !win && analysis.only_falls(types) => {
            limited(Phrase::OnlyLeft, *limit)
        }
        Condition::Exactly(_, limit) => limited(Phrase::Exactly, *limit),
        Condition::Tick(limit) => {
            // The first step is the reference's tick 0, and limits below 0 count as that tick.
            let tick = limit.saturating_add(1).max(1).to_string();
            let phrase = if win { Phrase::Survive } else { Phrase::Reached };
            phrase.with(&[("tick", &tick)])
        }
    }
}

/// Returns a phrase for the sum over a condition's possible types, by name. A type that occurs twice counts
/// twice.
fn summed(analysis: &Analysis, types: &[SpriteType], named: impl Fn(&str) -> String) -> String {
    counted(analysis, types, |name| {
        let own = |stype: &&SpriteType| analysis.game().name(**stype) == name;
        match types.iter().filter(own).count() {
            0 | 1 => named(name),
            times => Phrase::Repeated.with(&[("name", &named(name)), ("times", &times.to_string())]),
        }
    })
    .name
}

/// Returns a condition's possible types, or all its types if no type is possible.
fn countable(analysis: &Analysis, types: &[SpriteType]) -> Vec<SpriteType> {
    let possible: Vec<SpriteType> =
        types.iter().copied().filter(|&stype| analysis.facts(stype).possible).collect();
    if possible.is_empty() { types.to_vec() } else { possible }
}

/// Returns the names of a condition's possible types, without duplicates.
fn counted_names(analysis: &Analysis, types: &[SpriteType], named: impl Fn(&str) -> String) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for stype in countable(analysis, types) {
        let name = named(analysis.game().name(stype));
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

/// Returns a phrase for a condition's possible types, by name. If they are exactly the possible types of the
/// player's avatar, they stand for the player.
fn counted(analysis: &Analysis, types: &[SpriteType], named: impl Fn(&str) -> String) -> Party {
    let all = countable(analysis, types);
    let forms = analysis.avatars();
    let you = !forms.is_empty()
        && forms.iter().all(|form| all.contains(&form.stype))
        && all.iter().all(|stype| forms.iter().any(|form| form.stype == *stype));
    Party { name: list(&counted_names(analysis, types, named), "or"), you }
}
