//! Groups of effects and sprite classes by purpose.

pub use engine::EffectFamily;
use engine::SpriteClass;

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
