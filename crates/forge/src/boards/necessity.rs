//! The interactions without which a board cannot be won, or cannot be won as quickly.

use super::shortest::{Limits, shortest_win};
use base::Seed;
use engine::{Action, Analysis, Episode, Level, Outcome};
use std::collections::BTreeMap;

/// The minimum length, as a percentage of the known win's ticks, at which a win without an interaction counts as
/// different.
const LONGER: usize = 115;

/// Variants of a game with their analyses. Each variant omits one interaction.
pub(crate) struct Ablations {
    without: BTreeMap<usize, Analysis>,
}

impl Ablations {
    /// Analyses the variants. Costs one analysis per interaction.
    pub(crate) fn of(analysis: &Analysis) -> Ablations {
        let game = analysis.game();
        let lines = 0..game.description().interactions.len();
        Ablations { without: lines.map(|line| (line, Analysis::of(&game.without(line)))).collect() }
    }

    /// Returns which of the given interactions a level's win needs, and the number of calls. Each search for a
    /// different win may make `calls` calls.
    pub(crate) fn needed(
        &self,
        lines: impl IntoIterator<Item = usize>,
        level: &Level,
        win: &Episode,
        calls: u64,
    ) -> (Vec<usize>, u64) {
        let (mut needed, mut all) = (Vec::new(), 0);
        for line in lines {
            let (is_needed, spent) = self.needs(line, level, &win.actions, win.seed, calls);
            needed.extend(is_needed.then_some(line));
            all += spent;
        }
        (needed, all)
    }

    /// Returns whether a level's win needs an interaction, and the number of calls. The win needs the interaction if
    /// its actions do not win without the interaction, and no other win of similar length is found.
    fn needs(&self, line: usize, level: &Level, win: &[Action], seed: Seed, calls: u64) -> (bool, u64) {
        let Some(analysis) = self.without.get(&line) else { return (false, 0) };
        let game = analysis.game();
        let start = game.start(level, seed);
        let mut state = start.clone();
        let mut played = 0;
        for &action in win {
            played += 1;
            match game.step(&mut state, action) {
                Outcome::Ongoing => {}
                Outcome::Won => return (false, played),
                _ => break,
            }
        }
        let ticks = (win.len() * LONGER).div_ceil(100).saturating_sub(1);
        let found = shortest_win(analysis, &start, Limits { calls, ticks });
        (found.win.is_none(), played + found.calls)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::Game;

    const GAME: &str = "BasicGame\n  SpriteSet\n    wall > Immovable\n    gate > Immovable\n    key > Resource limit=2\n    bead > Immovable\n    plum > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    G > gate\n    k > key\n    b > bead\n    p > plum\n  InteractionSet\n    avatar wall > stepBack\n    gate avatar > killIfOtherHasMore resource=key limit=1\n    avatar gate > stepBack\n    key avatar > collectResource\n    bead avatar > killSprite scoreChange=1\n    plum avatar > killSprite\n  TerminationSet\n    SpriteCounter stype=avatar win=False\n    SpriteCounter stype=plum win=True\n";

    #[test]
    fn a_key_is_needed_and_a_bead_is_not() {
        let game = Game::from_source(GAME).unwrap();
        let analysis = Analysis::of(&game);
        let seed = Seed::from_text("necessity");
        let level = game.level("wwwwwww\nwkAbGpw\nwwwwwww\n").unwrap();
        let limits = Limits { calls: 10_000, ticks: 40 };
        let found = shortest_win(&analysis, &game.start(&level, seed), limits);
        let win = found.win.expect("the level can be won");
        // The key is one step away, and the plum is four more steps away. The gate stops the avatar in the tick in
        // which the gate opens.
        assert_eq!((win.len(), found.is_proved), (6, true));
        let ablations = Ablations::of(&analysis);
        let needs = |line: usize| ablations.needs(line, &level, &win, seed, 10_000).0;
        assert!(needs(1), "the gate must open");
        assert!(needs(3), "the key must be taken");
        assert!(!needs(4), "the bead is only worth a point");
        let shut = game.level("wwwwww\nw AGpw\nwwwwww\n").unwrap();
        let found = shortest_win(&analysis, &game.start(&shut, seed), limits);
        assert!(found.win.is_none() && found.is_proved, "there is no key");
    }
}
