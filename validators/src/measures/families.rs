//! Groups of effects and sprite classes by purpose.

pub use engine::{ClassFamily, EffectFamily};

#[cfg(test)]
mod tests {
    use super::*;
    use engine::SpriteClass;

    #[test]
    fn every_effect_has_a_family_and_every_family_an_effect() {
        let found: Vec<EffectFamily> =
            engine::EFFECTS.iter().map(|keyword| EffectFamily::of(keyword).expect(keyword)).collect();
        assert!(EffectFamily::ALL.iter().all(|family| found.contains(family)));
        assert_eq!(EffectFamily::of("killsprite"), None);
    }

    #[test]
    fn class_families_follow_behaviour() {
        assert_eq!(SpriteClass::RandomInertial.family(), ClassFamily::Npc);
        assert_eq!(SpriteClass::RandomBomber.family(), ClassFamily::Producer);
        assert_eq!(SpriteClass::Portal.family(), ClassFamily::Thing);
        assert_eq!(SpriteClass::WizardAvatar.family(), ClassFamily::Avatar);
        assert_eq!(SpriteClass::ResourcePack.family(), ClassFamily::Resource);
    }
}
