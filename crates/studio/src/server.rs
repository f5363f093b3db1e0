//! The server, with its port on this machine, its page and its API.

use crate::answers::Serving;
use crate::guard::{self, Guard};
use crate::refusal::Refusal;
use crate::studio::Studio;
use crate::{answers, api};
use axum::Router;
use axum::http::{HeaderValue, StatusCode, Uri, header};
use axum::response::{IntoResponse, Response};
use include_dir::{Dir, include_dir};
use loopback::Bounds;
use std::io;
use std::net::TcpListener;
use std::time::Duration;
use tokio::sync::oneshot;

/// The page's files: `index.html`, its script and its style.
pub(crate) static PAGE: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/bundle");

/// The server's limits. A request body contains a game and its levels.
const BOUNDS: Bounds = Bounds {
    connections: 64,
    body: 4 << 20,
    bodies: 32 << 20,
    head_time: Duration::from_secs(20),
    body_time: Duration::from_secs(60),
    write_time: Duration::from_secs(20),
    threads: answers::THREADS,
};

/// A server that is bound to its port but does not serve requests yet.
#[derive(Debug)]
pub struct Server {
    studio: Studio,
    listener: TcpListener,
    port: u16,
    guard: Guard,
}

/// A handle that stops a server when it is used or dropped.
#[derive(Debug)]
pub struct Stop(#[allow(dead_code, reason = "dropping it is the signal")] oneshot::Sender<()>);

impl Server {
    /// Binds the given port on 127.0.0.1, or any free port if `port` is 0, and draws a token.
    ///
    /// # Errors
    ///
    /// Returns an error if the port cannot be bound, or if the system has no random bytes.
    pub fn bind(studio: Studio, port: u16) -> io::Result<Server> {
        let listener = loopback::bind(port)?;
        let port = listener.local_addr()?.port();
        Ok(Server { studio, listener, port, guard: Guard::of(port)? })
    }

    /// Returns the server's port.
    pub fn port(&self) -> u16 {
        self.port
    }

    /// Returns the token that every request must contain.
    pub fn token(&self) -> &str {
        self.guard.token()
    }

    /// Returns the page's address, including the token.
    pub fn url(&self) -> String {
        format!("http://127.0.0.1:{}/?token={}", self.port, self.token())
    }

    /// Returns a handle that stops the server when dropped, and the function that serves requests until then.
    pub fn stoppable(self) -> (Stop, impl FnOnce() -> io::Result<()> + Send) {
        let (stop, stopped) = oneshot::channel();
        let run = move || {
            self.run_until(async {
                let _: Result<(), _> = stopped.await;
            })
        };
        (Stop(stop), run)
    }

    /// Serves requests until the program ends.
    ///
    /// # Errors
    ///
    /// Returns an error if the server cannot be started.
    pub fn run(self) -> io::Result<()> {
        self.run_until(std::future::pending())
    }

    fn run_until(self, stopped: impl Future<Output = ()> + Send) -> io::Result<()> {
        let router = Router::new()
            .merge(api::routes())
            .fallback(page)
            .method_not_allowed_fallback(guard::no_method)
            .layer(axum::middleware::from_fn_with_state(self.guard, guard::check))
            .with_state(Serving::new(self.studio, BOUNDS));
        loopback::answer(self.listener, router, BOUNDS, stopped)
    }
}

/// Returns one of the page's files.
async fn page(uri: Uri) -> Response {
    let path = uri.path();
    if path == "/api" || path.starts_with("/api/") {
        return Refusal::missing("there is no such API endpoint").into_response();
    }
    let name = match path.trim_start_matches('/') {
        "" => "index.html",
        name => name,
    };
    let Some(file) = PAGE.get_file(name) else {
        return (StatusCode::NOT_FOUND, "there is no such file").into_response();
    };
    let kind = match name.rsplit('.').next() {
        Some("html") => "text/html; charset=utf-8",
        Some("js") => "text/javascript; charset=utf-8",
        Some("css") => "text/css; charset=utf-8",
        Some("svg") => "image/svg+xml",
        Some("woff2") => "font/woff2",
        _ => "application/octet-stream",
    };
    let mut response = file.contents().into_response();
    response.headers_mut().insert(header::CONTENT_TYPE, HeaderValue::from_static(kind));
    response
}
