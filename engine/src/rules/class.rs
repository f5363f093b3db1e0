//! The sprite classes of VGDL (`spec/02` §6–§9, §12): names, hierarchy and additional parameters.

use crate::rules::Action;

base::named_enum! {
    /// A class's behaviour: the things that its sprites do on their own.
    pub enum ClassFamily {
        /// Sprites that do nothing on their own. They can be collected or pushed, and can lead to or carry
        /// other sprites.
        Thing = "thing",
        /// Sprites that do nothing on their own and can be held.
        Resource = "resource",
        /// Sprites that disappear after a while, or spread.
        Flicker = "flicker",
        /// Sprites that move straight ahead.
        Missile = "missile",
        /// Sprites that wander, chase or flee.
        Npc = "npc",
        /// Sprites that walk and fall.
        Walker = "walker",
        /// Sprites that create other sprites.
        Producer = "producer",
        /// Sprites that the player controls.
        Avatar = "avatar",
    }
}

/// Declares the classes once. Each entry consists of the variant, which is also the class's VGDL name, the
/// class that it extends, its family, and the parameters that it adds.
macro_rules! classes {
    ($($name:ident : $parent:ident, $family:ident, $own:expr;)*) => {
        /// A sprite class, named as in VGDL.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[allow(missing_docs, reason = "the names are VGDL's; docs/reference/ontology says what each does")]
        pub enum SpriteClass { $($name),* }

        impl SpriteClass {
            /// All classes that the engine supports.
            pub const ALL: &[SpriteClass] = &[$(SpriteClass::$name),*];

            /// Returns the class's name in VGDL.
            pub fn name(self) -> &'static str {
                match self { $(SpriteClass::$name => stringify!($name)),* }
            }

            /// Returns the parent class. A root class returns itself.
            fn parent(self) -> SpriteClass {
                match self { $(SpriteClass::$name => SpriteClass::$parent),* }
            }

            /// Returns the class's family. Code with special cases for some classes matches all others by
            /// family, so that no class is forgotten.
            pub fn family(self) -> ClassFamily {
                match self { $(SpriteClass::$name => ClassFamily::$family),* }
            }

            /// Returns the parameters that this class adds to its parent's parameters.
            pub fn own_parameters(self) -> &'static [&'static str] {
                match self { $(SpriteClass::$name => &$own),* }
            }
        }
    };
}

classes! {
    Immovable: Immovable, Thing, [];
    Door: Immovable, Thing, [];
    Passive: Passive, Thing, [];
    Conveyor: Conveyor, Thing, [];
    Resource: Passive, Resource, ["value", "limit", "resource_name"];
    ResourcePack: Resource, Resource, [];
    Flicker: Flicker, Flicker, ["limit", "age"];
    OrientedFlicker: Flicker, Flicker, [];
    Spreader: Flicker, Flicker, ["spreadprob", "stype"];
    Missile: Missile, Missile, [];
    ErraticMissile: Missile, Missile, [];
    RandomMissile: Missile, Missile, [];
    RandomNPC: RandomNPC, Npc, ["cons"];
    RandomInertial: RandomNPC, Npc, [];
    Chaser: RandomNPC, Npc, ["stype", "fleeing", "maxDistance"];
    Fleeing: Chaser, Npc, [];
    LOSChaser: Chaser, Npc, [];
    PathChaser: RandomNPC, Npc, ["stype", "fleeing", "maxDistance"];
    AlternateChaser: RandomNPC, Npc, ["stype1", "stype2", "fleeing"];
    RandomAltChaser: AlternateChaser, Npc, ["epsilon"];
    PathAltChaser: AlternateChaser, Npc, ["randomTarget"];
    RandomPathAltChaser: PathAltChaser, Npc, ["epsilon"];
    Walker: Walker, Walker, ["airsteering"];
    WalkerJumper: Walker, Walker, ["probability"];
    SpriteProducer: SpriteProducer, Producer, [];
    Portal: SpriteProducer, Thing, ["stype"];
    SpawnPoint: SpriteProducer, Producer, ["stype", "prob", "total", "spawnorientation", "counter"];
    Bomber: SpawnPoint, Producer, [];
    RandomBomber: SpawnPoint, Producer, [];
    BomberRandomMissile: SpawnPoint, Producer, ["stypeMissile"];
    SpawnPointMultiSprite: SpriteProducer, Producer, ["stypes", "prob", "total", "spawnorientation", "counter"];
    MovingAvatar: MovingAvatar, Avatar, [];
    HorizontalAvatar: MovingAvatar, Avatar, [];
    VerticalAvatar: MovingAvatar, Avatar, [];
    NullAvatar: MovingAvatar, Avatar, [];
    FlakAvatar: HorizontalAvatar, Avatar, ["stype", "ammo", "minAmmo", "ammoCost"];
    OrientedAvatar: MovingAvatar, Avatar, [];
    ShootAvatar: OrientedAvatar, Avatar, ["stype", "ammo"];
    OngoingAvatar: OrientedAvatar, Avatar, [];
    OngoingShootAvatar: ShootAvatar, Avatar, [];
    OngoingTurningAvatar: OrientedAvatar, Avatar, ["spawnBehind"];
    MissileAvatar: OrientedAvatar, Avatar, [];
    ShootOnlyAvatar: ShootAvatar, Avatar, [];
    AimedAvatar: ShootAvatar, Avatar, ["angle_diff"];
    SpaceshipAvatar: ShootAvatar, Avatar, ["angle_diff"];
    CarAvatar: OrientedAvatar, Avatar, ["angle_diff", "facing"];
    LanderAvatar: OrientedAvatar, Avatar, ["angle_diff"];
    BirdAvatar: OrientedAvatar, Avatar, [];
    PlatformerAvatar: MovingAvatar, Avatar, ["ground_speedup_factor", "air_slowdown_factor"];
    WizardAvatar: PlatformerAvatar, Avatar, ["stype", "facing_dir", "last_block_time"];
}

impl SpriteClass {
    /// Returns `true` if sprites of the class can draw random numbers.
    pub(crate) fn draws(self) -> bool {
        use SpriteClass as C;
        self.is_a(C::RandomNPC)
            || self.is_a(C::SpawnPoint)
            || self.is_a(C::Walker)
            || matches!(self, C::RandomMissile | C::Spreader | C::SpawnPointMultiSprite)
    }

    /// Returns the class with this name; `None` if there is no such class. The name is case-sensitive.
    pub fn from_name(name: &str) -> Option<SpriteClass> {
        SpriteClass::ALL.iter().copied().find(|class| class.name() == name)
    }

    /// Returns `true` if this class is `ancestor` or extends it.
    pub fn is_a(self, ancestor: SpriteClass) -> bool {
        self == ancestor || (self.parent() != self && self.parent().is_a(ancestor))
    }

    /// Returns `true` if players can control sprites of the class.
    pub fn is_avatar(self) -> bool {
        self.is_a(SpriteClass::MovingAvatar)
    }

    /// Returns `true` if sprites of the class create other sprites at regular intervals (`spec/02` §8).
    pub(crate) fn is_spawner(self) -> bool {
        self.is_a(SpriteClass::SpawnPoint) || self == SpriteClass::SpawnPointMultiSprite
    }

    /// Returns `true` if sprites of the class detect the ground (`spec/02` §2.5).
    pub(crate) fn is_ground_aware(self) -> bool {
        self.is_a(SpriteClass::PlatformerAvatar) || self.is_a(SpriteClass::Walker)
    }

    /// Returns the parameters that this class accepts in addition to the base sprite's parameters, including
    /// inherited ones.
    pub fn parameters(self) -> Vec<&'static str> {
        let inherited = if self.parent() == self { Vec::new() } else { self.parent().parameters() };
        inherited.into_iter().chain(self.own_parameters().iter().copied()).collect()
    }

    /// Returns the actions that a player may choose (`spec/01` §6.4), except [`Action::Nil`], in the order of
    /// [`Action`].
    pub fn actions(self) -> &'static [Action] {
        use Action::{Down, Left, Right, Up, Use};
        use ClassFamily as Family;
        match (self, self.family()) {
            (SpriteClass::HorizontalAvatar, _) => &[Left, Right],
            (SpriteClass::VerticalAvatar, _) => &[Up, Down],
            (SpriteClass::NullAvatar, _) => &[Action::Nil],
            (SpriteClass::FlakAvatar | SpriteClass::PlatformerAvatar, _) => &[Left, Right, Use],
            (SpriteClass::WizardAvatar, _) => &[Up, Left, Right, Use],
            (SpriteClass::AimedAvatar, _) => &[Up, Down, Use],
            (SpriteClass::BirdAvatar, _) => &[Use],
            (_, Family::Avatar) if self.is_a(SpriteClass::ShootAvatar) => &[Up, Left, Down, Right, Use],
            (_, Family::Avatar) => &[Up, Left, Down, Right],
            (_, Family::Thing | Family::Resource | Family::Flicker | Family::Missile) => &[],
            (_, Family::Npc | Family::Walker | Family::Producer) => &[],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keywords;

    #[test]
    fn families() {
        assert!(SpriteClass::OngoingShootAvatar.is_avatar());
        assert!(!SpriteClass::Bomber.is_avatar());
        assert_eq!(SpriteClass::Fleeing.parameters(), ["cons", "stype", "fleeing", "maxDistance"]);
        assert_eq!(SpriteClass::from_name("missile"), None);
        assert!(SpriteClass::ALL.iter().map(|class| class.name()).eq(keywords::CLASSES.iter().copied()));
        assert!(
            SpriteClass::ALL.iter().all(|class| class.is_avatar() == (class.family() == ClassFamily::Avatar))
        );
    }
}
