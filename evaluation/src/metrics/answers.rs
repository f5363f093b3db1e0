//! The answers before a step, and how the step says that it came about: the two have to agree.

use crate::log::{Event, Reply, ReplyClass};
use crate::player::Validity;
use engine::Action;

/// The answers since the last step.
#[derive(Debug, Default)]
pub(super) struct Answers<'a> {
    replies: Vec<&'a Reply>,
    /// True if a model was asked. Programs are asked without a word in the log, which has their wrong answers only.
    is_model: bool,
}

impl<'a> Answers<'a> {
    /// Takes up an answer, before the step of this number.
    pub(super) fn reply(&mut self, reply: &'a Reply, step: usize) -> Result<(), String> {
        if reply.step != step as u64 {
            return Err(format!("an answer to step {} stands before step {step}", reply.step));
        }
        self.replies.push(reply);
        Ok(())
    }

    /// Takes up any other event between two steps.
    pub(super) fn other(&mut self, event: &Event) {
        self.is_model |= matches!(event, Event::Request { .. });
    }

    /// Compares a step with the answers before it, and forgets them.
    pub(super) fn step(&mut self, event: &Event) -> Result<(), String> {
        let Event::Step { step, action, validity, calls, .. } = event else { return Ok(()) };
        let Answers { replies, is_model } = std::mem::take(self);
        let wrong = |what: &str| Err(format!("step {step} is recorded as {}, but {what}", name(*validity)));
        let is_valid = *validity == Validity::Valid;
        if !is_valid && *action != Action::Nil {
            return wrong("something was done");
        }
        if !is_valid && calls.is_some() {
            return wrong("a planner has chosen it");
        }
        let Some(last) = replies.last() else {
            return if is_model { wrong("the answer is missing") } else { Ok(()) };
        };
        if !is_model {
            // The answer that could be read is not in the log; a second one that could not is the last.
            let has_failed = replies.len() > 1;
            return match (is_valid, has_failed) {
                (true, true) => wrong("no answer could be read"),
                (false, false) => wrong("only one answer could not be read"),
                _ => Ok(()),
            };
        }
        match (validity, last.class) {
            (Validity::Valid, ReplyClass::Strict | ReplyClass::Tolerant) if last.action == Some(*action) => {
                Ok(())
            }
            (Validity::Valid, ReplyClass::Strict | ReplyClass::Tolerant) => {
                wrong("the last answer names another action")
            }
            (Validity::Invalid, ReplyClass::Invalid)
            | (Validity::Refused, ReplyClass::Refused)
            | (Validity::Truncated, ReplyClass::Truncated) => Ok(()),
            _ => wrong("the last answer is recorded otherwise"),
        }
    }
}

/// As in logs.
fn name(validity: Validity) -> &'static str {
    match validity {
        Validity::Valid => "valid",
        Validity::Invalid => "invalid",
        Validity::Refused => "refused",
        Validity::Truncated => "truncated",
    }
}
