//! The messages exchanged at each of an episode's decisions.

use crate::page::words;
use evaluation::client::{Finish, Role};
use evaluation::log::{Event, Reply, ReplyClass};
use serde::Serialize;

/// The maximum length of a displayed answer, in characters.
const ANSWER: usize = 1_500;
/// The maximum length of displayed reasoning, in characters.
const REASONING: usize = 1_500;
/// The maximum length of a displayed prompt, in characters.
const SHOWN: usize = 6_000;

/// The messages exchanged at a decision.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub(super) struct Talk {
    /// The messages that are new to the player, excluding its own answers.
    pub(super) shown: Vec<String>,
    /// The player's answers. There is more than one if the question was repeated.
    pub(super) answers: Vec<Answer>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Answer {
    pub(super) text: String,
    pub(super) reasoning: Option<String>,
    /// The answer's validity, in one word. Empty if the answer has the requested format.
    pub(super) class: &'static str,
    /// A phrase stating the number of tokens and the duration.
    pub(super) cost: String,
}

/// Returns the messages exchanged at each decision, in chronological order. Decisions without messages have an empty
/// entry.
///
/// If a conversation continues from an earlier level, the log repeats the texts of that level. The repetitions are
/// omitted here. The question after the last decision is assigned to that decision.
pub(super) fn talks(log: &[Event]) -> Vec<Talk> {
    let (mut talks, mut current, mut new): (Vec<Talk>, _, _) = (Vec::new(), Talk::default(), Vec::new());
    for event in log {
        match event {
            Event::Message { id, role, text, image } if *role != Role::Assistant => {
                let picture = if image.is_some() { "[an image of the board]\n" } else { "" };
                new.push((*id, cut(&format!("{picture}{text}"), SHOWN)));
            }
            Event::Request { messages, .. } => {
                let is_shown = |id: &u32| [messages.first(), messages.last()].contains(&Some(id));
                current.shown.extend(new.drain(..).filter(|(id, _)| is_shown(id)).map(|(_, text)| text));
            }
            Event::Reply(reply) => current.answers.push(Answer::of(reply)),
            Event::Step { .. } => talks.push(std::mem::take(&mut current)),
            _ => {}
        }
    }
    if let Some(last) = talks.last_mut().filter(|_| !current.answers.is_empty()) {
        last.shown.append(&mut current.shown);
        last.answers.append(&mut current.answers);
    }
    talks
}

impl Answer {
    fn of(reply: &Reply) -> Answer {
        let class = match reply.class {
            ReplyClass::Strict => "",
            ReplyClass::Tolerant => "read with tolerance",
            ReplyClass::Invalid => "invalid",
            ReplyClass::Refused => "refused",
            ReplyClass::Truncated => "truncated",
        };
        let reasoning = reply.reasoning.as_ref().map(|text| cut(text, REASONING));
        let mut cost = Vec::new();
        let usage = &reply.usage;
        if let (Some(input), Some(output)) = (usage.input_tokens, usage.output_tokens) {
            cost.push(format!("{} + {} tokens", words::grouped(input), words::grouped(output)));
        }
        if !reply.cached {
            cost.push(format!("{} ms", words::short(reply.latency_ms.round())));
        }
        if reply.finish == Finish::Length {
            cost.push("cut off".to_owned());
        }
        Answer {
            text: cut(&reply.text, ANSWER),
            reasoning: reasoning.filter(|text| !text.is_empty()),
            class,
            cost: cost.join(", "),
        }
    }
}

/// Returns the first `most` characters of a text, followed by a note stating how many were omitted.
fn cut(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        None => text.trim_end().to_owned(),
        Some((end, _)) => {
            let more = text[end..].chars().count() as u64;
            format!("{} … [{} more characters]", text[..end].trim_end(), words::grouped(more))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn earlier_levels_are_left_out_and_the_last_question_is_kept() {
        let message =
            |id: u32, role: Role| Event::Message { id, role, text: format!("text {id}"), image: None };
        let request = |messages: Vec<u32>| Event::Request { step: 0, attempt: 0, messages, tokens: 9 };
        let line = r#"{"event":"reply","step":0,"attempt":0,"class":"strict","text":"so","finish":"stop","usage":{},"latency_ms":0}"#;
        let reply: Event = serde_json::from_str(line).unwrap();
        let line = r#"{"event":"step","step":0,"action":"nil","validity":"valid","score":0.0,"hash":"HASH","outcome":"ongoing","avatar":null,"took_ms":0}"#;
        let step: Event = serde_json::from_str(&line.replace("HASH", &"0".repeat(32))).unwrap();
        let log = [
            message(0, Role::System),
            message(1, Role::User),
            message(2, Role::Assistant),
            message(3, Role::User),
            request(vec![0, 1, 2, 3]),
            reply.clone(),
            step,
            message(4, Role::User),
            request(vec![0, 1, 2, 3, 4]),
            reply,
        ];
        let talks = talks(&log);
        assert_eq!(talks.len(), 1);
        assert_eq!(talks[0].shown, ["text 0", "text 3", "text 4"]);
        assert_eq!(talks[0].answers.len(), 2);
    }

    #[test]
    fn long_texts_say_how_much_is_left_out() {
        assert_eq!(cut("short\n", 10), "short");
        assert_eq!(cut("äöüäöü", 4), "äöüä … [2 more characters]");
    }
}
