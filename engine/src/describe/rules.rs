//! Interactions and terminations in words.

use super::words::{Party, a, count, list, members, percent, sentence};
use crate::analysis::{Analysis, Condition, Encounter, Goal, Motion};
use crate::game::{Counting, SpriteType, Timed};
use crate::ontology::effects::{Effect, SpeedChange};
use crate::ontology::terminations::Decision;

/// One sentence for each interaction line, in order of execution; partners of one line together.
pub(super) fn meetings(analysis: &Analysis) -> Vec<String> {
    let mut lines: Vec<(usize, Vec<&Encounter>)> = Vec::new();
    for encounter in analysis.encounters() {
        match lines.iter_mut().find(|(line, _)| *line == encounter.line) {
            Some((_, all)) => all.push(encounter),
            None => lines.push((encounter.line, vec![encounter])),
        }
    }
    lines.sort_by_key(|(line, _)| *line);
    lines.iter().filter_map(|(line, encounters)| meeting(analysis, *line, encounters)).collect()
}

fn meeting(analysis: &Analysis, line: usize, encounters: &[&Encounter]) -> Option<String> {
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
    // A line that names the edge first has several first sprites.
    let first = distinct(encounters.iter().map(|encounter| Some(encounter.first)).collect());
    let second = distinct(encounters.iter().map(|encounter| encounter.second).collect());
    let text = happens(analysis, &info.effect, &first, &second);
    let if_killed = match info.effect {
        Effect::SubtractHealthPoints { score_if_killed, .. } => score_if_killed,
        _ => 0,
    };
    let mut text = sentence(&text);
    if info.score_change != 0 && info.apply_score {
        text += &format!(" {}.", points(info.score_change));
    }
    if if_killed != 0 {
        text += &format!(" If that kills, {}.", points(if_killed).to_lowercase());
    }
    if let Some(counting) = &info.counting {
        text += &counters(counting);
    }
    Some(text)
}

/// The counter changes of an execution, where the effect itself does not decide them.
fn counters(counting: &Counting) -> String {
    let amount = |on: bool, amount: Option<i32>| if on { amount.unwrap_or(0) } else { 0 };
    let both = counting.counter.iter().zip(&counting.counter_else);
    let changes = both.map(|(&count, &other)| {
        amount(counting.count, count).saturating_add(amount(counting.count_else, other))
    });
    let changes = (1..).zip(changes).filter(|(_, change)| *change != 0);
    changes.map(|(number, change)| format!(" Counter {number} changes by {change:+}.")).collect()
}

fn points(change: i32) -> String {
    let number = count(i64::from(change).abs(), "point");
    if change > 0 { format!("You gain {number}") } else { format!("You lose {number}") }
}

/// The effect on the first party when it touches the second.
fn happens(analysis: &Analysis, effect: &Effect, one: &Party, two: &Party) -> String {
    let name = |stype: SpriteType| analysis.game().name(stype);
    let (s, b) = (&one.name, &two.name);
    let die = one.verb("die", "disappears");
    let turn = one.verb("turn", "turns");
    let on = format!("on touching {b}");
    let when = format!("when {s} {} {b}", one.verb("touch", "touches"));
    let and_gone = |gone: bool| {
        if gone { format!(", and {b} {}", two.verb("die", "disappears")) } else { String::new() }
    };
    let chance =
        |prob: f64| if prob < 1.0 { format!(" with a chance of {}", percent(prob)) } else { String::new() };
    match effect {
        Effect::KillSprite | Effect::KillIfAlive => format!("{s} {die} {on}"),
        Effect::KillBoth => format!(
            "{s} and {b} both {} when they touch",
            if one.you || two.you { "die" } else { "disappear" }
        ),
        Effect::KillAll { .. } | Effect::ChangeSpeed { .. } => {
            format!("{when}, {}", by_itself(analysis, effect, None))
        }
        Effect::KillIfFromAbove => {
            format!("{s} {die} if {b} {} on {} from above", two.verb("fall", "falls"), one.again())
        }
        Effect::KillIfHasLess { resource, limit } => {
            let least = i64::from(*limit) + 1;
            format!("{s} {die} {on} unless {} at least {least} {}", one.again_holds(), name(*resource))
        }
        Effect::KillIfHasMore { resource, limit } => {
            format!("{s} {die} {on} if {} at least {limit} {}", one.again_holds(), name(*resource))
        }
        Effect::KillIfOtherHasMore { resource, limit, subtract } => {
            let spent = if *subtract { ", which uses them up" } else { "" };
            let holds = if two.you { "you hold" } else { "that holds" };
            format!("{s} {die} {on} if {holds} at least {limit} {}{spent}", name(*resource))
        }
        Effect::KillIfFrontal { frontal: true } => format!("{s} {die} on running into {b} head-on"),
        Effect::KillIfFrontal { frontal: false } => format!("{s} {die} {on} unless they meet head-on"),
        Effect::AddHealthPoints { value, kill_second, .. } => {
            let gain = one.verb("gain", "gains");
            format!("{s} {gain} {} {on}{}", count(i64::from(*value), "health point"), and_gone(*kill_second))
        }
        Effect::SubtractHealthPoints { value, limit, stype, .. } => {
            let points = count(i64::from(*value), "health point");
            let last = match limit {
                0 => "none is left".to_owned(),
                limit => format!("{limit} or fewer are left"),
            };
            match stype {
                None => format!(
                    "{s} {} {points} {on}, and {} when {last}",
                    one.verb("lose", "loses"),
                    one.verb("die", "dies")
                ),
                Some(stype) => format!("{when}, {} loses {points}, and dies when {last}", a(name(*stype))),
            }
        }
        Effect::StepBack { .. } => format!("{s} cannot enter {b}"),
        Effect::UndoAll { .. } => {
            format!("{s} cannot enter {b}: {when}, every move of that tick is taken back")
        }
        Effect::TurnAround => format!("{s} {turn} around at {b}, further down"),
        Effect::ReverseDirection => format!("{s} {turn} back at {b}"),
        Effect::FlipDirection => format!("{s} {turn} in a random direction {on}"),
        Effect::HalfSpeed => format!("{s} {} to half speed {on}", one.verb("slow down", "slows down")),
        Effect::WrapAround { .. } => {
            format!("{s} {} in again at the opposite edge on reaching {b}", one.verb("come", "comes"))
        }
        Effect::Align { .. } => format!("{s} {} put in the place of {b} {on}", one.verb("are", "is")),
        Effect::AttractGaze { prob, .. } => {
            format!("{s} {turn} to face the way of {b} {on}{}", chance(*prob))
        }
        Effect::BounceForward => format!("{b} {} {s}", two.verb("push", "pushes")),
        Effect::PullWithIt { .. } => format!("{b} {} {s} along", two.verb("carry", "carries")),
        Effect::TeleportToExit => format!("{s} {} to where {b} leads {on}", one.verb("jump", "jumps")),
        Effect::Spawn { stype, prob } => {
            format!("{when}, {} appears there{}", a(name(*stype)), chance(*prob))
        }
        Effect::SpawnIf { resource, limit, stype, spend, prob, more } => {
            let least = if *more { "at least" } else { "at most" };
            let cost = if *more && *spend != 0 { format!(", which costs {spend}") } else { String::new() };
            let holds = one.again_holds();
            format!(
                "{when} and {holds} {least} {limit} {}, {} appears there{}{cost}",
                name(*resource),
                a(name(*stype)),
                chance(*prob)
            )
        }
        Effect::SpawnBeside { stype, shift, prob, .. } => {
            let side = match shift {
                (0, -1) => "above",
                (0, 1) => "below",
                (-1, 0) => "to the left of",
                _ => "to the right of",
            };
            format!("{when}, {} appears {side} {b}{}", a(name(*stype)), chance(*prob))
        }
        Effect::SpawnBehind { stype, prob } => {
            format!("{when}, {} appears behind {b}{}", a(name(*stype)), chance(*prob))
        }
        Effect::CloneSprite => format!("{when}, another one like {} appears", one.again()),
        Effect::TransformTo { stype, kill_second, .. } => {
            format!("{s} {turn} into {} {on}{}", a(name(*stype)), and_gone(*kill_second))
        }
        Effect::TransformToAll { stype, to, kill_second, .. } => {
            format!("{when}, every {} turns into {}{}", name(*stype), a(name(*to)), and_gone(*kill_second))
        }
        Effect::TransformToRandomChild { options, kill_second, .. } => {
            let names: Vec<String> = options.iter().map(|&stype| a(name(stype))).collect();
            format!("{s} {turn} into {} {on}{}", list(&names, "or"), and_gone(*kill_second))
        }
        Effect::CollectResource { .. } => format!("{b} {} {s}", two.verb("collect", "collects")),
        Effect::CollectResourceIfHeld { held, value, .. } => {
            let collect = two.verb("collect", "collects");
            format!("{b} {collect} {s} if {} at least {value} {}", two.again_holds(), name(*held))
        }
        Effect::ChangeResource { resource, value, kill_resource } => {
            let (verb, number) = if *value < 0 {
                (one.verb("lose", "loses"), value.saturating_neg())
            } else {
                (one.verb("gain", "gains"), *value)
            };
            format!("{s} {verb} {number} {} {on}{}", name(*resource), and_gone(*kill_resource))
        }
        Effect::KillIfSpeed { limit, fast } => {
            let than = if *fast { "faster than" } else { "slower than" };
            format!("{s} {die} {on} {than} {limit}")
        }
        Effect::KillIfNotUpright => format!("{s} {die} {on} unless upright"),
        Effect::RemoveScore { .. } => format!("{when}, the score goes back to 0"),
        Effect::UpdateSpawnType { stype, spawn_point } => {
            format!("{when}, every {} makes {} from then on", name(*spawn_point), a(name(*stype)))
        }
        Effect::SpawnIfCounterSubTypes { stype, otherwise, counted, limit, .. } => format!(
            "{when}, {} appears there if there are {limit} {} of the right kinds, else {}",
            a(name(*stype)),
            name(*counted),
            a(name(*otherwise))
        ),
        Effect::TransformIfCount(rule) => {
            let many = match (rule.at_least, rule.at_most) {
                (least, 10_000) => format!("at least {least}"),
                (0, most) => format!("at most {most}"),
                (least, most) => format!("{least} to {most}"),
            };
            let otherwise = rule
                .otherwise
                .map_or(String::new(), |other| format!(", and otherwise into {}", a(name(other))));
            let (to, counted) = (a(name(rule.stype)), name(rule.counted));
            format!("{s} {turn} into {to} {on} if there are {many} {counted}{otherwise}")
        }
        Effect::TransformToSingleton { stype, other, .. } => {
            let (to, other) = (name(*stype), a(name(*other)));
            format!("{s} {turn} into the {to} {on}, and who was that before becomes {other}")
        }
        Effect::WaterPhysics => format!("{s} {} slowly from then on {on}", one.verb("sink", "sinks")),
        Effect::BounceDirection { .. } => {
            format!("{s} {} off {b}, the steeper the further from its middle", one.verb("bounce", "bounces"))
        }
        Effect::WallStop => format!("{s} {} at {b}, and can only go along it", one.verb("stop", "stops")),
        Effect::WallBounce => format!("{s} {} off {b}", one.verb("bounce", "bounces")),
        Effect::WallReverse => format!("{s} {turn} back at {b}"),
        Effect::AddTimer { timed } => {
            let rules = &analysis.game().0;
            let timed = &rules.timed[usize::from(*timed)];
            let later = by_itself(analysis, &rules.effects[usize::from(timed.effect)].effect, timed.target);
            format!("{when}, {} later {later}", count(i64::from(timed.timer), "tick"))
        }
        Effect::Disabled(_) => format!("{when}, nothing happens"),
        Effect::ShieldFrom { stype, .. } => {
            format!(
                "while {s} {} {b}, {} {} safe from {}",
                one.verb("touch", "touches"),
                one.again(),
                one.verb("are", "is"),
                Party::of(analysis, *stype).name
            )
        }
    }
}

/// One sentence for each line that runs by the clock.
pub(super) fn timed_effects(analysis: &Analysis) -> Vec<String> {
    let rules = &analysis.game().0;
    let line = |timed: &Timed| {
        let first = timed.first_due?;
        let text = by_itself(analysis, &rules.effects[usize::from(timed.effect)].effect, timed.target);
        let when = match (timed.repeating, first) {
            (true, _) => format!("every {}", count(i64::from(timed.timer), "tick")),
            (false, first) => format!("at tick {}", first.max(0)),
        };
        let mut text = sentence(&format!("{when}, {text}"));
        if timed.score_change != 0 && timed.apply_score {
            text += &format!(" {}.", points(timed.score_change));
        }
        Some(text)
    };
    rules.timed.iter().filter_map(line).collect()
}

/// The effect without a partner, on every sprite of a type or on none in particular.
fn by_itself(analysis: &Analysis, effect: &Effect, target: Option<SpriteType>) -> String {
    let name = |stype: SpriteType| analysis.game().name(stype);
    let every = target.map_or_else(|| "everything".to_owned(), |stype| format!("every {}", name(stype)));
    match effect {
        Effect::KillSprite => format!("{every} disappears"),
        Effect::KillAll { stype } => format!("every {} disappears", name(*stype)),
        Effect::TransformTo { stype, .. } => format!("{every} turns into {}", a(name(*stype))),
        Effect::TransformToAll { stype, to, .. } => {
            format!("every {} turns into {}", name(*stype), a(name(*to)))
        }
        Effect::Spawn { stype, .. } => format!("{} appears at {every}", a(name(*stype))),
        Effect::CloneSprite => format!("{every} is doubled"),
        Effect::AddHealthPoints { value, .. } => {
            format!("{every} gains {}", count(i64::from(*value), "health point"))
        }
        Effect::SubtractHealthPoints { value, stype, .. } => {
            let who = stype.map_or(every, |stype| a(name(stype)));
            format!("{who} loses {}", count(i64::from(*value), "health point"))
        }
        Effect::FlipDirection => format!("{every} turns in a random direction"),
        Effect::ReverseDirection => format!("{every} turns back"),
        Effect::ChangeSpeed { stype, value, how } => match how {
            SpeedChange::Increase => format!("every {} becomes faster by {value}", name(*stype)),
            SpeedChange::Decrease => format!("every {} becomes slower by {value}", name(*stype)),
            SpeedChange::Set => format!("the speed of every {} becomes {value}", name(*stype)),
        },
        Effect::UndoAll { .. } => "every move of that tick is taken back".to_owned(),
        _ => format!("something happens to {every}"),
    }
}

/// One line for each group that an interaction, a chaser or a fleeing sprite names, with its members.
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
        // Groups within groups are named once.
        let path = |member: SpriteType| &game.0.types[member.index()].path;
        let inner = |member: &SpriteType| {
            members.iter().any(|other| other != member && path(*member).contains(other))
        };
        let top: Vec<Party> = members
            .iter()
            .filter(|member| !inner(member))
            .map(|&member| Party::of(analysis, member))
            .collect();
        Some(format!("Any {} means {}.", game.name(stype), Party::any(&top).name))
    };
    game.sprite_types().filter_map(group).collect()
}

/// One sentence for each termination with that sign, in order of priority.
pub(super) fn endings(analysis: &Analysis, win: bool) -> Vec<String> {
    let goals = analysis.goals().iter().filter(|goal| goal.win == win);
    goals.map(|one| format!("{}.", goal(analysis, one))).collect()
}

/// A termination as a sentence, without its full stop.
pub(super) fn goal(analysis: &Analysis, goal: &Goal) -> String {
    let provided = match analysis.game().0.terminations[goal.line].decided_by {
        Decision::Line => String::new(),
        Decision::Score => ", if your score is not 0".to_owned(),
        Decision::Difference => ", if the counters are not all the same".to_owned(),
        Decision::Value(value) => format!(", if the counter is at {value}"),
    };
    let verb = if goal.win { "win" } else { "lose" };
    format!("You {verb} {}{provided}", ending(analysis, &goal.condition, goal.win))
}

fn ending(analysis: &Analysis, condition: &Condition, win: bool) -> String {
    let counted = counted(analysis, condition.types());
    let is_you = counted.you;
    match condition {
        Condition::AtMost(_, 0) | Condition::Exactly(_, 0) if is_you => "when you are gone".to_owned(),
        Condition::AtMost(_, limit) if *limit <= 0 => format!("when no {} is left", counted.name),
        Condition::AtMost(_, limit) => format!("when at most {limit} {} are left", counted.name),
        Condition::AtLeast(_, limit) => format!("when there are at least {limit} {}", counted.name),
        Condition::Exactly(_, 0) => format!("when no {} is left", counted.name),
        Condition::Exactly(_, 1) => format!("when there is exactly 1 {}", counted.name),
        Condition::Exactly(_, limit) => format!("when there are exactly {limit} {}", counted.name),
        Condition::Tick(limit) if win => format!("if you last until tick {limit}"),
        Condition::Tick(limit) => format!("when tick {limit} is reached"),
    }
}

/// The types of a condition, by name, those that can occur.
fn counted(analysis: &Analysis, types: &[SpriteType]) -> Party {
    let possible: Vec<SpriteType> =
        types.iter().copied().filter(|&stype| analysis.facts(stype).possible).collect();
    let all: &[SpriteType] = if possible.is_empty() { types } else { &possible };
    let you = !all.is_empty() && all.iter().all(|stype| analysis.avatars().iter().any(|a| a.stype == *stype));
    let mut names: Vec<&str> = Vec::new();
    for &stype in all {
        let name = analysis.game().name(stype);
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let name = list(&names, "or");
    Party { name, you }
}
