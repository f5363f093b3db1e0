//! Responses sent line by line.

use crate::refusal::Refusal;
use axum::body::{Body, Bytes, HttpBody};
use axum::http::header;
use axum::response::Response;
use hyper::body::Frame;
use serde::Serialize;
use serde_json::json;
use std::convert::Infallible;
use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::{Context, Poll};
use tokio::sync::mpsc::{Receiver, Sender, channel};

/// The maximum number of lines that wait for a client to read them.
const WAITING: usize = 256;

/// The error for a client that is no longer waiting, so the work can end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gone;

/// The sending end of a response.
#[derive(Clone, Debug)]
pub(crate) struct Lines {
    sender: Sender<Bytes>,
    superseded: Arc<AtomicBool>,
}

impl Lines {
    /// Creates the sending end, and the response that carries the lines.
    pub(crate) fn new() -> (Lines, Response) {
        let (sender, receiver) = channel(WAITING);
        let mut response = Response::new(Body::new(Reading(receiver)));
        let kind = header::HeaderValue::from_static("application/x-ndjson");
        response.headers_mut().insert(header::CONTENT_TYPE, kind);
        (Lines { sender, superseded: Arc::default() }, response)
    }

    /// Sends one line, and waits if the client reads slowly. The call blocks, so it must not run on the
    /// runtime's thread.
    pub(crate) fn send(&self, line: &impl Serialize) -> Result<(), Gone> {
        self.check()?;
        self.put(line)
    }

    fn put(&self, line: &impl Serialize) -> Result<(), Gone> {
        let mut bytes = serde_json::to_vec(line).map_err(|_| Gone)?;
        bytes.push(b'\n');
        self.sender.blocking_send(bytes.into()).map_err(|_| Gone)
    }

    /// Returns an error once the client is no longer waiting.
    pub(crate) fn check(&self) -> Result<(), Gone> {
        if self.sender.is_closed() || self.superseded.load(Ordering::Relaxed) { Err(Gone) } else { Ok(()) }
    }

    /// Returns the switch that ends this response in favour of a newer one.
    pub(crate) fn switch(&self) -> Arc<AtomicBool> {
        self.superseded.clone()
    }

    /// Runs the work for a response, and sends its last line.
    pub(crate) fn finish(self, work: impl FnOnce(&Lines) -> Result<(), Ended>) {
        let last = match work(&self) {
            Ok(()) => json!({ "stage": "done" }),
            Err(Ended::Gone) => json!({ "stage": "error", "error": "superseded" }),
            Err(Ended::Refused(refusal)) => json!({ "stage": "error", "error": refusal.text() }),
        };
        let _ = self.put(&last);
    }
}

/// The reason for ending a response early.
#[derive(Debug)]
pub(crate) enum Ended {
    Gone,
    Refused(Refusal),
}

impl From<Gone> for Ended {
    fn from(_: Gone) -> Ended {
        Ended::Gone
    }
}

impl From<Refusal> for Ended {
    fn from(refusal: Refusal) -> Ended {
        Ended::Refused(refusal)
    }
}

/// The receiving end, as the body of a response.
struct Reading(Receiver<Bytes>);

impl HttpBody for Reading {
    type Data = Bytes;
    type Error = Infallible;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, Infallible>>> {
        self.0.poll_recv(context).map(|line| line.map(|line| Ok(Frame::data(line))))
    }
}
