//! The sprite classes of VGDL (`spec/02` §6–§9, §12): names, families, what each adds to the base sprite.

use crate::game::Action;

/// Declares the classes once: variant, VGDL name is the variant's, `parent` is the class it extends.
macro_rules! classes {
    ($($name:ident : $parent:ident, $own:expr;)*) => {
        /// A sprite class, named as in VGDL.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[allow(missing_docs, reason = "the names are VGDL's; docs/ontology says what each does")]
        pub enum SpriteClass { $($name),* }

        impl SpriteClass {
            /// Every class that the engine plays.
            pub const ALL: &[SpriteClass] = &[$(SpriteClass::$name),*];

            /// As written in VGDL.
            pub fn name(self) -> &'static str {
                match self { $(SpriteClass::$name => stringify!($name)),* }
            }

            /// The class this one extends; the roots name themselves.
            fn parent(self) -> SpriteClass {
                match self { $(SpriteClass::$name => SpriteClass::$parent),* }
            }

            /// The parameters that this class adds to those of its parent.
            fn own_parameters(self) -> &'static [&'static str] {
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
    Flicker: Flicker, ["limit", "age"];
    OrientedFlicker: Flicker, [];
    Spreader: Flicker, ["spreadprob", "stype"];
    Missile: Missile, [];
    ErraticMissile: Missile, [];
    RandomMissile: Missile, [];
    RandomNPC: RandomNPC, ["cons"];
    Chaser: RandomNPC, ["stype", "fleeing", "maxDistance"];
    Fleeing: Chaser, [];
    SpriteProducer: SpriteProducer, [];
    Portal: SpriteProducer, ["stype"];
    SpawnPoint: SpriteProducer, ["stype", "prob", "total", "spawnorientation", "start", "counter"];
    Bomber: SpawnPoint, [];
    RandomBomber: SpawnPoint, [];
    MovingAvatar: MovingAvatar, [];
    HorizontalAvatar: MovingAvatar, [];
    VerticalAvatar: MovingAvatar, [];
    FlakAvatar: HorizontalAvatar, ["stype", "ammo", "minAmmo", "ammoCost"];
    OrientedAvatar: MovingAvatar, [];
    ShootAvatar: OrientedAvatar, ["stype", "ammo"];
    OngoingAvatar: OrientedAvatar, [];
    OngoingShootAvatar: ShootAvatar, [];
    MissileAvatar: OrientedAvatar, [];
}

/// Classes of the reference that the engine does not play yet; named so that a message can say so.
pub(crate) const LATER: &[&str] = &[
    "Walker",
    "WalkerJumper",
    "ResourcePack",
    "PathChaser",
    "RandomInertial",
    "AlternateChaser",
    "RandomAltChaser",
    "PathAltChaser",
    "RandomPathAltChaser",
    "OngoingTurningAvatar",
    "BomberRandomMissile",
    "NullAvatar",
    "AimedAvatar",
    "PlatformerAvatar",
    "BirdAvatar",
    "SpaceshipAvatar",
    "CarAvatar",
    "WizardAvatar",
    "LanderAvatar",
    "ShootOnlyAvatar",
    "SpawnPointMultiSprite",
    "LOSChaser",
];

impl SpriteClass {
    /// The class of that name, exact case.
    pub fn from_name(name: &str) -> Option<SpriteClass> {
        SpriteClass::ALL.iter().copied().find(|class| class.name() == name)
    }

    /// Whether this class is `ancestor` or extends it.
    pub fn is_a(self, ancestor: SpriteClass) -> bool {
        self == ancestor || (self.parent() != self && self.parent().is_a(ancestor))
    }

    /// Whether a player can control it.
    pub fn is_avatar(self) -> bool {
        self.is_a(SpriteClass::MovingAvatar)
    }

    /// The parameters that this class has beyond the base sprite's, its parents' included.
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
            SpriteClass::FlakAvatar => &[Left, Right, Use],
            SpriteClass::ShootAvatar | SpriteClass::OngoingShootAvatar => &[Up, Left, Down, Right, Use],
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
        assert!(LATER.iter().all(|name| SpriteClass::from_name(name).is_none()));
    }
}
