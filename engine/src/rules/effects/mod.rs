//! The effects of interactions (`spec/03`) as an enum, with their meaning. The code in `tick/effects/`
//! executes them.

mod build;
mod effect_summary;
mod parameters;
mod sentences;
mod summaries;
mod summary;

use super::SpriteType;
pub(crate) use build::{Arguments, Undeclared, build};
pub use effect_summary::{EffectSummary, Side};
pub(crate) use effect_summary::{Ending, Movement, Target};
pub use parameters::{ParameterKind, effect_parameters};
pub(crate) use sentences::{CHANCE, Sentence, Value, sentences, templates};
pub(crate) use summary::{
    Batch, Displacement, Draws, Gives, Moves, OrientationRead, Provided, PutBack, Redirection, SpeedChange,
    SpeedEffect, Spot, Summary, TickSummary, Turn,
};
pub use summary::{EffectFamily, Precondition};

/// An effect with its parameters, named as in VGDL.
#[derive(Clone, Debug)]
pub(crate) enum Effect {
    KillSprite,
    KillBoth,
    KillAll {
        stype: SpriteType,
    },
    KillIfAlive,
    KillIfFromAbove,
    KillIfHasLess {
        resource: SpriteType,
        limit: i32,
    },
    KillIfHasMore {
        resource: SpriteType,
        limit: i32,
    },
    KillIfOtherHasMore {
        resource: SpriteType,
        limit: i32,
        subtract: bool,
    },
    KillIfFrontal {
        frontal: bool,
    },
    KillIfSpeed {
        limit: f64,
        fast: bool,
    },
    KillIfNotUpright,
    AddHealthPoints {
        value: i32,
        kill_second: bool,
        to_max: bool,
    },
    SubtractHealthPoints {
        value: i32,
        limit: i32,
        stype: Option<SpriteType>,
        score_if_killed: i32,
    },
    StepBack {
        pixel_perfect: bool,
    },
    UndoAll {
        spare: Box<[SpriteType]>,
    },
    TurnAround,
    ReverseDirection,
    FlipDirection,
    HalfSpeed,
    WrapAround {
        offset: f64,
    },
    Align {
        orient: bool,
    },
    AttractGaze {
        align: bool,
        prob: f64,
    },
    BounceForward,
    PullWithIt {
        pixel_perfect: bool,
    },
    TeleportToExit,
    ChangeSpeed {
        stype: SpriteType,
        value: f64,
        how: SpeedChange,
    },
    Spawn {
        stype: SpriteType,
        prob: f64,
    },
    SpawnIf(SpawnIf),
    SpawnBeside {
        stype: SpriteType,
        shift: (i32, i32),
        step_back: bool,
        prob: f64,
    },
    SpawnBehind {
        stype: SpriteType,
        prob: f64,
    },
    CloneSprite,
    TransformTo {
        stype: SpriteType,
        kill_second: bool,
        force_orientation: bool,
    },
    TransformToAll {
        stype: SpriteType,
        to: SpriteType,
        kill_second: bool,
        force_orientation: bool,
    },
    TransformToRandomChild {
        options: Box<[SpriteType]>,
        kill_second: bool,
        force_orientation: bool,
    },
    CollectResource {
        kill_resource: bool,
    },
    CollectResourceIfHeld {
        held: SpriteType,
        value: i32,
        kill_resource: bool,
    },
    ChangeResource {
        resource: SpriteType,
        value: i32,
        kill_resource: bool,
    },
    ShieldFrom {
        stype: SpriteType,
        keyword: u16,
    },
    RemoveScore {
        stype: Option<SpriteType>,
        kill_second: bool,
    },
    UpdateSpawnType {
        stype: SpriteType,
        spawn_point: SpriteType,
    },
    SpawnIfCounterSubTypes(SpawnIfCounterSubTypes),
    TransformIfCount(Box<TransformIfCount>),
    TransformToSingleton {
        stype: SpriteType,
        other: SpriteType,
        take_orientation: bool,
    },
    WaterPhysics,
    BounceDirection {
        most: f64,
    },
    WallStop,
    WallBounce,
    WallReverse,
    /// Schedules one of the game's timed effects.
    AddTimer {
        timed: u16,
    },
    /// Makes the same random draws as the effect with this summary, and does nothing else
    /// (`ablation.rs`).
    Disabled(Box<Summary>),
}

/// The parameters of transformIfCount.
#[derive(Clone, Debug)]
pub(crate) struct TransformIfCount {
    pub(crate) stype: SpriteType,
    pub(crate) counted: SpriteType,
    pub(crate) at_least: i32,
    pub(crate) at_most: i32,
    pub(crate) otherwise: Option<SpriteType>,
    pub(crate) kill_second: bool,
    pub(crate) force_orientation: bool,
}

/// The parameters of spawnIfHasMore and spawnIfHasLess.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpawnIf {
    pub(crate) resource: SpriteType,
    pub(crate) limit: i32,
    pub(crate) stype: SpriteType,
    pub(crate) spend: i32,
    pub(crate) prob: f64,
    pub(crate) more: bool,
}

/// The parameters of spawnIfCounterSubTypes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpawnIfCounterSubTypes {
    pub(crate) stype: SpriteType,
    pub(crate) otherwise: SpriteType,
    pub(crate) counted: SpriteType,
    pub(crate) limit: i32,
    pub(crate) kinds: i32,
}

impl Effect {
    /// Returns an effect that makes the same random draws and has no consequences.
    pub(crate) fn disabled(&self) -> Effect {
        Effect::Disabled(Box::new(self.summary()))
    }
}
