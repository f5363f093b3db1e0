//! Level characters and colours: distinct within a game, and consistent across games.

use super::role::Role;
use super::theme::Theme;

/// Characters for types whose letters are all taken.
const SPARE: &str = "123456789*+=%&@?!^~$";

/// Returns a level character for a type: the first free letter of its name, small or capital, or a free sign.
///
/// `.`, `w` and `A` are for floor, wall and hero in every game.
pub(crate) fn symbol(name: &str, taken: &[char]) -> char {
    free_symbol(name, taken).expect("a game has fewer types than there are characters")
}

/// The same; returns `None` if no letter of the name and no sign is free.
pub(crate) fn free_symbol(name: &str, taken: &[char]) -> Option<char> {
    let small = name.chars().map(|letter| letter.to_ascii_lowercase());
    let large = name.chars().map(|letter| letter.to_ascii_uppercase());
    let reserved = ['.', 'w', 'A'];
    let mut candidates = small.take(1).chain(large).chain(name.chars().map(|c| c.to_ascii_lowercase()));
    candidates
        .find(|symbol| !taken.contains(symbol) && !reserved.contains(symbol))
        .or_else(|| SPARE.chars().find(|symbol| !taken.contains(symbol)))
}

/// The colours of VGDL, those that stand out from floors first.
pub(crate) const COLORS: [&str; 20] = [
    "YELLOW",
    "RED",
    "LIGHTBLUE",
    "PINK",
    "ORANGE",
    "LIGHTGREEN",
    "WHITE",
    "GOLD",
    "BLUE",
    "LIGHTRED",
    "BROWN",
    "LIGHTORANGE",
    "DARKGREEN",
    "LIGHTYELLOW",
    "DARKBLUE",
    "LIGHTGRAY",
    "GREEN",
    "GRAY",
    "BLACK",
    "DARKGRAY",
];

/// Returns a colour for a type: for floors and walls that of the theme; otherwise a free one that suits its role, or else
/// the first free one.
pub(crate) fn color(role: Role, theme: &Theme, taken: &[&'static str]) -> &'static str {
    match role {
        Role::Floor => return theme.floor,
        Role::Wall => return theme.walls,
        _ => {}
    }
    let suits = suiting(role);
    let free = |color: &&&'static str| !taken.contains(*color);
    suits.iter().find(free).or_else(|| COLORS.iter().find(free)).or(suits.first()).unwrap_or(&COLORS[0])
}

fn suiting(role: Role) -> &'static [&'static str] {
    use Role as R;
    match role {
        // Set by the theme.
        R::Floor | R::Wall => &[],
        R::Hero => &["GREEN", "LIGHTGREEN"],
        R::Exit | R::Haven | R::PortalOut => &["LIGHTBLUE", "BLUE"],
        R::Key | R::Relic | R::Trophy | R::Coin => &["GOLD", "YELLOW"],
        R::Gem | R::Lamp | R::Ingot => &["YELLOW", "LIGHTYELLOW"],
        R::Charm | R::Parcel | R::Friend => &["PINK", "LIGHTYELLOW"],
        R::Door | R::Gate | R::Chest | R::Crate | R::Cart => &["BROWN", "ORANGE"],
        R::Soil | R::Plot | R::Idol | R::Archway => &["BROWN", "LIGHTORANGE"],
        R::Rubble | R::Statue | R::Cover => &["LIGHTGRAY", "GRAY"],
        R::Dark | R::PortalIn | R::Pool => &["DARKBLUE", "BLACK"],
        R::Chaser | R::Trap | R::Pest => &["RED", "LIGHTRED"],
        R::Wanderer | R::Patroller | R::Rover | R::Bomber | R::Snuffer | R::Slug => {
            &["LIGHTRED", "ORANGE", "RED", "PINK"]
        }
        R::Nest | R::Turret | R::Vent => &["DARKGREEN", "DARKGRAY", "BLACK"],
        R::Dart | R::Drop | R::Blast | R::Charge => &["ORANGE", "LIGHTORANGE"],
        R::Steam | R::Bolt | R::Blade => &["WHITE", "LIGHTGRAY"],
        R::Slime | R::Creep | R::Sprout | R::Bush | R::Crop => &["DARKGREEN", "LIGHTGREEN"],
        R::Medicine | R::Ward | R::Torch => &["WHITE", "LIGHTORANGE"],
        R::Seed | R::Ore | R::Berry | R::Fruit | R::Tree => &["LIGHTORANGE", "PINK", "ORANGE"],
        R::Lever | R::Plate | R::Socket | R::Address | R::Forge | R::Ammo | R::Rack => &["BLUE", "LIGHTGRAY"],
    }
}
