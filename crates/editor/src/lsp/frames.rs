//! The protocol's frames. A frame consists of a header that states a length, followed by that number of
//! bytes.

use std::io::{self, BufRead, Read, Write};

/// The maximum size of a message in bytes. Larger messages are skipped entirely.
const MAX_MESSAGE: u64 = 1 << 25;
/// The maximum length of a header line, in bytes.
const MAX_LINE: u64 = 1 << 12;

/// A frame in the input.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Frame {
    /// The bytes of a message.
    Message(Vec<u8>),
    /// A message or header that was rejected, with the reason. Reading continues after the rejected part.
    Unread(String),
    /// The end of the input.
    End,
}

/// Reads the next frame. Memory is allocated as the bytes arrive, not according to the length stated in the header.
pub(super) fn read(input: &mut impl BufRead) -> io::Result<Frame> {
    let mut length = None;
    let mut is_empty = true;
    loop {
        let mut line = Vec::new();
        input.by_ref().take(MAX_LINE).read_until(b'\n', &mut line)?;
        if line.is_empty() {
            return Ok(if is_empty {
                Frame::End
            } else {
                Frame::Unread("the input ends within a header".to_owned())
            });
        }
        let text = line.trim_ascii();
        if text.is_empty() {
            if is_empty {
                // Ignore empty lines between messages.
                continue;
            }
            break;
        }
        is_empty = false;
        let text = String::from_utf8_lossy(text);
        if let Some((name, value)) = text.split_once(':')
            && name.trim().eq_ignore_ascii_case("content-length")
        {
            length = value.trim().parse::<u64>().ok();
        }
    }
    let Some(length) = length else {
        return Ok(Frame::Unread("the header has no numeric Content-Length".to_owned()));
    };
    if length > MAX_MESSAGE {
        io::copy(&mut input.by_ref().take(length), &mut io::sink())?;
        return Ok(Frame::Unread(format!("the message has {length} bytes; the limit is {MAX_MESSAGE}")));
    }
    let mut message = Vec::new();
    input.by_ref().take(length).read_to_end(&mut message)?;
    if (message.len() as u64) < length {
        return Ok(Frame::Unread("the input ends within a message".to_owned()));
    }
    Ok(Frame::Message(message))
}

/// Writes a message as a frame.
pub(super) fn write(output: &mut impl Write, message: &serde_json::Value) -> io::Result<()> {
    let text = message.to_string();
    write!(output, "Content-Length: {}\r\n\r\n{text}", text.len())?;
    output.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frames(mut input: &[u8]) -> Vec<Frame> {
        let mut frames = Vec::new();
        loop {
            let frame = read(&mut input).unwrap();
            if frame == Frame::End {
                return frames;
            }
            frames.push(frame);
        }
    }

    #[test]
    fn frames_are_read_one_after_the_other() {
        let input = b"Content-Length: 2\r\n\r\n{}content-length:3\nX: y\n\n[1]";
        assert_eq!(frames(input), [Frame::Message(b"{}".to_vec()), Frame::Message(b"[1]".to_vec())]);
    }

    #[test]
    fn broken_headers_cost_one_frame() {
        let input = b"Content-Length: x\r\n\r\nContent-Length: 2\r\n\r\n{}";
        let found = frames(input);
        assert!(matches!(&found[..], [Frame::Unread(_), Frame::Message(_)]), "{found:?}");
        for input in [
            &b"Content-Length: 99999999999999\r\n\r\n{}"[..],
            b"Content-Length: 9\r\n\r\n{}",
            b"Cont",
            b"\xff\n",
        ] {
            assert!(matches!(frames(input)[..], [Frame::Unread(_)]), "{input:?}");
        }
        let long = vec![b'a'; 1 << 14];
        assert!(matches!(frames(&long)[..], [Frame::Unread(_)]));
    }
}
