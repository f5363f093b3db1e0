//! Recounts all incrementally maintained parts of a state, for tests and fuzzing.

use crate::game::{Compiled, Game};
use crate::state::State;

impl State {
    /// Compares all incrementally maintained values with values counted from scratch. Returns the number of
    /// sprites of each type. Cost: O(sprites + cells).
    ///
    /// # Errors
    /// Returns a message that describes the first difference.
    #[doc(hidden)]
    pub fn recount(&self, game: &Game) -> Result<Vec<usize>, String> {
        let Compiled { rules, models, plan } = &*game.0;
        let counts = self.world.recount(rules, models)?;
        self.schedule.recount(plan, models, &self.world)?;
        Ok(counts)
    }
}
