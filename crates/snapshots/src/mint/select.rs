//! The selection of candidates for a release that is comparable with other months.
//!
//! Every candidate has passed its judges, so any selection is sound. The selection meets the recipe's quotas
//! and matches its difficulty histogram as closely as possible, by swapping games in and out from several
//! random starts. It uses only integers and seeded draws, so the same candidates give the same selection on
//! any machine.

use super::plan::{Job, Plan};
use crate::Digest;
use crate::card::{Bin, is_new, outside};
use crate::mint::error::MintError;
use crate::recipe::Recipe;
use crate::recipe::apportion::apportion;
use crate::recipe::known::item;
use crate::sections::frozen::FrozenGame;
use crate::sections::puzzles::PuzzleKind;
use engine::{Analysis, Game};
use forge::games::{Cast, NO_RULES};
use forge::{Tally, reasons};
use generators::invention::{is_part, share_idea};
use generators::levels::LevelSimilarity;
use itertools::Itertools;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use validators::measures::{AvatarKind, GameKind, GoalKind};
use validators::{Difficulty, GameForm, Tier};

/// The part of the recipe to which a game belongs. Each part has its own number of games.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Part {
    /// New levels for corpus games.
    Corpus,
    /// New games from kernels (hand-written designs).
    Generated,
    /// Invented games.
    Invented,
    /// Designs.
    Designs,
    /// Puzzles of one kind.
    Puzzles(PuzzleKind),
}

impl Part {
    /// Returns all parts of a recipe.
    fn all() -> impl Iterator<Item = Part> {
        let plain = [Part::Corpus, Part::Generated, Part::Invented, Part::Designs];
        plain.into_iter().chain(PuzzleKind::ALL.map(Part::Puzzles))
    }

    /// Returns the name of the part's section in a recipe.
    fn name(self) -> &'static str {
        match self {
            Part::Corpus => "corpus",
            Part::Generated => "generated",
            Part::Invented => "invented",
            Part::Designs => "designs",
            Part::Puzzles(kind) => kind.section(),
        }
    }

    /// Returns the part to which a job belongs.
    pub(super) fn of(job: Job) -> Part {
        match job {
            Job::Corpus(_) => Part::Corpus,
            Job::Puzzle(kind, _) => Part::Puzzles(kind),
            Job::Constructive(_) => Part::Generated,
            Job::Invented(..) => Part::Invented,
            Job::Design(_) => Part::Designs,
        }
    }

    /// Returns the requested number of games.
    fn asked(self, recipe: &Recipe) -> usize {
        let games = match self {
            Part::Corpus => recipe.corpus.games,
            Part::Generated => recipe.generated.games,
            Part::Invented => recipe.invented.as_ref().map_or(0, |part| part.games),
            Part::Designs => recipe.designs.as_ref().map_or(0, |part| part.games),
            Part::Puzzles(kind) => recipe.puzzles_of(kind).map_or(0, |part| part.games),
        };
        games as usize
    }
}

/// A game available for selection.
pub(super) struct Contender {
    /// The index of the game's job, and the index of the game in the job's result.
    pub(super) job: usize,
    pub(super) at: usize,
    part: Part,
    pub(super) is_new: bool,
    /// The titles and type names of the game and of its sibling (the withheld renamed copy). Selection treats both
    /// identically, so the selected games reveal nothing about the secret random choice of which of the two is
    /// published.
    titles: Vec<String>,
    casts: Vec<Cast>,
    /// The difficulties of the game's levels.
    pub(super) difficulties: Vec<Difficulty>,
    /// The tiers (difficulty classes) of the game's levels, if tiers were measured.
    tiers: Vec<Tier>,
    pub(super) goal: GoalKind,
    pub(super) avatar: AvatarKind,
    pub(super) rules: usize,
    pub(super) form: GameForm,
    /// The patterns from which the game was made.
    patterns: Vec<String>,
    /// The canonical items. An item is the rules with one level.
    pub(super) items: Vec<Digest>,
}

impl Contender {
    /// Creates the contender (candidate for selection) for a game, identified by its job's index and its index in the
    /// job's result; `None` if the game's rules or levels do not load.
    pub(super) fn of(part: Part, (job, at): (usize, usize), frozen: &FrozenGame) -> Option<Contender> {
        let game = Game::from_source(&frozen.text).ok()?;
        let analysis = Analysis::of(&game);
        let kind = GameKind::of(&analysis);
        let form = GameForm::of(&game);
        let likeness = LevelSimilarity::of(&analysis);
        let canonical = |text: &String| {
            let level = game.level(text).ok()?;
            Some(item(&form, &likeness, &level))
        };
        let items = frozen.levels.iter().map(canonical).collect::<Option<Vec<_>>>()?;
        let titles = frozen.guises().map(|(title, _)| title.to_owned()).collect();
        let casts = frozen.guises().map(|(_, text)| Game::from_source(text).ok().map(|game| Cast::of(&game)));
        let casts = casts.collect::<Option<Vec<Cast>>>()?;
        Some(Contender {
            job,
            at,
            part,
            is_new: is_new(&frozen.card),
            titles,
            casts,
            difficulties: frozen.difficulties.clone(),
            tiers: frozen.card.levels.iter().filter_map(|level| level.tier).collect(),
            goal: kind.goal,
            avatar: kind.avatar,
            rules: game.description().interactions.len(),
            form,
            patterns: frozen.card.origin.patterns().to_vec(),
            items,
        })
    }

    fn shares_cast(&self, other: &Contender) -> bool {
        self.casts.iter().any(|cast| other.casts.iter().any(|known| cast.is_shared(known)))
    }

    /// Returns `true` if a previous release contains a near-duplicate of this new game, or an item of this
    /// corpus game.
    fn is_known(&self, plan: &Plan<'_>) -> bool {
        match self.is_new {
            true => plan.before.iter().any(|form| self.form.is_near(form)),
            false => self.items.iter().any(|item| plan.recipe.known.items.contains(item)),
        }
    }
}

/// Returns the requested number of levels per difficulty, from easiest to hardest; empty if the recipe does not
/// request difficulties.
pub(super) fn histogram(recipe: &Recipe) -> Vec<(Difficulty, i64)> {
    let shares: Vec<f64> = recipe.difficulty.values().copied().collect();
    let numbers = apportion(recipe.levels(), &shares);
    recipe.difficulty.keys().copied().zip(numbers.into_iter().map(i64::from)).collect()
}

impl Plan<'_> {
    /// Returns the requested number of levels per difficulty, from easiest to hardest; empty if the recipe does not
    /// request difficulties.
    pub fn histogram(&self) -> Vec<(String, i64)> {
        let histogram = histogram(self.recipe).into_iter();
        histogram.map(|(label, levels)| (label.name().to_owned(), levels)).collect()
    }
}

/// Returns the requested number of levels per tier (difficulty class); empty if the recipe does not request tiers.
fn tiers(recipe: &Recipe) -> Vec<(Tier, i64)> {
    if recipe.tiers.is_empty() {
        return Vec::new();
    }
    recipe.tiers.levels(recipe.levels()).map(|(tier, levels)| (tier, i64::from(levels))).collect()
}

/// The number of random starts of the local search.
const STARTS: u64 = 24;

/// The amount by which a selection misses the quotas, the amount by which it misses the histogram, its number of
/// duplicate titles, and its number of pairs of games that share a mechanic or an ending.
type Miss = (i64, i64, i64, i64);

/// Recommends the next step: either a small change to the recipe that preserves finished jobs, or a different change
/// that does not. A sealed recipe cannot be changed at all, because the commitment covers it.
fn advice(recipe: &Recipe, small: &str, other: &str) -> String {
    if recipe.commitment.is_some() {
        return format!(
            "{small}, or {other}; then commit to the changed recipe with `arcade release RECIPE --commit`, and \
             start over"
        );
    }
    format!("{small} and continue with --resume, which keeps finished jobs; or {other}, and start over")
}

/// Selects the requested number of contenders from each part, and returns their indices in ascending order. The jobs'
/// tallies are used to explain errors.
///
/// # Errors
/// Returns an error if there are too few contenders, or if no selection meets the quotas and, within one level per
/// bin, the histogram.
pub(super) fn select(
    plan: &Plan<'_>,
    contenders: &[Contender],
    [of_corpus, of_new]: [&Tally; 2],
) -> Result<Vec<usize>, MintError> {
    let recipe = plan.recipe;
    let Fit { fit, dropped } = Fit::of(plan, contenders);
    let asked: BTreeMap<Part, usize> = Part::all().map(|part| (part, part.asked(recipe))).collect();
    for (&part, &asked) in &asked {
        let there = fit.iter().filter(|&&at| contenders[at].part == part).count();
        if there < asked {
            let failed = if part == Part::Corpus { of_corpus } else { of_new };
            let why: BTreeMap<String, u64> = dropped.get(&part).cloned().unwrap_or_default();
            let why = [failed.reasons(), reasons(&why)].into_iter().filter(|why| !why.is_empty()).join(", ");
            let part = part.name();
            let advice = if failed.rejections.contains_key(NO_RULES) {
                let small = format!("there are no rules for further jobs: either lower `{part}.games`");
                advice(recipe, &small, "leave out the earlier releases that have used them, or add kernels")
            } else if part == Part::Designs.name() {
                let small = "either lower `designs.games`";
                advice(recipe, small, "pass a folder with more designs, or relax the criteria")
            } else {
                let small = format!("either raise `{part}.candidates`");
                advice(recipe, &small, "raise the tries or relax the criteria")
            };
            return Err(MintError::TooFew { part, asked, there, why, advice });
        }
    }
    let improved = |start: u64| {
        let mut order = fit.clone();
        plan.seed.child("selection", start).sampler().shuffle(&mut order);
        let mut choice = Choice::of(recipe, contenders, order, asked.clone());
        choice.improve();
        (choice.counts.miss(), start, choice.taken)
    };
    // The best result is taken, or the first among equally good results, regardless of which start finishes first.
    let best = (0..STARTS).into_par_iter().map(improved).min_by_key(|(miss, start, _)| (*miss, *start));
    let mut taken = best.map(|(_, _, taken)| taken).unwrap_or_default();
    taken.sort_unstable();
    let missed = bins(recipe, contenders, &taken).into_iter().filter(|bin| bin.missed() > 0);
    let told = |bin: Bin| format!("{} {} (requested {} to {})", bin.name, bin.there, bin.least, bin.most);
    let missed = missed.map(told).join(", ");
    if missed.is_empty() {
        return Ok(taken);
    }
    let small = "raise `generated.candidates` or `corpus.candidates`, or relax the quotas,";
    let advice = advice(recipe, small, "add kernels");
    Err(MintError::Uneven { candidates: fit.len(), missed, advice })
}

/// The contenders (candidates for selection) that may be selected together, and the reasons for excluding the others.
struct Fit {
    /// The indices of the contenders (candidates for selection) that may be selected together.
    fit: Vec<usize>,
    /// The reasons why other contenders (candidates for selection) were excluded, with their counts, by part.
    dropped: BTreeMap<Part, BTreeMap<String, u64>>,
}

impl Fit {
    /// Excludes contenders (candidates for selection) that occur in a previous release or contain the same level twice.
    /// A new contender is also excluded if it is near an earlier new contender, or shares its idea, its title or most
    /// of its type names.
    fn of(plan: &Plan<'_>, contenders: &[Contender]) -> Fit {
        let mut fit: Vec<usize> = Vec::new();
        let mut dropped: BTreeMap<Part, BTreeMap<String, u64>> = BTreeMap::new();
        for (at, contender) in contenders.iter().enumerate() {
            let distinct: BTreeSet<&Digest> = contender.items.iter().collect();
            let repeats = distinct.len() < contender.items.len();
            let of_new = |same: &dyn Fn(&Contender) -> bool| {
                contender.is_new
                    && fit.iter().map(|&other| &contenders[other]).any(|other| other.is_new && same(other))
            };
            let why = match () {
                () if contender.is_known(plan) => "in an earlier release",
                () if repeats => "duplicate level",
                () if of_new(&|other| contender.form.is_near(&other.form)) => {
                    "too similar to another candidate"
                }
                () if of_new(&|other| share_idea(&contender.patterns, &other.patterns)) => {
                    "an idea shared with another candidate"
                }
                () if of_new(&|other| contender.titles.iter().any(|title| other.titles.contains(title))) => {
                    "duplicate title"
                }
                () if of_new(&|other| contender.shares_cast(other)) => "duplicate cast",
                () => {
                    fit.push(at);
                    continue;
                }
            };
            *dropped.entry(contender.part).or_default().entry(why.to_owned()).or_default() += 1;
        }
        Fit { fit, dropped }
    }
}

/// Returns the requirements for a selection, with the achieved counts. Difficulties may be off by one level, but
/// quotas are exact.
pub(super) fn bins(recipe: &Recipe, contenders: &[Contender], taken: &[usize]) -> Vec<Bin> {
    let counts = Counts::of(recipe, taken.iter().map(|&at| &contenders[at]));
    let mut bins = Vec::new();
    for (label, asked) in &counts.histogram {
        let there = counts.labels.get(label).copied().unwrap_or_default();
        bins.push(Bin { name: label.name().to_owned(), least: (asked - 1).max(0), most: asked + 1, there });
    }
    let others = counts.labels.iter().filter(|(label, _)| !recipe.difficulty.contains_key(label));
    for (label, &there) in others.filter(|_| !recipe.difficulty.is_empty()) {
        bins.push(Bin { name: label.name().to_owned(), least: 0, most: 1, there });
    }
    for &(tier, asked) in &counts.tiers_asked {
        let there = counts.tiers.get(&tier).copied().unwrap_or_default();
        bins.push(Bin { name: format!("tier {tier}"), least: (asked - 1).max(0), most: asked + 1, there });
    }
    for &(goal, (least, most)) in &counts.goal_quotas {
        let there = counts.goals.get(&goal).copied().unwrap_or_default();
        bins.push(Bin { name: format!("goal {}", goal.name()), least, most, there });
    }
    for &(avatar, (least, most)) in &counts.avatar_quotas {
        let there = counts.avatars.get(&avatar).copied().unwrap_or_default();
        bins.push(Bin { name: format!("avatar {}", avatar.name()), least, most, there });
    }
    if let Some(most) = counts.crowd {
        let there = counts.kinds.values().copied().max().unwrap_or_default();
        bins.push(Bin { name: "games with the same goal and avatar".to_owned(), least: 0, most, there });
    }
    bins
}

/// A selection that is being improved.
struct Choice<'a> {
    contenders: &'a [Contender],
    taken: Vec<usize>,
    left: Vec<usize>,
    counts: Counts<'a>,
}

impl<'a> Choice<'a> {
    /// Creates the initial selection, by taking the first contenders (candidates for selection) of each part in a given
    /// order.
    fn of(
        recipe: &'a Recipe,
        contenders: &'a [Contender],
        order: Vec<usize>,
        mut room: BTreeMap<Part, usize>,
    ) -> Choice<'a> {
        let (mut taken, mut left) = (Vec::new(), Vec::new());
        for at in order {
            let room = room.entry(contenders[at].part).or_default();
            match room.checked_sub(1) {
                Some(less) => {
                    *room = less;
                    taken.push(at);
                }
                None => left.push(at),
            }
        }
        let counts = Counts::of(recipe, taken.iter().map(|&at| &contenders[at]));
        Choice { contenders, taken, left, counts }
    }

    /// Makes the best swap repeatedly until no swap helps. Each swap reduces the miss, so the loop
    /// terminates. The cost per swap is quadratic in the number of candidates.
    fn improve(&mut self) {
        loop {
            let now = self.counts.miss();
            let mut best: Option<(Miss, usize, usize)> = None;
            for place in 0..self.taken.len() {
                let out = &self.contenders[self.taken[place]];
                self.counts.add(out, -1);
                for other in 0..self.left.len() {
                    let instead = &self.contenders[self.left[other]];
                    if instead.part != out.part {
                        continue;
                    }
                    self.counts.add(instead, 1);
                    let miss = self.counts.miss();
                    self.counts.add(instead, -1);
                    if miss < now && best.is_none_or(|(known, ..)| miss < known) {
                        best = Some((miss, place, other));
                    }
                }
                self.counts.add(out, 1);
            }
            let Some((_, place, other)) = best else { break };
            self.counts.add(&self.contenders[self.taken[place]], -1);
            self.counts.add(&self.contenders[self.left[other]], 1);
            std::mem::swap(&mut self.taken[place], &mut self.left[other]);
        }
    }
}

/// The counts of a selection for every requirement.
#[derive(Default)]
struct Counts<'a> {
    histogram: Vec<(Difficulty, i64)>,
    tiers_asked: Vec<(Tier, i64)>,
    goal_quotas: Vec<(GoalKind, (i64, i64))>,
    avatar_quotas: Vec<(AvatarKind, (i64, i64))>,
    crowd: Option<i64>,
    labels: BTreeMap<Difficulty, i64>,
    tiers: BTreeMap<Tier, i64>,
    goals: BTreeMap<GoalKind, i64>,
    avatars: BTreeMap<AvatarKind, i64>,
    kinds: BTreeMap<(GoalKind, AvatarKind), i64>,
    titles: BTreeMap<&'a str, i64>,
    parts: BTreeMap<&'a str, i64>,
}

impl<'a> Counts<'a> {
    fn of(recipe: &Recipe, games: impl Iterator<Item = &'a Contender>) -> Counts<'a> {
        let mut counts = Counts {
            histogram: histogram(recipe),
            tiers_asked: tiers(recipe),
            goal_quotas: recipe.goal_quotas(),
            avatar_quotas: recipe.avatar_quotas(),
            crowd: recipe.taxonomy.crowd.map(|crowd| recipe.quota((0.0, crowd)).1.max(1)),
            ..Counts::default()
        };
        games.for_each(|game| counts.add(game, 1));
        counts
    }

    fn add(&mut self, game: &'a Contender, times: i64) {
        for &difficulty in &game.difficulties {
            *self.labels.entry(difficulty).or_default() += times;
        }
        for &tier in &game.tiers {
            *self.tiers.entry(tier).or_default() += times;
        }
        *self.goals.entry(game.goal).or_default() += times;
        *self.avatars.entry(game.avatar).or_default() += times;
        *self.kinds.entry((game.goal, game.avatar)).or_default() += times;
        for part in game.patterns.iter().filter(|pattern| is_part(pattern)) {
            *self.parts.entry(part.as_str()).or_default() += times;
        }
        // Titles with count 0 are removed, so only the titles of selected games are kept.
        for title in &game.titles {
            let same = self.titles.entry(title.as_str()).or_default();
            *same += times;
            if *same == 0 {
                self.titles.remove(title.as_str());
            }
        }
    }

    fn miss(&self) -> Miss {
        let missed = |there: Option<&i64>, asked| outside(there.copied().unwrap_or_default(), asked);
        let goals = self.goal_quotas.iter().map(|(goal, asked)| missed(self.goals.get(goal), *asked));
        let avatars =
            self.avatar_quotas.iter().map(|(avatar, asked)| missed(self.avatars.get(avatar), *asked));
        let crowded =
            self.crowd.map_or(0, |most| self.kinds.values().map(|there| (there - most).max(0)).sum());
        let asked: BTreeMap<Difficulty, i64> = self.histogram.iter().copied().collect();
        let apart = |label: &Difficulty, there: i64| there - asked.get(label).copied().unwrap_or_default();
        let mut labels: BTreeSet<Difficulty> = asked.keys().copied().collect();
        labels.extend(self.labels.keys());
        let there = |label: &Difficulty| self.labels.get(label).copied().unwrap_or_default();
        // Squared deviations are summed, so that the deviation is spread over the bins.
        let histogram = match asked.is_empty() {
            true => 0,
            false => labels.iter().map(|label| apart(label, there(label)).pow(2)).sum(),
        };
        let of_tier =
            |(tier, asked): &(Tier, i64)| (self.tiers.get(tier).copied().unwrap_or_default() - asked).pow(2);
        let histogram = histogram + self.tiers_asked.iter().map(of_tier).sum::<i64>();
        let twice = self.titles.values().map(|there| (there - 1).max(0)).sum();
        let shared = self.parts.values().map(|there| there * (there - 1) / 2).sum();
        (goals.chain(avatars).sum::<i64>() + crowded, histogram, twice, shared)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mint::tests::{FETCH, recipe};

    /// Two of the three games have the same danger, so the third game is always selected.
    #[test]
    fn games_that_share_no_mechanic_are_preferred() {
        let form = GameForm::of(&Game::from_source(FETCH).unwrap());
        let contender = |(job, danger): (usize, &str)| Contender {
            job,
            at: 0,
            part: Part::Invented,
            is_new: true,
            titles: vec![format!("Game {job}")],
            casts: Vec::new(),
            difficulties: Vec::new(),
            tiers: Vec::new(),
            goal: GoalKind::Deliver,
            avatar: AvatarKind::Walks,
            rules: 5,
            form: form.clone(),
            patterns: vec![format!("mechanic/{danger}"), format!("ending/{job}")],
            items: Vec::new(),
        };
        let recipe = recipe("shared");
        for dangers in [["hunt", "hunt", "flood"], ["flood", "hunt", "hunt"], ["hunt", "flood", "hunt"]] {
            let contenders: Vec<Contender> = dangers.into_iter().enumerate().map(contender).collect();
            let asked = BTreeMap::from([(Part::Invented, 2)]);
            let mut choice = Choice::of(&recipe, &contenders, vec![0, 1, 2], asked);
            choice.improve();
            let taken: BTreeSet<&str> = choice.taken.iter().map(|&at| dangers[at]).collect();
            assert_eq!(taken, BTreeSet::from(["flood", "hunt"]), "{dangers:?}");
        }
    }
}
