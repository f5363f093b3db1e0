//! Tests of images of a small board. The images are compared with recorded digests, and read back by
//! independent decoders.

use base::{Digest, Seed};
use engine::{Action, Analysis, Game, Level, State};
use infinite_arcade_render::{self as render, Animation, Glyph, Looks, Painter, RenderError, Style, Symbols};

/// A game with all forms that must remain distinguishable.
const GAME: &str = "
BasicGame
    SpriteSet
        floor > Immovable hidden=True
        wall > Immovable
        hatch > Door color=GREEN
        latch > Door
        pin > Resource limit=1
        plum > Immovable
        thorn > Immovable
        tub > Passive
        drain > Immovable color=DARKBLUE
        newt > RandomNPC cooldown=3
        dart > Missile orientation=LEFT
        marten > MovingAvatar
    LevelMapping
        w > floor wall
        h > floor hatch
        l > floor latch
        p > floor pin
        f > floor plum
        t > floor thorn
        b > floor tub
        d > floor drain
        n > floor newt
        m > floor dart
        A > floor marten
        . > floor
    InteractionSet
        marten wall > stepBack
        newt wall > stepBack
        dart wall > reverseDirection
        tub wall > undoAll
        tub marten > bounceForward
        tub drain > killSprite
        pin marten > collectResource
        latch marten > killIfOtherHasMore resource=pin limit=1
        marten latch > stepBack
        plum marten > killSprite scoreChange=1
        hatch marten > killSprite
        marten thorn newt dart > killSprite
    TerminationSet
        SpriteCounter stype=hatch limit=0 win=True
        SpriteCounter stype=marten limit=0 win=False
";

const LEVEL: &str = "\
wwwwwwwww
wA.b.d.fw
w.t...n.w
wp...m.lw
wwwwwwwhw
";

fn board() -> (Analysis, Level, State) {
    let game = Game::from_source(GAME).unwrap();
    let level = game.level(LEVEL).unwrap();
    let state = game.start(&level, Seed::from_text("pictures"));
    (Analysis::of(&game), level, state)
}

fn pixels(painter: &mut Painter, looks: &Looks, state: &State, style: &Style) -> Digest {
    let image = painter.paint(&render::picture(looks, state, style).unwrap()).unwrap();
    Digest::of(&image.pixels.iter().flat_map(|colour| colour.0).collect::<Vec<u8>>())
}

#[test]
fn every_thing_has_its_own_form() {
    let (analysis, ..) = board();
    let check = |name: &str, expect: Glyph| {
        let stype = analysis.game().sprite_type(name).unwrap();
        assert_eq!(Glyph::of(&analysis, stype), expect, "{name}");
    };
    check("marten", Glyph::Avatar);
    check("wall", Glyph::Wall);
    check("hatch", Glyph::Exit);
    check("latch", Glyph::Gate);
    check("pin", Glyph::Key);
    check("plum", Glyph::Gem);
    check("thorn", Glyph::Hazard);
    check("tub", Glyph::Crate);
    check("drain", Glyph::Slot);
    check("newt", Glyph::Enemy);
    check("dart", Glyph::Charger);
}

#[test]
fn pixels_are_the_same_on_every_machine() {
    let (analysis, _, state) = board();
    let looks = Looks::of(&analysis);
    let style = Style { cell: 24, caption: true, legend: true };
    let mut painter = Painter::new();
    let digest = pixels(&mut painter, &looks, &state, &style);
    assert_eq!(digest.to_string(), "336deec210a384f00361226396978cde4257ba26306e7bf2f211bcd3fa54ce68");
    // The result does not depend on earlier pictures.
    pixels(&mut painter, &looks, &state, &Style::bare(9));
    assert_eq!(pixels(&mut painter, &looks, &state, &style), digest);
}

#[test]
fn the_text_describes_everything() {
    let (analysis, _, mut state) = board();
    let looks = Looks::of(&analysis);
    let symbols = Symbols::of(&analysis, &looks);
    let expect = "\
wwwwwwwww
w..b.d.fw
wAt...n.w
wp...m.lw
wwwwwwwhw

tick 1, score 0
to win: hatch 1 to go

A marten (you)
h hatch (the way to win)
d drain (swallows tub)
n newt (wanders, deadly)
m dart (goes straight on, deadly)
t thorn (deadly)
b tub (can be pushed, lost at drain)
p pin (needed for latch)
f plum (take it for points)
l latch (needs pin)
w wall (blocks the way for good)
";
    analysis.game().step(&mut state, Action::Down);
    assert_eq!(render::text(&looks, &symbols, &state), expect);
}

#[test]
fn a_player_keeps_its_size_in_a_pile() {
    let source = GAME.replace("        . > floor\n", "        . > floor\n        z > floor pin marten\n");
    let game = Game::from_source(&source).unwrap();
    let state = game.start(&game.level("w.z").unwrap(), Seed::from_text("pile"));
    let picture = render::picture(&Looks::of(&Analysis::of(&game)), &state, &Style::bare(40)).unwrap();
    let width = |name: &str| {
        let is_it = |tile: &usize| picture.tiles()[*tile].name.as_deref() == Some(name);
        picture.stamps().iter().find(|stamp| is_it(&stamp.tile)).map(|stamp| stamp.place.w)
    };
    assert_eq!(width("marten"), Some(40.0));
    assert!(width("pin") < Some(20.0), "{:?}", width("pin"));
}

#[test]
fn a_pile_of_one_type_has_a_count() {
    let source = GAME.replace("        . > floor\n", "        . > floor\n        z > floor newt newt newt\n");
    let game = Game::from_source(&source).unwrap();
    let stamps = |level: &str| {
        let state = game.start(&game.level(level).unwrap(), Seed::from_text("count"));
        render::picture(&Looks::of(&Analysis::of(&game)), &state, &Style::bare(40)).unwrap().stamps().len()
    };
    // The extra stamps are two more newts, a plate and a digit.
    assert_eq!(stamps("wAz"), stamps("wAn") + 4);
}

#[test]
fn pictures_of_a_game_are_drawn_but_the_rules_decide_the_meaning() {
    let source = GAME.replace("plum > Immovable", "plum > Immovable img=food/honeyLoaf");
    let game = Game::from_source(&source).unwrap();
    let analysis = Analysis::of(&game);
    let plum = game.sprite_type("plum").unwrap();
    let look = Looks::of(&analysis).look(plum);
    assert_eq!((look.form.name(), look.glyph), ("bread", Glyph::Gem));
    assert_eq!(Looks::of_rules(&analysis).look(plum).form, render::Form::Glyph(Glyph::Gem));
}

#[test]
fn names_of_types_call_for_pictures() {
    #[track_caller]
    fn check(from: &str, to: &str, form: &str) {
        let source = GAME.replace(from, to).replace(&format!("LevelMap{to}g"), "LevelMapping");
        let game = Game::from_source(&source).unwrap();
        let stype = game.sprite_type(to).unwrap();
        assert_eq!(Looks::of(&Analysis::of(&game)).look(stype).form.name(), form, "{to}");
    }

    check("plum", "plum", "apple");
    check("plum", "ripeMushroom", "mushroom");
    check("plum", "zygote", Glyph::Gem.form());
    check("newt", "panda", "bear");
    check("pin", "feather", "feather");
    check("pin", "zygote", Glyph::Key.form());
    check("pin", "wasp", Glyph::Key.form());
}

#[test]
fn what_loses_the_game_by_its_coming_is_not_called_harmless() {
    let source = GAME.replace("plum > Immovable", "plum > Immovable\n        rotten > Immovable")
        + "        SpriteCounterMore stype=rotten limit=1 win=False\n";
    let source =
        source.replace("InteractionSet\n", "InteractionSet\n        plum newt > transformTo stype=rotten\n");
    let game = Game::from_source(&source).unwrap();
    let looks = Looks::of(&Analysis::of(&game));
    assert_eq!(looks.meaning(game.sprite_type("rotten").unwrap()), "one, and you lose");
}

#[test]
fn captions_tell_what_is_left() {
    let source = GAME.replace("limit=1\n        marten latch", "limit=2\n        marten latch");
    let source = source.replace(
        "        newt > ",
        "        den > SpawnPoint stype=dart cooldown=5 total=3\n        newt > ",
    );
    let source = source.replace("        . > floor\n", "        . > floor\n        e > floor den\n");
    let source = source.replace("pin > Resource limit=1", "pin > Resource limit=3")
        + "        Timeout limit=50 win=False\n";
    let game = Game::from_source(&source).unwrap();
    let analysis = Analysis::of(&game);
    let looks = Looks::of(&analysis);
    let mut state = game.start(&game.level(&LEVEL.replace("wp", "we")).unwrap(), Seed::from_text("left"));
    game.step(&mut state, Action::Nil);
    let text = render::text(&looks, &Symbols::of(&analysis, &looks), &state);
    let lines: Vec<&str> = text.lines().skip(6).take(4).collect();
    let expect = [
        "tick 1 (50 left), score 0",
        "holds: pin 0 of 2",
        "to win: hatch 1 to go",
        "soon: den acts in 5 (2 left)",
    ];
    assert_eq!(lines, expect);
}

#[test]
fn captions_tell_timed_changes_and_join_states() {
    let source = GAME.replace("        newt > ", "        redNewt > Immovable\n        newt > ")
        + "        MultiSpriteCounter stype1=newt stype2=redNewt limit=0 win=True\n";
    let timed = "InteractionSet\n        marten TIME > transformToAll stype=newt stypeTo=redNewt timer=9 nextExecution=0\n";
    let game = Game::from_source(&source.replace("InteractionSet\n", timed)).unwrap();
    let analysis = Analysis::of(&game);
    let looks = Looks::of(&analysis);
    let state = game.start(&game.level(LEVEL).unwrap(), Seed::from_text("timed"));
    let text = render::text(&looks, &Symbols::of(&analysis, &looks), &state);
    let lines: Vec<&str> = text.lines().filter(|line| line.contains("newt ")).take(2).collect();
    assert_eq!(lines, ["to win: hatch 1 to go or newt 1 to go", "soon: newt changes in 10"]);
}

#[test]
fn captions_do_not_call_a_loss_a_win() {
    let to_win = |source: &str| {
        let game = Game::from_source(source).unwrap();
        let analysis = Analysis::of(&game);
        let looks = Looks::of(&analysis);
        let state = game.start(&game.level(LEVEL).unwrap(), Seed::from_text("loss"));
        render::text(&looks, &Symbols::of(&analysis, &looks), &state).contains("to win: hatch")
    };
    let lose = "    TerminationSet\n        SpriteCounter stype=hatch limit=0 win=False\n";
    assert!(to_win(GAME) && !to_win(&GAME.replace("    TerminationSet\n", lose)));
}

#[test]
fn svg_is_well_formed_and_names_what_it_shows() {
    let (analysis, _, state) = board();
    let style = Style { cell: 24, caption: true, legend: true };
    let picture = render::picture(&Looks::of(&analysis), &state, &style).unwrap();
    let text = render::svg(&picture);
    assert_eq!(text, render::svg(&picture));
    let document = roxmltree::Document::parse(&text).unwrap();
    let titles: Vec<&str> = document
        .descendants()
        .filter(|node| node.has_tag_name("title"))
        .filter_map(|node| node.text())
        .collect();
    assert!(
        titles.contains(&"marten") && titles.contains(&"wall") && !titles.contains(&"floor"),
        "{titles:?}"
    );
    let uses = document.descendants().filter(|node| node.has_tag_name("use"));
    let tiles = picture.tiles().len();
    for node in uses {
        let tile = node.attribute("href").and_then(|id| id.strip_prefix("#t")).unwrap();
        assert!(tile.parse::<usize>().unwrap() < tiles);
    }
}

#[test]
fn png_has_the_pixels_of_the_picture() {
    let (analysis, _, state) = board();
    let picture = render::picture(&Looks::of(&analysis), &state, &Style::bare(16)).unwrap();
    let image = Painter::new().paint(&picture).unwrap();
    let bytes = render::png(&picture).unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    assert_eq!(pixels, image.pixels.iter().flat_map(|colour| colour.0).collect::<Vec<u8>>());
}

#[test]
fn a_gif_has_a_frame_for_the_start_and_one_for_each_tick() {
    let (analysis, _, mut state) = board();
    let (game, looks) = (analysis.game(), Looks::of(&analysis));
    let style = Style { cell: 16, caption: true, legend: false };
    let draw = |state: &State| render::picture(&looks, state, &style).unwrap();
    let legend = render::picture(&looks, &state, &Style { legend: true, ..style }).unwrap();
    let mut animation = Animation::new(&[draw(&state), legend.clone()], 10).unwrap();
    animation.add(&draw(&state)).unwrap();
    let actions = [Action::Down, Action::Nil, Action::Right, Action::Up, Action::Left];
    for action in actions {
        game.step(&mut state, action);
        animation.add(&draw(&state)).unwrap();
    }
    assert!(matches!(animation.add(&legend), Err(RenderError::Frame { .. })));
    let bytes = animation.finish().unwrap();
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(bytes.as_slice()).unwrap();
    let last = Painter::new().paint(&draw(&state)).unwrap();
    let (mut frames, mut canvas) = (0, vec![[0; 3]; last.pixels.len()]);
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        let [left, top, width] = [frame.left, frame.top, frame.width].map(usize::from);
        for (at, pixel) in frame.buffer.chunks_exact(4).enumerate() {
            let (x, y) = (left + at % width, top + at / width);
            if pixel[3] == 0 {
                continue;
            }
            canvas[y * last.width as usize + x] = [pixel[0], pixel[1], pixel[2]];
        }
        frames += 1;
    }
    // The frames add up to the last image, except for blends that did not fit into the palette.
    for (got, wanted) in canvas.iter().zip(&last.pixels) {
        let off = got.iter().zip(wanted.0).map(|(a, b)| a.abs_diff(b)).max();
        assert!(off <= Some(40), "{got:?} for {wanted:?}");
    }
    let exact = canvas.iter().zip(&last.pixels).filter(|(got, wanted)| **got == wanted.0).count();
    assert!(exact * 10 > canvas.len() * 9, "{exact} of {} pixels", canvas.len());
    assert_eq!(frames, actions.len() + 1);
}

#[test]
fn sheets_hold_boards_and_captions() {
    let (analysis, _, state) = board();
    let board = render::picture(&Looks::of(&analysis), &state, &Style::bare(24)).unwrap();
    let entries: Vec<_> = (0..5).map(|at| (board.clone(), format!("level {at}"))).collect();
    let sheet = render::sheet(&entries, 3, 120).unwrap();
    assert_eq!(sheet.width(), 3 * (120 + 16) + 16);
    // Tiles are shared between the boards.
    assert!(sheet.tiles().len() < board.tiles().len() + 20);
    roxmltree::Document::parse(&render::svg(&sheet)).unwrap();
    assert!(matches!(render::sheet(&entries, 1, 4_000_000_000), Err(RenderError::TooLarge { .. })));
    assert!(render::sheet(&[], 3, 100).is_ok());
}

#[test]
fn sizes_that_cannot_be_are_refused() {
    let (analysis, _, state) = board();
    let picture = |cell| render::picture(&Looks::of(&analysis), &state, &Style::bare(cell));
    assert!(matches!(picture(3), Err(RenderError::Cell { cell: 3 })));
    assert!(matches!(picture(257), Err(RenderError::Cell { cell: 257 })));
    assert!(picture(4).is_ok() && picture(256).is_ok());
}

#[test]
fn the_legend_of_the_docs_is_up_to_date() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/reference/legend.svg");
    let committed = std::fs::read_to_string(file).unwrap();
    let same = committed == render::svg(&render::gallery(3));
    assert!(
        same,
        "docs/reference/legend.svg is old: cargo run -p infinite-arcade-render --example legend writes it"
    );
}

#[test]
fn the_page_names_every_form() {
    let page =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/reference/rendering.md"))
            .unwrap();
    for glyph in Glyph::ALL {
        let row = format!("| {} | {} |", glyph.form(), glyph.meaning());
        assert!(page.contains(&row), "docs/reference/rendering.md has no row `{row}`");
    }
}

/// A sign and a set of (railway) points beside it both show their direction, on boards and in observations.
/// Points that have been turned show the new direction.
#[test]
fn signs_point_as_they_are_set() {
    let source = |ways: [&str; 2]| {
        format!(
            "BasicGame\n  SpriteSet\n    floor > Immovable hidden=True\n    sign > Immovable orientation={} color=RED\n    points > Missile speed=0 orientation={} \
             color=BLUE\n    cart > Missile orientation=RIGHT\n    avatar > MovingAvatar\n  LevelMapping\n    . > floor\n    s > sign\n    p > points\n    \
             c > cart\n  InteractionSet\n    cart sign points > attractGaze\n    points avatar > reverseDirection\n    \
             avatar cart > killSprite\n  TerminationSet\n    Timeout limit=9 win=True\n",
            ways[0], ways[1]
        )
    };
    let drawn = |ways: [&str; 2], actions: [Action; 2]| {
        let game = Game::from_source(&source(ways)).unwrap();
        let level = game.level("Ap..\n...s\nc...\n").unwrap();
        let mut state = game.start(&level, Seed::from_text("signs"));
        let looks = Looks::of(&Analysis::of(&game));
        for action in actions {
            game.step(&mut state, action);
        }
        let board = render::svg(&render::picture(&looks, &state, &Style::bare(16)).unwrap());
        let seen = render::svg(&render::observed(&looks, &game.observe(&state), &Style::bare(16)).unwrap());
        (board, seen)
    };
    let (board, seen) = drawn(["UP", "LEFT"], [Action::Nil; 2]);
    for ways in [["DOWN", "LEFT"], ["UP", "RIGHT"]] {
        let (other, other_seen) = drawn(ways, [Action::Nil; 2]);
        assert!(board != other && seen != other_seen, "{ways:?}");
    }
    // The avatar steps on the points and away again, so that nothing covers them.
    let turned = drawn(["UP", "LEFT"], [Action::Right, Action::Left]);
    assert_eq!(turned, drawn(["UP", "RIGHT"], [Action::Nil; 2]));
}

/// Forms follow the rules, not only the class:
///
/// - A flood is dammed and not filled.
/// - Vanes and boards turn whatever comes to them.
/// - A conveyor that carries nothing is an ordinary thing.
/// - A pond gives something.
/// - A lever changes other things.
#[test]
fn forms_follow_the_rules() {
    let source = GAME
        .replace(
            "    LevelMapping\n",
            "        spring > Spreader stype=flood limit=90\n        flood > Immovable\n        vane > Conveyor orientation=UP\n        \
                belt > Conveyor\n        mat > Conveyor\n        board > Passive orientation=UP\n        pond > Immovable\n        bead > Resource limit=9\n        \
                lever > Immovable\n        shell > Immovable\n    LevelMapping\n        s > floor spring\n        v > floor vane\n        \
                z > floor belt\n        y > floor mat\n        o > floor board\n        q > floor pond\n        x > floor lever\n",
        )
        .replace(
            "    TerminationSet\n",
            "        flood tub > killSprite\n        marten flood > killSprite\n        dart vane > align\n        \
                newt belt > pullWithIt\n        newt mat > reverseDirection\n        board marten > bounceForward\n        \
                dart board > align\n        marten pond > changeResource resource=bead value=1\n        marten pond > stepBack\n        \
                lever marten > decreaseSpeedToAll stype=newt value=0.4\n        lever marten > killSprite scoreChange=1\n        \
                plum newt > transformTo stype=shell\n    TerminationSet\n        SpriteCounterMore stype=shell limit=2 win=False\n        \
                MultiSpriteCounter stype1=newt limit=3 win=False\n",
        );
    let analysis = Analysis::of(&Game::from_source(&source).unwrap());
    let glyph = |name: &str| Glyph::of(&analysis, analysis.game().sprite_type(name).unwrap());
    let found = ["flood", "drain", "vane", "belt", "mat"].map(glyph);
    assert_eq!(found, [Glyph::Hazard, Glyph::Slot, Glyph::Sign, Glyph::Conveyor, Glyph::Neutral]);
    assert_eq!(["board", "pond", "lever"].map(glyph), [Glyph::Pointer, Glyph::Spring, Glyph::Switch]);
    let looks = Looks::of(&analysis);
    let meaning = |name: &str| looks.meaning(analysis.game().sprite_type(name).unwrap());
    assert_eq!(
        ["pond", "lever", "shell", "newt"].map(meaning),
        ["gives bead", "touch it to change newt", "2, and you lose", "only 3, and you lose, deadly"]
    );
}

#[test]
fn legends_tell_what_others_are_brought_to() {
    let source = GAME
        .replace("hatch marten > killSprite", "newt hatch > killSprite")
        .replace("tub drain > killSprite", "plum newt > transformToAll stype=latch stypeTo=floor")
        .replace("plum marten > killSprite scoreChange=1", "newt marten > reverseDirection")
        .replace("stype=hatch limit=0", "stype=newt limit=0")
        .replace("latch marten > killIfOtherHasMore resource=pin limit=1\n", "\n")
        .replace("marten thorn newt dart > killSprite", "marten thorn dart > killSprite");
    let game = Game::from_source(&source).unwrap();
    let looks = Looks::of(&Analysis::of(&game));
    let meaning = |name: &str| looks.meaning(game.sprite_type(name).unwrap());
    assert_eq!(
        ["hatch", "plum", "latch", "wall"].map(meaning),
        ["bring newt here to win", "newt here changes latch", "opened by plum", "blocks the way for good"]
    );

    let source = source.replace("plum newt > transformToAll", "marten plum > transformToAll");
    let game = Game::from_source(&source).unwrap();
    let looks = Looks::of(&Analysis::of(&game));
    assert_eq!(looks.meaning(game.sprite_type("latch").unwrap()), "opened by plum", "not by the player");
}

#[test]
fn legends_tell_states_apart() {
    let source = "BasicGame
  SpriteSet
    floor > Immovable
    pad > Immovable
    scrap > Immovable
    cord > Immovable
    tub > Passive
    fuse > Immovable
    grille > Immovable
    opened > Immovable
    stool > Immovable
    broken > Immovable
    airlock > Door
    exit > Immovable
    glue > Flicker limit=9
    marten > MovingAvatar
  LevelMapping
    p > floor pad
    c > floor cord
    t > floor tub
    g > floor grille
    s > floor stool
    a > floor airlock
    m > floor marten
    l > floor glue
  InteractionSet
    pad marten > addTimer timer=25 ftype=transformToAll stype=scrap stypeTo=pad
    pad marten > transformTo stype=scrap
    cord marten > transformToAll stype=tub stypeTo=fuse
    grille marten > transformIfCount stypeCount=fuse leq=0 stype=opened
    tub marten > bounceForward
    stool fuse > transformTo stype=broken
    airlock marten > transformTo stype=exit
    marten scrap cord grille glue stool > stepBack
  TerminationSet
    SpriteCounter stype=airlock win=True
    MultiSpriteCounter stype1=tub stype2=fuse stype3=broken win=False
";
    let game = Game::from_source(source).unwrap();
    let looks = Looks::of(&Analysis::of(&game));
    let meaning = |name: &str| looks.meaning(game.sprite_type(name).unwrap());
    let meanings = [
        ("scrap", "solid for a while"),
        ("cord", "touch it to change tub"),
        ("grille", "solid as it is"),
        ("opened", "was grille"),
        ("broken", "was stool"),
        ("exit", "was airlock"),
        ("glue", "solid for a while"),
    ];
    for (name, expected) in meanings {
        assert_eq!(meaning(name), expected, "{name}");
    }

    let source = source
        .replace("  LevelMapping\n", "    kid > Missile cooldown=2\n    lost > Immovable\n  LevelMapping\n    k > floor kid\n")
        .replace("  TerminationSet\n", "    kid tub > transformTo stype=lost\n  TerminationSet\n    SpriteCounterMore stype=lost limit=1 win=False\n");
    let game = Game::from_source(&source).unwrap();
    let looks = Looks::of(&Analysis::of(&game));
    assert_eq!(looks.meaning(game.sprite_type("kid").unwrap()), "goes straight on, keep it safe");
}
