//! A scripted server on loopback that gives good and bad answers, and a clock that advances only during
//! sleep.

#![allow(dead_code, reason = "every test file uses its part")]

use evaluation::client::Clock;
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::{Arc, Condvar, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, SystemTime};

/// The server's response to a request.
#[derive(Clone, Debug)]
pub(crate) enum Response {
    /// Sends a complete HTTP reply.
    Reply {
        /// The HTTP status of the reply.
        status: u16,
        /// The headers of the reply, except for the length of its body.
        headers: Vec<(String, String)>,
        /// The body of the reply.
        body: Vec<u8>,
    },
    /// Sends nothing until the server is dropped.
    Hang,
    /// Sends the given bytes, which do not form a complete HTTP reply, and closes the connection.
    Cut(Vec<u8>),
}

/// A request as the server received it.
#[derive(Clone, Debug)]
pub(crate) struct ReceivedRequest {
    /// The path and query of the request.
    pub(crate) path: String,
    /// The headers of the request, with names in lower case.
    pub(crate) headers: Vec<(String, String)>,
    /// The body of the request.
    pub(crate) body: String,
}

impl ReceivedRequest {
    /// Returns the value of a header.
    pub(crate) fn header(&self, name: &str) -> Option<&str> {
        self.headers.iter().find(|(found, _)| found == name).map(|(_, value)| value.as_str())
    }

    /// Parses the body as JSON.
    pub(crate) fn json(&self) -> Value {
        serde_json::from_str(&self.body).expect("requests are JSON")
    }
}

impl Response {
    /// Returns a reply with the given status and body.
    pub(crate) fn reply(status: u16, body: impl Into<Vec<u8>>) -> Response {
        Response::Reply { status, headers: Vec::new(), body: body.into() }
    }

    /// Adds a header to a reply.
    pub(crate) fn with_header(self, name: &str, value: &str) -> Response {
        match self {
            Response::Reply { status, mut headers, body } => {
                headers.push((name.to_owned(), value.to_owned()));
                Response::Reply { status, headers, body }
            }
            other => other,
        }
    }

    /// Returns a chat completion with the given text, which reports 100 prompt tokens and 10 answer tokens.
    pub(crate) fn completion(text: &str) -> Response {
        let body = json!({
            "model": "served",
            "choices": [{ "index": 0, "message": { "role": "assistant", "content": text }, "finish_reason": "stop" }],
            "usage": { "prompt_tokens": 100, "completion_tokens": 10, "total_tokens": 110 },
        });
        Response::reply(200, body.to_string())
    }
}

/// A scripted server, which answers every request on a separate connection.
pub(crate) struct Server {
    address: SocketAddr,
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

type Script = dyn Fn(usize, &ReceivedRequest) -> Response + Send + Sync;

struct Shared {
    script: Box<Script>,
    state: Mutex<State>,
    closed: Condvar,
}

#[derive(Default)]
struct State {
    received: Vec<ReceivedRequest>,
    at_once: usize,
    max_concurrent: usize,
    closed: bool,
}

impl Server {
    /// Starts a server that calls `script` for its response to each request. The argument of `script` is the
    /// index of the request.
    pub(crate) fn start(
        script: impl Fn(usize, &ReceivedRequest) -> Response + Send + Sync + 'static,
    ) -> Server {
        let listener = TcpListener::bind(("127.0.0.1", 0)).expect("loopback has a free port");
        let address = listener.local_addr().expect("it is bound");
        let shared =
            Arc::new(Shared { script: Box::new(script), state: Mutex::default(), closed: Condvar::new() });
        let for_thread = shared.clone();
        let thread = std::thread::spawn(move || accept(&listener, &for_thread));
        Server { address, shared, thread: Some(thread) }
    }

    /// Starts a server that gives the listed responses to successive requests. The last response is repeated.
    pub(crate) fn scripted(acts: Vec<Response>) -> Server {
        Server::start(move |number, _| acts[number.min(acts.len() - 1)].clone())
    }

    /// Returns the server's base URL, in the form used for `--base-url`.
    pub(crate) fn base_url(&self) -> String {
        format!("http://{}/v1", self.address)
    }

    /// Returns all requests received so far.
    pub(crate) fn received(&self) -> Vec<ReceivedRequest> {
        self.shared.state.lock().unwrap().received.clone()
    }

    /// Returns the maximum number of requests that were in progress at the same time.
    pub(crate) fn max_concurrent(&self) -> usize {
        self.shared.state.lock().unwrap().max_concurrent
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.shared.state.lock().unwrap().closed = true;
        self.shared.closed.notify_all();
        // The connection wakes up the thread that is waiting for connections.
        let _ = TcpStream::connect(self.address);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn accept(listener: &TcpListener, shared: &Arc<Shared>) {
    for stream in listener.incoming() {
        if shared.state.lock().unwrap().closed {
            return;
        }
        if let Ok(stream) = stream {
            let shared = shared.clone();
            std::thread::spawn(move || serve(stream, &shared));
        }
    }
}

/// Serves one request. Connection errors are ignored, because the client must handle them.
fn serve(mut stream: TcpStream, shared: &Shared) {
    let Some(received) = read(&mut stream) else { return };
    let number = {
        let mut state = shared.state.lock().unwrap();
        state.received.push(received.clone());
        state.at_once += 1;
        state.max_concurrent = state.max_concurrent.max(state.at_once);
        state.received.len() - 1
    };
    let act = (shared.script)(number, &received);
    // The request must be counted as finished before the answer is sent, because the client could then
    // already send the next one.
    let leave = || shared.state.lock().unwrap().at_once -= 1;
    match act {
        Response::Reply { status, headers, body } => {
            let mut head = format!("HTTP/1.1 {status} As scripted\r\nContent-Length: {}\r\n", body.len());
            head.extend(headers.iter().map(|(name, value)| format!("{name}: {value}\r\n")));
            head.push_str("Connection: close\r\n\r\n");
            leave();
            let _ = stream.write_all(head.as_bytes()).and_then(|()| stream.write_all(&body));
        }
        Response::Cut(bytes) => {
            leave();
            let _ = stream.write_all(&bytes);
        }
        Response::Hang => {
            let state = shared.state.lock().unwrap();
            let mut state = shared.closed.wait_while(state, |state| !state.closed).unwrap();
            state.at_once -= 1;
        }
    }
}

fn read(stream: &mut TcpStream) -> Option<ReceivedRequest> {
    let mut reader = BufReader::new(stream);
    let mut line = String::new();
    reader.read_line(&mut line).ok()?;
    let path = line.split(' ').nth(1)?.to_owned();
    let mut headers = Vec::new();
    loop {
        let mut line = String::new();
        reader.read_line(&mut line).ok()?;
        let Some((name, value)) = line.trim_end().split_once(':') else { break };
        headers.push((name.to_lowercase(), value.trim().to_owned()));
    }
    let length = headers.iter().find(|(name, _)| name == "content-length").map_or("0", |(_, value)| value);
    let mut body = vec![0; length.parse().ok()?];
    reader.read_exact(&mut body).ok()?;
    Some(ReceivedRequest { path, headers, body: String::from_utf8(body).ok()? })
}

/// A clock that advances only during sleep.
#[derive(Default)]
pub(crate) struct FakeClock(Mutex<Vec<Duration>>);

impl FakeClock {
    /// Returns the durations of all sleeps.
    pub(crate) fn sleeps(&self) -> Vec<Duration> {
        self.0.lock().unwrap().clone()
    }

    /// Returns the date at which the clock starts.
    pub(crate) fn begin() -> SystemTime {
        SystemTime::UNIX_EPOCH + Duration::from_secs(1_796_000_000)
    }
}

impl Clock for FakeClock {
    fn elapsed(&self) -> Duration {
        self.0.lock().unwrap().iter().sum()
    }

    fn date(&self) -> SystemTime {
        FakeClock::begin() + self.elapsed()
    }

    fn sleep(&self, time: Duration) {
        self.0.lock().unwrap().push(time);
    }
}

impl FakeClock {
    /// Returns the time since the start, in milliseconds.
    pub(crate) fn elapsed_ms(&self) -> u64 {
        self.elapsed().as_millis() as u64
    }
}
