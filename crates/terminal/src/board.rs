//! Draws a state as terminal cells. Each cell of the board is two columns wide, and shows its topmost sprite.

use engine::{SpriteType, State};
use ratatui::style::{Color, Modifier, Style};
use render::{Colour, Glyph, Look, Looks, Symbols};
use std::ops::Range;

/// The colour of the empty board.
pub(crate) const GROUND: Color = Color::Indexed(235);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Cell<'a> {
    pub(crate) text: &'a str,
    pub(crate) style: Style,
}

/// The two-column symbol of each sprite type.
pub(crate) struct Signs {
    texts: Vec<String>,
    fallen: &'static str,
    ascii: bool,
}

impl Signs {
    /// Chooses each type's symbol by its glyph (kind of sprite). If several types share a symbol, its second column
    /// shows a different character for each type, so that the types differ in more than colour. Unicode symbols that
    /// fill both columns are left unchanged.
    pub(crate) fn of(looks: &Looks, symbols: &Symbols, ascii: bool) -> Signs {
        let sign = |glyph: Glyph| if ascii { glyph.ascii() } else { glyph.unicode() };
        let text = |stype: SpriteType| {
            let own = sign(looks.look(stype).glyph);
            let is_floor = |stype: SpriteType| looks.look(stype).glyph == Glyph::Floor;
            let like = |&other: &SpriteType| !is_floor(other) && sign(looks.look(other).glyph) == own;
            let kin = looks.shown().filter(like).count();
            let mut characters = own.chars();
            match (characters.next(), characters.next()) {
                (Some(first), Some(second)) if kin > 1 && !is_floor(stype) && (ascii || second == ' ') => {
                    format!("{first}{}", symbols.symbol(stype))
                }
                _ => own.to_owned(),
            }
        };
        let texts = looks.game().sprite_types().map(text).collect();
        Signs { texts, fallen: sign(Glyph::Fallen), ascii }
    }

    /// Returns the cell that shows a sprite type over the background below it.
    pub(crate) fn drawn(&self, looks: &Looks, stype: SpriteType, below: Color) -> Cell<'_> {
        let look = looks.look(stype);
        Cell { text: &self.texts[stype.index()], style: style(look, below, self.ascii) }
    }
}

/// Returns the cells, row by row. A sprite is drawn in the cell that contains its centre, and a large sprite
/// in all cells whose centres it covers. The avatar is never covered.
pub(crate) fn cells<'a>(looks: &Looks, signs: &'a Signs, state: &State) -> Vec<Cell<'a>> {
    let game = looks.game();
    let (columns, rows) = (state.size().0.max(1), state.size().1.max(1));
    let block = state.block().max(1);
    let mut order = vec![0; game.sprite_types().count()];
    for (at, stype) in game.drawing_order().into_iter().enumerate() {
        order[usize::from(stype)] = at;
    }
    let is_own = |stype: u16| matches!(looks.look(SpriteType(stype)).glyph, Glyph::Avatar | Glyph::Craft);
    let mut records = game.records(state);
    records.retain(|record| looks.is_visible(SpriteType(record.stype)));
    records.sort_by_key(|record| (is_own(record.stype), order[usize::from(record.stype)]));
    let empty = Cell { text: "  ", style: Style::new().bg(GROUND) };
    let mut cells = vec![empty; (columns * rows) as usize];
    for record in records {
        let stype = SpriteType(record.stype);
        for row in covered(record.rect.y, record.rect.h, block, rows) {
            for column in covered(record.rect.x, record.rect.w, block, columns) {
                let cell = &mut cells[(row * columns + column) as usize];
                *cell = signs.drawn(looks, stype, cell.style.bg.unwrap_or(GROUND));
                // The flag marks a killed avatar.
                if record.flags & 1 != 0 {
                    cell.text = signs.fallen;
                }
            }
        }
    }
    cells
}

fn style(look: Look, below: Color, ascii: bool) -> Style {
    use Glyph as G;
    let style = Style::new();
    match look.glyph {
        G::Avatar | G::Craft | G::Fallen => {
            style.fg(Color::Indexed(16)).bg(Color::Indexed(45)).add_modifier(Modifier::BOLD)
        }
        G::Exit | G::Treasure | G::Target | G::Prey | G::Socket => {
            style.fg(Color::Indexed(226)).bg(Color::Indexed(22)).add_modifier(Modifier::BOLD)
        }
        G::Enemy | G::Charger | G::HostileShot | G::Hazard | G::Nest | G::Peril => {
            style.fg(light(look.colour)).bg(Color::Indexed(52)).add_modifier(Modifier::BOLD)
        }
        G::Wall | G::Breakable | G::Soil if !ascii => style.fg(indexed(look.colour)).bg(Color::Indexed(238)),
        G::Mire | G::Spring | G::Conveyor => style.fg(light(look.colour)).bg(Color::Indexed(24)),
        G::Floor => style.bg(GROUND),
        _ => style.fg(light(look.colour)).bg(below),
    }
}

/// Returns the range of columns or rows, out of `limit`, that a sprite covers. A sprite covers the column or
/// row that contains its centre. A sprite larger than a cell covers all columns or rows whose centres it
/// reaches.
fn covered(from: i32, size: i32, block: i32, limit: i32) -> Range<i32> {
    let middle = from.saturating_add(size / 2).div_euclid(block);
    let first = from.saturating_add(block / 2).div_euclid(block).min(middle);
    let end =
        from.saturating_add(size).saturating_add(block / 2).div_euclid(block).max(middle.saturating_add(1));
    let (first, end) = if size <= block { (middle, middle.saturating_add(1)) } else { (first, end) };
    first.clamp(0, limit)..end.clamp(0, limit)
}

/// Returns the colour, lightened if necessary to stand out on a dark background.
fn light(Colour(parts): Colour) -> Color {
    let brightest = parts.into_iter().max().unwrap_or(0);
    let lift = 160_u8.saturating_sub(brightest);
    indexed(Colour(parts.map(|part| part.saturating_add(lift))))
}

/// Returns the nearest colour in the 6 × 6 × 6 colour cube of 256-colour terminals.
fn indexed(Colour(parts): Colour) -> Color {
    // The levels of the cube are 0, 95, 135, 175, 215 and 255.
    let step = |part: u8| match part {
        0..48 => 0,
        48..115 => 1,
        part => (part - 35) / 40,
    };
    let [red, green, blue] = parts.map(step);
    Color::Indexed(16 + 36 * red + 6 * green + blue)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_match_the_cube() {
        let check = |parts: [u8; 3], expect: u8| assert_eq!(indexed(Colour(parts)), Color::Indexed(expect));
        check([0, 0, 0], 16);
        check([255, 255, 255], 231);
        check([255, 0, 0], 196);
        check([95, 135, 175], 67);
        assert_eq!(light(Colour([0, 0, 0])), Color::Indexed(16 + 36 * 3 + 6 * 3 + 3));
    }

    #[test]
    fn sprites_cover_cells_by_their_middle() {
        let check = |from: i32, size: i32, expect: Range<i32>| {
            assert_eq!(covered(from, size, 10, 5), expect, "{from} {size}");
        };
        check(0, 10, 0..1);
        check(4, 10, 0..1);
        check(5, 10, 1..2);
        check(-6, 10, 0..0);
        check(48, 10, 5..5);
        check(10, 30, 1..4);
        check(16, 30, 2..5);
        check(-100, 400, 0..5);
        check(13, 4, 1..2);
    }

    #[test]
    fn no_two_types_share_a_sign_of_ascii() {
        let sprites: String =
            (0..12).map(|at| format!("        s{at} > Door\n        b{at} > Passive\n")).collect();
        let letter = |from: u8, at: u8| char::from(from + at);
        let mapping: String = (0..12)
            .map(|at| format!("        {} > s{at}\n        {} > b{at}\n", letter(b'a', at), letter(b'B', at)))
            .collect();
        let rules: String = (0..12)
            .map(|at| format!("        s{at} avatar > killSprite\n        b{at} avatar > bounceForward\n"))
            .collect();
        let source = format!(
            "BasicGame\n    SpriteSet\n{sprites}        avatar > MovingAvatar\n    LevelMapping\n{mapping}    InteractionSet\n{rules}    TerminationSet\n        SpriteCounter stype=s0 win=True\n"
        );
        let game = engine::Game::from_source(&source).unwrap();
        let analysis = engine::Analysis::of(&game);
        let looks = Looks::of(&analysis);
        let signs = Signs::of(&looks, &Symbols::of(&analysis, &looks), true);
        let shown: Vec<SpriteType> =
            looks.shown().filter(|&stype| looks.look(stype).glyph != Glyph::Floor).collect();
        assert!(shown.len() > 20, "{}", shown.len());
        for (at, &stype) in shown.iter().enumerate() {
            let text = &signs.texts[stype.index()];
            assert!(text.is_ascii() && text.len() == 2, "{text}");
            let other = shown[..at].iter().find(|other| signs.texts[other.index()] == *text);
            assert_eq!(other.map(|&other| game.name(other)), None, "{} has `{text}`, too", game.name(stype));
        }
    }

    #[test]
    fn all_symbols_are_two_columns_wide() {
        for &glyph in Glyph::ALL {
            for ascii in [false, true] {
                let text = if ascii { glyph.ascii() } else { glyph.unicode() };
                assert_eq!(ratatui::text::Line::from(text).width(), 2, "{glyph:?}");
                assert!(!ascii || text.is_ascii(), "{glyph:?}");
            }
        }
    }
}
