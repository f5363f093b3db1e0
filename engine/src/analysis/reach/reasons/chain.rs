//! The reasons why a termination can never hold in a level, as a chain of requirements that ends with the
//! first impossible one.
//!
//! Every requirement in the chain is proven impossible by the over-approximation of
//! [`Reach`](crate::analysis::reach::Reach): a requirement counts as missing only if it is missing in every cell that
//! sprites can reach. The chain is not necessarily complete, because further requirements may be missing as well.

use super::cause::Cause;
use crate::analysis::Analysis;
use crate::analysis::interactions::encounter::{EffectSummary, Encounter, Precondition, Side};
use crate::analysis::reach::cells::Cells;
use crate::analysis::reach::events::{Events, Gift};
use crate::rules::SpriteType;
use crate::rules::effects::{Ending, Target};
use std::collections::{BTreeMap, BTreeSet};

/// The reason why a termination can never hold in a level, with the missing requirement of each rule that
/// could help.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chain {
    /// The index into [`Analysis::goals`].
    pub goal: usize,
    /// The reason why the termination can never hold.
    pub cause: Cause,
    /// The rules that could help, each with its missing requirement. Empty if no rule could help.
    pub obstacles: Vec<Obstacle>,
}

/// A rule that would remove or create the required sprite, but can never do so in this level.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Obstacle {
    /// The sprite that the rule would remove, or the type that the rule would create.
    pub target: SpriteType,
    /// The index of the rule in [`Description::interactions`](crate::Description), or `None` if sprites
    /// create the type on their own.
    pub line: Option<usize>,
    /// The missing requirement.
    pub missing: Missing,
}

/// The first requirement of a rule that can never be met.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Missing {
    /// The level does not place a sprite of the type, and no rule or existing sprite creates one.
    Absent(SpriteType),
    /// The level does not place a sprite of the type, and no sprite of the type is ever created, because each
    /// rule that could create one has a missing requirement. The list of these rules is empty if the same
    /// chain already contains them.
    Unmade(SpriteType, Vec<Obstacle>),
    /// The rule requires more of a resource than any sprite can get.
    Resource(Shortage),
    /// Sprites of one of the types can never reach a required cell.
    Unreachable(Unreachable),
    /// Sprites of the type can enter the cell, but the rule at the given index moves them back before the
    /// required rule applies.
    Blocked(SpriteType, usize),
    /// Sprites of the two types never collide. `None` stands for the edge of the screen.
    Nowhere(SpriteType, Option<SpriteType>),
    /// The sprite never moves, and so never reaches the edge of the screen.
    Inside,
}

/// A resource that cannot be obtained in the required amount.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shortage {
    /// The resource.
    pub resource: SpriteType,
    /// The amount that must be held at once.
    pub needed: i32,
    /// The maximum amount that one sprite can hold, if it is less than the required amount.
    pub capacity: Option<i32>,
    /// The total obtainable amount. The value is meaningless if `capacity` is set.
    pub most: i64,
    /// The indices of the rules that give the resource.
    pub rules: Vec<usize>,
    /// The level's sprites that give the resource.
    pub sources: Vec<Source>,
}

/// A sprite that gives a resource.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    /// The sprite's type.
    pub stype: SpriteType,
    /// The cell in which the level places the sprite.
    pub cell: usize,
    /// The number of sprites of this type in the cell.
    pub count: u32,
    /// The amount that each sprite gives.
    pub each: i64,
    /// The obstacle between a collecting sprite and this source, or `None` if the resource can be obtained.
    pub unreachable: Option<Unreachable>,
}

/// A cell that sprites of a type can never reach.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unreachable {
    /// The type of the sprites.
    pub stype: SpriteType,
    /// The cell that the sprites can never reach.
    pub cell: usize,
    /// Removable sprites on the paths to the cell, adjacent to cells that the type can reach.
    pub blockers: Vec<Blocker>,
}

/// A sprite that blocks a path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Blocker {
    /// The sprite's type.
    pub stype: SpriteType,
    /// The sprite's cell.
    pub cell: usize,
    /// The rules that could remove the sprite, with their missing requirements. Empty if the same chain
    /// already contains these rules.
    pub obstacles: Vec<Obstacle>,
}

/// The maximum number of rules to report for one sprite.
const MAX_RULES: usize = 3;
/// The maximum number of blocking sprites to report.
const MAX_BLOCKERS: usize = 2;
/// The maximum number of sources to report.
const MAX_SOURCES: usize = 16;
/// The maximum number of consecutive blocking sprites to follow.
const MAX_DEPTH: usize = 4;

/// The value used instead of a cell in [`Reported`] entries about creating sprites.
const UNMADE: usize = usize::MAX;

/// The sprites whose obstacles have already been reported, each with its cell or [`UNMADE`].
type Reported = Vec<(SpriteType, usize)>;

/// The sprites that an interaction would remove.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Ended {
    Side(Side),
    Anywhere,
}

/// The data for deriving chains: the completed fixed point, and the analysis.
pub(crate) struct Chains<'a, 'e> {
    analysis: &'a Analysis,
    events: Events<'e>,
    gifts: BTreeMap<(SpriteType, SpriteType), Gift>,
}

impl<'a, 'e> Chains<'a, 'e> {
    pub(crate) fn of(analysis: &'a Analysis, mut events: Events<'e>) -> Chains<'a, 'e> {
        let gifts = events.gifts();
        Chains { analysis, events, gifts }
    }

    /// Returns the chain of causes for a termination that can never hold for the given reason.
    pub(crate) fn chain(&mut self, goal: usize, cause: Cause) -> Chain {
        let mut reported = Vec::new();
        let obstacles = match &cause {
            Cause::Permanent(sprites) => {
                sprites.first().map_or(Vec::new(), |&(stype, cell)| self.keeping(stype, cell, &mut reported))
            }
            Cause::AtMost(_) => {
                let mut types = self.analysis.goals()[goal].condition.types().to_vec();
                types.dedup();
                let lacking = types.iter().flat_map(|&stype| self.unmade(stype, &mut reported));
                lacking.take(MAX_RULES).collect()
            }
            Cause::Unpaid(_) => Vec::new(),
        };
        Chain { goal, cause, obstacles }
    }

    /// Returns the rules that could remove a sprite in its cell, with their missing requirements.
    fn keeping(&self, stype: SpriteType, cell: usize, reported: &mut Reported) -> Vec<Obstacle> {
        if reported.contains(&(stype, cell)) || reported.len() >= MAX_DEPTH {
            return Vec::new();
        }
        reported.push((stype, cell));
        let mut obstacles: Vec<Obstacle> = Vec::new();
        for encounter in &self.analysis.encounters {
            let Some(ended) = self.ended(encounter, stype) else { continue };
            if obstacles.iter().any(|known| known.line == Some(encounter.line)) {
                continue;
            }
            if let Some(missing) = self.missing(encounter, Some((stype, cell, ended)), reported) {
                obstacles.push(Obstacle { target: stype, line: Some(encounter.line), missing });
            }
        }
        // The obstacles that are closest to being overcome come first.
        obstacles.sort_by_key(|obstacle| obstacle.missing.rank());
        obstacles.truncate(MAX_RULES);
        obstacles
    }

    /// Returns the rules and sprites that could create sprites of a type, with their missing requirements.
    fn unmade(&self, stype: SpriteType, reported: &mut Reported) -> Vec<Obstacle> {
        let makes = |encounter: &Encounter| {
            encounter.does(|effect| {
                let clones = *effect == EffectSummary::Clone;
                effect.makes().contains(&stype) || clones && self.analysis.applies(encounter.first, stype)
            })
        };
        let mut obstacles: Vec<Obstacle> = Vec::new();
        for encounter in self.analysis.encounters.iter().filter(|encounter| makes(encounter)) {
            let known = obstacles.iter().any(|known| known.line == Some(encounter.line));
            if !known && let Some(missing) = self.missing(encounter, None, reported) {
                obstacles.push(Obstacle { target: stype, line: Some(encounter.line), missing });
            }
        }
        for maker in self.analysis.game().sprite_types() {
            if self.analysis.facts(maker).makes.contains(&stype) && !self.events.can_occur(maker) {
                obstacles.push(Obstacle { target: stype, line: None, missing: Missing::Absent(maker) });
            }
        }
        obstacles.sort_by_key(|obstacle| obstacle.missing.rank());
        obstacles
    }

    /// Returns which sprites of the type an interaction would remove, if any.
    fn ended(&self, encounter: &Encounter, stype: SpriteType) -> Option<Ended> {
        let rules = &*self.analysis.game().0;
        let first = self.analysis.applies(encounter.first, stype);
        let second = encounter.second.is_some_and(|second| self.analysis.applies(second, stype));
        // Only resources are collected.
        let collects = encounter.effects.contains(&EffectSummary::Collect);
        let first = first && (!collects || rules.types[stype.index()].traits.is_resource);
        encounter.effects.iter().find_map(|effect| match effect.ending()? {
            (_, Ending::Health { dies_at: i32::MIN, .. }) => None,
            (Target::Side(_), Ending::Health { by: 0.., .. }) => None,
            (Target::Side(side), _) => {
                let is_there = if side == Side::First { first } else { second };
                is_there.then_some(Ended::Side(side))
            }
            (Target::All(all), _) => (all == stype).then_some(Ended::Anywhere),
            (Target::Tree(of), _) => self.analysis.applies(of, stype).then_some(Ended::Anywhere),
        })
    }

    /// Returns the first requirement of an interaction that can never be met. If `target` is given, the
    /// interaction must remove the target sprite in its cell. Returns `None` if nothing is proven.
    fn missing(
        &self,
        encounter: &Encounter,
        target: Option<(SpriteType, usize, Ended)>,
        reported: &mut Reported,
    ) -> Option<Missing> {
        let Encounter { first, second, precondition, .. } = *encounter;
        if let Some(absent) = [Some(first), second].into_iter().flatten().find(|&side| !self.is_alive(side)) {
            let exists = &self.events.flood.model.exists;
            let mut family = self.analysis.game().0.types[absent.index()].tree.iter();
            return Some(match family.find(|stype| exists[stype.index()]) {
                None => Missing::Absent(absent),
                Some(&stype) if reported.contains(&(stype, UNMADE)) || reported.len() >= MAX_DEPTH => {
                    Missing::Unmade(stype, Vec::new())
                }
                Some(&stype) => {
                    reported.push((stype, UNMADE));
                    let mut obstacles = self.unmade(stype, reported);
                    obstacles.truncate(1);
                    Missing::Unmade(stype, obstacles)
                }
            });
        }
        if let Precondition::Holds(_, resource, needed) = precondition
            && !self.events.can_be(precondition)
        {
            return Some(Missing::Resource(self.shortage(resource, needed, reported)));
        }
        let Some((stype, cell, Ended::Side(side))) = target else {
            let met = match second {
                Some(second) => self.all(first).shared(&self.all(second)),
                None => self.all(first).shared(&self.events.board().ring()),
            };
            // A motionless sprite's position is known.
            let apart = |stands: SpriteType, comes: SpriteType| {
                let fixed = self.events.flood.model.of_type(stands).fixed;
                let (cell, _) = self.events.placed()[stands.index()].first().filter(|_| fixed)?;
                (!self.all(comes).contains(*cell)).then_some((comes, self.events.board().on_level(*cell)))
            };
            let apart = second.and_then(|second| apart(second, first).or_else(|| apart(first, second)));
            return met.is_empty().then(|| match apart {
                Some((comes, cell)) => Missing::Unreachable(self.unreachable(comes, cell, reported)),
                None => Missing::Nowhere(first, second),
            });
        };
        let Some(other) = (if side == Side::First { second } else { Some(first) }) else {
            return Some(Missing::Inside);
        };
        // If both sprites have the same type, it is unclear which sprite is meant.
        if self.analysis.applies(other, stype) {
            return None;
        }
        if !self.all(other).contains(self.events.board().of_level(cell)) {
            return Some(Missing::Unreachable(self.unreachable(other, cell, reported)));
        }
        let blocks = |earlier: &&Encounter| {
            earlier.blocks()
                && self.analysis.applies(earlier.first, other)
                && earlier.second.is_some_and(|second| self.analysis.applies(second, stype))
        };
        let before = self.analysis.encounters.iter().take_while(|known| !std::ptr::eq(*known, encounter));
        let lines: BTreeSet<usize> = before.filter(blocks).map(|earlier| earlier.line).collect();
        Some(Missing::Blocked(other, lines.first().copied()?))
    }

    /// Returns the reason why the needed amount of a resource cannot be obtained.
    fn shortage(&self, resource: SpriteType, needed: i32, reported: &mut Reported) -> Shortage {
        let model = self.events.flood.model;
        let rules = &*self.analysis.game().0;
        let limit = rules.types[resource.index()].resource_limit;
        let capacity = (needed > limit && !model.unlimited[resource.index()]).then_some(limit);
        let mut lines = Vec::new();
        let mut sources: Vec<Source> = Vec::new();
        for encounter in &self.analysis.encounters {
            let Some((giver, taker, each)) = self.giver(encounter, resource) else { continue };
            if lines.last() != Some(&encounter.line) {
                lines.push(encounter.line);
            }
            let family = rules.types[giver.index()].tree.iter().copied();
            for stype in family.filter(|stype| model.exists[stype.index()]) {
                let traits = &rules.types[stype.index()].traits;
                let own = each.unwrap_or(i64::from(traits.value));
                let gives = each.is_some() || traits.is_resource && traits.resource == resource;
                for &(cell, count) in &self.events.placed()[stype.index()] {
                    let at = self.events.board().on_level(cell);
                    let known = sources.iter().any(|source| (source.stype, source.cell) == (stype, at));
                    if !gives || own <= 0 || known || sources.len() >= MAX_SOURCES {
                        continue;
                    }
                    let got = self
                        .gifts
                        .get(&(resource, stype))
                        .is_some_and(|gift| !model.of_type(stype).fixed || gift.cells.contains(cell));
                    // If both sprites have the same type, it is unclear which sprite has to move. If the taker reaches
                    // the source, a different requirement of the rule is missing.
                    let is_reached = || self.all(taker).contains(cell);
                    if !got && (self.analysis.applies(taker, stype) || is_reached()) {
                        continue;
                    }
                    let unreachable = (!got).then(|| self.unreachable(taker, at, reported));
                    sources.push(Source { stype, cell: at, count, each: own, unreachable });
                }
            }
        }
        let most = self.events.have[resource.index()];
        Shortage { resource, needed, capacity, most, rules: lines, sources }
    }

    /// Returns the type whose sprites give a resource in an interaction, the type that receives it, and the
    /// amount, which is `None` if it is the resource's value.
    fn giver(
        &self,
        encounter: &Encounter,
        resource: SpriteType,
    ) -> Option<(SpriteType, SpriteType, Option<i64>)> {
        let second = encounter.second?;
        let rules = &*self.analysis.game().0;
        encounter.effects.iter().find_map(|effect| {
            if *effect == EffectSummary::Collect {
                let mut family = rules.types[encounter.first.index()].tree.iter();
                let gives = family.any(|stype| rules.types[stype.index()].traits.resource == resource);
                return gives.then_some((encounter.first, second, None));
            }
            let EffectSummary::Change { side: Side::First, resource: changed, by } = *effect else {
                return None;
            };
            (changed == resource && by > 0).then(|| (second, encounter.first, Some(i64::from(by))))
        })
    }

    /// Returns the obstacle that keeps sprites of a type out of a cell.
    fn unreachable(&self, stype: SpriteType, cell: usize, reported: &mut Reported) -> Unreachable {
        let blockers = self.in_the_way(stype, cell);
        let blockers = blockers.into_iter().take(MAX_BLOCKERS).map(|(stype, cell)| {
            let obstacles = self.keeping(stype, cell, reported);
            Blocker { stype, cell, obstacles }
        });
        Unreachable { stype, cell, blockers: blockers.collect() }
    }

    /// Returns the removable sprites that lie on a path to a cell and next to a cell that sprites of a type
    /// can reach. Each sprite is paired with its cell. Paths go from a cell to its four neighbours.
    fn in_the_way(&self, stype: SpriteType, target: usize) -> Vec<(SpriteType, usize)> {
        let (board, rules) = (self.events.board(), &*self.analysis.game().0);
        let family: Vec<SpriteType> = rules.types[stype.index()].tree.to_vec();
        let rest = self.cells_of(stype, |stype| self.events.rest(stype));
        let barring = |cell: usize| -> Vec<SpriteType> {
            let barring = family.iter().flat_map(|&stype| self.events.flood.barring(stype, cell));
            barring.collect::<BTreeSet<_>>().into_iter().collect()
        };
        let opens = |stype: SpriteType| {
            self.analysis.encounters.iter().any(|encounter| self.ended(encounter, stype).is_some())
        };
        let mut seen = Cells::none(board);
        let start = self.events.board().of_level(target);
        seen.insert(start);
        let (mut queue, mut found) = (vec![start], BTreeSet::new());
        while let Some(cell) = queue.pop() {
            let bars = barring(cell);
            if bars.iter().any(|&stype| !opens(stype)) {
                continue;
            }
            let neighbours = [(0, -1), (-1, 0), (0, 1), (1, 0)].map(|step| board.shifted(cell, step, 1));
            let beside = neighbours.iter().any(|&next| rest.contains(next));
            if beside {
                found.extend(bars.iter().map(|&stype| (board.on_level(cell), stype)));
            }
            for next in neighbours {
                if !board.is_ring(next) && !rest.contains(next) && seen.insert(next) {
                    queue.push(next);
                }
            }
        }
        found.into_iter().map(|(cell, stype)| (stype, cell)).collect()
    }

    /// Returns `true` if a rule on `written` can apply to some sprite.
    fn is_alive(&self, written: SpriteType) -> bool {
        let tree = &self.analysis.game().0.types[written.index()].tree;
        tree.iter().any(|&stype| self.events.can_occur(stype))
    }

    /// Returns the cells that sprites to which a rule on `written` applies can reach at some point.
    fn all(&self, written: SpriteType) -> Cells {
        self.cells_of(written, |stype| self.events.touch(stype))
    }

    /// Returns the cells of all possible sprites to which a rule on `written` applies.
    fn cells_of<'c>(&self, written: SpriteType, cells: impl Fn(SpriteType) -> &'c Cells) -> Cells {
        let mut all = Cells::none(self.events.board());
        let family = self.analysis.game().0.types[written.index()].tree.iter().copied();
        for stype in family.filter(|&stype| self.events.can_occur(stype)) {
            all.add(cells(stype));
        }
        all
    }
}

impl Missing {
    /// Returns the requirement's rank. The lower the rank, the closer the requirement is to being met.
    fn rank(&self) -> u8 {
        match self {
            Missing::Resource(_) => 0,
            Missing::Blocked(..) => 1,
            Missing::Unreachable(_) => 2,
            Missing::Nowhere(..) | Missing::Inside => 3,
            Missing::Unmade(..) => 2,
            Missing::Absent(_) => 4,
        }
    }
}
