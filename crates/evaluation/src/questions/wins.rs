//! Questions about wins, each answered by a win or by an exhaustive search. The searches use no lower bounds, so a
//! plain search can confirm their results.

use super::boards::position;
use super::draft::{Draft, Form};
use super::place::Place;
use super::question::Evidence;
use agents::search::{Answer, Pushes, SearchLimits, Searched, a_star, best_first};
use base::Sampler;
use engine::{Action, State};
use std::collections::BTreeSet;

/// The maximum number of forward-model calls per search.
const CALLS: u64 = 10_000;

/// The maximum number of positions to examine for a pair of questions.
const POSITIONS: usize = 12;

/// The number of searches without an answer after which the level is abandoned.
const UNKNOWN: usize = 3;

/// The maximum number of actions that lead to a position.
const BEFORE: usize = 24;

/// The range of lengths, in actions, of the shortest wins that questions are about.
const SHORTEST: std::ops::RangeInclusive<usize> = 2..=12;

/// Draws a pair of questions about one level: one about a position that can be won, and one about a position that
/// cannot. Both positions are reached after the same number of actions. Positions whose search reaches its limit are
/// dropped.
pub(super) fn winnable(place: Place<'_>, sampler: &mut Sampler) -> Option<Vec<Draft>> {
    let length = sampler.between(1, BEFORE);
    let (mut won, mut lost) = (None, None);
    let (mut seen, mut unknown) = (BTreeSet::new(), 0);
    for _ in 0..POSITIONS {
        let before = place.walk(length, sampler);
        let Some(state) = place.after(&before) else { continue };
        if unknown == UNKNOWN || !seen.insert(state.search_key(place.rules())) {
            continue;
        }
        let searched =
            best_first(&place.game.subject.analysis, &Pushes::default(), &state, SearchLimits::calls(CALLS));
        match searched.answer {
            Answer::Won { actions, .. } if won.is_none() => won = Some((before, actions)),
            Answer::Impossible if lost.is_none() => lost = Some((before, searched.states)),
            Answer::OutOfCalls | Answer::OutOfMemory => unknown += 1,
            Answer::Won { .. } | Answer::Impossible => {}
        }
        if won.is_some() && lost.is_some() {
            break;
        }
    }
    let ((won, win), (lost, states)) = (won?, lost?);
    let yes = Evidence {
        how: "Play `before` and then `win` from the start of the level: the level is won.".to_owned(),
        before: won,
        win,
        ..Evidence::default()
    };
    let no = Evidence {
        how: "Play `before`, and search all states that can follow: none of them is won.".to_owned(),
        before: lost,
        states: Some(states),
        ..Evidence::default()
    };
    let question = "## Question\nCan the game still be won from this position? The player may press any keys, for as long as the rules allow.";
    pair(place, (question, yes), (question, no), sampler)
}

/// Draws a pair of questions about one position. One states the number of actions in the shortest win, and the other
/// states one action fewer.
pub(super) fn win_within(place: Place<'_>, sampler: &mut Sampler) -> Option<Vec<Draft>> {
    let rest = sampler.between(*SHORTEST.start(), *SHORTEST.end()).min(place.win().len());
    let mut before = place.win()[..place.win().len() - rest].to_vec();
    before.extend(place.random(sampler.between(0, 3), sampler));
    let (win, states) = shortest_win(place, &place.after(&before)?)?;
    let within = win.len() as u64;
    let of = |within: u64, how: &str| {
        let (before, win) = (before.clone(), win.clone());
        let evidence = Evidence {
            how: how.to_owned(),
            before,
            win,
            within: Some(within),
            states: Some(states),
            ..Evidence::default()
        };
        let actions = if within == 1 { "action" } else { "actions" };
        (
            format!(
                "## Question\nCan the player win from this position with at most {within} {actions}? Pressing no key (nil) counts as an action."
            ),
            evidence,
        )
    };
    let (yes, proof) = of(
        within,
        "Play `before` and then `win` from the start of the level: the level is won with at most `within` actions.",
    );
    let (no, refutation) = of(
        within - 1,
        "Play `before`, and search breadth-first: no win has at most `within` actions. `win` is the shortest win.",
    );
    pair(place, (&yes, proof), (&no, refutation), sampler)
}

/// Returns the shortest win and the number of states that the search covered, if the search completes and the length
/// of the win is within [`SHORTEST`].
fn shortest_win(place: Place<'_>, state: &State) -> Option<(Vec<Action>, u64)> {
    let limits = SearchLimits::calls(CALLS);
    let Searched { answer, states, .. } =
        a_star(&place.game.subject.analysis, &Pushes::default(), state, limits);
    match answer {
        Answer::Won { actions, shortest: true } if SHORTEST.contains(&actions.len()) => {
            Some((actions, states))
        }
        _ => None,
    }
}

/// Returns two drafts in random order, one with the answer yes and one with the answer no.
fn pair(
    place: Place<'_>,
    yes: (&str, Evidence),
    no: (&str, Evidence),
    sampler: &mut Sampler,
) -> Option<Vec<Draft>> {
    let draft = |(question, evidence): (&str, Evidence), answer| {
        let parts = [position(place, &evidence.before)?, question.to_owned()];
        Some(Draft::new(place, &place.game.section("Rules"), &parts, Form::YesNo(answer), evidence))
    };
    let mut drafts = vec![draft(yes, true)?, draft(no, false)?];
    sampler.shuffle(&mut drafts);
    Some(drafts)
}
