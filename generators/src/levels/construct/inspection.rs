//! The final inspection of a board, in which the solutions of puzzles are played.

use super::board::Board;
use super::constructive::{ConstructiveLevels, Made};
use base::Seed;
use engine::analysis::{Harm, Motion, Reason, Role, Steering};
use engine::{Action, Level, Outcome, SpriteType, State};

/// The number of ticks that a player who does nothing should survive.
const GRACE_TICKS: usize = 12;
/// The number of random futures in which an idle player must survive.
const FUTURES: u64 = 4;
/// The number of ticks within which an idle player should not win.
const MAX_IDLE_TICKS: usize = 300;
/// The maximum number of ticks for which an idle player is tested if survival wins. In deterministic games, also the
/// number of random actions to test.
const MAX_TICKS: usize = 1000;

impl ConstructiveLevels<'_> {
    /// Converts a board to a level, or returns a description of the board's problem. The `bool` is `true` if an idle
    /// player survives the first ticks.
    pub(crate) fn inspect(&self, made: &Made, seed: Seed) -> Result<(Level, bool), String> {
        let board = &made.board;
        let text = board.text(&self.palette);
        let level = self.game.level(&text).map_err(|problems| problems.to_string())?;
        let state = self.game.start(&level, seed);
        if let Some(goal) = self.analysis.goal_met(&state) {
            return Err(format!("termination {} holds at the start", goal.line + 1));
        }
        for &(stype, asked) in &self.config.counts {
            let there = board.count(&self.analysis, stype);
            if there != asked {
                let name = self.game.name(stype);
                return Err(format!("requested {asked} of {name}, but placed {there}"));
            }
        }
        if made.played {
            return Ok((level, self.is_survivable(&state, seed)));
        }
        let cells = board.grid.len();
        let reach = board.reach(&self.analysis, &self.palette);
        let near = |cell: usize| reach[cell] || board.grid.beside(cell).any(|next| reach[next]);
        let missing = (0..cells).find(|&cell| {
            let goal = board.placed[cell].is_some_and(|symbol| self.is_goal(symbol));
            goal && !near(cell)
        });
        if let Some(cell) = missing {
            return Err(format!("a goal in row {} cannot be reached", board.grid.y(cell) + 1));
        }
        let short = self.analysis.requirements().iter().any(|requirement| {
            let count = |stype: &SpriteType| board.count(&self.analysis, *stype);
            let lock = match requirement.reason {
                Reason::Lock(stype) => {
                    let locks = matches!(self.analysis.role(stype), Role::Gate | Role::Exit);
                    locks && board.count(&self.analysis, stype) > 0
                }
                Reason::Portal(stype) => board.count(&self.analysis, stype) > 0,
                Reason::WinMethod(_) | Reason::Avatar | Reason::Goal(_) => false,
            };
            let ground = requirement.types.iter().any(|stype| self.palette.ground.contains(stype));
            lock && !ground
                && requirement.types.iter().map(count).sum::<usize>() < requirement.at_least as usize
        });
        if short {
            return Err("a lock has too few keys".to_owned());
        }
        Ok((level, self.is_survivable(&state, seed)))
    }

    /// Returns `true` if doing nothing wins the level, or if random actions win it in a deterministic game.
    pub(crate) fn is_trivial(&self, level: &Level, seed: Seed) -> bool {
        let start = self.game.start(level, seed);
        let wins = |ticks: usize, seed: Seed, act: &mut dyn FnMut(&State) -> Action| {
            let mut state = start.fork(seed);
            (0..ticks).any(|_| {
                let action = act(&state);
                self.game.step(&mut state, action) == Outcome::Won
            })
        };
        let survive = self.analysis.aims().survive.and_then(|tick| usize::try_from(tick).ok());
        let patience = survive.map_or(MAX_IDLE_TICKS, |tick| (tick + 1).min(MAX_TICKS));
        if wins(patience, seed.child("idle", 0), &mut |_| Action::Nil) {
            return true;
        }
        let mut sampler = seed.child("steps", 0).sampler();
        self.analysis.is_deterministic_from(&start)
            && (0..2).any(|future| {
                wins(MAX_TICKS, seed.child("steps of", future), &mut |state| {
                    *sampler.choose(self.game.actions(state))
                })
            })
    }

    /// Returns `true` if all expected types are on the board, and sprites stand next to their companions as often as in
    /// the examples.
    pub(crate) fn has_companions(&self, made: &Made) -> bool {
        let Some(examples) = self.config.like.as_deref() else { return true };
        let board = &made.board;
        let holds = |cell: usize, stype: SpriteType| {
            board.placed[cell].is_some_and(|symbol| self.game.places(symbol).contains(&stype))
        };
        let cells = || 0..board.grid.len();
        self.game.sprite_types().all(|stype| {
            let placement = examples.placement(stype);
            if placement.companions().next().is_none() {
                return true;
            }
            let own: Vec<usize> = cells().filter(|&cell| holds(cell, stype)).collect();
            let kept = own.iter().filter(|&&cell| {
                placement
                    .companions()
                    .all(|(way, other)| board.grid.shift(cell, way).is_some_and(|next| holds(next, other)))
            });
            let expected = made.expected.contains(&stype);
            kept.count() * 5 >= own.len() * 4 && (!expected || !own.is_empty())
        })
    }

    /// Returns `true` if every harmless spawned chaser can reach its target by steps that each bring it nearer. Chasers
    /// never take other steps.
    pub(crate) fn chasers_reach_targets(&self, board: &Board) -> bool {
        let grid = board.grid;
        let types = |cell: usize| {
            let symbol = if board.wall[cell] { self.palette.wall } else { board.placed[cell] };
            symbol.map_or(&[][..], |symbol| self.game.places(symbol))
        };
        (0..grid.len()).all(|from| {
            types(from).iter().flat_map(|&maker| &self.analysis.facts(maker).makes).all(|&sent| {
                let Motion::Chasing(target) = self.analysis.facts(sent).motion else { return true };
                let is_target = |&stype: &SpriteType| self.analysis.applies(target, stype);
                let sought: Vec<usize> =
                    (0..grid.len()).filter(|&cell| types(cell).iter().any(is_target)).collect();
                let harmless =
                    self.analysis.harm(sent) == Harm::None && self.analysis.role(sent) != Role::Enemy;
                let Some(&aim) = sought.iter().min_by_key(|&&cell| grid.manhattan(cell, from)) else {
                    return true;
                };
                !harmless
                    || self.is_approached(board, from, aim, |cell| {
                        cell == aim || !types(cell).iter().any(|&stype| self.analysis.blocks(stype, sent))
                    })
            })
        })
    }

    /// Returns `true` if a path of open cells leads to the target and each of its steps comes nearer to the target.
    fn is_approached(&self, board: &Board, from: usize, aim: usize, open: impl Fn(usize) -> bool) -> bool {
        let grid = board.grid;
        let mut reached = vec![from];
        let mut at = 0;
        while let Some(&cell) = reached.get(at) {
            at += 1;
            let nearer = |next: &usize| grid.manhattan(*next, aim) < grid.manhattan(cell, aim) && open(*next);
            let next: Vec<usize> =
                grid.beside(cell).filter(nearer).filter(|next| !reached.contains(next)).collect();
            reached.extend(next);
        }
        reached.contains(&aim)
    }

    /// Returns `true` if a character places a sprite that the avatar must touch to win.
    fn is_goal(&self, symbol: u8) -> bool {
        let horizontal = self
            .analysis
            .start_avatar()
            .is_some_and(|avatar| matches!(avatar.steering, Steering::Horizontal | Steering::Vertical));
        !horizontal
            && self.game.places(symbol).iter().any(|&stype| {
                let role = self.analysis.role(stype);
                let wanted = self.analysis.aims().remove.contains(&stype);
                role == Role::Exit || (wanted && matches!(role, Role::Collectable | Role::Prey))
            })
    }

    /// Returns `true` if an idle player survives the grace period in all of a few random futures.
    fn is_survivable(&self, state: &State, seed: Seed) -> bool {
        (0..FUTURES).all(|future| {
            let mut state = state.fork(seed.child("future", future));
            (0..GRACE_TICKS).all(|_| {
                !matches!(self.game.step(&mut state, Action::Nil), Outcome::Lost | Outcome::Stopped(_))
            })
        })
    }

    /// Plays the avatar's steps on a board. Returns the actions if they win or, if `wins` is `false`, if all of them
    /// can be played. An avatar that turns before moving gets an extra tick for each turn.
    pub(crate) fn play(
        &self,
        board: &Board,
        ways: &[(i32, i32)],
        wins: bool,
        seed: Seed,
    ) -> Option<Vec<Action>> {
        let level = self.game.level(&board.text(&self.palette)).ok()?;
        let mut state = self.game.start(&level, seed);
        let mut actions = Vec::new();
        let place = |state: &State| {
            let avatar = state.avatar_id()?;
            let record = self.game.records(state).into_iter().find(|record| record.id == avatar)?;
            Some((record.rect.x, record.rect.y))
        };
        for &step in ways {
            let action = match step {
                (0, -1) => Action::Up,
                (-1, 0) => Action::Left,
                (0, 1) => Action::Down,
                _ => Action::Right,
            };
            let before = place(&state)?;
            let aim = (before.0 + step.0 * state.block(), before.1 + step.1 * state.block());
            for _ in 0..4 {
                actions.push(action);
                match self.game.step(&mut state, action) {
                    Outcome::Won => return Some(actions),
                    Outcome::Ongoing => {}
                    _ => return None,
                }
                if place(&state)? == aim {
                    break;
                }
            }
            if place(&state)? != aim {
                return None;
            }
        }
        (!wins).then_some(actions)
    }
}
