//! A single consequence of an effect, as plain data, with the properties that analyses need.

use crate::rules::SpriteType;

/// One side of an interaction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The sprite named first, on which the effect acts.
    First,
    /// The first sprite's partner.
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

/// A single consequence of an interaction.
#[derive(Clone, Debug, PartialEq)]
pub enum EffectSummary {
    /// The sprite on the given side is removed.
    Kill(Side),
    /// Every sprite of exactly this type is removed.
    KillAll(SpriteType),
    /// The first sprite turns into a sprite of this type.
    Become(SpriteType),
    /// The first sprite turns into a sprite of one of these types, chosen at random.
    BecomeAny(Box<[SpriteType]>),
    /// Every sprite of exactly the first type turns into a sprite of the second type.
    BecomeAll(SpriteType, SpriteType),
    /// The first sprite moves back to its previous position, because the second sprite blocks it.
    Stop,
    /// Every sprite that has moved moves back, except sprites of these types.
    Undo(Box<[SpriteType]>),
    /// The first sprite changes its orientation.
    Turn,
    /// The second sprite pushes the first sprite.
    Push,
    /// The second sprite carries the first sprite along, or the first sprite moves to the second sprite's
    /// position.
    Carry,
    /// The first sprite reappears at the exit to which the second sprite leads.
    Teleport,
    /// The first sprite reappears at the opposite edge.
    Wrap,
    /// The speed of all sprites of this type and of related types in the SpriteSet changes. If the type is `None`, only
    /// the first sprite's speed changes.
    Speed(Option<SpriteType>),
    /// A sprite of this type appears.
    Make(SpriteType),
    /// Another sprite of the first sprite's type appears.
    Clone,
    /// The second sprite collects the first sprite as a resource, and gains its `value`, up to the limit.
    Collect,
    /// The sprite on the given side gains (or loses) this amount of a resource.
    Change {
        /// The side whose resources change.
        side: Side,
        /// The resource.
        resource: SpriteType,
        /// The change in the amount.
        by: i32,
    },
    /// Health points change, and a sprite with too few health points is removed.
    Health {
        /// The type whose sprites are affected, or `None` for the first sprite.
        of: Option<SpriteType>,
        /// The change in health points.
        by: i32,
        /// A sprite is removed if its health points fall to this number or below.
        dies_at: i32,
    },
    /// For the rest of the tick, the first sprite's type is shielded: interactions with the given keyword
    /// between that type and the type `from` have no effect on it.
    Shield {
        /// The partner type whose interactions are suppressed.
        from: SpriteType,
        /// The VGDL keyword of the suppressed effect.
        keyword: &'static str,
    },
}

/// The sprites that an effect changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Target {
    /// The sprite on the given side.
    Side(Side),
    /// Every sprite of exactly this type.
    All(SpriteType),
    /// Either one sprite or every sprite of this type or a related type. If there are no such sprites, the
    /// first sprite may be the target instead.
    Tree(SpriteType),
}

/// The way in which an effect removes sprites from their type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ending {
    /// The sprites are removed.
    Killed,
    /// The sprites turn into sprites of other types.
    Turned,
    /// The sprites are removed if they have no exit.
    Stranded,
    /// The sprites' health points change by `by`, and sprites with at most `dies_at` points left are removed.
    Health { by: i32, dies_at: i32 },
}

/// A move caused by an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Movement<'a> {
    /// The first sprite moves back to its previous position.
    Back,
    /// Every sprite moves back, except sprites of these types.
    AllBack(&'a [SpriteType]),
    /// The first sprite moves along with the second sprite, or to another position.
    Away,
}

/// The properties of an effect, determined by a single match over all effects.
#[derive(Clone, Copy, Default)]
struct Properties<'a> {
    /// The sprites that the effect changes, if any.
    target: Option<Target>,
    ending: Option<Ending>,
    movement: Option<Movement<'a>>,
    makes: &'a [SpriteType],
    /// The type that must exist or be held for the effect to happen; `None` if the effect needs no type.
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

    /// Returns the types of the sprites that appear, and the types that other sprites turn into.
    /// [`EffectSummary::Clone`], which creates a sprite of the first sprite's type, is not included.
    pub(crate) fn makes(&self) -> &[SpriteType] {
        self.properties().makes
    }

    /// Returns `true` if sprites of the given type must exist or be held for the effect to happen.
    pub(crate) fn names(&self, stype: SpriteType) -> bool {
        self.properties().names == Some(stype)
    }

    /// Returns the type whose sprites are all affected, if the effect does not run on a particular sprite.
    pub(crate) fn at_large(&self) -> Option<SpriteType> {
        match self.properties().target? {
            Target::All(of) | Target::Tree(of) => Some(of),
            Target::Side(_) => None,
        }
    }

    /// Returns the sprites that the effect may remove or turn into other sprites, and the way in which it does so;
    /// `None` for any other effect.
    pub(crate) fn ending(&self) -> Option<(Target, Ending)> {
        let Properties { target, ending, .. } = self.properties();
        target.zip(ending)
    }

    /// Returns the move caused by the effect; `None` if it causes no move.
    pub(crate) fn movement(&self) -> Option<Movement<'_>> {
        self.properties().movement
    }

    /// Returns `true` if the effect changes the sprite on `side`, regardless of its type.
    pub(crate) fn changes(&self, side: Side) -> bool {
        self.properties().target == Some(Target::Side(side))
    }

    /// Returns `true` if the effect moves a sprite of type `stype` on `side` back to its previous position.
    pub fn puts_back(&self, side: Side, stype: SpriteType) -> bool {
        match self.movement() {
            Some(Movement::Back) => side == Side::First,
            Some(Movement::AllBack(spare)) => !spare.contains(&stype),
            Some(Movement::Away) | None => false,
        }
    }
}
