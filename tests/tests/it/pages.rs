//! The pages of the reference manual are tests: `docs/reference/ontology/` (one page per VGDL class) and `docs/reference/diagnostics/` (one
//! page per diagnostic code).
//!
//! A page is prose around fenced blocks, which run from top to bottom:
//!
//! - `vgdl` is a game, and `level` is a level of the preceding game. `level seed=7` starts the level's episode from
//!   that seed instead of the default 0. Games are loaded strictly, except that a game in a `vgdl as-reference` block
//!   is loaded as the reference does.
//! - `actions` plays actions, such as `right use*3 nil`.
//! - `expect` states the results, such as `tick 2, score 1, won`. Facts about a type's oldest sprite may follow, such
//!   as `key: count 2; at 3,1; facing left; speed 0.5; health 2; size 1x1; holds coin 3` (in cells). The board in level
//!   characters may follow last. A cell shows the character that places exactly the cell's sprites, or otherwise its
//!   topmost sprite.
//! - `diagnostics` lists the problems in the block above it, each with line and column. Without a `diagnostics` block,
//!   there must be no problems, except that examples need not specify how they are won and lost.
//!
//! `BLESS=1 cargo test -p infinite-arcade-tests --test it pages` writes the actual results into the `expect` and
//! `diagnostics` blocks. It also fills in a value of `?` in a fact, and a board that consists of a single `?`. Review
//! the diff before accepting it.

use engine::{Action, Chance, Diagnostic, Game, Level, Outcome, Severity, SpriteClass, SpriteRecord, State};
use pulldown_cmark::{CodeBlockKind, Event, Parser, Tag, TagEnd};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::fs;
use std::ops::Range;
use std::path::Path;
use tests::{read, rust_files, workspace_files, workspace_root};

#[test]
fn every_page_matches_its_game() {
    let bless = std::env::var_os("BLESS").is_some();
    let mut failures = String::new();
    for file in pages("docs/reference/ontology").chain(pages("docs/reference/diagnostics")) {
        let text = read(&file);
        match run(&text) {
            Ok(out) if out == text => {}
            Ok(out) if bless => fs::write(workspace_root().join(&file), out).unwrap(),
            Ok(out) => write!(
                failures,
                "{file}: what happens is not what the page says\n{}",
                first_difference(&text, &out)
            )
            .unwrap(),
            Err(problem) => writeln!(failures, "{file}:{problem}").unwrap(),
        }
    }
    assert!(failures.is_empty(), "\n{failures}");
}

#[test]
fn every_class_has_a_page() {
    let mut problems = String::new();
    let classes = SpriteClass::ALL.iter().map(|class| ("sprites", class.name()));
    let effects = engine::EFFECTS.iter().map(|&name| ("effects", name));
    let terminations = engine::TERMINATIONS.iter().map(|&name| ("terminations", name));
    let all: Vec<(&str, &str)> = classes.chain(effects).chain(terminations).collect();
    for (folder, name) in &all {
        let file = format!("docs/reference/ontology/{folder}/{name}.md");
        if !workspace_root().join(&file).is_file() {
            writeln!(problems, "{file}: missing").unwrap();
            continue;
        }
        let text = read(&file);
        if !text.starts_with(&format!("# {name}\n")) {
            writeln!(problems, "{file}: does not start with `# {name}`").unwrap();
        }
        if !text.contains("```expect\n") {
            writeln!(problems, "{file}: runs no example").unwrap();
        }
        if !games(&text)
            .any(|game| game.contains(&format!("> {name}")) || game.contains(&format!(" {name} ")))
        {
            writeln!(problems, "{file}: no game in it uses {name}").unwrap();
        }
        if let Some(class) = SpriteClass::from_name(name) {
            for parameter in class.own_parameters().iter().filter(|own| !text.contains(&format!("`{own}`"))) {
                writeln!(problems, "{file}: says nothing of `{parameter}`").unwrap();
            }
        }
    }
    for file in pages("docs/reference/ontology") {
        let known =
            |(folder, name): &(&str, &str)| file == format!("docs/reference/ontology/{folder}/{name}.md");
        if !file.ends_with("README.md") && !all.iter().any(known) {
            writeln!(problems, "{file}: there is no such class").unwrap();
        }
    }
    assert!(problems.is_empty(), "\n{problems}");
}

#[test]
fn every_diagnostic_code_has_a_page() {
    let mut problems = String::new();
    let codes = codes();
    for code in &codes {
        let file = format!("docs/reference/diagnostics/{code}.md");
        if !workspace_root().join(&file).is_file() {
            writeln!(problems, "{file}: missing").unwrap();
            continue;
        }
        let page = read(&file);
        if !page.starts_with(&format!("# {code}\n")) {
            writeln!(problems, "{file}: does not start with `# {code}`").unwrap();
        }
        if !page.contains(&shown(code)) {
            writeln!(problems, "{file}: no example shows the code as {}", shown(code)).unwrap();
        }
        if repaired(&page).iter().any(|problem| problem.code == code) {
            writeln!(problems, "{file}: the last block still has the problem").unwrap();
        }
    }
    for file in pages("docs/reference/diagnostics").filter(|file| !file.ends_with("README.md")) {
        let code = Path::new(&file).file_stem().unwrap().to_string_lossy().into_owned();
        if !codes.contains(&code) {
            writeln!(problems, "{file}: there is no such code").unwrap();
        }
    }
    let index = read("docs/reference/diagnostics/README.md");
    for code in codes.iter().filter(|code| !index.contains(&format!("({code}.md)"))) {
        writeln!(problems, "docs/reference/diagnostics/README.md: does not list {code}").unwrap();
    }
    assert!(problems.is_empty(), "\n{problems}");
}

/// Returns the output that a code's page must show: the code in a list of problems, or the whole output for a
/// file created by the test if no small example causes the problem.
fn shown(code: &str) -> String {
    let source = match code {
        "not-text" => "BasicGame\u{7}\n".to_owned(),
        "too-deep" => (0..40).fold("BasicGame\n SpriteSet\n".to_owned(), |text, depth| {
            format!("{text}  {}s{depth} > Immovable\n", " ".repeat(depth))
        }),
        "too-many-problems" => {
            let lines = "  wall avatar\n".repeat(150);
            format!("BasicGame\n SpriteSet\n LevelMapping\n InteractionSet\n{lines} TerminationSet\n")
        }
        _ => return format!("[{code}]: "),
    };
    let problems = problems_of(&source);
    let own = problems.iter().filter(|problem| problem.code == code);
    own.map(|problem| rendered(&source, problem)).collect()
}

/// Returns the problems in a page's last game or level.
fn repaired(page: &str) -> Vec<Diagnostic> {
    let blocks = blocks(page);
    let games = blocks.iter().rfind(|block| block.info == "vgdl");
    let game = games.and_then(|block| Game::from_source(&block.text).ok());
    let last = blocks.iter().rfind(|block| block.info.starts_with("vgdl") || block.info.starts_with("level"));
    last.map_or(Vec::new(), |block| block.problems(game.as_ref()))
}

/// Returns the codes in the engine's source. A code is either the first argument of a problem's constructor,
/// or in a statement `let code = …;` above the constructor.
fn codes() -> BTreeSet<String> {
    let mut codes = BTreeSet::new();
    for (file, text) in rust_files().into_iter().filter(|(file, _)| file.starts_with("engine/src")) {
        for call in ["Diagnostic::error(", "Diagnostic::warning("] {
            for (at, _) in text.match_indices(call) {
                let argument = text[at + call.len()..].trim_start();
                let written = argument.split(',').next().unwrap_or_default();
                if written == "code" && file.ends_with("diagnostic/mod.rs") {
                    continue;
                }
                let above = text[..at].rsplit("let code = ").next().unwrap_or_default();
                let from = if written == "code" { above.split(';').next() } else { Some(written) };
                let literals: Vec<&str> = from.unwrap_or_default().split('"').skip(1).step_by(2).collect();
                assert!(!literals.is_empty(), "{}: which code is `{written}`?", file.display());
                codes.extend(literals.into_iter().map(str::to_owned));
            }
        }
    }
    codes
}

fn pages(folder: &'static str) -> impl Iterator<Item = String> {
    let files = workspace_files().into_iter().map(|file| file.to_string_lossy().replace('\\', "/"));
    files.filter(move |file| file.starts_with(folder) && file.ends_with(".md"))
}

/// Returns the games that load strictly and the levels on a folder's pages. Each item consists of the page,
/// the game, and the level, if any.
pub(crate) fn examples(folder: &'static str) -> Vec<(String, String, Option<String>)> {
    let mut examples = Vec::new();
    for page in pages(folder) {
        let mut game = String::new();
        for block in blocks(&read(&page)) {
            if block.info == "vgdl" {
                game.clone_from(&block.text);
                examples.push((page.clone(), block.text, None));
            } else if block.info.starts_with("level") {
                examples.push((page.clone(), game.clone(), Some(block.text)));
            }
        }
    }
    examples
}

fn games(page: &str) -> impl Iterator<Item = &str> {
    page.split("```vgdl").skip(1).filter_map(|rest| rest.split("```").next())
}

/// Returns the first line that differs, as stated and as it actually is.
fn first_difference(said: &str, is: &str) -> String {
    let at = said
        .lines()
        .zip(is.lines())
        .position(|(a, b)| a != b)
        .unwrap_or(said.lines().count().min(is.lines().count()));
    let line = |text: &str| text.lines().nth(at).unwrap_or("").to_owned();
    format!("  line {}\n  said: {}\n  is:   {}\n", at + 1, line(said), line(is))
}

/// A fenced block, with its info string, its text and its position.
struct Block {
    info: String,
    text: String,
    at: Range<usize>,
}

impl Block {
    /// Returns the problems in the block. A level is checked against `game`.
    fn problems(&self, game: Option<&Game>) -> Vec<Diagnostic> {
        match (self.info.as_str(), game) {
            ("vgdl as-reference", _) => {
                Game::from_source_as_reference(&self.text).map_or_else(|problems| problems.0, |_| Vec::new())
            }
            ("vgdl", _) => problems_of(&self.text),
            (info, Some(game)) if info.starts_with("level") => level_problems(game, &self.text),
            _ => Vec::new(),
        }
    }
}

fn blocks(page: &str) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    let mut open = false;
    for (event, range) in Parser::new(page).into_offset_iter() {
        match event {
            Event::Start(Tag::CodeBlock(CodeBlockKind::Fenced(info))) => {
                let first = range.start + page[range.start..].find('\n').map_or(0, |end| end + 1);
                blocks.push(Block { info: info.to_string(), text: String::new(), at: first..first });
                open = true;
            }
            Event::End(TagEnd::CodeBlock) => open = false,
            Event::Text(text) if open => {
                let block = blocks.last_mut().expect("a block is open");
                block.text.push_str(&text);
                block.at.end = range.end;
            }
            _ => {}
        }
    }
    blocks
}

/// The state of running a page: the games and levels loaded, and the actions played.
#[derive(Default)]
struct Bench {
    game: Option<Game>,
    level: Option<Level>,
    state: Option<State>,
}

/// Returns the page with the actual results in its `expect` and `diagnostics` blocks.
fn run(page: &str) -> Result<String, String> {
    let mut bench = Bench::default();
    let mut out = String::new();
    let mut written = 0;
    let blocks = blocks(page);
    for (number, block) in blocks.iter().enumerate() {
        let line = page[..block.at.start].matches('\n').count() + 1;
        let fail = |problem: String| format!("{line}: {problem}");
        let told = blocks.get(number + 1).is_some_and(|next| next.info == "diagnostics");
        let mut words = block.info.split_whitespace();
        let answer = match words.next() {
            Some("vgdl") => {
                let problems = bench.load(&block.text, words.next() == Some("as-reference"));
                expect_none(&block.text, &problems, told).map_err(fail)?
            }
            Some("level") => {
                let seed = words.next().and_then(|word| word.strip_prefix("seed="));
                let seed = seed.map_or(Ok(0), str::parse).map_err(|error| fail(format!("seed: {error}")))?;
                let problems = bench.start(&block.text, seed).map_err(fail)?;
                expect_none(&block.text, &problems, told).map_err(fail)?
            }
            Some("actions") => bench.play(&block.text).map(|()| None).map_err(fail)?,
            Some("expect") => Some(bench.report(&block.text).map_err(fail)?),
            Some("diagnostics") => {
                let above = &blocks[number.checked_sub(1).ok_or_else(|| fail("nothing above".into()))?];
                let problems = above.problems(bench.game.as_ref());
                Some(problems.iter().map(|problem| rendered(&above.text, problem)).collect())
            }
            _ => None,
        };
        if let Some(answer) = answer {
            out.push_str(&page[written..block.at.start]);
            out.push_str(&answer);
            written = block.at.end;
        }
    }
    out.push_str(&page[written..]);
    Ok(out)
}

fn expect_none(source: &str, problems: &[Diagnostic], told: bool) -> Result<Option<String>, String> {
    // An example need not be a complete game.
    let of_parts = |problem: &&Diagnostic| !["no-win", "no-lose"].contains(&problem.code);
    let text: String = problems.iter().filter(of_parts).map(|problem| rendered(source, problem)).collect();
    if told || text.is_empty() { Ok(None) } else { Err(text) }
}

fn problems_of(source: &str) -> Vec<Diagnostic> {
    Game::from_source(source).map_or_else(|problems| problems.0, |game| game.warnings().to_vec())
}

fn level_problems(game: &Game, text: &str) -> Vec<Diagnostic> {
    game.level(text).map_or_else(|problems| problems.0, |level| level.warnings().to_vec())
}

fn rendered(source: &str, problem: &Diagnostic) -> String {
    let (line, column) = engine::line_and_column(source, problem.span.start);
    let severity = if problem.severity == Severity::Error { "error" } else { "warning" };
    let mut text = format!("{line}:{column} {severity}[{}]: {}\n", problem.code, problem.message);
    if let Some(help) = &problem.help {
        writeln!(text, "    help: {help}").unwrap();
    }
    text
}

impl Bench {
    fn load(&mut self, source: &str, as_reference: bool) -> Vec<Diagnostic> {
        *self = Bench::default();
        if as_reference {
            match Game::from_source_as_reference(source) {
                Ok(game) => self.game = Some(game),
                Err(problems) => return problems.0,
            }
            return Vec::new();
        }
        self.game = Game::from_source(source).ok();
        problems_of(source)
    }

    fn start(&mut self, text: &str, seed: i64) -> Result<Vec<Diagnostic>, String> {
        let game = self.game.as_ref().ok_or("a level without a game")?;
        let level = game.level(text).ok();
        self.state = level.as_ref().map(|level| game.start_with(level, Chance::from_java(seed)));
        self.level = level;
        Ok(level_problems(game, text))
    }

    fn play(&mut self, text: &str) -> Result<(), String> {
        let (Some(game), Some(state)) = (&self.game, &mut self.state) else {
            return Err("actions without a level".into());
        };
        for word in text.split_whitespace() {
            let (name, times) = word.split_once('*').unwrap_or((word, "1"));
            let action = Action::ALL.into_iter().find(|action| action.to_string() == name);
            let action = action.ok_or_else(|| format!("no action named `{name}`"))?;
            let times: u32 = times.parse().map_err(|_| format!("`{word}`: how many times?"))?;
            for _ in 0..times {
                game.step(state, action);
            }
        }
        Ok(())
    }

    /// Returns the correct `expect` block with the requested facts.
    fn report(&self, said: &str) -> Result<String, String> {
        let (Some(game), Some(state)) = (&self.game, &self.state) else {
            return Err("expect without a level".into());
        };
        let ticks = game.observe(state).ticks;
        let outcome = match state.outcome() {
            Outcome::Stopped(limit) => format!("stopped: {limit}"),
            outcome => format!("{outcome:?}").to_lowercase(),
        };
        let mut text = format!("tick {ticks}, score {}, {outcome}\n", state.score());
        let mut rest = said.lines().skip(1).peekable();
        let about =
            |line: &&str| line.split_once(": ").and_then(|(name, _)| game.sprite_type(name)).is_some();
        while let Some(line) = rest.next_if(about) {
            let (name, facts) = line.split_once(": ").expect("it is about a sprite type");
            let answers = facts.split("; ").map(|asked| fact(game, state, name, asked));
            let answers = answers.collect::<Result<Vec<String>, String>>()?;
            writeln!(text, "{name}: {}", answers.join("; ")).unwrap();
        }
        if rest.next().is_some() {
            text.push_str(&board(game, state));
        }
        Ok(text)
    }
}

/// Returns one fact about the oldest sprite of a type.
fn fact(game: &Game, state: &State, name: &str, asked: &str) -> Result<String, String> {
    let stype = game.sprite_type(name).ok_or_else(|| format!("no sprite named `{name}`"))?;
    let records = game.records(state);
    let mut all = records.iter().filter(|record| record.stype == stype.0);
    let key = asked.split(' ').next().unwrap_or_default();
    if key == "count" {
        return Ok(format!("count {}", all.count()));
    }
    let Some(sprite) = all.next() else { return Ok(format!("{key} ? (there is no {name})")) };
    let cells = |pixels: i32| f64::from(pixels) / f64::from(state.block());
    let (x, y) = sprite.orientation;
    Ok(match key {
        "at" => format!("at {},{}", cells(sprite.rect.x), cells(sprite.rect.y)),
        "size" => format!("size {}x{}", cells(sprite.rect.w), cells(sprite.rect.h)),
        "facing" => match (x, y) {
            (0.0, 0.0) => "facing nowhere".to_owned(),
            (1.0, 0.0) => "facing right".to_owned(),
            (-1.0, 0.0) => "facing left".to_owned(),
            (0.0, 1.0) => "facing down".to_owned(),
            (0.0, -1.0) => "facing up".to_owned(),
            _ => format!("facing {x:.3},{y:.3}"),
        },
        "speed" => format!("speed {}", sprite.speed),
        "health" => format!("health {}", sprite.health),
        "holds" => {
            let resource = asked.split(' ').nth(1).ok_or("holds what?")?;
            format!("holds {resource} {}", held(game, sprite, resource)?)
        }
        _ => return Err(format!("`{asked}`: no such fact")),
    })
}

fn held(game: &Game, sprite: &SpriteRecord, resource: &str) -> Result<i32, String> {
    let stype = game.sprite_type(resource).ok_or_else(|| format!("no resource named `{resource}`"))?;
    Ok(sprite.resources.iter().find(|(held, _)| *held == stype.0).map_or(0, |&(_, amount)| amount))
}

/// Returns the board, written in level characters.
fn board(game: &Game, state: &State) -> String {
    let seen = game.observe(state);
    let mut text = String::new();
    for row in seen.cells.chunks(seen.columns) {
        let line: String = row.iter().map(|names| symbol(game, names)).collect();
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

fn symbol(game: &Game, names: &[String]) -> char {
    let Some(top) = names.last() else { return ' ' };
    let placing = |wanted: &[String]| {
        let mut wanted: Vec<&str> = wanted.iter().map(String::as_str).collect();
        wanted.sort_unstable();
        let mut lines = game.description().mapping.iter().rev();
        let line = lines.find(|line| {
            let mut placed: Vec<&str> = line.names.iter().map(|name| name.text.as_str()).collect();
            placed.sort_unstable();
            placed == wanted
        });
        line.map(|line| line.symbol)
    };
    let built_in = match top.as_str() {
        "wall" => Some('w'),
        "avatar" => Some('A'),
        _ => None,
    };
    placing(names).or_else(|| placing(std::slice::from_ref(top))).or(built_in).unwrap_or('?')
}
