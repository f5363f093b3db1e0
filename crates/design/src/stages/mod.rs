//! The stages of a draft, and the checks of their answers.

mod attempt;
pub(crate) mod idea;
pub(crate) mod levels;
pub(crate) mod rules;

use std::fmt;

base::named_enum! {
    /// A stage of a draft.
    pub enum Stage {
        /// The idea, in words.
        Idea = "idea",
        /// The rules, in VGDL.
        Rules = "rules",
        /// The levels, possibly with changed rules.
        Levels = "levels",
    }
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The problems with an answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Problem {
    /// The summary for tables, in one line.
    pub(crate) summary: String,
    /// The complete text for the designer.
    pub(crate) text: String,
}

impl Problem {
    /// Creates a problem that is described by one paragraph.
    pub(crate) fn plain(text: impl Into<String>) -> Problem {
        let text = text.into();
        Problem { summary: text.clone(), text }
    }

    /// Creates a problem that is described by an introduction and a report in a fenced block.
    pub(crate) fn reported(summary: impl Into<String>, introduction: &str, report: &str) -> Problem {
        let text = format!("{introduction}\n\n```text\n{}\n```", report.trim_end());
        Problem { summary: summary.into(), text }
    }

    /// Returns the message to the designer. `left` is the number of remaining corrections, including this one.
    pub(crate) fn message(&self, left: u32) -> String {
        let left = match left {
            1 => "This is the last correction.".to_owned(),
            left => format!("{left} corrections are left."),
        };
        format!("{}\n\nSend a complete, corrected answer in the same format. {left}", self.text)
    }
}
