//! The pushing rules of games that are won only by pushing.

use crate::GenerateError;
use crate::levels::palette::{Palette, Walk};
use engine::analysis::{Condition, Fate, Role, Sink, Steering};
use engine::{Analysis, SpriteType};

/// The maximum number of kinds of pushed objects.
pub(crate) const KINDS: usize = 2;

/// A pushed object's destination.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Destination {
    /// A target on which the object vanishes while the target remains.
    Sink,
    /// A target that vanishes together with the object.
    Hole,
    /// A target from which the object can be pushed off again.
    Place,
    /// An object of the other kind. Both objects vanish.
    Partner,
}

/// The pushing rules.
#[derive(Clone, Debug)]
pub(crate) struct Rules {
    /// The pushed types. There is one kind, or there are two kinds that have their own targets or are pushed onto each
    /// other.
    pub(crate) kinds: Vec<SpriteType>,
    /// The destination of each kind.
    pub(crate) destinations: Vec<Destination>,
    /// The target type for each kind of object; `None` if objects are pushed onto other objects.
    pub(crate) targets: Vec<Option<SpriteType>>,
    /// For each kind, `true` if the avatar can stand on its targets.
    pub(crate) walkable: [bool; KINDS],
    /// `crosses[a][b]` is `true` if an object of kind a can lie on a target of kind b and be pushed further.
    pub(crate) crosses: [[bool; KINDS]; KINDS],
    /// Ground on which the avatar can walk but onto which objects cannot be pushed; `None` if the rules have no such
    /// type.
    pub(crate) sill: Option<SpriteType>,
    /// `merges[a][b]` is `true` if pushing an object of kind a onto an object of kind b removes both.
    pub(crate) merges: [[bool; KINDS]; KINDS],
}

impl Rules {
    /// Returns `true` if objects of one kind are pushed onto objects of the other kind.
    pub(crate) fn in_pairs(&self) -> bool {
        self.destinations.contains(&Destination::Partner)
    }

    /// Derives the pushing rules from a game.
    ///
    /// # Errors
    /// Returns [`GenerateError::Unsuitable`] with the reason if the game is not won by pushing alone, or if its
    /// pushing rules are unsupported.
    pub(crate) fn of(analysis: &Analysis, palette: &Palette) -> Result<Rules, GenerateError> {
        find(analysis, palette).map_err(|why| GenerateError::Unsuitable(why.to_owned()))
    }
}

fn find(analysis: &Analysis, palette: &Palette) -> Result<Rules, &'static str> {
    let avatar = analysis.start_avatar().ok_or("no avatar can be placed")?;
    if avatar.steering != Steering::FourWay || !analysis.moves_by_whole_cells(avatar.stype) {
        return Err("the avatar does not move cell by cell in four directions");
    }
    if !analysis.is_deterministic() || !analysis.is_turn_based() {
        return Err("sprites move by themselves or at random, so puzzles cannot be generated backwards");
    }
    let wall = palette.wall.ok_or("the game has no walls")?;
    let mut wins = analysis.goals().iter().filter(|goal| goal.win);
    let (Some(goal), None) = (wins.next(), wins.next()) else {
        return Err("the game does not have exactly one winning termination");
    };
    let (Condition::AtMost(counted, 0) | Condition::Exactly(counted, 0)) = &goal.condition else {
        return Err("the game is not won by removing sprites");
    };
    let is_placed = |stype: &SpriteType| palette.symbol(*stype).is_some();
    let kinds: Vec<SpriteType> = counted.iter().copied().filter(is_placed).collect();
    let is_pushed = |stype: &SpriteType| {
        let listed = analysis.pushables().iter().any(|pushable| pushable.stype == *stype);
        listed && analysis.touch(avatar.stype, *stype).pushes
    };
    if kinds.is_empty() || !kinds.iter().all(is_pushed) {
        return Err("the sprites that must be removed cannot be pushed");
    }
    if kinds.len() > KINDS {
        return Err("more than two kinds of sprites must be pushed");
    }
    let walls = analysis.game().places(wall);
    if !kinds.iter().all(|&kind| walls.iter().any(|&wall| analysis.blocks(wall, kind))) {
        return Err("walls do not stop pushed sprites");
    }
    let sinks = |kind: SpriteType| {
        let pushable = analysis.pushables().iter().find(|pushable| pushable.stype == kind);
        pushable.map_or(&[][..], |pushable| &pushable.sinks)
    };
    let mut merges = [[false; KINDS]; KINDS];
    for (a, &one) in kinds.iter().enumerate() {
        for (b, &two) in kinds.iter().enumerate() {
            let ends = |sink: &Sink| sink.partner == two && sink.fate == Fate::Goes && sink.fills;
            merges[a][b] = sinks(one).iter().any(ends);
            if !merges[a][b] && !analysis.blocks(two, one) {
                return Err("pushed sprites do not stop each other");
            }
        }
    }
    let sill = find_sill(analysis, palette, avatar.stype, &kinds);
    match kinds[..] {
        [_, _] if merges[0][1] && merges[1][0] && !merges[0][0] && !merges[1][1] => Ok(Rules {
            kinds,
            destinations: vec![Destination::Partner; KINDS],
            targets: vec![None; KINDS],
            walkable: [true; KINDS],
            crosses: [[true; KINDS]; KINDS],
            merges,
            sill,
        }),
        _ if merges.iter().flatten().all(|&merges| !merges) => {
            let (mut destinations, mut targets, mut walkable) = (Vec::new(), Vec::new(), [true; KINDS]);
            for (at, &kind) in kinds.iter().enumerate() {
                let (target, destination, open) = single(analysis, palette, kind, counted, sinks(kind))?;
                destinations.push(destination);
                targets.push(Some(target));
                walkable[at] = open;
            }
            let mut crosses = [[true; KINDS]; KINDS];
            for (a, &kind) in kinds.iter().enumerate() {
                for (b, &target) in targets.iter().enumerate().filter(|&(b, _)| b != a) {
                    let target = target.expect("a kind with targets");
                    if sinks(kind).iter().any(|sink| sink.partner == target) {
                        return Err("one kind of sprites can be pushed onto the targets of the other kind");
                    }
                    crosses[a][b] = !analysis.blocks(target, kind);
                    if crosses[a][b] && !walkable[b] {
                        return Err("pushed sprites can enter cells that the avatar cannot enter");
                    }
                }
            }
            Ok(Rules { kinds, destinations, targets, walkable, crosses, merges, sill })
        }
        _ => Err("sprites are pushed onto each other in an unsupported way"),
    }
}

/// Finds a placed type that stops only pushed objects; `None` if there is no such type.
fn find_sill(
    analysis: &Analysis,
    palette: &Palette,
    avatar: SpriteType,
    kinds: &[SpriteType],
) -> Option<SpriteType> {
    let game = analysis.game();
    game.sprite_types().find(|&stype| {
        let Some(symbol) = palette.symbol(stype) else { return false };
        analysis.role(stype) != Role::Avatar
            && Some(symbol) != palette.wall
            && palette.walk(symbol) == Walk::Open
            && analysis.between(avatar, stype).next().is_none()
            && kinds.iter().all(|&kind| analysis.blocks(stype, kind))
            && !kinds.contains(&stype)
    })
}

/// Returns the rules for one kind of objects that are pushed to targets: the target, the objects' destination, and
/// `true` if the avatar can stand on the target.
fn single(
    analysis: &Analysis,
    palette: &Palette,
    kind: SpriteType,
    counted: &[SpriteType],
    sinks: &[Sink],
) -> Result<(SpriteType, Destination, bool), &'static str> {
    let returns = |to: SpriteType| {
        let pushed = analysis.pushables().iter().any(|pushable| pushable.stype == to);
        pushed && analysis.turns(to).iter().any(|&(back, _)| back == kind)
    };
    let destinations = sinks.iter().filter_map(|sink| {
        let symbol = palette.symbol(sink.partner)?;
        let lies = matches!(analysis.role(sink.partner), Role::Socket | Role::Hazard);
        let destination = match sink.fate {
            Fate::Goes if sink.fills => Destination::Hole,
            Fate::Goes => Destination::Sink,
            Fate::Becomes(to) if !sink.fills && !counted.contains(&to) && returns(to) => Destination::Place,
            _ => return None,
        };
        let fair = lies && !palette.ground.contains(&sink.partner);
        let fair = fair && !analysis.aims().protect.contains(&sink.partner);
        fair.then_some((sink.partner, destination, palette.walk(symbol)))
    });
    let (target, destination, walk) =
        destinations.into_iter().next().ok_or("pushed sprites have no destination")?;
    let walkable = match walk {
        Walk::Open => true,
        Walk::Blocked | Walk::Deadly => false,
        _ => return Err("the destinations are blocked in an unsupported way"),
    };
    Ok((target, destination, walkable))
}
