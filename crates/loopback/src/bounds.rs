//! Bounds on the server resources available to clients: connections, time and memory.

use std::time::Duration;

base::with_defaults! {
    /// A server's limits. When a limit is reached, the server waits or rejects requests instead of using more
    /// memory.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Bounds {
        /// The maximum number of open connections. If more clients connect, the server closes the connection
        /// that has been idle longest and is not waiting for a response.
        pub connections: usize = 64,
        /// The maximum size of a request body, in bytes.
        // The default suffices for a long conversation with an image.
        pub body: usize = 32 << 20,
        /// The maximum total size of the bodies of all requests in progress, in bytes.
        pub bodies: usize = 128 << 20,
        /// The time limit for a client to send the head of a request, which also covers the wait for the next
        /// request on the same connection.
        pub head_time: Duration = Duration::from_secs(20),
        /// The time limit for a client to send the body of a request, including the wait for memory.
        pub body_time: Duration = Duration::from_secs(60),
        /// The time limit for a client to read any part of a response.
        pub write_time: Duration = Duration::from_secs(20),
        /// The maximum number of threads that work on responses at the same time.
        pub threads: usize = 512,
    }
}
