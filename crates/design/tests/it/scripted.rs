//! A designer that returns recorded answers, and the settings of small runs.

use base::Seed;
use engine::SEMANTICS;
use evaluation::client::{ChatError, ChatErrorKind, ChatReply, ChatRequest, Decoding, Finish, Model, Usage};
use infinite_arcade_design::{Brief, DesignSettings, Designer, FORMAT, Known};
use serde_json::json;
use std::sync::{Arc, Mutex};
use validators::{Criteria, Criterion, CriterionSet};

/// A model that returns the given answers, in order, and then reports that a cap was reached.
pub(crate) struct Scripted {
    answers: Mutex<Vec<String>>,
    pub(crate) asked: Mutex<Vec<ChatRequest>>,
}

impl Scripted {
    pub(crate) fn new(answers: &[String]) -> Arc<Scripted> {
        let mut answers = answers.to_vec();
        answers.reverse();
        Arc::new(Scripted { answers: Mutex::new(answers), asked: Mutex::default() })
    }

    pub(crate) fn designer(self: &Arc<Self>) -> Designer {
        Designer::Model { model: self.clone(), decoding: Decoding::default() }
    }

    /// Returns the last message of each question.
    pub(crate) fn questions(&self) -> Vec<String> {
        let asked = self.asked.lock().unwrap();
        asked.iter().map(|request| request.messages.last().unwrap().text.clone()).collect()
    }
}

impl Model for Scripted {
    fn chat(&self, request: &ChatRequest) -> Result<ChatReply, ChatError> {
        let Some(text) = self.answers.lock().unwrap().pop() else {
            let message = "the next request would exceed --max-requests 3".to_owned();
            return Err(ChatError { kind: ChatErrorKind::Budget, message, failures: Vec::new() });
        };
        self.asked.lock().unwrap().push(request.clone());
        let usage = Usage { input_tokens: Some(100), output_tokens: Some(10), ..Usage::default() };
        Ok(ChatReply { usage, ..ChatReply::new(text, Finish::Stop) })
    }
}

/// Settings for small games of two levels that only need to be winnable.
pub(crate) fn settings(drafts: u64) -> DesignSettings {
    let criteria = Criteria {
        ask: CriterionSet::of(&[Criterion::WellFormed, Criterion::Winnable]),
        budget: 20_000,
        ..Criteria::default()
    };
    DesignSettings {
        format: FORMAT,
        semantics: SEMANTICS,
        suite: "test".to_owned(),
        designer: "scripted".to_owned(),
        details: json!({}),
        price: None,
        drafts,
        seed: Seed::from_text("design").to_string(),
        brief: Brief { levels: 2, theme: None, tier: None, required: Vec::new(), unlike: Vec::new() },
        criteria,
        known: Known::default().digest(),
    }
}
