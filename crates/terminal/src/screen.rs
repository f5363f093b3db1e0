//! Reads keys from the terminal, displays frames on it, and restores it afterwards.

use super::session::{Command, Session};
use super::view::{MIN_SIZE, View};
use engine::Action;
use ratatui::Terminal;
use ratatui::backend::CrosstermBackend;
use ratatui::crossterm::event::{self, Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use ratatui::crossterm::{cursor, execute, terminal};
use std::io::{IsTerminal, Stderr};
use std::time::{Duration, Instant};

/// The time to wait for a key if the clock is not running.
const IDLE: Duration = Duration::from_millis(500);

/// The reason why playing is impossible.
#[derive(Debug, thiserror::Error)]
pub enum PlayError {
    /// Standard input or standard error is not a terminal.
    #[error(
        "playing requires a terminal for standard input and standard error; `arcade render` draws boards \
         and episodes without a terminal"
    )]
    NoTerminal,
    /// The terminal has fewer columns or rows than a board needs.
    #[error("the terminal has {columns} columns and {rows} rows; make it at least {} by {}", MIN_SIZE.0, MIN_SIZE.1)]
    TooSmall {
        /// The terminal's number of columns.
        columns: u16,
        /// The terminal's number of rows.
        rows: u16,
    },
    /// An I/O error of the terminal.
    #[error("the terminal cannot be used")]
    Io(#[from] std::io::Error),
}

/// Plays until the user quits. Draws on standard error, so that standard output contains only the result.
///
/// # Errors
///
/// Returns an error if no usable terminal is available.
pub fn play(session: &mut Session, view: &View) -> Result<(), PlayError> {
    if !std::io::stdin().is_terminal() || !std::io::stderr().is_terminal() {
        return Err(PlayError::NoTerminal);
    }
    let (columns, rows) = terminal::size()?;
    if columns < MIN_SIZE.0 || rows < MIN_SIZE.1 {
        return Err(PlayError::TooSmall { columns, rows });
    }
    let mut screen = Screen::open()?;
    Ok(screen.run(session, view)?)
}

/// The time since the last tick. Episodes do not depend on it, because they record ticks rather than times.
struct Since(Instant);

impl Since {
    #[expect(clippy::disallowed_methods, reason = "only the pace of play depends on it")]
    fn now() -> Since {
        Since(Instant::now())
    }
}

/// A terminal in raw mode that shows its alternate screen. It is restored when `Screen` is dropped, and
/// before a panic is reported.
struct Screen(Terminal<CrosstermBackend<Stderr>>);

impl Screen {
    fn open() -> std::io::Result<Screen> {
        let told = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            restore();
            told(panic);
        }));
        // From here on, any failure drops the screen, which restores the terminal.
        let screen = Screen(Terminal::new(CrosstermBackend::new(std::io::stderr()))?);
        terminal::enable_raw_mode()?;
        execute!(std::io::stderr(), terminal::EnterAlternateScreen, cursor::Hide)?;
        Ok(screen)
    }

    fn run(&mut self, session: &mut Session, view: &View) -> std::io::Result<()> {
        let mut since = Since::now();
        while !session.over {
            self.0.draw(|frame| view.draw(session, frame))?;
            let left = 1.0 / f64::from(session.pace) - since.0.elapsed().as_secs_f64();
            let wait = if session.runs() { Duration::from_secs_f64(left.max(0.0)) } else { IDLE };
            if event::poll(wait)? {
                if let Event::Key(key) = event::read()?
                    && let Some(command) = command(key)
                {
                    session.handle(command);
                }
            } else if session.runs() {
                since = Since::now();
                session.tick();
            }
        }
        Ok(())
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        // A second restore would move the cursor back above the panic message.
        if !std::thread::panicking() {
            restore();
        }
    }
}

/// Restores the terminal. Ignores errors, because they cannot be reported.
fn restore() {
    let _ = terminal::disable_raw_mode();
    let _ = execute!(std::io::stderr(), terminal::LeaveAlternateScreen, cursor::Show);
}

fn command(key: KeyEvent) -> Option<Command> {
    if key.kind == KeyEventKind::Release {
        return None;
    }
    if key.modifiers.contains(KeyModifiers::CONTROL) {
        return matches!(key.code, KeyCode::Char('c' | 'd')).then_some(Command::Quit);
    }
    let KeyCode::Char(letter) = key.code else {
        return match key.code {
            KeyCode::Up => Some(Command::Act(Action::Up)),
            KeyCode::Left => Some(Command::Act(Action::Left)),
            KeyCode::Down => Some(Command::Act(Action::Down)),
            KeyCode::Right => Some(Command::Act(Action::Right)),
            KeyCode::PageDown => Some(Command::Down),
            KeyCode::PageUp => Some(Command::Up),
            KeyCode::Esc => Some(Command::Quit),
            _ => None,
        };
    };
    Some(match letter.to_ascii_lowercase() {
        'w' => Command::Act(Action::Up),
        'a' => Command::Act(Action::Left),
        's' => Command::Act(Action::Down),
        'd' => Command::Act(Action::Right),
        ' ' => Command::Act(Action::Use),
        '.' => Command::Act(Action::Nil),
        'p' => Command::Pause,
        'n' => Command::Step,
        'r' => Command::Restart,
        'u' => Command::Undo,
        't' => Command::TurnBased,
        '+' | '=' => Command::Faster,
        '-' => Command::Slower,
        'q' => Command::Quit,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_the_documented_ones() {
        let check = |code: KeyCode, modifiers: KeyModifiers, expect: Option<Command>| {
            assert_eq!(command(KeyEvent::new(code, modifiers)), expect, "{code:?}");
        };
        let none = KeyModifiers::NONE;
        check(KeyCode::Left, none, Some(Command::Act(Action::Left)));
        check(KeyCode::Char('D'), KeyModifiers::SHIFT, Some(Command::Act(Action::Right)));
        check(KeyCode::Char('d'), KeyModifiers::CONTROL, Some(Command::Quit));
        check(KeyCode::Char('c'), KeyModifiers::CONTROL, Some(Command::Quit));
        check(KeyCode::Char('c'), none, None);
        check(KeyCode::Char('.'), none, Some(Command::Act(Action::Nil)));
        check(KeyCode::F(1), none, None);
        let released = KeyEvent { kind: KeyEventKind::Release, ..KeyEvent::new(KeyCode::Up, none) };
        assert_eq!(command(released), None);
    }
}
