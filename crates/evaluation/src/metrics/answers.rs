//! Checks that the answers recorded before a step are consistent with the step's validity.

use crate::log::{Event, Reply, ReplyClass};
use crate::player::Validity;
use engine::Action;

/// The answers recorded since the last step.
#[derive(Debug, Default)]
pub(super) struct Answers<'a> {
    replies: Vec<&'a Reply>,
    /// `true` if the player is a model. An external program's log contains no requests, only invalid answers.
    is_model: bool,
}

impl<'a> Answers<'a> {
    /// Adds an answer that precedes the step with index `step`.
    pub(super) fn reply(&mut self, reply: &'a Reply, step: usize) -> Result<(), String> {
        if reply.step != step as u64 {
            return Err(format!("the answer to step {} precedes step {step}", reply.step));
        }
        self.replies.push(reply);
        Ok(())
    }

    /// Records an event between two steps that is not an answer.
    pub(super) fn other(&mut self, event: &Event) {
        self.is_model |= matches!(event, Event::Request { .. });
    }

    /// Compares a step with the preceding answers, and clears the answers.
    pub(super) fn step(&mut self, event: &Event) -> Result<(), String> {
        let Event::Step { step, action, validity, calls, .. } = event else { return Ok(()) };
        let is_named = |reply: &Reply| reply.action == Some(*action);
        self.decision(*step, *validity, *action == Action::Nil, calls.is_some(), is_named)
    }

    /// Compares a plan with the preceding answers, and clears the answers.
    pub(super) fn plan(&mut self, event: &Event) -> Result<(), String> {
        let Event::Plan { step, actions, validity } = event else { return Ok(()) };
        let is_named = |reply: &Reply| reply.plan.as_ref() == Some(actions);
        self.decision(*step, *validity, actions.is_empty(), false, is_named)
    }

    /// Compares a decision with the preceding answers. `is_named` returns `true` if an answer states the
    /// decision's actions.
    fn decision(
        &mut self,
        step: u64,
        validity: Validity,
        is_nothing: bool,
        is_planned: bool,
        is_named: impl Fn(&Reply) -> bool,
    ) -> Result<(), String> {
        let Answers { replies, is_model } = std::mem::take(self);
        let wrong = |what: &str| Err(format!("step {step} is recorded as {}, but {what}", validity.name()));
        let is_valid = validity == Validity::Valid;
        if !is_valid && !is_nothing {
            return wrong("the step has an action");
        }
        if !is_valid && is_planned {
            return wrong("a planner chose its action");
        }
        let Some(last) = replies.last() else {
            return if is_model { wrong("the answer is missing") } else { Ok(()) };
        };
        if !is_model {
            // An external program's log contains a usable answer only if the answer reports the program's thought. If
            // the log contains two unreadable answers, the second was the last answer.
            let has_failed = replies.len() > 1;
            return match (last.class, validity) {
                (ReplyClass::Strict, Validity::Valid) | (ReplyClass::Truncated, Validity::Truncated) => {
                    Ok(())
                }
                (ReplyClass::Strict | ReplyClass::Truncated, _) => {
                    wrong("the last answer contradicts the record")
                }
                _ if is_valid && has_failed => wrong("no answer was usable"),
                _ if !is_valid && !has_failed => wrong("only one answer was unusable"),
                _ => Ok(()),
            };
        }
        match (validity, last.class) {
            (Validity::Valid, ReplyClass::Strict | ReplyClass::Tolerant) if is_named(last) => Ok(()),
            (Validity::Valid, ReplyClass::Strict | ReplyClass::Tolerant) => {
                wrong("the last answer specifies a different action")
            }
            (Validity::Invalid, ReplyClass::Invalid)
            | (Validity::Refused, ReplyClass::Refused)
            | (Validity::Truncated, ReplyClass::Truncated) => Ok(()),
            _ => wrong("the last answer contradicts the record"),
        }
    }
}
