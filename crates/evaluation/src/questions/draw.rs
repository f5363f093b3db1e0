//! Draws a set of questions from games.

use super::draft::{Draft, LETTERS};
use super::place::{Place, QuestionGame};
use super::question::{Question, QuestionKind};
use super::{boards, rules, wins};
use crate::error::EvaluationError;
use crate::subject::Subject;
use base::{Digest, Sampler, Seed};
use rayon::prelude::*;
use std::collections::BTreeSet;

/// The number of attempts that run in parallel. The result does not depend on the number of threads.
const BLOCK: u64 = 32;

/// The maximum number of attempts per requested question, in addition to one block.
const ATTEMPTS: u64 = 40;

/// A request for questions.
#[derive(Clone, Debug)]
pub struct QuestionOrder {
    /// The kinds of questions.
    pub kinds: Vec<QuestionKind>,
    /// The number of questions of each kind. If it is even, equally many questions have the answers yes and no.
    pub count: usize,
    /// The seed that determines the questions.
    pub seed: Seed,
}

/// Draws questions from the levels of games, sorted by kind. There are fewer questions of a kind than requested if the
/// levels do not provide enough, and none if no level is deterministic and fully visible. `drawn` is called with the
/// number of questions drawn so far.
///
/// Cost: up to 40,000 forward-model calls for each level, and several short replays or searches for each question.
///
/// # Errors
/// Returns an error if the prompts of a game cannot be written.
pub fn draw(
    subjects: &[Subject],
    order: &QuestionOrder,
    drawn: &mut dyn FnMut(usize),
) -> Result<Vec<Question>, EvaluationError> {
    let games: Vec<QuestionGame<'_>> =
        subjects.par_iter().map(QuestionGame::new).collect::<Result<_, _>>()?;
    let games: Vec<QuestionGame<'_>> = games.into_iter().filter(|game| !game.levels.is_empty()).collect();
    if games.is_empty() {
        return Ok(Vec::new());
    }
    let mut questions = Vec::new();
    for &kind in &order.kinds {
        let before = questions.len();
        let seed = order.seed.child(kind.name(), 0);
        questions.extend(draw_kind(&games, kind, order.count, seed, &mut |found| drawn(before + found)));
    }
    Ok(questions)
}

fn draw_kind(
    games: &[QuestionGame<'_>],
    kind: QuestionKind,
    count: usize,
    seed: Seed,
    found: &mut dyn FnMut(usize),
) -> Vec<Question> {
    let mut drafts: Vec<Draft> = Vec::new();
    let mut seen = BTreeSet::new();
    let blocks = (count as u64).saturating_mul(ATTEMPTS).div_ceil(BLOCK) + 1;
    for block in 0..blocks {
        let attempts = (block * BLOCK..(block + 1) * BLOCK).into_par_iter();
        let attempted: Vec<_> = attempts
            .map(|number| attempt(games, kind, &mut seed.child("attempt", number).sampler()))
            .collect();
        for group in attempted.into_iter().flatten() {
            let digests: Vec<Digest> =
                group.iter().map(|draft| Digest::of(draft.body().as_bytes())).collect();
            if drafts.len() < count && digests.iter().all(|digest| !seen.contains(digest)) {
                seen.extend(digests);
                drafts.extend(group);
            }
        }
        found(drafts.len().min(count));
        if drafts.len() >= count {
            break;
        }
    }
    drafts.truncate(count);
    let letters = letters(drafts.len(), &mut seed.child("letters", 0).sampler());
    let complete = |(number, (draft, letter)): (usize, (Draft, usize))| {
        draft.complete(kind, number, letter, seed.child("options", number as u64))
    };
    drafts.into_iter().zip(letters).enumerate().map(complete).collect()
}

/// Attempts to draw a question, or a pair of questions, about a random level of a random game.
fn attempt(games: &[QuestionGame<'_>], kind: QuestionKind, sampler: &mut Sampler) -> Option<Vec<Draft>> {
    let game = sampler.choose(games);
    let place = Place { game, level: sampler.choose(&game.levels) };
    match kind {
        QuestionKind::NextBoard => boards::next_board(place, sampler),
        QuestionKind::BoardChoice => boards::board_choice(place, sampler),
        QuestionKind::Winnable => wins::winnable(place, sampler),
        QuestionKind::WinWithin => wins::win_within(place, sampler),
        QuestionKind::ChangedRule => rules::changed_rule(place, sampler),
        QuestionKind::SpriteBehaviour => rules::sprite_behaviour(place, sampler),
    }
}

/// Returns the indices of the right options' letters, in random order. The numbers of times that two letters occur
/// differ by at most one.
fn letters(count: usize, sampler: &mut Sampler) -> Vec<usize> {
    let mut letters: Vec<usize> = (0..count).map(|number| number % LETTERS.len()).collect();
    sampler.shuffle(&mut letters);
    letters
}
