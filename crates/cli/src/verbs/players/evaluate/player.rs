//! The player requested by the user, and its connection to the episodes.

use super::human::Human;
use super::mailbox::RequestedMailbox;
use super::model::{self, ConnectedModel};
use super::{Args, BUDGET};
use crate::console::Console;
use crate::failure::Failure;
use crate::flags::threads;
use crate::verbs::players::player_guard;
use agents::{Budget, PlannerSpec};
use evaluation::player::mailbox::Mailbox;
use evaluation::player::process::{PROTOCOL, Process, ProcessConfig};
use evaluation::player::{Contestant, Replay, Touching};
use evaluation::prompt::PromptSettings;
use evaluation::run::Task;
use evaluation::serve::{PromptPlayer, Prompted};
use evaluation::{Entrant, Observed, Settings, Subject, Track};
use serde_json::json;
use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

/// The player requested by the user.
pub(super) enum RequestedPlayer {
    Planner(PlannerSpec),
    Replay(Replay),
    Touching,
    Human(PromptSettings),
    Mailbox(RequestedMailbox),
    Prompted(PromptPlayer, PromptSettings),
    Process(Box<Process>),
    Model(Box<model::RequestedModel>),
}

/// A constructor for an episode's player.
pub(super) type PlayerOf = Box<dyn Fn(&Task<'_>) -> Contestant + Sync>;

/// A connected player: a constructor for its episodes' players, and the state that outlives an episode.
pub(super) struct Connected {
    pub(super) contestant: PlayerOf,
    pub(super) model: Option<Arc<ConnectedModel>>,
    pub(super) mailbox: Option<Arc<Mailbox>>,
}

impl From<PlayerOf> for Connected {
    fn from(contestant: PlayerOf) -> Connected {
        Connected { contestant, model: None, mailbox: None }
    }
}

impl RequestedPlayer {
    /// Returns the player's entry in results.
    pub(super) fn entrant(&self, args: &Args, subjects: &[Subject]) -> Result<Entrant, Failure> {
        let (name, details) = match self {
            RequestedPlayer::Model(model) => return model.entrant(subjects, args),
            RequestedPlayer::Planner(spec) => {
                let budget = spec.budget().unwrap_or(Budget(args.budget.unwrap_or(BUDGET)));
                let looks_ahead =
                    !matches!(spec.name(), "do-nothing" | "random" | "random-with-nil" | "nearest-goal");
                let name = match looks_ahead {
                    true => format!("{}:{}", spec.name(), budget.0),
                    false => spec.name().to_owned(),
                };
                (name, json!({ "planner": spec.name(), "budget": budget }))
            }
            RequestedPlayer::Replay(replay) => ("replay".to_owned(), json!({ "replay": replay.digest() })),
            RequestedPlayer::Touching => (Touching::NAME.to_owned(), json!({ "player": Touching::NAME })),
            RequestedPlayer::Human(prompts) => {
                (args.name.clone().unwrap_or("human".to_owned()), json!({ "prompt": prompts }))
            }
            RequestedPlayer::Mailbox(mailbox) => return mailbox.entrant(args, subjects),
            RequestedPlayer::Prompted(player, prompts) => (player.to_string(), json!({ "prompt": prompts })),
            RequestedPlayer::Process(process) => {
                let command = process.command();
                (format!("cmd:{command}"), json!({ "command": command, "protocol": PROTOCOL }))
            }
        };
        let aids = match self {
            RequestedPlayer::Human(prompts) | RequestedPlayer::Prompted(_, prompts) => {
                args.model.prompt.aids(prompts)
            }
            _ => Vec::new(),
        };
        Ok(Entrant { name, mode: None, aids, details })
    }

    /// Checks, before anything is written, that a player that reads prompts can read each game's first
    /// prompt.
    ///
    /// # Errors
    ///
    /// Returns a failure if the player cannot read a prompt. The message lists the affected games, the
    /// reason, and the games that the player can play.
    pub(super) fn check(&self, settings: &Settings, subjects: &[Subject]) -> Result<(), Failure> {
        let RequestedPlayer::Prompted(player, prompts) = self else { return Ok(()) };
        let prompters = model::prompters(subjects, prompts, settings, None)?;
        let mut problems: BTreeMap<&str, String> = BTreeMap::new();
        let tasks = evaluation::run::tasks(settings, subjects);
        for task in tasks.iter().filter(|task| task.run == 0) {
            let messages =
                prompters[&task.subject.id].prompt(&Observed::first(task).turn(task), &[], &[]).messages;
            if let Err(why) = player.check(&messages) {
                problems.entry(&task.subject.id).or_insert_with(|| why.to_string());
            }
        }
        let Some((game, why)) = problems.iter().next() else { return Ok(()) };
        let fit: Vec<&str> = subjects.iter().map(|subject| subject.id.as_str()).collect();
        let fit: Vec<&str> = fit.into_iter().filter(|id| !problems.contains_key(id)).collect();
        match (problems.len(), fit.is_empty()) {
            (_, false) => Err(malformed!(
                "{game}: {why}; the player can play {} of {} games: pass --games {}",
                fit.len(),
                subjects.len(),
                fit.join(",")
            )),
            (1, _) => Err(malformed!("{game}: {why}")),
            (many, _) => Err(malformed!("{game}: {why}; the player cannot play any of the {many} games")),
        }
    }

    /// Connects the player, and returns a constructor for its episodes' players.
    pub(super) fn connect(
        &self,
        args: &Args,
        settings: &Settings,
        subjects: &[Subject],
        console: &Console,
    ) -> Result<Connected, Failure> {
        let contestant: PlayerOf = match self {
            RequestedPlayer::Planner(spec) => {
                let (spec, budget) = (spec.clone(), Budget(args.budget.unwrap_or(BUDGET)));
                Box::new(move |_| Contestant::Planner { spec: spec.clone(), budget })
            }
            RequestedPlayer::Replay(replay) => {
                let replay = replay.clone();
                Box::new(move |_| Contestant::Agent(Box::new(replay.clone())))
            }
            RequestedPlayer::Touching => {
                let is_blind = args.model.prompt.track == Some(Track::Discover);
                let player = move |task: &Task<'_>| match is_blind {
                    true => Touching::new(task.chance()).without_score(),
                    false => Touching::new(task.chance()),
                };
                Box::new(move |task| Contestant::Agent(Box::new(player(task))))
            }
            RequestedPlayer::Human(prompts) => {
                let prompters = model::prompters(subjects, prompts, settings, None)?;
                let player = move |task: &Task<'_>| Human::new(prompters[&task.subject.id].clone());
                Box::new(move |task| Contestant::Agent(Box::new(player(task))))
            }
            RequestedPlayer::Prompted(player, prompts) => {
                let (player, prompters) =
                    (player.clone(), model::prompters(subjects, prompts, settings, None)?);
                let prompter = move |task: &Task<'_>| prompters[&task.subject.id].clone();
                Box::new(move |task| {
                    Contestant::Agent(Box::new(Prompted::new(player.clone(), prompter(task))))
                })
            }
            RequestedPlayer::Process(read) => {
                let (command, timeout) = (read.command().to_owned(), args.model.client.timeout());
                let remark = console.remarks();
                let track = args.model.prompt.track.unwrap_or(Track::Told);
                let most = args.model.client.max_output_tokens();
                let process = move || {
                    let process = process(&command, timeout).expect("the command line was parsed before");
                    process.with_notices(remark.clone()).on_track(track).with_max_output_tokens(most)
                };
                Box::new(move |_| Contestant::Agent(Box::new(process())))
            }
            RequestedPlayer::Mailbox(mailbox) => {
                let (contestant, mailbox) = mailbox.connect(args, settings, subjects, console)?;
                return Ok(Connected { mailbox: Some(mailbox), ..contestant.into() });
            }
            RequestedPlayer::Model(model) => {
                let model = Arc::new(model.connect(subjects, settings, console)?);
                let connected = model.clone();
                let contestant: PlayerOf = Box::new(move |task| connected.contestant(task));
                return Ok(Connected { model: Some(model), ..contestant.into() });
            }
        };
        Ok(contestant.into())
    }

    /// Returns the number of concurrent episodes, capped at the total number of episodes. It does not depend
    /// on the number of cores for models, whose episodes spend most of their time waiting.
    pub(super) fn threads(&self, args: &Args, episodes: usize, console: &Console) -> usize {
        let requested = match self {
            RequestedPlayer::Model(_) => args.model.client.concurrency().get(),
            RequestedPlayer::Human(_) => 1,
            RequestedPlayer::Mailbox(_) => threads::jobs().unwrap_or(1),
            _ => threads::jobs()
                .unwrap_or_else(|| std::thread::available_parallelism().map_or(1, NonZeroUsize::get)),
        };
        let episodes = episodes.max(1);
        if threads::jobs().is_some() && requested > episodes {
            console.remark(format_args!(
                "--jobs {requested}: there are only {episodes} episodes, so only {episodes} run at the same time"
            ));
        }
        requested.min(episodes)
    }
}

/// Rejects flags that would have no effect, because a user who sets a flag expects an effect.
pub(super) fn reject_unused_flags(args: &Args, requested: &RequestedPlayer) -> Result<(), Failure> {
    if args.budget.is_some() && !matches!(requested, RequestedPlayer::Planner(_)) {
        bail!(
            "--budget applies only to planners, such as --player mcts; remove it (`planner:mcts:300` \
             includes its budget in the name)"
        );
    }
    if matches!(requested, RequestedPlayer::Model(_)) {
        return match threads::jobs() {
            Some(_) => Err(malformed!(
                "--jobs does not apply to models; set the number of concurrent requests with --concurrency"
            )),
            None => Ok(()),
        };
    }
    let player = args.player.as_deref().unwrap_or_default();
    let is_limited = matches!(requested, RequestedPlayer::Mailbox(_) | RequestedPlayer::Process(_));
    if let Some(flag) = args.model.client.unused_without_model(is_limited) {
        let others = if flag == "--max-output-tokens" { ", mailboxes and programs (`cmd:`)" } else { "" };
        bail!(
            "{flag} applies only to language models (--model){others}; remove it for the player `{player}`"
        );
    }
    if args.model.client.timeout.is_some() && !matches!(requested, RequestedPlayer::Process(_)) {
        bail!(
            "--timeout applies only to language models (--model) and programs (`cmd:`); remove it for the \
             player `{player}`"
        );
    }
    let is_named = matches!(requested, RequestedPlayer::Human(_) | RequestedPlayer::Mailbox(_));
    if args.name.is_some() && !is_named {
        bail!(
            "--name applies only to the players `human` and `mailbox:DIR` and to models (--model); remove it \
             for the player `{player}`"
        );
    }
    let is_shown_prompts = is_named || matches!(requested, RequestedPlayer::Prompted(..));
    if !is_shown_prompts && args.model.prompt.has_flags()? {
        bail!(
            "the prompt flags (--mode, --rules, --with and so on) apply only to players that read prompts; \
             remove them for the \
             player `{player}`"
        );
    }
    Ok(())
}

pub(super) fn requested_player(args: &Args) -> Result<RequestedPlayer, Failure> {
    if let Some(id) = &args.model.client.model {
        return Ok(RequestedPlayer::Model(Box::new(model::RequestedModel::new(id, &args.model)?)));
    }
    let Some(player) = args.player.as_deref() else {
        bail!(
            "no player specified: pass one with --player (`random`, `mcts:100`, \"cmd:python3 \
             my_agent.py\"), or a language model with --model (`openai:ID`)"
        );
    };
    if let Some(file) = player.strip_prefix("replay:") {
        let episode = crate::input::episodes::read(Path::new(file))?;
        return Ok(RequestedPlayer::Replay(Replay::of(&episode)));
    }
    if player == Touching::NAME {
        return Ok(RequestedPlayer::Touching);
    }
    if player == "human" {
        return Ok(RequestedPlayer::Human(args.model.prompt.settings()?));
    }
    if let Some(folder) = player.strip_prefix("mailbox:") {
        return Ok(RequestedPlayer::Mailbox(RequestedMailbox::new(folder, args)?));
    }
    if let Some(command) = player.strip_prefix("cmd:") {
        let process = process(command, args.model.client.timeout()).map_err(Failure::malformed)?;
        #[cfg(unix)]
        process.find().map_err(Failure::malformed)?;
        return Ok(RequestedPlayer::Process(Box::new(process)));
    }
    if player == "reflex" || player.starts_with("planner:") {
        let player: PromptPlayer = player.parse().map_err(Failure::malformed)?;
        return Ok(RequestedPlayer::Prompted(player, args.model.prompt.settings()?));
    }
    let name = if player == "nil" { "do-nothing" } else { player };
    name.parse().map(RequestedPlayer::Planner).map_err(Failure::malformed)
}

/// Creates a player that runs a program.
fn process(command: &str, timeout: Duration) -> Result<Process, String> {
    Process::new(
        command,
        ProcessConfig { timeout, guard: player_guard::command(), ..ProcessConfig::default() },
    )
}
