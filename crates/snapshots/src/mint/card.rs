//! The file `CARD.json` of a release: planned and achieved numbers, the reference players' results, novelty, and
//! composition.

use super::Plan;
use super::select::{Contender, bins};
use crate::card::rungs::{RungRate, rates};
use crate::card::{MONTH, Novelty, ReleaseCard, Rung, counted, generator, is_new};
use forge::Tally;
use forge::card::Card;
use report::Quantiles;
use validators::GameForm;

impl ReleaseCard {
    /// Computes the card for the selected games. Cost: quadratic in the number of new games.
    pub(super) fn of(
        plan: &Plan<'_>,
        contenders: &[Contender],
        taken: &[usize],
        cards: &[Card],
        tally: Tally,
    ) -> ReleaseCard {
        let recipe = plan.recipe;
        let games = || taken.iter().map(|&at| &contenders[at]);
        let levels = || cards.iter().flat_map(|card| &card.levels);
        let new: Vec<&Contender> = games().filter(|game| game.is_new).collect();
        let nearest = |at: usize| {
            let others = new.iter().enumerate().filter(|(other, _)| *other != at).map(|(_, game)| &game.form);
            new[at].form.nearest(others).map(|(_, apart)| apart)
        };
        let nearest: Vec<f64> = (0..new.len()).filter_map(nearest).collect();
        let nearest_of = |forms: &[GameForm]| {
            let apart = new.iter().filter_map(|game| game.form.nearest(forms).map(|(_, apart)| apart));
            Quantiles::of(&apart.collect::<Vec<f64>>())
        };
        let rules: Vec<f64> = games().map(|game| game.rules as f64).collect();
        let ticks: Vec<f64> = levels().map(|level| level.witness_ticks as f64).collect();
        let rung = |rate: RungRate| Rung {
            detectable: rate.detectable(rate.games),
            detectable_month: rate.detectable(MONTH),
            rate,
        };
        ReleaseCard {
            canary: plan.canary(),
            games: cards.len() as u64,
            levels: levels().count() as u64,
            new_games: cards.iter().filter(|card| is_new(card)).count() as u64,
            planned: bins(recipe, contenders, taken),
            difficulty: counted(
                levels()
                    .filter_map(|level| level.ladder.as_ref())
                    .map(|ladder| ladder.difficulty.name().to_owned()),
            ),
            tiers: counted(levels().filter_map(|level| level.tier).map(|tier| tier.to_string())),
            goals: counted(games().map(|game| game.goal.name().to_owned())),
            avatars: counted(games().map(|game| game.avatar.name().to_owned())),
            generators: counted(cards.iter().map(generator)),
            ladder: rates(cards).into_iter().map(rung).collect(),
            novelty: Novelty {
                ancestors: recipe.known.releases.clone(),
                known_games: recipe.known.games.len() as u64,
                known_items: recipe.known.items.len() as u64,
                nearest: Quantiles::of(&nearest),
                nearest_corpus: nearest_of(&plan.forms),
                nearest_known: nearest_of(&plan.before),
            },
            patterns: counted(cards.iter().flat_map(|card| card.origin.mechanics()).map(str::to_owned)),
            rules: Quantiles::of(&rules),
            witness_ticks: Quantiles::of(&ticks),
            tally,
        }
    }
}
