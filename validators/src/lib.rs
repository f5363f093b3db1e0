//! Validators that judge games and levels. Each release criterion is a separate validator.
//!
//! There are three verdicts. *Pass* can include a witness: an episode that replays to a win. *Fail* includes a reason
//! and possibly a counter-example. *Unknown* includes the number of calls spent. A level never counts as unsolvable
//! merely because the budget ran out.
#![cfg_attr(not(doctest), doc = "", doc = include_str!("../README.md"))]

mod allowance;
mod case;
mod criteria;
mod criterion;
mod evidence;
mod explain;
mod gates;
mod judging;
pub mod measures;
pub mod novelty;
mod panel;
mod recording;
mod report;
mod thresholds;
mod validator;
mod verdict;

pub use allowance::Effort;
pub use case::Case;
pub use criteria::{NoEarlyDeath, NotIdle, NotRandom, RulesShown, SkillOverall, WellFormed};
pub use criterion::{Cost, Criterion, CriterionSet, UnknownCriterion};
pub use evidence::{Evidence, Line};
pub use explain::board::Board;
pub use gates::{Gates, NotInstant, OpenGround, ended_share};
pub use judging::{GameSubject, Judging, LevelSubject, Observer, TogetherSubject};
pub use measures::{
    Commitment, DeadEnds, Deception, Demand, Difficulty, FORESIGHT, GameKind, Ladder, LadderConfig, Measures,
    PlayMeasures, PlayerResult, Rate, RuleRef, RuleRefError, SkillGap, TIERS, Tier, TierBounds,
    UnknownDifficulty, is_guard, mcts_rate, shorter_win, used_rules,
};
pub use novelty::GameForm;
pub use panel::{Panel, Subject};
pub use recording::{Recorded, executions};
pub use report::{GameReport, Judgement, Report};
pub use thresholds::{CheckedCriteria, Criteria, CriteriaError};
pub use validator::Validator;
pub use verdict::{Finding, Reason, Verdict};
