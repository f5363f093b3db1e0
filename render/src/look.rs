//! The looks of the sprite types of one game.

use crate::colour::{Colour, INK, PAPER};
use crate::glyph::Glyph;
use engine::analysis::{EffectSummary, Key};
use engine::{Analysis, Game, SpriteType};

/// The squared distance below which colours are too similar to tell two types of one glyph apart.
const ALIKE: u32 = 3000;

/// The look of a sprite type: the input of its tile, except orientation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Look {
    /// The glyph.
    pub glyph: Glyph,
    /// The main colour: the game's own, or that of the glyph.
    pub colour: Colour,
    /// The variant of the glyph, from 0. Keys and the gates that they open have the same.
    pub variant: u8,
    /// The number of dots, for types that share glyph and colour.
    pub pips: u8,
}

impl Look {
    /// Returns the look of a glyph in a game that names no colour and has one type of it.
    pub fn plain(glyph: Glyph) -> Look {
        Look { glyph, colour: glyph.colour(), variant: 0, pips: 0 }
    }
}

/// The looks of all types of one game. Immutable; the same game always gives the same looks.
#[derive(Clone, Debug)]
pub struct Looks {
    game: Game,
    looks: Vec<Look>,
    /// By type: `true` if players see its sprites.
    visible: Vec<bool>,
    /// Types whose sprites can be seen in some episode.
    shown: Vec<SpriteType>,
    /// `true` if avatars can hold resources or have health.
    holdings: bool,
}

impl Looks {
    /// Computes the looks of an analysed game. Cost: O(types²).
    pub fn of(analysis: &Analysis) -> Looks {
        let game = analysis.game();
        let is_shown = |stype: &SpriteType| {
            let facts = analysis.facts(*stype);
            facts.concrete && facts.possible && !facts.hidden
        };
        let visible: Vec<bool> = game.sprite_types().map(|stype| !analysis.facts(stype).hidden).collect();
        let glyphs: Vec<Glyph> = game.sprite_types().map(|stype| Glyph::of(analysis, stype)).collect();
        let mut looks: Vec<Look> = glyphs.iter().map(|&glyph| Look::plain(glyph)).collect();
        // The looks that the game can show, so that types which never occur use up no variant. Gates come last: they
        // follow their keys.
        let mut seen: Vec<Look> = Vec::new();
        let mut order: Vec<SpriteType> = game.sprite_types().collect();
        order.sort_by_key(|stype| glyphs[stype.index()] == Glyph::Gate);
        for stype in order {
            let glyph = glyphs[stype.index()];
            let before = seen.iter().filter(|look| look.glyph == glyph).count();
            let colour = game.color(stype).map_or_else(|| shifted(glyph.colour(), before), Colour);
            let own = if glyph == Glyph::Gate { emblem(analysis, stype, &looks) } else { None };
            let variant = (own.unwrap_or(before) % glyph.variants()) as u8;
            let alike = |other: &&Look| {
                let same = other.glyph == glyph && other.variant == variant;
                same && other.colour.distance(colour) < ALIKE
            };
            let pips = if glyph.is_ground() { 0 } else { seen.iter().filter(alike).count().min(3) as u8 };
            let look = Look { glyph, colour, variant, pips };
            if is_shown(&stype) {
                seen.push(look);
            }
            looks[stype.index()] = look;
        }
        let shown: Vec<SpriteType> = game.sprite_types().filter(is_shown).collect();
        let wounds = |effect: &EffectSummary| matches!(effect, EffectSummary::Health { .. });
        let health = analysis.encounters().iter().any(|encounter| encounter.effects.iter().any(wounds));
        let holdings = health || !analysis.resources().is_empty();
        Looks { game: game.clone(), looks, visible, shown, holdings }
    }

    /// Returns the game that they belong to.
    pub fn game(&self) -> &Game {
        &self.game
    }

    /// Returns the look of a type.
    pub fn look(&self, stype: SpriteType) -> Look {
        self.looks[stype.index()]
    }

    /// Returns the types whose sprites players can ever see, in registry order.
    pub fn shown(&self) -> impl Iterator<Item = SpriteType> + '_ {
        self.shown.iter().copied()
    }

    /// Returns `true` if an avatar can hold something or has health: captions then show more than the score.
    pub fn has_holdings(&self) -> bool {
        self.holdings
    }

    /// Returns `true` if players see sprites of the type.
    pub fn is_visible(&self, stype: SpriteType) -> bool {
        self.visible[stype.index()]
    }
}

/// Returns the variant of the key that opens a gate.
fn emblem(analysis: &Analysis, gate: SpriteType, looks: &[Look]) -> Option<usize> {
    let lock = analysis.locks().iter().find(|lock| lock.stype == gate)?;
    let key = match lock.key {
        Key::Resource { resource, .. } => resource,
        Key::Avatar(_) => lock.givers.first()?.0,
        Key::Switch(switch, _) => switch,
    };
    looks.get(key.index()).filter(|look| look.glyph == Glyph::Key).map(|look| usize::from(look.variant))
}

/// Returns the colour of the nth type of a glyph without a colour of its own: of the same hue.
fn shifted(colour: Colour, nth: usize) -> Colour {
    match nth % 3 {
        0 => colour,
        1 => colour.mixed(PAPER, 45),
        _ => colour.mixed(INK, 40),
    }
}
