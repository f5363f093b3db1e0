//! Tests of limits on output tokens: how they are stated, counted, enforced and recorded.

use crate::games::corridor;
use base::Seed;
use evaluation::client::{ChatError, ChatErrorKind, ChatReply, ChatRequest, Decoding, Finish, Model, Usage};
use evaluation::log::ReplyClass;
use evaluation::metrics::EpisodeMetrics;
use evaluation::player::ModelPlayer;
use evaluation::player::mailbox::{Desk, Mailbox, MailboxPlayer};
use evaluation::prompt::{PromptSettings, Prompter};
use evaluation::run::{Task, play};
use evaluation::{
    AnswerLimit, Commitment, Contestant, Entrant, Evaluation, Event, Journal, Settings, Subject, Validity,
};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

/// A model that gives prepared answers, with the number of output tokens that it reports.
struct Scripted(Mutex<Vec<(&'static str, Finish, Option<u64>)>>);

impl Model for Scripted {
    fn chat(&self, _: &ChatRequest) -> Result<ChatReply, ChatError> {
        let mut left = self.0.lock().unwrap();
        if left.is_empty() {
            let message = "no answer is left".to_owned();
            return Err(ChatError { kind: ChatErrorKind::Budget, message, failures: Vec::new() });
        }
        let (text, finish, output_tokens) = left.remove(0);
        let usage = Usage { output_tokens, ..Usage::default() };
        Ok(ChatReply { usage, ..ChatReply::new(text.to_owned(), finish) })
    }
}

fn task(subject: &Subject, limit: Option<u32>) -> Task<'_> {
    Task {
        subject,
        level: &subject.levels[1],
        run: 0,
        seed: Seed::from_text("budgets"),
        max_steps: 3,
        commit: Commitment::ONE,
        max_output_tokens: limit,
        track: None,
        series: None,
    }
}

/// Plays the corridor with prepared answers, and returns the log.
fn played(limit: Option<u32>, answers: &[(&'static str, Finish, Option<u64>)]) -> Vec<Event> {
    let subject = corridor();
    let prompter = Prompter::new(&subject, PromptSettings::default()).unwrap();
    let prompter = Arc::new(prompter.with_answer_limit(limit.map(AnswerLimit::Tokens)));
    let model = Arc::new(Scripted(Mutex::new(answers.to_vec())));
    let samples = Seed::from_text("samples");
    let player = ModelPlayer::new(model, prompter, Decoding::default(), 1, samples);
    let mut journal = Journal::in_memory();
    play(&task(&subject, limit), &mut Contestant::Agent(Box::new(player)), &mut journal).unwrap();
    let log = journal.events().to_vec();
    let metrics = EpisodeMetrics::of(&subject, &log).expect("the log is sound");
    assert_eq!(metrics.max_output_tokens, limit);
    log
}

/// Returns the class of each answer, and the validity of each step.
fn told(log: &[Event]) -> (Vec<ReplyClass>, Vec<Validity>) {
    let class = |event: &Event| match event {
        Event::Reply(reply) => Some(reply.class),
        _ => None,
    };
    let validity = |event: &Event| match event {
        Event::Step { validity, .. } => Some(*validity),
        _ => None,
    };
    (log.iter().filter_map(class).collect(), log.iter().filter_map(validity).collect())
}

const GO: &str = "ACTION: right";

#[test]
fn an_answer_over_the_limit_is_no_answer() {
    use ReplyClass::{Strict, Truncated};
    let answers = [(GO, Finish::Stop, Some(50)), (GO, Finish::Stop, Some(51)), (GO, Finish::Stop, None)];
    let log = played(Some(50), &answers);
    let valid = Validity::Valid;
    assert_eq!(told(&log), (vec![Strict, Truncated, Strict], vec![valid, Validity::Truncated, valid]));
    let excess = |event: &Event| matches!(event, Event::Reply(reply) if reply.finish == Finish::Excess);
    assert_eq!(log.iter().filter(|event| excess(event)).count(), 1);
    // Without a limit, the same answers are all usable.
    assert_eq!(told(&played(None, &answers)).0, [Strict, Strict, Strict]);
    // Words count if the server reports no tokens.
    let wordy = [("I think that I should go. ACTION: right", Finish::Stop, None), (GO, Finish::Stop, None)];
    assert_eq!(told(&played(Some(5), &wordy)).0, [Truncated, Strict]);
}

/// A question is not repeated after an answer that has used up its tokens, because the player would get more tokens.
/// Other unusable answers are repeated as without a limit.
#[test]
fn a_spent_answer_is_not_repeated() {
    use ReplyClass::{Invalid, Strict, Truncated};
    let cut = ("I think", Finish::Length, Some(50));
    let unclear = ("I do not know.", Finish::Stop, Some(9));
    let go = (GO, Finish::Stop, Some(9));
    assert_eq!(told(&played(Some(50), &[cut, unclear, go, go])).0, [Truncated, Invalid, Strict, Strict]);
    assert_eq!(told(&played(None, &[cut, go, go, go])).0, [Truncated, Strict, Strict, Strict]);
}

#[test]
fn prompts_state_the_limit() {
    let subject = corridor();
    let with = |limit| Prompter::new(&subject, PromptSettings::default()).unwrap().with_answer_limit(limit);
    let plain = with(None);
    let tokens = with(Some(AnswerLimit::Tokens(500)));
    let words = with(Some(AnswerLimit::Words(500)));
    let rest = |own: &Prompter| own.static_part().strip_prefix(plain.static_part()).map(str::to_owned);
    assert_eq!(
        rest(&tokens).expect("the limit comes last"),
        "\nAn answer may have at most 500 tokens, all your thoughts included. A longer answer counts as no answer."
    );
    assert!(
        rest(&words).expect("the limit comes last").starts_with("\nAn answer may have at most 500 words.")
    );
    let digests =
        [plain.digest(), tokens.digest(), words.digest(), with(Some(AnswerLimit::Tokens(5))).digest()];
    for (at, digest) in digests.iter().enumerate() {
        assert!(!digests[..at].contains(digest), "prompts with different limits have different digests");
    }
}

/// Players that answer through files state their own count in the first line, or their words count.
#[test]
fn mailboxes_count_words_or_what_is_stated() {
    let home = tempfile::tempdir().unwrap();
    let (subject, folder) = (corridor(), home.path().join("box"));
    let entrant =
        Entrant { name: "alice".into(), mode: None, aids: Vec::new(), details: serde_json::Value::Null };
    let settings = Settings {
        format: evaluation::run::FORMAT,
        semantics: engine::SEMANTICS,
        suite: "test".into(),
        snapshot: None,
        entrant,
        seed: "test".into(),
        runs: 1,
        max_steps: 3,
        commit: Commitment::ONE,
        max_output_tokens: Some(4),
        track: None,
        series: 1,
        adaptive: None,
        games: Evaluation::entries(std::slice::from_ref(&subject)),
    };
    let mailbox = Arc::new(Mailbox::open(&folder, &settings, false, Arc::new(|_| ())).unwrap());
    let prompter = Prompter::new(&subject, PromptSettings::default()).unwrap();
    let prompter = Arc::new(prompter.with_answer_limit(Some(AnswerLimit::Words(4))));
    let log = thread::scope(|scope| {
        let playing = scope.spawn(|| {
            let task = task(&subject, Some(4));
            let player = MailboxPlayer::new(mailbox.clone(), &task, prompter, 1);
            let mut journal = Journal::in_memory();
            play(&task, &mut Contestant::Agent(Box::new(player)), &mut journal).unwrap();
            journal.events().to_vec()
        });
        for (step, text) in [
            (0, "So, right.\nACTION: right"),
            (1, "Tokens: 900\nACTION: right"),
            (2, "Now I think.\nACTION: right"),
        ] {
            let desk = Desk::open(&folder).unwrap();
            let open = loop {
                let waiting = desk.view().unwrap().waiting;
                if let Some(open) = waiting.into_iter().find(|open| open.prompt.address.step == step) {
                    break open;
                }
                thread::sleep(Duration::from_millis(10));
            };
            desk.answer(&open.prompt, text).unwrap();
        }
        playing.join().unwrap()
    });
    use ReplyClass::{Strict, Truncated};
    assert_eq!(told(&log).0, [Strict, Truncated, Truncated]);
    assert_eq!(EpisodeMetrics::of(&subject, &log).unwrap().thought, Some(4 + 900 + 5));
}
