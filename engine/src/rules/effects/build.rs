//! Builds an [`Effect`] from an interaction line: its keyword, and its required and optional parameters
//! (`spec/03` §2).

use super::{Effect, SpawnIf, SpawnIfCounterSubTypes, SpeedChange, TransformIfCount};
use crate::rules::SpriteType;

/// The parameters on a line, parsed on demand. Getters report problems and then continue with a default, so
/// that all problems on a line are found.
pub(crate) trait Arguments {
    fn int(&mut self, key: &'static str, default: i32) -> i32;
    fn number(&mut self, key: &'static str, default: f64) -> f64;
    fn flag(&mut self, key: &'static str, default: bool) -> bool;
    /// Returns the player's score: the first entry in a list of scores.
    fn score(&mut self, key: &'static str) -> i32;
    /// Returns a required sprite type that must be declared.
    fn sprite(&mut self, key: &'static str) -> SpriteType;
    /// Returns a required sprite type. For an undeclared name, returns [`SpriteType::NONE`], which stops the
    /// game only if it is used.
    fn sprite_or_none(&mut self, key: &'static str) -> SpriteType;
    /// Returns the sprite type that a parameter names, or `None` if the parameter is missing.
    fn optional_sprite(&mut self, key: &'static str, undeclared: Undeclared) -> Option<SpriteType>;
    /// Returns an optional type that is specified by its registry index. The reference accepts an index for
    /// some types.
    fn numbered(&mut self, key: &'static str) -> Option<SpriteType>;
    fn sprites(&mut self, key: &'static str) -> Vec<SpriteType>;
    /// Returns the keyword index of another effect.
    fn keyword(&mut self, key: &'static str) -> u16;
    /// Returns the effect that addTimer schedules, which is compiled as a separate line.
    fn timed(&mut self) -> u16;
    /// Returns the types related to a type in the SpriteSet, excluding the type itself.
    fn relatives(&self, stype: SpriteType) -> Box<[SpriteType]>;
}

/// The reference's handling of an undeclared name (`spec/03` §2.2). In strict mode, such a name is an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Undeclared {
    /// The reference drops the effect and ignores the rest of the file.
    Fails,
    /// The name counts as absent.
    Absent,
    /// The name stands for [`SpriteType::NONE`].
    Void,
}

/// Declares the effects once, sorted by keyword. Each entry contains its keywords and the effect built from
/// the arguments.
macro_rules! effects {
    ($keyword:ident, $args:ident; $($($name:literal)|+ => $effect:expr,)*) => {
        /// The keywords, for comparison with [`crate::keywords::EFFECTS`].
        #[cfg(test)]
        pub(super) const BUILT: &[&str] = &[$($($name),+),*];

        /// Returns the effect with this keyword, or `None` if there is no such effect.
        pub(crate) fn build($keyword: &str, $args: &mut impl Arguments) -> Option<Effect> {
            Some(match $keyword {
                $($($name)|+ => $effect,)*
                _ => return None,
            })
        }
    };
}

effects! {
    keyword, args;
    "addHealthPoints" | "addHealthPointsToMax" => Effect::AddHealthPoints {
        value: args.int("value", 1),
        kill_second: args.flag("killSecond", false),
        to_max: keyword == "addHealthPointsToMax",
    },
    "addTimer" => Effect::AddTimer { timed: args.timed() },
    "align" => Effect::Align { orient: args.flag("orient", true) },
    "attractGaze" => Effect::AttractGaze { align: args.flag("align", false), prob: args.number("prob", 1.0) },
    // Converts degrees to radians as the reference does.
    "bounceDirection" => Effect::BounceDirection {
        most: args.number("maxBounceAngleDeg", 60.0) * 0.017_453_292_519_943_295,
    },
    "bounceForward" => Effect::BounceForward,
    "changeResource" => Effect::ChangeResource {
        resource: args.sprite_or_none("resource"),
        value: args.int("value", 1),
        kill_resource: args.flag("killResource", false),
    },
    "cloneSprite" => Effect::CloneSprite,
    "collectResource" => Effect::CollectResource { kill_resource: args.flag("killResource", true) },
    "collectResourceIfHeld" => Effect::CollectResourceIfHeld {
        held: args.sprite_or_none("heldResource"),
        value: args.int("value", 1),
        kill_resource: args.flag("killResource", true),
    },
    "decreaseSpeedToAll" => speed(args, 0.1, SpeedChange::Decrease),
    "flipDirection" => Effect::FlipDirection,
    "halfSpeed" => Effect::HalfSpeed,
    "increaseSpeedToAll" => speed(args, 0.1, SpeedChange::Increase),
    "killAll" => Effect::KillAll { stype: args.sprite("stype") },
    "killBoth" => Effect::KillBoth,
    "killIfAlive" => Effect::KillIfAlive,
    "killIfFast" => Effect::KillIfSpeed { limit: args.number("limspeed", 1.0), fast: true },
    "killIfFromAbove" => Effect::KillIfFromAbove,
    "killIfFrontal" => Effect::KillIfFrontal { frontal: true },
    "killIfHasLess" => {
        Effect::KillIfHasLess { resource: args.sprite("resource"), limit: args.int("limit", 0) }
    },
    "killIfHasMore" => {
        Effect::KillIfHasMore { resource: args.sprite("resource"), limit: args.int("limit", 0) }
    },
    "killIfNotFrontal" => Effect::KillIfFrontal { frontal: false },
    "killIfNotUpright" => Effect::KillIfNotUpright,
    "killIfOtherHasMore" => Effect::KillIfOtherHasMore {
        resource: args.sprite_or_none("resource"),
        limit: args.int("limit", 0),
        subtract: args.flag("subtract", false),
    },
    "killIfSlow" => Effect::KillIfSpeed { limit: args.number("limspeed", 1.0), fast: false },
    "killSprite" => Effect::KillSprite,
    "pullWithIt" => Effect::PullWithIt { pixel_perfect: args.flag("pixelPerfect", false) },
    "removeScore" => Effect::RemoveScore {
        stype: subject(args, Undeclared::Absent),
        kill_second: args.flag("killSecond", false),
    },
    "reverseDirection" => Effect::ReverseDirection,
    "setSpeedForAll" => speed(args, 0.0, SpeedChange::Set),
    "shieldFrom" => Effect::ShieldFrom { stype: args.sprite("stype"), keyword: args.keyword("ftype") },
    "spawn" => Effect::Spawn { stype: args.sprite("stype"), prob: args.number("prob", 1.0) },
    "spawnAbove" => beside(args, (0, -1)),
    "spawnBehind" => Effect::SpawnBehind { stype: args.sprite("stype"), prob: args.number("prob", 1.0) },
    "spawnBelow" => beside(args, (0, 1)),
    "spawnIfCounterSubTypes" => Effect::SpawnIfCounterSubTypes(SpawnIfCounterSubTypes {
        stype: args.sprite("stype"),
        otherwise: args.sprite("estype"),
        counted: args.sprite("stypeCount"),
        limit: args.int("limit", 0),
        kinds: args.int("subTypesNum", -1),
    }),
    "spawnIfHasLess" | "spawnIfHasMore" => {
        let more = keyword == "spawnIfHasMore";
        Effect::SpawnIf(SpawnIf {
            resource: args.sprite("resource"),
            limit: args.int("limit", 0),
            stype: args.sprite("stype"),
            spend: if more { args.int("spend", 0) } else { 0 },
            prob: args.number("prob", 1.0),
            more,
        })
    },
    "spawnLeft" => beside(args, (-1, 0)),
    "spawnRight" => beside(args, (1, 0)),
    "stepBack" => Effect::StepBack { pixel_perfect: args.flag("pixelPerfect", false) },
    "subtractHealthPoints" => Effect::SubtractHealthPoints {
        value: args.int("value", 1),
        limit: args.int("limit", 0),
        stype: subject(args, Undeclared::Fails),
        score_if_killed: args.score("scoreChangeIfKilled"),
    },
    "teleportToExit" => Effect::TeleportToExit,
    "transformIfCount" => Effect::TransformIfCount(Box::new(TransformIfCount {
        stype: args.sprite("stype"),
        counted: args.sprite_or_none("stypeCount"),
        at_least: args.int("geq", 0),
        at_most: args.int("leq", 10_000),
        otherwise: args.optional_sprite("estype", Undeclared::Void),
        kill_second: args.flag("killSecond", false),
        force_orientation: args.flag("forceOrientation", false),
    })),
    "transformTo" => Effect::TransformTo {
        stype: args.sprite("stype"),
        kill_second: args.flag("killSecond", false),
        force_orientation: args.flag("forceOrientation", false),
    },
    "transformToAll" => Effect::TransformToAll {
        stype: args.sprite("stype"),
        to: args.sprite("stypeTo"),
        kill_second: args.flag("killSecond", false),
        force_orientation: args.flag("forceOrientation", false),
    },
    "transformToRandomChild" => {
        let stype = args.sprite("stype");
        Effect::TransformToRandomChild {
            options: args.relatives(stype),
            kill_second: args.flag("killSecond", false),
            force_orientation: args.flag("forceOrientation", false),
        }
    },
    "transformToSingleton" => Effect::TransformToSingleton {
        stype: args.sprite("stype"),
        other: args.sprite("stype_other"),
        take_orientation: args.flag("takeOrientation", false),
    },
    "turnAround" => Effect::TurnAround,
    "undoAll" => Effect::UndoAll { spare: args.sprites("notStype").into() },
    "updateSpawnType" => {
        Effect::UpdateSpawnType { stype: args.sprite("stype"), spawn_point: args.sprite("spawnPoint") }
    },
    "wallBounce" => Effect::WallBounce,
    "wallReverse" => Effect::WallReverse,
    "wallStop" => Effect::WallStop,
    "waterPhysics" => Effect::WaterPhysics,
    "wrapAround" => Effect::WrapAround { offset: args.number("offset", 0.0) },
}

fn speed(args: &mut impl Arguments, default: f64, how: SpeedChange) -> Effect {
    Effect::ChangeSpeed { stype: args.sprite("stype"), value: args.number("value", default), how }
}

/// Returns the type named by a parameter of subtractHealthPoints or removeScore, if any.
fn subject(args: &mut impl Arguments, undeclared: Undeclared) -> Option<SpriteType> {
    let numbered = args.numbered("itype");
    args.optional_sprite("stype", undeclared).or(numbered)
}

fn beside(args: &mut impl Arguments, shift: (i32, i32)) -> Effect {
    Effect::SpawnBeside {
        stype: args.sprite_or_none("stype"),
        shift,
        step_back: args.flag("stepBack", false),
        prob: args.number("prob", 1.0),
    }
}
