//! The questions and answers of one draft, recorded in its log.

use crate::designer::Designer;
use crate::stages::Stage;
use base::Seed;
use evaluation::client::{ChatMessage, ChatReply, Finish};
use evaluation::log::{Event, Reply, ReplyClass};
use evaluation::player::mailbox::Address;
use evaluation::{Halt, Journal, tokens};

/// A draft's conversation. Answers that are already in the log are not requested again.
pub(crate) struct Dialogue<'a> {
    pub(crate) journal: Journal,
    /// The source of answers, or `None` to use only the log.
    pub(crate) designer: Option<&'a Designer>,
    /// The name of the conversation in a mailbox.
    pub(crate) conversation: &'a str,
    /// The seed for sampling answers.
    pub(crate) samples: Seed,
}

impl Dialogue<'_> {
    /// Asks a question. `is_usable` returns `true` if a text is in the requested format.
    ///
    /// # Errors
    /// Returns an error if there is no answer, if the log cannot be written, or if the log contains a different
    /// question at this position.
    pub(crate) fn ask(
        &mut self,
        stage: Stage,
        attempt: u32,
        messages: &[ChatMessage],
        is_usable: impl Fn(&str) -> bool,
    ) -> Result<Reply, Halt> {
        let step = stage as u64;
        if let Some(asked) = self.asked(step, attempt)
            && asked != messages
        {
            return Err(Halt::Log(format!(
                "the question in the log for stage `{stage}`, attempt {attempt}, differs from the question that follows \
                 from the log's answers; use the version of arcade that wrote the log"
            )));
        }
        if let Some(reply) = self.recorded(step, attempt) {
            return Ok(reply);
        }
        let Some(designer) = self.designer else {
            return Err(Halt::Log(format!("the log has no answer for stage `{stage}`, attempt {attempt}")));
        };
        self.record_question(step, attempt, messages)?;
        let sample = self.samples.child("step", step).child("attempt", u64::from(attempt));
        let answer = designer.ask(self.conversation, Address { step, attempt }, messages, sample)?;
        let reply = Reply::of(step, attempt, class(&answer, is_usable), answer);
        push(&mut self.journal, Event::Reply(reply.clone()))?;
        Ok(reply)
    }

    fn recorded(&self, step: u64, attempt: u32) -> Option<Reply> {
        self.journal.events().iter().find_map(|event| match event {
            Event::Reply(reply) if (reply.step, reply.attempt) == (step, attempt) => Some(reply.clone()),
            _ => None,
        })
    }

    /// Returns the messages of a question in the log; `None` if the log does not contain the question.
    fn asked(&self, step: u64, attempt: u32) -> Option<Vec<ChatMessage>> {
        let ids = self.journal.events().iter().find_map(|event| match event {
            Event::Request { step: other, attempt: again, messages, .. }
                if (*other, *again) == (step, attempt) =>
            {
                Some(messages)
            }
            _ => None,
        })?;
        let message = |wanted: &u32| {
            self.journal.events().iter().find_map(|event| match event {
                Event::Message { id, role, text, .. } if id == wanted => {
                    Some(ChatMessage { role: *role, text: text.clone(), image: None })
                }
                _ => None,
            })
        };
        Some(ids.iter().filter_map(message).collect())
    }

    /// Logs a question before it is sent, unless an interrupted run has already logged it.
    fn record_question(&mut self, step: u64, attempt: u32, messages: &[ChatMessage]) -> Result<(), Halt> {
        if self.asked(step, attempt).is_some() {
            return Ok(());
        }
        let ids = messages.iter().map(|message| self.number(message)).collect::<Result<Vec<u32>, Halt>>()?;
        let count = |message: &ChatMessage| tokens::count(&message.text) + tokens::PER_MESSAGE;
        let tokens = messages.iter().map(count).sum();
        push(&mut self.journal, Event::Request { step, attempt, messages: ids, tokens })
    }

    /// Returns a message's index in the log. A message is added to the log at its first use.
    fn number(&mut self, message: &ChatMessage) -> Result<u32, Halt> {
        let texts = self.journal.events().iter().filter_map(|event| match event {
            Event::Message { id, role, text, .. } => Some((*id, *role, text)),
            _ => None,
        });
        if let Some((id, ..)) =
            texts.clone().find(|(_, role, text)| (*role, *text) == (message.role, &message.text))
        {
            return Ok(id);
        }
        let (id, role, text) = (texts.count() as u32, message.role, message.text.clone());
        push(&mut self.journal, Event::Message { id, role, text, image: None })?;
        Ok(id)
    }
}

fn push(journal: &mut Journal, event: Event) -> Result<(), Halt> {
    journal.push(event).map_err(|error| Halt::Log(error.to_string()))
}

fn class(answer: &ChatReply, is_usable: impl Fn(&str) -> bool) -> ReplyClass {
    match answer.finish {
        _ if is_usable(&answer.text) => ReplyClass::Strict,
        Finish::Refusal => ReplyClass::Refused,
        Finish::Length => ReplyClass::Truncated,
        _ => ReplyClass::Invalid,
    }
}
