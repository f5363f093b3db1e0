//! Questions about the next board.

use super::draft::{Draft, Form};
use super::place::Place;
use super::question::{Evidence, OptionSource};
use super::view::listed;
use base::Sampler;
use engine::{Action, Game};

/// The maximum number of actions before the position in question.
const BEFORE: usize = 12;

/// The maximum number of actions that a question asks about.
const ASKED: usize = 5;

/// The maximum number of attempts to find four distinct boards.
const ATTEMPTS: usize = 24;

/// Draws a question that asks for the board after one to five actions. The answer differs from the board shown.
pub(super) fn next_board(place: Place<'_>, sampler: &mut Sampler) -> Option<Vec<Draft>> {
    let before = place.walk(sampler.between(0, BEFORE), sampler);
    let now = board(place, &before, &[])?;
    let actions = place.random(sampler.between(1, ASKED), sampler);
    let next = board(place, &before, &actions).filter(|next| *next != now)?;
    let parts = [position(place, &before)?, asked(&actions) + " Write the board that follows."];
    let how = "Play `before` and then `actions` from the start of the level: the board is the answer.";
    let evidence = Evidence { how: how.to_owned(), before, actions, ..Evidence::default() };
    Some(vec![Draft::new(place, &place.game.section("Rules"), &parts, Form::Board(next), evidence)])
}

/// Draws a question that asks for the board after given actions, with four boards to choose from. All four are equally
/// likely to be right for an answerer who does not know the actions. The actions in question are drawn from a set of
/// similar sequences, and the options are the boards after these sequences. In half of the questions, two of the boards
/// result from rules with one interaction switched off.
pub(super) fn board_choice(place: Place<'_>, sampler: &mut Sampler) -> Option<Vec<Draft>> {
    let before = place.walk(sampler.between(0, BEFORE), sampler);
    board(place, &before, &[])?;
    let base = place.random(sampler.between(2, ASKED), sampler);
    let peers = if sampler.ratio(1, 2) { with_rule_off(place, &before, &base, sampler) } else { None };
    let mut peers = peers.or_else(|| after_other_actions(place, &before, &base, sampler))?;
    // Only boards that result from the unchanged rules can be right.
    let possible = peers.iter().filter(|(_, source)| source.without.is_none()).count();
    peers.swap(0, sampler.below(possible));
    let actions = peers[0].1.actions.clone();
    let parts = [position(place, &before)?, asked(&actions) + " Which board follows?"];
    let how = "Play `before` and then `actions` from the start of the level: the board is the answer. The other options follow from their own actions, or without one interaction.";
    let evidence = Evidence { how: how.to_owned(), before, actions, ..Evidence::default() };
    Some(vec![Draft::new(
        place,
        &place.game.section("Rules"),
        &parts,
        Form::Options(Box::new(peers)),
        evidence,
    )])
}

type Peers = [(String, OptionSource); 4];

/// Returns the boards after four similar sequences of actions, or `None` if too few boards differ.
fn after_other_actions(
    place: Place<'_>,
    before: &[Action],
    base: &[Action],
    sampler: &mut Sampler,
) -> Option<Peers> {
    let mut peers: Vec<(String, OptionSource)> = Vec::new();
    let mut actions = base.to_vec();
    for _ in 0..ATTEMPTS {
        if let Some(board) = board(place, before, &actions)
            && peers.iter().all(|(known, _)| *known != board)
        {
            peers.push((board, OptionSource { actions, ..OptionSource::default() }));
        }
        if peers.len() == 4 {
            break;
        }
        actions = edited(place, base, sampler);
    }
    peers.try_into().ok()
}

/// Returns a copy of the actions with one action replaced, removed, or swapped with its successor.
fn edited(place: Place<'_>, base: &[Action], sampler: &mut Sampler) -> Vec<Action> {
    let mut actions = base.to_vec();
    let at = sampler.below(actions.len());
    match sampler.below(3) {
        0 if actions.len() > 1 => {
            actions.remove(at);
        }
        1 if at + 1 < actions.len() => actions.swap(at, at + 1),
        _ => actions[at] = *sampler.choose(place.game.prompter.actions()),
    }
    actions
}

/// Returns the boards after two sequences of actions, first under the game's rules, and then with one interaction
/// switched off. This interaction has no visible consequences before the sequences begin. Returns `None` if fewer than
/// four boards differ.
fn with_rule_off(
    place: Place<'_>,
    before: &[Action],
    base: &[Action],
    sampler: &mut Sampler,
) -> Option<Peers> {
    let other = edited(place, base, sampler);
    let (views, _) = place.record(place.rules(), before);
    let (_, fired) = place.record(place.rules(), &[before, base].concat());
    let mut lines: Vec<usize> = fired.into_iter().collect();
    sampler.shuffle(&mut lines);
    lines.into_iter().find_map(|line| {
        let variant = place.rules().without(line);
        if !place.is_exact(&variant) || place.record(&variant, before).0 != views {
            return None;
        }
        let mut peers: Vec<(String, OptionSource)> = Vec::new();
        for (rules, without) in [(place.rules(), None), (&variant, Some(line))] {
            for actions in [base, &other] {
                let board = board_under(place, rules, &[before, actions].concat())?;
                let source = OptionSource { actions: actions.to_vec(), without, ..OptionSource::default() };
                if peers.iter().any(|(known, _)| *known == board) {
                    return None;
                }
                peers.push((board, source));
            }
        }
        peers.try_into().ok()
    })
}

/// Returns the board after the given actions, or `None` if the episode is over by then.
fn board(place: Place<'_>, before: &[Action], actions: &[Action]) -> Option<String> {
    board_under(place, place.rules(), &[before, actions].concat())
}

fn board_under(place: Place<'_>, rules: &Game, actions: &[Action]) -> Option<String> {
    let mut state = super::place::start(rules, &place.level.source.level);
    for &action in actions {
        rules.step(&mut state, action);
    }
    (!state.is_over()).then(|| place.view(&state).board)
}

/// Describes a position by the start of the level, the actions so far, and the current board. Returns `None` if the
/// episode is over by then.
pub(super) fn position(place: Place<'_>, before: &[Action]) -> Option<String> {
    let now = place.view(&place.after(before)?).text();
    if before.is_empty() {
        return Some(format!("## Board\nThe level has just started.\n{now}"));
    }
    let start = place.view(&place.level.start).text();
    Some(format!(
        "## Start of the level\n{start}\n\n## Actions so far\n{}\n\n## Board\n{now}",
        listed(before)
    ))
}

fn asked(actions: &[Action]) -> String {
    format!("## Question\nThe player now presses these keys, one per tick: {}.", listed(actions))
}
