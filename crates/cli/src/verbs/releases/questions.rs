//! The questions of `arcade export`, which are drawn and written as a dataset, or drawn again to check
//! answers.

use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::input::text::read_text;
use crate::paths;
use crate::shell;
use base::{MessagePath, Seed};
use evaluation::questions::{Question, QuestionKind, QuestionOrder, QuestionOrigin, dataset, draw, read};
use evaluation::{Subject, SubjectFacts};
use serde::{Deserialize, Serialize};
use serde_json::json;
use snapshots::Draft;
use snapshots::released::{Released, ReleasedGame};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The default number of questions of each kind.
const COUNT: u32 = 100;

/// The default text from which seeds are derived.
const SEED: &str = "questions";

/// The maximum size of a file with answers, in bytes.
const MAX_ANSWERS: usize = 1 << 30;

#[derive(clap::Args)]
pub(crate) struct QuestionArgs {
    /// Number of questions of each kind [default: 100]
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    count: Option<u32>,
    /// Text to derive the seeds of questions from [default: questions]
    #[arg(long, value_name = "TEXT")]
    seed: Option<String>,
    /// Check the answers in a file instead: one JSON object per line, with the keys id and answer
    #[arg(long, value_name = "ANSWERS", conflicts_with = "out")]
    check: Option<PathBuf>,
}

/// A line of a file with answers.
#[derive(Deserialize)]
struct Given {
    id: String,
    answer: String,
}

/// The checked answers to the questions of one kind.
#[derive(Default, Serialize)]
struct Checked {
    questions: u64,
    right: u64,
    wrong: u64,
    unreadable: u64,
    unanswered: u64,
}

impl QuestionArgs {
    /// Rejects flags that apply only to questions.
    pub(super) fn refuse(&self) -> Result<(), Failure> {
        if self.count.is_some() || self.seed.is_some() || self.check.is_some() {
            bail!(
                "--count, --seed and --check apply only to questions: omit them, or choose --format questions"
            );
        }
        Ok(())
    }

    /// Draws the questions, and writes them to the draft, or checks the given answers.
    pub(super) fn answer(
        &self,
        snapshot: &Path,
        released: &Released,
        draft: Option<Draft>,
        out: Option<&Path>,
        console: &Console,
    ) -> Answer {
        let given = self.check.as_deref().map(answers).transpose()?;
        let subjects: Vec<Subject> = released.games.iter().map(subject).collect::<Result<_, _>>()?;
        let (count, seed) = (self.count.unwrap_or(COUNT), self.seed.as_deref().unwrap_or(SEED));
        let order = QuestionOrder {
            kinds: QuestionKind::ALL.to_vec(),
            count: count as usize,
            seed: Seed::from_text(seed),
        };
        let bar = console.progress(u64::from(count) * order.kinds.len() as u64, "questions");
        let questions = draw(&subjects, &order, &mut |drawn| bar.set_position(drawn as u64))?;
        bar.finish_and_clear();
        if questions.is_empty() {
            bail!(
                "{}: no level is deterministic and fully visible, so there are no exact questions",
                snapshot.in_message()
            );
        }
        let name = &released.manifest.name;
        if let Some(given) = given {
            return report(name, &questions, &given, console);
        }
        let (Some(draft), Some(out)) = (draft, out) else {
            bail!("--out is missing: pass the folder to write");
        };
        let (root, canary) = (released.manifest.root.to_string(), released.manifest.canary.to_string());
        let command =
            format!("arcade export DIR --format questions --count {count} --seed {}", shell::quoted(seed));
        let origin = QuestionOrigin { release: name, root: &root, canary: &canary, command: &command };
        let files = dataset(&questions, &origin);
        for (path, content) in &files {
            draft.write(path, content)?;
        }
        draft.commit()?;
        let kinds = tally(&questions)
            .into_iter()
            .map(|(kind, found)| (kind.name(), found))
            .collect::<BTreeMap<_, _>>();
        let paths: Vec<&str> = files.iter().map(|(path, _)| path.as_str()).collect();
        console.document(&json!({
            "out": paths::in_json(out), "release": name, "root": root, "questions": kinds, "files": paths,
        }))?;
        console.say(format_args!("{name}: {} questions in {}", questions.len(), out.in_message()));
        for (kind, found) in tally(&questions) {
            let missing = if found < count as usize { "; the levels provide no more" } else { "" };
            console.say(format_args!("  {}: {found}{missing}", kind.name()));
        }
        Ok(true)
    }
}

fn subject(game: &ReleasedGame) -> Result<Subject, Failure> {
    let levels: Vec<_> =
        game.levels.iter().enumerate().map(|(number, level)| (number, level.text.clone(), None)).collect();
    let subject = Subject::read(&game.card.id, &game.source, &levels, SubjectFacts::default());
    subject.map_err(|problems| malformed!("{}: {problems}", game.card.id))
}

/// Returns the number of questions of each kind.
fn tally(questions: &[Question]) -> BTreeMap<QuestionKind, usize> {
    let mut tally = BTreeMap::from(QuestionKind::ALL.map(|kind| (kind, 0)));
    questions.iter().for_each(|question| *tally.entry(question.kind).or_default() += 1);
    tally
}

/// Reads a file with answers.
fn answers(path: &Path) -> Result<BTreeMap<String, String>, Failure> {
    let text = read_text(path, MAX_ANSWERS)?;
    let mut given = BTreeMap::new();
    for (number, line) in (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty()) {
        let Given { id, answer } = serde_json::from_str(line).map_err(|error| {
            malformed!(
                "{}: line {number} is not an answer ({error}); write {{\"id\": …, \"answer\": …}}",
                path.in_message()
            )
        })?;
        if given.insert(id.clone(), answer).is_some() {
            bail!("{}: line {number} answers `{id}` again; keep one answer", path.in_message());
        }
    }
    Ok(given)
}

/// Checks answers, and reports the results by kind.
fn report(
    release: &str,
    questions: &[Question],
    given: &BTreeMap<String, String>,
    console: &Console,
) -> Answer {
    let mut kinds = BTreeMap::<QuestionKind, Checked>::new();
    for question in questions {
        let checked = kinds.entry(question.kind).or_default();
        checked.questions += 1;
        let count = match given.get(&question.id).map(|text| read(question, text).choice()) {
            None => &mut checked.unanswered,
            Some(None) => &mut checked.unreadable,
            Some(Some(answer)) if answer == question.answer => &mut checked.right,
            Some(Some(_)) => &mut checked.wrong,
        };
        *count += 1;
    }
    let known: BTreeSet<&String> = questions.iter().map(|question| &question.id).collect();
    if let Some(unknown) = given.keys().find(|id| !known.contains(id)) {
        bail!(
            "there is no question `{unknown}`; pass the --count and --seed with which the questions were drawn"
        );
    }
    let by_name: BTreeMap<&str, &Checked> =
        kinds.iter().map(|(kind, checked)| (kind.name(), checked)).collect();
    console.document(&json!({ "release": release, "kinds": by_name }))?;
    for (kind, Checked { questions, right, wrong, unreadable, unanswered }) in &kinds {
        console.say(format_args!(
            "{}: {right} of {questions} right, {wrong} wrong, {unreadable} unreadable, {unanswered} unanswered",
            kind.name()
        ));
    }
    Ok(true)
}
