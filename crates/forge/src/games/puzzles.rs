//! Puzzles for one game, generated for a difficulty tier: lock puzzles, yards (carrying parcels), and pushing puzzles
//! with or without wandering deadly sprites.

use agents::search::{Answer, Pushes, SearchLimits, a_star};
use base::{Seed, SeedPath};
use engine::{Action, Analysis, Episode, Game, Level, Outcome};
use generators::GenerateError;
use generators::games::{LockRules, PushRules, Rethemed, YardRules};
use generators::levels::{
    LevelConfig, LockConfig, PuzzleConfig, PuzzleTarget, PuzzleVariation, StrayConfig, StrayLevels,
    YardConfig,
};
use std::ops::Range;
use validators::Tier;

/// The request for a game's puzzles.
#[derive(Clone, Debug)]
pub struct PuzzleLevels {
    /// The configuration of the levels, with the board sizes.
    pub config: LevelConfig,
    /// The tier (difficulty class) of each level.
    pub tiers: Vec<Tier>,
    /// The rules of the puzzles.
    pub rules: PuzzleRules,
    /// The number of pushable objects in tiers 3 and 4.
    pub things: usize,
}

/// The rules of puzzles. For pushing puzzles, the generator derives the rules from the game.
#[derive(Clone, Debug)]
pub enum PuzzleRules {
    /// The rules of pushing puzzles.
    Pushing,
    /// Lock puzzles, in which doors use up keys.
    Locks(Retold<LockRules>),
    /// Yards: puzzles in which the player carries parcels past moving carts.
    Yards(Retold<YardRules>),
    /// Pushing puzzles among deadly sprites that wander at random.
    Strays(Retold<PushRules>),
}

impl PuzzleRules {
    /// Returns the rules of lock puzzles for a game that has `rules` in the theme of `retold`.
    pub fn locks(rules: LockRules, retold: &Rethemed) -> PuzzleRules {
        PuzzleRules::Locks(Retold::of(rules, LockRules::SYMBOLS, retold))
    }

    /// Returns the rules of yards (puzzles about carrying parcels) for a game that has `rules` in the theme of
    /// `retold`.
    pub fn yards(rules: YardRules, retold: &Rethemed) -> PuzzleRules {
        PuzzleRules::Yards(Retold::of(rules, YardRules::SYMBOLS, retold))
    }

    /// Returns the rules of pushing puzzles among wandering deadly sprites, for a game that has `rules` in the theme of
    /// `retold`.
    pub fn strays(rules: PushRules, retold: &Rethemed) -> PuzzleRules {
        PuzzleRules::Strays(Retold::of(rules, PushRules::SYMBOLS, retold))
    }
}

/// Puzzle rules, and their level characters in a game's theme.
#[derive(Clone, Debug)]
pub struct Retold<Rules> {
    rules: Rules,
    /// The pairs of an original character and the corresponding character in the game.
    symbols: Vec<(char, char)>,
}

impl<Rules> Retold<Rules> {
    fn of(rules: Rules, symbols: &str, retold: &Rethemed) -> Retold<Rules> {
        let own = retold.level(symbols);
        Retold { rules, symbols: symbols.chars().zip(own.chars()).collect() }
    }

    /// Translates a level from the original characters to the game's.
    fn translate(&self, text: &str) -> String {
        text.chars().map(|symbol| self.symbol(symbol)).collect()
    }

    /// Translates an original character to the game's character.
    fn symbol(&self, plain: char) -> char {
        self.symbols.iter().find(|(other, _)| *other == plain).map_or(plain, |pair| pair.1)
    }
}

/// A puzzle generator for one position.
pub(crate) enum PuzzleGenerator<'a> {
    /// Generates pushing puzzles that meet a target.
    Pushing(Box<PuzzleVariation<'a>>),
    /// Generates pushing puzzles without a target. The range contains the numbers of actions in a win that the tier
    /// (difficulty class) allows.
    Easy(Box<PuzzleVariation<'a>>, Range<usize>),
    Locks(LockConfig, &'a Retold<LockRules>),
    Yards(YardConfig, &'a Retold<YardRules>),
    Strays(Box<StrayLevels>, &'a Retold<PushRules>),
}

impl PuzzleGenerator<'_> {
    /// Generates the level for a seed, with a winning sequence of actions. The actions win with the random draws of the
    /// seed `of_win`, or as long as no wandering sprite is in the way. Returns `None` if the seed yields no level with
    /// a win.
    pub(crate) fn create_solved(
        &self,
        game: &Game,
        seed: Seed,
        of_win: Seed,
    ) -> Option<(Level, Vec<Action>)> {
        match self {
            PuzzleGenerator::Pushing(puzzles) => {
                let solved = puzzles.create_solved(seed)?;
                Some((solved.level, solved.solution?))
            }
            PuzzleGenerator::Easy(puzzles, actions) => {
                let made = |draw| {
                    let solved = puzzles.create_solved(seed.child("draw", draw))?;
                    Some((solved.level, solved.solution?))
                };
                (0..DRAWS).filter_map(made).find(|(_, win)| actions.contains(&win.len()))
            }
            PuzzleGenerator::Locks(config, locks) => {
                let made = config.level(locks.rules, seed)?;
                Some((game.level(&locks.translate(&made.text)).ok()?, made.solution))
            }
            PuzzleGenerator::Yards(config, yards) => {
                let made = config.level(yards.rules, seed)?;
                Some((game.level(&yards.translate(&made.text)).ok()?, made.solution))
            }
            PuzzleGenerator::Strays(levels, strays) => {
                let made = levels.level(seed)?;
                let level = game.level(&strays.translate(&made.text)).ok()?;
                let [floor, stray] = [PushRules::FLOOR, PushRules::STRAY]
                    .map(|symbol| game.places(strays.symbol(symbol) as u8));
                let stray = *stray.iter().find(|stype| !floor.contains(stype))?;
                let win = levels.win(&made, (game, &level), stray, of_win)?;
                Some((level, win))
            }
        }
    }
}

/// The exclusive upper limit on the number of actions in a win among wandering deadly sprites. The longest fuse leaves
/// time for 50% more actions.
const MOST_ACTIONS: usize = 160;
/// The maximum number of floor plans to examine per level.
const FLOOR_PLANS: usize = 20_000;
/// The maximum number of floor plans without a target.
const FEW_FLOOR_PLANS: usize = 60;
/// The maximum number of levels to draw until one has the number of actions that the tier (difficulty class) requires.
const DRAWS: u64 = 40;

impl PuzzleLevels {
    /// Returns the tier required of the game's level with this number. A tier, from 1 to 4, states how far ahead a
    /// player must look to win.
    pub(crate) fn tier(&self, number: u32) -> Tier {
        self.tiers.get(number as usize).copied().unwrap_or(Tier::Four)
    }

    /// Returns the generator for the game's level with this number.
    pub(crate) fn generator<'a>(
        &'a self,
        game: &'a Game,
        number: u32,
    ) -> Result<PuzzleGenerator<'a>, GenerateError> {
        let tier = self.tier(number);
        let (columns, rows) = (self.config.columns, self.config.rows);
        let decisions = tier.bounds().decisions;
        let next =
            Tier::ALL.get(usize::from(u8::from(tier))).map_or(usize::MAX, |next| next.bounds().decisions);
        match &self.rules {
            PuzzleRules::Pushing => {}
            PuzzleRules::Locks(locks) => {
                let dead_ends = dead_ends(tier);
                let config = LockConfig { columns, rows, decisions, dead_ends, ..LockConfig::default() };
                return Ok(PuzzleGenerator::Locks(config, locks));
            }
            PuzzleRules::Yards(yards) => {
                let (carts, exposure) = traffic(tier);
                let sizes = YardConfig { columns, rows, ..YardConfig::default() };
                let config = YardConfig { decisions: (decisions, next), carts, exposure, ..sizes };
                return Ok(PuzzleGenerator::Yards(config, yards));
            }
            PuzzleRules::Strays(strays) => {
                let decisions = (decisions, next.min(MOST_ACTIONS));
                let config = StrayConfig { columns, rows, decisions, ..StrayConfig::default() };
                return Ok(PuzzleGenerator::Strays(Box::new(StrayLevels::new(strays.rules, config)), strays));
            }
        }
        let target = target(tier, self.things);
        let puzzle = match target {
            Some(_) => PuzzleConfig {
                things: Some(self.things),
                floor_plans: FLOOR_PLANS,
                target,
                ..PuzzleConfig::default()
            },
            // The farthest position of a good floor plan is too far for the lower tiers.
            None => PuzzleConfig {
                things: Some(2),
                floor_plans: FEW_FLOOR_PLANS,
                way: Some((0.0, 1.0)),
                ..PuzzleConfig::default()
            },
        };
        let levels = Box::new(PuzzleVariation::new(game, self.config.clone(), puzzle)?);
        Ok(match target {
            Some(_) => PuzzleGenerator::Pushing(levels),
            None => PuzzleGenerator::Easy(levels, tier.bounds().decisions..next),
        })
    }
}

/// Returns the target fraction of dead ends in a lock puzzle. The target exceeds the tier's threshold because a bounded
/// search cannot prove every dead end.
fn dead_ends(tier: Tier) -> f64 {
    match tier {
        Tier::One | Tier::Two => 0.0,
        Tier::Three => 0.03,
        Tier::Four => 0.09,
    }
}

/// Returns the number of carts in a yard (a puzzle about carrying parcels), and the fraction of the win's ticks during
/// which staying in place would be fatal.
fn traffic(tier: Tier) -> (usize, f64) {
    match tier {
        Tier::One => (1, 0.0),
        Tier::Two => (2, 0.05),
        Tier::Three => (4, 0.175),
        Tier::Four => (4, 0.2),
    }
}

/// Returns the target for a tier (difficulty class); `None` for tiers without a target. The generator counts the
/// actions of a win with the minimum number of pushes. The shortest win has fewer actions, so the target includes a
/// margin. Puzzles with more than three pushable objects require more pushes and actions.
fn target(tier: Tier, things: usize) -> Option<PuzzleTarget> {
    let pushes = match tier {
        Tier::One | Tier::Two => return None,
        Tier::Three => 30,
        Tier::Four => 60,
    };
    let decisions = tier.bounds().decisions;
    let more = things.saturating_sub(3);
    Some(PuzzleTarget {
        pushes: pushes + pushes * more / 3,
        decisions: decisions + decisions * (1 + 3 * more) / 8,
    })
}

/// Returns a puzzle's win, whether the win is proved to be the shortest, and the number of calls. Returns the shortest
/// win if `calls` forward-model calls suffice for the proof, and otherwise the generator's own win. In stochastic
/// games, nothing can be proved, so a known win is returned without a search. Returns `None` if the known actions do
/// not win.
pub(crate) fn win(
    analysis: &Analysis,
    level: &Level,
    known: Vec<Action>,
    calls: u64,
    seed: &SeedPath,
) -> Option<(Episode, bool, u64)> {
    let game = analysis.game();
    let played = |actions: Vec<Action>| {
        let (mut episode, mut state) = Episode::begin(game, level, seed);
        for action in actions {
            episode.play(game, &mut state, action);
        }
        (episode.outcome == Outcome::Won).then_some(episode)
    };
    if analysis.is_stochastic()
        && let Some(won) = played(known.clone())
    {
        return Some((won, false, 0));
    }
    let start = game.start(level, seed.seed());
    let searched = a_star(analysis, &Pushes::of(analysis, level), &start, SearchLimits::calls(calls));
    let (actions, shortest) = match searched.answer {
        Answer::Won { actions, shortest } => (actions, shortest),
        _ => (known, false),
    };
    Some((played(actions)?, shortest, searched.calls))
}

#[cfg(test)]
mod tests {
    use super::*;
    use validators::GameForm;

    /// No two games in a release are duplicates.
    #[test]
    fn rules_of_puzzles_differ() {
        let pushing = PushRules::ALL.iter().map(|rules| (rules.name(), rules.game()));
        let locks = LockRules::ALL.iter().map(|rules| (rules.name(), rules.game()));
        let yards = YardRules::ALL.iter().map(|rules| (rules.name(), rules.game()));
        let strays = PushRules::AMONG_STRAYS.iter().map(|rules| (rules.name(), rules.game()));
        let all = pushing.chain(locks).chain(yards).chain(strays);
        let forms: Vec<(String, GameForm)> = all.map(|(name, game)| (name, GameForm::of(&game))).collect();
        for (at, (name, form)) in forms.iter().enumerate() {
            let near = forms[..at].iter().find(|(_, other)| form.is_near(other));
            assert_eq!(near.map(|(other, _)| other), None, "{name}");
        }
    }

    /// In a different theme, a lock puzzle or a yard (a puzzle about carrying parcels) keeps its level and its winning
    /// actions. Outside of `cargo xtask sweep`, this test checks only every second set of rules.
    #[test]
    fn puzzles_are_won_under_every_theme() {
        let seed = Seed::from_text("puzzles");
        let locks = LockRules::ALL.map(|rules| {
            let retold = Rethemed::of_compounds(&rules.game(), seed).unwrap();
            (rules.name(), PuzzleRules::locks(rules, &retold), retold)
        });
        let yards = YardRules::ALL.map(|rules| {
            let retold = Rethemed::of_compounds(&rules.game(), seed).unwrap();
            (rules.name(), PuzzleRules::yards(rules, &retold), retold)
        });
        let strays = PushRules::AMONG_STRAYS.map(|rules| {
            let retold = Rethemed::of_compounds(&rules.game(), seed).unwrap();
            (rules.name(), PuzzleRules::strays(rules, &retold), retold)
        });
        let step = if std::env::var_os("ARCADE_SWEEP").is_some() { 1 } else { 2 };
        for (name, rules, retold) in locks.into_iter().chain(yards).chain(strays).step_by(step) {
            let game = Game::from_source(&engine::syntax::print(&retold.description)).unwrap();
            let config = LevelConfig { columns: (9, 9), rows: (9, 9), ..LevelConfig::default() };
            let puzzles = PuzzleLevels { config, tiers: vec![Tier::Two], rules, things: 3 };
            let generator = puzzles.generator(&game, 0).unwrap();
            let made = (0..8).find_map(|draw| generator.create_solved(&game, seed.child("draw", draw), seed));
            let (level, known) = made.unwrap_or_else(|| panic!("a level of {name}"));
            let analysis = Analysis::of(&game);
            let ticks = known.len();
            if analysis.is_stochastic() {
                let (won, shortest, _) = win(&analysis, &level, known, 2_000_000, &seed.into()).unwrap();
                assert!(
                    won.actions.len() >= ticks && !shortest,
                    "{name}: nothing is proved where chance plays a part"
                );
                continue;
            }
            let (won, shortest, _) = win(&analysis, &level, known.clone(), 0, &seed.into()).unwrap();
            assert_eq!((won.actions.len(), shortest), (ticks, false), "{name}");
            let (won, shortest, _) = win(&analysis, &level, known, 2_000_000, &seed.into()).unwrap();
            assert_eq!((won.actions.len(), shortest), (ticks, true), "{name}: the search proves it");
        }
    }

    /// In every theme, an object pushed off a mat lands on floor, so every cell has ground.
    #[test]
    fn puzzles_have_floor_under_every_theme() {
        for rules in PushRules::ALL.into_iter().filter(|rules| rules.name().contains("mat")).take(2) {
            let retold = Rethemed::of_compounds(&rules.game(), Seed::from_text("floor")).unwrap();
            let game = Game::from_source(&engine::syntax::print(&retold.description)).unwrap();
            let config = LevelConfig { columns: (8, 8), rows: (8, 8), ..LevelConfig::default() };
            let puzzles =
                PuzzleLevels { config, tiers: vec![Tier::One], rules: PuzzleRules::Pushing, things: 3 };
            let generator = puzzles.generator(&game, 0).unwrap();
            let made = (0..8).find_map(|draw| {
                let seed = Seed::from_text("x").child("draw", draw);
                generator.create_solved(&game, seed, seed)
            });
            let (level, _) = made.unwrap_or_else(|| panic!("a level of {}", rules.name()));
            assert!(!level.cells().contains(&b' '), "{}\n{level}", rules.name());
        }
    }
}
