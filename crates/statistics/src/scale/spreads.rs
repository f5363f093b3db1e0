//! The model's standard deviations, and the slopes between the difficulties for planners and for readers (players that
//! see only prompts).

/// The model's standard deviations in logits, and two slopes.
///
/// A game's difficulty for planners is normally distributed with mean 0 and standard deviation `game`. The difficulty
/// for readers (players that see only prompts) is the difficulty for planners multiplied by the slope, plus an
/// independent remainder. The same model applies to levels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spreads {
    /// For planners, the standard deviation of game difficulty.
    pub game: f64,
    /// For planners, the standard deviation of level difficulty within a game.
    pub level: f64,
    /// The standard deviation of the match effect between a family of planners and a game, which states how well the
    /// game suits the family.
    pub family: f64,
    /// The standard deviation of the match effect between a planner and a game (how well the game suits the planner),
    /// beyond the effect of the planner's family.
    pub planner: f64,
    /// The increase in a game's difficulty for readers (players that see only prompts) per logit of its difficulty for
    /// planners.
    pub game_slope: f64,
    /// The increase in a level's difficulty for readers (players that see only prompts), relative to its game, per
    /// logit of its difficulty for planners.
    pub level_slope: f64,
    /// The standard deviation of the component of a game's difficulty for readers (players that see only prompts) that
    /// is independent of its difficulty for planners.
    pub game_rest: f64,
    /// The standard deviation of the part of a level's difficulty for readers that is independent of its difficulty
    /// for planners. Readers are players that see only prompts.
    pub level_rest: f64,
    /// The standard deviation of the match effect between a reader (a player that sees only prompts) and a game.
    pub reader: f64,
}

impl Default for Spreads {
    fn default() -> Spreads {
        Spreads {
            game: 1.3,
            level: 1.0,
            family: 1.0,
            planner: 0.5,
            game_slope: 0.7,
            level_slope: 0.7,
            game_rest: 0.9,
            level_rest: 0.7,
            reader: 0.9,
        }
    }
}

/// The number of parameters in a model without readers (players that see only prompts).
pub(super) const PLANNERS_ONLY: usize = 4;
/// The number of parameters in a model with readers (players that see only prompts).
pub(super) const WITH_READERS: usize = 9;
/// The mean and the standard deviation of the prior for the logarithm of a standard deviation. The range of two
/// standard deviations on either side of the mean is 0.14 to 7 logits.
const LOG_PRIOR: (f64, f64) = (0.0, 1.0);
/// The mean and the standard deviation of the prior for a slope.
const SLOPE_PRIOR: (f64, f64) = (0.0, 1.0);

impl Spreads {
    /// Returns the parameters for maximisation: the logarithms of standard deviations, and the slopes.
    pub(super) fn parameters(&self, has_readers: bool) -> Vec<f64> {
        let mut all: Vec<f64> = [self.game, self.level, self.family, self.planner].map(libm::log).to_vec();
        if has_readers {
            all.extend([self.game_slope, self.level_slope]);
            all.extend([self.game_rest, self.level_rest, self.reader].map(libm::log));
        }
        all
    }

    /// Returns the spreads for the given parameters. If there are no parameters for readers (players that see only
    /// prompts), the spreads of readers are the defaults.
    pub(super) fn from_parameters(parameters: &[f64]) -> Spreads {
        let sd = |at: usize| libm::exp(parameters[at]);
        let planners =
            Spreads { game: sd(0), level: sd(1), family: sd(2), planner: sd(3), ..Spreads::default() };
        if parameters.len() == PLANNERS_ONLY {
            return planners;
        }
        Spreads {
            game_slope: parameters[4],
            level_slope: parameters[5],
            game_rest: sd(6),
            level_rest: sd(7),
            reader: sd(8),
            ..planners
        }
    }

    /// Returns the log prior density, up to a constant, and its derivatives.
    pub(super) fn log_prior(parameters: &[f64]) -> (f64, Vec<f64>) {
        let each = parameters.iter().enumerate().map(|(at, value)| {
            let (mean, sd) = if at == 4 || at == 5 { SLOPE_PRIOR } else { LOG_PRIOR };
            let z = (value - mean) / sd;
            (-0.5 * z * z, -z / sd)
        });
        let (logs, slopes): (Vec<f64>, Vec<f64>) = each.unzip();
        (logs.iter().sum(), slopes)
    }

    /// Returns the variances of a level's difficulty for planners and for readers (players that see only prompts), and
    /// their covariance.
    fn moments(&self) -> (f64, f64, f64) {
        let (game, level) = (self.game * self.game, self.level * self.level);
        let planners = game + level;
        let readers = self.game_slope * self.game_slope * game
            + self.level_slope * self.level_slope * level
            + self.game_rest * self.game_rest
            + self.level_rest * self.level_rest;
        (planners, readers, self.game_slope * game + self.level_slope * level)
    }

    /// Returns the correlation between level difficulties for planners and for readers (players that see only prompts).
    pub fn correlation(&self) -> f64 {
        let (planners, readers, both) = self.moments();
        both / (planners * readers).sqrt()
    }

    /// Returns the standard deviation of a level's difficulty in a dimension.
    pub fn total(&self, dimension: super::Dimension) -> f64 {
        let (planners, readers, _) = self.moments();
        match dimension {
            super::Dimension::Planner => planners.sqrt(),
            super::Dimension::Reader => readers.sqrt(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scale::Dimension;

    #[test]
    fn parameters_stand_for_spreads() {
        let given = Spreads { game: 2.0, level_slope: -0.25, reader: 1.5, ..Spreads::default() };
        let found = Spreads::from_parameters(&given.parameters(true));
        assert!((found.game - 2.0).abs() < 1e-12 && (found.reader - 1.5).abs() < 1e-12);
        assert_eq!(found.level_slope, -0.25);
        let planners = Spreads::from_parameters(&given.parameters(false));
        assert!((planners.game - 2.0).abs() < 1e-12 && planners.reader == Spreads::default().reader);
    }

    /// If the slopes are 1 and there is no independent component, levels are as hard for readers (players that see only
    /// prompts) as for planners.
    #[test]
    fn correlations() {
        let same = Spreads {
            game_slope: 1.0,
            level_slope: 1.0,
            game_rest: 0.0,
            level_rest: 0.0,
            ..Spreads::default()
        };
        assert!((same.correlation() - 1.0).abs() < 1e-12);
        assert!((same.total(Dimension::Planner) - same.total(Dimension::Reader)).abs() < 1e-12);
        let none = Spreads { game_slope: 0.0, level_slope: 0.0, ..same };
        assert!(Spreads { game_rest: 1.0, ..none }.correlation() == 0.0);
    }
}
