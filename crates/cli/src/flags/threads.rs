//! The number of threads, and the memory limit for their searches. Neither limit affects any output.

use crate::console;
use crate::failure::Failure;
use crate::flags::memory::Bytes;
use agents::search::bound_memory;
use rayon::{ThreadPoolBuildError, ThreadPoolBuilder};
use std::ffi::OsString;
use std::sync::OnceLock;
use std::thread::available_parallelism;

/// The maximum number of threads in a pool. Additional threads would only wait for each other, and starting
/// thousands of them would take minutes.
const MAX_THREADS: usize = 256;

/// The limits that the user sets for a run. No output depends on them.
#[derive(Clone, Copy, Debug, Default, clap::Args)]
pub(crate) struct Limits {
    /// Number of threads [default: all cores]. The output is the same for any number
    #[arg(long, value_name = "N", global = true)]
    jobs: Option<usize>,
    /// Maximum memory for all searches together, such as 4GiB; searches wait for each other if they need more.
    /// The output is the same for any size
    #[arg(long, value_name = "SIZE", global = true)]
    memory: Option<Bytes>,
}

/// The process-wide limits.
static LIMITS: OnceLock<Limits> = OnceLock::new();

impl Limits {
    /// Starts the threads, and limits the memory for their searches. Without this call, rayon would start as
    /// many threads as `RAYON_NUM_THREADS` specifies, and memory would be unlimited.
    pub(crate) fn apply(self) -> Result<(), Failure> {
        let threads = match self.jobs {
            Some(0) => bail!("--jobs takes a number of threads, which must be at least 1"),
            Some(jobs) if jobs > MAX_THREADS => {
                console::warn(format_args!("--jobs {jobs} exceeds the limit: using {MAX_THREADS} threads"));
                MAX_THREADS
            }
            jobs => jobs.unwrap_or_else(usual),
        };
        if let Some(Bytes(bytes)) = self.memory {
            bound_memory(bytes, threads)
                .map_err(|few| malformed!("--memory: {few}; raise it, or use fewer threads (--jobs)"))?;
        }
        LIMITS.get_or_init(|| self);
        ThreadPoolBuilder::new().num_threads(threads).build_global().map_err(failure)
    }

    /// Returns the flags that set these limits, for a command that resumes the run.
    fn flags(self) -> Vec<OsString> {
        let jobs = self.jobs.map(|jobs| ["--jobs".to_owned(), jobs.to_string()]);
        let memory = self.memory.map(|memory| ["--memory".to_owned(), memory.to_string()]);
        jobs.into_iter().chain(memory).flatten().map(OsString::from).collect()
    }
}

/// Returns the number of threads requested by the user; `None` without `--jobs`.
pub(crate) fn jobs() -> Option<usize> {
    LIMITS.get().and_then(|limits| limits.jobs)
}

/// Returns the flags that set the process-wide limits, for a command that resumes the run.
pub(crate) fn flags() -> Vec<OsString> {
    LIMITS.get().copied().unwrap_or_default().flags()
}

/// Runs the work on a pool with the given number of threads.
pub(crate) fn on<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> Result<T, Failure> {
    let pool = ThreadPoolBuilder::new().num_threads(threads.clamp(1, MAX_THREADS)).build();
    Ok(pool.map_err(failure)?.install(work))
}

/// Returns the default number of threads.
fn usual() -> usize {
    #[expect(
        clippy::disallowed_methods,
        reason = "only the number of threads depends on the variable, and no output depends on that number"
    )]
    let wanted = std::env::var("RAYON_NUM_THREADS").ok();
    let cores = available_parallelism().map_or(1, usize::from);
    bounded(wanted.as_deref(), cores)
}

/// Returns the requested number of threads if it is within bounds, or one thread per core.
fn bounded(wanted: Option<&str>, cores: usize) -> usize {
    let wanted =
        wanted.and_then(|text| text.parse().ok()).filter(|wanted| (1..=MAX_THREADS).contains(wanted));
    wanted.unwrap_or(cores).clamp(1, MAX_THREADS)
}

fn failure(error: ThreadPoolBuildError) -> Failure {
    Failure::environment(error, "threads cannot be started")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_sensible_numbers_of_threads_are_honoured() {
        for (wanted, cores, expect) in [
            (None, 2, 2),
            (Some("5"), 2, 5),
            (Some("0"), 2, 2),
            (Some("many"), 2, 2),
            (Some("999999999999"), 2, 2),
            (Some("257"), 4, 4),
            (None, 5000, MAX_THREADS),
        ] {
            assert_eq!(bounded(wanted, cores), expect, "{wanted:?} on {cores} cores");
        }
    }

    #[test]
    fn thread_counts_are_bounded() {
        assert_eq!(on(5000, rayon::current_num_threads).expect("started"), MAX_THREADS);
    }

    #[test]
    fn a_command_that_resumes_has_the_same_limits() {
        let limits = Limits { jobs: Some(2), memory: Some(Bytes(2 << 30)) };
        assert_eq!(limits.flags(), ["--jobs", "2", "--memory", "2GiB"]);
        assert!(Limits::default().flags().is_empty());
    }
}
