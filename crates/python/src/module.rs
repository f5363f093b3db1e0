//! The names exported by the extension.

use pyo3::prelude::*;

/// The extension module.
#[pymodule]
mod _native {
    use super::*;
    #[pymodule_export]
    use crate::corpus::{corpus, game_of_level, games_of_files, levels_of_files};
    #[pymodule_export]
    use crate::errors::{ArcadeError, LogError, VgdlError};
    #[pymodule_export]
    use crate::evaluate::{Series, metrics_of_log, prompt_digest, read_log, replay_log};
    #[pymodule_export]
    use crate::forging::{generate_games, generate_levels, integrity, validate, verify};
    #[pymodule_export]
    use crate::game::{Game, Level, seed_child, seed_from_text};
    #[pymodule_export]
    use crate::lanes::Lanes;
    #[pymodule_export]
    use crate::minting::{merge, mint, recipe};
    #[pymodule_export]
    use crate::planner::{Planner, planner_names};
    #[pymodule_export]
    use crate::questions::{draw_questions, is_right_answer, question_kinds};
    #[pymodule_export]
    use crate::state::State;
    #[pymodule_export]
    use crate::stream::Stream;

    /// Adds the constants to the module.
    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))?;
        module.add("SEMANTICS", engine::SEMANTICS)?;
        module.add("GENERATION", generators::GENERATION)?;
        module.add("ACTIONS", engine::Action::ALL.map(|action| action.name()).to_vec())
    }
}
