//! The `open-ground` gate: checks that levels offer space to move around, rather than tunnels in solid rock.

use super::{Gates, measured, without_subject};
use crate::allowance::Setting;
use crate::evidence::Evidence;
use crate::validator::{GameCase, GameValidator};
use crate::verdict::Finding;
use engine::analysis::Role;
use engine::{Analysis, Level};

/// Passes if the fraction of ground cells that are narrow averages at most [`Gates::narrow`] over the levels.
///
/// A ground cell is a cell without a wall ([`Role::Wall`]). A wall is stationary, always blocks and cannot be removed.
/// A ground cell is narrow if no 2×2 square of ground cells contains it, as in corridors, doorways and alcoves. No
/// episodes are played. Cost: O(cells) per level.
#[derive(Clone, Debug)]
pub struct OpenGround(pub Gates);

impl OpenGround {
    /// Returns the fraction of a level's ground cells that are narrow, or `None` if the level has no ground cells.
    pub fn narrow(analysis: &Analysis, level: &Level) -> Option<f64> {
        let game = analysis.game();
        let is_wall = |cell: &u8| game.places(*cell).iter().any(|&stype| analysis.role(stype) == Role::Wall);
        let walls: Vec<bool> = level.cells().iter().map(is_wall).collect();
        let (columns, rows) = (level.columns(), level.rows());
        let mut wide = vec![false; walls.len()];
        for row in 1..rows {
            for column in 1..columns {
                let corner = row * columns + column;
                let square = [corner, corner - 1, corner - columns, corner - columns - 1];
                if square.iter().all(|&cell| !walls[cell]) {
                    square.iter().for_each(|&cell| wide[cell] = true);
                }
            }
        }
        let ground = walls.iter().filter(|&&wall| !wall).count();
        let narrow = walls.iter().zip(&wide).filter(|&(&wall, &wide)| !wall && !wide).count();
        (ground > 0).then(|| narrow as f64 / ground as f64)
    }
}

pub(crate) const QUESTION: &str = "is there room to move?";

pub(crate) fn judge(setting: &Setting<'_>) -> OpenGround {
    OpenGround(setting.criteria.gates.clone())
}

impl GameValidator for OpenGround {
    fn validate(&self, case: GameCase<'_>) -> Finding {
        let levels = case.recording.iter().map(|recorded| recorded.level);
        let shares: Vec<f64> = levels.filter_map(|level| OpenGround::narrow(case.analysis, level)).collect();
        if shares.is_empty() {
            return without_subject("skipped: no level has ground");
        }
        let (mean, most) = (shares.iter().sum::<f64>() / shares.len() as f64, self.0.narrow);
        let each: Vec<String> = shares.iter().map(|share| format!("{:.0}", 100.0 * share)).collect();
        let text = format!(
            "{:.0}% of the ground is narrow on average ({}; at most {:.0}% allowed)",
            100.0 * mean,
            each.join(", "),
            100.0 * most
        );
        let seen =
            Evidence::new(text).advise("widen corridors and alcoves: leave islands of walls in open ground");
        measured(mean <= most, seen, mean)
    }
}

#[cfg(test)]
mod tests {
    use crate::Criterion;
    use crate::gates::tests::check;

    const GAME: &str = "BasicGame\n  SpriteSet\n    plum > Immovable\n    gate > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    p > plum\n    g > gate\n  InteractionSet\n    avatar wall > stepBack\n    gate avatar > killSprite\n    plum avatar > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype=plum win=True\n    Timeout limit=200 win=False\n";

    #[test]
    fn tunnels_fail_and_halls_pass() {
        let tunnel = "wwwwwwwww\nwA www pw\nwww   www\nwwwwwwwww\n";
        check(Criterion::OpenGround, GAME, &[tunnel], Some("100% of the ground is narrow"));
        let hall = "wwwwwwwww\nwA     pw\nw   w   w\nw       w\nwwwwwwwww\n";
        check(Criterion::OpenGround, GAME, &[hall], None);
        // Removable obstacles count as ground.
        let gates = "wwwwwwwww\nwAg g gpw\nwgg g  gw\nwwwwwwwww\n";
        check(Criterion::OpenGround, GAME, &[gates], None);
        // A narrow level is allowed if the other levels are wide.
        check(Criterion::OpenGround, GAME, &[tunnel, gates, gates, hall], None);
    }
}
