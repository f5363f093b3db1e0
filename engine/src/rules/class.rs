//! The sprite classes of VGDL (`spec/02` §6–§9, §12): names, hierarchy and additional parameters.

use crate::rules::Action;

base::named_enum! {
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

/// Declares the classes once: the variant, which is also the VGDL name, the class that it extends, its family, and the
/// parameters that it adds.
macro_rules! classes {
    ($($name:ident : $parent:ident, $family:ident, $own:expr;)*) => {
        /// A sprite class, named as in VGDL.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[allow(missing_docs, reason = "the names are VGDL's; docs/reference/ontology says what each does")]
        pub enum SpriteClass { $($name),* }

        impl SpriteClass {
            /// All classes that the engine supports.
            pub const ALL: &[SpriteClass] = &[$(SpriteClass::$name),*];

            /// The name in VGDL.
            pub fn name(self) -> &'static str {
                match self { $(SpriteClass::$name => stringify!($name)),* }
            }

            /// The class this one extends; the roots name themselves.
            fn parent(self) -> SpriteClass {
                match self { $(SpriteClass::$name => SpriteClass::$parent),* }
            }

            /// The family of the class. Code that treats only some classes in a way of their own decides by the family
            /// for all others, so that every class has an answer.
            pub fn family(self) -> ClassFamily {
                match self { $(SpriteClass::$name => ClassFamily::$family),* }
            }

            /// The parameters that this class adds to those of its parent.
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
    /// Tests whether sprites of the class can draw random numbers.
    pub(crate) fn draws(self) -> bool {
        use SpriteClass as C;
        self.is_a(C::RandomNPC)
            || self.is_a(C::SpawnPoint)
            || self.is_a(C::Walker)
            || matches!(self, C::RandomMissile | C::Spreader | C::SpawnPointMultiSprite)
    }

    /// The class of that name, exact case.
    pub fn from_name(name: &str) -> Option<SpriteClass> {
        SpriteClass::ALL.iter().copied().find(|class| class.name() == name)
    }

    /// Tests whether this class is `ancestor` or extends it.
    pub fn is_a(self, ancestor: SpriteClass) -> bool {
        self == ancestor || (self.parent() != self && self.parent().is_a(ancestor))
    }

    /// Tests whether a player can control it.
    pub fn is_avatar(self) -> bool {
        self.is_a(SpriteClass::MovingAvatar)
    }

    /// Tests whether sprites of the class produce others by the clock (`spec/02` §8).
    pub(crate) fn is_spawner(self) -> bool {
        self.is_a(SpriteClass::SpawnPoint) || self == SpriteClass::SpawnPointMultiSprite
    }

    /// Tests whether sprites of the class detect the ground (`spec/02` §2.5).
    pub(crate) fn is_ground_aware(self) -> bool {
        self.is_a(SpriteClass::PlatformerAvatar) || self.is_a(SpriteClass::Walker)
    }

    /// The parameters that this class has in addition to the base sprite's, including those of its parents.
    pub fn parameters(self) -> Vec<&'static str> {
        let inherited = if self.parent() == self { Vec::new() } else { self.parent().parameters() };
        inherited.into_iter().chain(self.own_parameters().iter().copied()).collect()
    }

    /// The actions that a player may choose besides NIL (`spec/01` §6.4), in the order of [`Action`].
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
