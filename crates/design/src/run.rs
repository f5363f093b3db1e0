//! A run of several drafts, its resumption and its replay.

use crate::designer::Designer;
use crate::dialogue::Dialogue;
use crate::draft::Draft;
use crate::error::DesignError;
use crate::folder::{DesignFolder, conversation};
use crate::known::Known;
use crate::work::{self, Context};
use engine::{Game, Outcome as GameOutcome};
use evaluation::player::mailbox::EpisodeResult;
use evaluation::{Halt, Journal};
use serde::Serialize;
use validators::CheckedCriteria;

/// The results of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Results {
    /// The finished drafts, in the order of their numbers.
    pub drafts: Vec<Draft>,
}

/// The result of [`run`].
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The finished drafts.
    pub results: Results,
    /// The reason why the run stopped early, if it did. A resumed run continues the unfinished draft.
    pub halt: Option<Halt>,
}

/// Writes all drafts that are not finished, one after another, because each draft must differ from the earlier ones.
/// `known` contains the games from which all drafts must differ. `finished` is called after each draft.
///
/// Costs at most twelve answers per draft, and one judgement of the game for each answer in the last stage.
///
/// # Errors
/// Returns an error if the folder's criteria are invalid, or a file cannot be read or written. If an answer is missing
/// for a reason that is not the designer's fault, the run ends without an error, and the outcome states the reason.
pub fn run(
    folder: &DesignFolder,
    designer: &Designer,
    known: &Known,
    finished: &mut dyn FnMut(&Draft),
) -> Result<Outcome, DesignError> {
    folder.begin_logs()?;
    let mut sequence = Sequence::new(folder, known)?;
    let mut halt = None;
    for number in 0..folder.settings.drafts {
        let draft = match folder.draft(number)? {
            Some(draft) => draft,
            None => match sequence.write(number, designer)? {
                Ok(draft) => draft,
                Err(stopped) => {
                    halt = Some(stopped);
                    break;
                }
            },
        };
        finished(&draft);
        sequence.push(draft);
    }
    let results = Results { drafts: sequence.drafts };
    folder.store_results(&results)?;
    Ok(Outcome { results, halt })
}

/// Recomputes all finished drafts from their logs, without a designer. Also returns the numbers of the drafts that
/// differ from the stored ones.
///
/// # Errors
/// Returns an error in the same cases as [`run`], or if a log does not contain a finished draft's answers.
pub fn replay(folder: &DesignFolder, known: &Known) -> Result<(Results, Vec<u64>), DesignError> {
    let mut sequence = Sequence::new(folder, known)?;
    let mut differing = Vec::new();
    for number in 0..folder.settings.drafts {
        let Some(stored) = folder.draft(number)? else { continue };
        if let Some(reference) = folder.settings.reference() {
            let draft = work::propose(&sequence.context(), number, reference);
            differing.extend((draft != stored).then_some(number));
            sequence.push(draft);
            continue;
        }
        let mut journal = Journal::in_memory();
        for event in folder.events(number)?.unwrap_or_default() {
            journal.push(event)?;
        }
        let draft = sequence.draft(number, journal, None).0;
        let draft = draft.map_err(|halt| DesignError::malformed(&folder.log(number), &halt.to_string()))?;
        if draft != stored {
            differing.push(number);
        }
        sequence.push(draft);
    }
    Ok((Results { drafts: sequence.drafts }, differing))
}

/// The drafts of a run so far.
struct Sequence<'a> {
    folder: &'a DesignFolder,
    criteria: CheckedCriteria,
    known: Known,
    drafts: Vec<Draft>,
}

impl<'a> Sequence<'a> {
    fn new(folder: &'a DesignFolder, known: &Known) -> Result<Sequence<'a>, DesignError> {
        let settings = &folder.settings;
        if known.digest() != settings.known {
            return Err(DesignError::Malformed(
                "the known games differ from those at the start of the run; use the version of arcade that started the run"
                    .to_owned(),
            ));
        }
        let criteria =
            settings.criteria.check().map_err(|error| DesignError::Malformed(error.to_string()))?;
        Ok(Sequence { folder, criteria, known: known.clone(), drafts: Vec::new() })
    }

    /// Adds a finished draft. Later drafts must differ from it if its rules compile.
    fn push(&mut self, draft: Draft) {
        let game = draft.rules.as_deref().and_then(|rules| Game::from_source(rules).ok());
        if let Some(game) = game {
            let name = draft.name.as_deref().unwrap_or_default();
            self.known.push(&format!("your earlier game `{name}`"), &game);
        }
        self.drafts.push(draft);
    }

    /// Writes a draft with its log, and stores it.
    fn write(&self, number: u64, designer: &Designer) -> Result<Result<Draft, Halt>, DesignError> {
        if let Designer::Reference(reference) = designer {
            let draft = work::propose(&self.context(), number, *reference);
            self.folder.store(&draft)?;
            return Ok(Ok(draft));
        }
        let journal = Journal::open(&self.folder.log(number))?;
        let (draft, mut journal) = self.draft(number, journal, Some(designer));
        match draft {
            Ok(draft) => {
                self.folder.store(&draft)?;
                end(designer, &draft)?;
                Ok(Ok(draft))
            }
            Err(halt) => {
                if let Some(event) = halt.event() {
                    journal.push(event)?;
                }
                Ok(Err(halt))
            }
        }
    }

    fn context(&self) -> Context<'_> {
        let settings = &self.folder.settings;
        Context { settings, criteria: &self.criteria, known: &self.known, earlier: &self.drafts }
    }

    fn draft(
        &self,
        number: u64,
        journal: Journal,
        designer: Option<&Designer>,
    ) -> (Result<Draft, Halt>, Journal) {
        let context = self.context();
        let conversation = conversation(number);
        let samples = context.settings.draft_seed(number);
        let mut dialogue = Dialogue { journal, designer, conversation: &conversation, samples };
        let draft = work::write(&context, number, &mut dialogue);
        (draft, dialogue.journal)
    }
}

/// Reports the result of the draft in the mailbox.
fn end(designer: &Designer, draft: &Draft) -> Result<(), DesignError> {
    let is_accepted = draft.is_accepted();
    let result = EpisodeResult {
        outcome: if is_accepted { GameOutcome::Won } else { GameOutcome::Lost },
        score: f64::from(u8::from(is_accepted)),
        steps: draft.spending.answers,
    };
    let text = match &draft.problem {
        None => "The game is accepted.\n".to_owned(),
        Some(problem) => format!("The draft was given up in the stage `{}`: {problem}\n", draft.stage),
    };
    Ok(designer.end(&conversation(draft.number), &result, &text)?)
}
