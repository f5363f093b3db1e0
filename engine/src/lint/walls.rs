//! Lints for walls that do not stop any avatar.

use super::Linter;
use crate::diagnostic::{Diagnostic, Span};
use crate::game::Game;
use crate::level::Level;
use crate::rules::SpriteType;
use crate::rules::class::SpriteClass;
use crate::syntax::{InteractionLine, Word};

/// The minimum side length of a board whose outermost cells count as a border.
const LEAST_SIDE: usize = 4;

impl Linter<'_> {
    /// Reports types that are named like walls, do not move, and appear in no rule with an avatar.
    pub(super) fn open_walls(&self, problems: &mut Vec<Diagnostic>) {
        for (_, line) in self.game.description().sprite_lines() {
            let Some(wall) = self.game.sprite_type(&line.name.text) else { continue };
            let is_there = self.analysis.facts(wall).possible && !self.roams(wall);
            if let Some(avatar) = open_to(self.game, wall).filter(|_| is_there && is_named(self.game, wall)) {
                problems.push(warning(self.game, wall, avatar, line.name.span));
            }
        }
    }
}

/// Returns a warning about the type that surrounds a level and does not stop the avatar. Returns `None` if there is no
/// such type, or if it is named like a wall, because the game already has a warning about it.
pub(crate) fn open_border(game: &Game, level: &Level) -> Option<Diagnostic> {
    let (columns, rows) = (level.columns(), level.rows());
    if columns < LEAST_SIDE || rows < LEAST_SIDE {
        return None;
    }
    let places = |at: usize| game.places(level.cells()[at]);
    let is_edge = |at: &usize| {
        let (column, row) = (at % columns, at / columns);
        column == 0 || row == 0 || column + 1 == columns || row + 1 == rows
    };
    let (edge, inner): (Vec<usize>, Vec<usize>) = (0..columns * rows).partition(is_edge);
    let surrounds = |wall: &SpriteType| edge.iter().all(|&at| places(at).contains(wall));
    let is_ground =
        |wall: SpriteType| 2 * inner.iter().filter(|&&at| places(at).contains(&wall)).count() > inner.len();
    let mut walls = places(0).iter().copied().filter(surrounds);
    let (wall, avatar) = walls.find_map(|wall| Some((wall, open_to(game, wall)?)))?;
    // A type that is named like a wall has its own warning.
    (!is_named(game, wall) && !is_ground(wall)).then(|| warning(game, wall, avatar, Span::new(0, 0)))
}

/// Returns an avatar type that a level can place, if the type `wall` is Immovable and does not stop avatars.
/// `wall` stops no avatar if no rule involves an avatar together with `wall`, or together with a type that
/// some character places along with `wall`.
fn open_to(game: &Game, wall: SpriteType) -> Option<SpriteType> {
    let info = &game.0.types[wall.index()];
    let is_avatar = |stype: SpriteType| game.class(stype).is_some_and(SpriteClass::is_avatar);
    let is = |word: &Word, is: &dyn Fn(SpriteType) -> bool| {
        let written = game.sprite_type(&word.text);
        written.is_some_and(|written| game.0.types[written.index()].tree.iter().any(|&stype| is(stype)))
    };
    let symbols = || game.description().mapping.iter().filter_map(|line| u8::try_from(line.symbol).ok());
    let placed = symbols().map(|symbol| game.places(symbol)).filter(|places| places.contains(&wall));
    let company: Vec<SpriteType> = placed.flatten().copied().chain([wall]).collect();
    let joins = |line: &InteractionLine| {
        let is_wall = |word: &Word| is(word, &|stype| company.contains(&stype));
        let plays = |word: &Word| is(word, &is_avatar);
        line.second
            .iter()
            .any(|second| is_wall(&line.first) && plays(second) || plays(&line.first) && is_wall(second))
    };
    let is_open = info.leaf && info.class == Some(SpriteClass::Immovable);
    if !is_open || game.description().interactions.iter().any(joins) {
        return None;
    }
    symbols().flat_map(|symbol| game.places(symbol)).copied().find(|&stype| is_avatar(stype))
}

fn is_named(game: &Game, wall: SpriteType) -> bool {
    game.name(wall).to_lowercase().contains("wall")
}

fn warning(game: &Game, wall: SpriteType, avatar: SpriteType, span: Span) -> Diagnostic {
    let (wall, avatar) = (game.name(wall), game.name(avatar));
    let message = format!("`{wall}` does not stop `{avatar}`: no rule applies to the two");
    Diagnostic::warning("open-wall", span, message).help(format!("add `{avatar} {wall} > stepBack`"))
}
