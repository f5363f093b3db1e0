//! The characters for building levels, which represent the empty cell, walls and every sprite type.

use engine::analysis::{EffectSummary, Harm, Lock, Motion, Removal, Role};
use engine::{Analysis, SpriteType};

/// A level character's effect on the initial avatar's movement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Walk {
    /// The avatar can enter the cell.
    Open,
    /// The avatar cannot enter the cell.
    Blocked,
    /// The avatar can enter the cell after shooting the obstacle.
    Breakable,
    /// The avatar pushes the object in the cell.
    Pushed,
    /// The sprite in the cell kills or wounds the avatar.
    Deadly,
    /// The cell is locked. Contains an index into [`Analysis::locks`].
    Locked(usize),
}

/// The characters for building levels.
#[derive(Clone, Debug)]
pub(crate) struct Palette {
    /// The character of the empty cell.
    pub(crate) base: u8,
    /// The types in an empty cell.
    pub(crate) ground: Vec<SpriteType>,
    /// The wall character; `None` if the game has no walls that structure a board.
    pub(crate) wall: Option<u8>,
    /// `true` if sprites could leave the board unless a ring of walls surrounds it.
    pub(crate) ring: bool,
    /// The avatars with their characters. These characters place as few other sprites as possible.
    pub(crate) avatars: Vec<(SpriteType, u8)>,
    /// The best character for each type that does not place an avatar.
    symbols: Vec<Option<u8>>,
    /// For each character, whether and how the avatar can enter its cell.
    walk: Vec<Walk>,
}

impl Palette {
    /// Chooses the characters for a game; `None` if no character places exactly one avatar.
    pub(crate) fn of(analysis: &Analysis) -> Option<Palette> {
        let avatars = avatars(analysis)?;
        let start = avatars[0].0;
        Palette::on(analysis, base(analysis, start, avatars[0].1))
    }

    /// Chooses the characters for a game with a given empty-cell character; `None` if no character places exactly one
    /// avatar.
    pub(crate) fn on(analysis: &Analysis, base: u8) -> Option<Palette> {
        let avatars = avatars(analysis)?;
        let start = avatars[0].0;
        let ground = analysis.game().places(base).to_vec();
        let symbols: Vec<Option<u8>> =
            analysis.game().sprite_types().map(|stype| best(analysis, stype, &ground)).collect();
        let wall_type = wall(analysis, &symbols);
        let wall = wall_type.and_then(|stype| symbols[stype.index()]);
        let walk = (0..128).map(|symbol| walk(analysis, start, &ground, symbol)).collect();
        Some(Palette {
            base,
            ground,
            wall,
            ring: wall.is_some() && leaves_board(analysis),
            avatars,
            symbols,
            walk,
        })
    }

    /// Returns `true` if a character can represent the empty cell. Such a character places nothing that the avatar
    /// collects, and nothing that hurts or blocks the avatar.
    pub(crate) fn is_bearable(analysis: &Analysis, symbol: u8) -> bool {
        let places = analysis.game().places(symbol);
        let plain = |stype: &SpriteType| match analysis.role(*stype) {
            Role::Floor | Role::Refuge | Role::Neutral | Role::Cover => true,
            Role::Ward => !analysis.aims().protect.contains(stype),
            _ => false,
        };
        let goals = |stype: &SpriteType| analysis.aims().remove.contains(stype);
        analysis.avatars().first().is_some_and(|avatar| {
            let free = |stype: &SpriteType| bearable(analysis, avatar.stype, *stype);
            !places.is_empty()
                && !holds_avatar(analysis, symbol)
                && places.iter().all(|stype| free(stype) && plain(stype) && !goals(stype))
        })
    }

    /// Returns the character that places a type with as few other sprites as possible.
    pub(crate) fn symbol(&self, stype: SpriteType) -> Option<u8> {
        self.symbols[stype.index()]
    }

    /// Returns whether and how the avatar can enter a cell with the given character.
    pub(crate) fn walk(&self, symbol: u8) -> Walk {
        self.walk.get(usize::from(symbol)).copied().unwrap_or(Walk::Open)
    }
}

/// Returns the characters that place an avatar with the fewest other sprites. Returns several characters only if they
/// place different avatars.
fn avatars(analysis: &Analysis) -> Option<Vec<(SpriteType, u8)>> {
    let game = analysis.game();
    let is_avatar = |stype: SpriteType| game.class(stype).is_some_and(|class| class.is_avatar());
    let mut found: Vec<(usize, SpriteType, u8)> = Vec::new();
    for avatar in analysis.avatars().iter().filter(|avatar| avatar.starts) {
        for &symbol in &analysis.facts(avatar.stype).symbols {
            let places = game.places(symbol);
            if places.iter().filter(|&&stype| is_avatar(stype)).count() == 1 {
                let others = places.iter().filter(|&&stype| analysis.role(stype) > Role::Avatar);
                let extra = others.filter(|&&stype| analysis.role(stype) != Role::Floor).count();
                found.push((extra, avatar.stype, symbol));
            }
        }
    }
    let least = found.iter().map(|(extra, _, _)| *extra).min()?;
    let mut list: Vec<(SpriteType, u8)> = Vec::new();
    for (_, stype, symbol) in found.into_iter().filter(|(extra, _, _)| *extra == least) {
        if list.iter().all(|(known, _)| *known != stype) {
            list.push((stype, symbol));
        }
    }
    Some(list)
}

/// Returns the character of the empty cell. The first choice is floor that the avatar also stands on, and the second is
/// `.`, if the avatar can walk on it without harm. The third choice is exactly the ground that the avatar stands on,
/// and the last is a space.
fn base(analysis: &Analysis, avatar: SpriteType, avatar_symbol: u8) -> u8 {
    let game = analysis.game();
    let under: Vec<SpriteType> =
        game.places(avatar_symbol).iter().copied().filter(|&stype| stype != avatar).collect();
    let symbols = (b'!'..=b'~').filter(|&symbol| !game.places(symbol).is_empty());
    let symbols: Vec<u8> = symbols.filter(|&symbol| !holds_avatar(analysis, symbol)).collect();
    let inert = |symbol: &&u8| {
        let mut types = game.places(**symbol).iter();
        types.all(|&stype| analysis.role(stype) == Role::Floor && under.contains(&stype))
    };
    let fewest = |symbol: &&u8| (game.places(**symbol).len(), **symbol != b'.', **symbol);
    if let Some(&symbol) = symbols.iter().filter(inert).min_by_key(fewest) {
        return symbol;
    }
    let dot = game.places(b'.');
    let bearable = |stype: &SpriteType| bearable(analysis, avatar, *stype);
    if !under.is_empty() && !dot.is_empty() && dot.iter().all(bearable) {
        return b'.';
    }
    let same = |symbol: &&u8| {
        let mut types = game.places(**symbol).to_vec();
        let mut wanted = under.clone();
        types.sort_unstable();
        wanted.sort_unstable();
        types == wanted && types.iter().all(bearable)
    };
    symbols.iter().find(same).copied().unwrap_or(b' ')
}

/// Returns `true` if a type may occur in every cell.
fn bearable(analysis: &Analysis, avatar: SpriteType, stype: SpriteType) -> bool {
    let touch = analysis.touch(avatar, stype);
    let still = analysis.facts(stype).motion == Motion::Still;
    let harmless = touch.harm <= Harm::Conditional && !touch.blocks && !touch.pushes;
    let role = analysis.role(stype);
    still && harmless && !matches!(role, Role::Exit | Role::Key | Role::Spawner | Role::Soil)
}

pub(crate) fn holds_avatar(analysis: &Analysis, symbol: u8) -> bool {
    let game = analysis.game();
    game.places(symbol).iter().any(|&stype| game.class(stype).is_some_and(|class| class.is_avatar()))
}

/// Returns the character that places a type with the fewest other sprites, not counting the ground.
fn best(analysis: &Analysis, stype: SpriteType, ground: &[SpriteType]) -> Option<u8> {
    let cost = |symbol: u8| {
        let places = analysis.game().places(symbol);
        let mut own = false;
        let strange: usize = places
            .iter()
            .map(|&other| {
                // The type itself counts once.
                if other == stype && !std::mem::replace(&mut own, true) {
                    return 0;
                }
                match analysis.role(other) {
                    _ if ground.contains(&other) => 0,
                    Role::Floor => 1,
                    Role::Refuge | Role::Neutral | Role::Cover => 2,
                    _ => 4,
                }
            })
            .sum();
        let missing = ground.iter().filter(|under| !places.contains(under)).count();
        (strange, missing, symbol)
    };
    let symbols = analysis.facts(stype).symbols.iter().copied();
    symbols.filter(|&symbol| !holds_avatar(analysis, symbol)).min_by_key(|&symbol| cost(symbol))
}

/// Returns the type that structures boards. Among the types that always block the avatar, it is the one that stops the
/// most other types.
fn wall(analysis: &Analysis, symbols: &[Option<u8>]) -> Option<SpriteType> {
    let moves = |stype: &SpriteType| {
        let facts = analysis.facts(*stype);
        let pushed = analysis.role(*stype) == Role::Pushable;
        facts.possible && (facts.motion != Motion::Still || pushed)
    };
    let movers: Vec<SpriteType> = analysis.game().sprite_types().filter(moves).collect();
    let candidates = analysis.game().sprite_types().filter(|&stype| {
        // The registry's `wall` type counts as a wall even if it can be shot away or kills.
        let named = stype == SpriteType(0) && matches!(analysis.role(stype), Role::Breakable | Role::Hazard);
        symbols[stype.index()].is_some() && (analysis.role(stype) == Role::Wall || named)
    });
    let strength = |stype: SpriteType| {
        let held = |mover: &&SpriteType| {
            let ends = analysis.between(**mover, stype).any(|encounter| !encounter.effects.is_empty());
            analysis.blocks(stype, **mover) || ends
        };
        movers.iter().filter(held).count()
    };
    candidates.max_by_key(|&stype| (strength(stype), stype == SpriteType(0), std::cmp::Reverse(stype)))
}

/// Returns `true` if some moving or pushed sprite has no rule for reaching the edge of the screen.
fn leaves_board(analysis: &Analysis) -> bool {
    analysis.game().sprite_types().any(|stype| {
        let facts = analysis.facts(stype);
        let pushed = analysis.role(stype) == Role::Pushable;
        let moves = facts.motion != Motion::Still || pushed;
        facts.possible && moves && !facts.fleeting && analysis.at_edge(stype).next().is_none()
    })
}

/// Returns the effect of entering a cell with the character, ignoring types that occur everywhere.
fn walk(analysis: &Analysis, avatar: SpriteType, ground: &[SpriteType], symbol: u8) -> Walk {
    let mut walk = Walk::Open;
    for &stype in analysis.game().places(symbol) {
        let still = analysis.facts(stype).motion == Motion::Still;
        let idle = analysis.role(stype) == Role::Avatar || ground.contains(&stype);
        if idle || (!still && analysis.role(stype) != Role::Boulder) {
            continue;
        }
        let touch = analysis.touch(avatar, stype);
        let guards = |lock: &Lock| lock.stype == stype && lock.guards;
        let new = if touch.pushes {
            Walk::Pushed
        } else if let Some(at) = analysis.locks().iter().position(guards) {
            Walk::Locked(at)
        } else if touch.harm != Harm::None && still {
            Walk::Deadly
        } else if touch.blocks && shot_away(analysis, stype) {
            Walk::Breakable
        } else if touch.blocks && touch.removal != Removal::Always {
            Walk::Blocked
        } else {
            continue;
        };
        if walk == Walk::Open || new == Walk::Blocked {
            walk = new;
        }
    }
    walk
}

/// Returns `true` if an avatar's shot removes or changes the type.
fn shot_away(analysis: &Analysis, stype: SpriteType) -> bool {
    let shots = analysis.avatars().iter().flat_map(|avatar| &avatar.shots);
    let ends = |shot: &SpriteType| {
        let first = |effect: &EffectSummary| {
            matches!(effect, EffectSummary::Kill(engine::analysis::Side::First) | EffectSummary::Become(_))
        };
        let second =
            |effect: &EffectSummary| matches!(effect, EffectSummary::Kill(engine::analysis::Side::Second));
        analysis.between(stype, *shot).any(|encounter| encounter.does(first))
            || analysis.between(*shot, stype).any(|encounter| encounter.does(second))
    };
    shots.into_iter().any(ends)
}
