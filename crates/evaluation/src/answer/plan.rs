//! Reads plans (sequences of actions) from players' answers.

use super::decisions::{MAX_SCANNED, line_before};
use super::phrase::{self, Context};
use super::read::{Chosen, action_of, named, pattern, quoted};
use super::text::{boundary, folded};
use super::{Reading, Stage, without_reasoning};
use engine::Action;
use regex::{Captures, Regex};
use std::sync::LazyLock;

/// The maximum number of markers to examine, counted from the end of the answer.
const MARKERS: usize = 100;

/// A plan in the requested format, on its own line.
static PLAN_LINE: LazyLock<Regex> = LazyLock::new(|| pattern(r"(?i)^PLAN:[ \t]*(\S.*)$"));

/// An item in the requested plan format: an action with its repeat count.
static ITEM: LazyLock<Regex> = LazyLock::new(|| pattern(r"(?i)^([a-z]+)(?:[ \t]+x[ \t]?([0-9]{1,9}))?$"));

/// The start of a plan: a tag, `\boxed{`, or a word such as "plan" or "actions" followed by a
/// punctuation mark.
static MARKER: LazyLock<Regex> = LazyLock::new(|| {
    pattern(
        r#"(?i)(?:<\|?(?P<tag>(?:final[_ ]?)?(?:plan|answer|actions?|moves?))\|?>|\\boxed\{|(?-u:\b)(?P<word>plan|(?:final[_ ])?answer|actions?|moves?)(?P<quote>["']?)[*`]{0,3}[ \t]{0,4}(?:[:=]|->|→|⇒))[ \t]*[*`]{0,3}"#,
    )
});

/// A part of a list: a count, an item number, a word, a line break, or any other symbol.
static PART: LazyLock<Regex> = LazyLock::new(|| {
    pattern(
        r"(?i)(?P<count>[ \t]*(?:(?-u:\b)x|[×*])[ \t]?(?P<times>[0-9]{1,9})(?-u:\b))|(?P<number>[0-9]+[.)][ \t])|(?P<word>[a-z0-9_]+)|(?P<line>\n)|(?P<end><[/|])|(?P<sign>[,;<>\[\](){}\\`*\x22' \t\r.\-→⇒+&]|(?P<other>[^\n]))",
    )
});

/// Reads a plan, truncated to `due` actions. `listed` contains the game's actions. The last plan in the
/// answer counts. If this plan contains a word that is not an action, it is unusable, and no earlier plan
/// replaces it. Cost: O(bytes + due).
pub fn read_plan(text: &str, due: u64, listed: &[Action]) -> Reading<Vec<Action>> {
    let said = without_reasoning(text).trim();
    if said.is_empty() {
        let why = if text.trim().is_empty() { "it is empty" } else { "it ends before it comes to a plan" };
        return Reading::Invalid { why: why.to_owned() };
    }
    if let Some(plan) = strict(said, due, listed) {
        return Reading::Strict(plan);
    }
    let folded = folded(said);
    let said = folded.as_str();
    let none = || Reading::Invalid { why: "it has no plan".to_owned() };
    let markers: Vec<_> = MARKER.captures_iter(said).collect();
    for marker in markers.iter().rev().take(MARKERS) {
        let Some(whole) = marker.get(0) else { continue };
        let is_json = marker.name("quote").is_some_and(|quote| !quote.is_empty());
        let rest = &said[whole.end()..];
        match phrase::context(line_before(said, whole.start())) {
            Context::Aside => continue,
            Context::Negated if phrase::names_other(first_line(rest), None) => return none(),
            Context::Negated => continue,
            Context::Free => {}
        }
        let stage = match (is_json, marker.name("tag")) {
            (true, _) => Stage::Json,
            (false, Some(_)) => Stage::Tag,
            _ => Stage::Marker,
        };
        match list(rest, due, listed) {
            // Each of these markers belongs to an object with a single action. The other keys of the objects
            // may state counts and the order.
            List::Plan(_) if is_json && is_one_of_several(marker, &markers) => return none(),
            List::Plan(_) if !is_json && phrase::retracts_plan(rest) => return none(),
            List::Plan(choice) => return Reading::Tolerant { choice, stage },
            List::Unknown(word) => {
                return Reading::Invalid { why: format!("`{}` is not an action of the list", quoted(word)) };
            }
            // Actions among other words do not form a list, so this marker has no plan, and no earlier plan
            // replaces it.
            List::None if phrase::names_other(first_line(rest), None) => break,
            List::None => {}
        }
    }
    // Without a marker, only the last line counts, and only if it consists of actions.
    let (before, last) = said.trim_end().rsplit_once('\n').unwrap_or(("", said));
    let before = before.trim_end();
    match list(last, due, listed) {
        List::Plan(choice) if phrase::context(line_before(before, before.len())) != Context::Negated => {
            Reading::Tolerant { choice, stage: Stage::Line }
        }
        _ => none(),
    }
}

/// Returns `true` if a marker is the quoted word "action" or "move", and there are several such markers.
fn is_one_of_several(marker: &Captures<'_>, markers: &[Captures<'_>]) -> bool {
    let is_single = |marker: &Captures<'_>| {
        let is_quoted = marker.name("quote").is_some_and(|quote| !quote.is_empty());
        let word = marker.name("word").map_or("", |word| word.as_str());
        is_quoted && ["action", "move"].iter().any(|single| word.eq_ignore_ascii_case(single))
    };
    is_single(marker) && markers.iter().filter(|marker| is_single(marker)).count() > 1
}

fn first_line(text: &str) -> &str {
    text[..boundary(text, MAX_SCANNED)].lines().next().unwrap_or_default()
}

fn strict(said: &str, due: u64, listed: &[Action]) -> Option<Vec<Action>> {
    let line = PLAN_LINE.captures(said.lines().next_back()?.trim())?;
    let mut plan = Vec::new();
    for item in line[1].split(',') {
        let item = ITEM.captures(item.trim())?;
        let action = *listed.iter().find(|action| item[1].eq_ignore_ascii_case(&action.to_string()))?;
        let times = item.get(2).map_or(Some(1), |times| times.as_str().parse().ok())?;
        extend(&mut plan, action, times, due);
    }
    Some(plan)
}

/// The result of parsing the beginning of a text as a list of actions.
enum List<'a> {
    Plan(Vec<Action>),
    /// A word that is not an action, after an action on the same line.
    Unknown(&'a str),
    None,
}

/// Reads a list of actions, up to the first line that does not belong to the list.
fn list<'a>(text: &'a str, due: u64, listed: &[Action]) -> List<'a> {
    let (mut plan, mut last, mut is_line_begun, mut is_known) = (Vec::new(), None, false, false);
    for part in PART.captures_iter(text) {
        if part.name("end").is_some() {
            break;
        } else if part.name("line").is_some() {
            (is_line_begun, last) = (false, None);
        } else if let (Some(times), Some(action)) = (part.name("times"), last) {
            let times: u64 = times.as_str().parse().unwrap_or(u64::MAX);
            extend(&mut plan, action, times.saturating_sub(1), due);
            last = None;
        } else if let Some(word) = part.name("word").or(part.name("times")).or(part.name("other")) {
            let action = match named(word.as_str(), listed) {
                Chosen::Action(action) if action_of(word.as_str()).is_some() => action,
                // The word belongs to prose after the list, or to a text without any list.
                _ if is_known && !is_line_begun => break,
                _ if is_known => return List::Unknown(word.as_str()),
                _ => return List::None,
            };
            extend(&mut plan, action, 1, due);
            (last, is_line_begun, is_known) = (Some(action), true, true);
        }
    }
    if is_known { List::Plan(plan) } else { List::None }
}

/// Adds an action to a plan the given number of times, up to a total of `due` actions.
fn extend(plan: &mut Vec<Action>, action: Action, times: u64, due: u64) {
    let room = due.saturating_sub(plan.len() as u64);
    plan.extend(std::iter::repeat_n(action, times.min(room) as usize));
}

#[cfg(test)]
mod tests {
    use super::*;
    use Action::{Down, Left, Nil, Right, Up, Use};
    use proptest::prelude::*;

    const LISTED: [Action; 6] = [Nil, Up, Left, Down, Right, Use];

    /// Checks how an answer is read when 6 actions are due. `expect` states the initials of the expected
    /// actions, and the rule that must read the answer.
    #[track_caller]
    fn check(text: &str, expect: &str) {
        let initials = |plan: &[Action]| {
            plan.iter().filter_map(|action| action.to_string().chars().next()).collect::<String>()
        };
        let got = match read_plan(text, 6, &LISTED) {
            Reading::Strict(plan) => format!("{} strict", initials(&plan)),
            Reading::Tolerant { choice, stage } => format!("{} {}", initials(&choice), stage.name()),
            Reading::Invalid { why } => why,
        };
        assert_eq!(got, expect, "{text:?}");
    }

    #[test]
    fn strict_plans_are_read() {
        check("PLAN: right, right, up", "rru strict");
        check("I go round the wall.\n\nPLAN: right x3, up, nil x 2\n", "rrrunn strict");
        check("plan: USE,left", "ul strict");
        check("<think>PLAN: left</think>\nPLAN: down", "d strict");
        check("PLAN: right x0, up", "u strict");
    }

    #[test]
    fn what_is_beyond_the_commitment_is_left_out() {
        check("PLAN: right x9", "rrrrrr strict");
        check("PLAN: right x999999999, up", "rrrrrr strict");
        check("PLAN: right right right right right right right up", "rrrrrr marker");
        check("PLAN: right x99999999999", "`x99999999999` is not an action of the list");
    }

    #[test]
    fn other_formats_are_read() {
        check("PLAN: right right up", "rru marker");
        check("**PLAN:** right, up.", "ru marker");
        check("PLAN: right → right → up", "rru marker");
        check("PLAN: right*2, up×2", "rruu marker");
        check("PLAN:\n1. right\n2. up\n3. use\n", "ruu marker");
        check("PLAN:\n- right\n- up x2\n\nThis leads to the exit.", "ruu marker");
        check("PLAN: right, up\nI hope this helps.", "ru marker");
        check(r#"{"plan": ["right", "up", "wait"]}"#, "run json");
        check("```json\n{\"actions\": [\"up\", \"up\"]}\n```", "uu json");
        check("Actions: ACTION_RIGHT, ACTION_UP", "ru marker");
        check("ACTION: left", "l marker");
        check("Through the door:\nright, right, up", "rru line");
    }

    #[test]
    fn formats_of_other_harnesses_are_read() {
        check("<|ACTION|>up, left</|ACTION|>", "ul tag");
        check("<answer>up, left</answer>", "ul tag");
        check("<answer>PLAN: up, left</answer>", "ul marker");
        check("Final answer: up, left.", "ul marker");
        check("PLAN：up，left", "ul marker");
        check("PLAN:\u{a0}up,\u{a0}left x2.", "ull marker");
        check("**PLAN:** **up**, **left**", "ul marker");
        check("PLAN: u\u{200b}p, left\u{200b}", "ul marker");
        check("```\nPLAN: up, left\n```", "ul marker");
        check(r"\boxed{\text{up, left}}", "ul marker");
        check("<think>PLAN: right</think>\nPLAN: up, left<|im_end|>", "ul marker");
        check("PLAN: up, wait, left.", "unl marker");
    }

    #[test]
    fn negated_and_ambiguous_plans_are_invalid() {
        for text in [
            "PLAN: not left, up",
            "PLAN: left, not up",
            "PLAN: up.\nPLAN: not left, up",
            "PLAN: left or right",
            "PLAN: left/right",
            "PLAN: left | right",
            "PLAN: left, up or PLAN: right.",
            "PLAN: never up",
            "PLAN: don't go left, up",
            "PLAN: anything but left",
            "PLAN: left?",
            "PLAN: left, up is bad",
            "I would not choose PLAN: left, up",
            "I would never do:\nleft, up",
            "PLAN: left, up.\nActually, I go right.",
            "<answer>not left</answer>",
            "Previous plan: left, up",
            r#"[{"action": "up"}, {"action": "left"}]"#,
        ] {
            let reading = read_plan(text, 6, &LISTED);
            assert!(matches!(reading, Reading::Invalid { .. }), "{text:?}: {reading:?}");
        }
    }

    #[test]
    fn tolerance_does_not_guess() {
        check("PLAN: right, jump, up", "`jump` is not an action of the list");
        check("PLAN: right 3, up", "`3` is not an action of the list");
        check("PLAN: right, left.\nPLAN: up, fly", "`fly` is not an action of the list");
        check("PLAN: first to the key, then right", "it has no plan");
        check("My plan: I go right and then up.", "it has no plan");
        check("I go right, then up", "it has no plan");
        check("0 4 4 1", "it has no plan");
        check("", "it is empty");
        check("<think>right, right", "it ends before it comes to a plan");
        check("PLAN:", "it has no plan");
    }

    proptest! {
        /// No text yields more actions than are due, and no text causes a panic.
        #[test]
        fn plans_are_no_longer_than_due(text in "(PLAN|plan|:|,| |\n|x|[0-9]{1,10}|right|up|left|jump|\\PC){0,40}", due in 1..9_u64) {
            if let Reading::Strict(plan) | Reading::Tolerant { choice: plan, .. } = read_plan(&text, due, &LISTED) {
                prop_assert!(plan.len() as u64 <= due);
            }
        }

        /// A plan in the requested format is read as intended.
        #[test]
        fn requested_plans_are_read_whole(plan in prop::collection::vec((0..6_usize, 1..5_u64), 1..20)) {
            let items: Vec<String> = plan.iter().map(|&(at, times)| match times {
                1 => LISTED[at].to_string(),
                _ => format!("{} x{times}", LISTED[at]),
            }).collect();
            let meant: Vec<Action> =
                plan.iter().flat_map(|&(at, times)| std::iter::repeat_n(LISTED[at], times as usize)).collect();
            prop_assert_eq!(read_plan(&format!("PLAN: {}", items.join(", ")), 1000, &LISTED), Reading::Strict(meant));
        }
    }
}
