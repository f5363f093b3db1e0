//! Opens the page in a browser.

use std::io::Write;
use std::process::{Command, Stdio};
use tempfile::NamedTempFile;

/// Tries to open an address in the user's browser. A missing browser is not an error.
///
/// Program arguments are visible to all users of a machine, and the address contains the token. Therefore,
/// the browser opens a file that redirects to the address and that only the current user can read. The file
/// is removed when the returned value is dropped.
pub(super) fn open(url: &str) -> Option<NamedTempFile> {
    let mut file = tempfile::Builder::new().prefix("arcade-studio-").suffix(".html").tempfile().ok()?;
    let page = format!(
        "<!doctype html>\n<meta charset=\"utf-8\">\n<meta http-equiv=\"refresh\" content=\"0; url={url}\">\n<title>Infinite Arcade \
         Studio</title>\n<p><a href=\"{url}\">Open the studio</a></p>\n"
    );
    file.write_all(page.as_bytes()).and_then(|()| file.flush()).ok()?;
    let program = if cfg!(target_os = "macos") { "open" } else { "xdg-open" };
    let mut command = if cfg!(windows) { Command::new("explorer") } else { Command::new(program) };
    command.arg(file.path()).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let mut child = command.spawn().ok()?;
    // The child may run as long as the browser, and nothing else waits for it.
    std::thread::spawn(move || child.wait());
    Some(file)
}
