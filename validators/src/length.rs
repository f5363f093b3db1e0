//! Is it neither over at once nor endless?

use crate::verdict::{Case, Finding, Validator, Verdict};

/// The witness takes a number of ticks within bounds.
#[derive(Clone, Copy, Debug)]
pub struct LengthWithin {
    /// Ticks at least.
    pub least: usize,
    /// Ticks at most.
    pub most: usize,
}

impl Validator for LengthWithin {
    fn name(&self) -> &'static str {
        "length"
    }

    fn validate(&self, case: Case<'_>) -> Finding {
        let Some(witness) = case.witness else { return Verdict::Unknown { spent: 0 }.into() };
        let ticks = witness.actions.len();
        let verdict = if ticks < self.least {
            Verdict::fail(format!("won in {ticks} ticks, fewer than {}", self.least))
        } else if ticks > self.most {
            Verdict::fail(format!("the shortest win found takes {ticks} ticks, more than {}", self.most))
        } else {
            Verdict::pass()
        };
        verdict.into()
    }
}
