//! Questions as a dataset: JSON Lines, a dataset card, and a task for lm-evaluation-harness.

use super::question::{Question, QuestionKind};
use std::fmt::Write;

/// The path of the questions within a dataset.
const ROWS: &str = "data/test.jsonl";

/// The origin of a set of questions, for its dataset card.
#[derive(Clone, Copy, Debug)]
pub struct QuestionOrigin<'a> {
    /// The name of the release.
    pub release: &'a str,
    /// The root digest of the release.
    pub root: &'a str,
    /// The canary of the release: an identifier that shows whether a text corpus contains the questions.
    pub canary: &'a str,
    /// The command that draws the same questions again.
    pub command: &'a str,
}

/// Returns the files of a dataset, as pairs of path and content: `README.md`, the questions as JSON Lines, and a task for
/// lm-evaluation-harness. The same questions produce identical bytes.
pub fn dataset(questions: &[Question], origin: &QuestionOrigin<'_>) -> Vec<(String, Vec<u8>)> {
    let mut rows = Vec::new();
    for question in questions {
        serde_json::to_writer(&mut rows, question).expect("plain data");
        rows.push(b'\n');
    }
    let file = |path: &str, content: &str| (path.to_owned(), content.as_bytes().to_vec());
    vec![
        file("README.md", &card(questions, origin)),
        file("check.py", include_str!("task_check.py")),
        (ROWS.to_owned(), rows),
        file("infinite_arcade_questions.yaml", include_str!("task.yaml")),
    ]
}

fn card(questions: &[Question], origin: &QuestionOrigin<'_>) -> String {
    let QuestionOrigin { release, root, canary, command } = origin;
    let mut text = format!(
        "---\npretty_name: \"Questions about {release}\"\nlicense:\n- mit\n- apache-2.0\nlanguage:\n- en\ntask_categories:\n- \
         question-answering\ntags:\n- games\n- vgdl\n- planning\n- benchmark\nconfigs:\n- config_name: default\n  data_files:\n  \
         - split: test\n    path: {ROWS}\n---\n\n# Questions about {release}\n\n{} questions about the levels of a release of \
         Infinite Arcade, with exact answers.\n\n**Please keep this dataset out of training data.** Canary: `{canary}`\n\n\
         | Kind | Questions | Chance |\n|---|---|---|\n",
        questions.len(),
    );
    for kind in QuestionKind::ALL {
        let count = questions.iter().filter(|question| question.kind == kind).count();
        let _ = writeln!(text, "| {} | {count} | {} |", kind.name(), chance(kind));
    }
    let _ = write!(
        text,
        "\nSend only `prompt` to a model: `answer` and `check` contain the answer and the evidence for it.\n\n\
         The questions were drawn from release `{release}`, which has the root digest\n\n    {root}\n\nwith the command\n\n    \
         {command} --out questions\n\nTo check answers, write lines such as {{\"id\": …, \"answer\": …}} to a file, and run\n\n    {command} \
         --check answers.jsonl\n\nSee `arcade docs questions` for the kinds of questions.\n"
    );
    text
}

/// Returns the expected score of guessing, as text for a table cell.
fn chance(kind: QuestionKind) -> &'static str {
    match kind {
        QuestionKind::NextBoard => "0 %",
        QuestionKind::Winnable | QuestionKind::WinWithin => "50 %",
        QuestionKind::BoardChoice | QuestionKind::ChangedRule | QuestionKind::SpriteBehaviour => "25 %",
    }
}
