//! Checks every claim that `describe`, the warnings, the analysis and the exhaustive search make against
//! episodes. The games are generated and modified games, loaded strictly and as in the reference. See
//! [`tests::claims`].

use agents::search::{Answer, Pushes, SearchLimits, a_star};
use base::Seed;
use engine::{Action, Outcome, SpriteType};
use rayon::prelude::*;
use std::io::Write as _;
use tests::claims::play::{Play, plays};
use tests::claims::{Case, Claim, Ending, Fact, Fault, Policy, Provided, Tally, Tie, When};
use tests::claims::{faults, games, read, shrink};
use tests::sweep;

/// The number of generated games in a sweep. Each of them is loaded under both policies.
const GAMES: usize = 40_000;
/// The number of games for each game that is searched exhaustively.
const SEARCHED: usize = 10;
/// The number of forward-model calls per search.
const CALLS: u64 = 3000;

/// Checks the game for a seed under a policy. Returns the counts, the number of sentences that could not be
/// parsed, and the false claims.
fn check(seed: Seed, search: bool, policy: Policy) -> Option<(Tally, usize, Vec<Fault>)> {
    let (source, level) = games::game(seed);
    let case = Case::load(&source, &level, policy)?;
    let (mut claims, unread) = read::claims(&case);
    let mut plays = plays(&case, seed);
    if search {
        let seed = seed.child("random", 0);
        let start = case.game.start(&case.level, seed);
        let pushes = Pushes::of(&case.analysis, &case.level);
        let limits = SearchLimits { calls: CALLS, bytes: 1 << 26 };
        let searched = a_star(&case.analysis, &pushes, &start, limits);
        match searched.answer {
            Answer::Won { actions, .. } => plays.push(Play::of(&case, seed, &actions)),
            Answer::Impossible => claims.push(Claim {
                text: format!("all {} reachable states were searched", searched.states),
                fact: Fact::SearchedInVain,
            }),
            Answer::OutOfCalls | Answer::OutOfMemory => {}
        }
    }
    let found = faults(&case, &claims, &plays);
    let mut tally = Tally::default();
    tally.count(&case, &claims, &plays);
    Some((tally, unread, found))
}

#[test]
fn no_claim_is_false() {
    let all = sweep::many_cases(GAMES).div_ceil(if sweep::is_full() { 1 } else { 5 });
    let parts = (0..all).into_par_iter().map(|number| {
        let seed = sweep::seed("claims").child("game", number as u64);
        let both = [Policy::Strict, Policy::Reference];
        both.into_iter().filter_map(|policy| check(seed, number % SEARCHED == 0, policy)).collect::<Vec<_>>()
    });
    let (mut tally, mut unread, mut found) = (Tally::default(), 0, Vec::new());
    for (part, sentences, faults) in parts.collect::<Vec<_>>().into_iter().flatten() {
        tally = tally.and(part);
        unread += sentences;
        found.extend(faults);
    }
    _ = writeln!(std::io::stderr(), "{tally}");
    assert_eq!(unread, 0, "sentences about endings that the test does not understand");
    let shown: String = found.into_iter().take(3).map(|fault| shrink::shrunk(fault).to_string()).collect();
    assert!(shown.is_empty(), "{shown}");
    assert!(tally.games.iter().all(|games| *games > all / 3), "{tally}");
    let rare: Vec<_> = KINDS.iter().filter(|kind| !tally.claims.contains_key(*kind)).collect();
    assert!(rare.is_empty(), "no claim of the kinds {rare:?}\n{tally}");
}

/// The kinds of claims that must occur in every run.
const KINDS: [&str; 13] = [
    "a rule never fires",
    "a termination never holds",
    "cannot enter",
    "cannot reach a cell",
    "chance plays no part",
    "endings: these win and lose, and nothing else",
    "no more can be held",
    "nothing can ever end it",
    "nothing happens unless you act",
    "over in the first tick",
    "so many points at most",
    "the game cannot be won",
    "the level cannot be won",
];

/// A game that contains everything that the checks cover.
const ZOO: &str = "\
BasicGame square_size=10
    SpriteSet
        gem > Resource limit=9
        pit > Immovable
        egg > Immovable
        owl > RandomNPC
        cart > Missile orientation=RIGHT
        veil > Immovable hidden=True
        moss > Immovable
        hero > MovingAvatar
        ghost > MovingAvatar
    LevelMapping
        g > gem
        p > pit
        e > egg
        o > owl
        c > cart
        v > veil
        m > moss
        A > hero
    InteractionSet
        gem hero > collectResource scoreChange=1
        egg hero > transformTo stype=pit
        hero veil > transformTo stype=ghost
        cart EOS > stepBack
        hero EOS > stepBack
    TerminationSet
        SpriteCounter stype=egg win=True
        SpriteCounter stype=owl win=False
        Timeout limit=300 win=False
";

/// Each check refutes a false claim, and no check refutes a true claim about the same game.
#[test]
fn false_claims_are_refuted() {
    let case = Case::load(ZOO, "A.gv...\nm.e.c..\n.o...p.\n", Policy::Strict);
    let case = case.unwrap_or_else(|| {
        Case::load(ZOO, "A gv   \nm e c  \n o   p \n", Policy::Strict).expect("the zoo loads")
    });
    let named = |name: &str| case.game.sprite_type(name).expect("a type of the zoo");
    let line = |effect: &str| {
        let lines = &case.game.description().interactions;
        lines.iter().position(|line| line.effect.text == effect).expect("an effect of the zoo")
    };
    let ending =
        |win: bool, when: When| Ending { win, when, kinds: None, provided: Provided::Always, unless: None };
    let seed = Seed::from_text("zoo");
    let keys = [Action::Right, Action::Right, Action::Down, Action::Nil];
    let won = Play::of(&case, seed, &keys);
    assert_eq!(won.frames.last().map(|frame| frame.outcome), Some(Outcome::Won));
    let other =
        Play::of(&case, seed, &[Action::Right, Action::Right, Action::Right, Action::Right, Action::Right]);
    let down = Play::of(&case, seed, &[Action::Down]);
    let cell = |column: usize, row: usize| row * 7 + column;
    let nowhere = |_: SpriteType| vec![false; 21];
    let types: Vec<SpriteType> = case.game.sprite_types().collect();
    let [gem, pit, egg, owl, cart, veil, moss, hero, ghost] =
        ["gem", "pit", "egg", "owl", "cart", "veil", "moss", "hero", "ghost"].map(named);
    let no_egg = || ending(true, When::AtMost(vec![egg], 0));
    let goal = case.analysis.goals().iter().position(|goal| goal.win).expect("a way to win");
    let speed = ZOO.find("scoreChange").expect("a score");
    let lies = [
        (&won, Fact::Endings(vec![ending(false, When::AtMost(vec![egg], 0))], Tie::Open)),
        (&won, Fact::Endings(vec![ending(true, When::AtLeast(vec![gem], 1)), no_egg()], Tie::Open)),
        (&won, Fact::Endings(vec![no_egg(), ending(false, When::AtMost(vec![gem], 0))], Tie::Lost)),
        (&won, Fact::Unattainable(true)),
        (&won, Fact::OutOfReach(true)),
        (&won, Fact::OverAtOnce(None)),
        (&won, Fact::Silent(line("collectResource"))),
        (&won, Fact::HeldAtMost(gem, 0)),
        (&won, Fact::Absent(pit)),
        (&won, Fact::OnlyTypes(vec![hero])),
        (&won, Fact::OnlyMembers(egg, vec![hero])),
        (&won, Fact::NeverMeet(vec![hero], Some(vec![gem]))),
        (&other, Fact::OnlyAvatars(vec![hero])),
        (&won, Fact::Stands(owl)),
        (&won, Fact::Fixed(hero)),
        (&won, Fact::Single(vec![pit])),
        (&won, Fact::OnlyFalls(vec![pit])),
        (&won, Fact::CountAtMost(vec![pit], 1)),
        (&won, Fact::Permanent(vec![(egg, cell(2, 1))])),
        (&won, Fact::GoalNeverHolds(goal)),
        (&won, Fact::NeverAt(hero, cell(1, 0))),
        (&won, Fact::Within(types.iter().map(|&stype| nowhere(stype)).collect())),
        (&won, Fact::ScoreAtMost(0)),
        (&won, Fact::CellsVisited(2)),
        (&down, Fact::CannotEnter(vec![hero], Some(vec![moss]))),
        (&won, Fact::Unseen(gem)),
        (&won, Fact::DeadKeys),
        (&won, Fact::IdleKeys(vec![Action::Down])),
        (&won, Fact::TurnBased),
        (&won, Fact::NoChance),
        (&won, Fact::OthersIdle),
        (&other, Fact::AllShown),
        (&won, Fact::Ignored(speed)),
        (&won, Fact::SearchedInVain),
    ];
    let quiet: Vec<&str> = lies
        .iter()
        .filter(|(play, lie)| lie.refuted_by(&case, play).is_none())
        .map(|(_, lie)| lie.kind())
        .collect();
    assert_eq!(quiet, Vec::<&str>::new(), "these lies are not found");
    let (claims, unread) = read::claims(&case);
    assert_eq!(unread, 0);
    let wrong: Vec<String> = faults(&case, &claims, &[won, other]).iter().map(ToString::to_string).collect();
    assert_eq!(wrong, Vec::<String>::new());
    _ = (cart, veil, ghost);
}

/// False claims about losses and barriers are refuted in games of their own.
#[test]
fn false_claims_about_losses_and_edges_are_refuted() {
    let source = ZOO
        .replace("hero EOS > stepBack", "pit hero > killBoth")
        .replace("SpriteCounter stype=owl", "SpriteCounter stype=pit");
    let case = Case::load(&source, "Ap  g\ne   c\n", Policy::Reference).expect("it loads");
    let [hero, cart] = ["hero", "cart"].map(|name| case.game.sprite_type(name).expect("a type"));
    let lost = Play::of(&case, Seed::from_text("lost"), &[Action::Right, Action::Right]);
    let left = Play::of(&case, Seed::from_text("left"), &[Action::Left, Action::Nil, Action::Nil]);
    for (play, lie) in [
        (&lost, Fact::OverAtOnce(Some(true))),
        (&lost, Fact::OutOfReach(false)),
        (&left, Fact::CannotEnter(vec![hero], None)),
        (&left, Fact::NeverMeet(vec![cart], None)),
    ] {
        assert!(lie.refuted_by(&case, play).is_some(), "{}", lie.kind());
    }
}

/// `newt` is a form of the player beside `palenewt` and `rednewt`, because the bird becomes one. A red newt may enter
/// the reed, although the sentence says that a pale newt and a `newt` cannot.
#[test]
fn a_form_named_after_a_parent_type_means_no_other_form() {
    let source = "\
BasicGame
    SpriteSet
        floor > Immovable
        redpot > Immovable
        reed > Immovable
        newt > MovingAvatar
            palenewt >
            rednewt >
        bird > BirdAvatar
    LevelMapping
        r > floor redpot
        R > floor reed
        p > floor palenewt
        b > floor bird
    InteractionSet
        palenewt reed > stepBack
        palenewt redpot > transformTo stype=rednewt
        bird wall > transformTo stype=newt
    TerminationSet
        Timeout limit=100 win=True
";
    let case = Case::load(source, "Rr\nwp\n", Policy::Reference).expect("it loads");
    let [palenewt, newt, reed] =
        ["palenewt", "newt", "reed"].map(|name| case.game.sprite_type(name).expect("a type"));
    let (claims, _) = read::claims(&case);
    let barrier = claims.iter().find(|claim| claim.text.starts_with("You as palenewt or newt cannot enter"));
    let barrier = barrier.expect("the description names both forms");
    let Fact::CannotEnter(first, second) = &barrier.fact else { panic!("{}", barrier.fact.kind()) };
    assert_eq!((first, second), (&vec![palenewt, newt], &Some(vec![reed])));
    let enters = Play::of(&case, Seed::from_text("enters"), &[Action::Up, Action::Left, Action::Left]);
    assert!(faults(&case, &claims, &[enters]).is_empty());
}
