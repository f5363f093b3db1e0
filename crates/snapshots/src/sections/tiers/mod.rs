//! The `[tiers]` section of a recipe: the fraction of levels in each tier, which is a difficulty class from 1 to 4.

mod section;

pub(crate) use section::TiersSection;

use crate::recipe::apportion::apportion;
use crate::recipe::error::{RecipeError, wrong};
use serde::{Deserialize, Serialize};
use validators::Tier;

/// The fraction of levels in each tier (difficulty class).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Tiers {
    /// The fraction of levels in tier 1.
    #[serde(rename = "1", skip_serializing_if = "is_zero")]
    pub one: f64,
    /// The fraction of levels in tier 2.
    #[serde(rename = "2", skip_serializing_if = "is_zero")]
    pub two: f64,
    /// The fraction of levels in tier 3.
    #[serde(rename = "3", skip_serializing_if = "is_zero")]
    pub three: f64,
    /// The fraction of levels in tier 4.
    #[serde(rename = "4", skip_serializing_if = "is_zero")]
    pub four: f64,
}

fn is_zero(share: &f64) -> bool {
    *share == 0.0
}

impl Tiers {
    /// Returns `true` if no tiers (difficulty classes) are requested.
    pub fn is_empty(&self) -> bool {
        *self == Tiers::default()
    }

    /// Checks that the fractions are valid and add up to 1.
    ///
    /// # Errors
    /// Returns an error if the fractions are invalid or do not add up to 1.
    pub(crate) fn check(&self) -> Result<(), RecipeError> {
        let total: f64 = self.shares().iter().sum();
        let are_shares = self.shares().iter().all(|share| (0.0..=1.0).contains(share));
        if self.is_empty() || are_shares && (total - 1.0).abs() < 1e-6 {
            return Ok(());
        }
        wrong("tiers", format!("adds up to {total}; the fractions must add up to 1"))
    }

    /// Divides `levels` levels among the tiers in proportion to the fractions, in order from tier 1 to tier
    /// 4.
    pub(crate) fn levels(&self, levels: u32) -> impl Iterator<Item = (Tier, u32)> {
        Tier::ALL.into_iter().zip(apportion(levels, &self.shares()))
    }

    /// Returns the fractions, from tier 1 to tier 4.
    pub fn shares(&self) -> [f64; 4] {
        [self.one, self.two, self.three, self.four]
    }
}
