//! The interactions without which a board cannot be won, or cannot be won as quickly, and the mechanics that matter.

use super::deviations::Deviation;
use super::shortest::{Limits, shortest_win};
use base::Seed;
use engine::{Action, Analysis, Episode, Game, Level, Outcome};
use std::collections::BTreeMap;

/// The minimum length of a win without an interaction, as a percentage of the known win's ticks, at which the two wins
/// count as different. Players do not notice a slightly longer route.
const LONGER: usize = 140;
/// The minimum length of the known win, as a percentage of the length of a win without a threat, at which the threat
/// matters.
const SHORTER: usize = 115;
/// The number of deviations from a win to try in order to find the threats that kill.
const DEVIATIONS: usize = 20;
/// The minimum number of deviations that a threat must make fatal in order to matter.
const FATAL: usize = 2;

/// Variants of a game with their analyses. Each variant omits one interaction, or all interactions of a mechanic.
pub(crate) struct Ablations {
    without: BTreeMap<usize, Analysis>,
    mechanics: Vec<(Vec<usize>, Analysis)>,
}

impl Ablations {
    /// Analyses the variants. `mechanics` lists the interactions of each mechanic. Costs one analysis per interaction
    /// and mechanic.
    pub(crate) fn of(analysis: &Analysis, mechanics: &[Vec<usize>]) -> Ablations {
        let game = analysis.game();
        let lines = 0..game.description().interactions.len();
        let without = lines.map(|line| (line, Analysis::of(&game.without(line)))).collect();
        let without_all = |lines: &Vec<usize>| {
            let game = lines.iter().fold(game.clone(), |game, &line| game.without(line));
            (lines.clone(), Analysis::of(&game))
        };
        let mechanics = mechanics.iter().filter(|lines| !lines.is_empty()).map(without_all).collect();
        Ablations { without, mechanics }
    }

    /// Returns which mechanics matter for a level's win, and the number of calls. `needed` lists the interactions that
    /// the win needs. Mechanics without interactions are omitted from the result.
    ///
    /// A mechanic matters if the win needs one of its interactions. A threat also matters if it makes wrong keys fatal,
    /// or if a clearly shorter win exists without it.
    pub(crate) fn matter(
        &self,
        analysis: &Analysis,
        needed: &[usize],
        level: &Level,
        win: &Episode,
        calls: u64,
    ) -> (Vec<bool>, u64) {
        let (actions, seed) = (&win.actions[..], win.seed);
        let kills = |game: &Game, deviation: &Deviation| deviation.kills(game, level, actions, seed);
        let mut fatal = Deviation::draw(analysis.game(), level, actions, seed, DEVIATIONS);
        fatal.retain(|deviation| kills(analysis.game(), deviation));
        let mut all = 0;
        let mut matters = |(lines, without): &(Vec<usize>, Analysis)| {
            let spared = || fatal.iter().filter(|deviation| !kills(without.game(), deviation)).count();
            let mut is_shorter = || {
                let ticks = win.actions.len() * 100 / SHORTER;
                let found =
                    shortest_win(without, &without.game().start(level, seed), Limits { calls, ticks });
                all += found.calls;
                // A win that also wins with the mechanic only shows that the known win is not the shortest.
                found.win.is_some_and(|shorter| !wins(analysis.game(), level, &shorter, seed))
            };
            lines.iter().any(|line| needed.contains(line)) || spared() >= FATAL || is_shorter()
        };
        let matter = self.mechanics.iter().map(&mut matters).collect();
        (matter, all)
    }

    /// Returns which of the given interactions a level's win needs, and the number of calls. Each search for a
    /// different win may make `calls` calls. The number should be large enough to find the known win, because otherwise
    /// a failed search proves nothing.
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

fn wins(game: &Game, level: &Level, actions: &[Action], seed: Seed) -> bool {
    let mut state = game.start(level, seed);
    actions.iter().any(|&action| game.step(&mut state, action) == Outcome::Won)
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::syntax::InteractionLine;

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
        let ablations = Ablations::of(&analysis, &[]);
        let needs = |line: usize| ablations.needs(line, &level, &win, seed, 10_000).0;
        assert!(needs(1), "the gate must open");
        assert!(needs(3), "the key must be taken");
        assert!(!needs(4), "the bead is only worth a point");
        let shut = game.level("wwwwww\nw AGpw\nwwwwww\n").unwrap();
        let found = shortest_win(&analysis, &game.start(&shut, seed), limits);
        assert!(found.win.is_none() && found.is_proved, "there is no key");
    }

    /// The route beside the thorns is longer. The beads lie beside the route.
    #[test]
    fn thorns_matter_and_beads_do_not() {
        let text = GAME
            .replace("    gate > Immovable\n", "    gate > Immovable\n    thorn > Immovable\n")
            .replace("    G > gate\n", "    G > gate\n    t > thorn\n")
            .replace("    bead avatar", "    avatar thorn > killSprite\n    bead avatar");
        let game = Game::from_source(&text).unwrap();
        let analysis = Analysis::of(&game);
        let seed = Seed::from_text("threats");
        let line = |first: &str, second: &str| {
            let lines = &game.description().interactions;
            let is_it = |line: &InteractionLine| line.first.text == first && line.second[0].text == second;
            vec![lines.iter().position(is_it).expect("the game has such a rule")]
        };
        let matter = |level: &str, mechanic: Vec<usize>| {
            let level = game.level(level).unwrap();
            let (mut win, mut state) = Episode::begin(&game, &level, seed);
            let found = shortest_win(&analysis, &state, Limits { calls: 10_000, ticks: 40 });
            for action in found.win.expect("the level can be won") {
                win.play(&game, &mut state, action);
            }
            let ablations = Ablations::of(&analysis, &[mechanic]);
            ablations.matter(&analysis, &[], &level, &win, 10_000).0
        };
        let detour = "wwwwwwwww\nwA t    w\nw wwww  w\nw       w\nw wwww ww\nwb  w  pw\nwwwwwwwww\n";
        let [thorn, bead] = [line("avatar", "thorn"), line("bead", "avatar")];
        assert_eq!(matter("wwwwwww\nwA t pw\nw     w\nwwwwwww\n", thorn), [true]);
        assert_eq!(matter(detour, bead), [false]);
        assert!(matter("wwwwwwww\nwA    pw\nw     tw\nwwwwwwww\n", vec![]).is_empty());
    }
}
