//! Threads: as many as are asked for, within reason.

use crate::console;
use crate::failure::Failure;
use std::thread::available_parallelism;

/// Threads that any request gets. More than there is work for cost time to start; those that wait for models are few hundred.
const MOST: usize = 256;

/// Runs on this many threads; on all cores if not given. More than [`MOST`], or four for each core, are not started.
///
/// # Errors
/// None are asked for, or the system refuses.
pub(crate) fn in_pool<T: Send>(jobs: Option<usize>, work: impl FnOnce() -> T + Send) -> Result<T, Failure> {
    if jobs == Some(0) {
        return Err(Failure::malformed("--jobs takes a number of threads, at least 1"));
    }
    let number = match jobs {
        Some(jobs) if jobs > most() => {
            console::warn(format_args!(
                "--jobs {jobs} is more than any work here can use: {} threads",
                most()
            ));
            most()
        }
        Some(jobs) => jobs,
        None => rayon::current_num_threads(),
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(number).build();
    let pool = pool.map_err(|error| Failure::surroundings(error, "threads cannot be started"))?;
    Ok(pool.install(work))
}

/// Starts the threads of verbs without `--jobs`: as many as there are cores, or as `RAYON_NUM_THREADS` says, within reason.
pub(crate) fn set_up() {
    #[expect(clippy::disallowed_methods, reason = "the number of threads changes no byte")]
    let asked = std::env::var("RAYON_NUM_THREADS").ok().and_then(|text| text.parse().ok());
    let number = asked.filter(|&number| number > 0).unwrap_or_else(cores).min(most());
    // It fails only if it was called before, and then there are threads.
    drop(rayon::ThreadPoolBuilder::new().num_threads(number).build_global());
}

fn cores() -> usize {
    available_parallelism().map_or(1, std::num::NonZero::get)
}

fn most() -> usize {
    MOST.max(4 * cores())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_more_threads_than_any_work_can_use() {
        for (asked, expect) in
            [(Some(1), 1), (Some(3), 3), (Some(usize::MAX), most()), (Some(most() + 1), most())]
        {
            assert_eq!(in_pool(asked, rayon::current_num_threads).unwrap(), expect);
        }
        assert!(in_pool(Some(0), || ()).is_err());
    }
}
