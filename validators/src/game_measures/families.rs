//! Groups of effects and sprite classes by purpose.

use engine::SpriteClass;

engine::named_enum! {
    /// The group of an effect: the groups of the engine's ontology, with movement split by its result.
    pub enum EffectFamily {
        /// Sprites go away, perhaps on a condition.
        Kill = "kill",
        /// Health points.
        Health = "health",
        /// Resources of sprites: taken or changed.
        Resource = "resource",
        /// Sprites appear.
        Spawn = "spawn",
        /// Sprites become others.
        Transform = "transform",
        /// Moves are undone.
        Block = "block",
        /// Sprites face another way.
        Turn = "turn",
        /// Sprites are pushed, pulled or carried.
        Push = "push",
        /// Sprites come out elsewhere.
        Travel = "travel",
        /// Sprites get faster or slower, or another physics.
        Speed = "speed",
        /// Continuous physics meets walls and bats.
        Bounce = "bounce",
        /// Something is scheduled for later.
        Timer = "timer",
        /// An interaction is prevented.
        Shield = "shield",
    }
}

impl EffectFamily {
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

engine::named_enum! {
    /// The behaviour of sprites of a class by themselves.
    pub enum ClassFamily {
        /// None: they lie about, are pushed, lead somewhere or carry.
        Thing = "thing",
        /// None, and they can be held.
        Resource = "resource",
        /// They go away after a while, or spread.
        Flicker = "flicker",
        /// They fly straight on.
        Missile = "missile",
        /// They wander, chase or flee.
        Npc = "npc",
        /// They walk and fall.
        Walker = "walker",
        /// They make others.
        Producer = "producer",
        /// They do as the player commands.
        Avatar = "avatar",
    }
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
