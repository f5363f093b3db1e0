//! The players for each track, which is a bundle of prompt settings.

use super::Args;
use super::player::RequestedPlayer;
use crate::console::Console;
use crate::failure::Failure;
use evaluation::predictions::Trials;
use evaluation::serve::PromptPlayer;
use evaluation::{Subject, Track};

/// Rejects a player that cannot play on the track. The message lists the suitable players.
///
/// # Errors
///
/// Returns a failure if the player sees more than the track shows, or cannot read what the track shows.
pub(super) fn check(args: &Args, requested: &RequestedPlayer) -> Result<(), Failure> {
    let Some(track) = args.model.prompt.track else { return Ok(()) };
    let player = args.player.as_deref().unwrap_or_default();
    let name = track.name();
    let refuse = |why: &str| {
        Err(malformed!(
            "`{player}` cannot play on the track `{name}`: {why} (`arcade docs tracks` lists who can)"
        ))
    };
    if track == Track::Discover && !args.commit.is_one() {
        bail!(
            "--commit {} contradicts the track `discover`, which reports what each action does; leave out \
             one of the two",
            args.commit
        );
    }
    match (requested, track) {
        (RequestedPlayer::Planner(spec), Track::Masked | Track::Discover | Track::Vision) => {
            match spec.name() {
                "random" | "random-with-nil" | "do-nothing" => Ok(()),
                _ => refuse(
                    "the player plans with the rules and the state, whatever prompts show; leave out --track",
                ),
            }
        }
        (RequestedPlayer::Replay(_), _) => refuse("the player repeats an episode; leave out --track"),
        (RequestedPlayer::Human(_), Track::Vision) => {
            refuse("a terminal cannot show images; `mailbox:DIR` puts a PNG file beside each prompt")
        }
        (RequestedPlayer::Human(_), Track::Discover) => refuse(
            "the answer to the last question has several lines; use `mailbox:DIR`, where people \
                    write whole answers",
        ),
        (RequestedPlayer::Touching, Track::Vision) => {
            refuse("the player cannot read images; choose `told`, `masked` or `discover`")
        }
        (RequestedPlayer::Prompted(PromptPlayer::Reflex, _), Track::Discover) => {
            refuse("the player needs the rules; use `touch-everything`, which plays without rules")
        }
        (RequestedPlayer::Prompted(PromptPlayer::Planner(_), _), _) => {
            refuse("the player needs the rules as VGDL; leave out --track, and pass --rules vgdl")
        }
        (RequestedPlayer::Prompted(..), Track::Vision) => {
            refuse("the player reads the board as text, not as an image; choose `told` or `masked`")
        }
        (RequestedPlayer::Process(_), Track::Vision) => refuse(
            "programs are sent the board as lines of JSON; a program that reads images plays through \
             `mailbox:DIR`, or as a server with --model and --base-url",
        ),
        _ => Ok(()),
    }
}

/// Prints a note about games in which exploring carries no risk.
pub(super) fn advise(track: Option<Track>, subjects: &[Subject], console: &Console) {
    if track != Some(Track::Discover) {
        return;
    }
    let is_free = |subject: &&Subject| Trials::of(subject).costly.is_empty();
    let free: Vec<&str> = subjects.iter().filter(is_free).map(|subject| subject.id.as_str()).collect();
    if !free.is_empty() {
        console.remark(format_args!(
            "in {}, no contact does harm or costs points, so exploring is risk-free (`arcade docs tracks` \
             says which games suit `discover`)",
            free.join(", ")
        ));
    }
}
