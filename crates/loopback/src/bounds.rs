//! Bounds on the resources that clients can take from a server: connections, time, memory.

use std::time::Duration;

base::with_defaults! {
    /// The limits of a server. Beyond them it waits or refuses, and takes no more memory.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Bounds {
        /// The maximum number of open connections. Of more, the one that has been silent for longest is closed, unless it waits for
        /// an answer.
        pub connections: usize = 64,
        /// The maximum number of bytes of a request.
        // Enough for a long conversation with a picture.
        pub body: usize = 32 << 20,
        /// The maximum number of bytes of all requests at a time.
        pub bodies: usize = 128 << 20,
        /// The time limit for a client to send the head of a request, including the next one on the same connection.
        pub head_time: Duration = Duration::from_secs(20),
        /// The time limit for a client to send the body of a request, including the wait for room.
        pub body_time: Duration = Duration::from_secs(60),
        /// The time limit for a client to read some of an answer.
        pub write_time: Duration = Duration::from_secs(20),
        /// The maximum number of threads that work on answers at a time.
        pub threads: usize = 512,
    }
}
