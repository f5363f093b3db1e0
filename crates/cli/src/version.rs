//! The text printed by `arcade --version`.

use snapshots::version::CURRENT;
use std::sync::LazyLock;

/// The version, the generation that the build mints, the semantics that it replays, and the commit if the
/// build recorded it: `0.12.0 (GENERATION 12, SEMANTICS 3, commit 0123456789ab)`.
static VERSION: LazyLock<String> = LazyLock::new(|| {
    let commit = option_env!("ARCADE_COMMIT").map_or(String::new(), |commit| format!(", commit {commit}"));
    let (number, generation, semantics) = (env!("CARGO_PKG_VERSION"), CURRENT.generation, CURRENT.semantics);
    format!("{number} (GENERATION {generation}, SEMANTICS {semantics}{commit})")
});

/// Returns the text of [`VERSION`].
pub(crate) fn version() -> &'static str {
    &VERSION
}
