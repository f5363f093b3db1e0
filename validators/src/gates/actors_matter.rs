//! The `actors-matter` gate: checks that self-moving sprites range over the board and get in the player's way.

use super::{Gates, NO_WIN, WonLevel, finding, without_subject, won_levels};
use crate::allowance::Setting;
use crate::evidence::Evidence;
use crate::validator::{GameCase, GameValidator};
use crate::verdict::Finding;
use engine::analysis::{Harm, Motion, Role};
use engine::{Analysis, Episode, Meeting, Outcome, SpriteType, Watch};
use std::collections::{BTreeMap, BTreeSet};

/// Passes if self-moving sprites, not counting the player's shots, sweep an average of at least [`Gates::sweep`] cells
/// each. In addition, on at least [`Gates::met_levels`] of the levels with such sprites, one of them must enter (or
/// come next to) a cell on the win's route, and come next to the player. If contact with such sprites can kill, they
/// must also cause at least [`Gates::foe_losses`] of careless players' losses. Careless players head for the nearest
/// goal, but press a random key in some ticks.
///
/// The sprites are observed in the shortest known wins and in the careless players' episodes. A sprite counts if it
/// lived for twenty ticks. Such sprites cause a loss if the avatar meets one of them, or one of their products, in the
/// tick of the loss. Games without self-moving sprites pass. Costs the careless players' episodes, and an inspection of
/// all sprites in each tick.
#[derive(Clone, Debug)]
pub(crate) struct ActorsMatter(Gates);

/// The minimum lifetime, in ticks, at which a sprite is measured.
const LIFE: usize = 20;

pub(crate) const QUESTION: &str = "do sprites that move by themselves get in the player's way?";

pub(crate) fn judge(setting: &Setting<'_>) -> ActorsMatter {
    ActorsMatter(setting.criteria.gates.clone())
}

impl GameValidator for ActorsMatter {
    fn validate(&self, case: GameCase<'_>) -> Finding {
        let gates = &self.0;
        let Some(wins) = won_levels(case) else { return without_subject(NO_WIN) };
        let actors = Actors::of(case.analysis);
        let (mut problems, mut notes) = (Vec::new(), Vec::new());
        let (mut sweeps, mut met, mut levels) = (Vec::new(), 0, 0);
        let (mut losses, mut theirs) = (0, 0);
        for won in wins {
            let seen = actors.watch(case, won, won.win);
            let played = case.careless.plays(won, gates);
            let careless: Vec<Watched> = played.iter().map(|play| actors.watch(case, won, play)).collect();
            let lost = played.iter().zip(&careless).filter(|(play, _)| play.outcome == Outcome::Lost);
            for (_, watched) in lost {
                losses += 1;
                theirs += u32::from(watched.last);
            }
            if seen.sweeps.is_empty() && !seen.present {
                continue;
            }
            levels += 1;
            sweeps.extend(seen.sweeps.iter().chain(careless.iter().flat_map(|watched| &watched.sweeps)));
            let near = seen.near || careless.iter().any(|watched| watched.near);
            if seen.crossed && near {
                met += 1;
            } else {
                let text = format!(
                    "level {}: no sprite that moves by itself comes near the player's path",
                    won.number
                );
                notes.push(
                    Evidence::new(text).advise("make the path of such a sprite cross the path to the goal"),
                );
            }
        }
        if levels == 0 {
            let note = "nothing moves by itself in any level";
            return finding(Vec::new(), vec![Evidence::new(note)], None);
        }
        let swept = sweeps.iter().sum::<f64>() / sweeps.len().max(1) as f64;
        let text = format!(
            "sprites that move by themselves sweep {swept:.1} cells on average over {} sprites (at least {} required)",
            sweeps.len(),
            gates.sweep
        );
        let narrow = !sweeps.is_empty() && swept < gates.sweep;
        if narrow { &mut problems } else { &mut notes }.push(Evidence::new(text));
        let text =
            format!("on {met} of {levels} levels, a sprite that moves by itself meets the player's path");
        let away = (met as f64) < gates.met_levels * f64::from(levels);
        if away { &mut problems } else { &mut notes }.push(Evidence::new(text));
        if actors.deadly && case.analysis.aims().avatar_must_live && losses > 0 {
            let share = f64::from(theirs) / f64::from(losses);
            let text = format!(
                "foes cause {theirs} of {losses} losses of careless players (at least {:.0}% required)",
                100.0 * gates.foe_losses
            );
            if share < gates.foe_losses { &mut problems } else { &mut notes }.push(Evidence::new(text));
        }
        finding(problems, notes, (!sweeps.is_empty()).then_some(swept))
    }
}

/// The self-moving types.
struct Actors<'a> {
    analysis: &'a Analysis,
    /// For each type, `true` if it is self-moving.
    moves: Vec<bool>,
    /// For each type, `true` if it is self-moving or created by a self-moving type.
    foes: Vec<bool>,
    /// `true` if contact with at least one self-moving type, or with a type that it creates, is harmful.
    deadly: bool,
}

/// The observations made during an episode.
#[derive(Default)]
struct Watched {
    /// The number of cells that each sprite swept, for sprites that lived long enough.
    sweeps: Vec<f64>,
    /// `true` if any self-moving sprites were present.
    present: bool,
    /// `true` if a self-moving sprite entered or came next to a cell on the avatar's route.
    crossed: bool,
    /// `true` if a self-moving sprite came next to the avatar.
    near: bool,
    /// `true` if the avatar met a self-moving sprite, or a sprite created by one, in the last tick.
    last: bool,
}

impl<'a> Actors<'a> {
    fn of(analysis: &'a Analysis) -> Actors<'a> {
        let game = analysis.game();
        let moves = |stype: SpriteType| {
            let facts = analysis.facts(stype);
            facts.possible
                && !matches!(facts.motion, Motion::Still | Motion::Steered)
                && !matches!(analysis.role(stype), Role::Shot | Role::Avatar)
        };
        let moves: Vec<bool> = game.sprite_types().map(moves).collect();
        let mut foes = moves.clone();
        for stype in game.sprite_types().filter(|stype| moves[stype.index()]) {
            analysis.facts(stype).makes.iter().for_each(|made| foes[made.index()] = true);
        }
        let harms = |stype: &SpriteType| foes[stype.index()] && analysis.harm(*stype) != Harm::None;
        let deadly = game.sprite_types().any(|stype| harms(&stype));
        Actors { analysis, moves, foes, deadly }
    }

    fn watch(&self, case: GameCase<'_>, won: WonLevel<'_>, episode: &Episode) -> Watched {
        let game = case.game;
        let mut state = game.start(won.level, episode.seed);
        let mut watched = Watched::default();
        let mut lives: BTreeMap<u32, (usize, BTreeSet<(i32, i32)>)> = BTreeMap::new();
        let mut route = BTreeSet::new();
        let block = state.block().max(1);
        let cell =
            |(x, y): (i32, i32)| ((x + block / 2).div_euclid(block), (y + block / 2).div_euclid(block));
        let mut meetings = Meetings { actors: self, any: false };
        for tick in 0..=episode.actions.len() {
            let avatar = state.avatar_place().map(cell);
            route.extend(avatar);
            for record in game.records(&state) {
                if !self.moves[usize::from(record.stype)] || record.flags & DISABLED != 0 {
                    continue;
                }
                watched.present = true;
                let at = cell((record.rect.x, record.rect.y));
                let life = lives.entry(record.id).or_default();
                life.0 += 1;
                life.1.insert(at);
                watched.near |= avatar.is_some_and(|avatar| next_to(avatar, at));
            }
            meetings.any = false;
            if let Some(&action) = episode.actions.get(tick) {
                game.step_watched(&mut state, action, &mut meetings);
                watched.last = meetings.any;
            }
        }
        watched.near |= watched.last;
        watched.crossed = lives.values().flat_map(|(_, cells)| cells).any(|&at| {
            [(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)]
                .iter()
                .any(|(dx, dy)| route.contains(&(at.0 + dx, at.1 + dy)))
        });
        let long = lives.values().filter(|(ticks, _)| *ticks >= LIFE);
        watched.sweeps = long.map(|(_, cells)| cells.len() as f64).collect();
        watched
    }
}

/// The flag in the records of sprites that are no longer in play.
const DISABLED: u16 = 1;

fn next_to((x, y): (i32, i32), (u, v): (i32, i32)) -> bool {
    (x - u).abs() + (y - v).abs() <= 1
}

/// A watcher that detects the avatar's contacts with self-moving sprites, and with sprites that they create.
struct Meetings<'a> {
    actors: &'a Actors<'a>,
    any: bool,
}

impl Watch for Meetings<'_> {
    fn interaction(&mut self, _: usize) {}

    fn wants_meetings(&self) -> bool {
        true
    }

    fn meeting(&mut self, meeting: Meeting) {
        let Some(second) = meeting.second else { return };
        let is_avatar = |stype: SpriteType| self.actors.analysis.role(stype) == Role::Avatar;
        let is_foe = |stype: SpriteType| self.actors.foes[stype.index()];
        self.any |= is_avatar(meeting.first) && is_foe(second) || is_avatar(second) && is_foe(meeting.first);
    }
}

#[cfg(test)]
mod tests {
    use crate::Criterion;
    use crate::gates::tests::check;

    const GAME: &str = "BasicGame\n  SpriteSet\n    plum > Immovable\n    wasp > Missile orientation=LEFT cooldown=2\n    avatar > MovingAvatar\n  LevelMapping\n    p > plum\n    s > wasp\n  InteractionSet\n    avatar wall > stepBack\n    wasp wall > reverseDirection\n    wasp wall > stepBack\n    avatar wasp > killSprite\n    plum avatar > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype=plum win=True\n    SpriteCounter stype=avatar win=False\n    Timeout limit=100 win=False\n";

    #[test]
    fn patrols_on_the_way_matter_and_those_in_pockets_do_not() {
        let patrol = "wwwwwwwwwwww\nwA    w    w\nwww w w w ww\nw          w\nwwwwww  s  w\nw          w\nw ww www w w\nwp  w     pw\nwwwwwwwwwwww\n";
        check(Criterion::ActorsMatter, GAME, &[patrol], None);
        let pocket = "wwwwwwwwwwwwwwwwwwwwwwwwwwww\nwA                        pw\nwwwwwwwwwwwwwwwwwwwwwwwwwwww\nw                      wwsww\nwwwwwwwwwwwwwwwwwwwwwwwwwwww\n";
        check(Criterion::ActorsMatter, GAME, &[pocket], Some("sweep 1.0 cells"));
        check(Criterion::ActorsMatter, GAME, &["wwwwww\nwA  pw\nwwwwww\n"], None);
    }
}
