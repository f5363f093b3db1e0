//! The role of every sprite type in a level; each type has exactly one.

use super::facts::Motion;
use super::marks::Marks;
use crate::analysis::Analysis;
use crate::analysis::interactions::lock::{Fate, Lock};
use crate::analysis::interactions::touch::{Harm, Removal, Touch};
use crate::rules::SpriteType;
use crate::rules::class::SpriteClass;

/// The role of a sprite type in a level. If several fit, the first one in this order counts, with the exceptions stated
/// at the variants.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// The player can control it.
    Avatar,
    /// An avatar makes it with the use key: a shot, a sword, a bomb.
    Shot,
    /// Touching it takes the avatar to a [`Role::PortalExit`].
    Portal,
    /// The destination of a portal.
    PortalExit,
    /// The avatar pushes it.
    Pushable,
    /// Touching it wins, or counts towards a win: a door, something locked, or something that makes the winning sprite.
    /// (Unlocked items that count towards a win are [`Role::Collectable`].)
    Exit,
    /// Still; it blocks the way or hurts until the avatar holds something, does something or changes its type.
    Gate,
    /// It moves by itself, blocks the avatar, and kills only in some ways of moving: for example, a falling rock.
    Boulder,
    /// It moves by itself and harms the avatar or a protected type, takes the avatar's resources, or makes sprites that
    /// do. (A type that the avatar catches unharmed for a win is [`Role::Prey`] nevertheless.)
    Enemy,
    /// Still; pushed sprites are removed by it, and either a goal requires that or it is harmless. (A deadly type that
    /// no goal requires is [`Role::Hazard`].)
    Socket,
    /// Still, and it harms the avatar.
    Hazard,
    /// Still, and it makes other sprites by itself.
    Spawner,
    /// Its loss loses the game, or moving sprites must not reach it.
    Ward,
    /// It must be removed for a win: by a shot, by others, or by being caught while it moves.
    Prey,
    /// Touching it gives the requirement of a gate or an exit.
    Key,
    /// Still; the avatar digs through it without gain, and it blocks others.
    Soil,
    /// The avatar takes it, or changes it, by touching it.
    Collectable,
    /// Still; it blocks the avatar until a shot, or an enemy, removes it.
    Breakable,
    /// Still; it always blocks the avatar, and nothing removes it.
    Wall,
    /// Still; shots are stopped by it or remove it, and it does nothing to the avatar.
    Cover,
    /// Still; it blocks enemies and lets the avatar pass.
    Refuge,
    /// Still, and no interaction with any avatar: a background under the others. It is in no interaction at all, or a
    /// character places it together with an avatar.
    Floor,
    /// None of these.
    Neutral,
}

impl Analysis {
    /// Derives the role of a type with these marks from the other parts of the analysis. Cost: O(types × avatars).
    pub(crate) fn role_with(&self, stype: SpriteType, marks: Marks) -> Role {
        let at = stype.index();
        let fact = &self.facts[at];
        let still = fact.motion == Motion::Still;
        let touches = || self.touches.iter().map(|row| &row[at]);
        let wanted = self.aims.remove.contains(&stype);
        let lock = self.locks.iter().find(|lock| lock.stype == stype);
        if self.avatars.iter().any(|avatar| avatar.stype == stype) || fact.motion == Motion::Steered {
            return Role::Avatar;
        }
        if self.avatars.iter().any(|avatar| avatar.shots.contains(&stype)) {
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
        let harm = self.harm(stype);
        let blocks = touches().any(|touch| touch.blocks);
        if !still && harm == Harm::Conditional && blocks && matches!(fact.motion, Motion::Straight(_)) {
            return Role::Boulder;
        }
        let takes = touches().any(|touch| touch.gives.iter().any(|&(_, by)| by < 0));
        let caught = wanted && harm == Harm::None && touches().any(|touch| touch.removal == Removal::Always);
        let hostile = harm != Harm::None || self.source[at] || marks.threat || takes;
        if !still && hostile && !caught {
            return Role::Enemy;
        }
        if still && self.is_socket(stype, harm) && !self.beside_avatar(stype) {
            return Role::Socket;
        }
        if still && harm != Harm::None {
            return Role::Hazard;
        }
        let class = self.game.class(stype);
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
        if still && !wanted && taken && !fact.is_resource && marks.holds_up && self.is_worthless(stype) {
            return Role::Soil;
        }
        if taken {
            return Role::Collectable;
        }
        if still && blocks {
            return if marks.breakable { Role::Breakable } else { Role::Wall };
        }
        if still && marks.spoilt && !self.beside_avatar(stype) {
            return Role::Ward;
        }
        if still && marks.meets_shots && !self.beside_avatar(stype) {
            return Role::Cover;
        }
        if still && marks.holds_up_enemies && self.is_refuge(stype) {
            return Role::Refuge;
        }
        let without_effect = Touch { any: true, ..Touch::default() };
        let touched = touches().any(|touch| touch.any && *touch != without_effect);
        if still && !touched && (self.beside_avatar(stype) || !marks.takes_part) {
            return Role::Floor;
        }
        Role::Neutral
    }

    fn is_portal_exit(&self, stype: SpriteType) -> bool {
        let types = (0u16..).map(SpriteType).zip(&self.facts).filter(|(_, fact)| fact.possible);
        types.map(|(portal, _)| portal).any(|portal| {
            self.game.0.types[portal.index()].leads_to() == Some(stype)
                && self.touches.iter().any(|row| row[portal.index()].teleports)
        })
    }

    fn is_exit(&self, stype: SpriteType, locked: bool) -> bool {
        let at = stype.index();
        let traits = &self.game.0.types[at].traits;
        let creates = |row: &Vec<Touch>| {
            let touch = &row[at];
            touch.makes.iter().any(|made| self.aims.create.contains(made))
                || touch.changes.is_some_and(|to| self.aims.create.contains(&to))
        };
        let ends = self.touches.iter().any(|row| row[at].ends_other());
        let door = traits.portal || self.game.class(stype) == Some(SpriteClass::Door);
        let wanted = self.aims.remove.contains(&stype);
        (wanted && (locked || (ends && door)) && !self.facts[at].is_resource)
            || self.touches.iter().any(creates)
    }

    /// Returns `true` if pushed sprites are removed by it, and that is required, uses it up, or hurts nobody.
    fn is_socket(&self, stype: SpriteType, harm: Harm) -> bool {
        self.pushables.iter().any(|pushable| {
            let Some(sink) = pushable.sinks.iter().find(|sink| sink.partner == stype) else { return false };
            let asked = [pushable.stype, stype].iter().any(|stype| self.aims.remove.contains(stype));
            let made = matches!(sink.fate, Fate::Becomes(to) if self.aims.create.contains(&to));
            let harmless = harm == Harm::None && self.touches.iter().all(|row| !row[stype.index()].blocks);
            // What only play makes, a flood, say, is dammed and not filled.
            let fills = sink.fills && (harm == Harm::None || !self.facts[stype.index()].symbols.is_empty());
            asked || made || fills || !sink.opens.is_empty() || harmless
        })
    }

    /// Returns `true` if it is worth nothing to the avatar.
    fn is_worthless(&self, stype: SpriteType) -> bool {
        self.touches.iter().all(|row| {
            let touch = &row[stype.index()];
            touch.score == 0 && touch.makes.is_empty() && touch.gives.is_empty() && touch.changes.is_none()
        })
    }

    fn is_refuge(&self, stype: SpriteType) -> bool {
        self.touches.iter().all(|row| !row[stype.index()].blocks) && !self.beside_avatar(stype)
    }

    /// Returns `true` if a character places it together with an avatar.
    fn beside_avatar(&self, stype: SpriteType) -> bool {
        let is_avatar = |other: &SpriteType| self.avatars.iter().any(|avatar| avatar.stype == *other);
        let symbols = self.facts[stype.index()].symbols.iter();
        symbols
            .map(|&symbol| &self.game.0.mapping[usize::from(symbol)])
            .any(|types| types.iter().any(is_avatar))
    }
}
