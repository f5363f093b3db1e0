//! The stages of a candidate level for one position of a game.

use super::sources::seed_of_win;
use super::stage::{Passage, Refusal, Stage};
use crate::boards::likeness::are_one_board;
use crate::games::{Drawn, FoundLevel, Levels, puzzles};
use crate::tally::Tally;
use engine::{Action, Analysis, Episode, Game};
use std::slice;
use validators::measures::Guards;
use validators::{
    Criterion, CriterionSet, Demand, Effort, Finding, Judgement, Judging, NotInstant, OpenGround, Panel,
    Verdict,
};

/// The minimum length of a later level's win, as a fraction of the length of an earlier level's win. Wins must not
/// become much shorter from level to level.
pub(super) const LATER_SHARE: f64 = 0.6;

/// The position of a level within its game, and the levels at other positions.
pub(super) struct Place<'a> {
    pub(super) levels: &'a Levels<'a>,
    pub(super) game: &'a Game,
    pub(super) number: u32,
    /// The levels at other positions, with their numbers.
    pub(super) others: &'a [(u32, FoundLevel)],
}

/// A candidate for one position of a game.
pub(super) struct LevelTrial<'a> {
    pub(super) place: &'a Place<'a>,
    pub(super) drawn: Drawn,
    /// The actions of a win known to the generator; `None` if the generator knows no win.
    pub(super) known: Option<Vec<Action>>,
    proof: Option<Proof>,
    /// The level with its judges' findings, once they have accepted it.
    pub(super) found: Option<FoundLevel>,
}

/// A level's win, if the generator knows one.
struct Proof {
    win: Episode,
    is_shortest: bool,
    calls: u64,
}

impl LevelTrial<'_> {
    pub(super) const NEW_LEVEL: Stage<Self> = Stage {
        name: "new level",
        purpose: "compares the level with the other levels of the game",
        reasons: &["the same level twice"],
        ..Stage::once(Self::refuse_same_level)
    };

    pub(super) const NEW_BOARD: Stage<Self> = Stage {
        name: "new board",
        purpose: "in a course, rejects a board that differs in only a few cells from another level's board, \
                  even if that board is mirrored, turned or shifted",
        reasons: &["like another level"],
        ..Stage::once(Self::refuse_same_board)
    };

    pub(super) const OPEN_GROUND: Stage<Self> = Stage {
        name: "open ground",
        purpose: "in a course, rejects a level whose narrow cells alone exceed the limit for the whole \
                  game",
        criteria: CriterionSet::of(&[Criterion::OpenGround]),
        ..Stage::once(Self::refuse_narrow_ground)
    };

    pub(super) const NEAREST_GOAL: Stage<Self> = Stage {
        name: "nearest goal",
        purpose: "after the second level of a course, rejects levels that a walk to the nearest goal wins",
        cost: "a play",
        criteria: CriterionSet::of(&[Criterion::NotInstant]),
        ..Stage::once(Self::refuse_walk_to_goal)
    };

    pub(super) const SHORTEST_WIN: Stage<Self> = Stage {
        name: "shortest win",
        purpose: "if the generator knows a win, proves the shortest win or takes the known win",
        cost: "a fraction of the budget of `winnable`",
        ..Stage::once(Self::prove_win)
    };

    pub(super) const JUDGES: Stage<Self> = Stage {
        name: "judges",
        purpose: "judges every criterion of levels, except `skill` in generated games",
        cost: "up to the budget of `winnable`; a failed search of half a million calls counts as two candidates, or as six while the game has \
               fewer than two levels",
        criteria: CriterionSet::LEVEL,
        ..Stage::once(Self::judge)
    };

    pub(super) const ORDER: Stage<Self> = Stage {
        name: "order",
        purpose: "in a course, requires that the win takes at least 0.6 times the ticks of every earlier \
                  level's win",
        reasons: &["less than an earlier level"],
        ..Stage::once(Self::compare_with_other_levels)
    };

    pub(super) const LATER_MECHANIC: Stage<Self> = Stage {
        name: "later mechanic",
        purpose: "when replacing a course's first level, requires a later win to need a mechanic that the \
                  replacement's own win does not need",
        cost: "a replay of each win",
        criteria: CriterionSet::of(&[Criterion::Progression]),
        ..Stage::once(Self::ask_for_something_left)
    };

    pub(super) const LENGTH_OF_WIN: Stage<Self> = Stage {
        name: "length of win",
        purpose: "after the second level of a course, rejects a win that comes sooner than `not-instant` \
                  allows",
        criteria: CriterionSet::of(&[Criterion::NotInstant]),
        ..Stage::once(Self::refuse_early_win)
    };

    pub(super) const DEAD_TIME: Stage<Self> = Stage {
        name: "dead time",
        purpose: "in a course, rejects a win with a long stretch without progress, such as waiting or pacing",
        cost: "a replay",
        criteria: CriterionSet::of(&[Criterion::NoDeadTime]),
        ..Stage::once(Self::refuse_dead_time)
    };

    pub(super) const TIER: Stage<Self> = Stage {
        name: "tier",
        purpose: "for a puzzle, measures the demands of its win, and requires the tier of the position",
        cost: "a second",
        reasons: &["tier"],
        ..Stage::once(Self::measure_tier)
    };

    fn refuse_same_level(&mut self, _: &mut Tally) -> Passage {
        let digest = self.drawn.level.digest();
        let is_taken = self.place.others.iter().any(|(_, found)| found.level.digest() == digest);
        if is_taken { Err("the same level twice".into()) } else { Ok(()) }
    }

    fn refuse_same_board(&mut self, _: &mut Tally) -> Passage {
        let is_shown = |(_, other): &(u32, FoundLevel)| are_one_board(&self.drawn.level, &other.level);
        let is_shown = self.is_of_course() && self.place.others.iter().any(is_shown);
        if is_shown { Err("like another level".into()) } else { Ok(()) }
    }

    fn refuse_narrow_ground(&mut self, _: &mut Tally) -> Passage {
        let Levels { criteria, count, .. } = *self.place.levels;
        if !criteria.includes(Criterion::OpenGround) || !self.is_of_course() {
            return Ok(());
        }
        let analysis = Analysis::of(self.place.game);
        let others = self.place.others.iter().map(|(_, found)| &found.level);
        let shares =
            others.chain([&self.drawn.level]).filter_map(|level| OpenGround::narrow(&analysis, level));
        let is_narrow = shares.sum::<f64>() > criteria.gates.narrow * f64::from(count);
        if is_narrow { Err(Criterion::OpenGround.into()) } else { Ok(()) }
    }

    fn refuse_walk_to_goal(&mut self, _: &mut Tally) -> Passage {
        let (ticks, seed) =
            (self.place.levels.criteria.most_ticks, self.drawn.seed.seed().child("nearest goal", 0));
        let is_won = self
            .not_instant()
            .is_some_and(|gate| gate.is_walked_through(self.place.game, &self.drawn.level, ticks, seed));
        if is_won { Err(Criterion::NotInstant.into()) } else { Ok(()) }
    }

    fn prove_win(&mut self, tally: &mut Tally) -> Passage {
        let Some(known) = self.known.take() else { return Ok(()) };
        let criteria = self.place.levels.criteria;
        let (analysis, Drawn { level, seed, .. }) = (Analysis::of(self.place.game), &self.drawn);
        let calls = (criteria.budget as f64 * criteria.shortest) as u64;
        let (win, is_shortest, calls) =
            puzzles::win(&analysis, level, known, calls, &seed_of_win(seed)).ok_or(Refusal::Counted)?;
        tally.judge(Criterion::Winnable.name(), true, calls);
        self.drawn.win = Some(win.clone());
        self.proof = Some(Proof { win, is_shortest, calls });
        Ok(())
    }

    fn judge(&mut self, tally: &mut Tally) -> Passage {
        let Place { levels, game, .. } = *self.place;
        let drawn = self.drawn.clone();
        let found = match self.proof {
            None => levels.judge_drawn(levels.panel, game, drawn, tally),
            Some(_) => {
                let others = levels.criteria.without(CriterionSet::of(&[Criterion::Winnable]));
                levels.judge_drawn(&Panel::new(others, Effort::Sequential), game, drawn, tally)
            }
        };
        self.found = Some(found.ok_or(Refusal::Counted)?);
        Ok(())
    }

    fn compare_with_other_levels(&mut self, _: &mut Tally) -> Passage {
        let Some(found) = self.found_of_course() else { return Ok(()) };
        let in_order = |(number, other): &(u32, FoundLevel)| match *number < self.place.number {
            true => takes_as_long(found, other),
            false => takes_as_long(other, found),
        };
        let is_in_order = self.place.others.iter().all(in_order);
        if is_in_order { Ok(()) } else { Err("less than an earlier level".into()) }
    }

    fn ask_for_something_left(&mut self, _: &mut Tally) -> Passage {
        let Some(found) = self.found_of_course() else { return Ok(()) };
        let Place { levels, game, number, others } = *self.place;
        let gives_all = number == 0 && !leaves_something(levels, game, found, others);
        if gives_all { Err(Criterion::Progression.into()) } else { Ok(()) }
    }

    fn refuse_early_win(&mut self, _: &mut Tally) -> Passage {
        let Some(found) = self.found_of_course() else { return Ok(()) };
        let (Some(gate), Some(win)) = (self.not_instant(), &found.report.witness) else { return Ok(()) };
        let is_early = gate.is_too_short(&Analysis::of(self.place.game), &found.level, win);
        if is_early { Err(Criterion::NotInstant.into()) } else { Ok(()) }
    }

    /// Rejects a level that fails the gate against dead time (ticks in which play has no effect) when judged on its
    /// own.
    fn refuse_dead_time(&mut self, tally: &mut Tally) -> Passage {
        let Some(found) = self.found_of_course() else { return Ok(()) };
        let panel = self.place.levels.panel_of(CriterionSet::of(&[Criterion::NoDeadTime]));
        let (board, report) = (slice::from_ref(&found.level), slice::from_ref(&found.report));
        let judging =
            Judging::together(self.place.game, board, report, found.seed.seed().child("dead time", 0));
        let judged = panel.judge(judging.until_failure());
        tally.judgements(&judged);
        let is_tedious = judged.iter().any(|judgement| !judgement.finding.verdict.is_pass());
        if is_tedious { Err(Criterion::NoDeadTime.into()) } else { Ok(()) }
    }

    fn measure_tier(&mut self, _: &mut Tally) -> Passage {
        let (Some(proof), Some(found)) = (self.proof.take(), &mut self.found) else { return Ok(()) };
        let Proof { win, is_shortest, calls } = proof;
        let optimal = is_shortest.then_some(win.actions.len());
        let verdict = Verdict::Pass { witness: Some(win.clone()) };
        let finding = Finding { searched: Some(calls), optimal, ..Finding::from(verdict) };
        found.report.judgements.insert(0, Judgement { criterion: Criterion::Winnable, finding });
        let Some(asked) = self.place.levels.source.tier(self.place.number) else { return Ok(()) };
        let (analysis, seed) = (Analysis::of(self.place.game), self.drawn.seed.seed().child("demand", 0));
        let demand = Demand::of(&analysis, &found.level, &win, is_shortest, seed).ok_or(Refusal::Counted)?;
        let tier = demand.tier();
        found.demand = Some(demand);
        if tier == asked { Ok(()) } else { Err("tier".into()) }
    }

    fn is_of_course(&self) -> bool {
        self.place.levels.source.is_course()
    }

    fn found_of_course(&self) -> Option<&FoundLevel> {
        self.found.as_ref().filter(|_| self.is_of_course())
    }

    /// Returns the gate against instant wins, if it applies to the level at this position. If a game has enough levels
    /// to allow one exception, the second level is exempt.
    fn not_instant(&self) -> Option<NotInstant> {
        let Levels { criteria, count, .. } = *self.place.levels;
        let gates = &criteria.gates;
        let exceptions = gates.instant_levels * f64::from(count.saturating_sub(1));
        let is_asked = criteria.includes(Criterion::NotInstant) && self.is_of_course();
        let first = if exceptions >= 1.0 { 2 } else { 1 };
        (is_asked && self.place.number >= first).then(|| NotInstant(gates.clone()))
    }
}

impl<'a> LevelTrial<'a> {
    pub(super) fn new(place: &'a Place<'a>, drawn: Drawn, known: Option<Vec<Action>>) -> LevelTrial<'a> {
        LevelTrial { place, drawn, known, proof: None, found: None }
    }
}

/// Returns `true` if winning a level takes at least about as long as winning an earlier level of the game.
fn takes_as_long(found: &FoundLevel, earlier: &FoundLevel) -> bool {
    let ticks = |found: &FoundLevel| found.report.witness.as_ref().map_or(0, |win| win.actions.len());
    ticks(found) as f64 >= LATER_SHARE * ticks(earlier) as f64
}

/// Returns `true` if the win of a later level executes a mechanic that the first level's win does not, or if the
/// criteria do not require a new mechanic.
pub(super) fn leaves_something(
    levels: &Levels<'_>,
    game: &Game,
    first: &FoundLevel,
    later: &[(u32, FoundLevel)],
) -> bool {
    let criteria = levels.criteria;
    if later.is_empty() || !criteria.includes(Criterion::Progression) || criteria.gates.growth == 0 {
        return true;
    }
    let guards = Guards::of(&Analysis::of(game));
    let known = first.mechanics(game, &guards);
    later.iter().any(|(_, found)| !found.mechanics(game, &guards).is_subset(&known))
}
