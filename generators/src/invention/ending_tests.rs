//! Tests that play small boards to check the outcomes of endings and dangers.

use super::emit;
use super::genome::{Invention, normal};
use super::tests::{mechanics, partition};
use base::Seed;
use engine::{Action, Game, Outcome, syntax};

/// Plays a game with the given mechanics, which need not pass the checks for a sound game. The rows of the board are
/// separated by spaces. The characters `a`, `b` and so on place the types in the order of their first ports (open
/// roles). Returns the outcome and the number of actions played.
fn play(names: &[&str], merges: &[(&str, &str)], board: &str, keys: &str) -> (Outcome, usize) {
    let mechanics = mechanics(names);
    let seed = Seed::from_text("play");
    let partition = normal(&partition(&mechanics, merges));
    let values = mechanics.iter().map(|mechanic| mechanic.numbers.draw(&mut seed.sampler())).collect();
    let invention = Invention { mechanics, partition, values, fiction: seed, time: Some(99) };
    let types = invention.types().unwrap();
    let mut description = emit::write(&invention, &types).unwrap().description;
    for (line, symbol) in description.mapping.iter_mut().zip(".wAabcdefgh".chars()) {
        line.symbol = symbol;
    }
    let text = syntax::print(&description).replacen("BasicGame", "BasicGame obs=wall", 1);
    let game = Game::from_source(&text).unwrap();
    let level = game.level(&board.replace(' ', "\n")).unwrap();
    let mut state = game.start(&level, seed);
    for (at, key) in keys.chars().enumerate() {
        let action = match key {
            'l' => Action::Left,
            'r' => Action::Right,
            'u' => Action::Up,
            'd' => Action::Down,
            _ => Action::Nil,
        };
        let outcome = game.step(&mut state, action);
        if outcome != Outcome::Ongoing {
            return (outcome, at + 1);
        }
    }
    (Outcome::Ongoing, keys.len())
}

#[track_caller]
fn check(names: &[&str], merges: &[(&str, &str)], board: &str, keys: &str, expect: Outcome) {
    let (outcome, played) = play(names, merges, board, keys);
    assert_eq!((outcome, played), (expect, keys.len()));
}

const FRIEND: &[(&str, &str)] = &[("last-out.friend", "herd.sheep")];
const SHEEP: &[(&str, &str)] = &[("lure-over.beast", "herd.sheep")];

#[test]
fn plates_are_weighed_down_by_a_load_and_the_player() {
    check(&["hunt", "all-down"], &[], "wwwwwwww wAbc.c.w w......w wwwwwwww", "rdrrru", Outcome::Won);
}

#[test]
fn tiles_turn_over_and_back_when_the_player_steps_off() {
    for (keys, outcome) in [("rrrr", Outcome::Won), ("rnrnrr", Outcome::Won), ("rrlrrr", Outcome::Ongoing)] {
        check(&["hunt", "turn-over"], &[], "wwwwwwww wAbbb..w wwwwwwww", keys, outcome);
    }
}

#[test]
fn the_last_to_leave_is_the_player() {
    check(&["hunt", "herd", "last-out"], FRIEND, "wwwwwww wAb.c.w wwwwwww", "rrr", Outcome::Won);
    check(&["hunt", "herd", "last-out"], FRIEND, "wwwwwww wb.Ac.w wwwwwww", "r", Outcome::Lost);
}

#[test]
fn the_exit_opens_when_every_burden_is_used_up() {
    let merges = [("lock.key", "use-up.burden")];
    check(&["lock", "hunt", "use-up"], &merges, "wwwwwww wAb.adw wwwwwww", "rrrrr", Outcome::Won);
    check(&["lock", "hunt", "use-up"], &merges, "wwwwwww wdAb..w wwwwwww", "lrrlll", Outcome::Ongoing);
}

#[test]
fn enough_prizes_are_held_before_the_rival_gets_the_last() {
    let merges = [("pace.walker", "outgather.rival")];
    check(&["pace", "outgather"], &merges, "wwwwwww wAbbbbw wwwwwww", "rrrr", Outcome::Won);
    check(&["pace", "outgather"], &merges, "wwwww wA.aw w..bw wwwww", "nn", Outcome::Lost);
}

#[test]
fn only_the_beast_may_step_on_the_tiles() {
    check(&["hunt", "herd", "lure-over"], SHEEP, "wwwwwww wAbcc.w wwwwwww", "rr", Outcome::Won);
    check(&["hunt", "herd", "lure-over"], SHEEP, "wwwwwww wcA.b.w wwwwwww", "l", Outcome::Lost);
}

#[test]
fn a_worn_tile_bars_the_way() {
    check(&["hunt", "one-stroke"], &[], "wwwwwww wAcc.bw wwwwwww", "rrrr", Outcome::Won);
    check(&["hunt", "one-stroke"], &[], "wwwwwww wbAc..w wwwwwww", "rrlll", Outcome::Ongoing);
}

#[test]
fn a_touch_is_undone_by_the_beast() {
    let merges = [("pace.walker", "undo.beast")];
    let names = ["hunt", "pace", "undo"];
    check(&names, &merges, "wwwwww wAc.cw w.b..w wwwwww", "rrnnnnr", Outcome::Ongoing);
    check(&names, &merges, "wwwwww wAc.cw wb...w wwwwww", "rrnnnnr", Outcome::Won);
}

#[test]
fn enough_friends_get_home() {
    let merges = [("rescue-some.foe", "hunt.hunter"), ("rescue-some.friend", "herd.sheep")];
    let board = "wwwwww wAb.cw w.b.cw w.b.cw wwwwww";
    let (outcome, played) = play(&["hunt", "herd", "rescue-some"], &merges, board, "rrlldrrlldrr");
    assert!(outcome == Outcome::Won && [7, 12].contains(&played), "{outcome:?} {played}");
}

#[test]
fn a_customer_is_lost_to_the_foe() {
    let merges = [("pace.walker", "before-them.foe")];
    check(&["pace", "before-them"], &merges, "wwwwwww wAc.b.w wwwwwww", "rrr", Outcome::Won);
    check(&["pace", "before-them"], &merges, "wwwww wAcaw w..bw wwwww", "nn", Outcome::Lost);
}

#[test]
fn one_touch_serves_two_mechanics() {
    let merges = [("engine.engine", "ring-all.bell")];
    check(&["hunt", "engine", "ring-all"], &merges, "wwwwwww wAb...w wwwwwww", "r", Outcome::Won);
}

#[track_caller]
fn check_idle(names: &[&str], merges: &[(&str, &str)], board: &str, expect: Outcome, ticks: (usize, usize)) {
    check_idle_after(names, merges, board, "", expect, ticks);
}

/// Plays the keys, and then does nothing.
#[track_caller]
fn check_idle_after(
    names: &[&str],
    merges: &[(&str, &str)],
    board: &str,
    keys: &str,
    expect: Outcome,
    ticks: (usize, usize),
) {
    let (outcome, played) = play(names, merges, board, &format!("{keys}{}", "n".repeat(60)));
    assert!(outcome == expect && (ticks.0..=ticks.1).contains(&played), "{outcome:?} {played}");
}

#[test]
fn a_beast_comes_out_of_a_den_that_is_left() {
    let merges = [("emerge.beast", "hunt.hunter")];
    check_idle(&["emerge", "hunt", "exit"], &merges, "wwwwwww wA.b.cw wwwwwww", Outcome::Lost, (15, 32));
}

#[test]
fn a_beast_eats_the_nearest_food() {
    let merges = [("breed.food", "gather.prize")];
    check_idle(&["breed", "gather"], &merges, "wwwwwww wA.a.bw wwwwwww", Outcome::Lost, (4, 7));
}

#[test]
fn an_avenger_rises_where_a_prize_was() {
    let names = ["avenge", "gather"];
    let merges = [("avenge.prize", "gather.prize")];
    check(&names, &merges, "wwwwwww wAb..bw wwwwwww", "rrrr", Outcome::Won);
    check_idle_after(&names, &merges, "wwwwwww wAb..bw wwwwwww", "r", Outcome::Lost, (3, 5));
}

#[test]
fn a_giant_tramples_what_is_in_its_way() {
    let merges = [("bulldoze.pane", "clear-way.barrier")];
    check_idle(&["bulldoze", "clear-way"], &merges, "wwwwwww wA.b.aw wwwwwww", Outcome::Won, (6, 7));
    check_idle(&["bulldoze", "exit"], &[], "wwwwwww wA..acw wwwwwww", Outcome::Lost, (8, 9));
}

#[test]
fn the_thirsty_die_far_from_the_water() {
    check_idle(&["thirst", "exit"], &[], "wwwwwww wA.a.bw wwwwwww", Outcome::Lost, (13, 23));
    let drinks = format!("rr{}", "n".repeat(40));
    check(&["thirst", "exit"], &[], "wwwwwww wA.a.bw wwwwwww", &drinks, Outcome::Ongoing);
}

#[test]
fn a_beast_hatches_from_an_egg_that_is_left() {
    let names = ["hatch", "hunt", "exit"];
    let merges = [("hatch.beast", "hunt.hunter")];
    check_idle(&names, &merges, "wwwwwww wA.b.cw wwwwwww", Outcome::Lost, (17, 34));
    let takes = format!("rr{}", "n".repeat(50));
    check(&names, &merges, "wwwwwww wA.b.cw wwwwwww", &takes, Outcome::Ongoing);
}

#[test]
fn a_roller_flattens_what_is_in_its_way() {
    let merges = [("roll-over.bed", "clear-way.barrier")];
    check_idle(&["roll-over", "clear-way"], &merges, "wwwwww wA...w wb.a.w wwwwww", Outcome::Won, (6, 9));
    check_idle(&["roll-over", "exit"], &[], "wwwwwwww wb..A.cw wwwwwwww", Outcome::Lost, (9, 13));
}

#[test]
fn a_worm_leaves_holes_in_the_way() {
    let merges = [("undermine.soil", "tread-all.tile")];
    check_idle(&["undermine", "tread-all"], &merges, "wwwwww wA...w w.b.cw wwwwww", Outcome::Lost, (2, 8));
}

#[test]
fn a_hunter_gets_quicker_after_a_while() {
    let board = format!("w{0}w wA{1}aw wb{1}.w w{0}w", "w".repeat(38), ".".repeat(36));
    check_idle(&["quicken", "exit"], &[], &board, Outcome::Lost, (44, 64));
}

#[test]
fn a_hunter_gets_quicker_after_a_theft() {
    let names = ["provoke", "exit"];
    let board = "wwwwwwwwwwwwww wbA..........aw wc..........ww wwwwwwwwwwwwww";
    check_idle_after(&names, &[], board, "", Outcome::Lost, (25, 33));
    check_idle_after(&names, &[], board, "l", Outcome::Lost, (10, 14));
}

#[test]
fn a_robber_comes_once_it_is_armed() {
    let board = "wwwwwww wA.b.aw wwwcwww wwwwwww";
    check_idle(&["arm", "exit"], &[], board, Outcome::Lost, (6, 9));
}

#[test]
fn a_rocket_clears_the_rock_in_its_way() {
    let merges = [("seek-out.rock", "clear-way.barrier")];
    check_idle(&["seek-out", "clear-way"], &merges, "wwwwwww wA.b.aw wwwwwww", Outcome::Won, (12, 21));
    let board = "wwwwwww wA...aw wwwcwww wwwwwww";
    check_idle(&["seek-out", "exit"], &[], board, Outcome::Lost, (14, 23));
}

#[test]
fn a_dropped_bomb_clears_the_rock_beside_it() {
    let names = ["pace", "drop-bombs", "clear-way"];
    let merges = [("pace.walker", "drop-bombs.beast"), ("drop-bombs.rock", "clear-way.barrier")];
    check_idle(&names, &merges, "wwwwww wA.a.w w....w w...bw wwwwww", Outcome::Won, (9, 60));
}
