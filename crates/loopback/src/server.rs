//! An HTTP server on a local port, with bounds on connections, time, and the memory for bodies.

use crate::bounds::Bounds;
use crate::seats::{Seats, Watched};
use axum::body::{Body, Bytes, HttpBody};
use axum::{Extension, Router};
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use std::io;
use std::net::{Ipv4Addr, TcpListener};
use std::sync::{Arc, PoisonError};
use std::time::Duration;
use tokio::sync::{OwnedSemaphorePermit, Semaphore};

/// The pause after the system has refused a connection because too many are open.
const PAUSE: Duration = Duration::from_millis(100);

/// The number of bytes of a request body that one permit covers.
const UNIT: usize = 1024;

/// Binds a port on 127.0.0.1, which only this machine can reach. Port 0 picks any free port.
///
/// # Errors
/// Returns an error if the port cannot be bound.
pub fn bind(port: u16) -> io::Result<TcpListener> {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
    listener.set_nonblocking(true)?;
    Ok(listener)
}

/// Serves connections on one thread until `stopped` resolves. Does not wait for work that handlers have
/// moved to blocking threads.
///
/// # Errors
/// Returns an error if the runtime cannot be started.
pub fn answer(
    listener: TcpListener,
    router: Router,
    bounds: Bounds,
    stopped: impl Future<Output = ()> + Send,
) -> io::Result<()> {
    let mut runtime = tokio::runtime::Builder::new_current_thread();
    let runtime = runtime.enable_all().max_blocking_threads(bounds.threads).build()?;
    let answered = runtime.block_on(async {
        let listener = tokio::net::TcpListener::from_std(listener)?;
        tokio::select! {
            () = accept(listener, router, bounds) => {}
            () = stopped => {}
        }
        Ok(())
    });
    runtime.shutdown_background();
    answered
}

/// Serves every connection, within the bounds. If the maximum number of connections is open, a new connection
/// replaces the one that has been idle longest. [Kept](crate::Asker::keep) connections are never replaced. If
/// all connections are kept, new connections wait.
async fn accept(listener: tokio::net::TcpListener, router: Router, bounds: Bounds) {
    let places = Arc::new(Semaphore::new(bounds.connections));
    let seats = Arc::new(Seats::default());
    loop {
        let Ok((stream, _)) = listener.accept().await else {
            tokio::time::sleep(PAUSE).await;
            continue;
        };
        let place = match places.clone().try_acquire_owned() {
            Ok(place) => place,
            Err(_) => {
                seats.free_one();
                places.clone().acquire_owned().await.expect("the semaphore is never closed")
            }
        };
        let asker = seats.take();
        let router = router.clone().layer(Extension(asker.clone()));
        tokio::spawn(async move {
            let mut http = http1::Builder::new();
            http.timer(TokioTimer::new()).header_read_timeout(bounds.head_time);
            let stream = Watched::new(stream, asker.clone(), bounds.write_time);
            let service = TowerToHyperService::new(router);
            // A client that disconnects, or is too slow, is not a server error.
            tokio::select! {
                _ = http.serve_connection(TokioIo::new(stream), service) => {}
                () = asker.leave.notified() => {}
            }
            asker.seats.open.lock().unwrap_or_else(PoisonError::into_inner).remove(&asker.number);
            drop::<OwnedSemaphorePermit>(place);
        });
    }
}

/// The reasons why a request body could not be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Unread {
    /// The body exceeds this number of bytes.
    #[error("the request is larger than the limit of {0} bytes")]
    TooLarge(usize),
    /// The connection was interrupted.
    #[error("the request was cut off: {0}")]
    CutOff(String),
    /// The client was too slow, or no memory for bodies became available in time.
    #[error("the request was not received in time, or too many other requests are in progress; try again")]
    Late,
}

/// The memory pool for the bodies of requests in progress.
#[derive(Clone, Debug)]
pub struct Bodies {
    bounds: Bounds,
    memory: Arc<Semaphore>,
}

impl Bodies {
    /// Creates the memory pool for bodies with these bounds.
    pub fn new(bounds: Bounds) -> Bodies {
        Bodies { bounds, memory: Arc::new(Semaphore::new(bounds.bodies / UNIT)) }
    }

    /// Reads a body within the bounds. First reserves memory for the body's stated size, or for the maximum
    /// size if the size is unknown. The memory stays reserved until the permit is dropped.
    ///
    /// # Errors
    /// Returns an error if the body is too large, arrives too slowly or is cut off.
    pub async fn read(&self, body: Body) -> Result<(Bytes, OwnedSemaphorePermit), Unread> {
        let Bounds { body: most, bodies, body_time, .. } = self.bounds;
        let most = most.min(bodies);
        // The stated length is reliable: the body cannot be longer.
        let stated = HttpBody::size_hint(&body).upper();
        let size = match stated.map(usize::try_from) {
            Some(Ok(size)) if size <= most => size,
            Some(_) => {
                // A client that is still sending cannot read the response, so the rest of the body is read
                // first.
                let _ = tokio::time::timeout(body_time, discard(body, 2 * most)).await;
                return Err(Unread::TooLarge(most));
            }
            None => most,
        };
        let read = async {
            let units = u32::try_from(size.div_ceil(UNIT)).expect("no body is that large");
            let taken =
                self.memory.clone().acquire_many_owned(units).await.expect("the semaphore is never closed");
            (axum::body::to_bytes(body, size).await, taken)
        };
        match tokio::time::timeout(body_time, read).await {
            Ok((Ok(bytes), taken)) => Ok((bytes, taken)),
            Ok((Err(_), _)) if stated.is_none() => Err(Unread::TooLarge(most)),
            Ok((Err(error), _)) => Err(Unread::CutOff(error.to_string())),
            Err(_) => Err(Unread::Late),
        }
    }
}

/// Reads and discards up to `most` bytes of a body.
async fn discard(body: Body, most: usize) {
    let (mut body, mut left) = (std::pin::pin!(body), most);
    while let Some(Ok(frame)) = std::future::poll_fn(|context| body.as_mut().poll_frame(context)).await {
        left = left.saturating_sub(frame.data_ref().map_or(0, Bytes::len));
        if left == 0 {
            return;
        }
    }
}
