//! The player `mailbox:DIR`, for any program or person that answers the prompts in a folder.

use super::Args;
use super::model::prompters;
use super::player::PlayerOf;
use crate::console::Console;
use crate::failure::Failure;
use crate::shell;
use base::MessagePath;
use evaluation::player::Contestant;
use evaluation::player::mailbox::{Mailbox, MailboxPlayer};
use evaluation::prompt::{PromptSettings, Prompter};
use evaluation::run::Task;
use evaluation::{AnswerLimit, Entrant, Settings, Subject};
use serde_json::json;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A requested mailbox, not yet opened.
pub(super) struct RequestedMailbox {
    folder: PathBuf,
    prompts: PromptSettings,
    reasks: u32,
}

impl RequestedMailbox {
    pub(super) fn new(folder: &str, args: &Args) -> Result<RequestedMailbox, Failure> {
        if folder.is_empty() {
            bail!("`mailbox:` has no folder; specify a new or empty one, such as `mailbox:alice`");
        }
        let (prompts, reasks) = (args.model.prompt.settings()?, args.model.reasks);
        Ok(RequestedMailbox { folder: folder.into(), prompts, reasks })
    }

    /// Returns the player's entry in the results. Its name is the value of `--name`, or else the last component of
    /// the folder's path.
    pub(super) fn entrant(&self, args: &Args, subjects: &[Subject]) -> Result<Entrant, Failure> {
        let digest = match subjects.first() {
            Some(subject) => {
                let prompter = Prompter::within(subject, self.prompts.clone(), u64::MAX, args.commit)?;
                Some(prompter.with_answer_limit(answer_limit(args)).digest())
            }
            None => None,
        };
        let folder = self.folder.file_name().unwrap_or(self.folder.as_os_str()).to_string_lossy();
        Ok(Entrant {
            name: args.name.clone().unwrap_or_else(|| format!("mailbox:{folder}")),
            mode: Some(self.prompts.mode.name().to_owned()),
            aids: args.model.prompt.aids(&self.prompts),
            details: json!({
                "mailbox": true,
                "prompt": self.prompts,
                "prompt_digest": digest,
                "reasks": self.reasks,
            }),
        })
    }

    /// Opens the mailbox, and returns it with a constructor for its episodes' players.
    pub(super) fn connect(
        &self,
        args: &Args,
        settings: &Settings,
        subjects: &[Subject],
        console: &Console,
    ) -> Result<(PlayerOf, Arc<Mailbox>), Failure> {
        let prompters = prompters(subjects, &self.prompts, settings, answer_limit(args))?;
        let mailbox = Arc::new(Mailbox::open(&self.folder, settings, args.resume, console.remarks())?);
        console.remark(format_args!(
            "prompts appear in {}; answer them with `{}`, or as `arcade docs mailbox` describes",
            self.folder.in_message(),
            shell::command([Path::new("mailbox"), &self.folder])
        ));
        let (opened, reasks) = (mailbox.clone(), self.reasks);
        let player = move |task: &Task<'_>| {
            MailboxPlayer::new(opened.clone(), task, prompters[&task.subject.id].clone(), reasks)
        };
        Ok((Box::new(move |task| Contestant::Agent(Box::new(player(task)))), mailbox))
    }
}

/// Returns the limit on each answer's length, if the user set it.
fn answer_limit(args: &Args) -> Option<AnswerLimit> {
    args.model.client.max_output_tokens().map(AnswerLimit::Words)
}
