//! The names of the files in a release.

use crate::format::manifest::item::ReleaseKind;

/// The README, for human readers.
pub(crate) const README_FILE: &str = "README.md";

/// The file that describes a whole release, for programs.
pub const RELEASE_CARD_FILE: &str = "CARD.json";

/// The file that contains a sealed release's secret. It is withheld until the reveal.
pub const SECRET_FILE: &str = "held/secret.json";
/// The folder for the files of a sealed release that are withheld until the reveal.
pub const HELD: &str = "held/";

/// Returns the path of a level's witness in a release. `game` is the name of the game's folder in `games`.
pub(crate) fn witness_path(kind: ReleaseKind, game: &str, level: usize) -> String {
    match kind {
        ReleaseKind::Open => format!("games/{game}/witness/lvl{level}.json"),
        ReleaseKind::Sealed => format!("{HELD}{game}/lvl{level}.json"),
    }
}

/// The folder for siblings, which are the renamed copies of games that are withheld for memory tests.
pub(crate) const SIBLINGS: &str = "held/siblings/";

/// Returns the path of a file in a game's withheld sibling (renamed copy). `game` is the name of the game's folder in
/// `games`.
pub(crate) fn sibling_path(game: &str, file: &str) -> String {
    format!("{SIBLINGS}{game}/{file}")
}

/// Returns the path of a level's withheld win.
pub(crate) fn second_path(game: &str, level: usize) -> String {
    format!("{HELD}seconds/{game}/lvl{level}.json")
}

/// Returns `true` if a withheld file is one of the wins that the memory tests publish early.
pub(crate) fn is_solution(path: &str) -> bool {
    path.strip_prefix(HELD).is_some_and(|file| file.split('/').count() == 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solutions_are_told_from_what_stays_withheld() {
        assert!(is_solution("held/mole-845b9ea3/lvl0.json"));
        for other in ["held/secret.json", "held/MARKS.json", "games/mole-845b9ea3/lvl0.txt"] {
            assert!(!is_solution(other), "{other}");
        }
        assert!(!is_solution(&second_path("mole-845b9ea3", 0)));
        assert!(!is_solution(&sibling_path("mole-845b9ea3", "game.vgdl")));
    }
}
