//! The designer requested by the user, and its connection.

use super::Args;
use crate::console::Console;
use crate::failure::Failure;
use crate::shell;
use base::MessagePath;
use design::{DesignFolder, Designer, Reference, Results};
use evaluation::client::{self, Caps, ModelOptions, ModelSettings, OnFailure, Price};
use evaluation::player::mailbox::{Finished, Mailbox};
use generators::GENERATION;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The designer requested by the user.
pub(super) enum RequestedDesigner {
    Model(Box<ModelOptions>, ModelSettings),
    Mailbox(PathBuf),
    Reference(Reference),
}

/// A connected designer, and the state that outlives a draft.
pub(super) struct Connected {
    pub(super) designer: Designer,
    /// The spending so far, and the caps on it.
    pub(super) caps: Option<Arc<Caps>>,
    mailbox: Option<Arc<Mailbox>>,
}

impl RequestedDesigner {
    pub(super) fn new(args: &Args) -> Result<RequestedDesigner, Failure> {
        if let Some(model) = &args.client.model {
            let options = args.client.options(model)?;
            let settings = client::settings(&options)?;
            client::price(&options)?;
            return Ok(RequestedDesigner::Model(Box::new(options), settings));
        }
        let Some(name) = args.designer.as_deref() else {
            bail!(
                "no designer specified: pass a language model with --model (`openai:ID`), or --designer mailbox:DIR"
            );
        };
        if let Some(flag) = args.client.unused_without_model(false) {
            bail!("{flag} applies only to language models (--model); remove it for the designer `{name}`");
        }
        if args.client.timeout.is_some() {
            bail!("--timeout applies only to language models (--model); remove it for the designer `{name}`");
        }
        if let Some(reference) = Reference::ALL.into_iter().find(|reference| reference.name() == name) {
            return Ok(RequestedDesigner::Reference(reference));
        }
        let Some(folder) = name.strip_prefix("mailbox:") else {
            let references = Reference::ALL.map(Reference::name).join(", ");
            bail!(
                "`{name}` isn't a designer; pass --designer mailbox:DIR, a reference designer ({references}), or a \
                 language model with --model"
            );
        };
        if folder.is_empty() {
            bail!("`mailbox:` has no folder; specify a new or empty one, such as `mailbox:alice`");
        }
        Ok(RequestedDesigner::Mailbox(folder.into()))
    }

    /// Returns the designer's name in results.
    pub(super) fn name(&self, args: &Args) -> String {
        args.name.clone().unwrap_or_else(|| match self {
            RequestedDesigner::Model(_, settings) => settings.model.clone(),
            RequestedDesigner::Mailbox(folder) => {
                let folder = folder.file_name().unwrap_or(folder.as_os_str()).to_string_lossy();
                format!("mailbox:{folder}")
            }
            RequestedDesigner::Reference(reference) => reference.name().to_owned(),
        })
    }

    pub(super) fn details(&self) -> Value {
        match self {
            RequestedDesigner::Model(_, settings) => json!({ "model": settings }),
            RequestedDesigner::Mailbox(_) => json!({ "mailbox": true }),
            RequestedDesigner::Reference(reference) => {
                json!({ "reference": reference, "generation": GENERATION })
            }
        }
    }

    pub(super) fn price(&self) -> Result<Option<Price>, Failure> {
        match self {
            RequestedDesigner::Model(options, _) => Ok(client::price(options)?),
            RequestedDesigner::Mailbox(_) | RequestedDesigner::Reference(_) => Ok(None),
        }
    }

    /// Connects without sending a request. The amounts spent by earlier runs in the folder count towards the caps.
    pub(super) fn connect(
        &self,
        args: &Args,
        folder: &DesignFolder,
        console: &Console,
    ) -> Result<Connected, Failure> {
        match self {
            RequestedDesigner::Reference(reference) => {
                Ok(Connected { designer: Designer::Reference(*reference), caps: None, mailbox: None })
            }
            RequestedDesigner::Model(options, _) => {
                let on_failure = Some(OnFailure(console.remarks()));
                let connection = client::connect(&ModelOptions { on_failure, ..(**options).clone() })?;
                connection.caps.charge_logged(&folder.all_events()?);
                let (model, decoding) = (Arc::from(connection.model), connection.settings.decoding);
                let designer = Designer::Model { model, decoding };
                Ok(Connected { designer, caps: Some(connection.caps), mailbox: None })
            }
            RequestedDesigner::Mailbox(path) => {
                let settings = &folder.settings;
                let (player, digest) = (&settings.designer, settings.digest());
                let mailbox = Mailbox::open_as(path, player, digest, args.resume, console.remarks())?;
                let mailbox = Arc::new(mailbox);
                console.remark(format_args!(
                    "questions appear in {}; `{}` lists them, and `arcade docs model-designs` describes how to answer them",
                    path.in_message(),
                    shell::command([Path::new("mailbox"), path, Path::new("--list")])
                ));
                let designer = Designer::Mailbox(mailbox.clone());
                Ok(Connected { designer, caps: None, mailbox: Some(mailbox) })
            }
        }
    }
}

impl Connected {
    /// Reports in the mailbox that all drafts are finished.
    pub(super) fn finish(&self, results: &Results, is_open: bool) -> Result<(), Failure> {
        let Some(mailbox) = self.mailbox.as_ref().filter(|_| !is_open) else { return Ok(()) };
        let accepted = results.drafts.iter().filter(|draft| draft.is_accepted()).count();
        let finished = Finished { episodes: results.drafts.len() as u64, won: accepted as u64 };
        Ok(mailbox.finish_with(&finished)?)
    }
}
