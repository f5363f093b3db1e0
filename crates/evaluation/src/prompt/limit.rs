//! Describes a game's rules under a step limit, including a sentence that states the limit and the
//! consequence of reaching it.

use engine::describe::Guide;

/// Returns the guide to a game whose episodes stop after `limit` ticks. Replaces all sentences about later
/// ticks with a single sentence about the limit.
pub(crate) fn limited(mut guide: Guide, limit: u64) -> Guide {
    let sentences = guide.winning.len() + guide.losing.len();
    let is_in_time = |line: &String| last_tick(line).is_none_or(|tick| tick <= limit);
    guide.order.retain(is_in_time);
    guide.winning.retain(is_in_time);
    guide.losing.retain(is_in_time);
    if guide.winning.len() + guide.losing.len() < sentences {
        guide
            .losing
            .push(format!("Play stops at tick {limit}: if you have not won by then, you do not win."));
    }
    guide
}

/// Returns the tick at which the game ends according to a sentence, if the sentence states one.
fn last_tick(line: &str) -> Option<u64> {
    let after = ["when tick ", "until tick "].iter().find_map(|words| line.split_once(words))?.1;
    let digits = after.split(|character: char| !character.is_ascii_digit()).next()?;
    digits.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::Game;

    /// Checks the sentences about winning and losing under a limit, for a game that is lost at tick 81 and
    /// won at tick 91.
    #[track_caller]
    fn check(limit: u64, expect: &[&str]) {
        let game = "BasicGame\n  SpriteSet\n    tick > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    t > tick\n  \
                    InteractionSet\n    tick avatar > killSprite\n  TerminationSet\n    SpriteCounter stype=tick win=True\n    \
                    Timeout limit=90 win=True\n    Timeout limit=80 win=False\n";
        let guide = limited(Guide::of(&Game::from_source(game).unwrap()), limit);
        assert_eq!([guide.winning, guide.losing].concat(), expect, "{limit}");
    }

    #[test]
    fn there_is_one_limit() {
        let (won, lost) = ("You win when no tick is left.", "You lose when tick 81 is reached.");
        check(1000, &[won, "You win if you last until tick 91.", lost]);
        check(91, &[won, "You win if you last until tick 91.", lost]);
        let stops =
            |tick: u64| format!("Play stops at tick {tick}: if you have not won by then, you do not win.");
        check(90, &[won, lost, &stops(90)]);
        check(60, &[won, &stops(60)]);
    }
}
