//! Parses VGDL text, compiles the text into games and levels, and steps, hashes and observes their states.
//!
//! The goals are, in order of priority:
//!
//! 1. The behaviour of the reference engine, bit for bit.
//! 2. The same result on every machine.
//! 3. Speed.
//! 4. Helpful messages.
#![cfg_attr(not(doctest), doc = "", doc = include_str!("../README.md"))]

// `pest_derive` is used without its `std` feature, which would check the stack at every step. It then
// generates code that names this crate.
extern crate alloc;

pub mod analysis;
mod compile;
pub mod describe;
mod diagnostic;
pub mod dialect;
mod episode;
mod flat;
mod game;
#[doc(hidden)]
pub mod inspect;
mod keywords;
pub mod layout;
mod level;
pub mod limits;
mod lint;
mod meanings;
mod numbers;
mod observe;
mod play;
mod rules;
mod schedule;
mod state;
pub mod syntax;
mod tick;
mod world;

pub use analysis::Analysis;
pub use compile::{
    Clauses, InteractionClause, Party, SPRITE_PARAMETERS, Term, TerminationClause, Terms, TypeClause,
};
pub use describe::describe;
pub use diagnostic::{Diagnostic, Diagnostics, Edit, Fix, Severity, Span, line_and_column, nearest};
pub use episode::{Divergence, Episode};
pub use flat::pack::Packed;
pub use game::Game;
pub use keywords::{EFFECTS, TERMINATIONS};
pub use level::{Level, LevelMapping};
pub use limits::{MAX_CELLS, MAX_LEVEL_TEXT, MAX_SIDE, MAX_SOURCE, MAX_SPRITES, MAX_TICKS, MAX_WORK};
pub use lint::{SwappedRule, swapped_rule};
pub use numbers::chance::Chance;
pub use numbers::geometry::{Direction, Rect};
pub use observe::planes::{Drawn, Planes};
pub use observe::{
    AvatarView, Category, Countdown, CountdownView, Event, MoverView, Observation, SpriteRecord,
};
pub use rules::class::{ClassFamily, SpriteClass};
pub use rules::effects::{EffectFamily, ParameterKind, effect_parameters};
pub use rules::{Action, Limit, Outcome, SpriteType};
pub use state::State;
pub use syntax::Description;
pub use tick::{Meeting, Removal, Watch};
pub use world::{SearchKey, StateHash};

/// The version of the engine's semantics. It is incremented when any golden trace changes, because a witness
/// replays only under the version with which it was recorded.
pub const SEMANTICS: u32 = 3;
