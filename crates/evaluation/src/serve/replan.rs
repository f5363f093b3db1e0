//! Plans from a position reconstructed from the prompt.
//!
//! The prompt must show all relevant information: the rules must be shown as VGDL, the game must be
//! deterministic and wait for the player, and the sprites must have no hidden state. The player answers only
//! if these conditions certainly hold.

use super::Unanswerable;
use super::shown::Shown;
use agents::{Budget, OpenLoop, PlannerSpec};
use base::Seed;
use engine::analysis::Time;
use engine::describe::plural;
use engine::syntax::{Description, MappingLine, parse};
use engine::{Action, Analysis, Direction, Game, Level, State};
use std::collections::BTreeMap;

/// The number of forward-model calls per decision, if the planner's name contains no budget.
const BUDGET: Budget = Budget(1000);

/// The effects that change only sprite positions and the avatar's resources.
const SHOWN_EFFECTS: &[&str] = &[
    "killSprite",
    "killBoth",
    "killAll",
    "stepBack",
    "undoAll",
    "bounceForward",
    "collectResource",
    "collectResourceIfHeld",
    "changeResource",
    "transformTo",
    "transformToAll",
    "killIfHasMore",
    "killIfHasLess",
    "killIfOtherHasMore",
    "spawn",
    "spawnIfHasMore",
    "spawnIfHasLess",
    "cloneSprite",
    "teleportToExit",
];

/// The terminations that depend only on sprite positions or the clock.
const SHOWN_ENDINGS: &[&str] = &["SpriteCounter", "SpriteCounterMore", "MultiSpriteCounter", "Timeout"];

/// Plans the due actions from the position that a prompt shows.
///
/// # Errors
/// Returns an error if the prompt does not show a position from which the player can plan. The message states
/// the missing information.
pub(super) fn choose(shown: &Shown<'_>, spec: &PlannerSpec, seed: Seed) -> Result<Vec<Action>, Unanswerable> {
    let (game, state) = position(shown, seed.child("unused", 0))
        .map_err(|why| Unanswerable(format!("`planner:{spec}` cannot plan from this prompt: {why}")))?;
    let seed = seed.child("planner", 0);
    let mut player = OpenLoop::new(spec.player(seed), spec.budget().unwrap_or(BUDGET), seed);
    let (mut actions, _) = player.plan(&game, &state, shown.due);
    if let Some(first) = actions.first_mut().filter(|first| !shown.actions.contains(first)) {
        *first = Action::Nil;
    }
    Ok(actions)
}

/// Checks that a prompt shows a position from which the player can plan.
///
/// # Errors
/// Returns an error in the same cases as [`choose`].
pub(super) fn check(shown: &Shown<'_>, spec: &PlannerSpec) -> Result<(), Unanswerable> {
    let found = position(shown, Seed::from_text("unused"));
    found
        .map(drop)
        .map_err(|why| Unanswerable(format!("`planner:{spec}` cannot plan from this prompt: {why}")))
}

/// Reconstructs the position shown in a prompt, within an equivalent game. If this is impossible, returns the
/// reason. The result does not depend on the seed.
fn position(shown: &Shown<'_>, seed: Seed) -> Result<(Game, State), String> {
    let Some(vgdl) = shown.vgdl else {
        return Err("the planner needs the rules as VGDL: pass --rules vgdl to `arcade evaluate`, or set \
                    `rules` to `vgdl` in the prompt settings"
            .to_owned());
    };
    let (description, _) = parse(vgdl);
    let game = Game::compile(&description)
        .map_err(|problems| format!("the VGDL in the prompt does not compile: {problems}"))?;
    is_shown(&Analysis::of(&game), shown)?;
    let Position { game, level } = Position::of(description, shown)?;
    let facing = shown.you.and_then(|you| you.facing).and_then(direction);
    let held = shown.held.iter().flatten();
    // For amounts above one, the prompt states resource names in the plural.
    let resource = |name: &str, amount: i32| {
        game.sprite_types().find(|&stype| match amount {
            1 => game.name(stype) == name,
            _ => plural(game.name(stype)) == name,
        })
    };
    let held: Vec<_> = held.filter_map(|(name, amount)| Some((resource(name, *amount)?, *amount))).collect();
    let state = game.start_as(&level, seed, facing, &held);
    Ok((game, state))
}

/// Checks that the board, together with the avatar's resources and direction, determines the game's state. If
/// it does not, returns the reason.
fn is_shown(analysis: &Analysis, shown: &Shown<'_>) -> Result<(), String> {
    let game = analysis.game();
    let possible = || game.sprite_types().filter(|&stype| analysis.facts(stype).possible);
    if analysis.is_stochastic() {
        return Err("the game is stochastic".to_owned());
    }
    if let Some(&unseen) = analysis.unseen().first() {
        return Err(format!("the {} affects play but is not visible", game.name(unseen)));
    }
    if analysis.taxonomy().time != Time::TurnBased {
        return Err("sprites move by themselves, and the board does not show in which direction".to_owned());
    }
    if let Some(fleeting) = possible().find(|&stype| analysis.facts(stype).fleeting) {
        return Err(format!("the board does not show how long the {} stays", game.name(fleeting)));
    }
    if let Some(slow) = analysis.avatars().iter().find(|avatar| analysis.facts(avatar.stype).pace != 1.0) {
        return Err(format!("the board does not show when the {} can move", game.name(slow.stype)));
    }
    let matters = |name: &str| {
        let Some(stype) = game.sprite_type(name) else { return false };
        let meets = analysis.encounters().iter().any(|encounter| {
            analysis.applies(encounter.first, stype)
                || encounter.second.is_some_and(|second| analysis.applies(second, stype))
        });
        meets || analysis.goals().iter().any(|goal| goal.condition.types().contains(&stype))
    };
    if let Some(floor) = shown.floors.iter().find(|name| matters(name)) {
        return Err(format!("the {floor} affects play, but the board does not show it"));
    }
    let clauses = game.clauses();
    let effects = clauses.interactions.iter().map(|clause| clause.effect);
    let endings = clauses.terminations.iter().map(|clause| clause.class);
    let unknown = effects.filter(|effect| !SHOWN_EFFECTS.contains(effect));
    match unknown.chain(endings.filter(|ending| !SHOWN_ENDINGS.contains(ending))).next() {
        Some(word) => Err(format!("`{word}` may have effects that a board does not show")),
        None => Ok(()),
    }
}

/// A reconstructed position: a game with a suitable level mapping, and the position as a level.
struct Position {
    game: Game,
    level: Level,
}

impl Position {
    fn of(mut description: Description, shown: &Shown<'_>) -> Result<Position, String> {
        if shown.you.is_none() || shown.cells.is_empty() {
            return Err("the prompt shows no board with an avatar (enable `grid` and `position`)".to_owned());
        }
        let symbols: Vec<char> = ('!'..='~').collect();
        let mut mapping: BTreeMap<&[&str], char> = BTreeMap::new();
        let mut text = String::new();
        for row in shown.cells.chunks(shown.columns) {
            for names in row {
                let next = symbols.get(mapping.len()).copied();
                text.push(match names.as_slice() {
                    [] => ' ',
                    names => match (mapping.get(names), next) {
                        (Some(&symbol), _) => symbol,
                        (None, Some(symbol)) => *mapping.entry(names).or_insert(symbol),
                        (None, None) => return Err("the prompt shows too many kinds of cell".to_owned()),
                    },
                });
            }
            text.push('\n');
        }
        let line = |(names, symbol): (&[&str], char)| MappingLine {
            symbol,
            names: names.iter().map(|&name| name.into()).collect(),
            ..MappingLine::default()
        };
        description.mapping = mapping.into_iter().map(line).collect();
        lower_tick_limits(&mut description, shown.tick);
        let game = Game::compile(&description)
            .map_err(|problems| format!("the board in the prompt does not fit the game: {problems}"))?;
        let level = game
            .level(&text)
            .map_err(|problems| format!("the board in the prompt is not a level of the game: {problems}"))?;
        Ok(Position { game, level })
    }
}

fn lower_tick_limits(description: &mut Description, ticks: u32) {
    let timeouts = description.terminations.iter_mut().filter(|line| line.class.text == "Timeout");
    for param in timeouts.flat_map(|line| &mut line.params).filter(|param| param.key.text == "limit") {
        if let Ok(limit) = param.value.text.parse::<i64>() {
            param.value.text = (limit - i64::from(ticks)).max(1).to_string();
        }
    }
}

fn direction(facing: Action) -> Option<Direction> {
    match facing {
        Action::Up => Some(Direction::UP),
        Action::Left => Some(Direction::LEFT),
        Action::Down => Some(Direction::DOWN),
        Action::Right => Some(Direction::RIGHT),
        Action::Nil | Action::Use => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commitment::Commitment;
    use crate::encoding;
    use crate::legend::Legend;
    use crate::prompt::{PromptSettings, Prompter, Rules};
    use crate::subject::{Subject, SubjectFacts};
    use crate::turn::{Turn, choices};
    use std::path::Path;

    /// Returns the visible part of a state, without the tick and the score.
    fn seen(legend: &Legend, game: &Game, state: &State) -> impl PartialEq + std::fmt::Debug + use<> {
        let seen = game.observe(state);
        let board = (encoding::grid(&seen, legend), encoding::stacks(&seen, legend));
        let avatar = seen.avatar.map(|avatar| (avatar.name, avatar.column, avatar.row, avatar.facing));
        let resources: Vec<_> = seen.resources.into_iter().filter(|(_, amount)| *amount != 0).collect();
        (seen.outcome, avatar, resources, board)
    }

    /// Corpus positions that are reconstructed from prompts continue in the same way as the original states.
    #[test]
    fn positions_read_from_a_board_play_like_the_original() {
        let settings = PromptSettings { rules: Rules::Vgdl, ..PromptSettings::default() };
        for name in ["dyepot-newt", "osier-way", "quiet-jars"] {
            let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpora").join(name);
            let text = |file: &str| std::fs::read_to_string(folder.join(file)).unwrap();
            let levels = [(0, text("lvl0.txt"), None)];
            let subject = Subject::read(name, &text("game.vgdl"), &levels, SubjectFacts::default()).unwrap();
            let prompter = Prompter::new(&subject, settings.clone()).unwrap();
            let own = &subject.game;
            let (mut compared, mut draws) = (0, Seed::from_text(name).sampler());
            for walk in 0..8 {
                let mut state = own.start(&subject.levels[0].level, Seed::from_text("walk"));
                for _ in 0..walk * 9 {
                    let action = *draws.choose(own.actions(&state));
                    own.step(&mut state, action);
                }
                if state.is_over() {
                    continue;
                }
                let (observation, actions) = (own.observe(&state), choices(own, &state));
                let (subject, observation, actions) = (&subject, &observation, &actions);
                let turn = Turn {
                    subject,
                    level: 0,
                    number: 0,
                    limit: 9,
                    commit: Commitment::ONE,
                    observation,
                    before: None,
                    played: &[],
                    actions,
                    series: None,
                    cause: None,
                };
                let messages = prompter.prompt(&turn, &[], &[]).messages;
                let shown = Shown::of(&messages).unwrap();
                let (game, mut copy) = position(&shown, Seed::from_text("copy")).unwrap();
                for _ in 0..60 {
                    let action = *draws.choose(actions);
                    own.step(&mut state, action);
                    game.step(&mut copy, action);
                    let legend = prompter.legend();
                    assert_eq!(seen(legend, &game, &copy), seen(legend, own, &state), "{name}, walk {walk}");
                    compared += 1;
                }
            }
            assert!(compared > 200, "{name}: {compared}");
        }
    }
}
