//! The search for a board.

use super::judge::{Judge, Judged, is_complete};
use super::necessity::Ablations;
use super::order::{BoardBudget, BoardMeasures, BoardOrder, MadeBoard};
use base::Seed;
use engine::{Analysis, Episode, Level};
use generators::boards::BoardVariation;
use generators::{Annealing, AnnealingConfig, Search};

/// Boards that lack something small and are judged at the end, at most.
const TIDIED: usize = 12;
/// The loss of quality that tidying may cost.
const TIDY_LOSS: f64 = 0.01;

/// Makes a board for any game: composes boards, anneals the best of them, and tidies the result. `None` if no board was won as
/// ordered within the budget, or if no character of the game places exactly one avatar.
///
/// The same arguments make the same board on every machine. Cost: the budget's forward-model calls at most, about.
pub fn make_board(
    analysis: &Analysis,
    order: &BoardOrder,
    seed: Seed,
    budget: &BoardBudget,
) -> Option<MadeBoard> {
    let variation = BoardVariation::new(analysis, &order.brief).ok()?;
    let ablations = Ablations::of(analysis);
    let judge = Judge { analysis, order, budget, ablations, seed: seed.child("game", 0) };
    let config = AnnealingConfig {
        starts: budget.compositions.min(budget.evaluations),
        chains: 1,
        warmest: 0.05,
        patience: budget.evaluations,
        ..AnnealingConfig::of(budget.evaluations)
    };
    let mut search = Annealing::new(&variation, config, seed.child("search", 0));
    let mut best = Best::default();
    while best.calls < budget.total && !best.is_complete() {
        let Some(level) = search.ask(1).pop() else { break };
        let judged = judge.judge(&level, best.quality());
        let evaluation = judged.evaluation.clone();
        best.note(&level, judged);
        search.tell(vec![(level, evaluation)]);
    }
    best.tidy(&variation, &judge);
    best.into_board()
}

/// The best board so far, and the cost.
#[derive(Default)]
struct Best {
    board: Option<(Level, Episode, BoardMeasures)>,
    evaluations: usize,
    calls: u64,
}

impl Best {
    fn is_complete(&self) -> bool {
        self.board.as_ref().is_some_and(|(.., measures)| is_complete(measures))
    }

    fn quality(&self) -> f64 {
        self.board.as_ref().map_or(0.0, |(.., measures)| measures.quality)
    }

    /// Counts a judged board, and keeps it if it is the best.
    fn note(&mut self, level: &Level, judged: Judged) {
        self.evaluations += 1;
        self.calls += judged.calls;
        if let Some((win, measures)) = judged.won.filter(|(_, measures)| measures.quality > self.quality()) {
            self.board = Some((level.clone(), win, measures));
        }
    }

    /// Leaves out walls and pieces that are not missed.
    fn tidy(&mut self, variation: &BoardVariation<'_>, judge: &Judge<'_>) {
        let (mut judged, mut least) = (0, self.quality() - TIDY_LOSS);
        while let Some((level, ..)) = &self.board {
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
                    self.board = Some((tidier, win, measures));
                    is_tidier = true;
                    break;
                }
            }
            if !is_tidier {
                return;
            }
        }
    }

    fn into_board(self) -> Option<MadeBoard> {
        let is_complete = self.is_complete();
        let (level, win, measures) = self.board?;
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
