//! A state as cells of a terminal: two columns each, the uppermost thing in it.

use engine::{SpriteType, State};
use ratatui::style::{Color, Modifier, Style};
use render::{Colour, Glyph, Look, Looks};

/// The empty board.
const GROUND: Color = Color::Indexed(235);

/// A cell of the board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Cell {
    pub(crate) text: &'static str,
    pub(crate) style: Style,
}

/// The cells, row-major. A sprite is in the cell that its centre is in; what the player steers is never covered.
pub(crate) fn cells(looks: &Looks, state: &State, ascii: bool) -> Vec<Cell> {
    let game = looks.game();
    let (columns, rows) = (state.size().0.max(1), state.size().1.max(1));
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
        let (x, y) = record.rect.centre();
        let cell = |at: f64| (at / f64::from(state.block().max(1))).floor() as i32;
        let (column, row) = (cell(x), cell(y));
        if !(0..columns).contains(&column) || !(0..rows).contains(&row) {
            continue;
        }
        let look = looks.look(SpriteType(record.stype));
        let dead = record.flags & 1 != 0;
        let look = if dead { Look { glyph: Glyph::Fallen, ..look } } else { look };
        let below = &mut cells[(row * columns + column) as usize];
        *below = drawn(look, below.style.bg.unwrap_or(GROUND), ascii);
    }
    cells
}

/// A look in two columns, on what lies below.
pub(crate) fn drawn(look: Look, below: Color, ascii: bool) -> Cell {
    use Glyph as G;
    let text = if ascii { look.glyph.ascii() } else { look.glyph.unicode() };
    let style = Style::new();
    let style = match look.glyph {
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
    };
    Cell { text, style }
}

/// Light enough to be read on a dark ground.
fn light(Colour(parts): Colour) -> Color {
    let brightest = parts.into_iter().max().unwrap_or(0);
    let lift = 160_u8.saturating_sub(brightest);
    indexed(Colour(parts.map(|part| part.saturating_add(lift))))
}

/// The nearest colour of the 6 × 6 × 6 cube of terminals with 256 colours.
fn indexed(Colour(parts): Colour) -> Color {
    // The steps of the cube: 0, 95, 135, 175, 215, 255.
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
    fn colours_are_those_of_the_cube() {
        let check = |parts: [u8; 3], expect: u8| assert_eq!(indexed(Colour(parts)), Color::Indexed(expect));
        check([0, 0, 0], 16);
        check([255, 255, 255], 231);
        check([255, 0, 0], 196);
        check([95, 135, 175], 67);
        assert_eq!(light(Colour([0, 0, 0])), Color::Indexed(16 + 36 * 3 + 6 * 3 + 3));
    }

    #[test]
    fn all_symbols_are_two_columns_wide() {
        for &glyph in Glyph::ALL {
            for ascii in [false, true] {
                let cell = drawn(Look::plain(glyph), GROUND, ascii);
                assert_eq!(ratatui::text::Line::from(cell.text).width(), 2, "{glyph:?}");
                assert!(!ascii || cell.text.is_ascii(), "{glyph:?}");
            }
        }
    }
}
