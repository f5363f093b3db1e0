//! Properties that must hold for any input. Each check takes bytes from any source. A fuzz target in
//! `tools/fuzz/`, or a short run in `tests/tests/it/robustness.rs`, is a single call to a check.
//!
//! - [`text`]: any text either compiles or yields diagnostics, and prints canonically.
//! - [`level`]: any text is either a level of a valid game or yields diagnostics.
//! - [`play`]: any actions on any valid game and level leave a sound state behind, tick after tick.

use crate::any_game::any_game;
use crate::choices::{Choices, random_bytes};
use crate::{read, workspace_root};
use base::{Sampler, Seed};
use engine::analysis::{Analysis, StateAbstraction};
use engine::syntax::{self, Description, InteractionLine, Param, Section, SpriteLine, Word};
use engine::{
    Action, Description as Tree, Diagnostic, Diagnostics, EFFECTS, Episode, Game, Level, Limit, MAX_TICKS,
    Outcome, SearchKey, Severity, Span, SpriteClass, State, Watch,
};
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// The coverage of a check.
#[derive(Clone, Copy, Debug, Default)]
pub struct Seen {
    /// The number of ticks played.
    pub ticks: usize,
    /// The number of pairs of distinct states with equal search keys whose futures were compared.
    pub merged: usize,
    /// The executed effects, one bit per effect, in [`EFFECTS`] order.
    pub effects: u64,
    /// The classes of the sprites that occurred, one bit per class, in [`SpriteClass::ALL`] order.
    pub classes: u64,
}

impl Seen {
    /// Adds another check's coverage.
    pub fn and(self, other: Seen) -> Seen {
        Seen {
            ticks: self.ticks + other.ticks,
            merged: self.merged + other.merged,
            effects: self.effects | other.effects,
            classes: self.classes | other.classes,
        }
    }
}

/// The corpus games, each as its text and the texts of its levels.
static CORPUS: LazyLock<Vec<(String, Vec<String>)>> = LazyLock::new(|| {
    let folders = workspace_root().join("corpora").read_dir().expect("the corpus can be read");
    let mut folders: Vec<_> = folders.map(|entry| entry.expect("the corpus can be read").path()).collect();
    folders.sort();
    let load = |folder: &std::path::PathBuf| {
        let levels =
            (0..).map(|number| folder.join(format!("lvl{number}.txt"))).take_while(|file| file.exists());
        (read(folder.join("game.vgdl")), levels.map(read).collect())
    };
    folders.iter().map(load).collect()
});

/// Checks a text as a game. Parsing and compiling any text, both strictly and as in the reference, may fail
/// only with diagnostics. Diagnostics must point into the text, and a text without problems must print
/// canonically.
pub fn text(bytes: &[u8]) {
    let source = String::from_utf8_lossy(bytes);
    let (description, problems) = syntax::parse(&source);
    check_diagnostics(&source, &problems);
    let _ = Game::compile(&description);
    if !Diagnostics::has_errors(&problems) {
        check_print(&source, &description);
    }
    for loaded in [Game::from_source(&source), Game::from_source_as_reference(&source)] {
        match loaded {
            Err(problems) => {
                assert!(Diagnostics::has_errors(&problems.0), "refused without an error");
                check_diagnostics(&source, &problems.0);
            }
            Ok(game) => {
                check_diagnostics(&source, game.warnings());
                // A one-row level with all types that a level can place.
                let everything: String =
                    (33..127u8).filter(|&c| !game.places(c).is_empty()).map(char::from).collect();
                for level in [everything.as_str(), "A"] {
                    if let Ok(level) = game.level(level) {
                        Walk::new(&game, &level, Seed::from_text("text")).random_walk(3);
                    }
                }
            }
        }
    }
}

/// Checks that spans lie within the text and on character boundaries, and that problems have messages and are
/// sorted by position.
fn check_diagnostics(source: &str, problems: &[Diagnostic]) {
    for Diagnostic { code, message, span, severity, .. } in problems {
        let Span { start, end } = *span;
        assert!(source.get(start..end).is_some(), "{code} at {start}..{end} of {}", source.len());
        assert!(!code.is_empty() && !message.is_empty(), "{code}: {message}");
        assert!(matches!(severity, Severity::Error | Severity::Warning));
    }
    assert!(problems.is_sorted_by_key(|problem| problem.span), "sorted by place: {problems:?}");
}

/// Checks that parsing inverts printing, that printing is idempotent, and that comments are preserved.
fn check_print(source: &str, description: &Description) {
    let printed = syntax::print(description);
    if printed.len() > engine::MAX_SOURCE {
        return;
    }
    let (again, problems) = syntax::parse(&printed);
    assert!(!Diagnostics::has_errors(&problems), "{problems:?}\n{printed}");
    assert_eq!(bare(again.clone()), bare(description.clone()), "\n{printed}");
    assert_eq!(syntax::print(&again), printed);
    assert_eq!(comments(&printed), comments(source));
}

/// Returns the comments in a text, sorted, because sections may be reordered.
fn comments(text: &str) -> Vec<&str> {
    let lines = text.split(['\n', '\r']).filter_map(|line| line.split_once('#'));
    let mut comments: Vec<&str> = lines.map(|(_, comment)| comment.trim()).collect();
    comments.sort_unstable();
    comments
}

/// Returns a description without its positions, and with its sections in canonical order.
fn bare(mut description: Description) -> Description {
    fn word(word: &mut Word) {
        word.span = Span::default();
    }
    fn params(params: &mut [Param]) {
        for param in params {
            word(&mut param.key);
            word(&mut param.value);
        }
    }
    fn sprites(lines: &mut [SpriteLine]) {
        for line in lines {
            word(&mut line.name);
            line.class.iter_mut().for_each(word);
            params(&mut line.params);
            sprites(&mut line.children);
        }
    }
    let Tree { header, parameters, sprites: forest, mapping, interactions, terminations, order, .. } =
        &mut description;
    word(&mut header.class);
    params(&mut header.params);
    for line in parameters {
        word(&mut line.name);
        params(&mut line.params);
    }
    sprites(forest);
    for line in mapping {
        line.span = Span::default();
        line.names.iter_mut().for_each(word);
    }
    for InteractionLine { first, second, effect, params: given, .. } in interactions {
        word(first);
        second.iter_mut().for_each(word);
        word(effect);
        params(given);
    }
    for line in terminations {
        word(&mut line.class);
        params(&mut line.params);
    }
    order.sort_by_key(|(section, _)| Section::ALL.iter().position(|other| other == section));
    description
}

/// Checks bytes as a level. Any bytes must either be a level of a valid game or be rejected with reasons. A
/// level must print unchanged and be playable.
pub fn level(bytes: &[u8]) -> Seen {
    let mut choices = Choices::new(bytes);
    let which = choices.below(2 * CORPUS.len());
    let source = match CORPUS.get(which) {
        Some((source, _)) => source.clone(),
        None => {
            let mut sampler = Seed::from_text("level").child("game", choices.below(1 << 16) as u64).sampler();
            any_game(&mut Choices::new(&random_bytes(&mut sampler, 300))).source
        }
    };
    let text = String::from_utf8_lossy(choices.rest());
    let mut seen = Seen::default();
    for game in [Game::from_source(&source), Game::from_source_as_reference(&source)].into_iter().flatten() {
        match game.level(&text) {
            Err(problems) => {
                assert!(Diagnostics::has_errors(&problems.0), "refused without an error");
                check_diagnostics(&text, &problems.0);
            }
            Ok(level) => {
                check_diagnostics(&text, level.warnings());
                let printed = level.to_string();
                let again = game.level(&printed).expect("a canonical level is a level");
                assert_eq!((again.digest(), again.cells()), (level.digest(), level.cells()), "\n{printed}");
                let mut walk = Walk::new(&game, &level, Seed::from_text("level"));
                walk.random_walk(8);
                seen = seen.and(walk.seen);
            }
        }
    }
    seen
}

/// Checks arbitrary actions in a valid game. After every tick, the state must be sound. Episodes must replay,
/// nothing may happen after their end, and states with equal search keys must have equal futures.
pub fn play(bytes: &[u8]) -> Seen {
    let mut choices = Choices::new(bytes);
    let seed = Seed::from_text("play").child("chance", u64::from(choices.from_end()));
    let prefers_reference = choices.from_end() % 4 == 3;
    let (source, text) = if choices.once_in(8) {
        let (source, levels) = &CORPUS[choices.below(CORPUS.len())];
        (source.clone(), levels[choices.below(levels.len())].clone())
    } else {
        let made = any_game(&mut choices);
        (made.source, made.level)
    };
    let strict = Game::from_source(&source).ok().filter(|_| !prefers_reference);
    let Some(game) = strict.or_else(|| Game::from_source_as_reference(&source).ok()) else {
        return Seen::default();
    };
    let Ok(level) = game.level(&text) else { return Seen::default() };
    let mut walk = Walk::new(&game, &level, seed);
    walk.episode(&mut choices);
    walk.explore(&mut choices);
    walk.seen
}

/// The number of ticks of the episode that is recorded and replayed.
const EPISODE: usize = 24;
/// The number of walks that start from states already seen.
const WAYS: usize = 24;
/// The maximum number of ticks per walk.
const WAY: usize = 4;
/// The number of state pairs with equal search keys that are played further.
const TWINS: usize = 4;
/// The number of ticks for which such a state pair is played further.
const FUTURE: usize = 50;
/// The work limit of a check, over all ticks and including the work of checking sprites.
const COST: usize = 300_000;
/// The work of checking a single sprite.
const CHECK: usize = 8;

/// A walk through one level's states, with a check after every step.
struct Walk<'g> {
    game: &'g Game,
    level: &'g Level,
    seed: Seed,
    /// The source of decisions once the input is exhausted.
    sampler: Sampler,
    cost: usize,
    seen: Seen,
}

/// An observer that records the effects executed in a step, and its work.
struct Executed<'g> {
    description: &'g Description,
    effects: u64,
    work: usize,
}

impl Watch for Executed<'_> {
    fn interaction(&mut self, line: usize) {
        let effect = self.description.interactions[line].effect.text.as_str();
        self.effects |= 1 << EFFECTS.binary_search(&effect).expect("an effect of the list");
    }

    fn worked(&mut self, work: usize) {
        self.work += work;
    }
}

impl<'g> Walk<'g> {
    fn new(game: &'g Game, level: &'g Level, seed: Seed) -> Walk<'g> {
        let sampler = seed.child("actions", 0).sampler();
        Walk { game, level, seed, sampler, cost: 0, seen: Seen::default() }
    }

    /// Plays some random ticks.
    fn random_walk(&mut self, ticks: usize) {
        let mut state = self.start();
        for _ in 0..ticks {
            let action = *self.sampler.choose(&Action::ALL);
            self.step(&mut state, action);
        }
    }

    fn start(&mut self) -> State {
        let state = self.game.start(self.level, self.seed);
        self.check(&state);
        state
    }

    fn action(&mut self, choices: &mut Choices<'_>) -> Action {
        if choices.is_empty() {
            *self.sampler.choose(&Action::ALL)
        } else {
            Action::ALL[usize::from(choices.from_end()) % Action::ALL.len()]
        }
    }

    /// Plays and checks one tick. A copy of the state made before the tick must stay unchanged, and a second
    /// copy must evolve identically.
    fn step(&mut self, state: &mut State, action: Action) {
        let before = state.clone();
        let (hash, over) = (state.state_hash(), state.is_over());
        let mut executed = Executed { description: self.game.description(), effects: 0, work: 0 };
        let outcome = self.game.step_watched(state, action, &mut executed);
        self.cost += 2 * executed.work;
        self.seen.effects |= executed.effects;
        self.seen.ticks += 1;
        self.check(state);
        assert_eq!(outcome, state.outcome());
        assert_eq!(before.state_hash(), hash, "stepping a state changes no copy of it");
        if over {
            assert_eq!(state.state_hash(), hash, "what is over stays as it is");
        }
        let mut copy = before;
        self.game.step_unscheduled(&mut copy, action, &mut ());
        if copy.outcome() == Outcome::Stopped(Limit::Work) {
            // Prediction saves work, so the other state gets further before it reaches the work limit.
            return;
        }
        assert_eq!(copy.state_hash(), state.state_hash(), "a copy that foresees nothing goes the same way");
        assert_eq!((copy.outcome(), copy.score()), (state.outcome(), state.score()));
    }

    /// Checks that a state restored from its packed form is unchanged and evolves identically.
    fn check_packing(&mut self, state: &State, base: &State) {
        let mut unpacked = base.clone();
        unpacked.unpack_from(&state.pack(base), base);
        let mut state = state.clone();
        for _ in 0..2 {
            assert_eq!(unpacked.state_hash(), state.state_hash());
            assert_eq!(unpacked.recount(self.game).err(), None);
            assert_eq!(unpacked.search_key(self.game), state.search_key(self.game));
            let action = *self.sampler.choose(&Action::ALL);
            let mut executed = Executed { description: self.game.description(), effects: 0, work: 0 };
            self.game.step_watched(&mut state, action, &mut executed);
            self.game.step(&mut unpacked, action);
            self.cost += 2 * executed.work;
        }
    }

    /// Checks that values maintained incrementally match the same values computed from scratch.
    fn check(&mut self, state: &State) {
        assert_eq!(state.state_hash(), state.state_hash_from_scratch(), "tick {}", state.tick());
        let counts =
            state.recount(self.game).unwrap_or_else(|found| panic!("tick {}: {found}", state.tick()));
        self.cost += CHECK * (1 + counts.iter().sum::<usize>());
        for (stype, count) in self.game.sprite_types().zip(counts) {
            if count > 0 {
                let class = self.game.class(stype).expect("sprites have a class");
                let at = SpriteClass::ALL.iter().position(|&other| other == class);
                self.seen.classes |= 1 << at.expect("a class of the list");
            }
        }
        assert!(!self.game.actions(state).is_empty());
    }

    /// Plays an episode and checks that it replays bit for bit.
    fn episode(&mut self, choices: &mut Choices<'_>) {
        let (mut episode, mut state) = Episode::begin(self.game, self.level, self.seed);
        self.check(&state);
        for _ in 0..EPISODE {
            let action = self.action(choices);
            let mut next = state.clone();
            self.step(&mut next, action);
            episode.play(self.game, &mut state, action);
            assert_eq!(state.state_hash(), next.state_hash());
            if self.cost > COST / 4 {
                break;
            }
        }
        let observation = self.game.observe(&state);
        assert_eq!(observation.cells.len(), self.level.columns() * self.level.rows());
        let replayed =
            episode.replay(self.game, self.level).unwrap_or_else(|divergence| panic!("{divergence}"));
        // The states are compared as text, because some speeds are NaN.
        let written = |state: &State| format!("{:?}", self.game.records(state));
        assert_eq!(written(&replayed), written(&state));
        if state.is_over() && self.cost < COST / 2 {
            Action::ALL.into_iter().for_each(|action| self.step(&mut state, action));
        }
    }

    /// Takes many short walks from visited states. If two walks lead to states with equal search keys but
    /// distinct histories, plays both states further, side by side.
    fn explore(&mut self, choices: &mut Choices<'_>) {
        let start = self.start();
        let mut reached = vec![start.clone()];
        let analysis = Analysis::of(self.game);
        let abstraction = analysis.abstraction(&start);
        let keys = |state: &State| [(0, state.search_key(self.game)), (1, abstraction.key(&analysis, state))];
        let mut table: BTreeMap<(usize, SearchKey), State> =
            keys(&start).into_iter().map(|key| (key, start.clone())).collect();
        for _ in 0..WAYS {
            let from = if choices.is_empty() {
                self.sampler.bits() as usize
            } else {
                usize::from(choices.from_end())
            };
            let mut state = reached[from % reached.len()].clone();
            for _ in 0..1 + from / reached.len() % WAY {
                if state.is_over() || self.cost > COST {
                    break;
                }
                let action = self.action(choices);
                self.step(&mut state, action);
                for key in keys(&state) {
                    match table.get(&key) {
                        None => drop(table.insert(key, state.clone())),
                        Some(twin)
                            if twin.state_hash() != state.state_hash()
                                && self.seen.merged < TWINS * (1 + key.0) =>
                        {
                            let twin = twin.clone();
                            self.compare_futures(
                                &twin,
                                &state,
                                (key.0 == 1).then_some((&analysis, &abstraction)),
                            );
                        }
                        Some(_) => {}
                    }
                }
            }
            self.check_packing(&state, &start);
            reached.push(state);
        }
    }

    /// Checks that states with equal keys still have equal keys, outcomes and gains after the same actions.
    /// If nothing draws random numbers, the random state is not part of the key and must not matter.
    ///
    /// If an `abstraction` is given, its keys are compared instead. If the abstraction omits the tick, the
    /// later state may lose for that reason.
    fn compare_futures(
        &mut self,
        one: &State,
        two: &State,
        abstraction: Option<(&Analysis, &StateAbstraction)>,
    ) {
        self.seen.merged += 1;
        let (mut one, mut two) = (one.clone(), two.clone());
        let key = |state: &State| match abstraction {
            Some((analysis, abstraction)) => abstraction.key(analysis, state),
            None => state.search_key(self.game),
        };
        if one.tick() > two.tick() {
            std::mem::swap(&mut one, &mut two);
        }
        let is_certain = match abstraction {
            Some((_, abstraction)) => !abstraction.reads_chance(),
            None => self.game.is_deterministic(),
        };
        if is_certain {
            two = two.fork(self.seed.child("fork", 0));
        }
        let forgets =
            self.game.description().interactions.iter().any(|line| line.effect.text == "removeScore");
        for ahead in 1..=FUTURE {
            let latest = one.tick().max(two.tick());
            if one.is_over() || self.cost > 2 * COST || latest >= MAX_TICKS - 1 {
                return;
            }
            let scores = (one.score(), two.score());
            assert_eq!(self.game.actions(&one), self.game.actions(&two), "{ahead} ticks on");
            let action = *self.sampler.choose(&Action::ALL);
            let mut executed = Executed { description: self.game.description(), effects: 0, work: 0 };
            let outcomes =
                (self.game.step_watched(&mut one, action, &mut executed), self.game.step(&mut two, action));
            self.cost += 2 * executed.work;
            let place = || {
                let (one, two) = (self.game.records(&one), self.game.records(&two));
                format!("{ahead} ticks on, after {action}\n{one:#?}\n{two:#?}")
            };
            if abstraction.is_some_and(|(_, abstraction)| abstraction.earlier_is_better())
                && outcomes.1 == Outcome::Lost
            {
                return;
            }
            assert_eq!(outcomes.0, outcomes.1, "{}", place());
            if !matches!(outcomes.0, Outcome::Stopped(_)) && !forgets {
                assert_eq!(one.score() - scores.0, two.score() - scores.1, "gains, {}", place());
            }
            assert_eq!(key(&one), key(&two), "keys, {}", place());
        }
    }
}
