//! A level's map, which is a graph of rooms in the language of kernel files.
//!
//! ```text
//! home: hero, exit@far
//! east: large, pillars, prize*2-3@far, patrol@lane
//! home -bridge over gulf- east
//! home - east
//! ```

/// A graph of rooms.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Map {
    pub(crate) rooms: Vec<Room>,
    pub(crate) links: Vec<Link>,
}

/// A room and its contents.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Room {
    pub(crate) name: String,
    pub(crate) size: Size,
    pub(crate) style: Style,
    /// The type that covers all free floor.
    pub(crate) fill: Option<String>,
    pub(crate) piece: Option<PieceUse>,
    pub(crate) items: Vec<Item>,
}

/// A drawn piece that forms a room.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PieceUse {
    pub(crate) name: String,
    /// `true` if the piece must not be mirrored.
    pub(crate) as_is: bool,
}

/// A room's size.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Size {
    Small,
    #[default]
    Medium,
    Large,
    Wide,
    Tall,
    /// Corridors one cell wide between the openings.
    Corridor,
}

/// A room's interior walls.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Style {
    /// No interior walls, except that all four corners may be cut.
    #[default]
    Plain,
    Open,
    Pillars,
    Bends,
    /// A block in the middle that the player can circle.
    Ring,
}

/// Sprites of one type to place in a room.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Item {
    pub(crate) stype: String,
    /// The minimum and maximum number of sprites.
    pub(crate) count: (u32, u32),
    pub(crate) place: Place,
}

/// The preferred position of sprites in a room.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Place {
    /// Positions away from other sprites and from openings.
    #[default]
    Fair,
    /// Positions as far from the entry as possible.
    Far,
    /// Positions near the entry.
    Near,
    Centre,
    Corner,
    /// Positions on the longest free line along the type's direction of movement.
    Lane,
    /// Positions next to each other in a line.
    Row,
    /// Positions next to a wall.
    Wall,
}

/// A connection between two rooms.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Link {
    pub(crate) between: (usize, usize),
    /// The type in the opening.
    pub(crate) stype: Option<String>,
    /// The number of openings.
    pub(crate) openings: u32,
    /// The type that forms the border between the two rooms.
    pub(crate) border: Option<String>,
    /// `true` for an opening three cells wide.
    pub(crate) is_wide: bool,
}

/// An error in a line of a map.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{line}`: {message}")]
pub(crate) struct MapError {
    line: String,
    message: String,
}

impl Map {
    /// Reads a level's map.
    ///
    /// # Errors
    /// Returns an error for the first line that cannot be parsed or that names an unknown room. Also returns an error
    /// if a room is unreachable.
    pub(crate) fn read(text: &str) -> Result<Map, MapError> {
        let mut map = Map::default();
        let lines = || text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
        for line in lines() {
            let fail = |message: String| MapError { line: line.to_owned(), message };
            if let Some((name, tokens)) = line.split_once(':') {
                let room = room(name.trim(), tokens).map_err(fail)?;
                if map.room(&room.name).is_some() {
                    return Err(fail("this room is already defined".to_owned()));
                }
                map.rooms.push(room);
            }
        }
        for line in lines().filter(|line| !line.contains(':')) {
            let fail = |message: String| MapError { line: line.to_owned(), message };
            let link = map.link(line).map_err(fail)?;
            map.links.push(link);
        }
        if let Some(room) = map.unreachable() {
            let line = map.rooms[room].name.clone();
            return Err(MapError {
                line,
                message: "no chain of links leads from the first room to this room".to_owned(),
            });
        }
        Ok(map)
    }

    fn room(&self, name: &str) -> Option<usize> {
        self.rooms.iter().position(|room| room.name == name)
    }

    fn link(&self, line: &str) -> Result<Link, String> {
        let room =
            |name: &str| self.room(name.trim()).ok_or_else(|| format!("there is no room `{}`", name.trim()));
        if let Some((one, two)) = line.split_once('>') {
            let between = (room(one)?, room(two)?);
            return Ok(Link { between, stype: None, openings: 1, border: None, is_wide: true });
        }
        let (one, rest) = line.split_once('-').ok_or("neither a room (`name: …`) nor a link (`a - b`)")?;
        let (inside, two) = rest.rsplit_once('-').unwrap_or(("", rest));
        let (opening, border) = match inside.split_once(" over ") {
            Some((opening, border)) => (opening.trim(), Some(border.trim().to_owned())),
            None => (inside.trim(), None),
        };
        let (stype, openings) = counted(opening)?;
        let between = (room(one)?, room(two)?);
        if between.0 == between.1 {
            return Err("a room is linked to itself".to_owned());
        }
        let stype = (!stype.is_empty()).then(|| stype.to_owned());
        Ok(Link { between, stype, openings: openings.1, border, is_wide: false })
    }

    /// Returns a room that is unreachable from the first room; `None` if all rooms are reachable.
    fn unreachable(&self) -> Option<usize> {
        let mut reached = vec![false; self.rooms.len()];
        let mut open = vec![0];
        while let Some(room) = open.pop() {
            if room < reached.len() && !std::mem::replace(&mut reached[room], true) {
                open.extend(self.links.iter().filter_map(|link| link.from(room)));
            }
        }
        reached.iter().position(|reached| !reached)
    }

    /// Returns the map without bare dead ends. A bare dead end is a room with a single link, where neither the room nor
    /// the opening contains a type of the game.
    #[must_use]
    pub(crate) fn without_bare_ends(mut self, is_present: impl Fn(&str) -> bool) -> Map {
        let is_bare = |map: &Map, number: usize| {
            let room = &map.rooms[number];
            let mut links = map.links.iter().filter(|link| link.from(number).is_some());
            let (first, others) = (links.next(), links.next());
            let holds = |stype: &Option<String>| stype.as_deref().is_some_and(&is_present);
            room.piece.is_none()
                && !holds(&room.fill)
                && !room.items.iter().any(|item| is_present(&item.stype) && item.count.1 > 0)
                && others.is_none()
                && first.is_some_and(|link| !holds(&link.stype) && !holds(&link.border))
        };
        while let Some(bare) = (0..self.rooms.len()).find(|&number| is_bare(&self, number)) {
            self.rooms.remove(bare);
            self.links.retain(|link| link.from(bare).is_none());
            for link in &mut self.links {
                let moved = |room: usize| if room > bare { room - 1 } else { room };
                link.between = (moved(link.between.0), moved(link.between.1));
            }
        }
        self
    }

    /// Returns the types placed by the map, first in rooms and then in links, with repetitions.
    pub(crate) fn types(&self) -> impl Iterator<Item = &str> {
        let rooms = self.rooms.iter();
        let placed = rooms.flat_map(|room| room.items.iter().map(|item| &item.stype).chain(&room.fill));
        placed
            .chain(self.links.iter().flat_map(|link| link.stype.iter().chain(&link.border)))
            .map(String::as_str)
    }
}

impl Link {
    /// Returns the room at the other end of the link; `None` if the link does not connect `room`.
    pub(crate) fn from(&self, room: usize) -> Option<usize> {
        match self.between {
            (one, two) if one == room => Some(two),
            (one, two) if two == room => Some(one),
            _ => None,
        }
    }
}

fn room(name: &str, tokens: &str) -> Result<Room, String> {
    let mut room = Room {
        name: name.to_owned(),
        size: Size::default(),
        style: Style::default(),
        fill: None,
        piece: None,
        items: Vec::new(),
    };
    for token in tokens.split(',').map(str::trim).filter(|token| !token.is_empty()) {
        match token {
            "small" => room.size = Size::Small,
            "large" => room.size = Size::Large,
            "wide" => room.size = Size::Wide,
            "tall" => room.size = Size::Tall,
            "corridor" => room.size = Size::Corridor,
            "open" => room.style = Style::Open,
            "pillars" => room.style = Style::Pillars,
            "bends" => room.style = Style::Bends,
            "ring" => room.style = Style::Ring,
            _ => {
                if let Some(stype) = token.strip_prefix("fill ") {
                    room.fill = Some(stype.trim().to_owned());
                } else if let Some(piece) = token.strip_prefix("draw ") {
                    let piece = piece.trim();
                    let (name, as_is) = match piece.strip_suffix(" as-is") {
                        Some(name) => (name.trim(), true),
                        None => (piece, false),
                    };
                    room.piece = Some(PieceUse { name: name.to_owned(), as_is });
                } else {
                    room.items.push(item(token)?);
                }
            }
        }
    }
    Ok(room)
}

fn item(token: &str) -> Result<Item, String> {
    let (what, place) = match token.split_once('@') {
        None => (token, Place::Fair),
        Some((what, place)) => (what, self::place(place.trim())?),
    };
    let (stype, count) = counted(what.trim())?;
    if !stype.chars().all(|c| c.is_ascii_alphanumeric()) || stype.is_empty() {
        return Err(format!("`{token}` is neither a type nor a property of rooms"));
    }
    Ok(Item { stype: stype.to_owned(), count, place })
}

fn place(name: &str) -> Result<Place, String> {
    Ok(match name {
        "far" => Place::Far,
        "near" => Place::Near,
        "centre" => Place::Centre,
        "corner" => Place::Corner,
        "lane" => Place::Lane,
        "row" => Place::Row,
        "wall" => Place::Wall,
        _ => return Err(format!("there is no place `@{name}`")),
    })
}

/// Splits `type*2-4` into the type and the range of counts.
fn counted(text: &str) -> Result<(&str, (u32, u32)), String> {
    let Some((stype, count)) = text.split_once('*') else { return Ok((text, (1, 1))) };
    let number = |text: &str| text.trim().parse().map_err(|_| format!("`{text}` is not a number of sprites"));
    let (least, most) = match count.split_once('-') {
        None => (number(count)?, number(count)?),
        Some((least, most)) => (number(least)?, number(most)?),
    };
    if least > most || most > 40 {
        return Err(format!("`{count}` is not a number of sprites from 0 to 40"));
    }
    Ok((stype.trim(), (least, most)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bare_dead_ends_are_left_out() {
        let text = "home: hero\nquay: exit\nhall: prize\nnook: small\nlair: small\nhome - quay\nhome - hall\nquay - nook\nhall -door- lair";
        let map = Map::read(text).unwrap();
        let rooms = |present: &[&str]| {
            let map = map.clone().without_bare_ends(|stype| present.contains(&stype));
            assert!(map.links.iter().all(|link| link.between.0.max(link.between.1) < map.rooms.len()));
            map.rooms.into_iter().map(|room| room.name).collect::<Vec<_>>()
        };
        assert_eq!(rooms(&["hero", "exit", "prize", "door"]), ["home", "quay", "hall", "lair"]);
        assert_eq!(rooms(&["hero", "prize"]), ["home", "hall"]);
    }
}
