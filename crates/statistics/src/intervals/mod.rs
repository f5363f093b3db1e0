//! Interval estimates for proportions, means and doses.

pub(crate) mod bootstrap;
pub(crate) mod clustered;
pub(crate) mod difference;
pub(crate) mod half_point;
pub(crate) mod over_games;
pub(crate) mod ratio;
pub(crate) mod wilson;
