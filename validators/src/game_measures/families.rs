//! Groups of effects and sprite classes by purpose.

use engine::SpriteClass;
use serde::{Deserialize, Serialize};

/// The group of an effect: the groups of the engine's ontology, with movement split by its result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EffectFamily {
    /// Sprites go away, perhaps on a condition.
    Kill,
    /// Health points.
    Health,
    /// Resources of sprites: taken or changed.
    Resource,
    /// Sprites appear.
    Spawn,
    /// Sprites become others.
    Transform,
    /// Moves are undone.
    Block,
    /// Sprites face another way.
    Turn,
    /// Sprites are pushed, pulled or carried.
    Push,
    /// Sprites come out elsewhere.
    Travel,
    /// Sprites get faster or slower, or another physics.
    Speed,
    /// Continuous physics meets walls and bats.
    Bounce,
    /// Something is scheduled for later.
    Timer,
    /// An interaction is prevented.
    Shield,
}

impl EffectFamily {
    /// All families, in their order.
    pub const ALL: [EffectFamily; 13] = [
        EffectFamily::Kill,
        EffectFamily::Health,
        EffectFamily::Resource,
        EffectFamily::Spawn,
        EffectFamily::Transform,
        EffectFamily::Block,
        EffectFamily::Turn,
        EffectFamily::Push,
        EffectFamily::Travel,
        EffectFamily::Speed,
        EffectFamily::Bounce,
        EffectFamily::Timer,
        EffectFamily::Shield,
    ];

    /// Returns the name used in data.
    pub fn name(self) -> &'static str {
        match self {
            EffectFamily::Kill => "kill",
            EffectFamily::Health => "health",
            EffectFamily::Resource => "resource",
            EffectFamily::Spawn => "spawn",
            EffectFamily::Transform => "transform",
            EffectFamily::Block => "block",
            EffectFamily::Turn => "turn",
            EffectFamily::Push => "push",
            EffectFamily::Travel => "travel",
            EffectFamily::Speed => "speed",
            EffectFamily::Bounce => "bounce",
            EffectFamily::Timer => "timer",
            EffectFamily::Shield => "shield",
        }
    }

    /// Returns the family of an effect by its keyword; none if it is not an effect.
    pub fn of(keyword: &str) -> Option<EffectFamily> {
        Some(match keyword {
            "killSprite" | "killBoth" | "killAll" | "killIfAlive" | "killIfFast" | "killIfSlow" => {
                EffectFamily::Kill
            }
            "killIfFromAbove" | "killIfFrontal" | "killIfNotFrontal" | "killIfNotUpright" => {
                EffectFamily::Kill
            }
            "killIfHasLess" | "killIfHasMore" | "killIfOtherHasMore" | "removeScore" => EffectFamily::Kill,
            "addHealthPoints" | "addHealthPointsToMax" | "subtractHealthPoints" => EffectFamily::Health,
            "collectResource" | "collectResourceIfHeld" | "changeResource" => EffectFamily::Resource,
            "spawn" | "spawnAbove" | "spawnBelow" | "spawnLeft" | "spawnRight" | "spawnBehind" => {
                EffectFamily::Spawn
            }
            "spawnIfHasLess"
            | "spawnIfHasMore"
            | "spawnIfCounterSubTypes"
            | "cloneSprite"
            | "updateSpawnType" => EffectFamily::Spawn,
            "transformTo"
            | "transformToAll"
            | "transformToRandomChild"
            | "transformToSingleton"
            | "transformIfCount" => EffectFamily::Transform,
            "stepBack" | "undoAll" => EffectFamily::Block,
            "turnAround" | "reverseDirection" | "flipDirection" | "attractGaze" => EffectFamily::Turn,
            "bounceForward" | "pullWithIt" | "align" => EffectFamily::Push,
            "teleportToExit" | "wrapAround" => EffectFamily::Travel,
            "increaseSpeedToAll" | "decreaseSpeedToAll" | "setSpeedForAll" | "halfSpeed" | "waterPhysics" => {
                EffectFamily::Speed
            }
            "bounceDirection" | "wallBounce" | "wallReverse" | "wallStop" => EffectFamily::Bounce,
            "addTimer" => EffectFamily::Timer,
            "shieldFrom" => EffectFamily::Shield,
            _ => return None,
        })
    }
}

/// The behaviour of sprites of a class by themselves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ClassFamily {
    /// None: they lie about, are pushed, lead somewhere or carry.
    Thing,
    /// None, and they can be held.
    Resource,
    /// They go away after a while, or spread.
    Flicker,
    /// They fly straight on.
    Missile,
    /// They wander, chase or flee.
    Npc,
    /// They walk and fall.
    Walker,
    /// They make others.
    Producer,
    /// They do as the player commands.
    Avatar,
}

impl ClassFamily {
    /// Returns the family of a class.
    pub fn of(class: SpriteClass) -> ClassFamily {
        use SpriteClass as C;
        match class {
            class if class.is_avatar() => ClassFamily::Avatar,
            class if class.is_a(C::RandomNPC) => ClassFamily::Npc,
            class if class.is_a(C::SpriteProducer) => match class {
                // A portal without a production of its own.
                C::Portal => ClassFamily::Thing,
                _ => ClassFamily::Producer,
            },
            class if class.is_a(C::Resource) => ClassFamily::Resource,
            C::Flicker | C::OrientedFlicker | C::Spreader => ClassFamily::Flicker,
            C::Missile | C::ErraticMissile | C::RandomMissile => ClassFamily::Missile,
            C::Walker | C::WalkerJumper => ClassFamily::Walker,
            _ => ClassFamily::Thing,
        }
    }

    /// Returns the name used in data.
    pub fn name(self) -> &'static str {
        match self {
            ClassFamily::Thing => "thing",
            ClassFamily::Resource => "resource",
            ClassFamily::Flicker => "flicker",
            ClassFamily::Missile => "missile",
            ClassFamily::Npc => "npc",
            ClassFamily::Walker => "walker",
            ClassFamily::Producer => "producer",
            ClassFamily::Avatar => "avatar",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_effect_has_a_family_and_every_family_an_effect() {
        let found: Vec<EffectFamily> =
            engine::EFFECTS.iter().map(|keyword| EffectFamily::of(keyword).expect(keyword)).collect();
        assert!(EffectFamily::ALL.iter().all(|family| found.contains(family)));
        assert_eq!(EffectFamily::of("killsprite"), None);
    }

    #[test]
    fn class_families_follow_behaviour() {
        assert_eq!(ClassFamily::of(SpriteClass::RandomInertial), ClassFamily::Npc);
        assert_eq!(ClassFamily::of(SpriteClass::RandomBomber), ClassFamily::Producer);
        assert_eq!(ClassFamily::of(SpriteClass::Portal), ClassFamily::Thing);
        assert_eq!(ClassFamily::of(SpriteClass::WizardAvatar), ClassFamily::Avatar);
        assert_eq!(ClassFamily::of(SpriteClass::ResourcePack), ClassFamily::Resource);
    }
}
