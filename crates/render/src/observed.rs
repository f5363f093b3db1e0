//! Images of a player's observations.

use crate::board::{framed, over};
use crate::error::RenderError;
use crate::looks::glyph::Glyph;
use crate::looks::look::Looks;
use crate::looks::shape::unit;
use crate::picture::{Picture, Place};
use crate::style::Style;
use engine::{MoverView, Observation};

/// Draws an observation without adding any information. Sprites fill the cells that they overlap, and only
/// the avatar and signs show a front. The avatar is drawn once, in the cell that contains its centre. The
/// image has no caption, even if the style requests one. Cost: O(cells).
///
/// # Errors
///
/// Returns an error if the cell size is out of range, or the image would be too large.
pub fn observed(looks: &Looks, observation: &Observation, style: &Style) -> Result<Picture, RenderError> {
    let style = Style { caption: false, ..*style };
    let (columns, size) = (observation.columns, (observation.columns as u32, observation.rows as u32));
    let (picture, _) = framed(looks, size, &style, |picture, left| {
        let at = |column: i32, row: i32| Place {
            x: left as f32 + column as f32 * style.cell as f32,
            y: row as f32 * style.cell as f32,
            w: style.cell as f32,
            h: style.cell as f32,
        };
        let avatar = observation.avatar.as_ref();
        for (cell, names) in observation.cells.iter().enumerate() {
            let (column, row) = ((cell % columns) as i32, (cell / columns) as i32);
            let own = avatar.filter(|avatar| (avatar.column, avatar.row) == (column, row));
            let others = names.iter().filter(|name| avatar.is_none_or(|avatar| avatar.name != **name));
            let mut covered = false;
            for name in others.chain(own.map(|avatar| &avatar.name)) {
                let Some(stype) = looks.game().sprite_type(name) else { continue };
                let look = looks.look(stype);
                let ground = look.form.is_ground();
                let place = at(column, row);
                let place = if covered && !ground { over(place) } else { place };
                covered |= !ground;
                let turns = look.glyph.turns() || look.glyph == Glyph::Avatar;
                let is_here =
                    |mover: &&MoverView| mover.name == *name && (mover.column, mover.row) == (column, row);
                let front = match own.filter(|avatar| turns && avatar.name == *name) {
                    Some(avatar) => unit((avatar.facing.x, avatar.facing.y)),
                    // Signs that have been turned are listed among the movers.
                    None if matches!(look.glyph, Glyph::Sign | Glyph::Pointer) => {
                        let set = observation.movers.iter().find(is_here);
                        set.map_or(looks.front(stype), |mover| unit((mover.facing.x, mover.facing.y)))
                    }
                    None => None,
                };
                picture.sprite(place, name, look, front);
            }
        }
    })?;
    Ok(picture)
}
