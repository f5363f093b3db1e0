//! The role of every sprite type in a level. Each type has exactly one role.

use super::facts::Motion;
use super::marks::Marks;
use crate::analysis::Analysis;
use crate::analysis::interactions::lock::{Fate, Lock};
use crate::analysis::interactions::touch::{Harm, Removal, Touch};
use crate::rules::SpriteType;
use crate::rules::class::SpriteClass;

/// A sprite type's role in a level. If several roles fit, the first role in this order applies, with the
/// exceptions documented on the variants.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// A type that the player can control.
    Avatar,
    /// A type that an avatar creates with the use key: a shot, a sword, a bomb.
    Shot,
    /// A type that takes the avatar to a [`Role::PortalExit`] on contact.
    Portal,
    /// The destination of a portal.
    PortalExit,
    /// A type that the avatar pushes.
    Pushable,
    /// A type that, on contact, wins or counts towards a win: a door, something locked, or something that
    /// creates the winning sprite. Unlocked items that count towards a win are [`Role::Collectable`].
    Exit,
    /// A motionless type that blocks or harms the avatar until the avatar holds something, does something or
    /// changes type.
    Gate,
    /// A type, such as a falling rock, that moves on its own, blocks the avatar, and kills only when it moves
    /// in certain ways.
    Boulder,
    /// A type that moves by itself and harms the avatar or a protected type, takes the avatar's resources, or
    /// creates sprites with any of these properties. However, a type that the avatar catches unharmed for a
    /// win is [`Role::Prey`].
    Enemy,
    /// A motionless type that removes pushed sprites, if a goal requires the removal or the type is harmless.
    /// A deadly type that no goal requires is [`Role::Hazard`].
    Socket,
    /// A motionless type that harms the avatar.
    Hazard,
    /// A motionless type that creates other sprites by itself.
    Spawner,
    /// A type whose disappearance loses the game, or from which moving sprites must be kept away.
    Ward,
    /// A type that must be removed for a win: by a shot, by other sprites, or by the avatar's touch while the
    /// sprite moves.
    Prey,
    /// A type that, on contact, gives the key to a gate or an exit.
    Key,
    /// A motionless type that the avatar digs through without gain, and that blocks other sprites.
    Soil,
    /// A type that the avatar takes or changes by touch.
    Collectable,
    /// A motionless type that blocks the avatar until a shot or an enemy removes it.
    Breakable,
    /// A permanent motionless type that always blocks the avatar.
    Wall,
    /// A motionless type that stops shots or is removed by shots, and has no effect on the avatar.
    Cover,
    /// A motionless type that blocks enemies and lets the avatar pass.
    Refuge,
    /// A motionless type without interactions with any avatar, drawn as a background. It either takes part in
    /// no interaction at all, or a level character places it together with an avatar.
    Floor,
    /// A type that fits no other role.
    Neutral,
}

impl Analysis {
    /// Derives a type's role from its flags ([`Marks`]) and the other parts of the analysis. Cost: O(types × avatars).
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

    /// Returns `true` if pushing a sprite onto the type contributes to a win, fills the type, or opens a
    /// different type. For a type that neither harms nor blocks the avatar, any effect of the push suffices.
    fn is_socket(&self, stype: SpriteType, harm: Harm) -> bool {
        self.pushables.iter().any(|pushable| {
            let Some(sink) = pushable.sinks.iter().find(|sink| sink.partner == stype) else { return false };
            let asked = [pushable.stype, stype].iter().any(|stype| self.aims.remove.contains(stype));
            let made = matches!(sink.fate, Fate::Becomes(to) if self.aims.create.contains(&to));
            let harmless = harm == Harm::None && self.touches.iter().all(|row| !row[stype.index()].blocks);
            // A type that levels do not place, such as a flood, is dammed rather than filled.
            let fills = sink.fills && (harm == Harm::None || !self.facts[stype.index()].symbols.is_empty());
            asked || made || fills || !sink.opens.is_empty() || harmless
        })
    }

    /// Returns `true` if touching the type gives the avatar nothing.
    fn is_worthless(&self, stype: SpriteType) -> bool {
        self.touches.iter().all(|row| {
            let touch = &row[stype.index()];
            touch.score == 0 && touch.makes.is_empty() && touch.gives.is_empty() && touch.changes.is_none()
        })
    }

    fn is_refuge(&self, stype: SpriteType) -> bool {
        self.touches.iter().all(|row| !row[stype.index()].blocks) && !self.beside_avatar(stype)
    }

    /// Returns `true` if a level character places the type together with an avatar.
    fn beside_avatar(&self, stype: SpriteType) -> bool {
        let is_avatar = |other: &SpriteType| self.avatars.iter().any(|avatar| avatar.stype == *other);
        let symbols = self.facts[stype.index()].symbols.iter();
        symbols
            .map(|&symbol| &self.game.0.mapping[usize::from(symbol)])
            .any(|types| types.iter().any(is_avatar))
    }
}
