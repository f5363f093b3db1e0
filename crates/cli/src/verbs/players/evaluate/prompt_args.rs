//! The prompt flags, and the settings that they select.

use crate::failure::Failure;
use crate::input::text::read_text;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use evaluation::Track;
use evaluation::prompt::{Mode, PromptSettings, PromptStyle, Rules};
use serde::de::DeserializeOwned;
use std::path::PathBuf;

/// The maximum size of the advice added to a prompt, in bytes.
const MAX_STRATEGY: usize = 1 << 16;

/// The content and the form of prompts.
#[derive(clap::Args)]
#[command(next_help_heading = "Prompts (see `arcade docs prompts`)")]
pub(crate) struct PromptArgs {
    /// A bundle of prompt settings, whose results are never mixed with those of other settings: the default prompts,
    /// meaningless names, three levels for discovering the rules instead of the rules themselves, or an image instead
    /// of the board (see `arcade docs tracks`)
    #[arg(long, value_parser = PossibleValuesParser::new(Track::ALL.map(Track::name)).map(track_named))]
    pub(super) track: Option<Track>,
    /// The earlier turns that prompts show [default: zero-shot]
    #[arg(long, value_parser = named::<Mode, 2>(Mode::ALL.map(Mode::name)))]
    mode: Option<Mode>,
    /// The layout of prompts
    #[arg(long, value_parser = named::<PromptStyle, 2>(["standard", "reference"]), default_value = "standard")]
    prompt_style: PromptStyle,
    /// The form of the rules in prompts
    #[arg(long, value_parser = named::<Rules, 3>(["described", "vgdl", "none"]), default_value = "described")]
    rules: Rules,
    /// Aids (optional parts of a prompt) to add to the defaults
    #[arg(long, value_enum, value_delimiter = ',', value_name = "AID")]
    with: Vec<Aid>,
    /// Aids to leave out
    #[arg(long, value_enum, value_delimiter = ',', value_name = "AID")]
    without: Vec<Aid>,
    /// Give sprites meaningless names
    #[arg(long)]
    masked_names: bool,
    /// Give each state of the avatar a different character, and do not reveal which characters stand for the
    /// player
    #[arg(long)]
    identity_tracking: bool,
    /// Shuffle the board's characters, with this number as the seed
    #[arg(long, value_name = "N")]
    shuffle_symbols: Option<u64>,
    /// File with advice that prompts include verbatim
    #[arg(long, value_name = "FILE")]
    strategy: Option<PathBuf>,
    /// Maximum number of tokens in a conversation; the oldest turns are left out if there are more [default: 20000]
    #[arg(long, value_name = "N")]
    history_tokens: Option<u64>,
}

/// Parses the name of a track, which is a bundle of prompt settings.
fn track_named(name: String) -> Track {
    let named = Track::ALL.into_iter().find(|track| track.name() == name);
    named.expect("the parser knows the names")
}

/// Returns a parser for a setting's values, by their JSON names.
fn named<T, const N: usize>(names: [&'static str; N]) -> impl TypedValueParser<Value = T>
where
    T: DeserializeOwned + Clone + Send + Sync + 'static,
{
    let value = |name: String| serde_json::from_value(name.into()).expect("the names are those of JSON");
    PossibleValuesParser::new(names).map(value)
}

/// An optional part of a prompt.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, clap::ValueEnum)]
enum Aid {
    /// The meanings of the board's characters
    Legend,
    /// The effects of the keys
    Meanings,
    /// The avatar's position and orientation
    Position,
    /// The result of the previous action
    Feedback,
    /// The board, one character per cell
    Grid,
    /// The cells around the avatar, and the nearest things
    Grounding,
    /// All things and their positions
    Coordinates,
    /// The board again, rotated by a quarter turn
    Rotated,
    /// A line of JSON
    Json,
    /// An image
    Image,
}

impl PromptArgs {
    /// Returns the prompt settings, which come from the track or from the flags.
    ///
    /// # Errors
    ///
    /// Returns a failure if a flag contradicts the track.
    pub(crate) fn settings(&self) -> Result<PromptSettings, Failure> {
        let by_flags = self.by_flags()?;
        let Some(track) = self.track else { return Ok(by_flags) };
        let mut settings = track.settings();
        if let Some(mode) = self.mode {
            if track == Track::Discover && mode != settings.mode {
                bail!(
                    "--mode {} contradicts the track `{}`, whose levels form one conversation; leave out one of the two",
                    mode.name(),
                    track.name()
                );
            }
            settings.mode = mode;
        }
        settings.history_tokens = self.history_tokens.unwrap_or(settings.history_tokens);
        // Values set by flags must equal the values that the track (the bundle of prompt settings) sets.
        let free = PromptSettings {
            mode: settings.mode,
            history_tokens: settings.history_tokens,
            ..PromptSettings::default()
        };
        let asked = PromptSettings { mode: free.mode, history_tokens: free.history_tokens, ..by_flags };
        let of_track = settings.aids_beyond(&free);
        if let Some(aid) = asked.aids_beyond(&free).into_iter().find(|aid| !of_track.contains(aid)) {
            bail!(
                "the track `{}` has fixed settings, which `{aid}` contradicts; leave out the flag for \
                 `{aid}`, or --track",
                track.name()
            );
        }
        Ok(settings)
    }

    /// Returns the ways in which the settings differ from the settings of the track (the bundle of prompt settings), as
    /// listed in results. Without a track, they are compared with the defaults.
    pub(super) fn aids(&self, settings: &PromptSettings) -> Vec<String> {
        let usual = self.track.map_or_else(PromptSettings::default, Track::settings);
        settings.aids_beyond(&usual)
    }

    /// Returns `true` if any prompt flag is set, other than the flag for the track (the bundle of prompt settings).
    pub(super) fn has_flags(&self) -> Result<bool, Failure> {
        Ok(self.by_flags()? != PromptSettings::default())
    }

    fn by_flags(&self) -> Result<PromptSettings, Failure> {
        let strategy = self.strategy.as_deref().map(|path| read_text(path, MAX_STRATEGY)).transpose()?;
        let mut settings = PromptSettings {
            style: self.prompt_style,
            mode: self.mode.unwrap_or_default(),
            rules: self.rules,
            masked_names: self.masked_names,
            identity_tracking: self.identity_tracking,
            shuffled_symbols: self.shuffle_symbols,
            strategy,
            history_tokens: self.history_tokens.unwrap_or(PromptSettings::default().history_tokens),
            ..PromptSettings::default()
        };
        if let Some(both) = self.with.iter().find(|aid| self.without.contains(aid)) {
            let name = both.name();
            bail!("`{name}` is passed to both --with and --without");
        }
        for (aids, on) in [(&self.with, true), (&self.without, false)] {
            for aid in aids {
                match aid {
                    Aid::Legend => settings.legend = on,
                    Aid::Meanings => settings.action_meanings = on,
                    Aid::Position => settings.position = on,
                    Aid::Feedback => settings.feedback = Some(on),
                    Aid::Grid => settings.encodings.grid = on,
                    Aid::Grounding => settings.encodings.grounding = on,
                    Aid::Coordinates => settings.encodings.coordinates = on,
                    Aid::Rotated => settings.encodings.rotated = on,
                    Aid::Json => settings.encodings.json = on,
                    Aid::Image => settings.encodings.image = on,
                }
            }
        }
        Ok(settings)
    }
}

impl Aid {
    fn name(self) -> String {
        let value = clap::ValueEnum::to_possible_value(&self).expect("no aid is hidden");
        value.get_name().to_owned()
    }
}
