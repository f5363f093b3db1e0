//! The board search.

use super::judge::{ALONE, Judge, Judged, is_complete};
use super::necessity::Ablations;
use super::order::{BoardBudget, BoardMeasures, BoardOrder, MadeBoard};
use base::Seed;
use engine::{Analysis, Episode, Level};
use generators::boards::BoardVariation;
use generators::{Annealing, AnnealingConfig, Search};
use validators::{Effort, Panel};

/// The maximum number of boards that the search may propose for each board in the budget. A proposed board uses up
/// budget only if it reaches the win search.
const CHEAP: usize = 3;
/// The maximum number of tidied boards to judge at the end.
const TIDIED: usize = 12;
/// The maximum number of boards in the final judging, besides the first board.
const SCRUTINIZED: usize = 3;
/// The maximum loss of quality from tidying.
const TIDY_LOSS: f64 = 0.01;

/// Generates a board for any game: composes boards, anneals the best of them, and tidies the result. Returns `None` if
/// no board within the budget has a win that meets the order, or if no character of the game places exactly one avatar.
///
/// The same arguments produce the same board on every machine. Cost: up to about [`BoardBudget::total`] forward-model
/// calls.
pub fn make_board(
    analysis: &Analysis,
    order: &BoardOrder,
    seed: Seed,
    budget: &BoardBudget,
) -> Option<MadeBoard> {
    search_boards(analysis, order, seed, budget).made
}

/// The result of a board search, with or without a board.
#[derive(Default)]
pub(crate) struct BoardSearch {
    /// The board as returned by [`make_board`].
    pub(crate) made: Option<MadeBoard>,
    /// The fraction of constraints met by the board that came closest to meeting the request ([`BoardOrder`]). The
    /// fraction is 1.0 if some board has a win that meets the request.
    pub(crate) feasibility: f64,
    /// The number of forward-model calls spent on the search.
    pub(crate) calls: u64,
}

/// Generates a board like [`make_board`], and also returns how close the search came if it failed.
pub(crate) fn search_boards(
    analysis: &Analysis,
    order: &BoardOrder,
    seed: Seed,
    budget: &BoardBudget,
) -> BoardSearch {
    let Ok(variation) = BoardVariation::new(analysis, &order.brief) else { return BoardSearch::default() };
    let ablations = Ablations::of(analysis, &order.mechanics);
    let panel = order.gates.as_ref().map(|criteria| Panel::new(criteria.only(ALONE), Effort::Sequential));
    let seed_of_game = seed.child("game", 0);
    let judge = Judge {
        analysis,
        order,
        budget,
        variation: &variation,
        ablations: &ablations,
        panel,
        seed: seed_of_game,
    };
    let config = AnnealingConfig {
        starts: budget.compositions.min(budget.evaluations) * CHEAP,
        chains: 1,
        warmest: 0.05,
        patience: budget.evaluations * CHEAP,
        ..AnnealingConfig::of(budget.evaluations * CHEAP)
    };
    let (calls, small_calls) = (budget.calls * budget.scrutiny, budget.small_calls * budget.scrutiny);
    let strict_budget = BoardBudget { calls, small_calls, ..budget.clone() };
    let strict = Judge { budget: &strict_budget, ..judge.clone() };
    let mut search = Annealing::new(&variation, config, seed.child("search", 0));
    let mut best = Best::default();
    while best.searched < budget.evaluations
        && best.calls < budget.total
        && !best.is_complete()
        && !best.is_stale(budget)
        && !best.is_hopeless(budget)
    {
        let Some(level) = search.ask(1).pop() else { break };
        let mut judged = judge.judge(&level, best.quality());
        // The first board must stand up to the final judging, so that the search never ends without a board.
        if budget.scrutiny > 1 && best.boards.is_empty() && judged.won.is_some() {
            let calls = judged.calls;
            judged = strict.judge(&level, 0.0);
            judged.calls += calls;
        }
        let evaluation = judged.evaluation.clone();
        best.note(&level, judged);
        search.tell(vec![(level, evaluation)]);
    }
    if budget.scrutiny > 1 {
        best.tidy(&variation, &judge);
        best.scrutinize(&strict);
    }
    let feasibility = search.best().map_or(0.0, |(_, evaluation)| evaluation.feasibility);
    BoardSearch { feasibility, calls: best.calls, made: best.into_board() }
}

/// The best boards so far, and the cost of the search.
#[derive(Default)]
struct Best {
    /// The boards, in the order found. Each board is better or tidier than the board before it.
    boards: Vec<(Level, Episode, BoardMeasures)>,
    evaluations: usize,
    /// The number of boards that reached the win search.
    searched: usize,
    /// The number of boards judged since the best board was found.
    stale: usize,
    calls: u64,
}

impl Best {
    /// Returns `true` if a board was won, and the search has not improved on it for a long time after the initial
    /// compositions. Without patience, the first won board is enough.
    fn is_stale(&self, budget: &BoardBudget) -> bool {
        let has_all = self.evaluations >= budget.compositions + budget.patience;
        !self.boards.is_empty() && self.stale >= budget.patience && (has_all || budget.patience == 0)
    }

    /// Returns `true` if many boards were searched but no win met the order.
    fn is_hopeless(&self, budget: &BoardBudget) -> bool {
        self.boards.is_empty() && self.searched >= budget.hopeless
    }

    fn is_complete(&self) -> bool {
        self.boards.last().is_some_and(|(.., measures)| is_complete(measures))
    }

    fn quality(&self) -> f64 {
        self.boards.last().map_or(0.0, |(.., measures)| measures.quality)
    }

    /// Counts a judged board, and stores it if it is the best so far.
    fn note(&mut self, level: &Level, judged: Judged) {
        self.evaluations += 1;
        self.calls += judged.calls;
        self.stale += 1;
        self.searched += usize::from(judged.is_searched);
        if let Some((win, measures)) = judged.won.filter(|(_, measures)| measures.quality > self.quality()) {
            self.boards.push((level.clone(), win, measures));
            self.stale = 0;
        }
    }

    /// Removes walls and pieces that do not matter.
    fn tidy(&mut self, variation: &BoardVariation<'_>, judge: &Judge<'_>) {
        let (mut judged, mut least) = (0, self.quality() - TIDY_LOSS);
        while let Some((level, ..)) = self.boards.last() {
            let mut is_tidier = false;
            for tidier in variation.tidied(level) {
                if judged >= TIDIED || self.calls >= judge.budget.total {
                    return;
                }
                judged += 1;
                let found = judge.judge(&tidier, self.quality());
                self.evaluations += 1;
                self.calls += found.calls;
                if let Some((win, measures)) = found.won.filter(|(_, measures)| measures.quality >= least) {
                    least = least.max(measures.quality - TIDY_LOSS);
                    self.boards.push((tidier, win, measures));
                    is_tidier = true;
                    break;
                }
            }
            if !is_tidier {
                return;
            }
        }
    }

    /// Judges the best board again, with a larger budget in calls. If the board fails, for example because its shortest
    /// win turns out to be too short, the previous best board is judged instead, and at last the first board.
    fn scrutinize(&mut self, judge: &Judge<'_>) {
        if self.boards.len() > SCRUTINIZED {
            self.boards.drain(1..self.boards.len() - SCRUTINIZED);
        }
        while let Some((level, ..)) = self.boards.pop() {
            let judged = judge.judge(&level, 0.0);
            self.calls += judged.calls;
            if let Some((win, measures)) = judged.won {
                self.boards.push((level, win, measures));
                return;
            }
        }
    }

    fn into_board(mut self) -> Option<MadeBoard> {
        let is_complete = self.is_complete();
        let (level, win, measures) = self.boards.pop()?;
        Some(MadeBoard {
            level,
            win,
            measures,
            is_complete,
            evaluations: self.evaluations,
            calls: self.calls,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::syntax::InteractionLine;
    use engine::{Game, Outcome};
    use generators::boards::BoardBrief;

    const GAME: &str = "BasicGame\n  SpriteSet\n    wall > Immovable\n    gate > Immovable\n    key > Resource limit=2\n    plum > Immovable\n    dog > Missile orientation=RIGHT cooldown=2\n    avatar > MovingAvatar\n  LevelMapping\n    G > gate\n    k > key\n    p > plum\n    d > dog\n  InteractionSet\n    avatar wall > stepBack\n    gate avatar > killIfOtherHasMore resource=key limit=1\n    avatar gate > stepBack\n    key avatar > collectResource\n    plum avatar > killSprite scoreChange=1\n    dog wall gate > reverseDirection\n    avatar dog > killSprite\n  TerminationSet\n    SpriteCounter stype=avatar win=False\n    SpriteCounter stype=plum win=True\n    Timeout limit=300 win=False\n";

    #[test]
    fn a_board_is_won_as_ordered_and_follows_from_its_seed() {
        let game = Game::from_source(GAME).unwrap();
        let analysis = Analysis::of(&game);
        let order = BoardOrder::of(BoardBrief::of_demand(0));
        let budget =
            BoardBudget { compositions: 8, evaluations: 16, calls: 20_000, ..BoardBudget::default() };
        let make = |text: &str| make_board(&analysis, &order, Seed::from_text(text), &budget);
        let made = make("a board").expect("a simple game has boards");
        let state = made.win.replay(&game, &made.level).expect("the win replays");
        assert_eq!(state.outcome(), Outcome::Won);
        assert!((order.ticks.0..=order.ticks.1).contains(&made.win.actions.len()));
        assert_eq!(made.measures.steady, 1.0, "the game has no chance");
        assert_eq!(make("a board").unwrap().level, made.level);
        assert_ne!(make("another board").map(|made| made.level), Some(made.level));
    }

    /// No board of this game has a shortest win of 100 ticks.
    #[test]
    fn hopeless_searches_end_early() {
        let game = Game::from_source(GAME).unwrap();
        let analysis = Analysis::of(&game);
        let order = BoardOrder { ticks: (100, 110), ..BoardOrder::of(BoardBrief::of_demand(0)) };
        let calls = |hopeless| {
            let budget = BoardBudget {
                compositions: 8,
                evaluations: 24,
                calls: 5_000,
                hopeless,
                ..BoardBudget::default()
            };
            let search = search_boards(&analysis, &order, Seed::from_text("hopeless"), &budget);
            assert!(search.made.is_none());
            search.calls
        };
        assert!(calls(2) < calls(24));
    }

    /// Every win collects the plum. No win depends on the points for the bead.
    #[test]
    fn ordered_mechanics_matter() {
        let text = GAME
            .replace("    gate > Immovable\n", "    gate > Immovable\n    bead > Immovable\n")
            .replace("    G > gate\n", "    G > gate\n    b > bead\n")
            .replace("    plum avatar", "    bead avatar > killSprite scoreChange=1\n    plum avatar");
        let game = Game::from_source(&text).unwrap();
        let analysis = Analysis::of(&game);
        let budget =
            BoardBudget { compositions: 8, evaluations: 24, calls: 20_000, ..BoardBudget::default() };
        let search = |mechanics: Vec<Vec<usize>>| {
            let order = BoardOrder { mechanics, ..BoardOrder::of(BoardBrief::of_demand(0)) };
            search_boards(&analysis, &order, Seed::from_text("ordered mechanics"), &budget)
        };
        let lines = &game.description().interactions;
        let kills = |first: &str| {
            let kills = |line: &InteractionLine| line.first.text == first && line.effect.text == "killSprite";
            lines.iter().position(kills).expect("the game has such a rule")
        };
        let plum = kills("plum");
        let made = search(vec![vec![plum]]).made.expect("every win takes the plum");
        assert!(made.measures.needed.contains(&plum));
        let found = search(vec![vec![kills("bead")]]);
        assert!(found.made.is_none() && found.feasibility < 1.0, "{}", found.feasibility);
    }
}
