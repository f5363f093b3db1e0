//! The pushing tasks of a level: the pushes, the path that they open, and the sprites to visit afterwards.

use super::plan::{furnishable, round};
use crate::levels::palette::{Palette, Walk};
use base::Sampler;
use engine::analysis::{Fate, Key, Lock, Pushable, Role, Sink, Steering};
use engine::{Analysis, SpriteType};
use itertools::Itertools;

/// The task of pushing a sprite onto a partner.
#[derive(Clone, Debug)]
pub(crate) struct Job {
    pub(crate) pushed: SpriteType,
    pub(crate) partner: SpriteType,
    /// `true` if the partner can also be pushed, and both sprites are removed.
    pub(crate) merges: bool,
    /// `true` if the pushed sprite, or the sprite that it turns into, remains in the cell.
    pub(crate) stays: bool,
    /// `true` if the push removes the partner.
    pub(crate) fills: bool,
    /// `true` if the avatar can walk over the partner.
    pub(crate) walkable: bool,
}

/// The plan for a level with pushable objects.
#[derive(Clone, Debug, Default)]
pub(crate) struct Jobs {
    /// The pushes, in the order in which the avatar makes them.
    pub(crate) jobs: Vec<Job>,
    /// `true` if the last job bridges the gap in front of the sprites to visit.
    pub(crate) bridge: bool,
    /// The door that the last job opens; `None` if the last job does not open a door.
    pub(crate) door: Option<SpriteType>,
    /// The gate in front of the sprites to visit; `None` if a bridge, a door or nothing is in front of them.
    pub(crate) gate: Option<SpriteType>,
    /// The number of visits to the gate's keys. These visits come first.
    pub(crate) keys: usize,
    /// The types of pushable objects that are merely obstacles.
    pub(crate) loose: Vec<SpriteType>,
    /// The sprites that the avatar must touch at the end, in order: keys, then exits and collectables.
    pub(crate) visits: Vec<SpriteType>,
    /// `true` if the plan is sufficient for a win.
    pub(crate) is_all: bool,
}

impl Jobs {
    /// Draws a plan; `None` if no sprite in the game can be pushed onto another one. `asked` contains the exact numbers
    /// that are requested for some types.
    pub(crate) fn draw(
        analysis: &Analysis,
        palette: &Palette,
        area: usize,
        difficulty: f64,
        asked: &[(SpriteType, usize)],
        sampler: &mut Sampler,
    ) -> Option<Jobs> {
        let start = analysis.start_avatar()?;
        palette.wall?;
        let pushed = |pushable: &&Pushable| {
            palette.symbol(pushable.stype).is_some() && analysis.touch(start.stype, pushable.stype).pushes
        };
        let placed: Vec<&Pushable> = analysis.pushables().iter().filter(pushed).collect();
        if start.steering != Steering::FourWay || placed.is_empty() {
            return None;
        }
        let mut options: Vec<Job> = Vec::new();
        for pushable in &placed {
            let sinks = pushable.sinks.iter().filter(|sink| is_fair(analysis, palette, sink));
            options.extend(sinks.map(|sink| job(analysis, palette, pushable.stype, sink)));
        }
        let remove = &analysis.aims().remove;
        let counts = |job: &&Job| remove.contains(&job.pushed) || remove.contains(&job.partner);
        let pushables =
            asked.iter().filter(|(stype, _)| placed.iter().any(|pushable| pushable.stype == *stype));
        let asked = pushables.map(|(_, count)| *count).reduce(|sum, count| sum.saturating_add(count));
        let asked = asked.map(|count| count.min(area));
        let mut plan = Jobs::default();
        let wanted: Vec<Job> = options.iter().filter(counts).cloned().collect();
        let most = (area / 14).clamp(1, 6);
        if wanted.is_empty() {
            plan.visits = visits(analysis, palette);
            if plan.visits.is_empty() || !analysis.is_turn_based() && options.iter().all(|job| !bridges(job))
            {
                return None;
            }
            let pushed: Vec<SpriteType> = placed.iter().map(|pushable| pushable.stype).collect();
            plan.bar(analysis, palette, &options, sampler, difficulty);
            let crowd = if plan.jobs.is_empty() { 0.1 + 0.08 * difficulty } else { 0.03 * difficulty };
            let crowd = round(area as f64 * crowd, sampler);
            let crowd = asked.map_or(crowd, |count| count.saturating_sub(plan.jobs.len()));
            for _ in 0..crowd {
                plan.loose.push(*sampler.choose(&pushed));
            }
        } else {
            let count = (2 + round(0.3 + 2.4 * difficulty, sampler)).min(most.max(2));
            let count = asked.unwrap_or(count);
            plan.removals(&wanted, remove, count, sampler);
            plan.visits = visits(analysis, palette);
        }
        plan.guard(analysis, palette, sampler);
        let placed = |stype: &&SpriteType| palette.symbol(**stype).is_some();
        let done = |stype: &SpriteType| {
            plan.visits.contains(stype)
                || plan.jobs.iter().any(|job| job.pushed == *stype || job.partner == *stype)
        };
        plan.is_all = remove.iter().filter(placed).all(done);
        Some(plan)
    }

    /// Adds jobs for every type that must be removed.
    fn removals(&mut self, wanted: &[Job], remove: &[SpriteType], count: usize, sampler: &mut Sampler) {
        let mut types = wanted.iter().map(|job| job.pushed).sorted_unstable().dedup().collect_vec();
        sampler.shuffle(&mut types);
        for at in 0..count.max(types.len().min(3)) {
            let stype = types[at % types.len()];
            let own: Vec<&Job> = wanted.iter().filter(|job| job.pushed == stype).collect();
            if let Some(job) = own.get(sampler.below(own.len().max(1))) {
                self.jobs.push((*job).clone());
            }
        }
        // Two things that merge are both removed, so fewer jobs suffice.
        let pairs = self.jobs.iter().filter(|job| job.merges && remove.contains(&job.partner)).count();
        self.jobs.truncate(self.jobs.len() - pairs / 2);
        sampler.shuffle(&mut self.jobs);
    }

    /// Blocks the path with a door that a push opens, or with a ditch that a pushed object fills.
    fn bar(
        &mut self,
        analysis: &Analysis,
        palette: &Palette,
        options: &[Job],
        sampler: &mut Sampler,
        difficulty: f64,
    ) {
        let switches: Vec<(SpriteType, &Job)> = analysis
            .locks()
            .iter()
            .filter_map(|lock| {
                let Key::Switch(partner, Some(pushed)) = lock.key else { return None };
                palette.symbol(lock.stype)?;
                let fits = |job: &&Job| job.partner == partner && job.pushed == pushed;
                options.iter().find(fits).map(|job| (lock.stype, job))
            })
            .collect();
        if !switches.is_empty() {
            let (door, job) = sampler.choose(&switches);
            // The thing that the push opens may be the exit itself.
            self.door = Some(*door).filter(|door| !self.visits.contains(door));
            self.jobs.push((*job).clone());
        } else {
            let bridging: Vec<&Job> = options.iter().filter(|job| bridges(job)).collect();
            if !bridging.is_empty() {
                let extra = round(1.6 * difficulty, sampler);
                for _ in 0..=extra {
                    self.jobs.push((*sampler.choose(&bridging)).clone());
                }
                self.bridge = true;
            }
        }
    }
}

impl Jobs {
    /// Returns `true` if the path to the sprites to visit is blocked.
    pub(crate) fn is_barred(&self) -> bool {
        self.bridge || self.door.is_some() || self.gate.is_some()
    }

    /// Blocks the path with a gate, if a suitable gate exists and the path is not blocked yet.
    fn guard(&mut self, analysis: &Analysis, palette: &Palette, sampler: &mut Sampler) {
        if self.is_barred() || self.visits.is_empty() {
            return;
        }
        let mut options: Vec<(SpriteType, SpriteType, usize)> = Vec::new();
        for stype in furnishable(analysis, palette, Role::Gate) {
            let Some(lock) =
                analysis.locks().iter().find(|lock| lock.stype == stype && !is_pushed_open(lock))
            else {
                continue;
            };
            let amount = if let Key::Resource { amount, .. } = lock.key { amount.max(1) } else { 1 };
            for &(giver, each) in &lock.givers {
                let count = amount.saturating_add(each - 1) / each.max(1);
                let lies = palette.symbol(giver).is_some() && !palette.ground.contains(&giver);
                if lies && count <= 3 && !self.visits.contains(&giver) {
                    options.push((stype, giver, count as usize));
                }
            }
        }
        if options.is_empty() {
            return;
        }
        let (gate, giver, count) = *sampler.choose(&options);
        self.gate = Some(gate);
        self.keys = count;
        self.visits.splice(0..0, std::iter::repeat_n(giver, count));
    }
}

/// Returns `true` if pushing one object onto another opens the lock.
fn is_pushed_open(lock: &Lock) -> bool {
    matches!(lock.key, Key::Switch(_, Some(_)))
}

/// Returns `true` if the partner can be placed, and pushing an object onto it does no damage.
fn is_fair(analysis: &Analysis, palette: &Palette, sink: &Sink) -> bool {
    let aims = analysis.aims();
    let spoils =
        matches!(sink.fate, Fate::Becomes(to) if aims.prevent.contains(&to) || aims.remove.contains(&to));
    let placed = palette.symbol(sink.partner).is_some() && !palette.ground.contains(&sink.partner);
    let still =
        matches!(analysis.role(sink.partner), Role::Socket | Role::Pushable | Role::Hazard | Role::Prey);
    placed && still && !spoils && !aims.protect.contains(&sink.partner)
}

fn job(analysis: &Analysis, palette: &Palette, pushed: SpriteType, sink: &Sink) -> Job {
    let walk = palette.symbol(sink.partner).map_or(Walk::Open, |symbol| palette.walk(symbol));
    Job {
        pushed,
        partner: sink.partner,
        merges: analysis.role(sink.partner) == Role::Pushable,
        stays: sink.fate != Fate::Goes,
        fills: sink.fills,
        walkable: walk == Walk::Open,
    }
}

/// Returns `true` if filling the partner clears a path.
fn bridges(job: &Job) -> bool {
    job.fills && !job.stays && !job.merges && !job.walkable
}

/// Returns the sprites to visit: the keys of locked exits, followed by the exits. In a game without exits, returns
/// the goods that count for a win.
fn visits(analysis: &Analysis, palette: &Palette) -> Vec<SpriteType> {
    let exits = furnishable(analysis, palette, Role::Exit);
    let mut visits: Vec<SpriteType> = Vec::new();
    for &exit in exits.iter().take(1) {
        let own = |lock: &&Lock| lock.stype == exit && !is_pushed_open(lock);
        if let Some(lock) = analysis.locks().iter().find(own) {
            let keys =
                lock.givers.iter().map(|(giver, _)| *giver).filter(|&giver| palette.symbol(giver).is_some());
            visits.extend(keys.take(1));
        }
        visits.push(exit);
    }
    if exits.is_empty() {
        let goods = furnishable(analysis, palette, Role::Collectable).into_iter();
        visits.extend(goods.filter(|stype| analysis.aims().remove.contains(stype)).take(1));
    }
    visits
}
