//! A server's connections, the time of their last activity, and whether the server may close them.

use std::collections::BTreeMap;
use std::io::{self, ErrorKind, IoSlice};
use std::ops::Deref;
use std::pin::Pin;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::task::{Context, Poll};
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::TcpStream;
use tokio::sync::Notify;
use tokio::time::{Sleep, sleep};

/// A server's open connections.
#[derive(Debug, Default)]
pub(super) struct Seats {
    /// A logical clock that advances whenever a connection is active.
    heard: AtomicU64,
    pub(super) open: Mutex<BTreeMap<u64, Asker>>,
}

impl Seats {
    /// Adds a connection.
    pub(super) fn take(self: &Arc<Seats>) -> Asker {
        let number = self.heard.fetch_add(1, Ordering::Relaxed);
        let seat = Seat {
            number,
            seats: self.clone(),
            heard: AtomicU64::new(number),
            kept: AtomicUsize::new(0),
            is_trusted: AtomicBool::new(false),
            leave: Notify::new(),
        };
        let asker = Asker(Arc::new(seat));
        self.open.lock().unwrap_or_else(PoisonError::into_inner).insert(number, asker.clone());
        asker
    }

    /// Closes the connection that has been idle longest, among the connections that may be closed. Does
    /// nothing if there is no such connection.
    pub(super) fn free_one(&self) {
        let open = self.open.lock().unwrap_or_else(PoisonError::into_inner);
        let leaving = open.values().filter(|asker| !asker.may_stay());
        if let Some(asker) = leaving.min_by_key(|asker| asker.heard.load(Ordering::Relaxed)) {
            asker.leave.notify_one();
        }
    }
}

/// A connection to the server.
#[derive(Debug)]
pub struct Seat {
    pub(super) number: u64,
    pub(super) seats: Arc<Seats>,
    heard: AtomicU64,
    kept: AtomicUsize,
    is_trusted: AtomicBool,
    pub(super) leave: Notify,
}

/// A request's connection. The server attaches this value to every request as an extension.
#[derive(Clone, Debug)]
pub struct Asker(Arc<Seat>);

impl Deref for Asker {
    type Target = Seat;

    fn deref(&self) -> &Seat {
        &self.0
    }
}

impl Asker {
    /// Exempts the connection permanently from being closed, regardless of how many new connections arrive.
    pub fn trust(&self) {
        self.is_trusted.store(true, Ordering::Relaxed);
    }

    /// Keeps the connection open until the returned value is dropped.
    pub fn keep(&self) -> Kept {
        self.kept.fetch_add(1, Ordering::Relaxed);
        Kept(self.clone())
    }

    fn may_stay(&self) -> bool {
        self.is_trusted.load(Ordering::Relaxed) || self.kept.load(Ordering::Relaxed) > 0
    }

    fn heard(&self) {
        let now = self.seats.heard.fetch_add(1, Ordering::Relaxed);
        self.0.heard.store(now, Ordering::Relaxed);
    }
}

/// A guard that keeps a connection open until the guard is dropped.
#[derive(Debug)]
pub struct Kept(Asker);

impl Drop for Kept {
    fn drop(&mut self) {
        self.0.kept.fetch_sub(1, Ordering::Relaxed);
    }
}

/// A stream that records its activity, and fails if the other end stops reading for too long.
pub(super) struct Watched {
    stream: TcpStream,
    asker: Asker,
    write_time: Duration,
    /// The deadline by which the other end must read, if a write is waiting.
    stalled: Option<Pin<Box<Sleep>>>,
}

impl Watched {
    pub(super) fn new(stream: TcpStream, asker: Asker, write_time: Duration) -> Watched {
        Watched { stream, asker, write_time, stalled: None }
    }

    /// Ends the wait if data was written. If no data was written, starts or continues the wait.
    fn written<T>(&mut self, context: &mut Context<'_>, polled: Poll<io::Result<T>>) -> Poll<io::Result<T>> {
        if polled.is_ready() {
            self.stalled = None;
            self.asker.heard();
            return polled;
        }
        let time = self.write_time;
        let stalled = self.stalled.get_or_insert_with(|| Box::pin(sleep(time)));
        match stalled.as_mut().poll(context) {
            Poll::Ready(()) => Poll::Ready(Err(ErrorKind::TimedOut.into())),
            Poll::Pending => Poll::Pending,
        }
    }
}

impl AsyncRead for Watched {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        let before = buffer.filled().len();
        let polled = Pin::new(&mut self.stream).poll_read(context, buffer);
        if buffer.filled().len() > before {
            self.asker.heard();
        }
        polled
    }
}

impl AsyncWrite for Watched {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        let polled = Pin::new(&mut self.stream).poll_write(context, bytes);
        self.written(context, polled)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        parts: &[IoSlice<'_>],
    ) -> Poll<io::Result<usize>> {
        let polled = Pin::new(&mut self.stream).poll_write_vectored(context, parts);
        self.written(context, polled)
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.is_write_vectored()
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(context)
    }
}
