//! Recipes: the TOML files in `seeds/` from which releases are minted.

pub(crate) mod apportion;
pub(crate) mod beacon;
mod check;
pub(crate) mod cited;
pub(crate) mod error;
pub(crate) mod known;
pub(crate) mod parts;
mod placement;
pub(crate) mod secret;

use crate::recipe::beacon::BeaconPart;
use crate::recipe::cited::Cited;
use crate::recipe::error::RecipeError;
use crate::recipe::known::Known;
use crate::recipe::parts::{CorpusPart, GeneratedPart, InventedPart, Taxonomy};
use crate::recipe::secret::Secret;
use crate::sections::ceilings::CeilingsPart;
use crate::sections::designs::DesignsPart;
use crate::sections::marks::MarksPart;
use crate::sections::memory::part::MemoryPart;
use crate::sections::puzzles::{PuzzleKind, PuzzlePart};
use crate::sections::tiers::Tiers;
use base::{Digest, Seed};
use forge::games::Board;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use validators::measures::{AvatarKind, GoalKind};
use validators::{Criteria, Criterion, CriterionSet, Difficulty};

/// The parameters that determine the bytes of a release.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Recipe {
    /// The name of the release: lower-case letters, digits and `-`.
    pub name: String,
    /// A description of the release, for its README.
    pub description: String,
    /// The people to cite, in order. If the recipe states neither people nor a publisher, the authors of Infinite
    /// Arcade are cited.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub authors: Vec<String>,
    /// The laboratory or project that publishes the release. The title of the release begins with this name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub publisher: Option<String>,
    /// The text from which the seed is derived. It is public, so the release is open.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<String>,
    /// The commitment to a secret, which replaces `seed` and makes the release sealed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub commitment: Option<Digest>,
    /// The public randomness that is mixed into the seed of a sealed release.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub beacon: Option<BeaconPart>,
    /// The root digest of the previous release.
    #[serde(default)]
    pub parent: Option<Digest>,
    /// New levels for corpus games.
    #[serde(default)]
    pub corpus: CorpusPart,
    /// New games from kernels (hand-written designs), with levels.
    #[serde(default)]
    pub generated: GeneratedPart,
    /// Invented games.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub invented: Option<InventedPart>,
    /// Games from a pool of designs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub designs: Option<DesignsPart>,
    /// New puzzles about pushing things.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub puzzles: Option<PuzzlePart>,
    /// New puzzles about locks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub locks: Option<PuzzlePart>,
    /// New puzzles in which the player carries parcels between carts in a yard.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub yards: Option<PuzzlePart>,
    /// New puzzles about pushing things among strays (deadly sprites that wander at random).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strays: Option<PuzzlePart>,
    /// The sizes of the boards.
    #[serde(default)]
    pub board: Board,
    /// The fraction of all levels with each difficulty. If empty, any difficulty is accepted.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub difficulty: BTreeMap<Difficulty, f64>,
    /// The fraction of all levels in each tier (difficulty class from 1 to 4). If empty, tiers are not measured.
    #[serde(default, skip_serializing_if = "Tiers::is_empty")]
    pub tiers: Tiers,
    /// The reference players, which never change. The release contains their results on each level.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub marks: Option<MarksPart>,
    /// The ceilings: the highest known win rate on each level, by commitment (number of actions per decision).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ceilings: Option<CeilingsPart>,
    /// The secret random choices for memory tests. Each decides between two renamings of a game, or between two wins of
    /// a level.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub memory: Option<MemoryPart>,
    /// The quotas for kinds of games.
    #[serde(default)]
    pub taxonomy: Taxonomy,
    /// The criteria for levels.
    #[serde(default)]
    pub criteria: Criteria,
    /// The content of previous releases, which must not be repeated. It is filled in from the parent.
    #[serde(default, skip_serializing_if = "Known::is_empty")]
    pub known: Known,
}

impl Recipe {
    /// Returns the digest that a commitment covers. The digest excludes `seed`, `commitment`, `known` and the
    /// beacon's value: `known` follows from `parent`, and the beacon's value is not known yet.
    pub fn committed(&self) -> Digest {
        let recipe = serde_json::to_value(self).expect("a recipe is plain data");
        secret::committed(&recipe).expect("a checked recipe contains only finite numbers")
    }

    /// Returns the seed from which everything in the release is derived. `secret` is a sealed release's secret.
    ///
    /// # Errors
    /// Returns an error if the release is sealed and the secret is missing, does not match the commitment, or was
    /// drawn for a different recipe. Also returns an error if the release is open and a secret was provided.
    pub fn root_seed(&self, secret: Option<&Secret>) -> Result<Seed, RecipeError> {
        let Some(secret) = secret else {
            return self.seed.as_deref().map(Seed::from_text).ok_or(RecipeError::Sealed);
        };
        let Some(commitment) = self.commitment else { return Err(RecipeError::Open) };
        if secret.commitment() != commitment {
            Err(RecipeError::OtherSecret)
        } else if secret.recipe != Some(self.committed()) {
            Err(RecipeError::OtherRecipe(self.mismatch_advice(secret)))
        } else {
            let seed = secret.root_seed();
            let Some(beacon) = &self.beacon else { return Ok(seed) };
            let missing =
                || RecipeError::NoBeacon { source_name: beacon.source.clone(), round: beacon.round };
            beacon.mix(seed).ok_or_else(missing)
        }
    }

    /// Returns advice on a mismatch between `secret` and the recipe. The most likely cause of a mismatch is the
    /// recipe's parent.
    fn mismatch_advice(&self, secret: &Secret) -> &'static str {
        let alone = Recipe { parent: None, ..self.clone() };
        match self.parent {
            None => {
                "did you forget --parent? Pass the same parent as with `--commit`, and undo any other changes"
            }
            Some(_) if secret.recipe == Some(alone.committed()) => {
                "only the parent is new, because the commitment has no parent; omit --parent"
            }
            Some(_) => {
                "is --parent a different release? Pass the same parent as with `--commit`, and undo any other changes"
            }
        }
    }

    /// Returns, as sentences, the guarantees that a release from this recipe lacks. The list is empty if the
    /// recipe follows an earlier release and requests gates and `skill`.
    pub fn caveats(&self) -> Vec<&'static str> {
        let mut caveats = Vec::new();
        if self.parent.is_none() && self.new_games() > 0 {
            caveats.push(
                "The release follows no earlier release (`--parent`), so its games are not compared with \
                 other releases, which may have the same rules, and even the same levels, under different \
                 names.",
            );
        }
        if self.generated.games > 0 && self.criteria.ask.only(CriterionSet::GATES).is_empty() {
            caveats.push(
                "The recipe has no gates, so the new games are not tested for being worth playing \
                 (`arcade docs gates`).",
            );
        }
        if self.tiers.is_empty() && !self.criteria.includes(Criterion::Skill) {
            caveats.push(
                "The recipe does not request `skill`, so difficulty is not measured (`arcade docs recipes`).",
            );
        }
        caveats
    }

    /// Returns the names under which the release is cited.
    pub(crate) fn cited(&self) -> Cited<'_> {
        Cited::of(&self.name, &self.authors, self.publisher.as_deref())
    }

    /// Returns the minimum and maximum number of games for each goal.
    pub fn goal_quotas(&self) -> Vec<(GoalKind, (i64, i64))> {
        self.taxonomy.goals.iter().map(|(&goal, &share)| (goal, self.quota(share))).collect()
    }

    /// Returns the minimum and maximum number of games for each avatar.
    pub fn avatar_quotas(&self) -> Vec<(AvatarKind, (i64, i64))> {
        self.taxonomy.avatars.iter().map(|(&avatar, &share)| (avatar, self.quota(share))).collect()
    }

    /// Converts a range of fractions to the minimum and maximum number of games.
    pub(crate) fn quota(&self, (least, most): (f64, f64)) -> (i64, i64) {
        let games = f64::from(self.games());
        // A small tolerance ensures that 0.2 of 10 games is 2.
        ((least * games - 1e-9).ceil() as i64, (most * games + 1e-9).floor() as i64)
    }

    /// Returns the total number of levels in all games.
    pub fn levels(&self) -> u32 {
        let parts = self.puzzle_parts().map(|part| (part.games, part.levels));
        let parts = parts
            .chain(self.invented.as_ref().map(|part| (part.games, part.levels)))
            .chain(self.designs.as_ref().map(|part| (part.games, part.levels)))
            .chain([(self.corpus.games, self.corpus.levels), (self.generated.games, self.generated.levels)]);
        parts.fold(0, |all, (games, levels)| all.saturating_add(games.saturating_mul(levels)))
    }

    /// Returns the total number of games.
    pub fn games(&self) -> u32 {
        self.corpus.games.saturating_add(self.new_games())
    }

    /// Returns the number of games that are not corpus games.
    pub fn new_games(&self) -> u32 {
        let invented = self.invented.as_ref().map_or(0, |part| part.games);
        let designs = self.designs.as_ref().map_or(0, |part| part.games);
        let generated = self.generated.games.saturating_add(invented).saturating_add(designs);
        self.puzzle_parts().fold(generated, |all, part| all.saturating_add(part.games))
    }

    /// Returns the section for one kind of puzzle; `None` if the recipe has no such section.
    pub fn puzzles_of(&self, kind: PuzzleKind) -> Option<&PuzzlePart> {
        match kind {
            PuzzleKind::Pushing => self.puzzles.as_ref(),
            PuzzleKind::Locks => self.locks.as_ref(),
            PuzzleKind::Yards => self.yards.as_ref(),
            PuzzleKind::Strays => self.strays.as_ref(),
        }
    }

    /// Returns the puzzle sections.
    fn puzzle_parts(&self) -> impl Iterator<Item = &PuzzlePart> {
        PuzzleKind::ALL.into_iter().filter_map(|kind| self.puzzles_of(kind))
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::recipe::error::MAX_RECIPE;

    pub(crate) const GOOD: &str =
        "name = 'small'\ndescription = 'a test'\nseed = 'x'\n[generated]\ngames = 2\n";

    pub(crate) fn check(text: &str, expect: &str) {
        let error = Recipe::from_toml(text).unwrap_err().to_string();
        assert!(error.contains(expect), "{error}");
    }

    /// The example in `docs/reference/recipes.md` is a valid recipe, and shows the defaults.
    #[test]
    fn the_example_in_the_docs() {
        let page = include_str!("../../../../docs/reference/recipes.md");
        let example = page.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
        let recipe = Recipe::from_toml(example).unwrap();
        assert_eq!(recipe.taxonomy, Taxonomy::default());
        assert_eq!(recipe.criteria, Criteria::default());
        assert_eq!(recipe.board, Board::default());
        assert_eq!(recipe.generated, GeneratedPart { games: 12, ..GeneratedPart::default() });
        assert_eq!(recipe.corpus, CorpusPart { games: 6, ..CorpusPart::default() });
    }

    #[test]
    fn a_secret_fits_one_recipe() {
        let sealed = |text: &str| GOOD.replace("seed = 'x'\n", "").replace("games = 2", text);
        let recipe = Recipe::to_commit(&sealed("games = 2")).unwrap();
        let secret = Secret::draw("small", recipe.committed(), [7; 64]);
        let minting = Recipe { commitment: Some(secret.commitment()), ..recipe.clone() };
        minting.check().unwrap();
        assert_eq!(minting.root_seed(Some(&secret)).unwrap(), secret.root_seed());
        // The commitment does not cover the `commitment` field itself, nor data from the parent.
        assert_eq!(Recipe::to_commit(GOOD).unwrap().committed(), recipe.committed());
        let known = Known { games: vec!["x".to_owned()], ..Known::default() };
        assert_eq!(Recipe { known, ..minting.clone() }.committed(), recipe.committed());

        let parent = Some(Digest::of(b"parent"));
        for changed in [
            Recipe { parent, ..minting.clone() },
            Recipe { description: "another".to_owned(), ..minting.clone() },
            Recipe { commitment: minting.commitment, ..Recipe::to_commit(&sealed("games = 3")).unwrap() },
        ] {
            let error = changed.root_seed(Some(&secret)).unwrap_err();
            assert!(matches!(error, RecipeError::OtherRecipe(_)), "{error}");
            let hint = if changed.parent.is_some() { "omit --parent" } else { "did you forget --parent?" };
            assert!(error.to_string().contains(hint), "{error}");
        }
        let other = Secret::draw("small", recipe.committed(), [8; 64]);
        let error = minting.root_seed(Some(&other)).unwrap_err();
        assert!(matches!(error, RecipeError::OtherSecret), "{error}");
        assert!(matches!(minting.root_seed(None), Err(RecipeError::Sealed)));
        let open = Recipe::from_toml(GOOD).unwrap();
        assert!(matches!(open.root_seed(Some(&secret)), Err(RecipeError::Open)));
    }

    #[test]
    fn a_recipe_says_what_it_does_not_promise() {
        let bare = Recipe::from_toml(GOOD).unwrap();
        assert_eq!(bare.caveats().len(), 3, "{:?}", bare.caveats());
        let ask = "['not-idle', 'not-random', 'winnable', 'skill', 'tight']";
        let mut full = Recipe::from_toml(&format!("{GOOD}[criteria]\nask = {ask}")).unwrap();
        full.parent = Some(Digest::of(b"parent"));
        assert_eq!(full.caveats(), Vec::<&str>::new());
    }

    #[test]
    fn releases_are_cited_by_their_own_authors() {
        let cited = |more: &str| {
            let recipe = Recipe::from_toml(&format!("{more}{GOOD}")).unwrap();
            let authors: Vec<String> = recipe.cited().authors().into_iter().map(str::to_owned).collect();
            (recipe.cited().title(), authors.join("; "), recipe.cited().sentence().unwrap_or_default())
        };
        let told = |title: &str, authors: &str, sentence: &str| {
            (title.to_owned(), authors.to_owned(), sentence.to_owned())
        };
        assert_eq!(cited(""), told("Infinite Arcade small", "The Infinite Arcade authors", ""));
        assert_eq!(cited("publisher = 'Lab'\n"), told("Lab small", "Lab", "Published by Lab."));
        assert_eq!(
            cited("authors = ['Ada', 'Bo']\n"),
            told("small, made with Infinite Arcade", "Ada; Bo", "By Ada, Bo.")
        );
        assert_eq!(
            cited("authors = ['Ada']\npublisher = 'Lab'\n"),
            told("Lab small", "Ada", "By Ada. Published by Lab.")
        );
    }

    #[test]
    fn commitments_are_complete() {
        assert!(Recipe::to_commit(&GOOD.replace("seed = 'x'\n", "")).is_ok());
        let error = Recipe::to_commit(&GOOD.replace("= 2", "= 0")).unwrap_err().to_string();
        assert!(error.contains("nothing to mint"), "{error}");
    }

    #[test]
    fn recipes_and_their_problems() {
        assert_eq!(Recipe::from_toml(GOOD).unwrap().generated.levels, 3);
        check(&GOOD.replace("games", "gamse"), "unknown field `gamse`");
        check(&GOOD.replace("'x'", "7"), "invalid type");
        check(&GOOD.replace("small", "Small One"), "`name`");
        check(&GOOD.replace("seed = 'x'\n", ""), "`seed` is missing");
        check(
            &GOOD.replace("[generated]", &format!("commitment = '{}'\n[generated]", Digest::of(b""))),
            "public or sealed",
        );
        check(&format!("{GOOD}mix = {{ constructive = 0 }}"), "`generated.mix`");
        check(&format!("{GOOD}mix = {{ evolution = 1 }}"), "unknown field `evolution`");
        let searched = format!("{GOOD}mix = {{ constructive = 1, search = 0.5 }}");
        check(&searched, "`generated.mix` requests kernel games by search");
        check(&searched.replace("search", "evolutionary"), "request games in [invented]");
        assert!(Recipe::from_toml(&searched.replace("0.5", "0")).is_ok());
        assert!(Recipe::from_toml(&searched.replace("[generated]", "[invented]")).is_ok());
        check(&format!("{GOOD}candidates = 0.5"), "`generated.candidates`");
        check(&format!("{GOOD}[difficulty]\nhard = 1.0"), "add `skill` to `criteria.ask`");
        check(&format!("{GOOD}[difficulty]\nhard = 0.5"), "adds up to 0.5");
        check(&format!("{GOOD}[difficulty]\nharsh = 1.0"), "unknown variant `harsh`");
        check(&format!("{GOOD}[taxonomy]\ncrowd = 0.0"), "`taxonomy.crowd`");
        check(&format!("{GOOD}[taxonomy.goals]\nreach = [0.5, 0.2]"), "`taxonomy.goals`");
        check(
            &format!("{GOOD}[taxonomy.goals]\nreach = [0.6, 1.0]\nunlock = [0.6, 1.0]"),
            "at least 4 games, but there are 2",
        );
        check(
            &format!("{GOOD}[taxonomy.avatars]\nwalks = [0.6, 0.9]"),
            "which no number of games out of 2 gives",
        );
        check(&GOOD.replace("= 2", "= 0"), "nothing to mint");
        check(&format!("{GOOD}[corpus.criteria]\nrandom_wins = 2.0"), "`corpus.criteria.random_wins` is 2");
        check(&format!("{GOOD}least_interactions = 1000"), "`generated.least_interactions` is 1000");
        check(&format!("{GOOD}levels = 0"), "`generated.levels` is 0");
        check(
            &format!("{GOOD}kinds = ['herding']"),
            "`generated.kinds` lists the kind `herding`, which has no generator",
        );
        check(&format!("{GOOD}kinds = ['luer']"), "luer");
        let ask = "ask = ['not-idle', 'not-random', 'winnable', 'progression']";
        check(
            &format!("{GOOD}levels = 2\n[criteria]\n{ask}"),
            "at least 3: raise it to 3 or more, or drop `progression`",
        );
        check(&format!("{GOOD}[criteria]\ndepths = []"), "`criteria.depths`");
        check(&format!("{GOOD}[criteria]\nask = ['winnable']"), "lacks `not-idle`");
        check(&format!("{GOOD}[criteria]\nask = ['winable']"), "did you mean `winnable`?");
        check(&format!("{GOOD}[board]\ncolumns = [9, 4]"), "`board.columns`");
        // A line appended to a file becomes part of the file's last table.
        check(
            &format!("{}commitment = '{}'\n", GOOD.replace("seed = 'x'\n", ""), Digest::of(b"")),
            "`commitment` is in the table [generated], but belongs to the recipe as a whole: move the \
             line above the first [table]",
        );
        check(&format!("{GOOD}authors = ['Ada']"), "move the line above the first [table]");
        check(&format!("{GOOD}[corpus.criteria]\nauthors = ['Ada']"), "in the table [corpus.criteria], but");
        check(
            &format!("{GOOD}[generated.board]\nrows = [9, 9]"),
            "write [board] instead of [generated.board]",
        );
        check(&format!("games = 6\n{GOOD}"), "`games` belongs in [generated] or [invented] or [corpus]");
        check(&format!("authors = ['']\n{GOOD}"), "`authors` takes");
        check(&format!("publisher = ' '\n{GOOD}"), "`publisher` takes");
        check("name = ", "expected");
        check(&GOOD.replace("games = 2", "games = 4294967295"), "games");
        check(&"#".repeat(MAX_RECIPE + 1), "larger than");
    }
}
