//! The simulated draws of games for a chain of monthly releases.

use super::clusters::Clusters;
use super::month::{Again, Nearest, Sketch, WellMonth, WellOrder};
use super::species::Species;
use super::words::Words;
use base::Seed;
use generators::invention::{Census, share_idea};
use rayon::prelude::*;
use statistics::quantile;
use validators::novelty::{GameForm, NEAR, distance};

/// The larger of the two distances used to estimate the unseen probability mass.
const FAR: f64 = 0.4;

/// A function that draws a candidate's rules, given the use counts of mechanics, the known games, the candidate's
/// number and attempt, and a seed.
pub(super) type Draw<'a> = &'a (dyn Fn(&Census, &[GameForm], (u32, u32), Seed) -> Option<Sketch> + Sync);

/// A simulated chain of monthly releases.
pub(super) struct Chain<'a> {
    order: &'a WellOrder,
    /// The known games, and the games of earlier months.
    known: Vec<GameForm>,
    seed: Seed,
    draw: Draw<'a>,
    sets: f64,
    census: Census,
    /// All rules that passed, including those rejected as near duplicates.
    seen: Vec<GameForm>,
    /// For each entry of `seen`, `true` if the rules became a game.
    is_game: Vec<bool>,
    near: Clusters,
    far: Clusters,
    mechanics: Species,
    endings: Species,
    couplings: Species,
    words: Words,
    used: u32,
}

/// The rule sets drawn for one candidate.
#[derive(Default)]
struct Attempts {
    drawn: u64,
    failed: u64,
    passed: Vec<Passed>,
}

/// Rules that passed the simulated judging.
struct Passed {
    sketch: Sketch,
    /// The distances to all rules seen in earlier months.
    distances: Vec<f64>,
    /// The distance to the nearest known game or earlier month's game.
    nearest: f64,
}

impl Passed {
    fn is_near(&self) -> bool {
        self.nearest < NEAR
    }
}

impl<'a> Chain<'a> {
    /// Creates a chain before its first month. `sets` is the total number of rule sets.
    pub(super) fn new(
        order: &'a WellOrder,
        known: &'a [GameForm],
        seed: Seed,
        draw: Draw<'a>,
        sets: f64,
    ) -> Chain<'a> {
        Chain {
            order,
            known: known.to_vec(),
            seed,
            draw,
            sets,
            census: Census::default(),
            seen: Vec::new(),
            is_game: Vec::new(),
            near: Clusters::within(NEAR),
            far: Clusters::within(FAR),
            mechanics: Species::default(),
            endings: Species::default(),
            couplings: Species::default(),
            words: Words::default(),
            used: 0,
        }
    }

    /// Simulates the chain's months.
    pub(super) fn run(mut self, noted: &dyn Fn(&WellMonth)) -> Vec<WellMonth> {
        let months = self.order.months;
        let month = |number| {
            let month = self.month(number);
            noted(&month);
            month
        };
        (1..=months).map(month).collect()
    }

    /// Simulates a month. Its candidates take the games of earlier months into account, but not each other.
    fn month(&mut self, number: u32) -> WellMonth {
        let candidates = (f64::from(self.order.games) * self.order.candidates).ceil() as u64;
        let seed = self.seed.child("month", number.into());
        let jobs: Vec<Attempts> =
            (0..candidates).into_par_iter().map(|at| self.attempts(at as u32, &seed)).collect();
        let drawn = jobs.iter().map(|job| job.drawn).sum();
        let failed = jobs.iter().map(|job| job.failed).sum();
        let passed: Vec<Passed> = jobs.into_iter().flat_map(|job| job.passed).collect();
        let near = passed.iter().filter(|one| one.is_near()).count() as u64;
        let share_near = if passed.is_empty() { 0.0 } else { near as f64 / passed.len() as f64 };
        let yielded = (passed.len() as u64 - near) as f64 / (drawn as f64).max(1.0);
        let mut selection = Selection::default();
        for one in passed {
            self.select(number, one, &mut selection);
        }
        for game in &selection.games {
            self.census.count(game.patterns.iter().map(String::as_str));
            self.known.push(game.form.clone());
        }
        let Selection { games, nearest, near_in_month, same_idea, same_words, again } = selection;
        let quantile_of = |share| quantile(&nearest, share);
        let nearest = quantile_of(0.0).zip(quantile_of(0.05)).zip(quantile_of(0.5));
        WellMonth {
            month: number,
            available: self.sets * (1.0 - share_near),
            drawn,
            failed,
            near,
            near_in_month,
            same_idea,
            same_words,
            games: games.len() as u32,
            used: self.used,
            yielded,
            nearest: nearest.map(|((least, low), median)| Nearest { least, low, median }),
            unseen_near: self.near.unseen(),
            unseen_far: self.far.unseen(),
            unseen_couplings: self.couplings.unseen(),
            unseen_mechanics: self.mechanics.unseen(),
            top_mechanic: self.mechanics.top(self.used),
            top_ending: self.endings.top(self.used),
            top_coupling: self.couplings.top(self.used),
            again,
        }
    }

    /// Draws rules for a candidate until new rules pass.
    fn attempts(&self, number: u32, month: &Seed) -> Attempts {
        let seed = month.child("game", number.into());
        let mut attempts = Attempts::default();
        for attempt in 0..self.order.tries {
            let seed = seed.child("attempt", attempt.into());
            attempts.drawn += 1;
            // Rules that will fail have no further effect, so they need not be drawn.
            if seed.child("play", 0).sampler().unit() >= self.order.passing {
                attempts.failed += 1;
                continue;
            }
            let Some(sketch) = (self.draw)(&self.census, &self.known, (number, attempt), seed) else {
                continue;
            };
            let passed = self.compared(sketch);
            let is_new = !passed.is_near();
            attempts.passed.push(passed);
            if is_new {
                break;
            }
        }
        attempts
    }

    fn compared(&self, sketch: Sketch) -> Passed {
        let distances: Vec<f64> = self.seen.iter().map(|form| distance(&sketch.form, form)).collect();
        let of_known = self.known.iter().map(|form| distance(&sketch.form, form));
        let nearest = of_known.fold(1.0, f64::min);
        Passed { sketch, distances, nearest }
    }

    /// Records rules that passed, and adds them to the month's games if accepted.
    fn select(&mut self, month: u32, passed: Passed, selection: &mut Selection) {
        let is_near = passed.is_near();
        let Passed { sketch, mut distances, nearest } = passed;
        let before = distances.len();
        let of_month = self.seen[before..].iter().map(|form| distance(&sketch.form, form));
        distances.extend(of_month);
        self.near.add(&distances);
        self.far.add(&distances);
        let games = distances.iter().zip(&self.is_game).skip(before).filter(|(_, is_game)| **is_game);
        let nearest = games.map(|(apart, _)| *apart).fold(nearest, f64::min);
        let is_taken = !is_near && selection.takes(&sketch, nearest, self.order.games);
        self.seen.push(sketch.form.clone());
        self.is_game.push(is_taken);
        if !is_taken {
            return;
        }
        self.used += 1;
        for (species, kind) in [
            (&mut self.mechanics, "mechanic/"),
            (&mut self.endings, "ending/"),
            (&mut self.couplings, "coupling/"),
        ] {
            species.count(sketch.patterns.iter().filter_map(|pattern| pattern.strip_prefix(kind)));
        }
        self.words.note(month, &sketch, &mut selection.again);
        selection.nearest.push(nearest);
        selection.games.push(sketch);
    }
}

/// A month's games, in candidate order.
#[derive(Default)]
struct Selection {
    games: Vec<Sketch>,
    nearest: Vec<f64>,
    near_in_month: u64,
    same_idea: u64,
    same_words: u64,
    again: Again,
}

impl Selection {
    /// Returns `true` if a candidate becomes a game. This requires that the month still needs games. No game of the
    /// month may be similar, have the same title, or share most of its type names.
    fn takes(&mut self, sketch: &Sketch, nearest: f64, room: u32) -> bool {
        let has_words = |other: &Sketch| other.title == sketch.title || other.cast.is_shared(&sketch.cast);
        if self.games.len() >= room as usize {
            return false;
        }
        if nearest < NEAR {
            self.near_in_month += 1;
            return false;
        }
        if self.games.iter().any(|other| share_idea(&other.patterns, &sketch.patterns)) {
            self.same_idea += 1;
            return false;
        }
        if self.games.iter().any(has_words) {
            self.same_words += 1;
            return false;
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::games::Cast;
    use engine::Game;

    /// Returns rules with `gems` kinds of gems.
    fn sketch(gems: usize) -> Sketch {
        let lines = |line: fn(usize) -> String| (0..gems).map(line).collect::<String>();
        let source = format!(
            "BasicGame\n  SpriteSet\n{}    avatar > MovingAvatar\n  LevelMapping\n{}  InteractionSet\n{}  TerminationSet\n    SpriteCounter stype=gem0 win=True\n    Timeout limit=90\n",
            lines(|at| format!("    gem{at} > Immovable\n")),
            lines(|at| format!("    {} > gem{at}\n", (b'a' + at as u8) as char)),
            lines(|at| format!("    gem{at} avatar > killSprite scoreChange={}\n", at + 1)),
        );
        let game = Game::from_source(&source).unwrap_or_else(|problems| panic!("{problems}\n{source}"));
        Sketch {
            form: GameForm::of(&game),
            title: format!("Gems {gems}"),
            summary: "Dig. Take the gems.".to_owned(),
            cast: Cast::of(&game),
            patterns: vec!["mechanic/take".to_owned(), "coupling/a+b".to_owned()],
        }
    }

    const ORDER: WellOrder = WellOrder { months: 3, games: 2, candidates: 1.5, tries: 4, passing: 0.9 };

    fn months(order: &WellOrder, known: &[GameForm], draw: Draw<'_>) -> Vec<WellMonth> {
        Chain::new(order, known, Seed::from_text("well"), draw, 100.0).run(&|_| ())
    }

    /// In a chain with a single rule set, every later draw is rejected, which shows that no unseen rules are left.
    #[test]
    fn a_chain_of_one_rule_set_has_nothing_unseen() {
        let found = months(&ORDER, &[], &|_, _, _, _| Some(sketch(1)));
        let games: Vec<u32> = found.iter().map(|month| month.games).collect();
        assert_eq!(games, [1, 0, 0]);
        let last = found.last().unwrap();
        assert_eq!((last.unseen_near, last.unseen_far), (Some(0.0), Some(0.0)));
        assert_eq!((last.available, last.yielded, last.nearest), (0.0, 0.0, None));
        assert!(last.near > 0 && last.used == 1);
        assert_eq!(last.top_mechanic.as_ref().map(|top| top.share), Some(1.0));
    }

    #[test]
    fn a_known_game_is_refused() {
        let found = months(&ORDER, &[sketch(1).form], &|_, _, _, _| Some(sketch(1)));
        assert!(found.iter().all(|month| month.games == 0 && month.near > 0));
    }

    #[test]
    fn rules_that_nobody_finds_boards_for_are_no_games() {
        let found = months(&WellOrder { passing: 0.0, ..ORDER }, &[], &|_, _, _, _| Some(sketch(1)));
        assert!(found.iter().all(|month| month.games == 0 && month.failed == month.drawn));
        assert_eq!(found[0].unseen_near, None);
    }

    #[test]
    fn months_are_the_same_on_any_number_of_threads() {
        let order = WellOrder { passing: 0.5, ..ORDER };
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| super::super::simulate(&order, &[], Seed::from_text("threads"), &|_| ()))
        };
        let one = on(1);
        assert_eq!(one, on(3));
        assert!(one.months.iter().all(|month| month.games > 0 && month.nearest.unwrap().least >= NEAR));
        assert_eq!(one.tables().map(|table| table.rows.len()), [3, 3]);
    }
}
