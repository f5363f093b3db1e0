//! The answers of external agents.

use crate::predictions::{Predicted, TouchFact};
use crate::turn::Turn;
use engine::Action;
use itertools::Itertools;
use serde::Deserialize;
use serde_json::Value;
use std::collections::BTreeMap;

/// An answer with an action, or with a plan's actions.
#[derive(Deserialize)]
struct Answer {
    action: Option<String>,
    actions: Option<Vec<String>>,
    output_tokens: Option<u64>,
    reasoning: Option<String>,
}

/// The thought that an answer may report.
#[derive(Default, Deserialize)]
pub(super) struct Thought {
    /// The number of output tokens, including reasoning.
    pub(super) output_tokens: Option<u64>,
    /// The reasoning, whose words count if there is no number of tokens.
    pub(super) reasoning: Option<String>,
}

/// The turn number that an answer may state.
#[derive(Deserialize)]
pub(super) struct Addressed {
    pub(super) turn: u64,
}

/// Returns an answer's actions (at most the number that is due) and the reasoning that it reports. Returns a message if
/// something is wrong with the answer.
pub(super) fn read(answer: &[u8], turn: &Turn<'_>) -> Result<(Vec<Action>, Thought), String> {
    if let Ok(Addressed { turn: addressed }) = serde_json::from_slice(answer)
        && addressed > turn.number
    {
        let number = turn.number;
        return Err(format!("this answers turn {addressed}, but the current turn is {number}"));
    }
    let names = |actions: &[Action]| actions.iter().map(ToString::to_string).join(", ");
    let expected = |problem: &str| match turn.commit.is_one() {
        true => format!("{problem}; answer with {{\"action\": …}}, using one of {}", names(turn.actions)),
        false => format!("{problem}; answer with {{\"actions\": […]}}, using up to {} actions", turn.due()),
    };
    let Answer { action, actions, output_tokens, reasoning } =
        serde_json::from_slice(answer).map_err(|error| expected(&error.to_string()))?;
    let actions = match (turn.commit.is_one(), action, actions) {
        (true, Some(action), _) => {
            let known = turn.actions.iter().find(|known| known.to_string() == action);
            let unavailable =
                || format!("the action `{action}` is not available now; available: {}", names(turn.actions));
            Ok(vec![*known.ok_or_else(unavailable)?])
        }
        (true, None, _) => Err(expected("missing field `action`")),
        // At this point, it is unknown which actions will be available later.
        (false, _, Some(actions)) => {
            let known = |action: String| {
                let found = Action::ALL.into_iter().find(|known| known.to_string() == action);
                found.ok_or_else(|| {
                    format!("`{action}` is not an action; the actions are {}", names(&Action::ALL))
                })
            };
            actions.into_iter().take(turn.due() as usize).map(known).collect::<Result<Vec<Action>, String>>()
        }
        (false, _, None) => Err(expected("missing field `actions`")),
    }?;
    Ok((actions, Thought { output_tokens, reasoning }))
}

/// Returns an answer's predictions, or a message stating the problem with the answer. `names` maps the names
/// sent to the process to the game's own names.
pub(super) fn read_predictions(answer: &[u8], names: &BTreeMap<String, String>) -> Result<Predicted, String> {
    const EXPECTED: &str = "answer with {\"kills\": […], \"stops\": […], \"goes\": […], \"scores\": […]}, \
                            using kinds from the question";
    let answer: BTreeMap<String, Value> =
        serde_json::from_slice(answer).map_err(|error| format!("{error}; {EXPECTED}"))?;
    let own = |name: String| {
        names
            .get(&name)
            .cloned()
            .ok_or_else(|| format!("`{name}` is not a kind from the question; {EXPECTED}"))
    };
    let facts = TouchFact::ALL.into_iter().map(|fact| {
        let missing = || format!("the list `{}` is missing; {EXPECTED}", fact.name());
        let named = answer.get(fact.name()).cloned().ok_or_else(missing)?;
        let named: Vec<String> = serde_json::from_value(named).map_err(|_| missing())?;
        Ok((fact, named.into_iter().map(own).collect::<Result<_, String>>()?))
    });
    facts.collect()
}
