//! The sources of drafts.

use crate::references::Reference;
use base::Seed;
use evaluation::client::{ChatMessage, ChatReply, ChatRequest, Decoding, Model};
use evaluation::player::mailbox::{Address, EpisodeResult, Mailbox};
use evaluation::{EvaluationError, Halt};
use std::sync::Arc;

/// A source of drafts: a language model, a mailbox in which a person or a program answers questions, or a
/// reference designer.
#[derive(Clone)]
pub enum Designer {
    /// A language model.
    Model {
        /// The model.
        model: Arc<dyn Model>,
        /// The sampling settings for its answers.
        decoding: Decoding,
    },
    /// A mailbox. Each draft is a conversation in its own folder.
    Mailbox(Arc<Mailbox>),
    /// A reference designer, which is a program that answers no questions.
    Reference(Reference),
}

impl Designer {
    /// Asks a question, and waits for the answer.
    ///
    /// # Errors
    /// Returns an error if the answer is missing for a reason that is not the designer's fault.
    pub(crate) fn ask(
        &self,
        conversation: &str,
        address: Address,
        messages: &[ChatMessage],
        sample: Seed,
    ) -> Result<ChatReply, Halt> {
        match self {
            Designer::Model { model, decoding } => {
                let (messages, decoding) = (messages.to_vec(), decoding.clone());
                Ok(model.chat(&ChatRequest { messages, decoding, sample })?)
            }
            Designer::Mailbox(mailbox) => Ok(mailbox.ask(conversation, address, messages)?),
            Designer::Reference(_) => Err(Halt::Log("a reference designer answers no questions".to_owned())),
        }
    }

    /// Reports in the mailbox that a conversation is over. Does nothing for designers without a mailbox.
    ///
    /// # Errors
    /// Returns an error if a file cannot be written.
    pub(crate) fn end(
        &self,
        conversation: &str,
        result: &EpisodeResult,
        text: &str,
    ) -> Result<(), EvaluationError> {
        match self {
            Designer::Model { .. } | Designer::Reference(_) => Ok(()),
            Designer::Mailbox(mailbox) => mailbox.end(conversation, result, text),
        }
    }
}
