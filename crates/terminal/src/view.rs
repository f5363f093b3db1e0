//! A session's screen: the board, with the resources, the legend and the rules beside it, and the keys below
//! it.

use super::board::{self, Cell, GROUND, Signs};
use super::session::{Player, Session};
use engine::describe::Guide;
use engine::{Analysis, Outcome, SpriteType};
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Paragraph, Wrap};
use render::{Glyph, Looks, Symbols};

/// The minimum terminal size for playing a game, in columns and rows.
pub(crate) const MIN_SIZE: (u16, u16) = (36, 10);
/// The minimum and maximum number of columns in the panel beside the board.
const PANEL: (u16, u16) = (32, 64);

/// The parts of the screen that stay the same during a session.
pub struct View {
    looks: Looks,
    signs: Signs,
    title: String,
    /// The rules in plain English, one per line.
    rules: Vec<String>,
}

impl View {
    /// Creates the view of a game with the given title. If `ascii` is `true`, it uses only ASCII symbols.
    #[must_use]
    pub fn new(analysis: &Analysis, title: String, ascii: bool) -> View {
        let looks = Looks::of(analysis);
        let signs = Signs::of(&looks, &Symbols::of(analysis, &looks), ascii);
        let rules = Guide::from_analysis(analysis).to_string().lines().map(str::to_owned).collect();
        View { looks, signs, title, rules }
    }

    pub(crate) fn draw(&self, session: &Session, frame: &mut Frame<'_>) {
        let area = frame.area();
        if area.width < MIN_SIZE.0 || area.height < MIN_SIZE.1 {
            let text =
                format!("The terminal is too small: it must be at least {} by {}.", MIN_SIZE.0, MIN_SIZE.1);
            frame.render_widget(Paragraph::new(text).wrap(Wrap { trim: true }), area);
            return;
        }
        let (columns, rows) = size(session);
        let [main, keys] = Layout::vertical([Constraint::Min(1), Constraint::Length(2)]).areas(area);
        let wide = columns.saturating_mul(2).saturating_add(2);
        let beside = main.width.saturating_sub(wide);
        if beside >= PANEL.0 {
            let width = beside.min(PANEL.1);
            let [left, right] =
                Layout::horizontal([Constraint::Length(wide), Constraint::Length(width)]).areas(main);
            let tall = Rect { height: main.height.min(rows.saturating_add(2)), ..left };
            self.board(session, frame, tall);
            self.panel(session, frame, right);
        } else {
            // If there is no room beside the board, as much of the status as fits is shown above it.
            let status = self.status(session);
            let lines = (status.len() as u16).min(main.height / 3);
            let [top, rest] = Layout::vertical([Constraint::Length(lines), Constraint::Min(1)]).areas(main);
            frame.render_widget(Paragraph::new(status), top);
            let area =
                Rect { width: rest.width.min(wide), height: rest.height.min(rows.saturating_add(2)), ..rest };
            self.board(session, frame, area);
            let legend = Rect { y: rest.y + area.height, height: rest.height - area.height, ..rest };
            frame.render_widget(Paragraph::new(self.legend()), legend);
        }
        let help = Style::new().add_modifier(Modifier::DIM);
        frame.render_widget(Paragraph::new(keys_of(session)).style(help).wrap(Wrap { trim: true }), keys);
    }

    /// Draws the part of the board around the player that fits the area.
    fn board(&self, session: &Session, frame: &mut Frame<'_>, area: Rect) {
        let block = Block::bordered().title(format!(" {} ", self.title));
        let inner = block.inner(area);
        frame.render_widget(block, area);
        let state = session.state();
        let (columns, rows) = size(session);
        let cells = board::cells(&self.looks, &self.signs, state);
        let game = self.looks.game();
        let own = game.records(state).into_iter().find(|record| Some(record.id) == state.avatar_id());
        let (x, y) = own.map_or((0.0, 0.0), |record| record.rect.centre());
        let block = f64::from(state.block().max(1));
        let start = |centre: f64, seen: u16, all: u16| {
            let at = (centre / block).clamp(0.0, f64::from(all)) as u16;
            at.saturating_sub(seen / 2).min(all.saturating_sub(seen))
        };
        let left = start(x, inner.width / 2, columns);
        let top = start(y, inner.height, rows);
        let line = |row: &[Cell<'_>]| {
            let seen = row.iter().skip(usize::from(left)).take(usize::from(inner.width / 2));
            Line::from(seen.map(|cell| Span::styled(cell.text.to_owned(), cell.style)).collect::<Vec<_>>())
        };
        let lines = cells.chunks(usize::from(columns.max(1))).skip(usize::from(top));
        frame.render_widget(Paragraph::new(lines.map(line).collect::<Vec<_>>()), inner);
    }

    /// Draws the status, the legend and the rules, one below the other.
    fn panel(&self, session: &Session, frame: &mut Frame<'_>, area: Rect) {
        let (status, legend) = (self.status(session), self.legend());
        let heights = [
            Constraint::Length(status.len() as u16 + 1),
            Constraint::Length((legend.len() as u16 + 1).min(area.height / 2)),
            Constraint::Min(0),
        ];
        let indented = Rect { x: area.x + 1, width: area.width.saturating_sub(1), ..area };
        let [top, middle, bottom] = Layout::vertical(heights).areas(indented);
        frame.render_widget(Paragraph::new(status), top);
        frame.render_widget(Paragraph::new(legend), middle);
        let rules: Vec<Line<'_>> = self.rules.iter().map(|line| rule(line)).collect();
        let rules = Paragraph::new(rules).wrap(Wrap { trim: false });
        frame.render_widget(rules.scroll((session.scroll, 0)), bottom);
    }

    fn status(&self, session: &Session) -> Vec<Line<'static>> {
        let (state, episode) = (session.state(), session.episode());
        let bold = Style::new().add_modifier(Modifier::BOLD);
        let mut lines =
            vec![Line::styled(format!("tick {}   score {}", episode.actions.len(), state.score()), bold)];
        if self.looks.has_holdings() {
            let held = render::holdings(&self.looks, state);
            lines.push(Line::from(format!("holds: {}", if held.is_empty() { "nothing" } else { &held })));
        }
        let last = episode.actions.last().map_or("none".to_owned(), ToString::to_string);
        lines.push(Line::from(format!("last action: {last}")));
        lines.push(Line::from(manner(session)));
        let ending = |text: String, colour| Line::styled(text, bold.fg(Color::Black).bg(colour));
        match state.outcome() {
            Outcome::Ongoing => {}
            Outcome::Won => lines.push(ending(" WON ".into(), Color::Green)),
            Outcome::Lost => lines.push(ending(" LOST ".into(), Color::Red)),
            Outcome::Ended => lines.push(ending(" ENDED without a winner ".into(), Color::Yellow)),
            Outcome::Stopped(limit) => lines.push(ending(format!(" STOPPED: {limit} "), Color::Yellow)),
        }
        lines
    }

    fn legend(&self) -> Vec<Line<'static>> {
        let mut shown: Vec<(Glyph, SpriteType)> = self
            .looks
            .shown()
            .map(|stype| (self.looks.look(stype).glyph, stype))
            .filter(|(glyph, _)| *glyph != Glyph::Floor)
            .collect();
        shown.sort_unstable();
        let line = |(_, stype): (Glyph, SpriteType)| {
            let cell = self.signs.drawn(&self.looks, stype, GROUND);
            let name = self.looks.game().name(stype).to_owned();
            let dim = Style::new().add_modifier(Modifier::DIM);
            Line::from(vec![
                Span::styled(cell.text.to_owned(), cell.style),
                Span::raw(format!(" {name} ")),
                Span::styled(format!(" {}", self.looks.meaning(stype)), dim),
            ])
        };
        shown.into_iter().map(line).collect()
    }
}

/// Returns the board's number of columns and rows.
fn size(session: &Session) -> (u16, u16) {
    let side = |length: i32| u16::try_from(length).unwrap_or(0);
    let (columns, rows) = session.state().size();
    (side(columns), side(rows))
}

/// Styles a line of the rules. Headings are bold.
fn rule(line: &str) -> Line<'_> {
    let heading = !line.starts_with(' ') && line.ends_with(':');
    let style = if heading { Style::new().add_modifier(Modifier::BOLD) } else { Style::new() };
    Line::styled(line, style)
}

/// Returns a description of the player, and of the trigger for the next tick.
fn manner(session: &Session) -> String {
    let ticks = session.episode().actions.len();
    let who = match &session.player {
        Player::Person => String::new(),
        Player::Planner { name, budget, .. } => format!("{name} plays, {} calls per tick; ", budget.0),
        Player::Recording(actions) => {
            format!("recording, {ticks} of {}; ", base::count(actions.len(), "tick"))
        }
    };
    let when = if session.is_at_end() {
        "over".to_owned()
    } else if session.turn_based {
        "waits for you".to_owned()
    } else if session.paused {
        "paused".to_owned()
    } else {
        format!("{} ticks per second", session.pace)
    };
    format!("{who}{when}")
}

fn keys_of(session: &Session) -> &'static str {
    match &session.player {
        Player::Person if session.turn_based => {
            "arrows or WASD move, space use, . wait, u undo, r restart, t real time, PgUp/PgDn scroll rules, q quit"
        }
        Player::Person => {
            "arrows or WASD move, space use, p pause, n step, u step back, r restart, +/- speed, t turn by turn, PgUp/PgDn scroll rules, q quit"
        }
        _ => "p pause, n step, u step back, r restart, +/- speed, PgUp/PgDn scroll rules, q quit",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::Command;
    use base::Seed;
    use engine::{Action, Game};
    use ratatui::Terminal;
    use ratatui::backend::TestBackend;

    const GAME: &str = "
BasicGame
    SpriteSet
        stone > Immovable
        hatch > Door
        crumb > Resource limit=3
        mouse > MovingAvatar
    LevelMapping
        s > stone
        h > hatch
        c > crumb
        m > mouse
    InteractionSet
        mouse stone > stepBack
        crumb mouse > collectResource scoreChange=1
        hatch mouse > killSprite
    TerminationSet
        SpriteCounter stype=hatch win=True
";

    fn subject(ascii: bool) -> (Session, View) {
        let game = Game::from_source(GAME).unwrap();
        let level = game.level("sssssss\nsm c hs\nsssssss\n").unwrap();
        let analysis = Analysis::of(&game);
        let mut view = View::new(&analysis, "pantry lvl0".to_owned(), ascii);
        view.rules = vec!["How you win:".to_owned(), "  Leave.".to_owned()];
        (Session::begin((game, level), Seed::from_text("view"), Player::Person, true, 8), view)
    }

    /// Draws the view on a terminal of the given size, and returns the text.
    fn drawn((session, view): &(Session, View), (width, height): (u16, u16)) -> String {
        let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
        terminal.draw(|frame| view.draw(session, frame)).unwrap();
        let buffer = terminal.backend().buffer();
        let row =
            |y| (0..width).map(|x| buffer[(x, y)].symbol()).collect::<String>().trim_end().to_owned() + "\n";
        (0..height).map(row).collect()
    }

    #[test]
    fn panels_stand_beside_the_board() {
        let mut subject = subject(false);
        subject.0.handle(Command::Act(Action::Right));
        subject.0.handle(Command::Act(Action::Right));
        let expect = "\
┌ pantry lvl0 ─┐ tick 2   score 1
│██████████████│ holds: crumb 1
│██    @   ★ ██│ last action: right
│██████████████│ waits for you
└──────────────┘
                 @  mouse  you
                 ★  hatch  the way to win
                 ○  crumb  a resource to hold
                 ██ stone  blocks the way for good

                 How you win:
                   Leave.

arrows or WASD move, space use, . wait, u undo, r restart, t
real time, PgUp/PgDn scroll rules, q quit
";
        assert_eq!(drawn(&subject, (64, 15)), expect);
        subject.0.handle(Command::Act(Action::Right));
        subject.0.handle(Command::Act(Action::Right));
        let text = drawn(&subject, (64, 15));
        assert!(text.contains("over") && text.contains(" WON"), "{text}");
    }

    #[test]
    fn a_narrow_terminal_has_the_status_above_and_ascii_suffices() {
        let subject = subject(true);
        let expect = "\
tick 0   score 0
holds: nothing
last action: none
┌ pantry lvl0 ─┐
│##############│
│##@   $   X ##│
│##############│
└──────────────┘
@  mouse  you
X  hatch  the way to win
arrows or WASD move, space use, .
wait, u undo, r restart, t real
";
        assert_eq!(drawn(&subject, (36, 12)), expect);
        assert!(drawn(&subject, (35, 12)).contains("too small"));
    }
}
