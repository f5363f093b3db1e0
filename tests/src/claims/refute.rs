//! Searches an episode for a moment that contradicts a claim.

use super::play::{Frame, Play};
use super::{Case, Ending, Fact, Policy, Provided, Tie, When};
use base::Seed;
use engine::analysis::Precondition;
use engine::syntax::{self, Param, SpriteLine};
use engine::{Action, MAX_TICKS, Outcome, SpriteRecord, SpriteType};
use std::collections::BTreeMap;

/// The number of ticks in an idle episode.
const IDLE: usize = 24;

fn stype(record: &SpriteRecord) -> SpriteType {
    SpriteType(record.stype)
}

fn is_disabled(record: &SpriteRecord) -> bool {
    record.flags & 1 != 0
}

fn is_avatar(record: &SpriteRecord) -> bool {
    record.flags & 2 != 0
}

impl Frame {
    fn count(&self, types: &[SpriteType]) -> usize {
        // A type that is listed twice counts twice.
        let count = |own: &SpriteType| {
            let counted = |record: &&SpriteRecord| !is_disabled(record) && stype(record) == *own;
            self.sprites.iter().filter(counted).count()
        };
        types.iter().map(count).sum()
    }

    /// Returns `true` if the tick was completed.
    fn is_whole(&self) -> bool {
        !matches!(self.outcome, Outcome::Stopped(_) | Outcome::Ended)
    }

    fn find(&self, id: u32) -> Option<&SpriteRecord> {
        self.sprites.binary_search_by_key(&id, |record| record.id).ok().map(|at| &self.sprites[at])
    }
}

/// Returns an episode's complete ticks, each with its number (counted from 1), the state before it and the
/// state after it.
fn ticks(play: &Play) -> impl Iterator<Item = (usize, &Frame, &Frame)> {
    let pairs = play.frames.windows(2).enumerate();
    pairs.map(|(at, pair)| (at + 1, &pair[0], &pair[1])).filter(|(.., after)| after.is_whole())
}

impl Fact {
    /// Returns the contradiction between the claim and an episode of the case, if there is one.
    pub fn refuted_by(&self, case: &Case, play: &Play) -> Option<String> {
        let name = |stype: SpriteType| case.game.name(stype);
        let ended = play.frames.last().map_or(Outcome::Ongoing, |frame| frame.outcome);
        let played = play.actions.len();
        let at_limit = i64::try_from(played).is_ok_and(|played| played > i64::from(MAX_TICKS));
        let wanted = |win: bool| if win { Outcome::Won } else { Outcome::Lost };
        match self {
            Fact::Endings(endings, tie) => refute_endings(case, endings, tie, play),
            Fact::Unattainable(win) => (ended == wanted(*win) && played > 1 && !at_limit)
                .then(|| format!("{ended:?} in tick {played}")),
            Fact::OutOfReach(win) => {
                (ended == wanted(*win) && !at_limit).then(|| format!("{ended:?} in tick {played}"))
            }
            Fact::OverAtOnce(win) => {
                let outcome = play.frames.get(1)?.outcome;
                let stopped = matches!(outcome, Outcome::Stopped(_) | Outcome::Ended);
                let fits = win.map_or(outcome != Outcome::Ongoing, |win| outcome == wanted(win));
                (!fits && !stopped).then(|| format!("{outcome:?} after the first tick"))
            }
            Fact::Silent(line) => {
                let at = play.frames.iter().position(|frame| frame.lines.contains(line))?;
                let written = &case.game.description().interactions[*line];
                Some(format!("`{} {}` in tick {at}", written.first.text, written.effect.text))
            }
            Fact::HeldAtMost(resource, most) => play.frames.iter().enumerate().find_map(|(at, frame)| {
                let held = frame.sprites.iter().flat_map(|record| {
                    let own = record.resources.iter().filter(|(held, _)| *held == resource.0);
                    own.map(move |(_, amount)| (record, *amount))
                });
                let (record, amount) = held.into_iter().find(|(_, amount)| i64::from(*amount) > *most)?;
                let (holder, resource) = (name(stype(record)), name(*resource));
                Some(format!("{holder} holds {amount} {resource} in tick {at}, not at most {most}"))
            }),
            Fact::ScoreAtMost(most) => play.frames.iter().enumerate().find_map(|(at, frame)| {
                (frame.score > *most as f64).then(|| format!("the score is {} in tick {at}", frame.score))
            }),
            Fact::Absent(absent) => play.frames.iter().enumerate().find_map(|(at, frame)| {
                let there = frame.sprites.iter().any(|record| stype(record) == *absent);
                there.then(|| format!("{} is present in tick {at}", name(*absent)))
            }),
            Fact::OnlyTypes(types) => play.frames.iter().enumerate().find_map(|(at, frame)| {
                let strange = |record: &&SpriteRecord| {
                    !types.contains(&stype(record)) && takes_part(case, stype(record))
                };
                let other = frame.sprites.iter().find(strange)?;
                Some(format!("{} is present in tick {at}", name(stype(other))))
            }),
            Fact::OnlyMembers(group, types) => play.frames.iter().enumerate().find_map(|(at, frame)| {
                let own = |record: &&SpriteRecord| case.analysis.applies(*group, stype(record));
                let other =
                    frame.sprites.iter().filter(own).find(|record| !types.contains(&stype(record)))?;
                Some(format!("{} is present in tick {at}", name(stype(other))))
            }),
            Fact::NeverMeet(first, second) => play.frames.iter().enumerate().find_map(|(at, frame)| {
                let lines = &case.game.description().interactions;
                let at_edge = |line: usize| lines[line].second.iter().any(|word| word.text == "EOS");
                let met = frame.meetings.iter().find(|meeting| match (second, meeting.second) {
                    (None, None) => first.contains(&meeting.first) && at_edge(meeting.line),
                    (Some(second), Some(partner)) => {
                        let meet = |one, two| first.contains(one) && second.contains(two);
                        meet(&meeting.first, &partner) || meet(&partner, &meeting.first)
                    }
                    _ => false,
                })?;
                Some(format!("{} meets it in tick {at}", name(met.first)))
            }),
            Fact::OnlyAvatars(types) => play.frames.iter().enumerate().find_map(|(at, frame)| {
                let other = frame.avatar.filter(|avatar| !types.contains(avatar))?;
                Some(format!("the avatar is {} in tick {at}", name(other)))
            }),
            Fact::Stands(stands) => {
                ticks(play).filter(|(.., after)| after.lines.is_empty()).find_map(|(tick, before, after)| {
                    moved(before, after, |record| stype(record) == *stands).map(|record| {
                        format!(
                            "{} moves to {:?} in tick {tick}, in which no rule runs",
                            name(*stands),
                            record.rect
                        )
                    })
                })
            }
            Fact::Fixed(fixed) => ticks(play).find_map(|(tick, before, after)| {
                let record = moved(before, after, |record| stype(record) == *fixed)?;
                Some(format!("{} moves to {:?} in tick {tick}", name(*fixed), record.rect))
            }),
            Fact::OthersIdle => {
                ticks(play).filter(|(.., after)| after.lines.is_empty()).find_map(|(tick, before, after)| {
                    let record = moved(before, after, |record| !is_avatar(record))?;
                    Some(format!("{} moves in tick {tick}, in which no rule runs", name(stype(record))))
                })
            }
            Fact::Single(types) => {
                let most = play.frames.first()?.count(types).max(1);
                play.frames.iter().enumerate().find_map(|(at, frame)| {
                    let count = frame.count(types);
                    (count > most).then(|| format!("{count} of {} in tick {at}", name(types[0])))
                })
            }
            Fact::OnlyFalls(types) => {
                let most = i64::try_from(play.frames.first()?.count(types)).ok()?;
                Fact::CountAtMost(types.clone(), most).refuted_by(case, play)
            }
            Fact::CountAtMost(types, most) => play.frames.iter().enumerate().find_map(|(at, frame)| {
                let count = frame.count(types);
                let too_many = i64::try_from(count).is_ok_and(|count| count > *most) && frame.is_whole();
                too_many.then(|| format!("{count} in tick {at}, not at most {most}"))
            }),
            Fact::Permanent(sprites) => sprites.iter().find_map(|(permanent, cell)| {
                let start = play.frames.first()?;
                let own = |record: &&SpriteRecord| {
                    stype(record) == *permanent && cell_of(case, play, record) == Some(*cell)
                };
                let ids: Vec<u32> = start.sprites.iter().filter(own).map(|record| record.id).collect();
                ticks(play).find_map(|(tick, _, after)| {
                    let stays = |id: &u32| {
                        let found = after.find(*id);
                        found.is_some_and(|record| stype(record) == *permanent && !is_disabled(record))
                    };
                    (!ids.iter().all(stays)).then(|| format!("{} is gone in tick {tick}", name(*permanent)))
                })
            }),
            Fact::GoalNeverHolds(goal) => {
                let types = case.analysis.goals()[*goal].condition.types();
                let mut whole =
                    play.frames.iter().enumerate().filter(|(at, frame)| *at > 0 && frame.is_whole());
                whole.find_map(|(at, frame)| {
                    let count = |stype: SpriteType| i32::try_from(frame.count(&[stype])).unwrap_or(i32::MAX);
                    let holds = case.analysis.goals()[*goal].condition.holds(count, at as i32 - 1);
                    let named: Vec<&str> = types.iter().map(|&stype| name(stype)).collect();
                    holds.then(|| {
                        format!("the termination that counts {} holds in tick {at}", named.join(", "))
                    })
                })
            }
            Fact::NeverAt(never, cell) => {
                let whole = play.frames.iter().enumerate().filter(|(_, frame)| frame.is_whole());
                whole.into_iter().find_map(|(at, frame)| {
                    let there = frame.sprites.iter().filter(|record| stype(record) == *never);
                    let there = there.into_iter().any(|record| cells_of(case, play, record).contains(cell));
                    there.then(|| format!("{} is in cell {cell} in tick {at}", name(*never)))
                })
            }
            Fact::Within(within) => {
                let whole = play.frames.iter().enumerate().filter(|(_, frame)| frame.is_whole());
                whole.into_iter().find_map(|(at, frame)| {
                    frame.sprites.iter().find_map(|record| {
                        let own = &within[usize::from(record.stype)];
                        let cell = cells_of(case, play, record).into_iter().find(|cell| !own[*cell])?;
                        Some(format!("{} is in cell {cell} in tick {at}", name(stype(record))))
                    })
                })
            }
            Fact::CellsVisited(most) => {
                let mut visited = vec![false; case.level.cells().len()];
                for frame in play.frames.iter().filter(|frame| frame.is_whole()) {
                    for record in frame.sprites.iter().filter(|record| is_avatar(record)) {
                        cells_of(case, play, record).into_iter().for_each(|cell| visited[cell] = true);
                    }
                }
                let count = visited.iter().filter(|visited| **visited).count();
                (count > *most).then(|| format!("{count} cells are visited, not at most {most}"))
            }
            Fact::CannotEnter(first, second) => refute_barrier(case, play, first, second.as_deref()),
            Fact::Unseen(unseen) => {
                let mut state = case.game.start(&case.level, play.seed);
                let mut actions = play.actions.iter();
                loop {
                    let cells = case.game.observe(&state).cells;
                    if cells.iter().flatten().any(|seen| seen == name(*unseen)) {
                        return Some(format!("{} is seen", name(*unseen)));
                    }
                    case.game.step(&mut state, *actions.next()?);
                }
            }
            Fact::DeadKeys => {
                let idle = vec![Action::Nil; played];
                differs(case, play, &Play::of(case, play.seed, &idle), "other keys")
            }
            Fact::IdleKeys(keys) => {
                let idle = |action: &Action| if keys.contains(action) { Action::Nil } else { *action };
                let actions: Vec<Action> = play.actions.iter().map(idle).collect();
                if actions == play.actions {
                    return None;
                }
                differs(case, play, &Play::of(case, play.seed, &actions), "other keys")
            }
            Fact::NoChance => {
                differs(case, play, &Play::of(case, Seed::from_text("other"), &play.actions), "another seed")
            }
            Fact::TurnBased => refute_turns(case, play.seed),
            Fact::AllShown => play.frames.iter().enumerate().find_map(|(at, frame)| {
                // Other interactions may be executed although their condition can never hold.
                let always = |line: usize| {
                    let mut own = case.analysis.encounters().iter().filter(|other| other.line == line);
                    own.any(|encounter| {
                        encounter.precondition == Precondition::Always && !encounter.effects.is_empty()
                    })
                };
                let hidden = |stype: &SpriteType| case.analysis.facts(*stype).hidden;
                let parties = |meeting: &engine::Meeting| [Some(meeting.first), meeting.second];
                let certain = frame.meetings.iter().filter(|meeting| always(meeting.line));
                let hidden = certain.flat_map(parties).flatten().find(hidden)?;
                Some(format!("an interaction in tick {at} concerns {}, which is not shown", name(hidden)))
            }),
            Fact::Ignored(position) => {
                let other = without(&case.source, *position)?;
                let other = Case::load(&other, &case.text, case.policy)?;
                differs(case, play, &Play::of(&other, play.seed, &play.actions), "a game without it")
            }
            Fact::SearchedInVain => (ended == Outcome::Won).then(|| format!("won in tick {played}")),
        }
    }
}

/// Returns a sprite that `wanted` accepts and whose position changed during the tick; `None` if there is no such
/// sprite.
fn moved<'a>(
    before: &Frame,
    after: &'a Frame,
    wanted: impl Fn(&SpriteRecord) -> bool,
) -> Option<&'a SpriteRecord> {
    before.sprites.iter().filter(|record| wanted(record)).find_map(|record| {
        let now = after.find(record.id)?;
        (now.rect != record.rect && now.stype == record.stype).then_some(now)
    })
}

/// Returns the cell that contains the sprite's top left corner; `None` if the corner is not on the board.
fn cell_of(case: &Case, play: &Play, record: &SpriteRecord) -> Option<usize> {
    let (column, row) = (record.rect.x.div_euclid(play.block), record.rect.y.div_euclid(play.block));
    let inside = column >= 0 && row >= 0 && (column as usize) < case.level.columns();
    inside.then_some(row as usize * case.level.columns() + column as usize)
}

/// Returns all board cells that a sprite covers.
fn cells_of(case: &Case, play: &Play, record: &SpriteRecord) -> Vec<usize> {
    let span = |from: i32, size: i32, limit: usize| {
        let last = from.saturating_add(size).saturating_sub(1).div_euclid(play.block);
        from.div_euclid(play.block).max(0)..=last.min(limit as i32 - 1)
    };
    let columns = span(record.rect.x, record.rect.w, case.level.columns());
    let rows = span(record.rect.y, record.rect.h, case.level.rows());
    let cells = rows.flat_map(|row| columns.clone().map(move |column| (column, row)));
    cells.map(|(column, row)| row as usize * case.level.columns() + column as usize).collect()
}

/// Returns the first difference between two episodes with the same actions; `None` if there is no difference.
fn differs(case: &Case, one: &Play, two: &Play, with: &str) -> Option<String> {
    let equal = |one: &Frame, two: &Frame| {
        // Sprites that differ are compared as text, because some speeds are NaN.
        let same = |one: &[SpriteRecord], two: &[SpriteRecord]| {
            one == two || format!("{one:?}") == format!("{two:?}")
        };
        one.outcome == two.outcome && one.score == two.score && same(&one.sprites, &two.sprites)
    };
    let pairs = one.frames.iter().zip(&two.frames);
    let whole = |(one, two): &(&Frame, &Frame)| one.is_whole() && two.is_whole();
    let at = pairs.take_while(whole).position(|(one, two)| !equal(one, two));
    let at = at?;
    let (one, two) = (&one.frames[at], &two.frames[at]);
    let changed =
        one.sprites.iter().zip(&two.sprites).find(|(one, two)| format!("{one:?}") != format!("{two:?}"));
    let what = changed.map_or("counts, outcome or score".to_owned(), |(one, two)| {
        format!("{} {one:?} and {two:?}", case.game.name(stype(one)))
    });
    Some(format!("with {with}, tick {at} differs: {what}"))
}

impl When {
    fn types(&self) -> &[SpriteType] {
        match self {
            When::AtMost(types, _) | When::AtLeast(types, _) | When::Exactly(types, _) => types,
            When::Ticks(_) => &[],
        }
    }

    fn holds(&self, frame: &Frame, tick: usize) -> bool {
        let count = || i64::try_from(frame.count(self.types())).unwrap_or(i64::MAX);
        match self {
            When::AtMost(_, limit) => count() <= *limit,
            When::AtLeast(_, limit) => count() >= *limit,
            When::Exactly(_, limit) => count() == *limit,
            When::Ticks(ticks) => i64::try_from(tick).is_ok_and(|tick| tick >= *ticks),
        }
    }
}

impl Ending {
    fn holds(&self, before: &Frame, frame: &Frame, tick: usize) -> bool {
        let kinds = || self.when.types().iter().filter(|stype| frame.count(&[**stype]) > 0).count();
        let held_up = self.unless.as_ref().is_some_and(|unless| match (unless.before, tick) {
            (true, 1) => unless.not_first,
            (true, _) => unless.when.holds(before, tick - 1),
            (false, _) => unless.when.holds(frame, tick),
        });
        let fits = self.kinds.is_none_or(|wanted| kinds() == wanted);
        fits && !held_up && self.when.holds(frame, tick) && self.is_provided(frame)
    }

    fn is_provided(&self, frame: &Frame) -> bool {
        let first = frame.counters.first();
        match self.provided {
            Provided::Always => true,
            Provided::Score => frame.score != 0.0,
            Provided::NoScore => frame.score == 0.0,
            Provided::Difference => frame.counters.iter().any(|counter| Some(counter) != first),
            Provided::NoDifference => frame.counters.iter().all(|counter| Some(counter) == first),
            Provided::Value(value) => first == Some(&value),
            Provided::OtherValue(value) => first != Some(&value),
        }
    }
}

/// Checks that every end of an episode matches a claimed ending, that every claimed ending ends the episode,
/// and that the outcome is the claimed one.
fn refute_endings(case: &Case, endings: &[Ending], tie: &Tie, play: &Play) -> Option<String> {
    ticks(play).find_map(|(tick, before, frame)| {
        let holds =
            |win: bool| endings.iter().any(|ending| ending.win == win && ending.holds(before, frame, tick));
        let counts = || {
            let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
            for record in frame.sprites.iter().filter(|record| !is_disabled(record)) {
                *counts.entry(case.game.name(stype(record))).or_default() += 1;
            }
            format!("in tick {tick}, with score {} and {counts:?}", frame.score)
        };
        let at_limit = i64::try_from(tick).is_ok_and(|tick| tick > i64::from(MAX_TICKS));
        match frame.outcome {
            Outcome::Won if !holds(true) => Some(format!("won as no sentence says {}", counts())),
            Outcome::Lost if !holds(false) && !at_limit => {
                Some(format!("lost as no sentence says {}", counts()))
            }
            Outcome::Won if holds(false) && *tie == Tie::Lost => Some(format!("a tie is won {}", counts())),
            Outcome::Lost if holds(true) && *tie == Tie::Won && !at_limit => {
                Some(format!("a tie is lost {}", counts()))
            }
            Outcome::Ongoing if holds(true) || holds(false) => {
                Some(format!("the game goes on against a sentence {}", counts()))
            }
            _ => None,
        }
    })
}

/// The effects that neither move nor turn sprites. In a tick with only these effects, barriers stay barriers.
const STILL_EFFECTS: [&str; 8] = [
    "stepBack",
    "collectResource",
    "changeResource",
    "killSprite",
    "killAll",
    "killIfHasMore",
    "killIfOtherHasMore",
    "subtractHealthPoints",
];

/// Finds a sprite that moves onto a barrier that was there before and has not moved.
fn refute_barrier(
    case: &Case,
    play: &Play,
    first: &[SpriteType],
    second: Option<&[SpriteType]>,
) -> Option<String> {
    let lines = &case.game.description().interactions;
    let quiet = |frame: &Frame| {
        // Avatars other than the player's are never updated, and return to older positions.
        let avatars = frame.sprites.iter().filter(|record| is_avatar(record)).count();
        // A sprite moved flush with one sprite may overlap another.
        let is_rough = |param: &Param| param.key.text == "pixelPerfect";
        let is_quiet = |&line: &usize| {
            let line = &lines[line];
            STILL_EFFECTS.contains(&line.effect.text.as_str()) && !line.params.iter().any(is_rough)
        };
        avatars < 2 && frame.lines.iter().all(is_quiet)
    };
    let (columns, rows) = (case.level.columns() as i32 * play.block, case.level.rows() as i32 * play.block);
    let inside = |record: &SpriteRecord| {
        let rect = record.rect;
        rect.x >= 0 && rect.y >= 0 && rect.x + rect.w <= columns && rect.y + rect.h <= rows
    };
    ticks(play).filter(|(.., after)| quiet(after)).find_map(|(tick, before, after)| {
        let movers =
            before.sprites.iter().filter(|record| first.contains(&stype(record)) && !is_disabled(record));
        let mut movers = movers.filter_map(|record| Some((record, after.find(record.id)?)));
        movers.find_map(|(was, is)| {
            if was.rect == is.rect || was.stype != is.stype || is_disabled(is) {
                return None;
            }
            let name = case.game.name(stype(is));
            let Some(second) = second else {
                return (inside(was) && !inside(is))
                    .then(|| format!("{name} leaves the board in tick {tick}"));
            };
            let others =
                before.sprites.iter().filter(|record| second.contains(&stype(record)) && record.id != is.id);
            // A sprite that is put back after its move was elsewhere when the other sprite arrived.
            let put_back =
                |other: &SpriteRecord| after.meetings.iter().any(|meeting| meeting.first == stype(other));
            let mut others = others.filter(|record| !put_back(record)).filter(|record| {
                after.find(record.id).is_some_and(|now| now.rect == record.rect && now.stype == record.stype)
            });
            let entered =
                others.find(|other| !other.rect.intersects(was.rect) && other.rect.intersects(is.rect))?;
            let other = case.game.name(stype(entered));
            Some(format!("{name} enters {other} at {:?} in tick {tick}", entered.rect))
        })
    })
}

/// Returns `true` if an interaction or a termination involves the type.
fn takes_part(case: &Case, stype: SpriteType) -> bool {
    let analysis = &case.analysis;
    let meets = analysis.encounters().iter().any(|encounter| {
        let second = encounter.second.is_some_and(|second| analysis.applies(second, stype));
        second || analysis.applies(encounter.first, stype)
    });
    meets || analysis.goals().iter().any(|goal| goal.condition.types().contains(&stype))
}

/// Finds an event in the game that occurs although no key is pressed.
fn refute_turns(case: &Case, seed: Seed) -> Option<String> {
    let shown = |frame: &Frame| {
        let own = frame.sprites.iter().filter(|record| takes_part(case, stype(record)));
        own.map(|record| (record.stype, record.rect)).collect::<Vec<_>>()
    };
    let play = Play::of(case, seed, &[Action::Nil; IDLE]);
    // The first tick is skipped, because sprites that the level places on top of each other meet in it.
    ticks(&play).skip(1).find_map(|(tick, before, after)| {
        let (one, two) = (shown(before), shown(after));
        let fresh =
            two.iter().find(|now| !one.contains(now)).or_else(|| one.iter().find(|was| !two.contains(was)));
        let (stype, rect) = fresh?;
        Some(format!(
            "{} changes at {rect:?} in tick {tick}, though no key is pressed",
            case.game.name(SpriteType(*stype))
        ))
    })
}

/// Returns the text of a game without the parameter at the given byte offset.
fn without(source: &str, position: usize) -> Option<String> {
    fn drop_at(params: &mut Vec<Param>, position: usize) -> bool {
        let before = params.len();
        params.retain(|param| param.key.span.start != position);
        params.len() < before
    }
    fn in_sprites(lines: &mut [SpriteLine], position: usize) -> bool {
        lines
            .iter_mut()
            .any(|line| drop_at(&mut line.params, position) || in_sprites(&mut line.children, position))
    }
    let (mut description, _) = syntax::parse(source);
    let found = in_sprites(&mut description.sprites, position)
        || description.interactions.iter_mut().any(|line| drop_at(&mut line.params, position));
    let other = syntax::print(&description);
    (found && Policy::Strict.load(&other).is_some()).then_some(other)
}
