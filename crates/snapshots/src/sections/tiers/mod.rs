//! The section `[tiers]` of a recipe: shares of levels by what they demand.

mod section;

pub(crate) use section::TiersSection;

use crate::recipe::apportion::apportion;
use crate::recipe::error::{RecipeError, wrong};
use serde::{Deserialize, Serialize};
use validators::Tier;

/// Shares of levels by tier.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Tiers {
    /// The share of tier 1.
    #[serde(rename = "1", skip_serializing_if = "is_zero")]
    pub one: f64,
    /// The share of tier 2.
    #[serde(rename = "2", skip_serializing_if = "is_zero")]
    pub two: f64,
    /// The share of tier 3.
    #[serde(rename = "3", skip_serializing_if = "is_zero")]
    pub three: f64,
    /// The share of tier 4.
    #[serde(rename = "4", skip_serializing_if = "is_zero")]
    pub four: f64,
}

fn is_zero(share: &f64) -> bool {
    *share == 0.0
}

impl Tiers {
    /// Returns `true` if no tier is asked for.
    pub fn is_empty(&self) -> bool {
        *self == Tiers::default()
    }

    /// Checks that the shares add up.
    ///
    /// # Errors
    /// They do not.
    pub(crate) fn check(&self) -> Result<(), RecipeError> {
        let total: f64 = self.shares().iter().sum();
        let are_shares = self.shares().iter().all(|share| (0.0..=1.0).contains(share));
        if self.is_empty() || are_shares && (total - 1.0).abs() < 1e-6 {
            return Ok(());
        }
        wrong("tiers", format!("adds up to {total}; it takes shares that add up to 1"))
    }

    /// The number of levels of each tier that these shares of `levels` are, from tier 1 to tier 4.
    pub(crate) fn levels(&self, levels: u32) -> impl Iterator<Item = (Tier, u32)> {
        Tier::ALL.into_iter().zip(apportion(levels, &self.shares()))
    }

    /// The shares, from tier 1 to tier 4.
    pub fn shares(&self) -> [f64; 4] {
        [self.one, self.two, self.three, self.four]
    }
}
