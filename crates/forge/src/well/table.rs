//! The months of a chain of releases as tables.

use super::month::{Nearest, Top, Well, WellMonth};
use report::{Column, Table, TableCell};

impl Well {
    /// Returns two tables with one row per month. The first is about the rules, and the second about parts and texts.
    pub fn tables(&self) -> [Table; 2] {
        [self.rules(), self.parts()]
    }

    fn rules(&self) -> Table {
        let nearest = |of: fn(&Nearest) -> f64| {
            move |month: &WellMonth| TableCell::number(month.nearest.as_ref().map(of), 2)
        };
        let columns: &[Column<'_, WellMonth>] = &[
            ("month", &|month| TableCell::Count(month.month.into())),
            ("sets available", &|month| TableCell::number(month.available, 0)),
            ("used", &|month| TableCell::Count(month.used.into())),
            ("drawn", &|month| TableCell::Count(month.drawn)),
            ("near", &|month| TableCell::Count(month.near)),
            ("same idea", &|month| TableCell::Count(month.same_idea)),
            ("near in month", &|month| TableCell::Count(month.near_in_month)),
            ("yield", &|month| percent(Some(month.yielded))),
            ("games", &|month| TableCell::Count(month.games.into())),
            ("least", &nearest(|found| found.least)),
            ("5%", &nearest(|found| found.low)),
            ("median", &nearest(|found| found.median)),
            ("unseen at 0.3", &|month| TableCell::number(month.unseen_near, 2)),
            ("unseen at 0.4", &|month| TableCell::number(month.unseen_far, 2)),
        ];
        let note = "Least, 5%, median: the distance from the month's games to the nearest earlier game. \
                    Near: rejected. Unseen: the estimated probability that the next rules are at least \
                    this far from all rules drawn up to the month.";
        Table::of("well-rules", "Rules of each month", note, &self.months, columns)
    }

    fn parts(&self) -> Table {
        let columns: &[Column<'_, WellMonth>] = &[
            ("month", &|month| TableCell::Count(month.month.into())),
            ("unseen pairs", &|month| TableCell::number(month.unseen_couplings, 2)),
            ("unseen mechanics", &|month| TableCell::number(month.unseen_mechanics, 2)),
            ("top mechanic", &|month| share(month.top_mechanic.as_ref())),
            ("top ending", &|month| share(month.top_ending.as_ref())),
            ("top pair", &|month| share(month.top_coupling.as_ref())),
            ("titles again", &|month| of_games(month.again.titles, month.games)),
            ("casts again", &|month| of_games(month.again.casts, month.games)),
            ("openings again", &|month| of_games(month.again.openings, month.games)),
            ("sentences again", &|month| of_games(month.again.sentences, month.again.all_sentences)),
        ];
        let last = self.months.last();
        let named = |top: Option<&Top>| top.map_or("none", |top| top.name.as_str()).to_owned();
        let note = format!(
            "Unseen: the estimated probability that the next pair or mechanic is new. Top: the fraction of all \
             games up to the month. At the end, the top mechanic is {}, the top ending {} and the top pair {}. \
             Again: used by another game within twelve months.",
            named(last.and_then(|month| month.top_mechanic.as_ref())),
            named(last.and_then(|month| month.top_ending.as_ref())),
            named(last.and_then(|month| month.top_coupling.as_ref())),
        );
        Table::of("well-parts", "Parts and words of each month", &note, &self.months, columns)
    }
}

fn share(top: Option<&Top>) -> TableCell {
    percent(top.map(|top| top.share))
}

fn of_games(again: u32, all: u32) -> TableCell {
    percent((all > 0).then(|| f64::from(again) / f64::from(all)))
}

fn percent(share: Option<f64>) -> TableCell {
    TableCell::figure(share.map(|share| format!("{:.1}%", 100.0 * share)))
}
