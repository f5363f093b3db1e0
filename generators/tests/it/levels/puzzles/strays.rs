//! Tests of puzzles among strays, which are deadly sprites that wander at random.

use base::Seed;
use generators::games::PushRules;
use generators::levels::{StrayConfig, StrayLevels};

#[test]
fn boards_without_room_have_no_level() {
    for sides in [(0, 7), (12, 12)] {
        let config = StrayConfig { columns: sides, rows: sides, ..StrayConfig::default() };
        let levels = StrayLevels::new(PushRules::AMONG_STRAYS[0], config);
        assert_eq!(levels.level(Seed::from_text("small")), None, "{sides:?}");
    }
}
