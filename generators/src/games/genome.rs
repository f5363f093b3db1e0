//! Genomes of games: what a search changes.

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

/// Compositions that are drawn for one game: a goal may find no company, and mechanics may have nothing to do with each
/// other.
const DRAWS: u64 = 64;
/// Ticks of one unit of a goal's time.
const TIME: u32 = 50;
/// The same where the hero has to hold out: every tick counts.
const SIEGE_TIME: u32 = 20;

/// A pattern and the seed that it is built with.
#[derive(Clone, Copy)]
pub(crate) struct Gene {
    pub(crate) pattern: &'static Pattern,
    pub(crate) seed: Seed,
}

/// A game as a typed tree: a fiction, patterns with the seed that each is built with, and typed edits of what they build.
///
/// The same genome builds the same game, on every machine. Those that [`ConstructiveGames`](super::ConstructiveGames) and
/// [`GameVariation`](super::GameVariation) give all build.
#[derive(Clone)]
pub struct GameGenome {
    pub(crate) fiction: Fiction,
    pub(crate) goal: &'static Goal,
    /// The way of moving, the goal, then threats, obstacles and boons: in the order in which they are built.
    pub(crate) genes: Vec<Gene>,
    /// Units of time until the game is over.
    pub(crate) time: u32,
    pub(crate) edits: Vec<Edit>,
}

/// What things are called.
#[derive(Clone, Copy)]
pub(crate) struct Fiction {
    pub(crate) theme: &'static Theme,
    pub(crate) names: Seed,
    /// What one does, for the title.
    pub(crate) deed: &'static str,
}

impl Fiction {
    pub(crate) fn draw(kind: Kind, seed: Seed) -> Fiction {
        let mut sampler = seed.child("fiction", 0).sampler();
        let theme = *sampler.choose(Theme::ALL);
        Fiction { theme, names: seed.child("names", 0), deed: kind.deed(&mut sampler) }
    }
}

impl GameGenome {
    /// Draws patterns that go together, and a fiction.
    ///
    /// # Errors
    /// If no kinds are allowed, or this seed leads nowhere. Whether the game compiles, [`build`](GameGenome::build) says.
    pub(crate) fn draw(config: &GameConfig, seed: Seed) -> Result<GameGenome, GenerateError> {
        if config.kinds.is_empty() {
            return Err(GenerateError::Unsuitable("no kinds of games are allowed".to_owned()));
        }
        let drawn = (0..DRAWS).find_map(|draw| {
            let sampler = &mut seed.child("composition", draw).sampler();
            let genome = GameGenome::compose(Composition::draw(&config.kinds, sampler)?, seed);
            (mechanics::dependencies(&genome.draft().0) > 0).then_some(genome)
        });
        drawn.ok_or_else(|| GenerateError::Unlucky("no goal found company".to_owned()))
    }

    /// These patterns, with a fiction for them.
    fn compose(Composition { goal, patterns }: Composition, seed: Seed) -> GameGenome {
        let (least, most) = goal.ticks;
        let genes = patterns.into_iter().enumerate();
        GameGenome {
            fiction: Fiction::draw(goal.kind, seed),
            goal,
            genes: genes
                .map(|(at, pattern)| Gene { pattern, seed: seed.child(pattern.name, at as u64) })
                .collect(),
            time: seed.child("time", 0).sampler().between(least as usize, most as usize) as u32,
            edits: Vec::new(),
        }
    }

    /// What sort of game it is.
    pub fn kind(&self) -> Kind {
        self.goal.kind
    }

    /// Edits of what the patterns build.
    pub fn edits(&self) -> usize {
        self.edits.len()
    }

    /// Builds the game. Cost: well under a millisecond.
    ///
    /// # Errors
    /// If the rules do not compile, or the compiler or the analysis warns of something in them, such as a game that cannot
    /// be won.
    pub fn build(&self) -> Result<GeneratedGame, GenerateError> {
        let draft = self.draft().0;
        let game = self.lay_out(draft);
        // From the print: what is built is what is frozen.
        match Game::from_source(&syntax::print(&game.description)) {
            Ok(compiled) if compiled.warnings().is_empty() => Ok(game),
            Ok(compiled) => {
                Err(GenerateError::Unlucky(format!("warned of: {}", compiled.warnings()[0].message)))
            }
            Err(problems) => Err(GenerateError::Unlucky(format!("the rules do not compile: {problems}"))),
        }
    }

    /// The digest of the rules as they are printed: genomes with the same key build the same rules under the same names.
    /// Cost: that of building without compiling.
    pub fn key(&self) -> Digest {
        Digest::of(syntax::print_bare(&assemble::describe(&self.draft().0)).as_bytes())
    }

    /// What the patterns build, with the edits made; and those of the edits that changed something.
    pub(crate) fn draft(&self) -> (Draft, Vec<Edit>) {
        let mut draft = Draft::new(self.fiction.theme, self.fiction.names);
        for (number, gene) in self.genes.iter().enumerate() {
            draft.gene = Some(number);
            (gene.pattern.build)(&mut draft, &mut gene.seed.sampler());
        }
        // Every game ends: lost when time is up, or won where holding out is the goal.
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
        let title = draft.title(self.fiction.deed);
        let patterns = self.genes.iter().map(|gene| gene.pattern.name).chain([self.fiction.theme.name]);
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

    /// Whether some pattern brings this.
    fn gives(&self, feature: Feature) -> bool {
        self.genes.iter().any(|gene| gene.pattern.gives.contains(&feature))
    }

    /// The patterns, in the order in which they are built.
    pub(crate) fn patterns(&self) -> Vec<&'static Pattern> {
        self.genes.iter().map(|gene| gene.pattern).collect()
    }
}

impl fmt::Debug for GameGenome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<&str> = self.genes.iter().map(|gene| gene.pattern.name).collect();
        f.debug_struct("GameGenome")
            .field("fiction", &self.fiction.theme.name)
            .field("patterns", &names)
            .field("time", &self.time)
            .field("edits", &self.edits)
            .finish_non_exhaustive()
    }
}

/// Who is where, with what; then what else there is.
fn summary(draft: &Draft) -> String {
    let hero = draft.one(HERO);
    let outfit = match draft.outfit.as_str() {
        "" => String::new(),
        outfit => format!(", {outfit},"),
    };
    let first = format!("{}{outfit} {}.", english::capital(&hero), draft.setting().place);
    let sentences = draft.clauses.iter().map(|clause| format!(" {}.", english::capital(&clause.text)));
    first + &sentences.collect::<String>()
}
