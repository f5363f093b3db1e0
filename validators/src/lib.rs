//! Judgements on a game and a level: each criterion of a release is a separate validator.
//!
//! A verdict has three values. *Pass* may carry a witness: an episode that replays. *Fail* gives a reason and may
//! carry a counter-example. *Unknown* gives the calls spent: a level is never called unsolvable because the budget
//! ran out.
#![cfg_attr(not(doctest), doc = "", doc = include_str!("../README.md"))]

mod ablation;
mod allowance;
mod board;
mod causes;
mod comparison;
mod criteria;
mod culprits;
mod demand;
mod early_death;
mod ending;
mod evidence;
pub mod game_measures;
mod game_report;
mod gates;
mod idle;
mod ladder;
mod length;
mod level_report;
mod mcts_rate;
mod measures;
pub mod novelty;
mod panel;
mod random;
mod reachable;
mod readable;
mod recording;
mod rule_ref;
mod rule_use;
mod skill;
mod skill_overall;
mod too_soon;
mod verdict;
mod well_formed;
mod winnable;
mod words;

pub use ablation::RulesMatter;
pub use board::Board;
pub use criteria::{Criteria, CriteriaError, GAME_CRITERIA, LEVEL_CRITERIA};
pub use demand::{Commitment, DeadEnds, Deception, Demand, TIERS, Tier, TierBounds, shorter_win};
pub use early_death::NoEarlyDeath;
pub use evidence::{Evidence, Line};
pub use game_measures::{GameKind, PlayMeasures};
pub use game_report::{GameCase, GameReport, GameValidator};
pub use gates::{
    ActorsMatter, Drama, GATES, Gates, Necessity, NoDeadTime, NotInstant, OpenGround, Progression, Tight,
    ended_share,
};
pub use idle::NotIdle;
pub use ladder::{Difficulty, Ladder, LadderConfig, PlayerResult, Rung, UnknownDifficulty};
pub use length::LengthWithin;
pub use level_report::{Judgement, Report};
pub use mcts_rate::mcts_rate;
pub use measures::{FORESIGHT, Measures, SkillGap, is_guard, used_rules};
pub use novelty::GameForm;
pub use panel::Panel;
pub use random::NotRandom;
pub use reachable::Reachable;
pub use readable::Readable;
pub use recording::{Recorded, executions};
pub use rule_ref::{RuleRef, RuleRefError};
pub use rule_use::{RuleUse, RulesShown};
pub use skill::SkillPays;
pub use skill_overall::SkillOverall;
pub use verdict::{Case, Finding, Rate, Reason, Validator, Verdict};
pub use well_formed::WellFormed;
pub use winnable::Winnable;
pub use words::question;
