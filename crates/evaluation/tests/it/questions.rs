//! Tests of questions with exact answers: every answer is derived again by replays and by plain breadth-first search.

use crate::sweeping;
use base::Seed;
use engine::{Action, Game, Level, Observation, Outcome, State};
use evaluation::encoding::grid;
use evaluation::legend::{Legend, LegendOptions};
use evaluation::questions::{OptionSource, Question, QuestionKind, QuestionOrder, draw, is_right};
use evaluation::{Subject, SubjectFacts};
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::path::PathBuf;
use std::sync::LazyLock;

/// Reads all games in a folder of game folders, such as the corpus or a release's `games`.
fn subjects(folder: &PathBuf) -> Vec<Subject> {
    let read = |folder: PathBuf| {
        let source = std::fs::read_to_string(folder.join("game.vgdl")).ok()?;
        let texts =
            (0..).map_while(|number| std::fs::read_to_string(folder.join(format!("lvl{number}.txt"))).ok());
        let levels: Vec<_> = texts.enumerate().map(|(number, text)| (number, text, None)).collect();
        let id = folder.file_name()?.to_str()?.to_owned();
        Subject::read(&id, &source, &levels, SubjectFacts::default()).ok()
    };
    let entries = std::fs::read_dir(folder).expect("a folder of games");
    let folders: BTreeSet<PathBuf> = entries.map(|entry| entry.expect("readable").path()).collect();
    folders.into_iter().filter_map(read).collect()
}

/// The games of `ARCADE_QUESTIONS_FROM`, or the corpus.
static SUBJECTS: LazyLock<Vec<Subject>> = LazyLock::new(|| {
    let given = std::env::var_os("ARCADE_QUESTIONS_FROM").map(PathBuf::from);
    subjects(&given.unwrap_or_else(|| PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../corpora"))))
});

fn order(count: usize, seed: &str) -> QuestionOrder {
    QuestionOrder { kinds: QuestionKind::ALL.to_vec(), count, seed: Seed::from_text(seed) }
}

static QUESTIONS: LazyLock<Vec<Question>> = LazyLock::new(|| {
    let count = if sweeping() { 2000 } else { 24 };
    draw(&SUBJECTS, &order(count, "questions test"), &mut |_| ()).expect("drawn")
});

fn by_kind() -> BTreeMap<QuestionKind, Vec<&'static Question>> {
    let mut all = BTreeMap::<_, Vec<_>>::new();
    QUESTIONS.iter().for_each(|question| all.entry(question.kind).or_default().push(question));
    all
}

fn place(question: &Question) -> (&'static Subject, &'static Level) {
    let subject = SUBJECTS.iter().find(|subject| subject.id == question.game).expect("the game");
    let level = subject.levels.iter().find(|level| level.number == question.level).expect("the level");
    (subject, &level.level)
}

/// Plays actions from the start of a level, with a seed that the draw does not use, and returns all boards.
fn play(subject: &Subject, game: &Game, level: &Level, actions: &[Action]) -> (Vec<String>, State) {
    let legend = Legend::new(&subject.analysis, &LegendOptions::default());
    let mut state = game.start(level, Seed::from_text("brute force"));
    let mut boards = vec![grid(&game.observe(&state), &legend)];
    for &action in actions {
        if state.is_over() {
            break;
        }
        game.step(&mut state, action);
        boards.push(grid(&game.observe(&state), &legend));
    }
    (boards, state)
}

fn game_of(subject: &Subject, option: &OptionSource) -> Game {
    match (option.without, option.vgdl.as_str()) {
        (Some(line), _) => subject.game.without(line),
        (None, "") => subject.game.clone(),
        (None, text) => Game::from_source(text).expect("it compiles"),
    }
}

/// Searches breadth-first for the shortest win of at most `limit` actions. Returns `Ok(None)` if no win exists, and an
/// error if there are more than `states` states.
fn search(game: &Game, start: State, limit: usize, states: usize) -> Result<Option<usize>, ()> {
    let mut seen = BTreeSet::from([start.search_key(game)]);
    let mut open = VecDeque::from([(start, 0)]);
    while let Some((state, depth)) = open.pop_front() {
        if depth >= limit {
            continue;
        }
        for action in Action::ALL {
            let mut next = state.clone();
            match game.step(&mut next, action) {
                Outcome::Won => return Ok(Some(depth + 1)),
                Outcome::Ongoing if seen.insert(next.search_key(game)) => open.push_back((next, depth + 1)),
                _ => {}
            }
        }
        if seen.len() > states {
            return Err(());
        }
    }
    Ok(None)
}

#[test]
fn every_kind_has_questions() {
    let least = if sweeping() { 2000 } else { 24 };
    for kind in QuestionKind::ALL {
        let found = by_kind().get(&kind).map_or(0, Vec::len);
        assert!(found >= least, "{}: {found}", kind.name());
    }
    let ids: BTreeSet<&str> = QUESTIONS.iter().map(|question| question.id.as_str()).collect();
    let prompts: BTreeSet<&str> = QUESTIONS.iter().map(|question| question.prompt.as_str()).collect();
    assert_eq!((ids.len(), prompts.len()), (QUESTIONS.len(), QUESTIONS.len()));
}

#[test]
fn the_same_seed_draws_the_same_questions() {
    let small = || draw(&SUBJECTS[..6], &order(4, "again"), &mut |_| ()).expect("drawn");
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool").install(small);
    assert_eq!(one, small());
    assert_ne!(one, draw(&SUBJECTS[..6], &order(4, "another"), &mut |_| ()).expect("drawn"));
}

#[test]
fn boards_replay() {
    for question in by_kind()[&QuestionKind::NextBoard].iter().chain(&by_kind()[&QuestionKind::BoardChoice]) {
        let (subject, level) = place(question);
        let check = &question.check;
        let board = |game: &Game, actions: &[Action]| {
            let (boards, state) = play(subject, game, level, &[&check.before[..], actions].concat());
            assert!(!state.is_over());
            boards.last().expect("the start").clone()
        };
        let right = board(&subject.game, &check.actions);
        if question.options.is_empty() {
            assert_eq!(question.answer, right, "{}", question.id);
            assert_ne!(right, board(&subject.game, &[]), "{}", question.id);
            continue;
        }
        let options = check.options.iter().map(|option| board(&game_of(subject, option), &option.actions));
        assert_eq!(options.collect::<Vec<_>>(), question.options, "{}", question.id);
        let equal: Vec<usize> = (0..4).filter(|&at| question.options[at] == right).collect();
        assert_eq!(equal, [letter(question)], "{}", question.id);
    }
}

fn letter(question: &Question) -> usize {
    ["A", "B", "C", "D"].iter().position(|letter| *letter == question.answer).expect("a letter")
}

#[test]
fn wins_replay_and_searches_are_confirmed() {
    let (mut proved, mut open) = (0, 0);
    for question in by_kind()[&QuestionKind::Winnable].iter().chain(&by_kind()[&QuestionKind::WinWithin]) {
        let (subject, level) = place(question);
        let check = &question.check;
        let (_, position) = play(subject, &subject.game, level, &check.before);
        assert!(!position.is_over(), "{}", question.id);
        if !check.win.is_empty() {
            let (_, end) = play(subject, &subject.game, level, &[&check.before[..], &check.win].concat());
            assert_eq!(end.outcome(), Outcome::Won, "{}", question.id);
        }
        let is_yes = question.answer == "yes";
        if let (true, Some(within)) = (is_yes, check.within) {
            assert!(check.win.len() as u64 <= within, "{}", question.id);
        }
        if is_yes {
            assert!(!check.win.is_empty(), "{}", question.id);
            continue;
        }
        let limit = check.within.map_or(usize::MAX, |within| within as usize);
        match search(&subject.game, position, limit, if sweeping() { 400_000 } else { 20_000 }) {
            Ok(found) => assert_eq!(found, None, "{}", question.id),
            Err(()) => open += 1,
        }
        proved += 1;
    }
    assert!(open * 4 <= proved, "{open} of {proved}");
}

#[test]
fn recordings_single_out_one_rule() {
    for question in
        by_kind()[&QuestionKind::ChangedRule].iter().chain(&by_kind()[&QuestionKind::SpriteBehaviour])
    {
        let (subject, level) = place(question);
        let boards =
            |option: &OptionSource| play(subject, &game_of(subject, option), level, &option.actions).0;
        let all: Vec<Vec<String>> = question.check.options.iter().map(boards).collect();
        let shown = rows_of_last_recording(&question.prompt);
        let matching: Vec<usize> = (0..4).filter(|&at| rows(&all[at]) == shown).collect();
        assert!(matching.contains(&letter(question)), "{}: {matching:?}\n{}", question.id, question.prompt);
        let texts: BTreeSet<&String> = question.options.iter().collect();
        assert_eq!(texts.len(), 4, "{}", question.id);
        let seen: Vec<_> =
            question.check.options.iter().map(|option| observations(subject, level, option)).collect();
        let is_unlike = |at: usize| seen[at + 1..].iter().all(|other| *other != seen[at]);
        assert!((0..4).all(is_unlike), "{}", question.id);
    }
}

/// Returns all observations of an option's recording.
fn observations(subject: &Subject, level: &Level, option: &OptionSource) -> Vec<Observation> {
    let game = game_of(subject, option);
    let mut state = game.start(level, Seed::from_text("brute force"));
    let play = |&action| {
        game.step(&mut state, action);
        game.observe(&state)
    };
    option.actions.iter().map(play).collect()
}

/// Returns the changed rows of each tick, as a prompt shows them.
fn rows(boards: &[String]) -> Vec<Vec<String>> {
    let changed = |pair: &[String]| {
        let rows = pair[0].lines().zip(pair[1].lines()).enumerate().filter(|(_, (old, new))| old != new);
        rows.map(|(row, (_, new))| format!("row {row}: {new}")).collect()
    };
    boards.windows(2).map(changed).collect()
}

/// Returns the changed rows of each tick in the last recording of a prompt.
fn rows_of_last_recording(prompt: &str) -> Vec<Vec<String>> {
    let recording = &prompt[prompt.rfind("ecording\n").expect("a recording")..];
    let recording = recording.split("\n\n## Question").next().expect("text");
    let rows = |tick: &str| {
        let (_, changes) = tick.split_once(": ").expect("a colon after the action");
        let lines = changes.lines().map(str::trim);
        lines.filter(|line| line.starts_with("row ")).map(str::to_owned).collect()
    };
    recording.split("\nTick ").skip(1).map(rows).collect()
}

#[test]
fn guesses_score_at_chance() {
    for (kind, questions) in by_kind() {
        let answers: BTreeSet<&str> = questions.iter().map(|question| question.answer.as_str()).collect();
        let score = |answer: &str| questions.iter().filter(|question| is_right(question, answer)).count();
        let most = answers.iter().map(|answer| score(&format!("ANSWER: {answer}"))).max().expect("answers");
        let chance = match kind {
            QuestionKind::NextBoard => 1,
            QuestionKind::Winnable | QuestionKind::WinWithin => questions.len().div_ceil(2),
            _ => questions.len().div_ceil(4),
        };
        assert!(most <= chance, "{}: {most} of {}", kind.name(), questions.len());
    }
    assert!(
        QUESTIONS.iter().all(|question| is_right(question, &format!("So.\n\nANSWER:\n{}", question.answer)))
    );
}
