//! The judges for all criteria other than gates.
//!
//! The module of a criterion contains its judge, the constant `QUESTION`, and a function `judge` that creates the judge
//! for a [`Setting`].

mod ablation;
mod early_death;
mod length;
mod not_idle;
mod not_random;
mod readable;
mod rule_use;
mod skill;
mod skill_overall;
mod well_formed;
mod winnable;

pub(crate) use ablation::is_guard;
pub use early_death::NoEarlyDeath;
pub(crate) use length::without_proof;
pub use not_idle::NotIdle;
pub use not_random::NotRandom;
pub use rule_use::RulesShown;
pub(crate) use rule_use::with_count;
pub use skill_overall::SkillOverall;
pub use well_formed::WellFormed;
pub(crate) use well_formed::is_over_at_once;

use crate::allowance::Setting;
use crate::criterion::{About, Criterion, Stage, every_criterion};
use crate::gates::{
    actors_matter, drama, necessity, no_dead_time, not_instant, open_ground, progression, tight,
};
use crate::validator::{GameJudge, LevelJudge};

/// Defines the questions and judges for [`Criterion`] from the table of criteria.
macro_rules! define {
    (
        levels { $($level:ident = $level_name:literal, $stage:ident, $level_cost:ident, $level_module:ident;)* }
        games { $($game:ident = $game_name:literal, $about:ident, $game_cost:ident, $game_module:ident;)* }
        gates { $($gate:ident = $gate_name:literal, $gate_cost:ident, $gate_module:ident;)* }
    ) => {
        impl Criterion {
            /// Returns the criterion's question, as one sentence.
            pub fn question(self) -> &'static str {
                match self {
                    $(Criterion::$level => $level_module::QUESTION,)*
                    $(Criterion::$game => $game_module::QUESTION,)*
                    $(Criterion::$gate => $gate_module::QUESTION,)*
                }
            }

            /// Returns the judge for a level criterion; `None` for any other criterion.
            pub(crate) fn level_judge(self, setting: &Setting<'_>) -> Option<LevelJudge> {
                let judge = |stage, validator| LevelJudge { criterion: self, stage, validator };
                match self {
                    $(Criterion::$level => Some(judge(Stage::$stage, Box::new($level_module::judge(setting)))),)*
                    _ => None,
                }
            }

            /// Returns the judge for a game criterion; `None` for any other criterion.
            pub(crate) fn game_judge(self, setting: &Setting<'_>) -> Option<GameJudge> {
                let judge = |about, validator| GameJudge { criterion: self, about, validator };
                match self {
                    $(Criterion::$game => Some(judge(About::$about, Box::new($game_module::judge(setting)))),)*
                    $(Criterion::$gate => Some(judge(About::Play, Box::new($gate_module::judge(setting)))),)*
                    _ => None,
                }
            }
        }
    };
}

every_criterion!(define);
