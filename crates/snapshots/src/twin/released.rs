//! Twins of released games, which are copies with a different surface.

use super::{Made, Original, Twin, TwinError, TwinGame, of_levels};
use crate::released::{ReleasedGame, ReleasedSibling};

/// The words that indicate a side, except `left`, which mostly means "remaining".
const SIDES: [&str; 7] = ["leftward", "leftwards", "right", "rightward", "rightwards", "west", "east"];

/// Creates a released game's twin. A mirrored twin keeps the texts on the game's card unless they mention a
/// side.
///
/// # Errors
/// Returns an error if the game has no twin of this kind.
pub fn of_released(kind: Twin, released: &ReleasedGame) -> Result<TwinGame, TwinError> {
    if kind == Twin::Sibling {
        let sibling = released.sibling.as_ref().ok_or(TwinError::NoSibling)?;
        return of_sibling(released, sibling);
    }
    let levels: Vec<String> = released.levels.iter().map(|level| level.text.clone()).collect();
    let witnesses = released.levels.iter().map(|level| level.witness.as_ref()).collect();
    let mut twin = of_levels(kind, &released.source, &levels, witnesses)?;
    if kind == Twin::Mirrored {
        let card = &released.card;
        for (own, told) in [(&mut twin.description, &card.description), (&mut twin.goal, &card.goal)] {
            if !names_a_side(told) {
                own.clone_from(told);
            }
        }
    }
    Ok(twin)
}

/// Creates the twin from a game's sibling (its withheld renamed copy), with the game's witnesses.
fn of_sibling(released: &ReleasedGame, sibling: &ReleasedSibling) -> Result<TwinGame, TwinError> {
    let original = Original {
        game: sibling.game.clone(),
        levels: Vec::new(),
        witnesses: released.levels.iter().map(|level| level.witness.as_ref()).collect(),
    };
    let levels = sibling.levels.iter().map(|(text, _)| text.clone()).collect();
    let Made { twin, .. } = Made::of(&original, sibling.game.description(), levels, |action| action)?;
    let title = original.title().unwrap_or_default();
    Ok(TwinGame { text: sibling.source.clone(), title, ..twin })
}

fn names_a_side(text: &str) -> bool {
    let text = text.to_lowercase();
    let mut words = text.split(|c: char| !c.is_alphabetic());
    text.contains("the left") || text.contains("to left") || words.any(|word| SIDES.contains(&word))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_with_a_side() {
        assert!(names_a_side("Steam drifts to the left."));
        assert!(names_a_side("The wind is from the East, always."));
        assert!(!names_a_side("You win when no feast is left."));
    }
}
