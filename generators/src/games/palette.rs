//! Level characters and colours, distinct within a game and consistent across games.

use crate::kernels::words::scene::Scene;

/// The characters for types whose names contain no free letter.
const SPARE: &str = "123456789*+=%&@?!^~$";

/// Returns a level character for a type. The character is the first free letter of its name, in lower or upper case, or
/// otherwise a free symbol.
///
/// In every game, `.`, `w` and `A` represent floor, walls and the avatar.
pub(crate) fn symbol(name: &str, taken: &[char]) -> char {
    free_symbol(name, taken).expect("a game has fewer types than there are characters")
}

/// Returns a level character like [`symbol`], or `None` if no letter in the name and no symbol is free.
pub(crate) fn free_symbol(name: &str, taken: &[char]) -> Option<char> {
    let small = name.chars().map(|letter| letter.to_ascii_lowercase());
    let large = name.chars().map(|letter| letter.to_ascii_uppercase());
    let reserved = ['.', 'w', 'A'];
    let mut candidates = small.take(1).chain(large).chain(name.chars().map(|c| c.to_ascii_lowercase()));
    candidates
        .find(|symbol| !taken.contains(symbol) && !reserved.contains(symbol))
        .or_else(|| SPARE.chars().find(|symbol| !taken.contains(symbol)))
}

/// The colours of VGDL. Colours that contrast with floors come first.
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

/// Returns a colour for a type. Floors and walls use the scene's colour. Other types use a free colour that suits
/// their role, or otherwise the first free colour.
pub(crate) fn color(role: &str, scene: &'static Scene, taken: &[&'static str]) -> &'static str {
    match role {
        "floor" => return &scene.floor_color,
        "wall" => return &scene.wall_color,
        _ => {}
    }
    let suits = suiting(role);
    let free = |color: &&&'static str| !taken.contains(*color);
    suits.iter().find(free).or_else(|| COLORS.iter().find(free)).or(suits.first()).unwrap_or(&COLORS[0])
}

fn suiting(role: &str) -> &'static [&'static str] {
    match role {
        "hero" => &["GREEN", "LIGHTGREEN"],
        "exit" | "haven" | "outlet" => &["LIGHTBLUE", "BLUE"],
        "key" | "relic" | "trophy" | "coin" => &["GOLD", "YELLOW"],
        "prize" | "lamp" | "ingot" => &["YELLOW", "LIGHTYELLOW"],
        "treasure" | "cargo" | "friend" => &["PINK", "LIGHTYELLOW"],
        "door" | "gate" | "chest" | "crate" | "cart" => &["BROWN", "ORANGE"],
        "soil" | "plot" | "idol" | "archway" => &["BROWN", "LIGHTORANGE"],
        "rubble" | "statue" | "cover" => &["LIGHTGRAY", "GRAY"],
        "dark" | "portal" | "gulf" => &["DARKBLUE", "BLACK"],
        "hunter" | "trap" | "pest" => &["RED", "LIGHTRED"],
        "stroller" | "patrol" | "rover" | "bomber" | "snuffer" | "slug" => {
            &["LIGHTRED", "ORANGE", "RED", "PINK"]
        }
        "nest" | "shooter" | "vent" => &["DARKGREEN", "DARKGRAY", "BLACK"],
        "shot" | "drop" | "blast" | "charge" => &["ORANGE", "LIGHTORANGE"],
        "steam" | "bolt" | "blade" => &["WHITE", "LIGHTGRAY"],
        "trail" | "creep" | "plant" | "bush" | "crop" => &["DARKGREEN", "LIGHTGREEN"],
        "remedy" | "ward" | "torch" => &["WHITE", "LIGHTORANGE"],
        "seed" | "ore" | "food" | "fruit" | "tree" => &["LIGHTORANGE", "PINK", "ORANGE"],
        "lever" | "plate" | "socket" | "customer" | "forge" | "ammo" | "rack" => &["BLUE", "LIGHTGRAY"],
        _ => &[],
    }
}
