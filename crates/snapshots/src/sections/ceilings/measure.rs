//! The measurement of ceilings: the strongest known players compete on some seeds, and the best of them plays on others.

use super::{CEILING_COMMITS, Ceiling, CeilingsPart, LevelCeilings};
use crate::sections::frozen::FrozenGame;
use agents::{Budget, OpenLoop, PlannerSpec};
use base::Seed;
use engine::{Action, Analysis, Episode, Game, Level, Outcome, State};
use forge::card::Card;
use generators::games::PushRules;
use generators::levels::CarefulPlayer;
use rayon::prelude::*;
use validators::Commitment;

/// The planners that compete.
const PLANNERS: [&str; 3] = ["guided-mcts:500", "olets:500", "width:500"];
/// The budget of a planner whose name states none.
const NO_BUDGET: Budget = Budget(0);
/// The name of the player by which a level's generator judges the level.
const CAREFUL: &str = "careful";
/// The number of whole plans that each planner contributes.
const PLANS: u64 = 5;
/// The number of requested episodes per episode in which each player competes.
const TRIED: u64 = 2;

/// The typical cost of a planner's episode, in seconds.
const EPISODE: f64 = 0.05;

/// Estimates the cost of a level's ceilings (highest known win rates), in core seconds.
pub(super) fn seconds(asked: CeilingsPart) -> f64 {
    let commits = (CEILING_COMMITS.len() - 1) as f64;
    let episodes = asked.episodes as f64;
    commits * episodes * (1.0 + PLANNERS.len() as f64 / TRIED as f64) * EPISODE
}

/// Measures the ceilings (highest known win rates) of a game's levels.
///
/// # Errors
/// Returns a message if the game or a level cannot be loaded.
pub(super) fn of_game(
    frozen: &FrozenGame,
    asked: CeilingsPart,
    root: Seed,
) -> Result<Vec<LevelCeilings>, String> {
    let game = Game::from_source(&frozen.text).map_err(|problems| problems.to_string())?;
    let analysis = Analysis::of(&game);
    let seed = root.child("ceilings", 0).child(&frozen.card.id, 0);
    let each = (0..).zip(frozen.levels.iter().zip(&frozen.witnesses));
    each.map(|(number, (text, win))| {
        let level = game.level(text).map_err(|problems| problems.to_string())?;
        let careful = careful_player(&frozen.card, &game, &level, win);
        Ok(of_level(&analysis, &level, win, careful, asked, seed.child("level", number)))
    })
    .collect()
}

/// Returns the careful player of a puzzle among wandering deadly sprites.
fn careful_player(card: &Card, game: &Game, level: &Level, win: &Episode) -> Option<CarefulPlayer> {
    let name = card.origin.patterns().iter().find_map(|pattern| pattern.strip_prefix("puzzle/"))?;
    let rules = PushRules::AMONG_STRAYS.into_iter().find(|rules| rules.name() == name)?;
    CarefulPlayer::of(rules, game, level, win)
}

/// Measures a level, from the longest commitment (number of actions per decision) to the shortest. The best player of
/// each commitment also competes at the next shorter one, because a player that looks more often can still play its plan.
fn of_level(
    analysis: &Analysis,
    level: &Level,
    win: &Episode,
    careful: Option<CarefulPlayer>,
    CeilingsPart { episodes }: CeilingsPart,
    seed: Seed,
) -> LevelCeilings {
    let game = analysis.game();
    if analysis.is_deterministic_from(&game.start(level, seed)) {
        return LevelCeilings::exact();
    }
    let arena = Arena { game, level, careful, ticks: 2 * win.actions.len() + 20 };
    let mut best: Option<Contender> = None;
    let mut ceilings = Vec::new();
    for (at, commit) in CEILING_COMMITS.into_iter().enumerate().rev() {
        let seed = seed.child("commitment", at as u64);
        let (mut contenders, trials) = match commit {
            Commitment::All => (arena.plans(win, seed.child("plans", 0)), episodes),
            _ => (arena.players(commit), episodes.div_ceil(TRIED)),
        };
        contenders.extend(best.take());
        let chosen = arena.best(contenders, trials, seed.child("trials", 0));
        let wins = arena.wins(&chosen, episodes, seed.child("episodes", 0));
        ceilings.push(Ceiling::of(commit, (chosen.name(), chosen.commit()), wins, episodes));
        best = Some(chosen);
    }
    ceilings.reverse();
    LevelCeilings { exact: false, ceilings }
}

/// A player that competes at a commitment (number of actions per decision).
#[derive(Clone, Debug)]
enum Contender {
    /// The player by which the level's generator judged the level.
    Careful(Commitment),
    /// A planner, which plays in open loop.
    Planner(&'static str, Commitment),
    /// A plan for the whole episode, with the name of its author.
    Plan(&'static str, Vec<Action>),
}

impl Contender {
    fn name(&self) -> String {
        match self {
            Contender::Careful(_) => CAREFUL.to_owned(),
            Contender::Planner(name, _) | Contender::Plan(name, _) => (*name).to_owned(),
        }
    }

    fn commit(&self) -> Commitment {
        match self {
            Contender::Careful(commit) | Contender::Planner(_, commit) => *commit,
            Contender::Plan(..) => Commitment::All,
        }
    }
}

/// A level with randomness, on which players compete.
struct Arena<'a> {
    game: &'a Game,
    level: &'a Level,
    careful: Option<CarefulPlayer>,
    /// The maximum number of ticks in an episode.
    ticks: usize,
}

impl Arena<'_> {
    /// Returns the players that look again after each commitment (a number of actions).
    fn players(&self, commit: Commitment) -> Vec<Contender> {
        let careful = self.careful.iter().map(|_| Contender::Careful(commit));
        careful.chain(PLANNERS.map(|name| Contender::Planner(name, commit))).collect()
    }

    /// Returns the plans for a whole episode.
    fn plans(&self, win: &Episode, seed: Seed) -> Vec<Contender> {
        let careful = self.careful.as_ref().and_then(CarefulPlayer::plan);
        let mut plans = vec![Contender::Plan("witness", win.actions.clone())];
        plans.extend(careful.map(|plan| Contender::Plan(CAREFUL, plan)));
        let drawn: Vec<(&'static str, Seed)> = PLANNERS
            .into_iter()
            .flat_map(|name| (0..PLANS).map(move |number| (name, seed.child(name, number))))
            .collect();
        let plan = |(name, seed): (&'static str, Seed)| {
            let start = self.game.start(self.level, seed.child("chance", 0));
            let (actions, _) = planner(name, seed).plan(self.game, &start, self.ticks as u64);
            Contender::Plan(name, actions)
        };
        plans.extend(drawn.into_par_iter().map(plan).collect::<Vec<_>>());
        plans
    }

    /// Returns the contender with the most wins, or the first of several.
    fn best(&self, contenders: Vec<Contender>, episodes: u64, seed: Seed) -> Contender {
        let counted = contenders.into_iter().map(|one| (self.wins(&one, episodes, seed), one));
        let best = counted.reduce(|best, other| if other.0 > best.0 { other } else { best });
        best.expect("the witness and the planners always compete").1
    }

    fn wins(&self, contender: &Contender, episodes: u64, seed: Seed) -> u64 {
        let won = |&number: &u64| self.is_won(contender, seed.child("episode", number));
        (0..episodes).into_par_iter().filter(won).count() as u64
    }

    fn is_won(&self, contender: &Contender, seed: Seed) -> bool {
        match contender {
            Contender::Careful(commit) => {
                let commit = commit.actions().unwrap_or(1);
                self.careful.as_ref().is_some_and(|player| player.wins(commit as usize, seed))
            }
            Contender::Planner(name, commit) => {
                let mut player = planner(name, seed.child(name, 0));
                self.play(seed, commit.actions().unwrap_or(1), |state, due| {
                    player.plan(self.game, state, due).0
                })
            }
            Contender::Plan(_, plan) => self.play(seed, u64::MAX, |_, _| plan.clone()),
        }
    }

    /// Plays an episode in plans of `commit` actions. A plan that is too short continues with doing nothing.
    fn play(&self, seed: Seed, commit: u64, mut plan: impl FnMut(&State, u64) -> Vec<Action>) -> bool {
        let mut state = self.game.start(self.level, seed);
        let mut left = self.ticks as u64;
        while !state.is_over() && left > 0 {
            let due = commit.min(left);
            let actions = plan(&state, due);
            for action in actions.into_iter().chain(std::iter::repeat(Action::Nil)).take(due as usize) {
                if state.is_over() {
                    break;
                }
                self.game.step(&mut state, action);
            }
            left -= due;
        }
        state.outcome() == Outcome::Won
    }
}

/// Returns a planner that plays in open loop.
fn planner(name: &str, seed: Seed) -> OpenLoop<agents::Player> {
    let spec: PlannerSpec = name.parse().expect("a planner of the registry");
    OpenLoop::new(spec.player(seed), spec.budget().unwrap_or(NO_BUDGET), seed)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the rates of a level on which the avatar must meet a wanderer, or only has to walk to a door.
    fn rates(level: &str) -> (LevelCeilings, Vec<f64>) {
        let game = Game::from_source(
            "BasicGame
    SpriteSet
        door > Immovable
        moth > RandomNPC
        avatar > MovingAvatar
    LevelMapping
        o > door
        m > moth
    InteractionSet
        avatar wall > stepBack
        moth wall > stepBack
        door avatar > killSprite
        moth avatar > killSprite
    TerminationSet
        MultiSpriteCounter stype1=door stype2=moth limit=0 win=True
        Timeout limit=12 win=False
",
        )
        .unwrap();
        let level = game.level(level).unwrap();
        let (mut win, mut state) = Episode::begin(&game, &level, Seed::from_text("win"));
        for action in [Action::Right, Action::Right, Action::Right] {
            win.play(&game, &mut state, action);
        }
        let (part, seed) = (CeilingsPart { episodes: 60 }, Seed::from_text("ceilings"));
        let found = of_level(&Analysis::of(&game), &level, &win, None, part, seed);
        assert_eq!(found, of_level(&Analysis::of(&game), &level, &win, None, part, seed));
        let rates = found.ceilings.iter().map(|ceiling| ceiling.rate).collect();
        (found, rates)
    }

    #[test]
    fn without_chance_the_ceiling_is_exact() {
        let (found, rates) = rates("wwwwww\nwA  ow\nwwwwww\n");
        assert!(found.exact && rates == [1.0; 4], "{found:?}");
        assert!(found.ceilings.iter().all(|ceiling| ceiling.interval == [1.0, 1.0]));
    }

    /// A player that looks before every action meets the wanderer, but a plan meets it only by luck.
    #[test]
    fn luck_is_worth_less_than_looking() {
        let (found, rates) = rates("wwwwwww\nwA    w\nw     w\nw    mw\nwwwwwww\n");
        assert!(!found.exact && rates[0] > rates[3] + 0.2, "{rates:?}");
    }
}
