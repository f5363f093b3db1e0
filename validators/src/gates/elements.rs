//! The removable elements of a game: placed types, and rules except guards, which only keep sprites on the board and
//! out of walls.

use crate::evidence::{Evidence, Line};
use crate::measures::Guards;
use crate::validator::GameCase;
use engine::analysis::{Motion, Role};
use engine::{Game, Level, SpriteType};
use std::collections::BTreeSet;

/// A rule or a placed type, and the game without it.
pub(super) struct Element {
    /// The rule's text, or the type's name.
    pub(super) text: String,
    line: Option<Line>,
    /// The indices of the levels on which the element occurs. A type occurs where it is placed, and a rule where a
    /// recorded episode executes it.
    pub(super) levels: Vec<usize>,
    pub(super) without: Game,
    /// `true` if the element is a type, so that levels must be parsed again without it.
    pub(super) is_type: bool,
    /// `true` if removing the element shifts the random draws, so that later events differ at random.
    pub(super) shifts: bool,
}

impl Element {
    /// Returns the level for the game without the element, or `None` if it cannot be parsed.
    pub(super) fn level(&self, level: &Level) -> Option<Level> {
        if !self.is_type {
            return Some(level.clone());
        }
        self.without.level(&level.to_string()).ok()
    }

    /// Returns evidence of a problem with the element.
    pub(super) fn problem(&self, text: String) -> Evidence {
        Evidence { rule: self.line.clone(), ..Evidence::new(text) }
            .advise("remove this rule or type, or make winning depend on it")
    }
}

/// Returns a game's elements: interactions and placed types. Excluded interactions are guards ([`Guards`]), and those
/// in which a wall keeps sprites other than avatars in bounds. Excluded types are avatars, walls, the background, and
/// types that an ending counts.
///
/// `executed` lists, by level, the rules that were executed in addition to those in the recording.
pub(super) fn elements(case: GameCase<'_>, executed: &[(usize, BTreeSet<usize>)]) -> Vec<Element> {
    let (game, analysis) = (case.game, case.analysis);
    let guards: BTreeSet<usize> = Guards::of(analysis).lines().collect();
    let rule = |line: usize| {
        let uses = &case.usage.lines[line];
        let mut levels: BTreeSet<usize> = uses.iter().map(|at| at.level).collect();
        levels.extend(executed.iter().filter(|(_, lines)| lines.contains(&line)).map(|(number, _)| *number));
        let written = Line::interaction(game, line);
        Element {
            text: written.text.clone(),
            line: Some(written),
            levels: levels.into_iter().collect(),
            without: game.without(line),
            is_type: false,
            shifts: false,
        }
    };
    let of_role = |name: &str, role: Role| {
        let written = game.sprite_type(name);
        let family =
            |written: SpriteType| game.sprite_types().filter(move |&stype| analysis.applies(written, stype));
        written.is_some_and(|written| family(written).any(|stype| analysis.role(stype) == role))
    };
    let bounds = |line: usize| {
        let written = &game.description().interactions[line];
        !of_role(&written.first.text, Role::Avatar)
            && written.second.iter().any(|second| of_role(&second.text, Role::Wall))
    };
    let inner = |line: &usize| !guards.contains(line) && !bounds(*line);
    let rules = (0..case.usage.lines.len()).filter(inner).map(rule);
    let counted: Vec<SpriteType> =
        analysis.goals().iter().flat_map(|goal| goal.condition.types()).copied().collect();
    let scenery = |stype: &SpriteType| {
        matches!(analysis.role(*stype), Role::Avatar | Role::Wall | Role::Floor) || counted.contains(stype)
    };
    let of_type = |stype: SpriteType| {
        let places = |level: &Level| level.cells().iter().any(|&cell| game.places(cell).contains(&stype));
        let on = case.recording.iter().enumerate().filter(|(_, recorded)| places(recorded.level));
        let levels: Vec<usize> = on.map(|(number, _)| number).collect();
        let moves = analysis.facts(stype).motion != Motion::Still || !analysis.facts(stype).makes.is_empty();
        let without = (!levels.is_empty()).then(|| without_type(game, stype))??;
        Some(Element {
            text: game.name(stype).to_owned(),
            line: Line::sprite(game, game.name(stype)),
            levels,
            without,
            is_type: true,
            shifts: moves && analysis.is_stochastic(),
        })
    };
    let types = game.sprite_types().filter(|stype| !scenery(stype)).filter_map(of_type);
    rules.chain(types).collect()
}

/// Returns the game whose levels do not place a type, or `None` if it does not compile.
fn without_type(game: &Game, stype: SpriteType) -> Option<Game> {
    let mut description = game.description().clone();
    for line in &mut description.mapping {
        line.names.retain(|name| game.sprite_type(&name.text) != Some(stype));
    }
    let compiled = Game::compile(&description).ok();
    compiled.or_else(|| Game::from_source_as_reference(&engine::syntax::print_bare(&description)).ok())
}
