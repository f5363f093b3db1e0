//! Variation of levels for search: edits and crossovers keep what makes a level of a game.

use crate::corpora::{game_in, name_of, own};
use engine::analysis::{Harm, Reason, Role, Sink, Steering};
use engine::{Analysis, Game, Level, Seed, SpriteType};
use generators::levels::{LevelConfig, LevelVariation};
use generators::{Generator, Variation};
use std::array;
use std::collections::BTreeSet;

/// The kind of a level character.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Ground,
    Wall,
    Avatar,
    Thing(Role),
}

/// The requirements and the usual numbers of a game, from which the faults of a level are told.
struct Standards<'a> {
    analysis: &'a Analysis,
    /// By character.
    kinds: Vec<Kind>,
    /// By character: the minimum and maximum number.
    bounds: Vec<(usize, usize)>,
    /// By character: the first and the last line on which it lies, in thousandths of the board, if the avatar moves along a line.
    bands: Option<Vec<(usize, usize)>>,
}

impl<'a> Standards<'a> {
    /// Derives the usual numbers from sample levels, the same as the variation does.
    fn of(variation: &'a LevelVariation<'_>) -> Standards<'a> {
        let levels = variation.constructive();
        let analysis = levels.analysis();
        let game = analysis.game();
        let seed = Seed::from_text("usual numbers");
        let samples: Vec<Level> =
            (0..16).filter_map(|index| levels.generate(seed.child("level", index)).ok()).collect();
        let is_avatar = |stype: SpriteType| game.class(stype).is_some_and(|class| class.is_avatar());
        let holds_avatar = |symbol: u8| game.places(symbol).iter().any(|&stype| is_avatar(stype));
        let holds_wall =
            |symbol: u8| game.places(symbol).iter().any(|&stype| analysis.role(stype) == Role::Wall);
        // Empty cells are the most common but for walls.
        let empty = (b' '..=b'~').filter(|&symbol| !holds_avatar(symbol) && !holds_wall(symbol));
        let empty =
            empty.max_by_key(|&symbol| samples.iter().map(|level| count(level, symbol)).sum::<usize>());
        let ground = empty.map_or(&[][..], |symbol| game.places(symbol));
        let kind = |symbol: u8| {
            if holds_avatar(symbol) {
                return Kind::Avatar;
            }
            let types = game.places(symbol).iter().filter(|stype| !ground.contains(stype));
            match types.map(|&stype| analysis.role(stype)).min() {
                None | Some(Role::Soil | Role::Floor) => Kind::Ground,
                Some(Role::Wall) => Kind::Wall,
                Some(role) => Kind::Thing(role),
            }
        };
        let bounds = |symbol: u8| {
            let counts = || samples.iter().map(|level| count(level, symbol));
            let (low, high) = (counts().min().unwrap_or(0), counts().max().unwrap_or(usize::MAX));
            if low < high { (low.div_ceil(2), high.saturating_add(high / 2)) } else { (low, high) }
        };
        let mut standards = Standards {
            analysis,
            kinds: (0..128).map(kind).collect(),
            bounds: (0..128).map(bounds).collect(),
            bands: None,
        };
        let band = |symbol: u8| {
            let cells =
                samples.iter().flat_map(|level| cells_of(level, symbol).map(move |cell| (level, cell)));
            let places: Vec<usize> = cells.map(|(level, cell)| standards.across(level, cell)).collect();
            (places.iter().copied().min().unwrap_or(usize::MAX), places.into_iter().max().unwrap_or(0))
        };
        let bound = matches!(standards.steering(), Some(Steering::Horizontal | Steering::Vertical));
        standards.bands = bound.then(|| (0..128).map(band).collect());
        standards
    }

    fn steering(&self) -> Option<Steering> {
        self.analysis.start_avatar().map(|avatar| avatar.steering)
    }

    /// The position of a cell across the avatar's line of movement, in thousandths of the board.
    fn across(&self, level: &Level, cell: usize) -> usize {
        let (place, length) = match self.steering() {
            Some(Steering::Vertical) => (cell % level.columns(), level.columns()),
            _ => (cell / level.columns(), level.rows()),
        };
        place * 1000 / (length - 1).max(1)
    }

    fn kind(&self, level: &Level, cell: usize) -> Kind {
        self.kinds[usize::from(level.cells()[cell])]
    }

    fn is_wall(&self, level: &Level, cell: usize) -> bool {
        self.kind(level, cell) == Kind::Wall
    }

    /// The border cells, if all of them are wall.
    fn border(&self, level: &Level) -> Option<Vec<u8>> {
        let border = || (0..level.cells().len()).filter(|&cell| around(level, cell).contains(&None));
        border()
            .all(|cell| self.is_wall(level, cell))
            .then(|| border().map(|cell| level.cells()[cell]).collect())
    }

    /// The faults of a level, each as a number; 0 is best: sprites by which it misses requirements and usual numbers, cells that cannot
    /// be reached, harmful things too close to the avatar, and things where they do not belong.
    fn faults(&self, level: &Level) -> [usize; 4] {
        [self.count_deviation(level), self.stranded(level), self.crowded(level), self.misplaced(level)]
    }

    fn count_deviation(&self, level: &Level) -> usize {
        let game = self.analysis.game();
        let sprites = |stype: SpriteType| {
            let places = level.cells().iter().flat_map(|&symbol| game.places(symbol));
            places.filter(|&&placed| placed == stype).count()
        };
        let missed = self.analysis.requirements().iter().map(|requirement| {
            let asked = match requirement.reason {
                Reason::Avatar => false,
                Reason::Goal(_) | Reason::WinMethod(_) => true,
                Reason::Lock(stype) => {
                    matches!(self.analysis.role(stype), Role::Gate | Role::Exit) && sprites(stype) > 0
                }
                Reason::Portal(stype) => sprites(stype) > 0,
            };
            let there: usize = requirement.types.iter().map(|&stype| sprites(stype)).sum();
            let too_few = (requirement.at_least as usize).saturating_sub(there);
            let too_many = requirement.at_most.map_or(0, |most| there.saturating_sub(most as usize));
            if asked { too_few + too_many } else { 0 }
        });
        // Pushed things that have to go, and have no place to go to.
        let pushed = self.analysis.pushables().iter();
        let pushed = pushed.filter(|pushable| self.analysis.aims().remove.contains(&pushable.stype));
        let homeless = pushed.map(|pushable| {
            let merges = |sink: &Sink| self.analysis.role(sink.partner) == Role::Pushable;
            let is_endless = |sink: &&Sink| (!sink.fills || merges(sink)) && sprites(sink.partner) > 0;
            let room: usize = pushable.sinks.iter().map(|sink| sprites(sink.partner)).sum();
            let endless = pushable.sinks.iter().any(|sink| is_endless(&sink));
            if endless { 0 } else { sprites(pushable.stype).saturating_sub(room) }
        });
        let things =
            (b' '..=b'~').filter(|&symbol| matches!(self.kinds[usize::from(symbol)], Kind::Thing(_)));
        let unusual = things.map(|symbol| {
            let ((low, high), count) = (self.bounds[usize::from(symbol)], count(level, symbol));
            low.saturating_sub(count) + count.saturating_sub(high)
        });
        missed.sum::<usize>() + homeless.sum::<usize>() + unusual.sum::<usize>()
    }

    fn avatar(&self, level: &Level) -> usize {
        let mut cells = 0..level.cells().len();
        cells.find(|&cell| self.kind(level, cell) == Kind::Avatar).expect("a level has an avatar")
    }

    /// The number of cells without wall that the avatar cannot reach through cells without wall.
    fn stranded(&self, level: &Level) -> usize {
        let mut open: Vec<bool> = (0..level.cells().len()).map(|cell| !self.is_wall(level, cell)).collect();
        let mut todo = vec![self.avatar(level)];
        while let Some(cell) = todo.pop() {
            open[cell] = false;
            todo.extend(beside(level, cell).into_iter().flatten().filter(|&next| open[next]));
        }
        open.into_iter().filter(|&open| open).count()
    }

    /// The steps by which harmful things are nearer to the avatar than three.
    fn crowded(&self, level: &Level) -> usize {
        let (avatar, game) = (self.avatar(level), self.analysis.game());
        let harms =
            |&stype: &SpriteType| self.analysis.harm(stype) != Harm::None || self.analysis.makes_harm(stype);
        let harmful = (0..level.cells().len()).filter(|&cell| {
            let is_thing = matches!(self.kind(level, cell), Kind::Thing(_));
            is_thing && game.places(level.cells()[cell]).iter().any(harms)
        });
        let steps = |cell: usize| {
            let (column, row) = (cell % level.columns(), cell / level.columns());
            column.abs_diff(avatar % level.columns()) + row.abs_diff(avatar / level.columns())
        };
        harmful.map(|cell| 3_usize.saturating_sub(steps(cell))).sum()
    }

    /// The number of isolated wall blocks, gates in the open, and things in unusual positions.
    fn misplaced(&self, level: &Level) -> usize {
        let is_misplaced = |&cell: &usize| match self.kind(level, cell) {
            Kind::Wall => {
                let is_open = |next: Option<usize>| next.is_some_and(|next| !self.is_wall(level, next));
                around(level, cell).into_iter().all(is_open)
            }
            Kind::Thing(role) => {
                let [up, left, down, right] =
                    beside(level, cell).map(|next| next.is_none_or(|next| self.is_wall(level, next)));
                let is_between = up == down && left == right && up != left;
                let band = self.bands.as_ref().map(|bands| bands[usize::from(level.cells()[cell])]);
                let place = self.across(level, cell);
                let in_band = band.is_none_or(|(low, high)| low > high || (low..=high).contains(&place));
                !in_band || (role == Role::Gate && !is_between)
            }
            Kind::Ground | Kind::Avatar => false,
        };
        (0..level.cells().len()).filter(is_misplaced).count()
    }
}

/// The cells that hold a character.
fn cells_of(level: &Level, symbol: u8) -> impl Iterator<Item = usize> {
    (0..level.cells().len()).filter(move |&cell| level.cells()[cell] == symbol)
}

fn count(level: &Level, symbol: u8) -> usize {
    cells_of(level, symbol).count()
}

/// The eight cells around a cell; `None` off the board.
fn around(level: &Level, cell: usize) -> [Option<usize>; 8] {
    const WAYS: [(isize, isize); 8] = [(0, -1), (-1, 0), (0, 1), (1, 0), (-1, -1), (-1, 1), (1, 1), (1, -1)];
    WAYS.map(|(right, down)| {
        let column = (cell % level.columns()).checked_add_signed(right)?;
        let row = (cell / level.columns()).checked_add_signed(down)?;
        (column < level.columns() && row < level.rows()).then_some(row * level.columns() + column)
    })
}

/// Those above, left, below and right.
fn beside(level: &Level, cell: usize) -> [Option<usize>; 4] {
    let around = around(level, cell);
    array::from_fn(|way| around[way])
}

fn seed(name: &str) -> Seed {
    Seed::from_text("variation").child(name, 0)
}

fn check(name: &str, game: &Game, parents: &[&Level], child: &Level, standards: &Standards<'_>) {
    let text = child.to_string();
    assert_eq!(game.level(&text).as_ref(), Ok(child), "{name}\n{text}");
    let one = parents[0];
    assert_eq!((child.columns(), child.rows()), (one.columns(), one.rows()), "{name}");
    assert!(game.start(child, seed(name)).avatar_id().is_some(), "{name}\n{text}");
    if let Some(border_of_parent) = standards.border(one) {
        assert_eq!(standards.border(child), Some(border_of_parent), "{name}\n{text}");
    }
    let allowed = parents.iter().map(|parent| standards.faults(parent));
    let allowed = allowed.reduce(|one, two| array::from_fn(|fault| one[fault].max(two[fault])));
    let (allowed, faults) = (allowed.unwrap_or_default(), standards.faults(child));
    let is_worse = faults.iter().zip(&allowed).any(|(fault, allowed)| fault > allowed);
    assert!(!is_worse, "{name}: {faults:?} {allowed:?}\n{text}");
}

#[test]
fn varied_levels_are_levels() {
    for folder in own() {
        let Some(game) = game_in(&folder) else { continue };
        let name = name_of(&folder);
        let variation = LevelVariation::new(&game, LevelConfig::default()).unwrap();
        let standards = Standards::of(&variation);
        let mut sampler = seed(&name).sampler();
        let create = |index: u64| variation.create(seed(&name).child("level", index)).unwrap();
        let (mut level, other) = (create(0), create(1));
        let (mut changed, mut different) = (0, BTreeSet::new());
        for turn in 0..500 {
            let crossing = turn % 5 == 4;
            let child = if crossing {
                variation.cross(&level, &other, &mut sampler)
            } else {
                variation.mutate(&level, &mut sampler)
            };
            let parents = if crossing { vec![&level, &other] } else { vec![&level] };
            check(&name, &game, &parents, &child, &standards);
            changed += u32::from(child != level);
            different.insert(child.to_string());
            level = if turn % 50 == 49 { create(turn) } else { child };
        }
        assert!(changed >= 490, "{name}: {changed} of 500 changed something");
        assert!(different.len() >= 450, "{name}: {} different levels", different.len());
    }
}

#[test]
fn equal_draws_give_equal_levels() {
    for folder in own() {
        let Some(game) = game_in(&folder) else { continue };
        let walk = || {
            let variation = LevelVariation::new(&game, LevelConfig::default()).unwrap();
            let mut sampler = seed("walk").sampler();
            let mut level = variation.create(seed("walk")).unwrap();
            for _ in 0..30 {
                level = variation.mutate(&level, &mut sampler);
            }
            level.to_string()
        };
        assert_eq!(walk(), walk());
    }
}
