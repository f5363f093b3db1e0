//! The meanings of a board's characters. Each game has one table for all its levels, states and episodes.

use crate::direction::direction_name;
use base::Seed;
use engine::analysis::{EffectSummary, Encounter, Motion, Role};
use engine::{Analysis, SpriteClass, SpriteType};
use render::{EMPTY, Glyph, Looks, Symbols};
use std::collections::BTreeMap;

/// The character for the avatar in all of its states.
pub const AVATAR: char = '@';

/// The characters from which shuffled symbols are drawn.
const POOL: &str = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";

/// The characters for types whose names contain no unused letter.
const SPARE: &str = "+*%&$=~^?!:;|/abcdefghijklmnopqrstuvwxyz0123456789";

/// The options for assigning characters to sprite types.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LegendOptions {
    /// `true` if each avatar state has its own character instead of [`AVATAR`], so that the player must track
    /// the avatar's current character.
    pub tracking: bool,
    /// The number of the random table that replaces all characters with letters and digits, so that no
    /// character is meaningful by itself. `None` keeps the original characters.
    pub shuffled: Option<u64>,
}

/// The role of a sprite type on the board, from the player's point of view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EntryRole {
    /// The sprite that the player controls.
    Avatar,
    /// A type that is a permanent obstacle.
    Wall,
    /// The ground under the other sprites, omitted from encodings.
    Floor,
    /// A stationary type from which there is nothing to gain, such as soil, cover, or sprites that shots or
    /// other sprites can break. Lists of its positions would be too long.
    Scenery,
    /// Any other type.
    Thing,
}

/// A legend entry for a visible sprite type.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The name of the sprite type.
    pub name: String,
    /// The character of the sprite type, or [`EMPTY`] for floors.
    pub symbol: char,
    /// The role of the sprite type.
    pub role: EntryRole,
    /// `true` if the type's sprites move straight ahead in directions that the rules do not fix, or stand
    /// still and are turned.
    pub is_turned: bool,
    /// `true` if the type's sprites follow shortest paths to their target.
    pub follows_paths: bool,
}

/// A game's table of characters. Only floors, or the avatar's states, can share a character.
#[derive(Clone, Debug)]
pub struct Legend {
    looks: Looks,
    /// The table's entries. The avatar is first, and the other types follow in registry order, which reveals
    /// nothing about a type's purpose or importance.
    entries: Vec<Entry>,
    places: BTreeMap<String, usize>,
}

impl Legend {
    /// Builds the table for an analysed game. The same game and options always give the same table.
    pub fn new(analysis: &Analysis, options: &LegendOptions) -> Legend {
        let (game, looks) = (analysis.game(), Looks::of_rules(analysis));
        let symbols = Symbols::of(analysis, &looks);
        let mut types: Vec<SpriteType> = looks.shown().collect();
        let is_avatar = |stype| analysis.avatars().iter().any(|avatar| avatar.stype == stype);
        types.sort_by_key(|&stype| (!is_avatar(stype), stype));
        let entry = |&stype: &SpriteType| {
            let role = match looks.look(stype).glyph {
                _ if is_avatar(stype) => EntryRole::Avatar,
                Glyph::Wall => EntryRole::Wall,
                _ if symbols.symbol(stype) == EMPTY => EntryRole::Floor,
                _ if is_scenery(analysis, stype) => EntryRole::Scenery,
                _ => EntryRole::Thing,
            };
            let (name, symbol) = (game.name(stype).to_owned(), symbols.symbol(stype));
            let follows_paths = analysis.game().class(stype) == Some(SpriteClass::PathChaser);
            Entry { name, symbol, role, is_turned: is_turned(analysis, stype), follows_paths }
        };
        let mut entries: Vec<Entry> = types.iter().map(entry).collect();
        if !options.tracking {
            unite_avatars(&mut entries);
        }
        separate_cases(&mut entries);
        if let Some(number) = options.shuffled {
            shuffle(&mut entries, number);
        }
        let places = entries.iter().enumerate().map(|(at, entry)| (entry.name.clone(), at)).collect();
        Legend { looks, entries, places }
    }

    /// Returns the entries of the game's visible sprite types, avatar first.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// Returns the entry of the named type, or `None` if the type is never visible.
    pub fn entry(&self, name: &str) -> Option<&Entry> {
        self.places.get(name).map(|&at| &self.entries[at])
    }

    /// Returns the sprite types' appearance in images.
    pub fn looks(&self) -> &Looks {
        &self.looks
    }

    /// Returns `true` if encodings show the named type. Encodings show every visible type except floors.
    pub(crate) fn is_shown(&self, name: &str) -> bool {
        self.entry(name).is_some_and(|entry| entry.role != EntryRole::Floor)
    }

    /// Returns one line per character: the character, a space, and the names of its types.
    pub fn lines(&self) -> Vec<String> {
        let names = |role: EntryRole| {
            let all = self.entries.iter().filter(move |entry| entry.role == role);
            all.map(|entry| entry.name.as_str()).collect::<Vec<_>>()
        };
        let mut lines = match names(EntryRole::Floor)[..] {
            [] => vec![format!("{EMPTY} nothing")],
            ref floors => vec![format!("{EMPTY} nothing or {}", floors.join(" or "))],
        };
        let avatars = names(EntryRole::Avatar);
        let mut before = None;
        for entry in self.entries.iter().filter(|entry| entry.role != EntryRole::Floor) {
            let united = entry.role == EntryRole::Avatar && self.is_united();
            if before.replace(entry.symbol) == Some(entry.symbol) {
                continue;
            }
            lines.push(match united {
                true => format!("{} you: {}", entry.symbol, avatars.join(" or ")),
                false => format!("{} {}", entry.symbol, entry.name),
            });
        }
        lines
    }

    /// Returns `true` if all avatar states share one character.
    fn is_united(&self) -> bool {
        let mut avatars = self.entries.iter().filter(|entry| entry.role == EntryRole::Avatar);
        let first = avatars.next().map(|entry| entry.symbol);
        avatars.all(|entry| Some(entry.symbol) == first)
    }
}

/// Returns `true` if a type is stationary and there is nothing to gain from it.
fn is_scenery(analysis: &Analysis, stype: SpriteType) -> bool {
    let facts = analysis.facts(stype);
    let is_counted = analysis.goals().iter().any(|goal| goal.condition.types().contains(&stype));
    let stays = matches!(facts.motion, Motion::Still) && facts.makes.is_empty();
    let role = analysis.role(stype);
    stays
        && !is_counted
        && matches!(role, Role::Soil | Role::Cover | Role::Breakable | Role::Refuge | Role::Floor)
}

/// Returns `true` if a type's sprites move straight ahead in directions that the rules do not fix, or stand
/// still and are turned.
fn is_turned(analysis: &Analysis, stype: SpriteType) -> bool {
    let motion = analysis.facts(stype).motion;
    let turns = |effect: &EffectSummary| match effect {
        EffectSummary::Turn => true,
        // A sprite keeps its direction when it becomes a sprite of a different type.
        EffectSummary::Become(into) | EffectSummary::BecomeAll(_, into) => *into == stype,
        EffectSummary::BecomeAny(into) => into.contains(&stype),
        _ => false,
    };
    let is_own = |encounter: &Encounter, effect: &EffectSummary| {
        !matches!(effect, EffectSummary::Turn) || analysis.applies(encounter.first, stype)
    };
    let by_rules = analysis
        .encounters()
        .iter()
        .any(|encounter| encounter.effects.iter().any(|effect| turns(effect) && is_own(encounter, effect)));
    match motion {
        Motion::Straight(direction) => {
            direction_name(direction).is_none() || by_rules || analysis.role(stype) == Role::Shot
        }
        Motion::Still => by_rules,
        _ => false,
    }
}

/// Assigns the character [`AVATAR`] to all avatar states. A type that already had this character gets one
/// that is no longer used.
fn unite_avatars(entries: &mut [Entry]) {
    let is_avatar = |entry: &&Entry| entry.role == EntryRole::Avatar;
    let Some(free) = entries.iter().find(is_avatar).map(|entry| entry.symbol) else { return };
    for entry in entries.iter_mut() {
        if entry.role == EntryRole::Avatar {
            entry.symbol = AVATAR;
        } else if entry.symbol == AVATAR {
            entry.symbol = free;
        }
    }
}

/// Assigns a new character to each type whose letter differs from an earlier entry's letter only in case. The
/// new character is a letter from the type's name, or a spare character.
fn separate_cases(entries: &mut [Entry]) {
    for at in 1..entries.len() {
        let own = entries[at].symbol;
        let is_like = |other: &Entry, symbol: char| other.symbol.eq_ignore_ascii_case(&symbol);
        if !entries[..at].iter().any(|other| other.symbol != own && is_like(other, own)) {
            continue;
        }
        let name: String = entries[at].name.chars().filter(char::is_ascii_alphanumeric).collect();
        let is_free = |symbol: &char| !entries.iter().any(|other| is_like(other, *symbol));
        if let Some(symbol) = name.chars().chain(SPARE.chars()).find(is_free) {
            entries[at].symbol = symbol;
        }
    }
}

/// Replaces the characters with random ones. Entries that shared a character still share one.
fn shuffle(entries: &mut [Entry], number: u64) {
    let mut pool: Vec<char> = POOL.chars().collect();
    Seed::from_text("shuffled symbols").child("symbols", number).sampler().shuffle(&mut pool);
    let mut pool = pool.into_iter().chain(('\u{C0}'..=char::MAX).filter(|c| c.is_alphabetic()));
    let mut drawn = BTreeMap::from([(EMPTY, EMPTY)]);
    for entry in entries {
        let next = || pool.next().expect("types are far fewer than characters");
        entry.symbol = *drawn.entry(entry.symbol).or_insert_with(next);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::Game;

    #[test]
    fn letters_differ_in_more_than_case() {
        let source = "BasicGame\n  SpriteSet\n    bed > Immovable\n    bridge > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    \
                      b > bed\n    B > bridge\n  InteractionSet\n    bed bridge avatar > killSprite\n  TerminationSet\n    \
                      SpriteCounter stype=bed win=True\n";
        let analysis = Analysis::of(&Game::from_source(source).unwrap());
        let symbol = |name: &str| {
            let legend = Legend::new(&analysis, &LegendOptions::default());
            legend.entry(name).unwrap().symbol
        };
        assert_eq!((symbol("bed"), symbol("bridge")), ('b', 'r'));
    }
}
