//! Games from merged mechanics, with a board found by search for each level.

use super::Proposal;
use base::Seed;
use engine::{Analysis, syntax};
use forge::boards::{BoardBudget, BoardOrder, make_board};
use generators::boards::BoardBrief;
use generators::invention::{Census, Invention, InventionConfig};

pub(super) fn propose(levels: usize, seed: Seed) -> Option<Proposal> {
    let config = InventionConfig::default();
    let invention = Invention::draw(&config, &Census::default(), seed.child("rules", 0))?;
    let invented = invention.build().ok()?;
    let analysis = Analysis::of(&invented.game.rules);
    let level = |number: usize| {
        let brief = BoardBrief::of_demand(u8::try_from(number).unwrap_or(u8::MAX));
        let order = BoardOrder { mechanics: invented.mechanics.clone(), ..BoardOrder::of(brief) };
        let seed = seed.child("level", number as u64);
        make_board(&analysis, &order, seed, &BoardBudget::default()).map(|made| made.level.to_string())
    };
    let levels = (0..levels).filter_map(level).collect();
    Some(Proposal { rules: syntax::print(invented.game.rules.description()), levels })
}
