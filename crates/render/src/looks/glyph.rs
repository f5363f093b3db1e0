//! The glyphs (symbols) of tiles, one for each kind of sprite that a player must be able to distinguish.

use super::art::Art;
use super::colour;
use super::colour::Colour;
use super::{remarks, wins};
use crate::looks::art::{creatures, ground, passages, shots, things};
use engine::analysis::{EffectSummary, Harm, Key, Motion, Role, Steering};
use engine::{Analysis, SpriteClass, SpriteType};

/// Declares each glyph in one place, with its variant, form, meaning, colour, terminal symbols and drawing.
macro_rules! glyphs {
    ($($name:ident, $form:literal, $meaning:literal, $colour:ident, $unicode:literal, $ascii:literal, $draw:path;)*) => {
        /// A tile's glyph: the symbol for a kind of sprite that a player must be able to distinguish.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Glyph { $(#[doc = $meaning] $name),* }

        impl Glyph {
            /// All glyphs, in legend order.
            pub const ALL: &[Glyph] = &[$(Glyph::$name),*];

            /// Returns a short description of the glyph's form.
            pub fn form(self) -> &'static str {
                match self { $(Glyph::$name => $form),* }
            }

            /// Returns a short description of the glyph's meaning.
            pub fn meaning(self) -> &'static str {
                match self { $(Glyph::$name => $meaning),* }
            }

            pub(crate) fn colour(self) -> Colour {
                match self { $(Glyph::$name => colour::$colour),* }
            }

            /// Returns the glyph's symbol, which is two columns wide in a terminal.
            pub fn unicode(self) -> &'static str {
                match self { $(Glyph::$name => $unicode),* }
            }

            /// Returns the glyph's ASCII symbol, which is two columns wide in a terminal.
            pub fn ascii(self) -> &'static str {
                match self { $(Glyph::$name => $ascii),* }
            }

            /// Adds the glyph's shapes to a tile.
            pub(crate) fn draw(self, art: &mut Art) {
                match self { $(Glyph::$name => $draw(art)),* }
            }
        }
    };
}

glyphs! {
    Avatar, "a figure in a bright ring", "you", BLUE, "@ ", "@ ", creatures::avatar;
    Craft, "a ship in a bright ring", "you, steering by thrust", BLUE, "▲ ", "@^", creatures::craft;
    Fallen, "a grave cross", "you, dead", STONE, "† ", "+ ", creatures::fallen;
    Exit, "a door with a star", "the way to win", GREEN, "★ ", "X ", passages::exit;
    Treasure, "a star", "take it to win", YELLOW, "☆ ", "* ", things::treasure;
    Prey, "a startled creature with a star", "catch or hit it to win", YELLOW, "◎ ", "& ", creatures::prey;
    Target, "rings with a star", "must go for the win", YELLOW, "⊛ ", "()", things::target;
    Peril, "spiked rings with a star", "harms, and must go for the win", VERMILION, "✶ ", "(^", things::peril;
    Socket, "a sunken square with a star", "push things here to win", SKY, "□ ", "_ ", passages::socket;
    Slot, "a sunken square", "push things here, or lose them here", SKY, "⊔ ", "U ", passages::slot;
    Ward, "a shield with a heart", "keep it safe", SKY, "♥ ", "V ", things::ward;
    Enemy, "a spiky creature with angry eyes", "moves and harms", VERMILION, "Ж ", "M ", creatures::enemy;
    Charger, "an angry head with a pointed snout", "runs ahead, harms", VERMILION, "Ж ", "M>", creatures::charger;
    HostileShot, "a barbed arrow", "a shot that harms", VERMILION, "↯ ", "! ", shots::hostile;
    Hazard, "a row of spikes", "harms where it stands", VERMILION, "▲▲", "^^", ground::hazard;
    Mire, "waves", "harms at times", SKY, "≈≈", "~~", ground::mire;
    Nest, "a cave with eyes", "makes what harms", PURPLE, "◙ ", "% ", passages::nest;
    Maker, "a hatch with a plus", "makes other things", PURPLE, "⊞ ", "%+", passages::maker;
    Boulder, "a rock", "falls, blocks, may crush", STONE, "● ", "O ", things::boulder;
    Crate, "a crossed crate", "can be pushed", WOOD, "▣ ", "[]", things::crossed_crate;
    Pointer, "a crate with an arrow", "can be pushed, turns what comes to it", WOOD, "▷ ", "[>", things::pointer;
    Key, "a key", "opens something", YELLOW, "¬ ", "k ", things::key;
    Switch, "a button", "touch it to open", ORANGE, "⊙ ", "o ", things::switch;
    Token, "a coin", "a resource to hold", YELLOW, "○ ", "$ ", things::token;
    Gem, "a gem", "can be taken", ORANGE, "◆ ", "' ", things::gem;
    Gate, "bars with a lock", "bars the way for now", WOOD, "╫╫", "##", passages::gate;
    Portal, "a swirl", "takes you elsewhere", PURPLE, "@@", "@@", passages::portal;
    PortalExit, "an empty ring with an arrow", "where a portal leads", PURPLE, "◌ ", "<>", passages::portal_exit;
    Blade, "a slash", "what you strike with", SKY, "⁄ ", "/ ", shots::blade;
    Bolt, "a dart", "what you shoot", SKY, "• ", ". ", shots::bolt;
    Bomb, "a round bomb", "what you lay", SLATE, "♠ ", "b ", shots::bomb;
    Friend, "a round creature that smiles", "moves and does no harm", GREEN, "☻ ", "f ", creatures::friend;
    Raft, "planks", "moves along, does no harm", WOOD, "≡≡", "==", things::raft;
    Wall, "bricks", "blocks the way for good", SLATE, "██", "##", ground::bricks;
    Breakable, "cracked bricks", "blocks until broken", STONE, "▓▓", "%%", ground::breakable;
    Soil, "speckled ground", "dug away by walking", EARTH, "░░", "::", ground::soil;
    Cover, "sandbags", "stops shots", STONE, "▒▒", "HH", ground::cover;
    Refuge, "a bush", "stops enemies, not you", GREEN, "♣♣", "\"\"", ground::refuge;
    Conveyor, "chevrons", "carries what stands on it", STONE, "»»", ">>", ground::conveyor;
    Sign, "an arrow", "turns what comes to it", STONE, "→ ", "->", things::sign;
    Spring, "a tile with a plus", "gives while you are on it", SKY, "++", "++", ground::spring;
    Floor, "a plain tile", "nothing happens on it", GRID, "  ", "  ", ground::floor;
    Neutral, "a pebble", "none of these", STONE, "▪ ", ", ", things::neutral;
}

impl Glyph {
    /// Chooses the glyph (symbol) of a sprite type, first by its role, and then by its movement and its purpose. A type
    /// gets no star if it cannot contribute to a win.
    pub fn of(analysis: &Analysis, stype: SpriteType) -> Glyph {
        let glyph = Glyph::by_role(analysis, stype);
        let plain = match glyph {
            Glyph::Exit | Glyph::Treasure => Glyph::Gem,
            Glyph::Prey => Glyph::Friend,
            Glyph::Socket if remarks::is_socket_of_win(analysis, stype) => return glyph,
            Glyph::Socket => return Glyph::Slot,
            Glyph::Target => Glyph::Neutral,
            Glyph::Peril => Glyph::Hazard,
            _ => return glyph,
        };
        match wins::may_win(analysis, stype) {
            true => glyph,
            false if plain != Glyph::Hazard && wins::is_to_keep(analysis, stype) => Glyph::Ward,
            false => plain,
        }
    }

    fn by_role(analysis: &Analysis, stype: SpriteType) -> Glyph {
        let facts = analysis.facts(stype);
        let wanted = analysis.aims().remove.contains(&stype);
        let still = facts.motion == Motion::Still;
        match analysis.role(stype) {
            Role::Avatar => {
                let avatar = analysis.avatars().iter().find(|avatar| avatar.stype == stype);
                let thrust = avatar.is_some_and(|avatar| avatar.steering == Steering::Thrust);
                if thrust { Glyph::Craft } else { Glyph::Avatar }
            }
            Role::Shot if facts.fleeting && still => Glyph::Blade,
            Role::Shot if still => Glyph::Bomb,
            Role::Shot => Glyph::Bolt,
            Role::Portal => Glyph::Portal,
            Role::PortalExit => Glyph::PortalExit,
            Role::Pushable if analysis.sign(stype).is_some() => Glyph::Pointer,
            Role::Pushable => Glyph::Crate,
            Role::Gate | Role::Hazard if lies_under(analysis, stype) => Glyph::Mire,
            Role::Key | Role::Collectable if lies_under(analysis, stype) => Glyph::Spring,
            Role::Exit => Glyph::Exit,
            Role::Gate => Glyph::Gate,
            Role::Boulder => Glyph::Boulder,
            Role::Enemy if is_spoilt(analysis, stype) => Glyph::Friend,
            Role::Enemy => match facts.motion {
                Motion::Straight(_) if is_dropped(analysis, stype) => Glyph::HostileShot,
                Motion::Straight(_) => Glyph::Charger,
                _ => Glyph::Enemy,
            },
            Role::Socket => Glyph::Socket,
            Role::Hazard if wanted => Glyph::Peril,
            Role::Hazard if analysis.harm(stype) == Harm::Conditional => Glyph::Mire,
            Role::Hazard => Glyph::Hazard,
            Role::Spawner if analysis.makes_harm(stype) => Glyph::Nest,
            Role::Spawner => Glyph::Maker,
            Role::Ward => Glyph::Ward,
            Role::Prey if still => Glyph::Target,
            Role::Prey => Glyph::Prey,
            Role::Key => key(analysis, stype),
            Role::Soil => Glyph::Soil,
            Role::Collectable if still && !wanted && is_source(analysis, stype) => Glyph::Spring,
            Role::Collectable if still && !wanted && changes_speed(analysis, stype).is_some() => {
                Glyph::Switch
            }
            Role::Collectable if wanted && still => Glyph::Treasure,
            Role::Collectable if wanted => Glyph::Prey,
            Role::Collectable if !still => Glyph::Friend,
            Role::Collectable if facts.is_resource => Glyph::Token,
            Role::Collectable => Glyph::Gem,
            Role::Breakable => Glyph::Breakable,
            Role::Wall => Glyph::Wall,
            Role::Cover => Glyph::Cover,
            Role::Refuge => Glyph::Refuge,
            Role::Neutral if analysis.sign(stype).is_some() => Glyph::Sign,
            Role::Floor if is_thing(analysis, stype) && analysis.sign(stype).is_some() => Glyph::Sign,
            Role::Floor if is_thing(analysis, stype) => neutral(analysis, stype),
            Role::Floor => Glyph::Floor,
            Role::Neutral if still => neutral(analysis, stype),
            Role::Neutral if matches!(facts.motion, Motion::Straight(_)) => Glyph::Raft,
            Role::Neutral => Glyph::Friend,
        }
    }

    /// Returns the number of variants of the glyph (symbol). Variants distinguish types with the same glyph by more
    /// than colour.
    pub(crate) fn variants(self) -> usize {
        match self {
            Glyph::Enemy | Glyph::Gem | Glyph::Key | Glyph::Gate => 4,
            Glyph::Charger | Glyph::Token | Glyph::Friend | Glyph::Treasure | Glyph::Crate => 3,
            _ => 1,
        }
    }

    /// Returns `true` if the tile turns with the sprite's orientation.
    pub(crate) fn turns(self) -> bool {
        use Glyph as G;
        matches!(
            self,
            G::Craft | G::Charger | G::HostileShot | G::Bolt | G::Blade | G::Conveyor | G::Sign | G::Pointer
        )
    }

    /// Returns `true` if the tile fills its cell. Adjacent tiles of this kind join, and other sprites in the cell are
    /// drawn over them.
    pub(crate) fn is_ground(self) -> bool {
        use Glyph as G;
        matches!(self, G::Wall | G::Breakable | G::Soil | G::Mire | G::Conveyor | G::Spring | G::Floor)
    }
}

/// Returns `true` if a moving type creates sprites of the type, and the type itself creates nothing. A
/// dropped bomb qualifies, but a cart that comes out of a shed does not.
fn is_dropped(analysis: &Analysis, stype: SpriteType) -> bool {
    let drops = |maker: SpriteType| {
        let facts = analysis.facts(maker);
        facts.possible && facts.motion != Motion::Still && facts.makes.contains(&stype)
    };
    analysis.facts(stype).makes.is_empty() && analysis.game().sprite_types().any(drops)
}

/// Returns `true` if sprites of the type stay when touched, and several level characters place something on top of
/// them. Such a type is the ground of some part of the board rather than an object.
fn lies_under(analysis: &Analysis, stype: SpriteType) -> bool {
    let game = analysis.game();
    let stays = analysis.avatars().iter().all(|avatar| !analysis.touch(avatar.stype, stype).ends_other());
    let below = |symbol: &&u8| game.places(**symbol).last() != Some(&stype);
    let facts = analysis.facts(stype);
    stays && facts.motion == Motion::Still && facts.symbols.iter().filter(below).count() > 1
}

/// Returns `true` if rules involve the type, and no level character places anything over it. Such a type does
/// not affect an avatar in the same cell, but it is not ground either.
fn is_thing(analysis: &Analysis, stype: SpriteType) -> bool {
    let game = analysis.game();
    let above = |symbol: &u8| game.places(*symbol).last() == Some(&stype);
    !analysis.is_scenery(stype) && analysis.facts(stype).symbols.iter().all(above)
}

/// Returns `true` if the type gives a resource to every avatar that touches it, and its sprites stay on the
/// board.
fn is_source(analysis: &Analysis, stype: SpriteType) -> bool {
    let mut touches = analysis.avatars().iter().map(|avatar| analysis.touch(avatar.stype, stype));
    touches.all(|touch| !touch.ends_other() && touch.gives.iter().any(|&(_, by)| by > 0))
}

/// Returns `true` if rules about the type apply to an avatar.
pub(crate) fn is_avatar(analysis: &Analysis, written: SpriteType) -> bool {
    analysis.avatars().iter().any(|avatar| analysis.applies(written, avatar.stype))
}

/// Returns the type whose speed changes when an avatar touches `stype`; `None` if no speed changes.
pub(crate) fn changes_speed(analysis: &Analysis, stype: SpriteType) -> Option<SpriteType> {
    analysis.encounters().iter().find_map(|met| {
        let second = met.second?;
        let is_met = (analysis.applies(met.first, stype) && is_avatar(analysis, second))
            || (analysis.applies(second, stype) && is_avatar(analysis, met.first));
        met.effects.iter().find_map(|effect| match *effect {
            EffectSummary::Speed(Some(of)) if is_met && of != stype && !is_avatar(analysis, of) => Some(of),
            _ => None,
        })
    })
}

/// Returns the glyph (symbol) for a type that gives a key. It is a button if touching the type is enough, coins if the
/// avatar can hold many, and a key otherwise.
fn key(analysis: &Analysis, stype: SpriteType) -> Glyph {
    let many = |resource: SpriteType| {
        analysis.resources().iter().any(|known| known.stype == resource && known.limit > 2)
    };
    let mut locks =
        analysis.locks().iter().filter(|lock| lock.givers.iter().any(|(giver, _)| *giver == stype));
    let glyph = |key: &Key| match key {
        Key::Switch(..) => Glyph::Switch,
        Key::Resource { resource, .. } if many(*resource) => Glyph::Token,
        _ => Glyph::Key,
    };
    locks.next().map_or(Glyph::Key, |lock| glyph(&lock.key))
}

fn neutral(analysis: &Analysis, stype: SpriteType) -> Glyph {
    let carries = || {
        let mut met = analysis.encounters().iter();
        met.any(|met| {
            met.second.is_some_and(|second| analysis.applies(second, stype))
                && met.does(|effect| *effect == EffectSummary::Carry)
        })
    };
    match analysis.game().class(stype) {
        Some(SpriteClass::Conveyor) if carries() => Glyph::Conveyor,
        Some(SpriteClass::Portal) => Glyph::Portal,
        Some(class) if class.is_a(SpriteClass::SpawnPoint) => Glyph::Maker,
        _ => Glyph::Neutral,
    }
}

/// Returns `true` if a type must be protected: it is harmless, but other types can turn it into a forbidden type.
pub(crate) fn is_spoilt(analysis: &Analysis, stype: SpriteType) -> bool {
    let prevented = |to: SpriteType| analysis.aims().prevent.contains(&to);
    analysis.harm(stype) == Harm::None && analysis.turns(stype).iter().any(|(to, _)| prevented(*to))
}
