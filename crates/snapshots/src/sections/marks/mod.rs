//! Marks, or reference results: the results of fixed players on a release's levels, stored in the release for
//! comparison with other players.
//!
//! The recipe specifies the players. When the release is minted, they play each level with each commitment (the
//! number of actions per decision), and their results are stored in a file of the release. In a sealed release, this
//! file is withheld, so that the difficulty of the levels is not revealed early.

mod check;
mod compare;
mod section;
mod steps;
mod words;

pub use compare::{MarkDifference, mark_differences};

pub(crate) use section::MarksSection;
pub use steps::{Fall, Falls};

use crate::card::rungs::Clustered;
use crate::format::layout::HELD;
use crate::format::manifest::Manifest;
use crate::format::manifest::item::ReleaseKind;
use crate::recipe::error::{RecipeError, wrong};
use agents::{Budget, PlannerSpec};
use itertools::Itertools;
use serde::{Deserialize, Serialize};
use std::fmt::Debug;
use validators::{Commitment, Tier};

/// The file with the reference results. In a sealed release, it is stored in [`HELD`].
pub const MARKS_FILE: &str = "MARKS.json";

/// The version of the file format.
pub const MARKS_FORMAT: u32 = 1;

/// The maximum number of reference players that a recipe can request.
const MOST_PLAYERS: usize = 16;
/// The maximum number of episodes per player, commitment (number of actions per decision) and level.
const MOST_PLAYS: u64 = 20;
/// The maximum number of actions per episode that a recipe can request.
const MOST_STEPS: u64 = 2000;
/// The maximum number of forward-model calls per decision that a recipe can request.
const MOST_CALLS: u64 = 2000;
/// The maximum number of forward-model calls per plan that a recipe can request.
const MOST_PLAN_CALLS: u64 = 100_000;

/// The average length of an episode, as a fraction of the maximum length.
const PLAYED: f64 = 0.5;
/// The cost of a forward-model call, in seconds.
const CALL: f64 = 1e-6;
/// The cost of a prompt and its answer, in seconds.
const PROMPT: f64 = 3e-3;

/// The planner that searches for whole plans.
const PLANNING: &str = "systematic";
/// The fraction of [`PLANNING`]'s call budget that is spent per action. In stochastic games, a ten-tick plan
/// gets a tenth of the calls. In deterministic games, the planner searches for only a few plans per episode.
const PLANNED: f64 = 0.01;

/// The player that ignores the rules and reads no prompts.
const TOUCHING: &str = "touch-everything";

base::with_defaults! {
    /// The reference results that a recipe requests.
    #[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct MarksPart {
        /// The players, in the notation of `arcade evaluate --player`. The name of a planner includes its call budget
        /// per decision.
        pub players: Vec<String> = names(&["random", "touch-everything", "nearest-goal", "reflex", "width:200", "guided-mcts:200", "olets:200"]),
        /// The numbers of actions that the players commit to at each decision.
        pub commits: Vec<Commitment> = vec![Commitment::One, Commitment::Five, Commitment::Twenty, Commitment::All],
        /// The number of episodes per player, commitment (number of actions per decision) and level.
        pub plays: u64 = 2,
        /// The maximum number of actions per episode.
        pub max_steps: u64 = 400,
    }
}

fn names(of: &[&str]) -> Vec<String> {
    of.iter().map(|&name| name.to_owned()).collect()
}

impl MarksPart {
    /// Checks the values. [`MarkPlayers::check`] checks the names of players that are not planners.
    ///
    /// # Errors
    /// Returns an error for the first value that is out of range.
    pub(crate) fn check(&self) -> Result<(), RecipeError> {
        for (key, value, most) in
            [("marks.plays", self.plays, MOST_PLAYS), ("marks.max_steps", self.max_steps, MOST_STEPS)]
        {
            if !(1..=most).contains(&value) {
                return wrong(key, format!("is {value}; the value must be from 1 to {most}"));
            }
        }
        if self.players.is_empty() || self.players.len() > MOST_PLAYERS || !self.players.iter().all_unique() {
            return wrong("marks.players", format!("takes 1 to {MOST_PLAYERS} different players"));
        }
        if self.commits.is_empty()
            || !self.commits.iter().all_unique()
            || self.commits.contains(&Commitment::None)
        {
            let known =
                Commitment::ALL.iter().skip(1).map(|commit| format!("\"{}\"", commit.name())).join(", ");
            return wrong("marks.commits", format!("takes distinct values from {known}"));
        }
        for player in &self.players {
            let Ok(spec) = player.parse::<PlannerSpec>() else { continue };
            let calls = spec.budget().map_or(0, |Budget(calls)| calls);
            let most = if spec.name() == PLANNING { MOST_PLAN_CALLS } else { MOST_CALLS };
            if calls > most || calls == 0 && spec.spends_its_budget() {
                let help = format!("takes planners with 1 to {most} calls per decision");
                return wrong(
                    "marks.players",
                    format!("contains `{player}`; the list {help}, such as `olets:200`"),
                );
            }
        }
        Ok(())
    }

    /// Estimates the cost of a level's reference results, in core seconds on the machine described in
    /// docs/reference/recipes.md. In a deterministic game, planners play once for all commitments (numbers of actions
    /// per decision).
    pub(crate) fn seconds(&self, is_certain: bool) -> f64 {
        let looks = |commit: &Commitment| commit.actions().map_or(0.0, |actions| 1.0 / actions as f64);
        let of = |player: &String| match player.parse::<PlannerSpec>() {
            Ok(spec) if !spec.spends_its_budget() => 0.0,
            Ok(spec) => {
                let commits = if is_certain { 1 } else { self.commits.len() };
                let share = if spec.name() == PLANNING { PLANNED } else { 1.0 };
                CALL * share * spec.budget().map_or(0, |Budget(calls)| calls) as f64 * commits as f64
            }
            Err(_) if player == TOUCHING => 0.0,
            Err(_) => PROMPT * self.commits.iter().map(looks).sum::<f64>(),
        };
        let actions = PLAYED * (self.plays * self.max_steps) as f64;
        actions * self.players.iter().map(of).sum::<f64>()
    }
}

/// The interface for running the reference players. The evaluation crate implements it, because this crate does not
/// depend on the evaluation crate.
pub trait MarkPlayers: Sync + Debug {
    /// Checks that a player with the given name exists.
    ///
    /// # Errors
    /// Returns a message if the player does not exist.
    fn check(&self, player: &str) -> Result<(), String>;

    /// Plays a game's levels, and returns the number of episodes won for each level, player and commitment (number of
    /// actions per decision). The result depends only on the texts and the request.
    ///
    /// # Errors
    /// Returns a message if a player cannot play the game.
    fn play(&self, game: &str, levels: &[String], asked: &MarksPart) -> Result<Vec<Wins>, String>;
}

/// The numbers of episodes won on a level, as one list per player with one number per commitment (number of actions per
/// decision).
pub type Wins = Vec<Vec<u64>>;

/// The content of [`MARKS_FILE`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Marks {
    /// The release's canary: an identifier that shows whether a text corpus contains the release.
    pub canary: String,
    /// The version of the format: [`MARKS_FORMAT`].
    pub format: u32,
    /// The recipe's request.
    pub asked: MarksPart,
    /// The win rate of each player with each commitment (number of actions per decision), first in each tier (lowest
    /// tier first) and then over all levels.
    pub rates: Vec<MarkRate>,
    /// The decreases in win rate from each tier (difficulty class) to the next higher one, and from each commitment
    /// (number of actions per decision) to the next longer one.
    pub falls: Falls,
    /// The games, ordered by folder name.
    pub games: Vec<GameMarks>,
}

/// A game's reference results.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GameMarks {
    /// The name of the game's folder.
    pub id: String,
    /// The game's levels.
    pub levels: Vec<LevelMarks>,
}

/// A level's reference results.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LevelMarks {
    /// The level's tier (difficulty class).
    pub tier: Tier,
    /// The number of episodes won, by player and commitment (number of actions per decision).
    pub wins: Wins,
}

/// A player's win rate with one commitment (number of actions per decision) on the levels of one tier (difficulty
/// class).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MarkRate {
    /// The tier (difficulty class); `None` for all levels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tier: Option<Tier>,
    /// The reference player.
    pub player: String,
    /// The number of actions that the player commits to at each decision.
    pub commit: Commitment,
    /// The number of levels.
    pub levels: u64,
    /// The mean over levels of the fraction of episodes won, with its interval clustered by game.
    pub rate: Clustered,
}

impl Marks {
    /// Combines the reference results of several games.
    pub(crate) fn of(canary: &str, asked: &MarksPart, mut games: Vec<GameMarks>) -> Marks {
        games.sort_by(|one, other| one.id.cmp(&other.id));
        let (rates, falls) = (rates(asked, &games), Falls::of(asked, &games));
        Marks { canary: canary.to_owned(), format: MARKS_FORMAT, asked: asked.clone(), rates, falls, games }
    }

    /// Parses the reference results of a release.
    ///
    /// # Errors
    /// Returns a message if the text does not contain reference results in this format.
    pub fn read(text: &[u8]) -> Result<Marks, String> {
        let marks: Marks = serde_json::from_slice(text).map_err(|error| error.to_string())?;
        match marks.format {
            MARKS_FORMAT => Ok(marks),
            other => Err(format!("format {other} is not {MARKS_FORMAT}: use a different arcade version")),
        }
    }

    /// Returns the file's path in a release of the given kind.
    pub fn path(kind: ReleaseKind) -> String {
        match kind {
            ReleaseKind::Open => MARKS_FILE.to_owned(),
            ReleaseKind::Sealed => format!("{HELD}{MARKS_FILE}"),
        }
    }

    /// Returns the path of the reference results according to a manifest; `None` if the manifest's recipe
    /// requests no reference results.
    pub fn path_in(manifest: &Manifest) -> Option<String> {
        manifest.recipe.get("marks").filter(|part| !part.is_null()).map(|_| Marks::path(manifest.kind))
    }
}

/// Computes the win rates, in the order of [`Marks::rates`].
fn rates(asked: &MarksPart, games: &[GameMarks]) -> Vec<MarkRate> {
    let has = |tier: &Tier| games.iter().flat_map(|game| &game.levels).any(|level| level.tier == *tier);
    let tiers = Tier::ALL.into_iter().filter(has).map(Some).chain([None]);
    let mut rates = Vec::new();
    for tier in tiers {
        let of_tier = |level: &&LevelMarks| tier.is_none_or(|tier| level.tier == tier);
        for (player, name) in asked.players.iter().enumerate() {
            for (commit, &commitment) in asked.commits.iter().enumerate() {
                let played = |game: &GameMarks| -> Vec<(u64, u64)> {
                    let levels = game.levels.iter().filter(of_tier);
                    levels.map(|level| (level.wins[player][commit], asked.plays)).collect()
                };
                let mut of_games: Vec<Vec<(u64, u64)>> = games.iter().map(played).collect();
                of_games.retain(|levels| !levels.is_empty());
                if of_games.is_empty() {
                    continue;
                }
                rates.push(MarkRate {
                    tier,
                    player: name.clone(),
                    commit: commitment,
                    levels: of_games.iter().map(Vec::len).sum::<usize>() as u64,
                    rate: Clustered::of(&of_games),
                });
            }
        }
    }
    rates
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::recipe::Recipe;
    use crate::recipe::tests::{GOOD, check};

    /// Returns a request with two players and two commitments.
    pub(crate) fn asked() -> MarksPart {
        MarksPart {
            players: names(&["random", "olets:9"]),
            commits: vec![Commitment::One, Commitment::All],
            plays: 2,
            max_steps: 50,
        }
    }

    /// Returns reference results for games with one level of tier 1 and one of tier 4.
    pub(crate) fn marks(ids: &[&str], wins: impl Fn(usize, Tier) -> Wins) -> Marks {
        let level = |game, tier| LevelMarks { tier, wins: wins(game, tier) };
        let game = |(at, id): (usize, &&str)| GameMarks {
            id: (*id).to_owned(),
            levels: vec![level(at, Tier::One), level(at, Tier::Four)],
        };
        Marks::of("canary", &asked(), ids.iter().enumerate().map(game).collect())
    }

    #[test]
    fn rates_are_of_tiers_players_and_commitments() {
        let ids = ["b", "a", "c", "d", "e", "f"];
        let easy = |_, tier| match tier {
            Tier::One => vec![vec![1, 0], vec![2, 2]],
            _ => vec![vec![0, 0], vec![1, 0]],
        };
        let marks = marks(&ids, easy);
        assert_eq!(marks.games[0].id, "a");
        let told: Vec<(Option<Tier>, &str, Commitment, f64)> = marks
            .rates
            .iter()
            .map(|rate| (rate.tier, rate.player.as_str(), rate.commit, rate.rate.mean))
            .collect();
        let (one, all) = (Commitment::One, Commitment::All);
        assert_eq!(
            told[..5],
            [
                (Some(Tier::One), "random", one, 0.5),
                (Some(Tier::One), "random", all, 0.0),
                (Some(Tier::One), "olets:9", one, 1.0),
                (Some(Tier::One), "olets:9", all, 1.0),
                (Some(Tier::Four), "random", one, 0.0),
            ]
        );
        assert_eq!(
            told[8..],
            [
                (None, "random", one, 0.25),
                (None, "random", all, 0.0),
                (None, "olets:9", one, 0.75),
                (None, "olets:9", all, 0.5),
            ]
        );
        let rate = &marks.rates[8];
        assert_eq!((rate.levels, rate.rate.games, rate.rate.wins, rate.rate.plays), (12, 6, 6, 24));
        let text = serde_json::to_vec(&marks).unwrap();
        assert_eq!(Marks::read(&text), Ok(marks));
    }

    #[test]
    fn requests_stay_within_bounds() {
        let marks = |text: &str| format!("{GOOD}[marks]\n{text}");
        assert_eq!(Recipe::from_toml(&marks("")).unwrap().marks, Some(MarksPart::default()));
        check(&marks("plays = 0"), "`marks.plays` is 0; the value must be from 1 to 20");
        check(&marks("max_steps = 2001"), "`marks.max_steps` is 2001");
        check(&marks("players = []"), "takes 1 to 16 different players");
        check(&marks("players = ['random', 'random']"), "different players");
        check(&marks("players = ['olets']"), "contains `olets`");
        check(&marks("players = ['mcts:5000']"), "contains `mcts:5000`");
        check(&marks("commits = ['none']"), "`marks.commits` takes distinct values from \"1\", \"2\"");
        check(&marks("commits = ['7']"), "unknown variant `7`");
        check(&marks("games = 3"), "unknown field `games`");
        // Recipes that request no reference results are serialised as before.
        assert!(serde_json::to_value(Recipe::from_toml(GOOD).unwrap()).unwrap().get("marks").is_none());
    }
}
