//! The looks of a game's sprite types. A look determines how a type is drawn: shape, colour and letter.

use super::colour::{Colour, INK, PAPER};
use super::figure::{Form, Hint, Mood};
use super::glyph::Glyph;
use super::meaning::meaning;
use super::prospects::Prospects;
use super::shape::Point;
use crate::looks::shape::unit;
use engine::analysis::{EffectSummary, Key};
use engine::{Analysis, Game, SpriteType};
use std::collections::BTreeMap;

/// The squared distance below which two colours are too similar to distinguish types with the same glyph (symbol).
const ALIKE: u32 = 3000;
/// The maximum number of dots on a tile.
const MAX_PIPS: u8 = 4;

/// The look of a sprite type: everything that determines its tile, except the orientation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Look {
    /// The glyph (symbol) derived from the rules. The glyph decides how legends describe the type.
    pub glyph: Glyph,
    /// The shape that is drawn: a figure if the game specifies an image, and the symbol chosen from the rules (the
    /// glyph) otherwise.
    pub form: Form,
    /// The sign for the type's state, as an index into the table of figures; `None` if the tile needs no sign.
    pub(crate) mark: Option<u16>,
    /// The face's expression, if the form has a face.
    pub mood: Mood,
    /// The main colour: the colour that the game specifies, or the glyph's default.
    pub colour: Colour,
    /// The variant of the glyph (symbol), from 0. A key and the gates that it opens have the same variant.
    pub variant: u8,
    /// The number of dots that distinguish types with the same glyph (symbol) and colour.
    pub pips: u8,
}

impl Look {
    /// Returns the look of a glyph (symbol) in a game that specifies no colour and has only one type with this glyph.
    pub fn plain(glyph: Glyph) -> Look {
        Look {
            glyph,
            form: Form::Glyph(glyph),
            mark: None,
            mood: Mood::Calm,
            colour: glyph.colour(),
            variant: 0,
            pips: 0,
        }
    }
}

impl Look {
    /// Returns `true` if players cannot distinguish two types with these looks. Such types have the same
    /// drawing and the same number of dots, and their colours are either similar or not visible in the
    /// drawing.
    pub fn is_like(self, other: Look) -> bool {
        let drawing = |look: Look| (look.form, look.mark, look.mood, look.variant, look.pips);
        // Figures (drawings of nouns) show less of the type's colour than glyphs (symbols) do.
        let alike = if self.form.figure().is_some() { 3 * ALIKE } else { ALIKE };
        drawing(self) == drawing(other)
            && (!self.form.is_coloured() || self.colour.distance(other.colour) < alike)
    }
}

/// The looks of all types in a game. Looks are immutable, and the same game always yields the same looks.
#[derive(Clone, Debug)]
pub struct Looks {
    game: Game,
    looks: Vec<Look>,
    /// For each type, `true` if its sprites are visible to players.
    visible: Vec<bool>,
    /// The types whose sprites can be visible in at least one episode.
    shown: Vec<SpriteType>,
    /// `true` if avatars can hold resources or have health.
    holdings: bool,
    /// The meaning of each type in legends.
    meanings: Vec<String>,
    prospects: Prospects,
    /// The floor of a composed game; `None` for other games.
    floor: Option<SpriteType>,
    /// The direction of each type's signs according to the rules.
    fronts: Vec<Option<Point>>,
}

impl Looks {
    /// Computes the looks (shapes, colours and letters of types) for an analysed game, with the images that the game
    /// specifies or that its types' names suggest. Cost: O(types²).
    pub fn of(analysis: &Analysis) -> Looks {
        let named = pictures(analysis.game());
        let by_name = |stype: SpriteType, glyph: Glyph| match named.get(&stype) {
            Some(img) => Some(Hint::of(img)),
            None => Hint::of_name(analysis.game().name(stype), glyph),
        };
        let mut looks = Looks::with_hints(analysis, by_name);
        let is_floor = |(_, img): &(&SpriteType, &String)| Hint::of(img).role == Some("floor");
        looks.floor = named.iter().find(is_floor).map(|(&stype, _)| stype);
        let told = |stype: SpriteType| meaning(analysis, stype, looks.look(stype).form);
        let meanings = analysis.game().sprite_types().map(told).collect();
        Looks { meanings, ..looks }
    }

    /// Computes the looks (shapes, colours and letters of types) that follow from the rules alone, with the meanings of
    /// the symbols. Ignores the images that the game specifies. Cost: O(types²).
    pub fn of_rules(analysis: &Analysis) -> Looks {
        Looks::with_hints(analysis, |_, _| None)
    }

    fn with_hints<'a>(analysis: &Analysis, hint_of: impl Fn(SpriteType, Glyph) -> Option<Hint<'a>>) -> Looks {
        let game = analysis.game();
        let is_shown = |stype: &SpriteType| {
            let facts = analysis.facts(*stype);
            facts.concrete && facts.possible && !facts.hidden
        };
        let visible: Vec<bool> = game.sprite_types().map(|stype| !analysis.facts(stype).hidden).collect();
        let glyphs: Vec<Glyph> = game.sprite_types().map(|stype| Glyph::of(analysis, stype)).collect();
        let mut looks: Vec<Look> = glyphs.iter().map(|&glyph| Look::plain(glyph)).collect();
        // Only the looks of types that can be visible in the game are counted, so that other types do not use up
        // variants. Gates come last, because a gate's look follows its key's look.
        let mut seen: Vec<Look> = Vec::new();
        let mut order: Vec<SpriteType> = game.sprite_types().collect();
        order.sort_by_key(|stype| glyphs[stype.index()] == Glyph::Gate);
        for stype in order {
            let glyph = glyphs[stype.index()];
            let hint = hint_of(stype, glyph);
            let form = hint.map_or(Form::Glyph(glyph), |hint| hint.form(glyph));
            let (mark, mood) = (hint.and_then(Hint::mark), hint.map_or(Mood::Calm, |hint| hint.mood(glyph)));
            let before = seen.iter().filter(|look| look.form == form).count();
            let colour = game.color(stype).map_or_else(|| shifted(glyph.colour(), before), Colour);
            let own = if form == Form::Glyph(Glyph::Gate) { emblem(analysis, stype, &looks) } else { None };
            let variant = (own.unwrap_or(before) % form.variants()) as u8;
            let look = Look { glyph, form, mark, mood, colour, variant, pips: 0 };
            let taken = |pips: &u8| seen.iter().any(|other| Look { pips: *pips, ..look }.is_like(*other));
            let pips = (0..MAX_PIPS).find(|pips| !taken(pips)).unwrap_or(MAX_PIPS);
            let look = Look { pips, ..look };
            if is_shown(&stype) {
                seen.push(look);
            }
            looks[stype.index()] = look;
        }
        let passing = engine::describe::passing_types(analysis);
        let is_seen = |stype: &SpriteType| is_shown(stype) && !passing.contains(stype);
        let shown: Vec<SpriteType> = game.sprite_types().filter(is_seen).collect();
        let wounds = |effect: &EffectSummary| matches!(effect, EffectSummary::Health { .. });
        let health = analysis.encounters().iter().any(|encounter| encounter.effects.iter().any(wounds));
        let holdings = health || !analysis.resources().is_empty();
        let meanings = glyphs.iter().map(|glyph| glyph.meaning().to_owned()).collect();
        let prospects = Prospects::of(analysis);
        let front = |stype| analysis.sign(stype).and_then(|way| unit((way.x, way.y)));
        let fronts = game.sprite_types().map(front).collect();
        Looks {
            game: game.clone(),
            looks,
            visible,
            shown,
            holdings,
            meanings,
            prospects,
            floor: None,
            fronts,
        }
    }

    /// Returns the game to which the looks belong.
    pub fn game(&self) -> &Game {
        &self.game
    }

    /// Returns a type's look.
    pub fn look(&self, stype: SpriteType) -> Look {
        self.looks[stype.index()]
    }

    /// Returns a short description of a type: the meaning of its glyph (symbol), and how the type moves.
    pub fn meaning(&self, stype: SpriteType) -> &str {
        &self.meanings[stype.index()]
    }

    /// Returns the floor of a composed game, whose levels omit it from cells where it would be hidden; `None` for other
    /// games.
    pub(crate) fn floor(&self) -> Option<SpriteType> {
        self.floor
    }

    /// Returns a sign's direction according to the rules; `None` for types that are not signs. The sign's sprites may
    /// turn during play.
    pub(crate) fn front(&self, stype: SpriteType) -> Option<Point> {
        self.fronts[stype.index()]
    }

    pub(crate) fn prospects(&self) -> &Prospects {
        &self.prospects
    }

    /// Returns the types whose sprites can ever be visible to players, in registry order.
    pub fn shown(&self) -> impl Iterator<Item = SpriteType> + '_ {
        self.shown.iter().copied()
    }

    /// Returns `true` if an avatar can hold something or has health. If so, captions show more than the
    /// score.
    pub fn has_holdings(&self) -> bool {
        self.holdings
    }

    /// Returns `true` if sprites of the type are visible to players.
    pub fn is_visible(&self, stype: SpriteType) -> bool {
        self.visible[stype.index()]
    }
}

/// Returns the images that a game specifies (`img=`), by type. A type without an image inherits its parent's.
fn pictures(game: &Game) -> BTreeMap<SpriteType, String> {
    let mut pictures = BTreeMap::new();
    // The images of the enclosing lines, by depth.
    let mut above: Vec<Option<String>> = Vec::new();
    for (depth, line) in game.description().sprite_lines() {
        above.truncate(depth);
        let own = line.params.iter().find(|param| param.key.text == "img");
        let own = own.map(|param| param.value.text.clone());
        let picture = own.or_else(|| above.last().cloned().flatten());
        above.push(picture.clone());
        if let (Some(stype), Some(picture)) = (game.sprite_type(&line.name.text), picture) {
            pictures.insert(stype, picture);
        }
    }
    pictures
}

/// Returns the variant of the key that opens a gate; `None` if no type that is drawn as a key opens it.
fn emblem(analysis: &Analysis, gate: SpriteType, looks: &[Look]) -> Option<usize> {
    let lock = analysis.locks().iter().find(|lock| lock.stype == gate)?;
    let key = match lock.key {
        Key::Resource { resource, .. } => resource,
        Key::Avatar(_) => lock.givers.first()?.0,
        Key::Switch(switch, _) => switch,
    };
    looks.get(key.index()).filter(|look| look.glyph == Glyph::Key).map(|look| usize::from(look.variant))
}

/// Returns the colour of the nth type with the same glyph (symbol), for types without a colour of their own. The hue
/// stays the same.
fn shifted(colour: Colour, nth: usize) -> Colour {
    match nth % 3 {
        0 => colour,
        1 => colour.mixed(PAPER, 45),
        _ => colour.mixed(INK, 40),
    }
}
