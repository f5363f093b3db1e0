//! One role for every sprite type: what it is for in a level.

use super::encounter::{Deed, Encounter, Side};
use super::facts::{Avatar, Facts, Motion, is_certain};
use super::goal::Aims;
use super::lock::{Fate, Lock, Pushable, Touches};
use super::touch::{Harm, Removal};
use crate::game::{Rules, SpriteType};
use crate::ontology::class::SpriteClass;

/// What a sprite type is for in a level. Where several fit, the first one in this order counts, with the exceptions
/// that the variants state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// The player can control it.
    Avatar,
    /// An avatar makes it by the use key: a shot, a sword, a bomb.
    Shot,
    /// Touching it takes the avatar to a [`Role::PortalExit`].
    Portal,
    /// Where a portal leads.
    PortalExit,
    /// The avatar pushes it.
    Pushable,
    /// Touching it wins, or counts towards a win: a door, something locked, or what makes the winning sprite.
    /// (Goods that lie open and count towards a win are [`Role::Collectable`].)
    Exit,
    /// Still, and until something is held, done or become it blocks the way or hurts.
    Gate,
    /// It moves by itself, blocks the avatar, and kills only in some ways of moving: a falling rock.
    Boulder,
    /// It moves by itself and harms the avatar or what must be protected, takes what the avatar holds, or makes what does
    /// so. (What the avatar catches for a win, unharmed, is [`Role::Prey`] all the same.)
    Enemy,
    /// Still; pushed things end on it, and either that is wanted or it is harmless. (What is deadly and wanted by no
    /// goal is [`Role::Hazard`].)
    Socket,
    /// Still, and it harms the avatar.
    Hazard,
    /// Still, and it makes other sprites by itself.
    Spawner,
    /// Its loss loses the game, or what moves must not reach it.
    Ward,
    /// It must go for a win, and goes by a shot, by others, or by being caught while it moves.
    Prey,
    /// Its touch gives what a gate or an exit needs.
    Key,
    /// Still; the avatar digs through it for no gain, while it holds up others.
    Soil,
    /// The avatar takes it, or changes it, by touch.
    Collectable,
    /// Still; it blocks the avatar until a shot, or an enemy, removes it.
    Breakable,
    /// Still; it blocks the avatar always, and nothing removes it.
    Wall,
    /// Still; shots end on it or remove it, and it does nothing to the avatar.
    Cover,
    /// Still; it holds up enemies and lets the avatar pass.
    Refuge,
    /// Still, and nothing happens between it and any avatar: what lies under the others. It is in no interaction at
    /// all, or a character places it together with an avatar.
    Floor,
    /// None of these.
    Neutral,
}

/// What the roles are derived from.
pub(super) struct Basis<'a> {
    pub(super) rules: &'a Rules,
    pub(super) encounters: &'a [Encounter],
    pub(super) facts: &'a [Facts],
    pub(super) avatars: &'a [Avatar],
    pub(super) aims: &'a Aims,
    pub(super) touches: &'a Touches,
    pub(super) pushables: &'a [Pushable],
    pub(super) locks: &'a [Lock],
    /// By type: what contact with it does to some avatar, at worst.
    pub(super) harm: &'a [Harm],
    /// By type: others end what must be protected, or make what must not appear, when they meet it.
    pub(super) threat: &'a [bool],
    /// By type: it makes, by itself and perhaps in several steps, what harms the avatar or a goal.
    pub(super) source: &'a [bool],
}

impl Basis<'_> {
    /// The role of a type. Cost: O(avatars + encounters).
    pub(super) fn role(&self, stype: SpriteType) -> Role {
        let at = stype.index();
        let fact = &self.facts[at];
        let still = fact.motion == Motion::Still;
        let touches = || self.touches.iter().map(|row| &row[at]);
        let wanted = self.aims.remove.contains(&stype);
        let lock = self.locks.iter().find(|lock| lock.stype == stype);
        if self.avatars.iter().any(|avatar| avatar.stype == stype) || fact.motion == Motion::Steered {
            return Role::Avatar;
        }
        if self.is_shot(stype) {
            return Role::Shot;
        }
        if touches().any(|touch| touch.teleports) {
            return Role::Portal;
        }
        if self.is_portal_exit(stype) {
            return Role::PortalExit;
        }
        if self.pushables.iter().any(|pushable| pushable.stype == stype) {
            return Role::Pushable;
        }
        if still && self.is_exit(stype, lock.is_some()) {
            return Role::Exit;
        }
        let makes = !fact.makes.is_empty();
        if still && lock.is_some_and(|lock| lock.guards) && !fact.is_resource && !makes {
            return Role::Gate;
        }
        let harm = self.harm[at];
        let blocks = touches().any(|touch| touch.blocks);
        if !still && harm == Harm::Conditional && blocks && matches!(fact.motion, Motion::Straight(_)) {
            return Role::Boulder;
        }
        let takes = touches().any(|touch| touch.gives.iter().any(|&(_, by)| by < 0));
        let caught = wanted && harm == Harm::None && touches().any(|touch| touch.removal == Removal::Always);
        let hostile = harm != Harm::None || self.source[at] || self.threat[at] || takes;
        if !still && hostile && !caught {
            return Role::Enemy;
        }
        if still && self.is_socket(stype, harm) && !self.beside_avatar(stype) {
            return Role::Socket;
        }
        if still && harm != Harm::None {
            return Role::Hazard;
        }
        let class = self.rules.types[at].class;
        if still && class.is_some_and(|c| c.is_a(SpriteClass::SpawnPoint) || c == SpriteClass::Spreader) {
            return Role::Spawner;
        }
        if self.aims.protect.contains(&stype) {
            return Role::Ward;
        }
        let gain = touches().any(|touch| touch.removal != Removal::Never || touch.changes.is_some());
        if wanted && (!still || !gain) {
            return Role::Prey;
        }
        let opens = |lock: &Lock| lock.givers.iter().any(|(giver, _)| *giver == stype);
        if self.locks.iter().any(opens) {
            return Role::Key;
        }
        let taken = gain || touches().any(|touch| touch.gives.iter().any(|&(_, by)| by > 0));
        if still && !wanted && taken && !fact.is_resource && self.is_soil(stype) {
            return Role::Soil;
        }
        if taken {
            return Role::Collectable;
        }
        if still && blocks {
            return if self.is_breakable(stype) { Role::Breakable } else { Role::Wall };
        }
        if still && self.is_spoilt(stype) && !self.beside_avatar(stype) {
            return Role::Ward;
        }
        if still && self.meets_shots(stype) && !self.beside_avatar(stype) {
            return Role::Cover;
        }
        if still && self.holds_up_enemies(stype) {
            return Role::Refuge;
        }
        let touched = touches().any(|touch| touch.any && *touch != neutral_touch());
        if still && !touched && self.lies_under(stype) {
            return Role::Floor;
        }
        Role::Neutral
    }

    fn is(&self, stype: SpriteType, written: SpriteType) -> bool {
        self.rules.types[written.index()].in_tree(stype)
    }

    fn is_shot(&self, stype: SpriteType) -> bool {
        self.avatars.iter().any(|avatar| avatar.shots.contains(&stype))
    }

    fn is_portal_exit(&self, stype: SpriteType) -> bool {
        let types = (0u16..).map(SpriteType).zip(self.facts).filter(|(_, fact)| fact.possible);
        types.map(|(portal, _)| portal).any(|portal| {
            self.rules.types[portal.index()].leads_to() == Some(stype)
                && self.touches.iter().any(|row| row[portal.index()].teleports)
        })
    }

    fn is_exit(&self, stype: SpriteType, locked: bool) -> bool {
        let at = stype.index();
        let traits = &self.rules.types[at].traits;
        let creates = |row: &Vec<super::Touch>| {
            let touch = &row[at];
            touch.makes.iter().any(|made| self.aims.create.contains(made))
                || touch.changes.is_some_and(|to| self.aims.create.contains(&to))
        };
        let ends = self.touches.iter().any(|row| row[at].ends_other());
        let door = traits.portal || self.rules.types[at].class == Some(SpriteClass::Door);
        let wanted = self.aims.remove.contains(&stype);
        (wanted && (locked || (ends && door)) && !self.facts[at].is_resource)
            || self.touches.iter().any(creates)
    }

    /// Pushed things end on it, and that is wanted, uses it up, or hurts nobody.
    fn is_socket(&self, stype: SpriteType, harm: Harm) -> bool {
        self.pushables.iter().any(|pushable| {
            let Some(sink) = pushable.sinks.iter().find(|sink| sink.partner == stype) else { return false };
            let asked = [pushable.stype, stype].iter().any(|stype| self.aims.remove.contains(stype));
            let made = matches!(sink.fate, Fate::Becomes(to) if self.aims.create.contains(&to));
            let harmless = harm == Harm::None && self.touches.iter().all(|row| !row[stype.index()].blocks);
            asked || made || sink.fills || !sink.opens.is_empty() || harmless
        })
    }

    /// Worth nothing to the avatar, in the way of something else.
    fn is_soil(&self, stype: SpriteType) -> bool {
        let worthless = self.touches.iter().all(|row| {
            let touch = &row[stype.index()];
            touch.score == 0 && touch.makes.is_empty() && touch.gives.is_empty() && touch.changes.is_none()
        });
        worthless
            && self.encounters.iter().any(|encounter| {
                let avatar = self.avatars.iter().any(|avatar| self.is(avatar.stype, encounter.first));
                encounter.blocks() && !avatar && encounter.second.is_some_and(|second| self.is(stype, second))
            })
    }

    fn is_breakable(&self, stype: SpriteType) -> bool {
        self.encounters.iter().any(|encounter| {
            let Some(second) = encounter.second else { return false };
            let by_other = |other: SpriteType| {
                let tree = self.rules.types[other.index()].tree.iter();
                tree.clone().any(|&other| self.is_shot(other) || self.harm[other.index()] != Harm::None)
            };
            is_certain(encounter)
                && ((self.is(stype, encounter.first) && encounter.ends(Side::First) && by_other(second))
                    || (self.is(stype, second) && encounter.ends(Side::Second) && by_other(encounter.first)))
        })
    }

    /// What moves makes, on meeting it, what must not appear.
    fn is_spoilt(&self, stype: SpriteType) -> bool {
        self.encounters.iter().any(|encounter| {
            let spoils = encounter.does(|deed| match deed {
                Deed::Become(to) | Deed::Make(to) => self.aims.prevent.contains(to),
                _ => false,
            });
            spoils && encounter.second.is_some_and(|second| self.is(stype, second))
        })
    }

    fn holds_up_enemies(&self, stype: SpriteType) -> bool {
        self.encounters.iter().any(|encounter| {
            let hostile = |other: &SpriteType| {
                let at = other.index();
                self.facts[at].motion != Motion::Still
                    && self.facts[at].possible
                    && (self.harm[at] != Harm::None || self.source[at] || self.threat[at])
            };
            encounter.blocks()
                && encounter.second.is_some_and(|second| self.is(stype, second))
                && self.rules.types[encounter.first.index()].tree.iter().any(hostile)
                && self.touches.iter().all(|row| !row[stype.index()].blocks)
                && !self.beside_avatar(stype)
        })
    }

    /// A character places it together with an avatar.
    fn beside_avatar(&self, stype: SpriteType) -> bool {
        let is_avatar = |other: &SpriteType| self.avatars.iter().any(|avatar| avatar.stype == *other);
        let symbols = self.facts[stype.index()].symbols.iter();
        symbols
            .map(|&symbol| &self.rules.mapping[usize::from(symbol)])
            .any(|types| types.iter().any(is_avatar))
    }

    fn lies_under(&self, stype: SpriteType) -> bool {
        let takes_part = |encounter: &Encounter| {
            self.is(stype, encounter.first) || encounter.second.is_some_and(|second| self.is(stype, second))
        };
        self.beside_avatar(stype) || !self.encounters.iter().any(takes_part)
    }

    /// Shots, the avatar's or others', end on it, or it ends by them.
    fn meets_shots(&self, stype: SpriteType) -> bool {
        let shot = |other: SpriteType| {
            let straight = matches!(self.facts[other.index()].motion, Motion::Straight(_));
            let made = |maker: &Facts| maker.possible && maker.makes.contains(&other);
            self.is_shot(other) || (straight && self.facts.iter().any(made))
        };
        let flies = |other: SpriteType| self.rules.types[other.index()].tree.iter().any(|&other| shot(other));
        self.encounters.iter().any(|encounter| {
            let Some(second) = encounter.second else { return false };
            let ends = encounter.ends(Side::First) || encounter.ends(Side::Second);
            ends && ((self.is(stype, encounter.first) && flies(second))
                || (self.is(stype, second) && flies(encounter.first)))
        })
    }
}

/// Whether others end what must be protected, or make what must not appear, when they meet a type. Of two, the one that
/// moves is to blame; of two that move, the second.
pub(super) fn is_threat(
    rules: &Rules,
    encounters: &[Encounter],
    facts: &[Facts],
    aims: &Aims,
    stype: SpriteType,
) -> bool {
    let is = |stype: SpriteType, written: SpriteType| rules.types[written.index()].in_tree(stype);
    let moving = |written: SpriteType| {
        rules.types[written.index()].tree.iter().any(|stype| facts[stype.index()].motion != Motion::Still)
    };
    let guarded = |written: SpriteType| aims.protect.iter().any(|&ward| is(ward, written));
    encounters.iter().any(|encounter| {
        let Some(second) = encounter.second else { return false };
        let (one, two) = (is(stype, encounter.first), is(stype, second));
        let spoils = encounter.does(|deed| match deed {
            Deed::Become(to) | Deed::Make(to) => aims.prevent.contains(to),
            _ => false,
        });
        let blamed = if two { moving(second) } else { one && !moving(second) };
        (two && encounter.ends(Side::First) && guarded(encounter.first))
            || (one && encounter.ends(Side::Second) && guarded(second))
            || (spoils && blamed)
    })
}

/// A touch of which the avatar notices nothing.
fn neutral_touch() -> super::Touch {
    super::Touch { any: true, ..super::Touch::default() }
}
