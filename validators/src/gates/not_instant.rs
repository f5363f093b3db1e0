//! The `not-instant` gate: checks that levels after the first cannot be won immediately or by walking to the nearest
//! goal.

use super::{Gates, NO_WIN, WonLevel, careless, finding, without_subject, won_levels};
use crate::allowance::Setting;
use crate::evidence::{Evidence, Line};
use crate::validator::{GameCase, GameValidator};
use crate::verdict::Finding;
use base::Seed;
use engine::analysis::{Attainable, Role};
use engine::{Analysis, Episode, Game, Level, SpriteClass, SpriteType, Term};

/// Passes if each level after the first meets two conditions:
///
/// - The shortest known win takes at least [`Gates::least_win`] ticks and [`Gates::spawn_periods`] periods of the
///   slowest spawner on the level.
/// - The nearest-goal player ([`agents::NearestGoal`]) wins at most [`Gates::bot_wins`] of its episodes. If it wins
///   more, it plays four times as many episodes.
///
/// Up to a fraction [`Gates::instant_levels`] of these levels may be exceptions. In addition, the game's time limit
/// must be within [`Gates::time_limit`] times the longest known win.
///
/// A spawner (a sprite that creates others) counts if the level places it and its sprites can do harm, are needed for
/// an ending or give something. Its period is the mean time between two sprites: its cooldown divided by its
/// probability. The time limit does not matter in games won by surviving. Costs the nearest-goal player's episodes.
#[derive(Clone, Debug)]
pub struct NotInstant(pub Gates);

pub(crate) const QUESTION: &str = "does a win take time, and does the time limit leave a sensible margin?";

pub(crate) fn judge(setting: &Setting<'_>) -> NotInstant {
    NotInstant(setting.criteria.gates.clone())
}

impl GameValidator for NotInstant {
    fn validate(&self, case: GameCase<'_>) -> Finding {
        let gates = &self.0;
        let Some(wins) = won_levels(case) else { return without_subject(NO_WIN) };
        let longest = wins.iter().map(WonLevel::ticks).max().unwrap_or_default();
        let periods = periods(case.analysis);
        let (mut problems, mut notes, mut instant) = (Vec::new(), Vec::new(), 0);
        let later: Vec<&WonLevel<'_>> = wins.iter().filter(|won| won.number > 0).collect();
        for won in &later {
            let before = problems.len();
            problems.extend(self.too_short(case.analysis, **won, &periods));
            let seed = case.seed.child("level", won.number as u64);
            let wins = |plays| NotInstant::nearest_goal_wins(case.game, won.level, won.ticks(), plays, seed);
            let mut share = wins(gates.bot_plays);
            if share > gates.bot_wins {
                share = wins(gates.bot_plays.saturating_mul(careless::CLOSER));
            }
            let text = format!(
                "the nearest-goal player wins {:.0}% of its episodes on level {}",
                100.0 * share,
                won.number
            );
            match share > gates.bot_wins {
                true => problems
                    .push(Evidence::new(text).advise("make the nearest goal the wrong choice at times")),
                false => notes.push(Evidence::new(text)),
            }
            instant += usize::from(problems.len() > before);
        }
        if (instant as f64) <= gates.instant_levels * later.len() as f64 {
            notes.splice(0..0, problems.drain(..));
        }
        let aims = case.analysis.aims();
        if let (Some(limit), None) = (aims.deadline, aims.survive) {
            let factor = f64::from(limit) / longest.max(1) as f64;
            let (least, most) = gates.time_limit;
            let text = format!(
                "the time limit of {limit} ticks is {factor:.1} times the longest win of {longest} ({least} \
                 to {most} times required)"
            );
            match factor < least || factor > most {
                true => problems
                    .push(Evidence::new(text).advise("set the time limit in proportion to the longest win")),
                false => notes.push(Evidence::new(text)),
            }
        }
        let shortest = later.iter().map(|won| won.ticks()).min();
        finding(problems, notes, shortest.map(|ticks| ticks as f64))
    }
}

impl NotInstant {
    /// Returns `true` if the nearest-goal player wins a level more often than the gate allows on levels after the
    /// first. The player may take as long as if the known win took `ticks` ticks. This check does not need a known win,
    /// so it can reject a level before a win search. It does not include the gate's second evaluation, which plays more
    /// episodes. Costs the player's episodes.
    pub fn is_walked_through(&self, game: &Game, level: &Level, ticks: usize, seed: Seed) -> bool {
        NotInstant::nearest_goal_wins(game, level, ticks, self.0.bot_plays, seed) > self.0.bot_wins
    }

    /// Returns `true` if a win comes sooner than the gate allows on levels after the first.
    pub fn is_too_short(&self, analysis: &Analysis, level: &Level, win: &Episode) -> bool {
        let won = WonLevel { number: 1, level, win };
        !self.too_short(analysis, won, &periods(analysis)).is_empty()
    }

    fn nearest_goal_wins(game: &Game, level: &Level, ticks: usize, plays: u32, seed: Seed) -> f64 {
        careless::win_share(&careless::nearest_goal(game, level, ticks, 0.0, 0..plays, seed))
    }

    /// Returns a problem if the win takes fewer than [`Gates::least_win`] ticks, and another if it takes fewer than
    /// [`Gates::spawn_periods`] periods of the slowest spawner on the level.
    fn too_short(
        &self,
        analysis: &Analysis,
        won: WonLevel<'_>,
        periods: &[(SpriteType, f64)],
    ) -> Vec<Evidence> {
        let Gates { least_win, spawn_periods, .. } = self.0;
        let (game, number, ticks) = (analysis.game(), won.number, won.ticks());
        let mut problems = Vec::new();
        if ticks < least_win {
            let text =
                format!("level {number} is won in {}, fewer than {least_win}", base::count(ticks, "tick"));
            problems.push(Evidence::new(text).advise("move the goal farther away, or add an obstacle"));
        }
        let start = game.start(won.level, won.win.seed);
        let placed = periods.iter().filter(|(stype, _)| start.alive(*stype) > 0);
        let slowest = placed.max_by(|one, other| one.1.total_cmp(&other.1));
        if let Some((stype, period)) = slowest.filter(|(_, period)| (ticks as f64) < spawn_periods * period) {
            let name = game.name(*stype);
            let text = format!(
                "level {number} is won in {}, before {spawn_periods} periods of `{name}` ({period:.0} ticks each)",
                base::count(ticks, "tick")
            );
            let rule = Line::sprite(game, name);
            problems.push(Evidence { rule, ..Evidence::new(text) }.advise("lower the spawner's cooldown"));
        }
        problems
    }
}

/// Returns the spawners whose products matter, with the mean number of ticks between two spawned sprites.
fn periods(analysis: &Analysis) -> Vec<(SpriteType, f64)> {
    let game = analysis.game();
    let goals: Vec<SpriteType> = analysis
        .goals()
        .iter()
        .filter(|goal| goal.attainable != Attainable::Never)
        .flat_map(|goal| goal.condition.types())
        .copied()
        .collect();
    let matters = |stype: &SpriteType| {
        let role = analysis.role(*stype);
        goals.contains(stype) || !matches!(role, Role::Floor | Role::Neutral | Role::Wall | Role::Cover)
    };
    let spawns = |class: SpriteClass| {
        class.is_a(SpriteClass::SpawnPoint) || class == SpriteClass::SpawnPointMultiSprite
    };
    let clauses = game.clauses();
    let spawners = clauses.types.iter().filter(|clause| clause.class.is_some_and(spawns));
    let spawners = spawners.filter(|clause| analysis.facts(clause.stype).makes.iter().any(matters));
    let period = |clause: &engine::TypeClause| {
        let number = |key: &str| {
            clause.terms.iter().find_map(|(name, term)| match term {
                Term::Number(number) if *name == key => Some(*number),
                _ => None,
            })
        };
        let chance = number("prob").unwrap_or(1.0).clamp(0.001, 1.0);
        (clause.stype, number("cooldown").unwrap_or(1.0).max(1.0) / chance)
    };
    spawners.map(period).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Criterion;
    use crate::gates::tests::check;

    const GAME: &str = "BasicGame\n  SpriteSet\n    hive > SpawnPoint stype=wasp cooldown=15 prob=0.5\n    wasp > Missile orientation=LEFT\n    plum > Immovable\n    key > Resource limit=2\n    gate > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    h > hive\n    p > plum\n    k > key\n    g > gate\n  InteractionSet\n    avatar wall > stepBack\n    wasp wall > killSprite\n    key avatar > collectResource\n    gate avatar > killIfOtherHasMore resource=key limit=1 subtract=True\n    avatar gate > stepBack\n    avatar wasp > killSprite\n    plum avatar > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype=plum win=True\n    SpriteCounter stype=avatar win=False\n    Timeout limit=80 win=False\n";
    const NEAR: &str = "wwwwww\nwA  pw\nwwwwww\n";

    #[test]
    fn periods_count_the_probability() {
        let game = Game::from_source(GAME).unwrap();
        let found = periods(&Analysis::of(&game));
        assert_eq!(found, [(game.sprite_type("hive").unwrap(), 30.0)]);
    }

    #[test]
    fn near_goals_and_early_spawners_fail() {
        check(Criterion::NotInstant, GAME, &[NEAR, NEAR], Some("level 1 is won in 3 ticks, fewer than 25"));
        let hive = "wwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwww\nwA                                pw\nw                                  w\nwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwww\nw                                 hw\nwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwww\n";
        check(
            Criterion::NotInstant,
            GAME,
            &[NEAR, hive],
            Some("before 1.5 periods of `hive` (30 ticks each)"),
        );
        let plain = "wwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwww\nwA                                pw\nwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwww\n";
        check(Criterion::NotInstant, GAME, &[NEAR, plain], Some("the nearest-goal player wins 100%"));
        check(
            Criterion::NotInstant,
            &GAME.replace("80", "900"),
            &[NEAR],
            Some("time limit of 900 ticks is 300.0 times"),
        );
    }

    const LOCK: &str = "wwwwwwwwwwwwwwwww\nwA  p   w       w\nw       w       w\nw       w       w\nw       g       w\nw       w      pw\nwk      w       w\nwwwwwwwwwwwwwwwww\n";

    #[test]
    fn a_lock_takes_longer() {
        check(Criterion::NotInstant, GAME, &[NEAR, LOCK], None);
    }

    #[test]
    fn a_walk_is_told_before_a_win_is_known() {
        let game = Game::from_source(GAME).unwrap();
        let gate = NotInstant(Gates::default());
        let is_walk = |level: &str| {
            gate.is_walked_through(&game, &game.level(level).unwrap(), 160, Seed::from_text("walk"))
        };
        assert!(is_walk(NEAR) && !is_walk(LOCK));
    }
}
