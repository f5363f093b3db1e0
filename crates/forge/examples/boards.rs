//! Prints boards of a game, either drawn or found by a search: `boards KERNEL|PATH.vgdl SEED [SLOT] [COUNT] [DIR]`.
//!
//! A slot is a position in a game's sequence of levels. Without a slot, prints compositions as they are drawn, and a
//! table of their similarity. With a slot, searches for boards, each unlike all earlier boards, and writes them as
//! level files to the folder, if a folder is given.

#![allow(clippy::print_stdout, reason = "an example prints")]

use base::Seed;
use engine::{Analysis, Game, Level};
use generators::Variation;
use generators::boards::{BoardBrief, BoardVariation, Idiom};
use generators::kernels::KernelGenome;
use infinite_arcade_forge::boards::{BoardBudget, BoardOrder, make_board};
use std::collections::BTreeSet;
use std::path::Path;

/// The number of compositions that are judged without a search.
const DRAWS: u64 = 30;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [name, seed, rest @ ..] = &arguments[..] else {
        println!("usage: boards KERNEL|PATH.vgdl SEED [SLOT] [COUNT] [DIR]");
        return;
    };
    let seed = Seed::from_text(seed);
    let game = load(name, seed);
    let analysis = Analysis::of(&game);
    print_kit(&analysis);
    let number = |at: usize, usual: u64| rest.get(at).and_then(|text| text.parse().ok()).unwrap_or(usual);
    match rest.first() {
        None => draw(&analysis, seed, 100),
        Some(_) => search(&analysis, seed, number(0, 2) as u8, number(1, 1), rest.get(2)),
    }
}

fn load(name: &str, seed: Seed) -> Game {
    if name.ends_with(".vgdl") || name.ends_with(".txt") {
        let source = std::fs::read_to_string(name).expect("the file can be read");
        return Game::from_source(&source).expect("the game compiles");
    }
    let genome = KernelGenome::of_kernel(name, |_| true, &BTreeSet::new(), seed).expect("a kernel");
    let game = genome.build().expect("the kernel builds").game.rules;
    println!("{}", engine::syntax::print(game.description()));
    game
}

fn print_kit(analysis: &Analysis) {
    let game = analysis.game();
    for stype in game.sprite_types() {
        let symbol = analysis.facts(stype).symbols.first().map_or(' ', |&symbol| char::from(symbol));
        println!(
            "{symbol} {:14} {:?} {:?}",
            game.name(stype),
            Idiom::of(analysis, stype),
            analysis.role(stype)
        );
    }
}

/// Returns the fraction of equal cells, among all cells that are not floor on both boards, in the best of the eight
/// orientations.
fn likeness(one: &Level, other: &Level, floor: u8) -> f64 {
    let at = |level: &Level, x: usize, y: usize| match x < level.columns() && y < level.rows() {
        true => level.cells()[y * level.columns() + x],
        false => floor,
    };
    let turned = |turn: usize, x: usize, y: usize| {
        let (x, y) = if turn & 4 != 0 { (y, x) } else { (x, y) };
        let x = if turn & 1 != 0 { other.columns().wrapping_sub(1 + x) } else { x };
        let y = if turn & 2 != 0 { other.rows().wrapping_sub(1 + y) } else { y };
        at(other, x, y)
    };
    let side = one.columns().max(one.rows()).max(other.columns()).max(other.rows());
    let share = |turn: usize| {
        let (mut equal, mut all) = (0, 0);
        for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
            let (a, b) = (at(one, x, y), turned(turn, x, y));
            all += usize::from(a != floor || b != floor);
            equal += usize::from(a == b && a != floor);
        }
        f64::from(equal as u32) / f64::from(all.max(1) as u32)
    };
    (0..8).map(share).fold(0.0, f64::max)
}

fn draw(analysis: &Analysis, seed: Seed, count: u64) {
    let variation = BoardVariation::new(analysis, &BoardBrief::of_demand(2)).expect("a usual game");
    let levels: Vec<Level> = (0..count).filter_map(|at| variation.create(seed.child("board", at))).collect();
    for level in levels.iter().take(12) {
        println!("{level}");
    }
    let floor = most_common(&levels);
    let pairs = (0..levels.len()).flat_map(|one| (0..one).map(move |two| (one, two)));
    let alike = pairs.filter(|&(one, two)| likeness(&levels[one], &levels[two], floor) > 0.8).count();
    println!("{} of {count} drawn; {alike} pairs above 0.8", levels.len());
}

fn most_common(levels: &[Level]) -> u8 {
    let mut counts = [0usize; 256];
    let inner = |level: &Level| level.cells()[level.columns() + 1..].to_vec();
    levels.iter().flat_map(inner).for_each(|symbol| counts[usize::from(symbol)] += 1);
    (0..=255u8).max_by_key(|&symbol| counts[usize::from(symbol)]).unwrap_or(b'.')
}

/// Prints the fraction of compositions that meet all constraints without changes.
fn print_yield(analysis: &Analysis, seed: Seed, order: &BoardOrder) {
    let budget = BoardBudget { evaluations: 1, total: 1, ..BoardBudget::default() };
    let made =
        (0..DRAWS).filter(|&at| make_board(analysis, order, seed.child("yield", at), &budget).is_some());
    println!("{} of {DRAWS} compositions are won as ordered", made.count());
}

fn search(analysis: &Analysis, seed: Seed, slot: u8, count: u64, folder: Option<&String>) {
    let mut order = BoardOrder::of(BoardBrief::of_demand(slot));
    print_yield(analysis, seed, &order);
    for at in 0..count {
        let made = make_board(analysis, &order, seed.child("made", at), &BoardBudget::default());
        let Some(made) = made else {
            println!("board {at}: none");
            continue;
        };
        let measures = &made.measures;
        println!(
            "board {at}: {} ticks{}, needed {:.2}, traps {:.2} (dead {:.2}), used {:.2}, dead {:.2}, sweep {:.1}, quality {:.3}, {} boards, {} calls{}",
            measures.ticks,
            if measures.is_shortest { " (shortest)" } else { "" },
            measures.necessity(),
            measures.traps,
            measures.deaths,
            measures.used,
            measures.dead,
            measures.sweep.unwrap_or(f64::NAN),
            measures.quality,
            made.evaluations,
            made.calls,
            if made.is_complete { ", complete" } else { "" },
        );
        println!("{}", made.level);
        if let Some(folder) = folder {
            let path = Path::new(folder).join(format!("board{at}.txt"));
            std::fs::write(path, made.level.to_string()).expect("the folder can be written to");
        }
        order.known.push(measures.firsts.clone());
        order.unlike.push(made.level);
    }
}
