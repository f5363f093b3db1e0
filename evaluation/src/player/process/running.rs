//! The processes of all players that run now, so that a program that is told to end can end them first.

use rustix::process::{Pid, Signal, kill_process, kill_process_group};
use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard};
use std::thread;
use std::time::Duration;

/// The players of this program.
static RUNNING: Mutex<Running> = Mutex::new(Running { is_over: false, players: BTreeMap::new() });

/// Looks, until all players are gone, and the pause between them: three seconds at most.
const LOOKS: u32 = 600;
const PAUSE: Duration = Duration::from_millis(5);

/// Players by their process numbers, and whether they have a guard.
pub(super) struct Running {
    is_over: bool,
    players: BTreeMap<u32, bool>,
}

impl Running {
    /// Returns whether no further player may start.
    pub(super) fn is_over(&self) -> bool {
        self.is_over
    }

    /// Notes a player that was started while this was held.
    pub(super) fn insert(&mut self, id: u32, is_guarded: bool) {
        self.players.insert(id, is_guarded);
    }

    /// Forgets a player. Its number may belong to another process afterwards.
    pub(super) fn remove(&mut self, id: u32) {
        self.players.remove(&id);
    }
}

/// The players that run now. Whoever starts or buries one holds this meanwhile.
pub(super) fn running() -> MutexGuard<'static, Running> {
    RUNNING.lock().expect("nothing panics while it holds this lock")
}

/// Ends all players of this program, and lets no further one start: for a program that is about to end. Episodes that are under way
/// are left as an interruption leaves them. Returns when the players are gone, after three seconds at the latest.
pub fn end_all() {
    let mut all = running();
    all.is_over = true;
    for (&id, &is_guarded) in &all.players {
        let Some(id) = Pid::from_raw(id.cast_signed()) else { continue };
        // A guard ends what it guards, which takes a moment.
        let _ = match is_guarded {
            true => kill_process(id, Signal::TERM),
            false => kill_process_group(id, Signal::KILL),
        };
    }
    drop(all);
    for _ in 0..LOOKS {
        if running().players.is_empty() {
            return;
        }
        thread::sleep(PAUSE);
    }
}
