//! VGDL text to games, levels and states: parse, compile, step, hash, observe.
//!
//! Goals, in order: the same behaviour as the reference engine, bit for bit; the same result on every machine; speed;
//! messages that help.
#![cfg_attr(not(doctest), doc = "", doc = include_str!("../README.md"))]

mod ablation;
pub mod analysis;
mod arrange;
mod causes;
mod chance;
mod compile;
mod contacts;
mod contribution;
mod defaults;
pub mod describe;
mod diagnostic;
mod digest;
mod episode;
mod events;
mod flight;
mod game;
mod geometry;
mod hash;
mod level;
pub mod limits;
mod lint;
mod motion;
mod moved;
mod named;
mod observe;
mod occupancy;
mod ontology;
mod overlap;
mod overrides;
mod pack;
mod paths;
mod population;
mod recount;
mod sampler;
mod scenery;
mod search_key;
mod seed;
mod side_tables;
mod sleep;
mod span;
mod state;
mod step;
mod swept_cells;
pub mod syntax;
mod trigonometry;

pub use analysis::Analysis;
pub use chance::Chance;
pub use compile::{
    Clauses, InteractionClause, Party, SPRITE_PARAMETERS, Term, TerminationClause, Terms, TypeClause,
};
pub use describe::describe;
pub use diagnostic::{Diagnostic, Diagnostics, Severity, Span, line_and_column, nearest};
pub use digest::{Digest, NotHex};
pub use episode::{Divergence, Episode};
pub use game::{Action, Game, Limit, Outcome, SpriteType};
pub use geometry::{Direction, Rect};
pub use hash::{SearchKey, StateHash};
pub use level::{Level, LevelMapping};
pub use limits::{MAX_CELLS, MAX_LEVEL_TEXT, MAX_SIDE, MAX_SOURCE, MAX_SPRITES, MAX_TICKS, MAX_WORK};
pub use lint::{SwappedRule, swapped_rule};
pub use observe::{AvatarView, Category, Countdown, Event, Observation, SpriteRecord};
pub use ontology::class::SpriteClass;
pub use ontology::effects::{NAMES as EFFECTS, ParameterKind, effect_parameters};
pub use ontology::terminations::NAMES as TERMINATIONS;
pub use pack::Packed;
pub use sampler::Sampler;
pub use seed::Seed;
pub use state::State;
pub use step::{Meeting, Watch};
pub use syntax::Description;

/// The version of the semantics, incremented when any golden trace changes: witnesses replay only under the same number.
pub const SEMANTICS: u32 = 3;
