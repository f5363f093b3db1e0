//! Bounds on the resources that clients can use on a server: connections, time, memory.

use std::time::Duration;

base::with_defaults! {
    /// The limits of a server. Beyond these limits, the server waits or rejects requests, and uses no more memory.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Bounds {
        /// The maximum number of open connections. If more clients connect, the connection that has been
        /// silent for longest is closed, unless it waits for an answer.
        pub connections: usize = 64,
        /// The maximum size of a request in bytes.
        // The default suffices for a long conversation with an image.
        pub body: usize = 32 << 20,
        /// The maximum size of all current requests together, in bytes.
        pub bodies: usize = 128 << 20,
        /// The time limit for a client to send the head of a request, including the next request on the same
        /// connection.
        pub head_time: Duration = Duration::from_secs(20),
        /// The time limit for a client to send the body of a request, including the wait for memory.
        pub body_time: Duration = Duration::from_secs(60),
        /// The time limit for a client to read any part of an answer.
        pub write_time: Duration = Duration::from_secs(20),
        /// The maximum number of threads that work on answers at the same time.
        pub threads: usize = 512,
    }
}
