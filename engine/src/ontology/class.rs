//! The sprite classes of VGDL (`spec/02` §6–§9, §12): names, hierarchy and additional parameters.

use crate::rules::Action;

/// Declares the classes once: the variant, which is also the VGDL name, and the class that it extends.
macro_rules! classes {
    ($($name:ident : $parent:ident, $own:expr;)*) => {
        /// A sprite class, named as in VGDL.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[allow(missing_docs, reason = "the names are VGDL's; docs/ontology says what each does")]
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

            /// The parameters that this class adds to those of its parent.
            pub fn own_parameters(self) -> &'static [&'static str] {
                match self { $(SpriteClass::$name => &$own),* }
            }
        }
    };
}

classes! {
    Immovable: Immovable, [];
    Door: Immovable, [];
    Passive: Passive, [];
    Conveyor: Conveyor, [];
    Resource: Passive, ["value", "limit", "resource_name"];
    ResourcePack: Resource, [];
    Flicker: Flicker, ["limit", "age"];
    OrientedFlicker: Flicker, [];
    Spreader: Flicker, ["spreadprob", "stype"];
    Missile: Missile, [];
    ErraticMissile: Missile, [];
    RandomMissile: Missile, [];
    RandomNPC: RandomNPC, ["cons"];
    RandomInertial: RandomNPC, [];
    Chaser: RandomNPC, ["stype", "fleeing", "maxDistance"];
    Fleeing: Chaser, [];
    LOSChaser: Chaser, [];
    PathChaser: RandomNPC, ["stype", "fleeing", "maxDistance"];
    AlternateChaser: RandomNPC, ["stype1", "stype2", "fleeing"];
    RandomAltChaser: AlternateChaser, ["epsilon"];
    PathAltChaser: AlternateChaser, ["randomTarget"];
    RandomPathAltChaser: PathAltChaser, ["epsilon"];
    Walker: Walker, ["airsteering"];
    WalkerJumper: Walker, ["probability"];
    SpriteProducer: SpriteProducer, [];
    Portal: SpriteProducer, ["stype"];
    SpawnPoint: SpriteProducer, ["stype", "prob", "total", "spawnorientation", "counter"];
    Bomber: SpawnPoint, [];
    RandomBomber: SpawnPoint, [];
    BomberRandomMissile: SpawnPoint, ["stypeMissile"];
    SpawnPointMultiSprite: SpriteProducer, ["stypes", "prob", "total", "spawnorientation", "counter"];
    MovingAvatar: MovingAvatar, [];
    HorizontalAvatar: MovingAvatar, [];
    VerticalAvatar: MovingAvatar, [];
    NullAvatar: MovingAvatar, [];
    FlakAvatar: HorizontalAvatar, ["stype", "ammo", "minAmmo", "ammoCost"];
    OrientedAvatar: MovingAvatar, [];
    ShootAvatar: OrientedAvatar, ["stype", "ammo"];
    OngoingAvatar: OrientedAvatar, [];
    OngoingShootAvatar: ShootAvatar, [];
    OngoingTurningAvatar: OrientedAvatar, ["spawnBehind"];
    MissileAvatar: OrientedAvatar, [];
    ShootOnlyAvatar: ShootAvatar, [];
    AimedAvatar: ShootAvatar, ["angle_diff"];
    SpaceshipAvatar: ShootAvatar, ["angle_diff"];
    CarAvatar: OrientedAvatar, ["angle_diff", "facing"];
    LanderAvatar: OrientedAvatar, ["angle_diff"];
    BirdAvatar: OrientedAvatar, [];
    PlatformerAvatar: MovingAvatar, ["ground_speedup_factor", "air_slowdown_factor"];
    WizardAvatar: PlatformerAvatar, ["stype", "facing_dir", "last_block_time"];
}

impl SpriteClass {
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
        match self {
            SpriteClass::HorizontalAvatar => &[Left, Right],
            SpriteClass::VerticalAvatar => &[Up, Down],
            SpriteClass::NullAvatar => &[Action::Nil],
            SpriteClass::FlakAvatar | SpriteClass::PlatformerAvatar => &[Left, Right, Use],
            SpriteClass::WizardAvatar => &[Up, Left, Right, Use],
            SpriteClass::AimedAvatar => &[Up, Down, Use],
            SpriteClass::BirdAvatar => &[Use],
            class if class.is_a(SpriteClass::ShootAvatar) => &[Up, Left, Down, Right, Use],
            class if class.is_avatar() => &[Up, Left, Down, Right],
            _ => &[],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn families() {
        assert!(SpriteClass::OngoingShootAvatar.is_avatar());
        assert!(!SpriteClass::Bomber.is_avatar());
        assert_eq!(SpriteClass::Fleeing.parameters(), ["cons", "stype", "fleeing", "maxDistance"]);
        assert_eq!(SpriteClass::from_name("missile"), None);
        assert_eq!(SpriteClass::ALL.len(), 50);
    }
}
