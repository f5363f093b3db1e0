//! The meaningful steps of an episode (`spec/06` §2.1).
//!
//! The paper calls a step meaningful if it earned a reward or if its action changed the grid. Moves that
//! cancel each other within four steps are not meaningful.
//!
//! An action's effect is determined by comparison with a counterfactual: the observation that would follow
//! from the same state, with the same randomness, if the player had done nothing. Sprites that move by
//! themselves look the same in both observations, so only the player's own effects differ.

/// The maximum number of steps within which moves cancel each other.
pub const WINDOW: usize = 4;

/// An action's effect, compared with doing nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// The result is the same as after doing nothing, and there is no reward.
    Nothing,
    /// Only the avatar's position differs from the result of doing nothing, and there is no reward.
    Moved,
    /// The action earned a reward, or had an effect other than a move. For example, a sprite appeared,
    /// vanished, changed or moved, the avatar turned into a different type, or the game ended.
    Acted,
}

/// Returns, for each step, `true` if the step is meaningful. `places` contains the avatar's position before
/// the first step and after each step. A position is `None`, or missing at the end, while there is no avatar.
///
/// A step with effect [`Acted`](Effect::Acted) is meaningful. A step with effect [`Moved`](Effect::Moved) is
/// meaningful unless it is part of a loop. A loop closes when the avatar returns to the position that it had
/// before one of the last [`WINDOW`] steps, and all steps since then only moved it. The moves of a closed
/// loop cancel each other, and the loop is removed from the walk. In the walk A B A B C, the first two moves
/// cancel each other, and the last two moves lead from A to C. Cost: O(steps).
///
/// ```
/// use infinite_arcade_evaluation::metrics::{Effect::{Acted, Moved, Nothing}, meaningful};
/// // The avatar moves back and forth, bumps into a wall, walks on, and then pushes a box.
/// let places = [0, 1, 0, 0, 1, 2].map(Some);
/// let flags = meaningful(&[Moved, Moved, Nothing, Moved, Acted], &places);
/// assert_eq!(flags, [false, false, false, true, true]);
/// ```
pub fn meaningful<P: Copy + PartialEq>(effects: &[Effect], places: &[Option<P>]) -> Vec<bool> {
    let mut flags: Vec<bool> = effects.iter().map(|effect| *effect != Effect::Nothing).collect();
    // The walk since the last step that acted, without loops. Each move is stored with the position that it
    // started from.
    let mut walk: Vec<(usize, P)> = Vec::new();
    for (step, effect) in effects.iter().enumerate() {
        let place = |at: usize| places.get(at).copied().flatten();
        let (Some(from), Some(to), true) = (place(step), place(step + 1), *effect != Effect::Acted) else {
            walk.clear();
            continue;
        };
        if from == to {
            continue;
        }
        walk.push((step, from));
        if let Some(start) = walk.iter().position(|&(left, place)| place == to && step - left < WINDOW) {
            walk.drain(start..).for_each(|(cancelled, _)| flags[cancelled] = false);
        }
    }
    flags
}

#[cfg(test)]
mod tests {
    use super::Effect::{Acted, Moved, Nothing};
    use super::*;

    /// Checks the flags of a walk. Positions are written as letters, with `-` for a missing position. Effects
    /// are written as `m`, `a` or `.`, and flags as `1` or `0`.
    #[track_caller]
    fn check(places: &str, effects: &str, expect: &str) {
        let places: Vec<Option<char>> =
            places.chars().map(|place| Some(place).filter(|&p| p != '-')).collect();
        let effects: Vec<Effect> = effects
            .chars()
            .map(|effect| match effect {
                'm' => Moved,
                'a' => Acted,
                _ => Nothing,
            })
            .collect();
        let found: String =
            meaningful(&effects, &places).iter().map(|&flag| if flag { '1' } else { '0' }).collect();
        assert_eq!(found, expect);
    }

    #[test]
    fn walks() {
        check("a", "", "");
        check("abcd", "mmm", "111");
        check("aabb", ".m.", "010");
    }

    #[test]
    fn moves_that_cancel_each_other() {
        check("aba", "mm", "00");
        // The first two moves cancel each other, and other moves follow.
        check("ababc", "mmmm", "0011");
        // Two pairs of moves cancel each other. The pairs are successive or nested.
        check("ababa", "mmmm", "0000");
        check("abcba", "mmmm", "0000");
        // Four moves form a loop around a block.
        check("abcda", "mmmm", "0000");
        // A bump into a wall or a pause between the moves also counts as a step of the window.
        check("abba", "m.m", "000");
        check("abbba", "m..m", "0000");
        check("abbbba", "m...m", "10001");
        // A loop of six moves is not cancelled.
        check("abcdefa", "mmmmmm", "111111");
    }

    /// A walk that collects something and returns has changed the state, so it does not cancel out.
    #[test]
    fn effects_on_the_game_are_never_cancelled() {
        check("aba", "am", "11");
        check("aba", "ma", "11");
        check("abba", "mam", "111");
        check("ababa", "ammm", "1001");
    }

    /// A slide is not one of the player's actions, but it is part of the walk.
    #[test]
    fn moved_by_something_else() {
        check("aba", "m.", "00");
        check("abc", "..", "00");
    }

    #[test]
    fn without_an_avatar() {
        check("ab-ba", "m..m", "1001");
        check("---", ".a", "01");
    }
}
