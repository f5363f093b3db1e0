//! The choice of levels by their difficulty on a scale, with `--plan`, `--adaptive` and their targets.

use super::Args;
use super::player::RequestedPlayer;
use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::flags::numbers::number;
use crate::whole_file;
use base::Digest;
use base::MessagePath;
use base::count;
use evaluation::run::{Adaptive, MAX_EPISODES};
use evaluation::scale::{AdaptiveChoice, Plan, PlannedErrors, ScaleFile, ScaledLevels, Target};
use evaluation::{Settings, Subject};
use serde_json::json;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

/// The accepted range for targets, in logits.
const TARGETS: RangeInclusive<f64> = 0.001..=100.0;
/// The range of abilities for which levels can be planned, in logits. Below it, every episode is lost, and
/// above it, every episode is won.
const ABILITIES: RangeInclusive<f64> = -20.0..=20.0;

/// The file in a results folder that records an adaptive choice.
const SELECTION_FILE: &str = "selection.json";

#[derive(clap::Args)]
pub(super) struct ChoiceArgs {
    /// Choose the levels by this scale (a file from `arcade study calibrate`) to reach a target, spreading them over
    /// games first; --runs is the maximum number of episodes per level
    #[arg(long, value_name = "FILE", help_heading = "Choice of levels")]
    scale: Option<PathBuf>,
    /// Choose enough levels to reach this standard error of the ability, in logits
    #[arg(
        long,
        value_name = "LOGITS",
        requires = "scale",
        group = "target",
        help_heading = "Choice of levels",
        value_parser = number(TARGETS)
    )]
    target_error: Option<f64>,
    /// Choose enough levels to detect an ability difference of this size, in logits, between two players on the same
    /// levels. The difference is detected in 80 of 100 evaluations
    #[arg(
        long,
        value_name = "LOGITS",
        requires = "scale",
        group = "target",
        conflicts_with = "adaptive",
        help_heading = "Choice of levels",
        value_parser = number(TARGETS)
    )]
    target_difference: Option<f64>,
    /// Choose this number of episodes; with --target-error and --adaptive, the maximum number
    #[arg(long, value_name = "N", requires = "scale", help_heading = "Choice of levels", value_parser = clap::value_parser!(u64).range(1..=MAX_EPISODES))]
    episodes: Option<u64>,
    /// The ability that the plan assumes, in logits [default: 0, the mean difficulty of the first month]
    #[arg(
        long,
        value_name = "LOGITS",
        requires = "scale",
        conflicts_with = "adaptive",
        allow_hyphen_values = true,
        help_heading = "Choice of levels",
        value_parser = number(ABILITIES)
    )]
    ability: Option<f64>,
    /// Print only the chosen levels, their number, and the expected errors
    #[arg(long, requires = "scale", conflicts_with = "adaptive", help_heading = "Choice of levels")]
    plan: bool,
    /// Choose each level based on the episodes so far: the most informative level at the ability estimated from them.
    /// The choices are recorded in selection.json
    #[arg(long, requires = "scale", help_heading = "Choice of levels")]
    adaptive: bool,
    /// Number of episodes that --adaptive chooses at a time, to be played concurrently
    #[arg(long, value_name = "N", default_value_t = 1, requires = "adaptive", help_heading = "Choice of levels", value_parser = clap::value_parser!(u64).range(1..=1000))]
    batch: u64,
}

/// The method for choosing an evaluation's levels.
pub(super) enum Choice {
    /// All levels specified by the user.
    All,
    /// The levels of a plan. The settings already contain only these levels.
    Planned(Box<Plan>),
    /// One level after another, each chosen based on the results so far.
    Adaptive(Box<AdaptiveChoice>),
}

/// Chooses the levels: either restricts the settings and subjects to a plan's levels, or prepares an adaptive
/// choice.
pub(super) fn choose(
    args: &Args,
    requested: &RequestedPlayer,
    settings: &mut Settings,
    subjects: &mut Vec<Subject>,
    console: &Console,
) -> Result<Choice, Failure> {
    let ChoiceArgs { scale: Some(path), target_error, target_difference, episodes, ability, .. } =
        &args.choice
    else {
        return Ok(Choice::All);
    };
    let scale = ScaleFile::read(path)?;
    if args.max_steps.is_none() {
        settings.max_steps = scale.max_steps;
    }
    if let Some(flags) = settings.apart_from(scale.max_steps) {
        bail!(
            "{flags}: this scale requires --max-steps {}, --commit 1 and the track `told`",
            scale.max_steps
        );
    }
    let is_reader = !matches!(requested, RequestedPlayer::Planner(_));
    let levels = ScaledLevels::of(&scale, &settings.games, is_reader).map_err(|level| {
        malformed!(
            "{level} is not on the scale {}; `arcade study calibrate --scale` adds a release",
            path.in_message()
        )
    })?;
    if !levels.is_linked {
        console.remark(
            "warning: too few anchors (readers that never change) have played this release, so `arcade study scale` cannot place the player; the errors below hold only for comparisons on this release; to calibrate the release, evaluate two anchors (--readers)",
        );
    }
    if args.choice.adaptive {
        if matches!(requested, RequestedPlayer::Mailbox(_)) {
            bail!(
                "--adaptive chooses episodes one at a time, but a mailbox offers all of them at once; use \
                 --plan"
            );
        }
        if args.dry_run {
            bail!(
                "--adaptive has no forecast, because its choices depend on which episodes are won; use \
                   --plan for a fixed choice with a forecast"
            );
        }
        if target_error.is_none() && episodes.is_none() {
            bail!("--adaptive needs a stopping condition: pass --target-error, --episodes, or both");
        }
        let all = settings.games.iter().map(|game| game.levels.len() as u64).sum::<u64>() * settings.runs;
        let bytes = disk::read(path, u64::MAX).map_err(|error| Failure::read(path, error))?;
        let bytes = bytes.unwrap_or_default();
        settings.adaptive = Some(Adaptive {
            scale: Digest::of(&bytes),
            episodes: episodes.unwrap_or(all).min(all),
            error: *target_error,
            batch: args.choice.batch,
        });
        let choice = AdaptiveChoice::new(&levels, settings).expect("the settings are adaptive");
        return Ok(Choice::Adaptive(Box::new(choice)));
    }
    let target = match (target_error, target_difference, episodes) {
        (Some(error), None, None) => Target::Error(*error),
        (None, Some(difference), None) => Target::Difference(*difference),
        (None, None, Some(episodes)) => Target::Episodes(*episodes),
        _ => {
            bail!("--scale needs exactly one target: --target-error, --target-difference or --episodes")
        }
    };
    let plan = levels.plan(ability.unwrap_or(0.0), target, settings.runs);
    settings.runs = plan.runs;
    let mut kept = plan.levels.iter();
    for subject in subjects.iter_mut() {
        let of = kept.next().expect("a plan has all games");
        let mut at = 0..;
        subject.levels.retain(|_| at.next().is_some_and(|at: usize| of.contains(&at)));
    }
    subjects.retain(|subject| !subject.levels.is_empty());
    settings.games = evaluation::Evaluation::entries(subjects);
    Ok(Choice::Planned(Box::new(plan)))
}

impl Args {
    /// Returns `true` if the user requested only the plan.
    pub(super) fn only_plans(&self) -> bool {
        self.choice.plan
    }
}

/// Prints an evaluation plan.
pub(super) fn print(plan: &Plan, settings: &Settings, console: &Console) -> Answer {
    let games: Vec<_> = settings
        .games
        .iter()
        .map(|game| json!({ "game": game.id, "levels": game.levels.iter().map(|level| level.number).collect::<Vec<_>>() }))
        .collect();
    console.document(&json!({
        "target": plan.target, "ability": plan.ability, "is_reached": plan.is_reached, "runs": plan.runs, "games": games,
        "errors": plan.errors, "others": plan.others,
    }))?;
    console.say(words(plan));
    for game in &settings.games {
        let numbers: Vec<String> = game.levels.iter().map(|level| level.number.to_string()).collect();
        console.say(format_args!(
            "  {}: {} {}",
            game.id,
            if numbers.len() == 1 { "level" } else { "levels" },
            numbers.join(", ")
        ));
    }
    console.say("\nepisodes  games  error  difference detected in 80% of evaluations");
    for PlannedErrors { episodes, games, error, difference } in &plan.others {
        console.say(format_args!("{episodes:>8}  {games:>5}  {error:>5.2}  {difference:>10.2}"));
    }
    Ok(plan.is_reached)
}

/// Returns a sentence describing a plan.
pub(super) fn words(plan: &Plan) -> String {
    let PlannedErrors { episodes, games, error, difference } = plan.errors;
    let runs = if plan.runs > 1 { format!(", {} on each level", plan.runs) } else { String::new() };
    let reached = match plan.is_reached {
        true => "",
        false => "; these levels cannot reach the target: raise --runs, or use a larger release",
    };
    format!(
        "{} on {}{runs}: at an ability of {:+.1}, the standard error is {error:.2} logits, and the \
         detectable difference between two players is {difference:.2}{reached}",
        count(episodes as usize, "episode"),
        count(games as usize, "game"),
        plan.ability
    )
}

/// Records an adaptive evaluation's choices, and returns a sentence with their number, the ability and its
/// error.
pub(super) fn record(choice: &AdaptiveChoice, folder: &Path) -> Result<String, Failure> {
    let text = serde_json::to_string_pretty(&json!({ "format": 1, "choices": choice.choices() }));
    let text =
        text.map_err(|error| Failure::environment(error, "the choices cannot be written as JSON"))? + "\n";
    whole_file::write(&folder.join(SELECTION_FILE), text.as_bytes())?;
    let (ability, error) = choice.ability();
    Ok(format!(
        "{} chosen; ability about {ability:+.2}, error {error:.2}: run `arcade study scale` for the breakdown",
        count(choice.choices().len(), "episode")
    ))
}
