//! The pieces for a game's boards, and the number of each.

use super::brief::BoardBrief;
use super::idiom::Idiom;
use crate::levels::palette::{Palette, Walk};
use base::Sampler;
use engine::analysis::{Condition, Harm, Reason};
use engine::{Analysis, SpriteType};

/// The maximum number of kinds of pieces per board.
const MAX_KINDS: usize = 8;
/// The maximum number of givers to place because an interaction requires their resource.
const MOST_GIVERS: usize = 12;

/// A kind of piece (a sprite type that is placed on boards), with its position and count.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    pub(crate) stype: SpriteType,
    pub(crate) symbol: u8,
    pub(crate) idiom: Idiom,
    /// `true` if the piece harms the player or creates harmful sprites.
    pub(crate) harmful: bool,
    /// `true` if the request specifies the number of pieces of this kind.
    pub(crate) asked: bool,
    /// The minimum and maximum number of pieces per board.
    pub(crate) counts: (usize, usize),
}

/// The pieces, avatar, walls and floor for a game's boards.
#[derive(Clone, Debug)]
pub(crate) struct Kit<'a> {
    pub(crate) analysis: &'a Analysis,
    pub(crate) palette: Palette,
    /// The kinds of pieces, sorted by sprite type.
    pub(crate) pieces: Vec<Piece>,
    pub(crate) brief: BoardBrief,
}

impl<'a> Kit<'a> {
    /// Creates the pieces for a game and a request; `None` if no level character places exactly one avatar.
    pub(crate) fn of(analysis: &'a Analysis, brief: &BoardBrief) -> Option<Kit<'a>> {
        let palette = Palette::of(analysis)?;
        let start = palette.avatars[0].0;
        let mut pieces: Vec<Piece> = Vec::new();
        for stype in analysis.game().sprite_types() {
            let told = || brief.idioms.iter().find(|(of, _)| *of == stype).map(|(_, idiom)| *idiom);
            let idiom = told().or_else(|| Idiom::of(analysis, stype));
            let (Some(symbol), Some(idiom)) = (palette.symbol(stype), idiom) else {
                continue;
            };
            let is_ground = palette.ground.contains(&stype) || Some(symbol) == palette.wall;
            if is_ground || brief.without.contains(&stype) || symbol == palette.base {
                continue;
            }
            let harmful = analysis.harm(stype) != Harm::None || analysis.makes_harm(stype);
            let asked = brief.counts.iter().find(|(of, _)| *of == stype).map(|(_, counts)| *counts);
            let counts = asked.unwrap_or_else(|| counts(analysis, stype, idiom, brief.demand));
            if counts.1 > 0 && stype != start && pieces.iter().all(|piece| piece.symbol != symbol) {
                pieces.push(Piece { stype, symbol, idiom, harmful, asked: asked.is_some(), counts });
            }
        }
        let mut kit = Kit { analysis, palette, pieces, brief: brief.clone() };
        kit.pair_pushed();
        Some(kit)
    }

    /// Returns the piece for a character; `None` if the character places no piece.
    pub(crate) fn piece(&self, symbol: u8) -> Option<&Piece> {
        self.pieces.iter().find(|piece| piece.symbol == symbol)
    }

    /// Returns `true` if a character places something that the avatar can never pass or remove.
    pub(crate) fn is_solid(&self, symbol: u8) -> bool {
        self.palette.wall == Some(symbol)
            || (self.palette.walk(symbol) == Walk::Blocked
                && self
                    .piece(symbol)
                    .is_none_or(|piece| matches!(piece.idiom, Idiom::Hazard | Idiom::Obstacle)))
    }

    /// Returns `true` if the avatar can stand in a cell with the given character at the start of a level.
    pub(crate) fn is_open(&self, symbol: u8) -> bool {
        if self.piece(symbol).is_some_and(|piece| piece.idiom.moves()) {
            return true;
        }
        matches!(self.palette.walk(symbol), Walk::Open | Walk::Pushed)
    }

    /// Returns `true` if sprites of the type open, fill or disarm other sprites and must therefore be on the avatar's
    /// side of the dividers.
    pub(crate) fn is_opener(&self, stype: SpriteType) -> bool {
        let gives = self
            .analysis
            .locks()
            .iter()
            .any(|lock| lock.guards && lock.givers.iter().any(|(giver, _)| *giver == stype));
        let fills = self.analysis.pushables().iter().any(|pushable| {
            pushable.stype == stype && pushable.sinks.iter().any(|sink| sink.fills || !sink.opens.is_empty())
        });
        let ammo = self.analysis.resources().iter().any(|resource| {
            resource.is_ammunition && resource.givers.iter().any(|(giver, _)| *giver == stype)
        });
        gives || fills || ammo
    }

    /// Returns `true` if winning requires removing or protecting sprites of the type.
    pub(crate) fn is_aim(&self, stype: SpriteType) -> bool {
        let aims = self.analysis.aims();
        aims.remove.contains(&stype) || aims.protect.contains(&stype)
    }

    /// Draws the pieces for one board, with the number of each. If a game has many types, a board contains only some of
    /// them.
    pub(crate) fn draw(&self, sampler: &mut Sampler) -> Vec<(Piece, usize)> {
        let mut pieces: Vec<&Piece> = self.pieces.iter().collect();
        while pieces.len() > MAX_KINDS {
            let spare: Vec<usize> = (0..pieces.len())
                .filter(|&at| !pieces[at].asked && !self.is_required(pieces[at].stype))
                .collect();
            if spare.is_empty() {
                break;
            }
            pieces.remove(*sampler.choose(&spare));
        }
        let mut drawn: Vec<(Piece, usize)> = pieces
            .into_iter()
            .map(|piece| (piece.clone(), sampler.between(piece.counts.0, piece.counts.1)))
            .collect();
        self.match_pushed(&mut drawn);
        drawn.retain(|(_, count)| *count > 0);
        drawn
    }

    /// Returns `true` if a win needs the type, or if it needs another type that in turn requires this one.
    fn is_required(&self, stype: SpriteType) -> bool {
        let asked = |reason: Reason| match reason {
            Reason::Avatar | Reason::Portal(_) => false,
            Reason::Goal(_) | Reason::WinMethod(_) => true,
            Reason::Lock(locked) => self.is_aim(locked),
        };
        self.is_aim(stype)
            || self.analysis.requirements().iter().any(|requirement| {
                requirement.at_least > 0 && asked(requirement.reason) && requirement.types.contains(&stype)
            })
    }

    /// Ensures that each pushed type can occur together with enough targets.
    fn pair_pushed(&mut self) {
        let remove = &self.analysis.aims().remove;
        for pushable in self.analysis.pushables() {
            let wanted = remove.contains(&pushable.stype);
            for sink in pushable.sinks.iter().filter(|sink| wanted && sink.fills) {
                let most = self.pieces.iter().find(|piece| piece.stype == pushable.stype);
                let most = most.map_or(0, |piece| piece.counts.1);
                let partner = self.pieces.iter_mut().find(|piece| piece.stype == sink.partner);
                if let Some(partner) = partner.filter(|partner| !partner.asked) {
                    partner.counts.1 = partner.counts.1.max(most);
                }
            }
        }
    }

    /// Raises the numbers of pushed sprites and of their targets to the numbers that a win needs.
    fn match_pushed(&self, drawn: &mut [(Piece, usize)]) {
        let remove = &self.analysis.aims().remove;
        let number = |drawn: &[(Piece, usize)], stype: SpriteType| {
            drawn.iter().find(|(piece, _)| piece.stype == stype).map_or(0, |(_, count)| *count)
        };
        let raise = |drawn: &mut [(Piece, usize)], stype: SpriteType, least: usize| {
            let found = drawn.iter_mut().find(|(piece, _)| piece.stype == stype && !piece.asked);
            found.into_iter().for_each(|(_, count)| *count = least.max(*count));
        };
        for pushable in self.analysis.pushables() {
            for sink in pushable.sinks.iter().filter(|sink| sink.fills && sink.partner != pushable.stype) {
                let (pushed, targets) = (number(drawn, pushable.stype), number(drawn, sink.partner));
                if remove.contains(&pushable.stype) && targets > 0 {
                    raise(drawn, sink.partner, pushed);
                } else if remove.contains(&sink.partner) {
                    raise(drawn, pushable.stype, targets);
                }
            }
        }
    }
}

/// Returns the default range for the number of a type's sprites on a board, within the limits set by the terminations.
fn counts(analysis: &Analysis, stype: SpriteType, idiom: Idiom, demand: u8) -> (usize, usize) {
    let demand = usize::from(demand);
    let is_aim = analysis.aims().remove.contains(&stype);
    let mut pushed = analysis.pushables().iter().flat_map(|pushable| &pushable.sinks);
    let is_target = pushed.any(|sink| sink.partner == stype);
    let (mut low, mut high) = match idiom {
        Idiom::Barrier if is_aim => (1 + demand.div_ceil(2).min(2), 2 + demand),
        Idiom::Barrier => (1, 2 + demand),
        Idiom::Crossing => (3, 14),
        Idiom::Road => (0, 4 + demand),
        Idiom::Obstacle => (0, 40),
        Idiom::Ground => (4, 10 + 2 * demand),
        Idiom::Hazard => (2, 5 + demand),
        Idiom::Thing if is_aim => (2 + demand, 4 + demand + demand / 2),
        Idiom::Thing => (1, 2 + demand / 2),
        Idiom::Heavy => (1 + demand.min(1), 2 + demand / 2),
        Idiom::Spot if is_aim && !is_target => (2 + demand, 4 + demand + demand / 2),
        // A single target would make the level too short.
        Idiom::Spot | Idiom::Patrol | Idiom::Hunter | Idiom::Stray if is_aim => {
            (1 + demand.min(1), 2 + demand / 2)
        }
        Idiom::Spot => (1, 2 + demand / 2),
        Idiom::Patrol => (1, 1 + demand.div_ceil(2)),
        Idiom::Hunter => (1, 1 + demand / 2),
        Idiom::Stray => (1, 2 + demand / 2),
        Idiom::Source | Idiom::Exit => (1, 1 + usize::from(demand > 2 && idiom == Idiom::Source)),
    };
    for requirement in analysis.requirements().iter().filter(|requirement| requirement.types == [stype]) {
        low = low.max(requirement.at_least as usize);
        let most = requirement.at_most.map_or(usize::MAX, |most| most as usize);
        (low, high) = (low.min(most), high.min(most));
    }
    for resource in analysis.resources().iter().filter(|resource| resource.obtainable) {
        if let [(giver, amount)] = resource.givers[..]
            && giver == stype
        {
            low =
                low.max((resource.needed.max(0) as usize).div_ceil(amount.max(1) as usize).min(MOST_GIVERS));
        }
    }
    for goal in analysis.goals().iter().filter(|goal| goal.win && goal.condition.types().contains(&stype)) {
        if let Condition::AtMost(types, limit) = &goal.condition {
            let least = usize::try_from(*limit).unwrap_or(0) + 1;
            if types.len() == 1 {
                low = low.max(least + usize::from(idiom == Idiom::Thing));
            }
        }
    }
    (low, high.max(low))
}
