//! A lower bound on the number of pushes between a state and a win. For example, no number of pushes gets a box from
//! a corner to its goal.

use base::Seed;
use engine::analysis::{Analysis, Condition, EffectSummary, Encounter, Motion, Precondition, Reach, Side};
use engine::{Level, SpriteClass, SpriteType, State};
use smallvec::SmallVec;

/// Lower bounds on the number of pushes that a level's pushable sprites need.
///
/// Each bound is for one cell and one type that moves only when it is pushed. The bound is the minimum number of
/// pushes after which a rule may remove the sprite or turn it into a sprite that may stay. The bounds are derived
/// from the rules. They generalise the distances and "simple deadlocks" of Sokoban solvers (Junghanns and Schaeffer
/// 2001, "Sokoban: enhancing general single-agent search methods using domain knowledge").
///
/// Each sprite is treated as if it were alone on the board, and everything else is assumed to be as helpful as
/// [`Reach`] allows. Therefore, no state needs fewer pushes than the bound, and a state that is reported as dead
/// cannot be won.
#[derive(Clone, Debug, Default)]
pub struct Pushes {
    columns: i32,
    /// The pushes that each winning goal needs. Empty if anything other than pushes can cause a win.
    needs: Vec<Need>,
}

/// A goal that requires the removal of sprites.
#[derive(Clone, Debug)]
struct Need {
    /// The number of sprites that are allowed to remain.
    limit: usize,
    /// The counted types, each with the number of pushes needed by a sprite in each cell.
    pushes: Vec<(SpriteType, Vec<u16>)>,
}

/// The value for a sprite for which no number of pushes is enough.
const NEVER: u16 = u16::MAX;

impl Pushes {
    /// Computes the bounds. Cost: one [`Analysis::reach`], plus O(types × interactions × cells).
    pub fn of(analysis: &Analysis, level: &Level) -> Pushes {
        find(analysis, level).unwrap_or_default()
    }

    /// Returns the minimum number of pushes, and hence of ticks, that a state of the level needs. Returns 0 if no
    /// bound is known, or `None` if the state can no longer be won. Cost: O(sprites that must disappear).
    pub fn least(&self, state: &State) -> Option<u32> {
        if self.needs.is_empty() {
            return Some(0);
        }
        self.needs.iter().filter_map(|need| need.least(self.columns, state)).min()
    }
}

impl Need {
    fn least(&self, columns: i32, state: &State) -> Option<u32> {
        let block = state.block();
        let mut needed: SmallVec<[u16; 32]> = SmallVec::new();
        for (stype, pushes) in &self.pushes {
            for rect in state.rects(*stype) {
                // There is no bound for a sprite that is not aligned with the cells.
                let is_aligned = rect.x % block == 0 && rect.y % block == 0;
                let cell = (rect.y / block).wrapping_mul(columns).wrapping_add(rect.x / block);
                needed.push(pushes.get(cell as usize).copied().filter(|_| is_aligned).unwrap_or(0));
            }
        }
        // Some sprites may remain. The estimate is admissible because it leaves out the sprites that need the most pushes.
        if self.limit > 0 {
            needed.sort_unstable();
            needed.truncate(needed.len().saturating_sub(self.limit));
        }
        let is_lost = needed.contains(&NEVER);
        (!is_lost).then(|| needed.iter().map(|&pushes| u32::from(pushes)).sum())
    }
}

/// Computes the bounds. Returns `None` if the rules cannot be modelled, because then no bound is certain.
fn find(analysis: &Analysis, level: &Level) -> Option<Pushes> {
    let game = analysis.game();
    let is_modelled = !analysis.has_timed_effects() && steps_are_whole(analysis);
    if analysis.pushables().is_empty() || !is_modelled || has_other_avatar(analysis, level) {
        return None;
    }
    let reach = analysis.reach(level);
    if reach.is_coarse() {
        return None;
    }
    let abstraction = analysis.abstraction(&game.start(level, Seed::from_text("pushes")));
    let still = game.sprite_types().filter(|&stype| abstraction.is_constant(stype)).collect();
    let board = Board { analysis, level, reach: &reach, still, columns: level.columns(), rows: level.rows() };
    let pushed: Vec<SpriteType> = analysis.pushables().iter().map(|pushable| pushable.stype).collect();
    let is_tame: Vec<bool> =
        game.sprite_types().map(|stype| pushed.contains(&stype) && board.only_pushed(stype)).collect();
    let winning = analysis.goals().iter().filter(|goal| goal.win);
    let needs: Option<Vec<Need>> = winning
        .map(|goal| {
            let (types, limit) = match &goal.condition {
                Condition::AtMost(types, limit) => (types, *limit),
                Condition::Exactly(types, 0) => (types, 0),
                _ => return None,
            };
            let tame = types.iter().filter(|stype| is_tame[stype.index()]);
            let pushes: Vec<_> =
                tame.clone().map(|&stype| (stype, board.pushes(stype, types, &is_tame))).collect();
            let some = pushes.iter().any(|(_, cells)| cells.iter().any(|&pushes| pushes > 0));
            some.then_some(Need { limit: usize::try_from(limit).ok()?, pushes })
        })
        .collect();
    Some(Pushes { columns: level.columns() as i32, needs: needs? })
}

/// Returns `true` if an effect moves a sprite other than by a push, or changes its speed.
fn moves(effect: &EffectSummary) -> bool {
    use EffectSummary::{Carry, Speed, Teleport, Wrap};
    matches!(effect, Carry | Teleport | Wrap | Speed(_))
}

/// Returns `true` if all avatars move by whole cells and face the direction in which they move, and nothing else
/// moves them.
fn steps_are_whole(analysis: &Analysis) -> bool {
    let displaces =
        |effect: &EffectSummary| matches!(effect, EffectSummary::Turn | EffectSummary::Push) || moves(effect);
    analysis.avatars().iter().all(|avatar| analysis.moves_by_whole_cells(avatar.stype))
        && !analysis.encounters().iter().any(|encounter| {
            let of_avatar =
                analysis.avatars().iter().any(|avatar| analysis.applies(encounter.first, avatar.stype));
            encounter.does(|effect| matches!(effect, EffectSummary::Speed(_)))
                || (of_avatar && encounter.does(displaces))
        })
}

/// Returns `true` if the level contains an avatar that is missing from the game's analysis, because the game itself
/// does not use the character that places the avatar.
fn has_other_avatar(analysis: &Analysis, level: &Level) -> bool {
    let game = analysis.game();
    let is_other = |stype: &SpriteType| {
        let is_avatar = game.class(*stype).is_some_and(SpriteClass::is_avatar);
        is_avatar && !analysis.avatars().iter().any(|avatar| avatar.stype == *stype)
    };
    level.cells().iter().any(|&symbol| game.places(symbol).iter().any(is_other))
}

struct Board<'a> {
    analysis: &'a Analysis,
    level: &'a Level,
    reach: &'a Reach,
    /// The types that always stay where the level places them.
    still: Vec<SpriteType>,
    columns: usize,
    rows: usize,
}

impl Board<'_> {
    /// Returns the rules that involve a sprite of the type. Each rule comes with its index in the tick and the
    /// sprite's side in the rule.
    fn rules_of(&self, stype: SpriteType) -> impl Iterator<Item = (usize, Side, &Encounter)> {
        let analysis = self.analysis;
        analysis.encounters().iter().enumerate().flat_map(move |(at, encounter)| {
            let first = analysis.applies(encounter.first, stype).then_some((at, Side::First, encounter));
            let second = encounter.second.filter(|&second| analysis.applies(second, stype));
            first.into_iter().chain(second.map(|_| (at, Side::Second, encounter)))
        })
    }

    /// Returns the index, within the tick, of the first rule by which a fixed sprite in the cell undoes the
    /// movement of a sprite of the type. Returns `None` if there is no such rule, or if a later rule in the tick may
    /// push the sprite there again.
    fn thrown_back(&self, stype: SpriteType, cell: usize) -> Option<usize> {
        let here = self.analysis.game().places(self.level.cells()[cell]);
        let throws = |side: Side, rule: &Encounter| {
            let partner = match side {
                Side::First => rule.second,
                Side::Second => Some(rule.first),
            };
            let always = |&there: &SpriteType| {
                self.still.contains(&there)
                    && partner.is_some_and(|partner| self.analysis.applies(partner, there))
            };
            let back = |effect: &EffectSummary| effect.puts_back(side, stype);
            rule.precondition == Precondition::Always && rule.does(back) && here.iter().any(always)
        };
        let last_push = self
            .rules_of(stype)
            .filter(|(_, side, rule)| {
                *side == Side::First && rule.does(|effect| *effect == EffectSummary::Push)
            })
            .map(|(at, ..)| at)
            .max();
        let back = self.rules_of(stype).find(|(_, side, rule)| throws(*side, rule)).map(|(at, ..)| at);
        back.filter(|&back| last_push.is_none_or(|push| push < back))
    }

    /// Returns `true` if only pushes move sprites of the type.
    fn only_pushed(&self, stype: SpriteType) -> bool {
        self.analysis.facts(stype).motion == Motion::Still
            && self.analysis.facts(stype).makes.is_empty()
            && !self.analysis.facts(stype).fleeting
            && !self.rules_of(stype).any(|(_, side, rule)| side == Side::First && rule.does(moves))
    }

    /// Returns `true` if anything other than an avatar may push the type. Such a pusher could be in any cell.
    fn is_pushed_by_others(&self, stype: SpriteType) -> bool {
        let avatars = self.analysis.avatars();
        self.rules_of(stype).any(|(_, side, rule)| {
            side == Side::First
                && rule.does(|effect| matches!(effect, EffectSummary::Push))
                && !rule.second.is_some_and(|second| {
                    let tree = self.analysis.game().sprite_types();
                    let mut tree = tree.filter(|&other| self.analysis.applies(second, other));
                    tree.all(|other| {
                        avatars.iter().any(|avatar| avatar.stype == other)
                            || !self.analysis.facts(other).possible
                    })
                })
        })
    }

    /// Returns `true` if a sprite in the cell may meet a partner of the rule on the given side, or the edge.
    fn may_be_met(&self, rule: &Encounter, side: Side, cell: usize) -> bool {
        let partner = match side {
            Side::First => rule.first,
            Side::Second => match rule.second {
                Some(second) => second,
                None => return true,
            },
        };
        let types = self.analysis.game().sprite_types();
        types
            .filter(|&other| self.analysis.applies(partner, other))
            .any(|other| self.reach.can_touch(other, cell))
    }

    /// Returns the possible fates of a sprite of the type in a cell: removal (`None`) or a different type. If a rule
    /// undoes the sprite's movement into the cell, only the rules before that rule apply.
    fn fates(&self, stype: SpriteType, cell: usize) -> Vec<Option<SpriteType>> {
        let mut fates = Vec::new();
        let before = self.thrown_back(stype, cell).unwrap_or(usize::MAX);
        for (_, side, rule) in self.rules_of(stype).filter(|(at, ..)| *at < before) {
            let other = match side {
                Side::First => Side::Second,
                Side::Second => Side::First,
            };
            if !self.may_be_met(rule, other, cell) {
                continue;
            }
            for effect in &rule.effects {
                match effect {
                    EffectSummary::Kill(who) if *who == side => fates.push(None),
                    EffectSummary::Health { of: None, .. } if side == Side::First => fates.push(None),
                    EffectSummary::Become(to) if side == Side::First => fates.push(Some(*to)),
                    EffectSummary::BecomeAny(options) if side == Side::First => {
                        fates.extend(options.iter().map(|to| Some(*to)));
                    }
                    _ => {}
                }
            }
        }
        for rule in self.analysis.encounters() {
            for effect in &rule.effects {
                match effect {
                    EffectSummary::KillAll(of) | EffectSummary::Health { of: Some(of), .. }
                        if self.analysis.applies(*of, stype) =>
                    {
                        fates.push(None);
                    }
                    EffectSummary::BecomeAll(of, to) if self.analysis.applies(*of, stype) => {
                        fates.push(Some(*to))
                    }
                    _ => {}
                }
            }
        }
        fates
    }

    fn neighbour(&self, cell: usize, (dx, dy): (i32, i32)) -> Option<usize> {
        let (column, row) = ((cell % self.columns) as i32 + dx, (cell / self.columns) as i32 + dy);
        let inside = (0..self.columns as i32).contains(&column) && (0..self.rows as i32).contains(&row);
        inside.then(|| row as usize * self.columns + column as usize)
    }

    /// Returns, for each cell, the minimum number of pushes after which a sprite of type `stype` may be gone or
    /// have a type outside `counted`. The result is a fixed point. It is computed backwards from the cells in which
    /// the sprite can be removed, leave the board, or become a type outside `counted`. Types that are not
    /// `tame` are not followed.
    fn pushes(&self, stype: SpriteType, counted: &[SpriteType], tame: &[bool]) -> Vec<u16> {
        let cells = self.columns * self.rows;
        // The types that the sprite may have while it is still counted. Indices below refer to this list.
        let mut kinds = vec![stype];
        // The possible fates by kind, then by cell.
        let mut fates: Vec<Vec<Vec<Option<SpriteType>>>> = Vec::new();
        while let Some(&kind) = kinds.get(fates.len()) {
            let of_kind: Vec<_> = (0..cells).map(|cell| self.fates(kind, cell)).collect();
            for &fate in of_kind.iter().flatten().flatten() {
                if counted.contains(&fate) && tame[fate.index()] && !kinds.contains(&fate) {
                    kinds.push(fate);
                }
            }
            fates.push(of_kind);
        }
        let by_others: Vec<bool> = kinds.iter().map(|&kind| self.is_pushed_by_others(kind)).collect();
        let mut pushes: Vec<Vec<u16>> = vec![vec![NEVER; cells]; kinds.len()];
        loop {
            let mut changed = false;
            for (at, &kind) in kinds.iter().enumerate() {
                for cell in (0..cells).filter(|&cell| self.reach.can_touch(kind, cell)) {
                    let ends = fates[at][cell].iter().map(|fate| match *fate {
                        None => 0,
                        Some(to) => kinds.iter().position(|&k| k == to).map_or(0, |to| pushes[to][cell]),
                    });
                    // A sprite cannot be pushed any further from a cell in which its movement is always undone.
                    let rests = self.reach.can_be(kind, cell) && self.thrown_back(kind, cell).is_none();
                    let pushed = |(dx, dy): (i32, i32)| {
                        // Anything may happen beyond the edge.
                        let Some(there) = self.neighbour(cell, (dx, dy)) else { return 0 };
                        let behind = self.neighbour(cell, (-dx, -dy));
                        if by_others[at] {
                            // Several sprites may be pushed in one tick.
                            pushes[at][there]
                        } else if behind.is_none_or(|cell| self.reach.avatar_reaches(cell)) {
                            pushes[at][there].saturating_add(1)
                        } else {
                            NEVER
                        }
                    };
                    let ways = [(0, -1), (-1, 0), (0, 1), (1, 0)].into_iter().filter(|_| rests);
                    let least = ends.chain(ways.map(pushed)).min().unwrap_or(NEVER);
                    changed |= least < pushes[at][cell];
                    pushes[at][cell] = least.min(pushes[at][cell]);
                }
            }
            if !changed {
                return pushes.swap_remove(0);
            }
        }
    }
}
