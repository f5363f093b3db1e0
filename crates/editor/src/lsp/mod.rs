//! A language server for games (`*.vgdl`, `game.txt`) and levels (`lvlN.txt` beside a game), over any pair of streams.
//!
//! The server responds to every malformed message with an error and keeps running.

mod answers;
mod documents;
mod frames;
mod server;
mod uri;

use frames::Frame;
use server::Server;
use std::io::{self, BufRead, Write};
use std::sync::mpsc::{TryRecvError, sync_channel};
use std::thread;

/// The number of messages to read ahead. If several changes arrive in succession, only the last one is checked.
const AHEAD: usize = 8;

/// Serves one client until the client leaves. Returns `true` if the client requested a shutdown first.
///
/// # Errors
///
/// Returns an error if a stream fails, but not if the client has closed it.
pub fn serve(input: impl BufRead + Send + 'static, output: impl Write) -> io::Result<bool> {
    let mut server = Server::default();
    match converse(&mut server, input, output) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(error),
        _ => Ok(server.is_shut_down()),
    }
}

fn converse(
    server: &mut Server,
    mut input: impl BufRead + Send + 'static,
    mut output: impl Write,
) -> io::Result<()> {
    let (sender, messages) = sync_channel(AHEAD);
    // The thread ends with the input or with the process.
    thread::spawn(move || {
        loop {
            let frame = frames::read(&mut input);
            let ends = !matches!(frame, Ok(Frame::Message(_) | Frame::Unread(_)));
            if sender.send(frame).is_err() || ends {
                return;
            }
        }
    });
    loop {
        let frame = match messages.try_recv() {
            Ok(frame) => frame,
            Err(TryRecvError::Empty) => {
                for message in server.published() {
                    frames::write(&mut output, &message)?;
                }
                match messages.recv() {
                    Ok(frame) => frame,
                    Err(_) => return Ok(()),
                }
            }
            Err(TryRecvError::Disconnected) => return Ok(()),
        };
        let answers = match frame? {
            Frame::Message(bytes) => server.receive(&bytes),
            Frame::Unread(reason) => vec![server::unreadable(&reason)],
            Frame::End => return Ok(()),
        };
        for answer in answers {
            frames::write(&mut output, &answer)?;
        }
        if server.is_left() {
            return Ok(());
        }
    }
}
