//! The roles of sprite types in kernels (game designs) and scenes (themes), and the colours of each role.

use crate::games::palette::COLORS;

/// The colours suitable for each role.
const SUITING: &[(&[&str], &[&str])] = &[
    (&["hero"], &["GREEN", "LIGHTGREEN"]),
    (&["exit", "haven", "outlet", "portal", "sky"], &["LIGHTBLUE", "BLUE"]),
    (&["key", "prize", "coin", "treasure"], &["GOLD", "YELLOW", "LIGHTYELLOW"]),
    (
        &["door", "gate", "crate", "bridge", "soil", "yard", "plot", "dam", "trough"],
        &["BROWN", "ORANGE", "LIGHTORANGE"],
    ),
    (&["gulf", "pit", "shade", "flood"], &["DARKBLUE", "BLUE", "BLACK"]),
    (&["ice", "pane", "screen", "grille"], &["LIGHTBLUE", "WHITE"]),
    (
        &["rubble", "guard", "plate", "socket", "firm", "stone", "grave", "source"],
        &["LIGHTGRAY", "GRAY", "DARKGRAY"],
    ),
    (&["hunter", "raider", "fire", "pest", "thief"], &["RED", "LIGHTRED"]),
    (&["patrol", "bomber", "stroller", "beast", "rival", "shooter"], &["LIGHTRED", "ORANGE", "PINK", "RED"]),
    (&["sleeper", "nest", "den", "bird", "dust"], &["GRAY", "DARKGRAY", "DARKGREEN"]),
    (&["friend", "cargo", "customer", "prey", "keeper"], &["PINK", "LIGHTYELLOW", "LIGHTORANGE"]),
    (&["shot", "bolt", "blade", "blast", "charge", "embers"], &["ORANGE", "LIGHTORANGE"]),
    (&["plant", "seed", "food", "bait", "trail", "brush"], &["DARKGREEN", "LIGHTGREEN"]),
    (&["fuel", "lamp", "ward", "fireplace", "stove"], &["LIGHTYELLOW", "ORANGE", "YELLOW"]),
    (&["floater", "remedy", "armour", "disguise", "tool", "ammo", "lever"], &["WHITE", "BLUE", "LIGHTGRAY"]),
    (&["well", "spring", "load"], &["BLUE", "LIGHTBLUE"]),
];

/// Returns `true` if a word is a role that has a colour.
pub(crate) fn is_role(word: &str) -> bool {
    SUITING.iter().any(|(roles, _)| roles.contains(&word))
}

/// Returns a colour that suits the role. The colour is not used by any other type, as long as there are enough colours.
pub(crate) fn color(role: &str, taken: &[String]) -> &'static str {
    let suiting =
        SUITING.iter().find(|(roles, _)| roles.contains(&role)).map_or(&[][..], |(_, colors)| colors);
    let free = |color: &&&'static str| !taken.iter().any(|taken| taken == **color);
    suiting.iter().find(free).or_else(|| COLORS.iter().find(free)).unwrap_or(&"WHITE")
}
