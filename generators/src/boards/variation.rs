//! Boards as search candidates.

use super::brief::BoardBrief;
use super::draft::Draft;
use super::edits::Edit;
use super::furnish::compose;
use super::kit::Kit;
use crate::{GenerateError, Variation};
use base::{Sampler, Seed};
use engine::{Action, Analysis, Level, Outcome};

/// The number of compositions to try per board.
const COMPOSITIONS: u64 = 40;
/// The maximum number of edits to try when a board is edited.
const DRAWS: usize = 40;
/// The maximum number of mutations to try until one yields a board on which the player survives the first ticks.
const MUTATIONS: usize = 6;
/// The number of ticks that a player who does nothing should survive.
const GRACE: usize = 10;
/// The maximum number of fragments after an edit, unless the board had more before; see [`Draft::fragments`].
const FRAGMENTS: usize = 2;
/// The maximum area of the largest empty rectangle after an edit, as a fraction of the area within the border. If the
/// rectangle was larger before the edit, it must not grow.
const EMPTY: f64 = 0.25;

/// Boards for any game, as search candidates. The boards are composed from plans and from the kinds of position that
/// suit each type ([`Idiom`](super::Idiom)), and changed by edits.
///
/// All boards have one avatar, connected ground that is mostly wide, and the numbers of sprites that the request
/// specifies. Nothing harmful is next to the avatar, which survives a few ticks of doing nothing. The boards are not
/// tested for winnability. Cost: about a millisecond per board, and tens of microseconds per edit.
#[derive(Clone, Debug)]
pub struct BoardVariation<'a> {
    kit: Kit<'a>,
}

impl<'a> BoardVariation<'a> {
    /// Creates a variation for a game and a request.
    ///
    /// # Errors
    /// Returns an error if no level character in the game places exactly one avatar.
    pub fn new(analysis: &'a Analysis, brief: &BoardBrief) -> Result<BoardVariation<'a>, GenerateError> {
        let kit = Kit::of(analysis, brief);
        let kit = kit
            .ok_or_else(|| GenerateError::Unsuitable("no character places exactly one avatar".to_owned()))?;
        Ok(BoardVariation { kit })
    }

    /// Returns variants of a board that each lack one small part. A search uses them to find the parts that do not
    /// matter.
    pub fn tidied(&self, level: &Level) -> Vec<Level> {
        Draft::of(&self.kit, level).tidied().iter().filter_map(Draft::level).collect()
    }

    /// Returns the area of a board's largest empty rectangle, as a fraction of the area within the border. The
    /// fraction is large for a bare hall.
    pub fn emptiness(&self, level: &Level) -> f64 {
        Draft::of(&self.kit, level).emptiness()
    }

    /// Returns `true` if a player who does nothing survives the first ticks with one fixed random seed.
    fn is_safe(&self, level: &Level) -> bool {
        let game = self.kit.analysis.game();
        let mut state = game.start(level, Seed::from_text("first ticks"));
        (0..GRACE).all(|_| !matches!(game.step(&mut state, Action::Nil), Outcome::Lost | Outcome::Stopped(_)))
    }

    /// Returns a sound board after one to three edits. If no edit leads to a sound board, returns the board unchanged.
    fn edited<'k>(&'k self, draft: Draft<'k>, sampler: &mut Sampler) -> Draft<'k> {
        let mut edits = 1 + sampler.weighted(&[5, 3, 2]).unwrap_or(0);
        let mut draft = draft;
        let fragments = draft.fragments().max(FRAGMENTS);
        let empty = draft.emptiness().max(EMPTY);
        for _ in 0..DRAWS {
            let mut next = draft.clone();
            let edit = Edit::draw(sampler);
            let is_made = next.edit(edit, sampler).is_some();
            if is_made && next.cells != draft.cells && next.is_composed(fragments, empty) && next.is_sound() {
                draft = next;
                edits -= 1;
            }
            if edits == 0 {
                break;
            }
        }
        draft
    }
}

impl Variation for BoardVariation<'_> {
    type Candidate = Level;

    fn create(&self, seed: Seed) -> Option<Level> {
        let analysis = self.kit.analysis;
        (0..COMPOSITIONS).find_map(|at| {
            let level = compose(&self.kit, seed.child("composition", at))?.level()?;
            let start = analysis.game().start(&level, seed);
            let begins = analysis.goal_met(&start).is_none() && analysis.reach(&level).can_win();
            (begins && self.is_safe(&level)).then_some(level)
        })
    }

    fn mutate(&self, parent: &Level, sampler: &mut Sampler) -> Level {
        let made = (0..MUTATIONS).find_map(|_| {
            let level = self.edited(Draft::of(&self.kit, parent), sampler).level()?;
            self.is_safe(&level).then_some(level)
        });
        made.unwrap_or_else(|| parent.clone())
    }

    /// Returns the first board with its right part replaced by that of the second, if both have the same size and the
    /// result is sound. Otherwise, returns an edited version of the first board.
    fn cross(&self, one: &Level, two: &Level, sampler: &mut Sampler) -> Level {
        let (mut child, other) = (Draft::of(&self.kit, one), Draft::of(&self.kit, two));
        let cut = sampler.between(3, child.grid.columns.max(7) - 4);
        if child.grid == other.grid {
            for cell in (0..child.grid.len()).filter(|&cell| child.grid.x(cell) >= cut) {
                child.cells[cell] = other.cells[cell];
            }
        }
        let is_whole = child.grid == other.grid && child.is_sound();
        let level = if is_whole { child.level() } else { None };
        level.unwrap_or_else(|| self.mutate(one, sampler))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::boards::Idiom;
    use engine::Game;

    const GAME: &str = "BasicGame obs=wall\n  SpriteSet\n    wall > Immovable\n    gulf > Immovable\n    ice > Immovable\n    gate > Immovable\n    key > Resource limit=2\n    plum > Immovable\n    crate > Passive\n    hole > Immovable\n    wolf > PathChaser stype=avatar cooldown=2\n    bat > Missile orientation=RIGHT\n    avatar > MovingAvatar\n  LevelMapping\n    g > gulf\n    i > ice\n    G > gate\n    k > key\n    p > plum\n    c > crate\n    h > hole\n    W > wolf\n    b > bat\n  InteractionSet\n    avatar wall gulf > stepBack\n    ice avatar > transformTo stype=gulf\n    gate avatar > killIfOtherHasMore resource=key limit=1\n    avatar gate > stepBack\n    key avatar > collectResource\n    plum avatar > killSprite scoreChange=1\n    crate avatar > bounceForward\n    crate wall gate > undoAll\n    hole crate > killBoth\n    avatar hole > stepBack\n    bat wall > reverseDirection\n    wolf wall gate > stepBack\n    avatar wolf bat > killSprite\n  TerminationSet\n    SpriteCounter stype=avatar win=False\n    SpriteCounter stype=plum win=True\n    Timeout limit=300 win=False\n";

    #[test]
    fn idioms_follow_from_the_rules() {
        let game = Game::from_source(GAME).unwrap();
        let analysis = Analysis::of(&game);
        let idiom = |name: &str| Idiom::of(&analysis, game.sprite_type(name).unwrap());
        let expected = [
            ("gulf", Idiom::Obstacle),
            ("ice", Idiom::Road),
            ("gate", Idiom::Barrier),
            ("key", Idiom::Thing),
            ("plum", Idiom::Thing),
            ("crate", Idiom::Heavy),
            ("hole", Idiom::Crossing),
            ("wolf", Idiom::Hunter),
            ("bat", Idiom::Patrol),
        ];
        for (name, wanted) in expected {
            assert_eq!(idiom(name), Some(wanted), "{name}");
        }
        assert_eq!(idiom("avatar"), None);
    }

    #[test]
    fn boards_and_their_edits_keep_the_brief() {
        let game = Game::from_source(GAME).unwrap();
        let analysis = Analysis::of(&game);
        let [plum, bat] = ["plum", "bat"].map(|name| game.sprite_type(name).unwrap());
        let brief =
            BoardBrief { counts: vec![(plum, (3, 4))], without: vec![bat], ..BoardBrief::of_demand(1) };
        let variation = BoardVariation::new(&analysis, &brief).unwrap();
        let count =
            |level: &Level, symbol: u8| level.cells().iter().filter(|&&other| other == symbol).count();
        let check = |level: &Level| {
            assert_eq!(count(level, b'A'), 1, "{level}");
            assert_eq!(count(level, b'b'), 0, "{level}");
            assert!((3..=4).contains(&count(level, b'p')), "{level}");
        };
        let mut sampler = Seed::from_text("edits").sampler();
        let mut made = 0;
        for at in 0..20 {
            let Some(mut level) = variation.create(Seed::from_text("boards").child("board", at)) else {
                continue;
            };
            made += 1;
            check(&level);
            assert_eq!(variation.create(Seed::from_text("boards").child("board", at)).unwrap(), level);
            let first = level.clone();
            for _ in 0..10 {
                level = variation.mutate(&level, &mut sampler);
                check(&level);
            }
            assert_ne!(first, level, "edits change boards");
        }
        assert!(made >= 15, "{made} of 20 boards were made");
    }
}
