//! The dialogue with the examined player, and its log.

use super::answer::{self, Answer};
use super::prompt;
use super::score::WorldModelScore;
use super::task::WorldModelTask;
use crate::client::{ChatMessage, ChatReply, Finish, Role};
use crate::log::{Event, Journal, Reply, ReplyClass};
use crate::player::Halt;
use crate::player::mailbox::Address;
use crate::tokens;
use engine::Game;
use serde::{Deserialize, Serialize};

/// The maximum number of answers that are not explorations: the first one, and two corrections.
pub const MAX_ATTEMPTS: u32 = 3;

/// The result of an examination.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Examined {
    /// The number of answers that are not explorations, from 1 to [`MAX_ATTEMPTS`].
    pub attempts: u32,
    /// The number of actions that the examined player used to explore the game.
    pub explored: usize,
    /// The problems in the last answer, if it contains no usable game.
    pub problems: Option<String>,
    /// The canonical text of the game that the examined player wrote, if it is usable.
    pub game: Option<String>,
    /// The score. Without a usable game, nothing is reproduced.
    pub score: WorldModelScore,
}

/// A function that answers a conversation. The address consists of the number of actions played so far and the number
/// of unusable answers.
pub type Ask<'a> = dyn FnMut(Address, &[ChatMessage]) -> Result<ChatReply, Halt> + 'a;

/// Examines the player that answers through `ask`. Answers that are already in the log are not requested again.
///
/// # Errors
/// Returns an error if `ask` returns one, if the log cannot be written, or if the log contains a different question.
pub fn examine(task: &WorldModelTask, journal: &mut Journal, ask: &mut Ask<'_>) -> Result<Examined, Halt> {
    let conversation = vec![message(Role::User, prompt::question(task))];
    let mut dialogue = Dialogue { task, journal, conversation };
    let (mut explored, mut attempt) = (0, 0);
    loop {
        let left = task.actions - explored;
        let address = Address { step: explored as u64, attempt };
        let text = dialogue.reply(address, left, ask)?;
        let told = match answer::read(task, &text, left) {
            Answer::Game(game) => return Ok(examined(task, attempt + 1, explored, Ok(game))),
            Answer::Unusable(problems) if attempt + 1 == MAX_ATTEMPTS => {
                return Ok(examined(task, MAX_ATTEMPTS, explored, Err(problems)));
            }
            Answer::Unusable(problems) => {
                attempt += 1;
                prompt::complaint(&problems)
            }
            Answer::Played(recording) => {
                explored += recording.actions.len();
                prompt::played(task, &recording, task.actions - explored)
            }
        };
        dialogue.conversation.extend([message(Role::Assistant, text), message(Role::User, told)]);
    }
}

fn examined(task: &WorldModelTask, attempts: u32, explored: usize, read: Result<Game, String>) -> Examined {
    let score = WorldModelScore::of(task, read.as_ref().ok());
    let game = read.as_ref().ok().map(|game| engine::syntax::print_bare(game.description()));
    Examined { attempts, explored, problems: read.err(), game, score }
}

fn message(role: Role, text: String) -> ChatMessage {
    ChatMessage { role, text, image: None }
}

struct Dialogue<'a> {
    task: &'a WorldModelTask,
    journal: &'a mut Journal,
    conversation: Vec<ChatMessage>,
}

impl Dialogue<'_> {
    /// Returns the text of an answer from the log, or requests the answer and logs it.
    fn reply(&mut self, address: Address, left: usize, ask: &mut Ask<'_>) -> Result<String, Halt> {
        self.log_request(address)?;
        let recorded = self.journal.events().iter().find_map(|event| match event {
            Event::Reply(reply) if (reply.step, reply.attempt) == (address.step, address.attempt) => {
                Some(reply.text.clone())
            }
            _ => None,
        });
        if let Some(text) = recorded {
            return Ok(text);
        }
        let mut answer = ask(address, &self.conversation)?;
        answer::shorten(&mut answer.text);
        let class = match (answer::read(self.task, &answer.text, left), answer.finish) {
            (Answer::Game(_) | Answer::Played(_), _) => ReplyClass::Strict,
            (_, Finish::Refusal) => ReplyClass::Refused,
            (_, Finish::Length) => ReplyClass::Truncated,
            _ => ReplyClass::Invalid,
        };
        let text = answer.text.clone();
        self.push(Event::Reply(Reply::of(address.step, address.attempt, class, answer)))?;
        Ok(text)
    }

    /// Logs a question before it is sent, unless it is already in the log.
    fn log_request(&mut self, address: Address) -> Result<(), Halt> {
        let texts = self.journal.events().iter().filter_map(|event| match event {
            Event::Message { text, .. } => Some(text),
            _ => None,
        });
        let logged = texts.clone().count();
        if texts.zip(&self.conversation).any(|(text, message)| *text != message.text) {
            let problem = "the log contains a different question; use the settings and the version of arcade with which the log was started";
            return Err(Halt::Log(problem.to_owned()));
        }
        for (id, message) in self.conversation.clone().into_iter().enumerate().skip(logged) {
            self.push(Event::Message { id: id as u32, role: message.role, text: message.text, image: None })?;
        }
        let (now, now_attempt) = (address.step, address.attempt);
        let is_same = |event: &Event| matches!(event, Event::Request { step, attempt, .. } if (*step, *attempt) == (now, now_attempt));
        if self.journal.events().iter().any(is_same) {
            return Ok(());
        }
        let count = |message: &ChatMessage| tokens::count(&message.text) + tokens::PER_MESSAGE;
        let tokens = self.conversation.iter().map(count).sum();
        let messages = (0..self.conversation.len() as u32).collect();
        self.push(Event::Request { step: now, attempt: now_attempt, messages, tokens })
    }

    fn push(&mut self, event: Event) -> Result<(), Halt> {
        self.journal.push(event).map_err(|error| Halt::Log(error.to_string()))
    }
}
