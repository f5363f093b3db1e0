//! The games of a set so far, which limit the next ones: they have to differ, and each kernel and kind has a maximum
//! number of games.

use super::cast::Cast;
use crate::games::candidate::{Candidate, MadeGame};
use crate::games::order::GameOrder;
use crate::pipeline::NEAR_KNOWN;
use engine::Game;
use generators::games::Kind;
use generators::invention::share_idea;
use generators::kernels::KernelGenome;
use std::collections::{BTreeMap, BTreeSet};
use validators::novelty::GameForm;

/// The games of a set so far. No two games are near, no two share a title or a cast, no kernel and no kind is crowded,
/// and games of the same kernel have different maps.
#[derive(Default)]
pub(crate) struct Company {
    forms: Vec<GameForm>,
    titles: BTreeSet<String>,
    casts: Vec<Cast>,
    /// The patterns of each game.
    patterns: Vec<Vec<String>>,
    /// The walls of the levels of all games, by family and slot.
    walls: BTreeSet<(String, usize, Vec<String>)>,
    /// The scenes of the games.
    pub(crate) scenes: BTreeSet<String>,
    /// The remaining places.
    pub(crate) room: Room,
}

/// The remaining places of a set for kernels and kinds.
#[derive(Clone, Default)]
pub(crate) struct Room {
    /// The number of games of each family of kernels that hardly differ.
    of_families: BTreeMap<String, usize>,
    /// The number of games of each kernel in each form.
    of_forms: BTreeMap<(String, Option<String>), usize>,
    /// The number of games of each kind.
    of_kinds: BTreeMap<String, usize>,
    /// The maximum number of games of a kernel and of a kind; `None` if only some kinds are requested.
    most: Option<(usize, usize)>,
}

/// The maximum fraction of a set that may be of one kind.
const OF_KIND: (usize, usize) = (3, 20);
/// The number of games of a kind that is always allowed, even in a small set.
const FEW: usize = 2;
/// The reason for rejecting a game whose kernel or kind has enough games.
pub(crate) const CROWDED: &str = "enough of its kind";

/// Returns the maximum number of games of a kind in a set of `count` games.
fn most_of_kind(count: usize) -> usize {
    (count * OF_KIND.0 / OF_KIND.1).max(FEW)
}

impl Room {
    /// Returns the places for an order. A small set has one game per kernel; a larger one has more, since games of some
    /// kernels may fail. Kinds are limited by [`OF_KIND`]. If only some kinds are requested, there is no limit.
    fn of(order: &GameOrder) -> Room {
        let (count, kernels) = (order.count as usize, KernelGenome::kernels().count());
        let of_kernel = 1 + (2 * count).saturating_sub(1) / kernels.max(1);
        let most = (order.kinds.len() >= Kind::ALL.len()).then_some((of_kernel, most_of_kind(count)));
        Room { most, ..Room::default() }
    }

    /// Returns `true` if there is a place for a game of this kernel and kind.
    pub(crate) fn has_room(&self, kernel: &str, kind: &str) -> bool {
        let Some((of_family, of_kind)) = self.most else { return true };
        self.games_of(kernel) < of_family && self.of_kinds.get(kind).is_none_or(|&there| there < of_kind)
    }

    /// Returns `true` if a game of the kernel may have this form, which requires that no other form has fewer games.
    pub(crate) fn is_open(&self, kernel: &str, form: Option<&str>) -> bool {
        let there = |form: Option<&str>| {
            let key = (kernel.to_owned(), form.map(str::to_owned));
            self.of_forms.get(&key).copied().unwrap_or(0)
        };
        let least = KernelGenome::forms(kernel).into_iter().map(there).min();
        self.most.is_none() || least.is_none_or(|least| there(form) <= least)
    }

    /// Returns the number of games of a kernel and of kernels that hardly differ from it.
    pub(crate) fn games_of(&self, kernel: &str) -> usize {
        self.of_families.get(KernelGenome::family(kernel)).copied().unwrap_or(0)
    }

    /// Counts a game with this kernel, form and kind.
    pub(crate) fn take(&mut self, kernel: &str, form: Option<&str>, kind: &str) {
        *self.of_families.entry(KernelGenome::family(kernel).to_owned()).or_default() += 1;
        *self.of_forms.entry((kernel.to_owned(), form.map(str::to_owned))).or_default() += 1;
        *self.of_kinds.entry(kind.to_owned()).or_default() += 1;
    }
}

impl Company {
    pub(crate) fn of(order: &GameOrder) -> Company {
        Company { room: Room::of(order), ..Company::default() }
    }

    /// Returns the reason why a game cannot be admitted, whatever its levels are.
    pub(crate) fn objection(&self, candidate: &Candidate) -> Option<&'static str> {
        self.objection_to(&candidate.game, &candidate.title)
    }

    fn objection_to(&self, game: &Game, title: &str) -> Option<&'static str> {
        if self.forms.is_empty() {
            return None;
        }
        if self.titles.contains(title) {
            return Some("duplicate title");
        }
        let cast = Cast::of(game);
        if self.casts.iter().any(|other| cast.is_shared(other)) {
            return Some("duplicate cast");
        }
        let form = GameForm::of(game);
        self.forms.iter().any(|other| form.is_near(other)).then_some(NEAR_KNOWN)
    }

    /// Admits the game, or returns the reason why it is rejected.
    pub(crate) fn admit(&mut self, made: &MadeGame) -> Result<(), &'static str> {
        if let Some(why) = self.objection_to(&made.game, &made.card.title) {
            return Err(why);
        }
        let origin = &made.card.origin;
        if self.patterns.iter().any(|other| share_idea(other, origin.patterns())) {
            return Err("two mechanics of another game");
        }
        let (kernel, form) = (origin.kernel().unwrap_or_default(), origin.form());
        if !(self.room.has_room(kernel, &made.card.kind) && self.room.is_open(kernel, form)) {
            return Err(CROWDED);
        }
        let family = KernelGenome::family(kernel);
        let levels = made.levels.iter().map(|found| walls(&found.level.to_string())).enumerate();
        let walls: Vec<_> = levels.map(|(slot, walls)| (family.to_owned(), slot, walls)).collect();
        if self.room.most.is_some() && walls.iter().any(|level| self.walls.contains(level)) {
            return Err("a map twice");
        }
        self.walls.extend(walls);
        self.room.take(kernel, form, &made.card.kind);
        self.titles.insert(made.card.title.clone());
        self.casts.push(Cast::of(&made.game));
        self.forms.push(GameForm::of(&made.game));
        self.patterns.push(origin.patterns().to_vec());
        self.scenes.extend(origin.scene().map(str::to_owned));
        Ok(())
    }

    /// Removes the last games of crowded kinds from a set that has become smaller than ordered, until no kind is
    /// crowded. Returns the number of removed games.
    pub(crate) fn thin(&self, games: &mut Vec<MadeGame>) -> usize {
        let before = games.len();
        while self.room.most.is_some() {
            let mut of_kinds = BTreeMap::new();
            for game in games.iter() {
                *of_kinds.entry(&game.card.kind).or_insert(0) += 1;
            }
            let most = most_of_kind(games.len());
            let is_crowded =
                |game: &MadeGame| of_kinds.get(&game.card.kind).is_some_and(|&there| there > most);
            let Some(last) = games.iter().rposition(is_crowded) else { break };
            games.remove(last);
        }
        before - games.len()
    }
}

/// Returns the walls of a level, mirrored such that mirror images give the same result.
fn walls(level: &str) -> Vec<String> {
    let rows: Vec<String> = level
        .lines()
        .map(|row| row.chars().map(|symbol| if symbol == 'w' { '#' } else { '.' }).collect())
        .collect();
    let turned = |mirrored: bool, upside_down: bool| {
        let row = |row: &String| if mirrored { row.chars().rev().collect() } else { row.clone() };
        let mut rows: Vec<String> = rows.iter().map(row).collect();
        if upside_down {
            rows.reverse();
        }
        rows
    };
    let all = [(false, false), (true, false), (false, true), (true, true)];
    all.into_iter().map(|(mirrored, upside_down)| turned(mirrored, upside_down)).min().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mirror_images_have_the_same_walls() {
        let level = "wwww\nwA.w\nww.w\nwwww\n";
        let mirrored = "wwww\nw.ww\nw.Bw\nwwww\n";
        assert_eq!(walls(level), walls(mirrored));
        assert_ne!(walls(level), walls("wwww\nwA.w\nw..w\nwwww\n"));
    }

    #[test]
    fn sets_have_room_for_few_games_of_a_kernel_and_of_a_kind() {
        let check = |count: u32, of_kernel: usize, of_kind: usize| {
            let room = Room::of(&GameOrder::new(count));
            assert_eq!(room.most, Some((of_kernel, of_kind)), "{count}");
        };
        let kernels = KernelGenome::kernels().count() as u32;
        check(8, 1, 2);
        check(kernels / 2, 1, 3);
        check(kernels, 2, 7);
        check(50, 3, 7);
    }

    #[test]
    fn forms_of_a_kernel_take_turns() {
        let mut room = Room::of(&GameOrder::new(50));
        let kernel = "bridges-burn-behind";
        let [own, other] = KernelGenome::forms(kernel)[..] else { panic!("two forms") };
        assert!(room.is_open(kernel, own) && room.is_open(kernel, other));
        room.take(kernel, own, "lure");
        assert!(!room.is_open(kernel, own) && room.is_open(kernel, other));
        room.take(kernel, other, "lure");
        assert!(room.is_open(kernel, own) && room.games_of(kernel) == 2);
    }
}
