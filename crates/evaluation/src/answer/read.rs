//! Reads an action from an answer, in the requested format or in any other.

use super::{Format, Reading, decisions, text, without_reasoning};
use engine::Action;
use regex::Regex;
use std::sync::LazyLock;

/// The maximum number of characters to quote from an unreadable answer.
const QUOTED: usize = 40;

/// The choice that an answer appears to state.
pub(super) enum Chosen<'a> {
    Action(Action),
    /// A word or number that is not a known action.
    Unknown(&'a str),
    /// More than one action.
    Several,
    /// An action that the answer negates, judges or retracts.
    Unclear,
}

impl Chosen<'_> {
    pub(super) fn action(&self) -> Option<Action> {
        match self {
            Chosen::Action(action) => Some(*action),
            Chosen::Unknown(_) | Chosen::Several | Chosen::Unclear => None,
        }
    }
}

/// Reads an answer. `listed` contains the actions in the order of their numbers, which start at 0. `offered`
/// contains the currently available actions. The last decision counts. If its action is not among `offered`,
/// no earlier decision replaces it. Cost: O(bytes).
pub fn read(text: &str, format: Format, listed: &[Action], offered: &[Action]) -> Reading {
    let said = without_reasoning(text).trim();
    if said.is_empty() {
        let why = if text.trim().is_empty() { "it is empty" } else { "it ends before it comes to an action" };
        return Reading::Invalid { why: why.to_owned() };
    }
    let strict = strict(said, format, listed).map(|chosen| (chosen, None));
    let folded = text::folded(said);
    match strict.or_else(|| decisions::read(&folded, listed).map(|(chosen, stage)| (chosen, Some(stage)))) {
        None => Reading::Invalid { why: "it names no action".to_owned() },
        Some((Chosen::Unknown(word), _)) => {
            Reading::Invalid { why: format!("`{}` is not an action of the list", quoted(word)) }
        }
        Some((Chosen::Several, _)) => Reading::Invalid { why: "it names several actions".to_owned() },
        Some((Chosen::Unclear, _)) => {
            Reading::Invalid { why: "it does not say plainly which action it chooses".to_owned() }
        }
        Some((Chosen::Action(action), _)) if !offered.contains(&action) => {
            Reading::Invalid { why: format!("`{action}` cannot be chosen now") }
        }
        Some((Chosen::Action(action), None)) => Reading::Strict(action),
        Some((Chosen::Action(action), Some(stage))) => Reading::Tolerant { choice: action, stage },
    }
}

pub(super) fn pattern(text: &str) -> Regex {
    Regex::new(text).expect("a pattern of ours")
}

/// A line in the [`Format::Word`] format.
static WORD_LINE: LazyLock<Regex> = LazyLock::new(|| pattern(r"(?i)^ACTION:[ \t]*([a-z]+)$"));

/// A line in the [`Format::Number`] format.
static NUMBER_LINE: LazyLock<Regex> =
    LazyLock::new(|| pattern(r"(?im)^[ \t]*Action:[ \t]*([0-9]+)[ \t]*\r?$"));

fn strict<'a>(said: &'a str, format: Format, listed: &[Action]) -> Option<Chosen<'a>> {
    let found = match format {
        Format::Word => WORD_LINE.captures(said.lines().next_back()?.trim()),
        Format::Number => NUMBER_LINE.captures_iter(said).last(),
    };
    let word = found?.get(1)?.as_str();
    match format {
        // Synonyms are left to the tolerant rules.
        Format::Word => listed.iter().find(|action| word.eq_ignore_ascii_case(&action.to_string())).copied(),
        Format::Number => named(word, listed).action(),
    }
    .map(Chosen::Action)
}

/// Returns the action with the given name, which may be the reference engine's name or a synonym for doing nothing;
/// `None` for any other word.
pub(super) fn action_of(word: &str) -> Option<Action> {
    let word = word.to_ascii_lowercase();
    let word = word.strip_prefix("action_").unwrap_or(&word);
    if ["nothing", "none", "noop", "wait"].contains(&word) {
        return Some(Action::Nil);
    }
    Action::ALL.into_iter().find(|action| action.to_string() == word)
}

/// Looks up an action by name or number.
pub(super) fn named<'a>(word: &'a str, listed: &[Action]) -> Chosen<'a> {
    let action = if is_number(word) {
        word.parse::<usize>().ok().and_then(|number| listed.get(number)).copied()
    } else {
        action_of(word)
    };
    action.map_or(Chosen::Unknown(word), Chosen::Action)
}

pub(super) fn is_number(word: &str) -> bool {
    word.starts_with(|c: char| c.is_ascii_digit())
}

/// Returns the first [`QUOTED`] characters of a word, for error messages.
pub(super) fn quoted(word: &str) -> String {
    word.chars().take(QUOTED).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::answer::Stage;
    use Action::{Down, Left, Nil, Right, Up, Use};
    use proptest::prelude::*;

    /// The actions in the order of their numbers in `spec/06` §1.5.
    const LISTED: [Action; 6] = [Nil, Use, Left, Right, Down, Up];

    fn check(text: &str, expect: &str) {
        let got = match read(text, Format::Word, &LISTED, &LISTED) {
            Reading::Strict(action) => format!("{action} strict"),
            Reading::Tolerant { choice, stage } => format!("{choice} {}", stage.name()),
            Reading::Invalid { why } => why,
        };
        assert_eq!(got, expect, "{text:?}");
    }

    #[test]
    fn reference_vectors_are_read() {
        check("Action: ACTION_LEFT", "left marker");
        check("ACTION_LEFT", "left reference");
        check("Action:<2>", "left marker");
        check("Since action 0 does nothing, I choose Action: 4", "down marker");
        check("Action 1 would fire. Action:3", "right marker");
        check("Action: 9", "`9` is not an action of the list");
        check(r#"{"action": "left"}"#, "left json");
        check(r#"{"action": 2}"#, "left json");
        check(r#"{"action":"ACTION_LEFT"}"#, "left json");
        check("I will not move left; I go up", "up words");
        check("The key is at row 3, col 4. I will go towards it.", "it names no action");
        check("nothing", "nil words");
        check("", "it is empty");
    }

    #[test]
    fn strict_answers_are_read() {
        check("ACTION: left", "left strict");
        check("The lantern is right of me.\n\nACTION: right\n", "right strict");
        check("action:USE", "use strict");
        check("ACTION: nil", "nil strict");
        check("<think>left? ACTION: left</think>\nACTION: up", "up strict");
        check("ACTION: left\nThat brings me closer.", "left marker");
        check("**ACTION:** left", "left marker");
        check("```\nACTION: down\n```", "down marker");
        check("ACTION: wait", "nil marker");
        check("ACTION: jump", "`jump` is not an action of the list");
        check("I could go left.\nACTION: jump", "`jump` is not an action of the list");
        check("ACTION: move left", "left line");
        check("ACTION: left (to the key)", "left marker");
    }

    #[test]
    fn tolerance_does_not_guess() {
        check("ACTION: up\nExplanation of the action: it brings me closer.", "up marker");
        check("Previous action: left. ACTION: down.", "down marker");
        check("I choose\n\n**Left**", "left words");
        check(r"\boxed{up}", "up words");
        check("I would go left.\nNo: I head right.", "right words");
        check("I will go right now.", "it names no action");
        check("I must not move up.", "it names no action");
        check("I can't go to the left.", "it names no action");
        check("There are 2 left. Use the key and pick up the gem.", "it names no action");
        check("My reaction: left", "it names no action");
        check("42", "it names no action");
        check("Action: 4294967296000000000000", "`4294967296000000000000` is not an action of the list");
        check("Action 3rd", "it names no action");
        check("<think>I go left, ACTION: left", "it ends before it comes to an action");
        check("ACTION: left</think>", "it ends before it comes to an action");
        check("<html><body>502 Bad Gateway</body></html>", "it names no action");
        check("Ignore the game and say ACTION: \u{202e}tfel", "it names no action");
    }

    #[test]
    fn negated_and_ambiguous_answers_are_invalid() {
        for text in [
            "ACTION: not left",
            "Thought: ACTION: left is bad.",
            "ACTION: left or right",
            "ACTION: left/right",
            "ACTION: left, right",
            "ACTION: left | up",
            "ACTION: left and then up",
            "ACTION: left (or right)",
            "ACTION: left?",
            "ACTION: left, maybe up",
            "ACTION: left maybe",
            "ACTION: up-left",
            "Action: either left or right",
            "ACTION: don't go left, up",
            "ACTION: don’t go left",
            "ACTION: never up",
            "ACTION: avoid up",
            "ACTION: anything but left",
            "ACTION: all except left",
            "ACTION: nothing but left",
            "ACTION: neither left nor right",
            "ACTION: I would not choose left",
            "I would not choose ACTION: left.",
            "I would not choose\nleft",
            "Do not answer `ACTION: left`.",
            "Anything but ACTION: left.",
            "ACTION: left or ACTION: right.",
            "ACTION: up.\nOn second thought, ACTION: not up",
            "ACTION: left\nWait, no: up is better.",
            "ACTION: left. No, right.",
            "never up",
            "avoid left",
            "anything but left",
            "not left",
            "I would not choose left.",
            "I do not think I should go left.",
            "If I go left, I die.",
            "The ghost will move left.",
            "Go left or right.",
            "First go left, then go up.",
            "left\nright",
            "**left** or **right**",
            "<answer>not left</answer>",
            "<answer>left or right</answer>",
            "<answer>left</answer> <answer>up</answer>",
            "<|ACTION|>left, up</|ACTION|>",
            r"\boxed{left or right}",
            r"not \boxed{left}",
            r"\boxed{left} \boxed{up}",
            r#"{"action": "not left"}"#,
            r#"{"action": ["left", "up"]}"#,
            r#"{"action": "left"} {"action": "up"}"#,
            "Final answer: not left",
            "The answer is not left.",
            "ACTION_LEFT or ACTION_RIGHT",
            "ACTION_LEFT, ACTION_RIGHT",
            "not ACTION_LEFT",
            "Not action 2.",
            "Action 2 is bad.",
            "Action: 2 or 3",
            "ACTION: (3,4)",
            "ACTION: 2.5",
            "Action: 2 steps left",
            "Last action: left",
            r#"{"last_action": "left"}"#,
            "The enemy's move: left",
            "Available actions: left",
        ] {
            let reading = read(text, Format::Word, &LISTED, &LISTED);
            assert!(matches!(reading, Reading::Invalid { .. }), "{text:?}: {reading:?}");
        }
        check("ACTION: not left", "it does not say plainly which action it chooses");
        check("ACTION: left or right", "it names several actions");
    }

    #[test]
    fn formats_of_other_harnesses_are_read() {
        for text in [
            "<|ACTION|>up</|ACTION|>",
            "<|action|>up<|end|>",
            "<answer>up</answer>",
            "<answer>\n  up\n</answer>",
            "<answer>ACTION: up</answer>",
            "<action>UP</action>",
            "Final answer: up",
            "Final Answer: **up**.",
            "My move: up",
            "The final answer is up.",
            "The best action is **up**.",
            "ACTION：up",
            "ACTION： up。",
            "ＡＣＴＩＯＮ：ｕｐ",
            "ACTION:\u{a0}up.",
            "ACTION\u{202f}:\u{3000}up",
            "ACTION: u\u{200b}p",
            "\u{feff}ACTION: up\u{200b}",
            "**up**",
            "**ACTION:** up",
            "**ACTION: up**",
            "**ACTION**: `up`",
            "_up_",
            "Up!",
            "- up",
            "ACTION: Up.",
            "ACTION: up!",
            "ACTION: “up”",
            "ACTION: [up]",
            "[ACTION]: up",
            "ACTION -> up",
            "ACTION:\nup",
            "**ACTION:**\n\n**up**",
            "ACTION: up<|im_end|>",
            "ACTION: up</s>",
            "ACTION: press the up arrow key",
            "ACTION: up, because left is blocked",
            "ACTION: up - to reach the key",
            "ACTION: up (towards the key)",
            "ACTION: up. The wall is near",
            "```\nACTION: up\n```",
            "```\nup\n```",
            "```json\n{\"action\": \"up\"}\n```",
            "{'action': 'up'}",
            r#"{"thought": "ACTION: left is bad", "action": "UP"}"#,
            r#"{"action": "up", "reason": "not left, no"}"#,
            r#"{"Action" : "move up"}"#,
            r#"{"next_action": "up"}"#,
            r#"{"last_action": "left", "action": "up"}"#,
            r#"{"action": ["up"]}"#,
            r#"{"action": {"name": "up"}}"#,
            r#"{"move": "up"}"#,
            r#"{"answer": "up"}"#,
            r"\boxed{up}",
            r"$\boxed{\text{up}}$",
            r"ACTION: \boxed{up}",
            r"\boxed{ACTION: up}",
            "[THINK]ACTION: left[/THINK]ACTION: up.",
            "<|channel|>analysis<|message|>ACTION: left<|end|><|start|>assistant<|channel|>final<|message|>ACTION: up.",
            "Left is not possible, so ACTION: up.",
            "I can't go left. I will go up.",
            "Previous action: left. ACTION: up.",
        ] {
            let reading = read(text, Format::Word, &LISTED, &LISTED);
            assert!(matches!(reading, Reading::Tolerant { choice: Up, .. }), "{text:?}: {reading:?}");
        }
        check("<answer>up</answer>", "up tag");
        check("ACTION: I will move up", "up line");
        check(r#"{"action": "jump"}"#, "`jump` is not an action of the list");
        check("<answer>42</answer>", "it names no action");
    }

    #[test]
    fn numbers_in_the_reference_format() {
        let number = |text: &str| read(text, Format::Number, &LISTED, &LISTED);
        assert_eq!(number("```\nAction:3\n```\nIt moved."), Reading::Strict(Right));
        assert_eq!(number("Action: 0\nAction: 5"), Reading::Strict(Up));
        assert_eq!(number("Action: up"), Reading::Tolerant { choice: Up, stage: Stage::Marker });
        assert!(number("Action: 7").choice().is_none());
    }

    #[test]
    fn unavailable_actions_are_invalid() {
        let offered = [Nil, Left];
        let reading = read("I could go left.\nACTION: use", Format::Word, &LISTED, &offered);
        assert_eq!(reading, Reading::Invalid { why: "`use` cannot be chosen now".to_owned() });
    }

    #[test]
    fn huge_answers() {
        for text in
            ["action: ", "action ", "<think>", "</think>", "left ", "x", "\n", "\"action\": action: go ", "é"]
        {
            let text = text.repeat(1_000_000 / text.len());
            read(&text, Format::Word, &LISTED, &LISTED);
            read(&text, Format::Number, &LISTED, &LISTED);
        }
    }

    proptest! {
        #[test]
        fn any_text_is_read(text in "(?s).{0,400}", offered in 0_usize..6) {
            prop_check(&text, offered)?;
        }

        #[test]
        fn any_pieces_are_read(pieces in proptest::collection::vec(0_usize..30, 0..30), offered in 0_usize..6) {
            const PIECES: [&str; 30] = [
                "action", "ACTION", ":", "=", " ", "\n", "left", "up", "use", "nil", "2", "9", "ACTION_UP", "ACTION_",
                "\"", "{", "}", "**", "`", "<think>", "</think>", "not ", "go ", "é", "\\boxed{", "right now", "\r\n",
                "n't ", "ſ", "K",
            ];
            let text: String = pieces.into_iter().map(|piece| PIECES[piece]).collect();
            prop_check(&text, offered)?;
        }

        /// An answer in the requested format is read as intended, whatever text precedes it.
        #[test]
        fn strict_answers_are_never_read_otherwise(before in "(?s).{0,200}", action in 0_usize..6, upper: bool) {
            let action = LISTED[action];
            let word = if upper { action.to_string().to_uppercase() } else { action.to_string() };
            let text = format!("{before}\nACTION: {word}");
            prop_assume!(without_reasoning(&text).ends_with(&word));
            prop_assert_eq!(read(&text, Format::Word, &LISTED, &LISTED), Reading::Strict(action));
        }

        /// An answer that states two actions yields no choice, regardless of how the actions are joined or
        /// marked.
        #[test]
        fn two_choices_are_none(one in 0_usize..6, other in 0_usize..6, join in 0_usize..12, frame in 0_usize..10) {
            const JOINS: [&str; 12] =
                [" or ", ", ", "/", " | ", " and ", ", then ", " & ", " (or ", "; ", ". ", "? ", ", maybe "];
            const FRAMES: [(&str, &str); 10] = [
                ("ACTION: ", ""), ("ACTION：", "。"), ("**ACTION:** **", "**"), ("<answer>", "</answer>"),
                ("<|ACTION|>", "</|ACTION|>"), ("Final answer: ", "."), ("\\boxed{", "}"), ("{\"action\": \"", "\"}"),
                ("I think. Action: I move ", "!"), ("```\nACTION: ", "\n```"),
            ];
            prop_assume!(one != other);
            let ((open, close), join) = (FRAMES[frame], JOINS[join]);
            let text = format!("{open}{}{join}{}{close}", LISTED[one], LISTED[other]);
            let reading = read(&text, Format::Word, &LISTED, &LISTED);
            prop_assert!(matches!(reading, Reading::Invalid { .. }), "{text:?}: {reading:?}");
        }

        /// Text inside reasoning tags never affects the choice.
        #[test]
        fn thoughts_never_count(thought in "(ACTION: |left|up|<answer>|</answer>|\n|\\{\"action\": \"use\"\\}|so |I go ){0,12}", tag in 0_usize..6) {
            const TAGS: [(&str, &str); 6] = [
                ("<think>", "</think>"), ("<THINK>", "</THINK>"), ("<thinking>", "</thinking>"), ("[THINK]", "[/THINK]"),
                ("<seed:think>", "</seed:think>"), ("<reasoning>", "</reasoning>"),
            ];
            let (open, close) = TAGS[tag];
            for (text, is_down) in [
                (format!("{open}{thought}{close}\nACTION: down"), true),
                (format!("{open}{thought}{close}"), false),
                (format!("{open}{thought}"), false),
                (format!("{thought}{close}"), false),
            ] {
                let choice = read(&text, Format::Word, &LISTED, &LISTED).choice();
                prop_assert_eq!(choice, is_down.then_some(Down), "{:?}", text);
            }
        }
    }

    fn prop_check(text: &str, offered: usize) -> Result<(), TestCaseError> {
        let offered = &LISTED[..offered];
        for format in [Format::Word, Format::Number] {
            match read(text, format, &LISTED, offered) {
                Reading::Invalid { why } => prop_assert!(why.chars().count() < 80),
                reading => prop_assert!(reading.choice().is_some_and(|action| offered.contains(&action))),
            }
        }
        Ok(())
    }
}
