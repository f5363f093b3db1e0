//! Long-running calls that Ctrl-C can interrupt.

use crate::errors::failed;
use forge::Progress;
use forge::games::Kept;
use pyo3::prelude::*;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

/// The time between two checks for a signal.
const PAUSE: Duration = Duration::from_millis(100);
/// The stack size of the working thread, in bytes. It equals the usual stack size of a main thread.
const STACK: usize = 8 << 20;

/// A flag that is set once the result of a call is no longer needed.
#[derive(Clone, Default)]
pub(crate) struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Ends the work by unwinding if its result is no longer needed. The panic hook is not called.
    fn check(&self) {
        if self.0.load(Ordering::Relaxed) {
            resume_unwind(Box::new("the call was interrupted"));
        }
    }
}

impl Progress for Interrupt {
    fn start(&self) {
        self.check();
    }

    fn looked(&self) {
        self.check();
    }

    fn kept(&self, _attempt: &str) -> Option<Kept> {
        self.check();
        None
    }
}

impl snapshots::mint::Progress for Interrupt {
    fn made(&self, _name: &str, _games: &[snapshots::FrozenGame]) {
        self.check();
    }
}

/// Runs `work` on a separate thread, while the calling thread waits without the interpreter lock and checks for
/// signals. After a signal such as Ctrl-C, the call immediately raises the signal's exception. The work ends when it
/// next checks the [`Interrupt`], or with the process.
pub(crate) fn interruptible<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&Interrupt) -> PyResult<T> + Send + 'static,
) -> PyResult<T> {
    let interrupt = Interrupt::default();
    let (sender, receiver) = channel();
    let own = interrupt.clone();
    let run = move || {
        // If the receiver is gone, the call was interrupted.
        let _ = sender.send(work(&own));
    };
    let worker =
        thread::Builder::new().name("call".to_owned()).stack_size(STACK).spawn(run).map_err(failed)?;
    let receiver = Mutex::new(receiver);
    let wait = || receiver.lock().expect("no other thread uses the receiver").recv_timeout(PAUSE);
    loop {
        match py.detach(wait) {
            Ok(result) => return result,
            Err(RecvTimeoutError::Timeout) => py.check_signals().inspect_err(|_| {
                interrupt.0.store(true, Ordering::Relaxed);
            })?,
            Err(RecvTimeoutError::Disconnected) => match worker.join() {
                Err(panic) => resume_unwind(panic),
                Ok(()) => return Err(failed("the call has ended without a result")),
            },
        }
    }
}
