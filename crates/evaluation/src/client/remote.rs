//! A model on a server. The client retries after transient failures, enforces caps and rates, and uses the
//! cache.

use super::cache::{self, Cache};
use super::chat::{ChatError, ChatErrorKind, ChatReply, ChatRequest, Failure, Model};
use super::clock::Clock;
use super::fault::{Fault, classify, shorten};
use super::http::{HttpClient, HttpError};
use super::key::Key;
use super::options::OnFailure;
use super::pace::Pace;
use super::spec::ModelSpec;
use super::spending::caps::Caps;
use super::spending::estimate::prompt_tokens;
use base::{Digest, Sampler};
use std::collections::BTreeMap;
use std::num::NonZeroU32;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

pub(super) struct Remote {
    pub(super) spec: ModelSpec,
    pub(super) key: Option<Key>,
    pub(super) http: HttpClient,
    pub(super) pace: Pace,
    pub(super) caps: Arc<Caps>,
    pub(super) cache: Option<Cache>,
    pub(super) tries: NonZeroU32,
    pub(super) clock: Arc<dyn Clock>,
    /// `true` once a connection was not refused. Before that, a refused connection means that no server is running.
    pub(super) is_reached: AtomicBool,
    /// A function that reports failures while the request is still being retried.
    pub(super) on_failure: Option<OnFailure>,
    /// The time of the last report about each HTTP status; `None` stands for failures without a status.
    pub(super) reported: Mutex<BTreeMap<Option<u16>, Duration>>,
}

/// The wait after the first failed try. The wait doubles after each further failure.
const FIRST_WAIT: Duration = Duration::from_secs(1);

/// The maximum wait, unless the server requests a longer one.
const MAX_WAIT: Duration = Duration::from_secs(60);

/// The maximum wait that a server can request. The client gives up if the server requests more.
const MAX_SERVER_WAIT: Duration = Duration::from_secs(300);

/// The minimum time between two reports about the same HTTP status.
const REPORT_EVERY: Duration = Duration::from_secs(60);

impl Model for Remote {
    fn chat(&self, request: &ChatRequest) -> Result<ChatReply, ChatError> {
        let provider = self.spec.provider;
        let url = format!("{}{}", self.spec.server.base_url, provider.path(&self.spec.model));
        let body = provider.body(&self.spec.model, request).to_string().into_bytes();
        let entry = self.cache.as_ref().map(|cache| (cache, cache::key(provider, &url, &body, request)));
        if let Some(reply) = entry.and_then(|(cache, key)| cache.get(key)) {
            return Ok(ChatReply { cached: true, ..reply });
        }
        let _slot = self.pace.enter();
        self.request_with_retries(request, &url, &body, entry)
    }
}

impl Remote {
    /// Requests an answer that is not in the cache.
    fn request_with_retries(
        &self,
        request: &ChatRequest,
        url: &str,
        body: &[u8],
        entry: Option<(&Cache, Digest)>,
    ) -> Result<ChatReply, ChatError> {
        let prompt = prompt_tokens(request);
        let reservation = self.caps.reserve(prompt).map_err(|message| ChatError {
            kind: ChatErrorKind::Budget,
            message,
            failures: Vec::new(),
        })?;
        let mut jitter = request.sample.child("jitter", 0).sampler();
        let mut failures = Vec::new();
        loop {
            self.pace.wait(prompt);
            let begin = self.clock.elapsed();
            let outcome = self.try_once(url, body);
            let latency = self.clock.elapsed().saturating_sub(begin);
            let (status, message, requested_wait) = match outcome {
                Ok(answer) => {
                    let latency_ms = latency.as_micros() as f64 / 1000.0;
                    let reply = ChatReply { failures, latency_ms, ..answer };
                    // The answer is stored first. If the run is killed after this point, the next run finds
                    // the answer in the cache.
                    if let Some((cache, key)) = entry {
                        cache.put(key, &reply);
                    }
                    reservation.settle(&reply.usage, &reply.text, reply.reasoning.as_deref());
                    if let (Some(input), Some(output)) = (reply.usage.input_tokens, reply.usage.output_tokens)
                    {
                        self.pace.correct(prompt, input.saturating_add(output));
                    }
                    return Ok(reply);
                }
                Err(Fault::Final { status, message }) => {
                    failures.push(Failure { status: Some(status), message: message.clone(), waited_ms: 0 });
                    return Err(self.rejected(status, &message, failures));
                }
                Err(Fault::Unreachable { message }) => {
                    failures.push(Failure { status: None, message, waited_ms: 0 });
                    return Err(self.unreachable(failures));
                }
                Err(Fault::Transient { status, message, wait }) => (status, message, wait),
            };
            let number = failures.len() as u32 + 1;
            if number == 1 {
                self.report_failure(status, &message);
            }
            let too_long = requested_wait.is_some_and(|time| time > MAX_SERVER_WAIT);
            if number == self.tries.get() || too_long {
                failures.push(Failure { status, message, waited_ms: 0 });
                return Err(self.given_up(failures, requested_wait.filter(|_| too_long)));
            }
            if let Some(time) = requested_wait {
                self.pace.delay_all(time);
            }
            let wait = wait(number, requested_wait, &mut jitter);
            failures.push(Failure { status, message, waited_ms: wait.as_millis() as u64 });
            self.clock.sleep(wait);
        }
    }

    fn try_once(&self, url: &str, body: &[u8]) -> Result<ChatReply, Fault> {
        let headers = self.spec.provider.headers(self.key.as_ref());
        let outcome = self.http.post(url, &headers, body);
        let hide = |words: String| match &self.key {
            Some(key) => key.hide_in_message(&words),
            None => words,
        };
        let is_refused = matches!(&outcome, Err(error) if error.is_refused);
        let was_reached = match is_refused {
            true => self.is_reached.load(Ordering::Relaxed),
            false => self.is_reached.swap(true, Ordering::Relaxed),
        };
        let mut reply = outcome.map_err(|HttpError { status, message, is_refused }| {
            let message = shorten(&hide(message));
            match is_refused && !was_reached {
                true => Fault::Unreachable { message },
                false => Fault::Transient { status, message, wait: None },
            }
        })?;
        if let Some(key) = &self.key {
            let answers = (200..300).contains(&reply.status);
            reply.body =
                if answers { key.hide_in_answer(reply.body) } else { key.hide_in_message(&reply.body) };
        }
        match classify(self.spec.provider, &reply, self.clock.date()) {
            Ok(answer) => Ok(self.without_key(answer)),
            Err(Fault::Transient { status, message, wait }) => {
                Err(Fault::Transient { status, message: hide(message), wait })
            }
            Err(Fault::Unreachable { message }) => Err(Fault::Unreachable { message: hide(message) }),
            Err(Fault::Final { status, message }) => Err(Fault::Final { status, message: hide(message) }),
        }
    }

    /// Removes the key once more after parsing, because JSON can encode the same text in many ways.
    fn without_key(&self, answer: ChatReply) -> ChatReply {
        let Some(key) = &self.key else { return answer };
        let hide = |text| key.hide_in_answer(text);
        ChatReply {
            text: hide(answer.text),
            reasoning: answer.reasoning.map(hide),
            served_by: answer.served_by.map(hide),
            ..answer
        }
    }

    fn rejected(&self, status: u16, words: &str, failures: Vec<Failure>) -> ChatError {
        let (host, model) = (&self.spec.server.host, &self.spec.model);
        let next = match (status, &self.key) {
            (401 | 403, Some(key)) => {
                format!("; check that the key in {} is valid for {host}", key.variable)
            }
            (401 | 403, None) => {
                "; if the server requires a key, pass the name of its variable with --key-variable".to_owned()
            }
            (404, _) if self.spec.server.own => format!("; check the model name `{model}`"),
            (404, _) => {
                format!("; check the model name `{model}` and the end of the base URL (usually `/v1`)")
            }
            _ => String::new(),
        };
        let message = format!("{host} rejected the request ({status}: {words}){next}");
        ChatError { kind: ChatErrorKind::Rejected, message, failures }
    }

    /// Reports the first failed try of a request, so that the user knows why nothing happens. Failures with the same
    /// status are reported once per minute, because a server may limit the rate of most requests.
    fn report_failure(&self, status: Option<u16>, message: &str) {
        let Some(OnFailure(report)) = &self.on_failure else { return };
        let now = self.clock.elapsed();
        let mut reported = self.reported.lock().expect("no holder panics");
        let is_due = reported.get(&status).is_none_or(|&last| now.saturating_sub(last) >= REPORT_EVERY);
        if is_due {
            reported.insert(status, now);
            let status = status.map(|status| format!("{status}: ")).unwrap_or_default();
            let (host, tries) = (&self.spec.server.host, self.tries);
            let next =
                if tries.get() == 1 { String::new() } else { format!("; it is tried up to {tries} times") };
            report(&format!("a request to {host} failed ({status}{message}){next}"));
        }
    }

    fn unreachable(&self, failures: Vec<Failure>) -> ChatError {
        let host = &self.spec.server.host;
        let message = format!("no server answers at {host} (connection refused); is it running?");
        ChatError { kind: ChatErrorKind::Unreachable, message, failures }
    }

    fn given_up(&self, failures: Vec<Failure>, requested_wait: Option<Duration>) -> ChatError {
        let host = &self.spec.server.host;
        let last = failures.last().expect("at least one try has failed");
        let status = last.status.map(|status| format!("{status}: ")).unwrap_or_default();
        let times = if failures.len() == 1 { "once".to_owned() } else { format!("{} times", failures.len()) };
        let requested_wait = requested_wait
            .map(|time| format!(", and the server requested a wait of {} s", time.as_secs()))
            .unwrap_or_default();
        let message = format!(
            "requests to {host} failed {times}, the last time with {status}{}{requested_wait}; continue later with --resume",
            last.message
        );
        ChatError { kind: ChatErrorKind::Infrastructure, message, failures }
    }
}

/// Returns the wait after a failed try.
///
/// The wait grows exponentially with every try. It is multiplied by a random factor between one half and one,
/// so that threads that failed at the same time do not retry at the same time. If the server requests a
/// longer wait, returns the requested wait plus a small random amount.
fn wait(number: u32, requested_wait: Option<Duration>, jitter: &mut Sampler) -> Duration {
    let doubled = FIRST_WAIT.saturating_mul(1u32.checked_shl(number - 1).unwrap_or(u32::MAX));
    let own = doubled.min(MAX_WAIT).mul_f64(0.5 + 0.5 * jitter.unit());
    let requested_wait =
        requested_wait.map_or(Duration::ZERO, |time| time + FIRST_WAIT.mul_f64(jitter.unit()));
    own.max(requested_wait)
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::Seed;

    #[test]
    fn waits_double_up_to_a_minute() {
        let mut jitter = Seed::from_text("jitter").sampler();
        for (number, seconds) in [(1, 1.0), (2, 2.0), (5, 16.0), (7, 60.0), (40, 60.0)] {
            let time = wait(number, None, &mut jitter).as_secs_f64();
            assert!(time >= seconds / 2.0 && time <= seconds, "{time} after try {number}");
        }
        let time = wait(3, Some(Duration::from_secs(20)), &mut jitter).as_secs_f64();
        assert!((20.0..21.0).contains(&time), "{time}");
        assert!(
            wait(6, Some(Duration::ZERO), &mut jitter) >= Duration::from_secs(16),
            "it asks for too little"
        );
    }
}
