//! Bounds on the resources that clients can take from a server: connections, time, memory.

use std::time::Duration;

/// The limits of a server. Beyond them it waits or refuses, and takes no more memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bounds {
    /// The maximum number of open connections. Others wait until one is closed.
    pub connections: usize,
    /// The maximum number of bytes of a request.
    pub body: usize,
    /// The maximum number of bytes of all requests at a time.
    pub bodies: usize,
    /// The time limit for a client to send the head of a request, including the next one on the same connection.
    pub head_time: Duration,
    /// The time limit for a client to send the body of a request, including the wait for room.
    pub body_time: Duration,
}

impl Default for Bounds {
    fn default() -> Bounds {
        Bounds {
            connections: 64,
            // Enough for a long conversation with a picture.
            body: 32 << 20,
            bodies: 128 << 20,
            head_time: Duration::from_secs(20),
            body_time: Duration::from_secs(60),
        }
    }
}
