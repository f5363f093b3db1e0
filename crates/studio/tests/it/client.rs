//! A running studio, and a client that can misbehave.

use infinite_arcade_studio::{
    GameEntry, Kind, NamedText, Place, Server, Stop, Studio, WitnessEntry, Workspace,
};
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::thread::JoinHandle;
use std::time::Duration;

/// A game with a key and a door.
pub(crate) const GAME: &str = "BasicGame\n  SpriteSet\n    floor > Immovable hidden=True\n    key > Resource limit=1\n    door > Door\n    avatar > MovingAvatar\n  LevelMapping\n    . > floor\n    k > key floor\n    d > door floor\n    A > avatar floor\n  InteractionSet\n    avatar wall > stepBack\n    key avatar > collectResource\n    door avatar > killIfOtherHasMore resource=key limit=1\n    avatar door > stepBack\n  TerminationSet\n    SpriteCounter stype=door win=True\n    Timeout limit=100 win=False\n";
pub(crate) const LEVEL: &str = "wwwwwww\nwA.k.dw\nwwwwwww\n";
/// A level in which the key is behind a wall.
pub(crate) const WALLED: &str = "wwwwwww\nwA.wkdw\nwwwwwww\n";

/// A studio that runs until it is dropped.
pub(crate) struct Running {
    port: u16,
    pub(crate) token: String,
    stop: Option<Stop>,
    thread: Option<JoinHandle<()>>,
}

/// A response: the status, the head and the body.
#[derive(Debug)]
pub(crate) struct Answer {
    pub(crate) status: u16,
    pub(crate) head: String,
    pub(crate) body: Vec<u8>,
}

impl Answer {
    pub(crate) fn json(&self) -> Value {
        serde_json::from_slice(&self.body)
            .unwrap_or_else(|error| panic!("{error}: {}", String::from_utf8_lossy(&self.body)))
    }

    pub(crate) fn header(&self, name: &str) -> Option<&str> {
        self.head.lines().find_map(|line| {
            let (key, value) = line.split_once(':')?;
            key.eq_ignore_ascii_case(name).then_some(value.trim())
        })
    }
}

pub(crate) fn text(name: &str, text: &str) -> NamedText {
    NamedText { name: name.to_owned(), text: text.to_owned() }
}

pub(crate) fn entry(id: &str, place: Place) -> GameEntry {
    let witnesses: Vec<WitnessEntry> = Vec::new();
    GameEntry {
        id: id.to_owned(),
        title: id.to_owned(),
        place,
        card: None,
        summary: String::new(),
        witnesses,
    }
}

/// Returns a game that exists only in memory.
pub(crate) fn in_memory(id: &str, source: &str, levels: &[&str]) -> GameEntry {
    let levels = levels.iter().enumerate().map(|(number, level)| text(&format!("lvl{number}.txt"), level));
    entry(id, Place::Texts { source: text("game.vgdl", source), levels: levels.collect() })
}

/// Writes a game to a folder, and returns its entry.
pub(crate) fn in_folder(id: &str, folder: &Path) -> GameEntry {
    std::fs::write(folder.join("game.vgdl"), GAME).expect("written");
    std::fs::write(folder.join("lvl0.txt"), LEVEL).expect("written");
    entry(id, Place::Folder { folder: folder.to_owned(), source: "game.vgdl".to_owned(), writable: true })
}

pub(crate) fn studio(copies: &Path, games: Vec<GameEntry>) -> Studio {
    let workspace = Workspace::new(Kind::Games, "tests", copies.to_owned(), games);
    Studio::new(workspace, "0", |name| (name == "known").then(|| "# Known".to_owned()))
}

pub(crate) fn run(studio: Studio) -> Running {
    let server = Server::bind(studio, 0).expect("a port is free");
    let (port, token) = (server.port(), server.token().to_owned());
    let (stop, run) = server.stoppable();
    let thread = std::thread::spawn(move || run().expect("it answers"));
    Running { port, token, stop: Some(stop), thread: Some(thread) }
}

/// Runs a studio with one game, which exists only in memory.
pub(crate) fn usual() -> Running {
    run(studio(Path::new("."), vec![in_memory("one", GAME, &[LEVEL, WALLED])]))
}

impl Drop for Running {
    fn drop(&mut self) {
        drop(self.stop.take());
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

impl Running {
    pub(crate) fn host(&self) -> String {
        format!("127.0.0.1:{}", self.port)
    }

    /// Returns the headers that the page itself would send.
    pub(crate) fn own(&self) -> Vec<(String, String)> {
        vec![("Host".to_owned(), self.host()), ("X-Arcade-Token".to_owned(), self.token.clone())]
    }

    fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(self.host()).expect("it listens");
        stream.set_read_timeout(Some(Duration::from_secs(120))).expect("set");
        stream
    }

    /// Sends a request with the given headers, and reads the whole response.
    pub(crate) fn send(&self, method: &str, path: &str, headers: &[(String, String)], body: &[u8]) -> Answer {
        let mut stream = self.connect();
        let mut request = format!("{method} {path} HTTP/1.1\r\nConnection: close\r\n");
        for (key, value) in headers {
            request += &format!("{key}: {value}\r\n");
        }
        request += &format!("Content-Length: {}\r\n\r\n", body.len());
        stream.write_all(request.as_bytes()).expect("sent");
        // A server that rejects a request may close the connection before it has read all of it.
        let _ = stream.write_all(body);
        read(stream)
    }

    pub(crate) fn get(&self, path: &str) -> Answer {
        self.send("GET", path, &self.own(), b"")
    }

    pub(crate) fn post(&self, path: &str, body: &Value) -> Answer {
        self.send("POST", path, &self.own(), body.to_string().as_bytes())
    }

    pub(crate) fn put(&self, path: &str, body: &Value) -> Answer {
        self.send("PUT", path, &self.own(), body.to_string().as_bytes())
    }

    pub(crate) fn delete(&self, path: &str, body: &Value) -> Answer {
        self.send("DELETE", path, &self.own(), body.to_string().as_bytes())
    }

    /// Sends a request and returns the response, which must be a success.
    pub(crate) fn ask(&self, path: &str, body: &Value) -> Value {
        let answer = self.post(path, body);
        assert_eq!(answer.status, 200, "{path}: {}", String::from_utf8_lossy(&answer.body));
        answer.json()
    }

    /// Sends a request whose response has several lines. The response must end normally, or with an error
    /// line.
    pub(crate) fn lines(&self, path: &str, body: &Value) -> Vec<Value> {
        let answer = self.post(path, body);
        assert_eq!(answer.status, 200, "{path}: {}", String::from_utf8_lossy(&answer.body));
        assert_eq!(answer.header("content-type"), Some("application/x-ndjson"));
        let lines = answer.body.split(|&byte| byte == b'\n').filter(|line| !line.is_empty());
        let lines: Vec<Value> = lines.map(|line| serde_json::from_slice(line).expect("JSON")).collect();
        let last = lines.last().expect("a last line")["stage"].clone();
        assert!(last == json!("done") || last == json!("error"), "{last}");
        lines
    }
    /// Sends a request whose response has several lines, reads up to the first line with one of the given
    /// stages, and leaves.
    pub(crate) fn lines_until(&self, path: &str, body: &Value, stages: &[&str]) -> Vec<Value> {
        let mut stream = self.connect();
        let body = body.to_string();
        let (host, token, length) = (self.host(), &self.token, body.len());
        let head = format!(
            "POST {path} HTTP/1.1\r\nHost: {host}\r\nX-Arcade-Token: {token}\r\nContent-Length: {length}\r\n\r\n"
        );
        stream.write_all(format!("{head}{body}").as_bytes()).expect("sent");
        let mut lines = Vec::new();
        for line in BufReader::new(stream).lines() {
            let line = line.expect("a line");
            // The head and the chunk sizes are not JSON objects.
            let Ok(line @ Value::Object(_)) = serde_json::from_str(&line) else { continue };
            let is_last = line["stage"].as_str().is_some_and(|stage| stages.contains(&stage));
            lines.push(line);
            if is_last {
                break;
            }
        }
        lines
    }
}

fn read(stream: TcpStream) -> Answer {
    let mut reader = BufReader::new(stream);
    let mut head = String::new();
    loop {
        let mut line = String::new();
        let read = reader.read_line(&mut line).expect("an answer");
        if read == 0 || line == "\r\n" {
            break;
        }
        head += &line;
    }
    let status = head.split(' ').nth(1).and_then(|status| status.parse().ok()).expect("a status");
    let mut body = Vec::new();
    let is_chunked = head.to_ascii_lowercase().contains("transfer-encoding: chunked");
    if is_chunked {
        loop {
            let mut size = String::new();
            reader.read_line(&mut size).expect("a chunk");
            let size = usize::from_str_radix(size.trim(), 16).expect("a size");
            let mut chunk = vec![0; size + 2];
            reader.read_exact(&mut chunk).expect("a chunk");
            if size == 0 {
                break;
            }
            body.extend_from_slice(&chunk[..size]);
        }
    } else {
        reader.read_to_end(&mut body).expect("a body");
    }
    Answer { status, head, body }
}
