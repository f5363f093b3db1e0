//! Searches for the line of a game that is to blame for a level that is unwinnable or has no known win.
//!
//! The module changes one line of the game at a time, and searches for a win in the changed game. A win proves that the
//! changed game can be won. It proves that a change is necessary only if the original level is proven unwinnable.

use crate::case::Case;
use crate::criteria::is_guard;
use crate::evidence::{Evidence, Line};
use crate::measures::level::MeetingRecorder;
use crate::verdict::{Finding, Reason, Verdict};
use agents::{PortfolioConfig, Solution, solve};
use engine::analysis::{Condition, EffectSummary, Motion, Role};
use engine::syntax::{InteractionLine, Param, SpriteLine, Word};
use engine::{Analysis, Description, Episode, Game, Meeting, SpriteType};

/// The number by which the budget of `winnable` is divided to get the total budget for searches in changed games.
const SHARE: u64 = 2;
/// The fraction of a search's budget that may be spent, in a stochastic game, on searching with all randomness
/// foreseen.
const FORESIGHT: f64 = 0.4;
/// The maximum number of responsible lines to report.
const MAX_NAMED: usize = 3;
/// The maximum number of changed games in which to search for a win.
const MAX_TRIALS: u64 = 200;
/// The speed given to sprites that should carry others. At this speed, a sprite takes several ticks to leave a cell.
const CARRYING_SPEED: &str = "0.2";

/// The start of the sentence about a line whose presence or absence makes the level winnable.
pub(crate) const CAN_BE_WON: &str = "the level can be won ";

/// Adds the lines that prevent a win to a `winnable` finding, as far as searches in changed games reveal them. All
/// other findings remain unchanged. Costs half of the search budget.
pub(crate) fn explain(case: Case<'_>, finding: &mut Finding, search: &PortfolioConfig) {
    let is_open = match &finding.verdict {
        Verdict::Pass { .. } => return,
        Verdict::Fail { .. } => false,
        Verdict::Unknown { spent } => *spent > 0,
    };
    let is_searched = matches!(finding.verdict, Verdict::Fail { .. }) && finding.searched.is_some();
    if !is_open && matches!(finding.verdict, Verdict::Unknown { .. }) {
        return;
    }
    let mut trials = Trials { case, search, left: search.budget / SHARE, tried: 0, calls: 0 };
    let found = trials.all();
    finding.searched = Some(finding.searched.unwrap_or(0) + trials.calls).filter(|&calls| calls > 0);
    let Some(first) = found.first() else { return };
    if let (Verdict::Fail { reason, .. }, true) = (&mut finding.verdict, is_searched) {
        *reason = Reason(format!("{}; {}", reason.0, first.text));
        finding.evidence.retain(|seen| seen.board.is_some());
        finding.evidence.iter_mut().for_each(|seen| seen.advice = None);
        finding.evidence.splice(0..0, found);
    } else {
        finding.evidence.extend(found);
    }
}

/// A game variant that differs in one line.
struct Changed {
    game: Game,
    /// The original line, or the new line.
    line: Line,
    /// The description of the change, which follows [`CAN_BE_WON`].
    how: String,
    advice: String,
}

/// A win found in a changed game.
struct Won {
    changed: Changed,
    episode: Episode,
    shortest: bool,
}

impl Won {
    fn evidence(self) -> Evidence {
        let ticks = self.episode.actions.len();
        let fewest = if self.shortest { " at the earliest" } else { "" };
        let Changed { line, how, advice, .. } = self.changed;
        Evidence::new(format!(
            "{CAN_BE_WON}{how}: a search wins it in {}{fewest}",
            base::count(ticks, "tick")
        ))
        .of_rule(line)
        .advise(advice)
    }
}

/// The searches, with the number of remaining calls.
struct Trials<'a> {
    case: Case<'a>,
    search: &'a PortfolioConfig,
    left: u64,
    tried: u64,
    calls: u64,
}

impl Trials<'_> {
    /// Returns the evidence for all changes that make the level winnable, from most to least informative.
    fn all(&mut self) -> Vec<Evidence> {
        let repairs: Vec<Changed> = self.carriers().into_iter().chain(self.leavers()).collect();
        let dropped = self.dropped();
        // A swapped push is the most frequent mistake of this kind, and its correction leaves all other rules
        // unchanged.
        let is_push = |(line, _): &(usize, Changed)| {
            let mut encounters = self.case.analysis.encounters().iter();
            encounters.any(|other| other.line == *line && other.does(|effect| *effect == EffectSummary::Push))
        };
        let (pushes, swapped): (Vec<_>, Vec<_>) = self.swapped().into_iter().partition(is_push);
        let waiting = (repairs.len() + dropped.len() + pushes.len() + swapped.len()) as u64;
        let mut waiting = waiting.min(MAX_TRIALS);
        let mut found = Vec::new();
        for changed in repairs {
            found.extend(self.won(changed, &mut waiting).map(Won::evidence));
        }
        let before = found.len();
        for (_, changed) in pushes {
            found.extend(self.won(changed, &mut waiting).map(Won::evidence));
        }
        if found.len() > before {
            return found;
        }
        let mut lines = Vec::new();
        // Walls keep the avatar out of many cells, so removing their rule removes more than the cause.
        let analysis = self.case.analysis;
        let is_wall = |line: Option<usize>| line.is_some_and(|line| is_guard(analysis, line));
        let (walls, others): (Vec<_>, Vec<_>) = dropped.into_iter().partition(|(line, _)| is_wall(*line));
        for (line, changed) in others.into_iter().chain(walls) {
            if found.len() >= MAX_NAMED || is_wall(line) && !found.is_empty() {
                break;
            }
            let Some(won) = self.won(changed, &mut waiting) else { continue };
            lines.extend(line);
            match line {
                Some(line) => found.extend(self.without_rule(line, won)),
                None => found.push(won.evidence()),
            }
        }
        for (line, changed) in swapped {
            if found.len() >= MAX_NAMED {
                break;
            }
            // A rule that is only in the way does not have swapped sides.
            if !lines.contains(&line) {
                found.extend(self.won(changed, &mut waiting).map(Won::evidence));
            }
        }
        found
    }

    /// Searches for a win in a changed game. The remaining calls are divided equally among the changed games that have
    /// not been searched yet.
    fn won(&mut self, changed: Changed, waiting: &mut u64) -> Option<Won> {
        let share = self.left / (*waiting).max(1);
        *waiting = waiting.saturating_sub(1);
        if share == 0 || self.tried >= MAX_TRIALS {
            return None;
        }
        self.tried += 1;
        let analysis = Analysis::of(&changed.game);
        let level = changed.game.level(&self.case.level.to_string()).ok()?;
        if !analysis.can_win() || !analysis.reach(&level).can_win() {
            return None;
        }
        let config = PortfolioConfig { budget: share, foresight: FORESIGHT, ..self.search.clone() };
        let seed = self.case.seed.child("changed", self.tried);
        let solved = solve(&analysis, &level, &config, seed);
        self.left = self.left.saturating_sub(solved.calls);
        self.calls += solved.calls;
        match solved.solution {
            // A change that wins immediately explains nothing.
            Solution::Won { episode, shortest } if episode.actions.len() > 1 => {
                Some(Won { changed, episode: *episode, shortest })
            }
            _ => None,
        }
    }

    /// Returns the game variants that lack one interaction or one losing termination.
    fn dropped(&self) -> Vec<(Option<usize>, Changed)> {
        let Case { game, analysis, .. } = self.case;
        let rules = (0..game.description().interactions.len()).map(|line| {
            let rule = Line::interaction(game, line);
            let how = format!("without `{}`", rule.text);
            let advice = format!("change `{}`, or the sprites that it acts on in the level", rule.text);
            (Some(line), Changed { game: game.without(line), line: rule, how, advice })
        });
        let losing = analysis.goals().iter().filter(|goal| !goal.win);
        let endings = losing.filter_map(|goal| {
            let ending = Line::termination(game, goal.line);
            let mut description = game.description().clone();
            description.terminations.remove(goal.line);
            let how = format!("without `{}`", ending.text);
            let advice = match goal.condition {
                Condition::Tick(_) => "raise its `limit=`, or shorten the path".to_owned(),
                _ => format!("make `{}` hold later", ending.text),
            };
            Some((None, Changed { game: Game::compile(&description).ok()?, line: ending, how, advice }))
        });
        rules.chain(endings).collect()
    }

    /// Returns one game variant per interaction, with the interaction's two sides swapped. Rules that make a wall stop
    /// the avatar are not swapped, because the avatar could then walk through walls.
    fn swapped(&self) -> Vec<(usize, Changed)> {
        let game = self.case.game;
        let lines = &game.description().interactions;
        let swap = |line: usize| {
            let written = &lines[line];
            let [second] = &written.second[..] else { return None };
            let edge = |word: &Word| ["EOS", "TIME"].contains(&word.text.as_str());
            if second.text == written.first.text || edge(second) || edge(&written.first) {
                return None;
            }
            let swapped = InteractionLine {
                first: second.clone(),
                second: vec![written.first.clone()],
                ..written.clone()
            };
            let rule = Line::interaction(game, line);
            let changed = with_lines(game, |lines| lines[line] = swapped)?;
            let meant = Line::interaction(&changed, line).text;
            let how = format!("with the two sides of `{}` swapped", rule.text);
            let advice = format!("did you mean `{meant}`?");
            Some((line, Changed { game: changed, line: rule, how, advice }))
        };
        (0..lines.len()).filter(|&line| !is_guard(self.case.analysis, line)).filter_map(swap).collect()
    }

    /// Returns the game variants in which sprites that fly off the board reappear at the opposite edge.
    fn leavers(&self) -> Vec<Changed> {
        let Case { game, analysis, .. } = self.case;
        let leaves = |&stype: &SpriteType| {
            let facts = analysis.facts(stype);
            let flies = matches!(facts.motion, Motion::Straight(_)) && facts.possible;
            flies && analysis.role(stype) != Role::Shot && analysis.at_edge(stype).next().is_none()
        };
        let returning = |stype: SpriteType| {
            let name = game.name(stype);
            let line = InteractionLine {
                first: Word::from(name),
                second: vec![Word::from("EOS")],
                effect: Word::from("wrapAround"),
                ..InteractionLine::default()
            };
            let changed = with_lines(game, |lines| lines.push(line))?;
            let how = format!("with `{name} EOS > wrapAround`");
            let advice = format!(
                "add `{name} EOS > wrapAround`: no rule names `{name} EOS`, so each `{name}` leaves the board for good"
            );
            Some(Changed { game: changed, line: Line::sprite(game, name)?, how, advice })
        };
        game.sprite_types().filter(leaves).filter_map(returning).collect()
    }

    /// Returns the game variants in which a sprite that should carry others is slow enough to do so.
    fn carriers(&self) -> Vec<Changed> {
        let Case { game, analysis, .. } = self.case;
        let carries = |&stype: &SpriteType| {
            let facts = analysis.facts(stype);
            let carries = |encounter: &engine::analysis::Encounter| {
                let written = &game.description().interactions[encounter.line];
                encounter.does(|effect| *effect == EffectSummary::Carry)
                    && encounter.second.is_some_and(|second| analysis.applies(second, stype))
                    && written.effect.text == "pullWithIt"
            };
            facts.possible && facts.pace > 0.0 && analysis.encounters().iter().any(carries)
        };
        let slowed = |stype: SpriteType| {
            let name = game.name(stype);
            let mut description = game.description().clone();
            slow_down(&mut description.sprites, name).then_some(())?;
            let changed = Game::compile(&description).ok()?;
            let how = format!("with `speed={CARRYING_SPEED}` for `{name}`");
            let advice = format!(
                "add `speed={CARRYING_SPEED}` to `{name}`: at a speed of 1 or more, it leaves the cell before `pullWithIt` can take its rider along"
            );
            Some(Changed { game: changed, line: Line::sprite(game, name)?, how, advice })
        };
        game.sprite_types().filter(carries).filter_map(slowed).collect()
    }

    /// Returns the evidence about a rule whose removal makes the level winnable. The evidence states where the rule
    /// would act in the win found without it, and whether it is enough to move the rule further down or to shield the
    /// avatar from it.
    fn without_rule(&mut self, line: usize, won: Won) -> Vec<Evidence> {
        let game = self.case.game;
        let (place, others) = self.first_meeting(line, &won);
        let mut seen = vec![won.evidence()];
        let written = &game.description().interactions[line];
        let name = Line::interaction(game, line).text;
        // Insert the rule below the last rule that shields the avatar from it. Without such a rule, insert it at the
        // end.
        let shields = |other: &InteractionLine| {
            let value = |key: &str| other.params.iter().find(|param| param.key.text == key);
            other.effect.text == "shieldFrom"
                && value("ftype").is_some_and(|param| param.value.text == written.effect.text)
        };
        let lines = &game.description().interactions;
        let shield = lines.iter().rposition(shields).filter(|&shield| shield > line);
        let below = shield.or_else(|| lines.len().checked_sub(1).filter(|&last| last > line));
        let moved = below.and_then(|below| {
            let game = with_lines(game, |lines| {
                let moved = lines.remove(line);
                lines.insert(below, moved);
            })?;
            let below = Line::interaction(self.case.game, below);
            let why = if shield.is_some() { ": a shield protects only from rules below it" } else { "" };
            let how = format!("with `{name}` below `{}`", below.text);
            let advice = format!("move `{name}` below `{}`{why}", below.text);
            Some(Changed { game, line: below, how, advice })
        });
        let mut better = moved.and_then(|moved| self.won(moved, &mut 8));
        if better.is_none() {
            for other in &others {
                let Some(shielded) = self.shielded(line, other) else { continue };
                better = self.won(shielded, &mut 8);
                if better.is_some() {
                    break;
                }
            }
        }
        if let Some(place) = place {
            seen.push(place);
        }
        if let Some(better) = better {
            seen[0].advice = None;
            seen.push(better.evidence());
        }
        seen
    }

    /// Returns the game variant in which the avatar is protected from a rule while standing on sprites called `other`.
    fn shielded(&self, line: usize, other: &str) -> Option<Changed> {
        let game = self.case.game;
        let written = &game.description().interactions[line];
        let [from] = &written.second[..] else { return None };
        let param = |key: &str, value: &str| Param { key: Word::from(key), value: Word::from(value) };
        let shield = InteractionLine {
            first: written.first.clone(),
            second: vec![Word::from(other)],
            effect: Word::from("shieldFrom"),
            params: vec![param("stype", &from.text), param("ftype", &written.effect.text)],
            ..InteractionLine::default()
        };
        let changed = with_lines(game, |lines| lines.insert(line, shield))?;
        let text = Line::interaction(&changed, line).text;
        let rule = Line::interaction(game, line);
        let how = format!("with `{text}`");
        let advice = format!("add `{text}` above `{}`", rule.text);
        Some(Changed { game: changed, line: rule, how, advice })
    }

    /// Returns the position at which a disabled rule would first act in a win, and the names of the other
    /// types there.
    fn first_meeting(&self, line: usize, won: &Won) -> (Option<Evidence>, Vec<String>) {
        let (case, game) = (self.case, &won.changed.game);
        let mut state = game.start(case.level, won.episode.seed);
        for (tick, &action) in won.episode.actions.iter().enumerate() {
            let mut recorder = MeetingRecorder::new(game);
            game.step_watched(&mut state, action, &mut recorder);
            let Some(met) = recorder.meetings.iter().find(|meeting| meeting.line == line) else { continue };
            let Meeting { first, second, cell, .. } = *met;
            let name = |stype: SpriteType| case.game.name(stype);
            let seen = game.observe(&state);
            let place = usize::try_from(cell.0).ok().zip(usize::try_from(cell.1).ok());
            let place = place.filter(|&(column, row)| column < seen.columns && row < seen.rows);
            let there = place.map_or(&[][..], |(column, row)| &seen.cells[row * seen.columns + column]);
            let is_met = |stype: SpriteType| stype == first || Some(stype) == second;
            let meets =
                |stype: SpriteType| case.analysis.between(first, stype).next().is_some() && !is_met(stype);
            let others = there.iter().filter(|name| case.game.sprite_type(name).is_some_and(meets));
            let mut others: Vec<String> = others.cloned().collect();
            others.dedup();
            let partner =
                second.map_or("the edge of the screen".to_owned(), |second| format!("`{}`", name(second)));
            let beside = match others.first() {
                Some(other) => format!(", where there is also a `{other}`"),
                None => String::new(),
            };
            let text = format!("in that win, the rule would act on `{}` and {partner}{beside}", name(first));
            let cell = place.map(|(column, row)| (column + 1, row + 1));
            return (Some(Evidence { tick: Some(tick + 1), cell, ..Evidence::new(text) }), others);
        }
        (None, Vec::new())
    }
}

/// Returns the game with changed interactions, or `None` if it does not compile.
fn with_lines(game: &Game, change: impl FnOnce(&mut Vec<InteractionLine>)) -> Option<Game> {
    let mut description: Description = game.description().clone();
    change(&mut description.interactions);
    Game::compile(&description).ok()
}

/// Sets the speed of the sprite called `name` to one at which it can carry others. Returns `false` if the sprite is
/// already slow enough.
fn slow_down(lines: &mut [SpriteLine], name: &str) -> bool {
    for line in lines {
        if line.name.text == name {
            let speed = |param: &&mut Param| param.key.text == "speed";
            if let Some(known) = line.params.iter_mut().find(speed) {
                if known.value.text.parse::<f64>().is_ok_and(|speed| speed < 1.0) {
                    return false;
                }
                known.value = Word::from(CARRYING_SPEED);
            } else {
                line.params.push(Param { key: Word::from("speed"), value: Word::from(CARRYING_SPEED) });
            }
            return true;
        }
        if slow_down(&mut line.children, name) {
            return true;
        }
    }
    false
}
