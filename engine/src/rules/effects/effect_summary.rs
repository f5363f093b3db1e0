//! One consequence of an effect, as plain data, and the properties that analyses ask of it.

use crate::rules::SpriteType;

/// One side of an interaction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The sprite named first: the one acted upon.
    First,
    /// Its partner.
    Second,
}

impl Side {
    pub(crate) fn other(self) -> Side {
        match self {
            Side::First => Side::Second,
            Side::Second => Side::First,
        }
    }
}

/// One effect of an interaction.
#[derive(Clone, Debug, PartialEq)]
pub enum EffectSummary {
    /// The sprite of that side is removed.
    Kill(Side),
    /// Every sprite of exactly this type is removed.
    KillAll(SpriteType),
    /// The first sprite turns into one of this type.
    Become(SpriteType),
    /// The first sprite turns into one of these types, chosen at random.
    BecomeAny(Box<[SpriteType]>),
    /// Every sprite of exactly the one type turns into one of the other.
    BecomeAll(SpriteType, SpriteType),
    /// The first sprite moves back to its previous position: the second one blocks it.
    Stop,
    /// Every sprite that moved moves back, except sprites of these types.
    Undo(Box<[SpriteType]>),
    /// The first sprite changes its orientation.
    Turn,
    /// The first sprite is pushed along by the second.
    Push,
    /// The first sprite is carried along by the second, or moved to its position.
    Carry,
    /// The first sprite reappears at the exit of the second one.
    Teleport,
    /// The first sprite reappears at the opposite edge.
    Wrap,
    /// Sprites of this type and its relatives, or the first sprite alone, change their speed.
    Speed(Option<SpriteType>),
    /// A sprite of this type appears.
    Make(SpriteType),
    /// Another sprite like the first appears.
    Clone,
    /// The second sprite takes the first one as a resource: as many as the first one's `value`, up to its limit.
    Collect,
    /// The sprite of that side gains (or loses) this amount of a resource.
    Change {
        /// The side whose resources change.
        side: Side,
        /// The resource.
        resource: SpriteType,
        /// The change in the amount.
        by: i32,
    },
    /// Health points change, and a sprite with too few of them dies.
    Health {
        /// The type whose sprites are affected; none: the first sprite.
        of: Option<SpriteType>,
        /// The change in health points.
        by: i32,
        /// The number of health points at or below which it dies.
        dies_at: i32,
    },
    /// For the rest of the tick, interactions of one keyword with sprites of this type do not affect the first sprite's
    /// type.
    Shield {
        /// The shielded-off partner.
        from: SpriteType,
        /// The suppressed keyword, as in VGDL.
        keyword: &'static str,
    },
}

/// The sprites that an effect changes, out of all sprites of a level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Target {
    /// The sprite of that side.
    Side(Side),
    /// Every sprite of exactly this type.
    All(SpriteType),
    /// A sprite, or every sprite, of this type and its relatives; of a type without sprites, it may be the first sprite.
    Tree(SpriteType),
}

/// The way in which an effect takes sprites away from their type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ending {
    /// They are removed.
    Killed,
    /// They turn into others.
    Turned,
    /// They are removed where there is no exit for them.
    Stranded,
    /// Their health points change by `by`, and they are removed if `dies_at` or fewer are left.
    Health { by: i32, dies_at: i32 },
}

/// The move that an effect makes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Movement<'a> {
    /// The first sprite moves back to its previous position.
    Back,
    /// Every sprite moves back, except sprites of these types.
    AllBack(&'a [SpriteType]),
    /// The first sprite moves along with the second, or to another place.
    Away,
}

/// The properties of an effect that others ask for: the one match over all effects.
#[derive(Clone, Copy, Default)]
struct Properties<'a> {
    /// The sprites that it changes, if it changes any.
    target: Option<Target>,
    ending: Option<Ending>,
    movement: Option<Movement<'a>>,
    makes: &'a [SpriteType],
    /// The type that must exist, or be held, for the effect to happen.
    names: Option<SpriteType>,
}

impl EffectSummary {
    fn properties(&self) -> Properties<'_> {
        use EffectSummary as E;
        let none = Properties::default();
        let first = Properties { target: Some(Target::Side(Side::First)), ..none };
        let of_tree = |of: Option<SpriteType>| of.map_or(first.target, |of| Some(Target::Tree(of)));
        let moved = |movement| Properties { movement: Some(movement), ..first };
        match self {
            E::Kill(side) => {
                Properties { target: Some(Target::Side(*side)), ending: Some(Ending::Killed), ..none }
            }
            E::KillAll(of) => {
                Properties { target: Some(Target::All(*of)), ending: Some(Ending::Killed), ..none }
            }
            E::Become(to) => Properties {
                ending: Some(Ending::Turned),
                makes: std::slice::from_ref(to),
                names: Some(*to),
                ..first
            },
            E::BecomeAny(options) => Properties { ending: Some(Ending::Turned), makes: options, ..first },
            E::BecomeAll(of, to) => Properties {
                target: Some(Target::All(*of)),
                ending: Some(Ending::Turned),
                makes: std::slice::from_ref(to),
                ..none
            },
            E::Stop => moved(Movement::Back),
            E::Undo(spare) => Properties { movement: Some(Movement::AllBack(spare)), ..none },
            E::Push | E::Carry | E::Wrap => moved(Movement::Away),
            E::Teleport => Properties { ending: Some(Ending::Stranded), ..moved(Movement::Away) },
            E::Turn => first,
            E::Speed(of) => Properties { target: of_tree(*of), ..none },
            E::Make(to) => Properties { makes: std::slice::from_ref(to), names: Some(*to), ..none },
            E::Collect => Properties { target: Some(Target::Side(Side::Second)), ..none },
            E::Change { side, resource, .. } => {
                Properties { target: Some(Target::Side(*side)), names: Some(*resource), ..none }
            }
            E::Health { of, by, dies_at } => Properties {
                target: of_tree(*of),
                ending: Some(Ending::Health { by: *by, dies_at: *dies_at }),
                names: *of,
                ..none
            },
            E::Clone | E::Shield { .. } => none,
        }
    }

    /// Returns the types of which a sprite appears, or another sprite becomes one; without [`EffectSummary::Clone`]'s,
    /// which is the first sprite's.
    pub(crate) fn makes(&self) -> &[SpriteType] {
        self.properties().makes
    }

    /// Returns `true` if that type has to exist for it to happen, or to be held.
    pub(crate) fn names(&self, stype: SpriteType) -> bool {
        self.properties().names == Some(stype)
    }

    /// Returns the type that it concerns all sprites of, if it needs none in particular.
    pub(crate) fn at_large(&self) -> Option<SpriteType> {
        match self.properties().target? {
            Target::All(of) | Target::Tree(of) => Some(of),
            Target::Side(_) => None,
        }
    }

    /// Returns the sprites that it may remove or turn into others, and the way in which it does so.
    pub(crate) fn ending(&self) -> Option<(Target, Ending)> {
        let Properties { target, ending, .. } = self.properties();
        target.zip(ending)
    }

    /// Returns the move that it makes.
    pub(crate) fn movement(&self) -> Option<Movement<'_>> {
        self.properties().movement
    }

    /// Returns `true` if it changes the sprite of that side, whatever its type.
    pub(crate) fn changes(&self, side: Side) -> bool {
        self.properties().target == Some(Target::Side(side))
    }

    /// Returns `true` if it moves a sprite of that type, which is on that side, back to its previous position.
    pub fn puts_back(&self, side: Side, stype: SpriteType) -> bool {
        match self.movement() {
            Some(Movement::Back) => side == Side::First,
            Some(Movement::AllBack(spare)) => !spare.contains(&stype),
            Some(Movement::Away) | None => false,
        }
    }
}
