//! The events of a win: executed interactions, participating types, stretches without events, and swept cells.

use engine::analysis::{EffectSummary, Motion, Role};
use engine::{Analysis, Episode, Game, Level, Meeting, SpriteType, State, Watch};
use generators::boards::Idiom;
use std::collections::{BTreeMap, BTreeSet};

/// The events of a win.
#[derive(Clone, Debug, Default)]
pub(super) struct Events {
    /// The interactions that did more than stop or turn a sprite, in the order of their first executions.
    pub(super) firsts: Vec<usize>,
    /// The fraction of placed types, not counting walls and floor, that took part.
    pub(super) used: f64,
    /// The fraction of placed types that take part, among the types whose placement pattern is in [`HANDLED`].
    pub(super) handled: f64,
    /// The number of supplies that the win leaves in place. Supplies are sprites to be pushed, and resources that can
    /// be held.
    pub(super) spare: usize,
    /// The number of supplies (sprites to push and resources to collect) at the start.
    pub(super) supplies: usize,
    /// The longest stretch of the win in which no interaction of `firsts` is executed, as a fraction of the win's
    /// ticks.
    pub(super) dead: f64,
    /// The mean number of cells swept by self-moving sprites; `None` without such sprites.
    pub(super) sweep: Option<f64>,
}

/// The placement patterns of types that the player handles. A win that leaves such a type alone shows that the type is
/// not needed.
const HANDLED: [Idiom; 4] = [Idiom::Thing, Idiom::Heavy, Idiom::Spot, Idiom::Exit];

/// Returns `true` if an interaction only stops or turns its first sprite, which makes it a guard.
pub(super) fn is_guard(analysis: &Analysis, line: usize) -> bool {
    let idle = |effect: &EffectSummary| {
        matches!(effect, EffectSummary::Stop | EffectSummary::Undo(_) | EffectSummary::Turn)
    };
    let mut own = analysis.encounters().iter().filter(|met| met.line == line);
    own.all(|met| met.effects.iter().all(idle))
}

/// Replays a win and returns the interactions that do more than stop or turn a sprite, in the order in which they are
/// first executed. Costs one replay of the win.
pub(crate) fn first_executions(analysis: &Analysis, level: &Level, win: &Episode) -> Vec<usize> {
    events(analysis, level, win).firsts
}

/// Replays a win and returns its events. Costs one replay of the win.
pub(super) fn events(analysis: &Analysis, level: &Level, win: &Episode) -> Events {
    let game = analysis.game();
    let mut state = game.start(level, win.seed);
    let mut log = Log { analysis, firsts: Vec::new(), took_part: BTreeSet::new(), is_eventful: false };
    let movers: Vec<SpriteType> = game.sprite_types().filter(|&stype| moves(analysis, stype)).collect();
    let mut swept: BTreeMap<SpriteType, (usize, BTreeSet<(i32, i32)>)> = BTreeMap::new();
    let (mut since, mut longest) = (0, 0);
    let supplies = |state: &State| -> BTreeSet<(SpriteType, (i32, i32))> {
        let types = game.sprite_types().filter(|&stype| is_supply(analysis, stype));
        types.flat_map(|stype| state.places(stype).map(move |place| (stype, place))).collect()
    };
    let at_start = supplies(&state);
    for (tick, &action) in win.actions.iter().enumerate() {
        for &mover in &movers {
            let (most, cells) = swept.entry(mover).or_default();
            *most = state.alive(mover).max(*most);
            cells.extend(state.places(mover));
        }
        log.is_eventful = false;
        game.step_watched(&mut state, action, &mut log);
        since = if log.is_eventful { 0 } else { since + 1 };
        longest = longest.max(since);
        if tick + 1 == win.actions.len() {
            break;
        }
    }
    let swept: Vec<f64> = swept
        .values()
        .filter(|(most, _)| *most > 0)
        .map(|(most, cells)| cells.len() as f64 / *most as f64)
        .collect();
    let placed = placed(game, analysis, level);
    let took_part = |of: &dyn Fn(&&SpriteType) -> bool| {
        let all = placed.iter().filter(of).count();
        let part = placed.iter().filter(of).filter(|stype| log.took_part.contains(*stype)).count();
        if all == 0 { 1.0 } else { part as f64 / all as f64 }
    };
    let is_handled =
        |stype: &&SpriteType| Idiom::of(analysis, **stype).is_some_and(|idiom| HANDLED.contains(&idiom));
    Events {
        used: took_part(&|_| true),
        handled: took_part(&is_handled),
        spare: at_start.intersection(&supplies(&state)).count(),
        supplies: at_start.len(),
        dead: longest as f64 / win.actions.len().max(1) as f64,
        sweep: (!swept.is_empty()).then(|| swept.iter().sum::<f64>() / swept.len() as f64),
        firsts: log.firsts,
    }
}

/// Returns the types on a board that could take part in a win.
fn placed(game: &Game, analysis: &Analysis, level: &Level) -> BTreeSet<SpriteType> {
    let types = level.cells().iter().flat_map(|&symbol| game.places(symbol)).copied();
    let plays = |stype: &SpriteType| {
        !matches!(analysis.role(*stype), Role::Wall | Role::Floor | Role::Avatar)
            && analysis.facts(*stype).possible
    };
    types.filter(plays).collect()
}

/// Returns `true` if the player needs the type's sprites only in order to push or hold them.
fn is_supply(analysis: &Analysis, stype: SpriteType) -> bool {
    let is_held = analysis.resources().iter().any(|resource| resource.stype == stype);
    (is_held || analysis.role(stype) == Role::Pushable) && !analysis.aims().protect.contains(&stype)
}

fn moves(analysis: &Analysis, stype: SpriteType) -> bool {
    let facts = analysis.facts(stype);
    facts.possible
        && !facts.fleeting
        && analysis.role(stype) != Role::Shot
        && !matches!(facts.motion, Motion::Still | Motion::Steered)
}

struct Log<'a> {
    analysis: &'a Analysis,
    firsts: Vec<usize>,
    took_part: BTreeSet<SpriteType>,
    is_eventful: bool,
}

impl Watch for Log<'_> {
    fn interaction(&mut self, line: usize) {
        if is_guard(self.analysis, line) {
            return;
        }
        self.is_eventful = true;
        if !self.firsts.contains(&line) {
            self.firsts.push(line);
        }
    }

    fn wants_meetings(&self) -> bool {
        true
    }

    fn meeting(&mut self, meeting: Meeting) {
        self.took_part.insert(meeting.first);
        self.took_part.extend(meeting.second);
    }
}

#[cfg(test)]
mod tests {
    use super::super::shortest::{Limits, shortest_win};
    use super::*;
    use base::Seed;

    const GAME: &str = "BasicGame\n  SpriteSet\n    wall > Immovable\n    gate > Immovable\n    key > Resource limit=2\n    bead > Immovable\n    plum > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    G > gate\n    k > key\n    b > bead\n    p > plum\n  InteractionSet\n    avatar wall > stepBack\n    gate avatar > killIfOtherHasMore resource=key limit=1\n    avatar gate > stepBack\n    key avatar > collectResource\n    bead avatar > killSprite scoreChange=1\n    plum avatar > killSprite\n  TerminationSet\n    SpriteCounter stype=avatar win=False\n    SpriteCounter stype=plum win=True\n";

    #[test]
    fn a_bead_beside_the_way_is_not_handled() {
        let game = Game::from_source(GAME).unwrap();
        let analysis = Analysis::of(&game);
        let handled = |level: &str| {
            let level = game.level(level).unwrap();
            let (mut win, mut state) = Episode::begin(&game, &level, Seed::from_text("events"));
            let limits = Limits { calls: 10_000, ticks: 40 };
            let found = shortest_win(&analysis, &state, limits);
            for action in found.win.unwrap() {
                win.play(&game, &mut state, action);
            }
            events(&analysis, &level, &win).handled
        };
        assert_eq!(handled("wwwwwww\nwkAbGpw\nwwwwwww\n"), 1.0);
        assert_eq!(handled("wwwwwww\nwkA Gpw\nwbwwwww\nwwwwwww\n"), 2.0 / 3.0);
    }
}
