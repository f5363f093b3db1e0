//! A registry of the running processes of all players, so that `arcade` can kill them before it exits.

use rustix::process::{Pid, Signal, kill_process, kill_process_group};
use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard};
use std::thread;
use std::time::Duration;

static RUNNING: Mutex<Running> = Mutex::new(Running { is_over: false, players: BTreeMap::new() });

/// The maximum number of times to check whether all players have exited. Including the pauses between checks,
/// this takes at most three seconds.
const POLLS: u32 = 600;
/// The pause between checks for running players.
const PAUSE: Duration = Duration::from_millis(5);

/// The registry of running players.
pub(super) struct Running {
    /// `true` once no more players may start.
    pub(super) is_over: bool,
    /// The running players by process ID, each with `true` if it has a guard (a supervising process). A player is
    /// inserted while it starts. It is removed before it is reaped, because afterwards a different process may reuse
    /// its ID.
    pub(super) players: BTreeMap<u32, bool>,
}

/// Locks the registry of running players. The lock is held while a player is started or reaped.
pub(super) fn running() -> MutexGuard<'static, Running> {
    RUNNING.lock().expect("nothing panics while it holds this lock")
}

/// Kills the processes of all players and prevents new ones from starting, so that `arcade` can exit.
///
/// Episodes in progress are left in the same state as after an interruption. The function returns when all
/// players have exited, or after at most three seconds.
pub fn end_all() {
    let mut all = running();
    all.is_over = true;
    for (&id, &is_guarded) in &all.players {
        let Some(id) = Pid::from_raw(id.cast_signed()) else { continue };
        // A guard (supervising process) needs a moment to end its program.
        let _ = match is_guarded {
            true => kill_process(id, Signal::TERM),
            false => kill_process_group(id, Signal::KILL),
        };
    }
    drop(all);
    for _ in 0..POLLS {
        if running().players.is_empty() {
            return;
        }
        thread::sleep(PAUSE);
    }
}
