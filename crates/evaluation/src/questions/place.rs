//! Levels about which exact questions can be asked, and walks through them.

use super::view::View;
use crate::error::EvaluationError;
use crate::prompt::{PromptSettings, Prompter, sections};
use crate::subject::{Subject, SubjectLevel};
use agents::search::{Answer, Pushes, SearchLimits, a_star, best_first};
use base::{Sampler, Seed};
use engine::{Action, Analysis, Game, Level, State, Watch};
use itertools::Itertools;
use std::collections::BTreeSet;

/// The maximum number of forward-model calls in the search for a level's win.
const LEVEL_CALLS: u64 = 30_000;

/// A game with the texts that its questions share.
pub(super) struct QuestionGame<'a> {
    pub(super) subject: &'a Subject,
    pub(super) prompter: Prompter,
    pub(super) levels: Vec<QuestionLevel<'a>>,
}

/// A level that is deterministic and fully visible from its start.
pub(super) struct QuestionLevel<'a> {
    pub(super) source: &'a SubjectLevel,
    pub(super) start: State,
    /// A win found by a short search, or an empty list if the search found none.
    win: Vec<Action>,
}

/// A level with its game.
#[derive(Clone, Copy)]
pub(super) struct Place<'a> {
    pub(super) game: &'a QuestionGame<'a>,
    pub(super) level: &'a QuestionLevel<'a>,
}

impl<'a> QuestionGame<'a> {
    /// Prepares a game and those of its levels that are deterministic and fully visible. Cost: a search of at most
    /// [`LEVEL_CALLS`] calls per level.
    ///
    /// # Errors
    /// Returns an error if the game's prompts cannot be written.
    pub(super) fn new(subject: &'a Subject) -> Result<QuestionGame<'a>, EvaluationError> {
        let prompter = Prompter::new(subject, PromptSettings::default())?;
        let levels = subject.levels.iter().filter_map(|level| QuestionLevel::new(subject, level)).collect();
        Ok(QuestionGame { subject, prompter, levels })
    }

    /// Returns a section of the game's prompts with its heading.
    pub(super) fn section(&self, heading: &str) -> String {
        let sections = sections(self.prompter.static_part());
        let body = sections.iter().find(|(own, _)| *own == heading).map_or("", |(_, body)| body);
        format!("## {heading}\n{body}")
    }

    /// Returns the drawing order of the visible types as one sentence.
    pub(super) fn layers(&self) -> String {
        let game = &self.subject.game;
        let order = game.drawing_order().into_iter().map(usize::from).collect::<Vec<_>>();
        let names: Vec<&str> = game.sprite_types().map(|stype| game.name(stype)).collect();
        let names = order.iter().rev().filter_map(|&at| names.get(at)).filter(|name| self.is_drawn(name));
        format!(
            "A cell shows you if you are in it. Otherwise it shows the first of these that it contains: {}.",
            names.format(", ")
        )
    }

    fn is_drawn(&self, name: &str) -> bool {
        let legend = self.prompter.legend();
        let is_avatar =
            legend.entry(name).is_some_and(|entry| entry.role == crate::legend::EntryRole::Avatar);
        legend.is_shown(name) && !is_avatar
    }
}

impl<'a> QuestionLevel<'a> {
    fn new(subject: &Subject, level: &'a SubjectLevel) -> Option<QuestionLevel<'a>> {
        let analysis = &subject.analysis;
        let start = start(&subject.game, &level.level);
        let is_exact = analysis.is_deterministic_from(&start) && analysis.is_fully_observable_from(&start);
        if !is_exact || start.is_over() {
            return None;
        }
        let pushes = Pushes::of(analysis, &level.level);
        let limits = SearchLimits::calls(LEVEL_CALLS);
        let shortest = a_star(analysis, &pushes, &start, SearchLimits::calls(LEVEL_CALLS / 3)).answer;
        let won = match shortest {
            Answer::Won { .. } => shortest,
            _ => best_first(analysis, &pushes, &start, limits).answer,
        };
        let win = if let Answer::Won { actions, .. } = won { actions } else { Vec::new() };
        Some(QuestionLevel { source: level, start, win })
    }
}

/// Returns a level's first state. Questions are only about deterministic levels, so the seed has no effect.
pub(super) fn start(game: &Game, level: &Level) -> State {
    game.start(level, Seed::from_text("questions"))
}

impl<'a> Place<'a> {
    pub(super) fn rules(&self) -> &'a Game {
        &self.game.subject.game
    }

    /// Returns the state after the given actions from the start of the level, or `None` if the episode is over by then.
    pub(super) fn after(&self, actions: &[Action]) -> Option<State> {
        let mut state = self.level.start.clone();
        for &action in actions {
            self.rules().step(&mut state, action);
        }
        (!state.is_over()).then_some(state)
    }

    pub(super) fn view(&self, state: &State) -> View {
        View::foretelling(self.rules(), state, self.game.prompter.legend())
    }

    /// Returns the win that was found in advance, or an empty list if none was found.
    pub(super) fn win(&self) -> &'a [Action] {
        &self.level.win
    }

    /// Draws a walk: actions from the start of the level. In half of the walks, the first part follows a win. All other
    /// actions are random, with frequent repetitions. The episode may be over before the end of the walk.
    pub(super) fn walk(&self, length: usize, sampler: &mut Sampler) -> Vec<Action> {
        let followed = if sampler.ratio(1, 2) { sampler.between(0, length.min(self.win().len())) } else { 0 };
        let mut actions = self.win()[..followed].to_vec();
        actions.extend(self.random(length - followed, sampler));
        actions
    }

    /// Draws random actions, each of which repeats its predecessor with probability 1/3.
    pub(super) fn random(&self, length: usize, sampler: &mut Sampler) -> Vec<Action> {
        let keys = self.game.prompter.actions();
        let mut actions: Vec<Action> = Vec::with_capacity(length);
        for _ in 0..length {
            let repeated = actions.last().copied().filter(|_| sampler.ratio(1, 3));
            actions.push(repeated.unwrap_or_else(|| *sampler.choose(keys)));
        }
        actions
    }

    /// Returns `true` if the level is also deterministic and fully visible under the given changed rules.
    pub(super) fn is_exact(&self, rules: &Game) -> bool {
        let (analysis, start) = (Analysis::of(rules), start(rules, &self.level.source.level));
        analysis.is_deterministic_from(&start) && analysis.is_fully_observable_from(&start)
    }

    /// Plays actions from the start of the level under the given rules, until the episode is over. Returns the views of
    /// all states, including the first state, and the indices of the interactions that occurred.
    pub(super) fn record(&self, rules: &Game, actions: &[Action]) -> (Vec<View>, BTreeSet<usize>) {
        let legend = self.game.prompter.legend();
        let mut state = start(rules, &self.level.source.level);
        let (mut views, mut fired) = (vec![View::of(rules, &state, legend)], Fired::default());
        for &action in actions {
            if state.is_over() {
                break;
            }
            rules.step_watched(&mut state, action, &mut fired);
            views.push(View::of(rules, &state, legend));
        }
        (views, fired.0)
    }
}

/// The indices of the interactions that occurred.
#[derive(Default)]
struct Fired(BTreeSet<usize>);

impl Watch for Fired {
    fn interaction(&mut self, line: usize) {
        self.0.insert(line);
    }
}
