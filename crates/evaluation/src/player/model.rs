//! A language model as a player: its prompts, its answers, and their interpretation.

use crate::answer::Reading;
use crate::client::{ChatMessage, ChatReply, ChatRequest, Decoding, Finish, Model};
use crate::error::EvaluationError;
use crate::log::{Event, Journal, Reply, ReplyClass};
use crate::player::{Agent, Choice, Halt, Said, Validity};
use crate::predictions::Predicted;
use crate::prompt::{Attempt, Past, Prompt, Prompter};
use crate::run::Task;
use crate::turn::Turn;
use base::{Digest, Seed};
use engine::Action;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The feedback on a truncated answer.
const CUT_OFF: &str = "it was cut off before it stated an action";
/// The feedback on an answer that exceeds the limit on its length.
const TOO_LONG: &str = "it exceeds the limit on its length";
/// The feedback on a refusal.
const DECLINED: &str = "it declines to play";

/// An agent that plays an episode with a language model.
pub struct ModelPlayer {
    model: Arc<dyn Model>,
    prompter: Arc<Prompter>,
    decoding: Decoding,
    /// The maximum number of times that a question is repeated after answers without a usable action.
    reasks: u32,
    /// The seed for sampling answers.
    samples: Seed,
    past: Vec<Past>,
    /// The indices of texts already in the log.
    texts: BTreeMap<Text, u32>,
    /// The number of log events whose texts have already been added to `texts`.
    read: usize,
}

/// The source of a turn's answers.
enum Log<'a> {
    /// The log, and the model for answers missing from the log.
    Open(&'a mut Journal),
    /// The log alone, because the turn is over.
    Past(&'a Journal),
}

type Text = (u8, Digest, Option<Digest>);

impl ModelPlayer {
    /// Creates a player for one episode of the prompter's game. `reasks` is the maximum number of times that
    /// a question is repeated after an answer without an available action. `samples` is the seed for sampling
    /// the answers, which must not change when the episode is resumed.
    pub fn new(
        model: Arc<dyn Model>,
        prompter: Arc<Prompter>,
        decoding: Decoding,
        reasks: u32,
        samples: Seed,
    ) -> ModelPlayer {
        let (past, texts) = (Vec::new(), BTreeMap::new());
        ModelPlayer { model, prompter, decoding, reasks, samples, past, texts, read: 0 }
    }

    /// Uses the given model for all further answers.
    pub(super) fn set_model(&mut self, model: Arc<dyn Model>) {
        self.model = model;
    }

    /// Makes up to `reasks + 1` attempts at a turn. Answers that are already in the log are not requested
    /// again.
    fn turn(&mut self, turn: &Turn<'_>, mut log: Log<'_>) -> Result<Choice, Halt> {
        let prompter = self.prompter.clone();
        let mut attempts = Vec::new();
        let mut attempt = 0;
        let (shown, choice) = loop {
            let prompt = prompter.prompt(turn, &self.past, &attempts);
            let recorded = match &log {
                Log::Open(journal) => recorded(journal, attempt),
                Log::Past(journal) => recorded(journal, attempt),
            };
            let reply = match (recorded, &mut log) {
                (Some(reply), _) => reply,
                (None, Log::Open(journal)) => self.ask(turn, journal, attempt, &prompt)?,
                (None, Log::Past(_)) => {
                    return Err(Halt::Log(format!("the log has no answer for step {}", turn.number)));
                }
            };
            let (class, actions, why) = classify(&prompter, turn, &reply.text, reply.finish);
            let again = actions.is_none() && attempt < self.reasks && !self.is_spent(class);
            let complaint = again.then(|| prompter.complaint(&why));
            attempts.push(Attempt { answer: reply.text, complaint });
            if !again {
                let nothing = || Choice::nothing(validity_of(class));
                break (prompt.shown, actions.map_or_else(nothing, Choice::plan));
            }
            attempt += 1;
        };
        self.past.push(Past::new(shown, &attempts, choice.action(0)));
        Ok(choice)
    }

    /// Requests an answer to a turn.
    fn ask(
        &mut self,
        turn: &Turn<'_>,
        journal: &mut Journal,
        attempt: u32,
        prompt: &Prompt,
    ) -> Result<Reply, Halt> {
        let answer = self.request(turn.number, journal, attempt, prompt)?;
        let (class, actions, _) = classify(&self.prompter, turn, &answer.text, answer.finish);
        let stage = match self.prompter.read(&answer.text, turn) {
            Reading::Tolerant { stage, .. } if actions.is_some() => Some(stage.name().to_owned()),
            _ => None,
        };
        let (action, plan) = match turn.commit.is_one() {
            true => (actions.and_then(|actions| actions.first().copied()), None),
            false => (None, actions),
        };
        let reply = Reply { action, plan, stage, ..Reply::of(turn.number, attempt, class, answer) };
        push(journal, Event::Reply(reply.clone()))?;
        Ok(reply)
    }

    /// Makes up to `reasks + 1` attempts at the last question of a series. Answers that are already in the
    /// log are not requested again.
    fn question(&mut self, last: &Turn<'_>, kinds: &[String], journal: &mut Journal) -> Result<Said, Halt> {
        let prompter = self.prompter.clone();
        let mut attempts = Vec::new();
        let mut attempt = 0;
        loop {
            let prompt = prompter.question(last, kinds, &self.past, &attempts);
            let classified = |text: &str, finish| classify_predictions(&prompter, kinds, text, finish);
            let reply = match recorded(journal, attempt) {
                Some(reply) => reply,
                None => {
                    let answer = self.request(last.number, journal, attempt, &prompt)?;
                    let (class, ..) = classified(&answer.text, answer.finish);
                    let reply = Reply::of(last.number, attempt, class, answer);
                    push(journal, Event::Reply(reply.clone()))?;
                    reply
                }
            };
            let (class, predicted, why) = classified(&reply.text, reply.finish);
            if let Some(predicted) = predicted {
                return Ok(Said { predicted: Some(predicted), validity: Validity::Valid });
            }
            if attempt >= self.reasks || self.is_spent(class) {
                return Ok(Said { predicted: None, validity: validity_of(class) });
            }
            let complaint = Some(prompter.question_complaint(&why, kinds));
            attempts.push(Attempt { answer: reply.text, complaint });
            attempt += 1;
        }
    }

    /// Returns `true` if an answer has used up the limit on its length. Its question is not repeated, because the
    /// player would think longer than the limit allows.
    fn is_spent(&self, class: ReplyClass) -> bool {
        class == ReplyClass::Truncated && self.prompter.answer_limit().is_some()
    }

    /// Requests an answer. The request is logged before it is sent.
    fn request(
        &mut self,
        step: u64,
        journal: &mut Journal,
        attempt: u32,
        prompt: &Prompt,
    ) -> Result<ChatReply, Halt> {
        let messages = prompt.messages.iter().map(|message| self.number(message, journal));
        let messages = messages.collect::<Result<Vec<u32>, Halt>>()?;
        let was_requested =
            |event: &Event| matches!(event, Event::Request { attempt: other, .. } if *other == attempt);
        if !journal.pending().iter().any(was_requested) {
            let tokens = prompt.tokens.total;
            push(journal, Event::Request { step, attempt, messages, tokens })?;
        }
        let request = ChatRequest {
            messages: prompt.messages.clone(),
            decoding: self.decoding.clone(),
            sample: self.samples.child("step", step).child("attempt", u64::from(attempt)),
        };
        let answer = self.model.chat(&request)?;
        let is_excess = self.prompter.answer_limit().is_some_and(|limit| limit.is_exceeded(&answer));
        Ok(if is_excess { ChatReply { finish: Finish::Excess, ..answer } } else { answer })
    }

    /// Returns a message's index in the log. Each message is added to the log when it is first used.
    fn number(&mut self, message: &ChatMessage, journal: &mut Journal) -> Result<u32, Halt> {
        for event in &journal.events()[self.read..] {
            if let Event::Message { id, role, text, image } = event {
                self.texts.insert((*role as u8, Digest::of(text.as_bytes()), *image), *id);
            }
        }
        self.read = journal.events().len();
        let image = message.image.as_deref().map(Digest::of);
        let text = (message.role as u8, Digest::of(message.text.as_bytes()), image);
        if let Some(&id) = self.texts.get(&text) {
            return Ok(id);
        }
        let id = self.texts.len() as u32;
        let (role, words) = (message.role, message.text.clone());
        push(journal, Event::Message { id, role, text: words, image })?;
        self.texts.insert(text, id);
        Ok(id)
    }
}

impl Agent for ModelPlayer {
    fn begin(&mut self, task: &Task<'_>) {
        // Each level has its own log, in which texts are numbered from 0. The answers on later levels are
        // sampled with new seeds.
        if !task.is_practice() && task.series.is_some() {
            self.samples = task.chance().child("answers", 0);
        }
        self.texts.clear();
        self.read = 0;
    }

    fn predict(
        &mut self,
        last: &Turn<'_>,
        kinds: &[String],
        journal: &mut Journal,
    ) -> Result<Option<Said>, Halt> {
        match self.prompter.asks_predictions() {
            true => self.question(last, kinds, journal).map(Some),
            false => Ok(None),
        }
    }

    fn act(&mut self, turn: &Turn<'_>, journal: &mut Journal) -> Result<Choice, Halt> {
        self.turn(turn, Log::Open(journal))
    }

    fn recall(&mut self, turn: &Turn<'_>, journal: &Journal, choice: &Choice) -> Result<(), Halt> {
        let again = self.turn(turn, Log::Past(journal))?;
        let step = turn.number;
        match again == *choice {
            true => Ok(()),
            false => Err(Halt::Log(format!(
                "the answers at step {step} are now interpreted differently than in the log; resume with the \
                 version of arcade that wrote the log"
            ))),
        }
    }
}

/// Returns an answer's class and its actions. If there are no actions, the returned string states the reason,
/// as a clause whose subject is the answer.
fn classify(
    prompter: &Prompter,
    turn: &Turn<'_>,
    text: &str,
    finish: Finish,
) -> (ReplyClass, Option<Vec<Action>>, String) {
    if finish == Finish::Refusal {
        return (ReplyClass::Refused, None, DECLINED.to_owned());
    }
    if finish == Finish::Excess {
        return (ReplyClass::Truncated, None, TOO_LONG.to_owned());
    }
    match (prompter.read(text, turn), finish) {
        (Reading::Strict(actions), _) => (ReplyClass::Strict, Some(actions), String::new()),
        // An action considered before the answer was cut off is not a decision.
        (_, Finish::Length) => (ReplyClass::Truncated, None, CUT_OFF.to_owned()),
        (Reading::Tolerant { choice, .. }, _) => (ReplyClass::Tolerant, Some(choice), String::new()),
        (Reading::Invalid { why }, _) => (ReplyClass::Invalid, None, why),
    }
}

/// Returns the class and the predictions of an answer to the last question. If there are no predictions, the
/// returned string states the reason, as a clause whose subject is the answer.
fn classify_predictions(
    prompter: &Prompter,
    kinds: &[String],
    text: &str,
    finish: Finish,
) -> (ReplyClass, Option<Predicted>, String) {
    if finish == Finish::Refusal {
        return (ReplyClass::Refused, None, DECLINED.to_owned());
    }
    if finish == Finish::Excess {
        return (ReplyClass::Truncated, None, TOO_LONG.to_owned());
    }
    match (prompter.read_predictions(text, kinds), finish) {
        (Ok(predicted), _) => (ReplyClass::Strict, Some(predicted), String::new()),
        (Err(_), Finish::Length) => (ReplyClass::Truncated, None, CUT_OFF.to_owned()),
        (Err(why), _) => (ReplyClass::Invalid, None, why),
    }
}

/// Returns the validity of a turn whose last answer stated no action.
fn validity_of(class: ReplyClass) -> Validity {
    match class {
        ReplyClass::Refused => Validity::Refused,
        ReplyClass::Truncated => Validity::Truncated,
        ReplyClass::Strict | ReplyClass::Tolerant | ReplyClass::Invalid => Validity::Invalid,
    }
}

/// Returns the recorded answer to the given attempt, if it is in the log.
fn recorded(journal: &Journal, attempt: u32) -> Option<Reply> {
    let reply = |event: &Event| match event {
        Event::Reply(reply) if reply.attempt == attempt => Some(reply.clone()),
        _ => None,
    };
    journal.pending().iter().find_map(reply)
}

fn push(journal: &mut Journal, event: Event) -> Result<(), Halt> {
    journal.push(event).map_err(|error: EvaluationError| Halt::Log(error.to_string()))
}
