//! Genomes of games: the representation that a search varies.

use super::assemble;
use super::composition::Composition;
use super::constructive::{GameConfig, GeneratedGame};
use super::draft::{Draft, Ending, HERO};
use super::edit::Edit;
use super::english;
use super::kind::Kind;
use super::mechanics;
use super::pattern::{Feature, Goal, Pattern};
use super::theme::Theme;
use crate::GenerateError;
use engine::{Digest, Game, Seed, syntax};
use std::fmt;

/// The maximum number of compositions to draw for one game: a goal may find no fitting patterns, or the mechanics may not
/// depend on each other.
const DRAWS: u64 = 64;
/// The number of ticks in one unit of a goal's time.
const TIME: u32 = 50;
/// The same where the hero has to survive until time is up.
const SIEGE_TIME: u32 = 20;

/// A pattern with the seed to build it.
#[derive(Clone, Copy)]
pub(crate) struct Gene {
    pub(crate) pattern: &'static Pattern,
    pub(crate) seed: Seed,
}

/// A game as a typed tree: a theme, patterns with a seed for each, and typed edits of the result.
///
/// The same genome builds the same game on every machine. All genomes returned by
/// [`ConstructiveGames`](super::ConstructiveGames) and [`GameVariation`](super::GameVariation) build.
#[derive(Clone)]
pub struct GameGenome {
    pub(crate) theme_draw: ThemeDraw,
    pub(crate) goal: &'static Goal,
    /// The way of moving, the goal, then threats, obstacles and boons: in build order.
    pub(crate) genes: Vec<Gene>,
    /// The number of units of time until the game is over.
    pub(crate) time: u32,
    pub(crate) edits: Vec<Edit>,
}

/// The theme of a game, and the draws of its names.
#[derive(Clone, Copy)]
pub(crate) struct ThemeDraw {
    pub(crate) theme: &'static Theme,
    pub(crate) names: Seed,
    /// The hero's task, for the title.
    pub(crate) title_word: &'static str,
}

impl ThemeDraw {
    pub(crate) fn draw(kind: Kind, seed: Seed) -> ThemeDraw {
        let mut sampler = seed.child("fiction", 0).sampler();
        let theme = *sampler.choose(Theme::ALL);
        ThemeDraw { theme, names: seed.child("names", 0), title_word: kind.title_word(&mut sampler) }
    }
}

impl GameGenome {
    /// Draws patterns that go together, and a theme.
    ///
    /// # Errors
    /// If no kinds are allowed, or generation fails with this seed. The game may still fail to compile: see
    /// [`build`](GameGenome::build).
    pub(crate) fn draw(config: &GameConfig, seed: Seed) -> Result<GameGenome, GenerateError> {
        if config.kinds.is_empty() {
            return Err(GenerateError::Unsuitable("no kinds of games are allowed".to_owned()));
        }
        let drawn = (0..DRAWS).find_map(|draw| {
            let sampler = &mut seed.child("composition", draw).sampler();
            let genome = GameGenome::compose(Composition::draw(&config.kinds, sampler)?, seed);
            (mechanics::dependencies(&genome.draft().0) > 0).then_some(genome)
        });
        drawn.ok_or_else(|| GenerateError::Unlucky("no goal found fitting patterns".to_owned()))
    }

    /// Makes a genome of these patterns, with a theme for them.
    fn compose(Composition { goal, patterns }: Composition, seed: Seed) -> GameGenome {
        let (least, most) = goal.ticks;
        let genes = patterns.into_iter().enumerate();
        GameGenome {
            theme_draw: ThemeDraw::draw(goal.kind, seed),
            goal,
            genes: genes
                .map(|(at, pattern)| Gene { pattern, seed: seed.child(pattern.name, at as u64) })
                .collect(),
            time: seed.child("time", 0).sampler().between(least as usize, most as usize) as u32,
            edits: Vec::new(),
        }
    }

    /// The kind of game.
    pub fn kind(&self) -> Kind {
        self.goal.kind
    }

    /// The number of edits.
    pub fn edits(&self) -> usize {
        self.edits.len()
    }

    /// Builds the game. Cost: well under a millisecond.
    ///
    /// # Errors
    /// If the rules do not compile, or if the compiler or the analysis warns about them, for example that the game cannot
    /// be won.
    pub fn build(&self) -> Result<GeneratedGame, GenerateError> {
        let draft = self.draft().0;
        let game = self.lay_out(draft);
        // Compiles the printed text: frozen games are compiled from it.
        match Game::from_source(&syntax::print(&game.description)) {
            Ok(compiled) if compiled.warnings().is_empty() => Ok(game),
            Ok(compiled) => Err(GenerateError::Unlucky(format!(
                "the rules compile with a warning: {}",
                compiled.warnings()[0].message
            ))),
            Err(problems) => Err(GenerateError::Unlucky(format!("the rules do not compile: {problems}"))),
        }
    }

    /// The digest of the printed rules: genomes with the same key build the same rules under the same names. Cost: that
    /// of building without compiling.
    pub fn key(&self) -> Digest {
        Digest::of(syntax::print_bare(&assemble::describe(&self.draft().0)).as_bytes())
    }

    /// Builds the patterns and applies the edits; returns the draft with the edits that changed something.
    pub(crate) fn draft(&self) -> (Draft, Vec<Edit>) {
        let mut draft = Draft::new(self.theme_draw.theme, self.theme_draw.names);
        for (number, gene) in self.genes.iter().enumerate() {
            draft.gene = Some(number);
            (gene.pattern.build)(&mut draft, &mut gene.seed.sampler());
        }
        // Every game ends: it is lost when time is up, or won where surviving is the goal.
        let waiting = draft.endings.iter_mut().find(|(ending, _)| matches!(ending, Ending::Timeout(_)));
        match waiting {
            Some((ending, _)) => *ending = Ending::Timeout(SIEGE_TIME * self.time),
            None => draft.endings.push((Ending::Timeout(TIME * self.time), false)),
        }
        assemble::complete(&mut draft);
        let made = self.edits.iter().filter(|edit| edit.apply(&mut draft).is_some()).copied().collect();
        (draft, made)
    }

    fn lay_out(&self, mut draft: Draft) -> GeneratedGame {
        let title = draft.title(self.theme_draw.title_word);
        let patterns = self.genes.iter().map(|gene| gene.pattern.name).chain([self.theme_draw.theme.name]);
        let edits = self.edits.iter().map(Edit::name);
        GeneratedGame {
            description: assemble::describe(&draft),
            title,
            summary: summary(&draft),
            goal: format!("{}.", english::capital(&draft.goal)),
            kind: self.goal.kind,
            real_time: self.gives(Feature::Movers),
            patterns: patterns.chain(edits).map(str::to_owned).collect(),
        }
    }

    /// Returns `true` if some pattern has this feature.
    fn gives(&self, feature: Feature) -> bool {
        self.genes.iter().any(|gene| gene.pattern.gives.contains(&feature))
    }

    /// The patterns, in build order.
    pub(crate) fn patterns(&self) -> Vec<&'static Pattern> {
        self.genes.iter().map(|gene| gene.pattern).collect()
    }
}

impl fmt::Debug for GameGenome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<&str> = self.genes.iter().map(|gene| gene.pattern.name).collect();
        f.debug_struct("GameGenome")
            .field("theme", &self.theme_draw.theme.name)
            .field("patterns", &names)
            .field("time", &self.time)
            .field("edits", &self.edits)
            .finish_non_exhaustive()
    }
}

/// Describes the hero with its equipment and the place, then the other facts.
fn summary(draft: &Draft) -> String {
    let hero = draft.with_article(HERO);
    let outfit = match draft.outfit.as_str() {
        "" => String::new(),
        outfit => format!(", {outfit},"),
    };
    let first = format!("{}{outfit} {}.", english::capital(&hero), draft.theme.place);
    let sentences = draft.clauses.iter().map(|clause| format!(" {}.", english::capital(&clause.text)));
    first + &sentences.collect::<String>()
}
