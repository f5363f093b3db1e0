//! Tests of the language server as an editor runs it. A client that counts in UTF-16 runs whole sessions with
//! the binary.

use crate::arcade::{arcade, run, text};
use base::{Sampler, Seed};
use serde_json::{Value, json};
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, ExitStatus, Stdio};

const GAME: &str = include_str!("../../../../corpora/hailglass/game.vgdl");

/// A client with its server.
struct Client {
    process: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    requests: i64,
    /// The notifications that the test has not looked at yet.
    told: Vec<Value>,
}

impl Client {
    /// Starts a server in a folder without sending any message.
    fn start(folder: &Path) -> Client {
        let mut process =
            arcade(folder).args(["lsp"]).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
        let input = process.stdin.take().unwrap();
        let output = BufReader::new(process.stdout.take().unwrap());
        Client { process, input, output, requests: 0, told: Vec::new() }
    }

    /// Starts a session in which the client offers `encodings` for counting positions.
    fn begin(folder: &Path, encodings: &[&str]) -> Client {
        let mut client = Client::start(folder);
        let capabilities = json!({
            "general": { "positionEncodings": encodings },
            "textDocument": { "rename": { "prepareSupport": true } },
        });
        let answer = client
            .ask("initialize", &json!({ "processId": null, "rootUri": null, "capabilities": capabilities }));
        assert_eq!(answer["serverInfo"]["name"], "arcade lsp");
        let expect = if encodings.contains(&"utf-8") { "utf-8" } else { "utf-16" };
        assert_eq!(answer["capabilities"]["positionEncoding"], expect);
        client.tell("initialized", &json!({}));
        client
    }

    fn send(&mut self, message: &[u8]) {
        write!(self.input, "Content-Length: {}\r\n\r\n", message.len()).unwrap();
        self.input.write_all(message).unwrap();
        self.input.flush().unwrap();
    }

    fn tell(&mut self, method: &str, params: &Value) {
        self.send(json!({ "jsonrpc": "2.0", "method": method, "params": params }).to_string().as_bytes());
    }

    fn receive(&mut self) -> Value {
        let mut length = 0;
        loop {
            let mut line = String::new();
            assert!(self.output.read_line(&mut line).unwrap() > 0, "the server has left");
            match line.trim_end().split_once(": ") {
                Some(("Content-Length", value)) => length = value.parse().unwrap(),
                Some(_) => {}
                None => break,
            }
        }
        let mut body = vec![0; length];
        self.output.read_exact(&mut body).unwrap();
        serde_json::from_slice(&body).unwrap()
    }

    /// Returns the response to a request: a result or an error.
    fn answer(&mut self, method: &str, params: &Value) -> Value {
        self.requests += 1;
        let id = self.requests;
        let request = json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params });
        self.send(request.to_string().as_bytes());
        loop {
            let message = self.receive();
            if message["id"] == id {
                return message;
            }
            self.told.push(message);
        }
    }

    #[track_caller]
    fn ask(&mut self, method: &str, params: &Value) -> Value {
        let answer = self.answer(method, params);
        assert!(answer.get("error").is_none(), "{method}: {answer}");
        answer["result"].clone()
    }

    #[track_caller]
    fn refused(&mut self, method: &str, params: &Value) -> (i64, String) {
        let error = self.answer(method, params)["error"].clone();
        (error["code"].as_i64().unwrap(), error["message"].as_str().unwrap().to_owned())
    }

    /// Returns the diagnostics for a version of a document.
    fn diagnostics(&mut self, uri: &str, version: i64) -> Vec<Value> {
        loop {
            let own = |message: &Value| {
                message["method"] == "textDocument/publishDiagnostics"
                    && message["params"]["uri"] == uri
                    && message["params"]["version"] == version
            };
            if let Some(at) = self.told.iter().position(own) {
                return self.told.remove(at)["params"]["diagnostics"].as_array().unwrap().clone();
            }
            let message = self.receive();
            self.told.push(message);
        }
    }

    fn open(&mut self, uri: &str, text: &str) {
        let item = json!({ "uri": uri, "languageId": "vgdl", "version": 1, "text": text });
        self.tell("textDocument/didOpen", &json!({ "textDocument": item }));
    }

    fn change(&mut self, uri: &str, version: i64, changes: &Value) {
        let document = json!({ "uri": uri, "version": version });
        self.tell("textDocument/didChange", &json!({ "textDocument": document, "contentChanges": changes }));
    }

    fn leave(mut self) -> ExitStatus {
        assert_eq!(self.ask("shutdown", &Value::Null), Value::Null);
        self.tell("exit", &Value::Null);
        self.process.wait().unwrap()
    }
}

/// Returns the position of a byte, counted in UTF-16 code units.
fn position(text: &str, at: usize) -> Value {
    let line = text[..at].matches('\n').count();
    let start = text[..at].rfind('\n').map_or(0, |newline| newline + 1);
    json!({ "line": line, "character": text[start..at].encode_utf16().count() })
}

/// Returns the byte offset of a position counted in UTF-16 code units.
fn byte(text: &str, position: &Value) -> usize {
    let line = position["line"].as_u64().unwrap() as usize;
    let start: usize = text.split_inclusive('\n').take(line).map(str::len).sum();
    let units = position["character"].as_u64().unwrap() as usize;
    let mut left = units;
    for (at, c) in text[start..].char_indices() {
        if left == 0 {
            return start + at;
        }
        left -= c.len_utf16();
    }
    text.len()
}

/// Returns the text after edits in the protocol's format. Like an editor, applies the edits from last to
/// first.
fn edited(text: &str, edits: &Value) -> String {
    let mut places: Vec<(usize, usize, &str)> = edits
        .as_array()
        .unwrap()
        .iter()
        .map(|edit| {
            let range = &edit["range"];
            (byte(text, &range["start"]), byte(text, &range["end"]), edit["newText"].as_str().unwrap())
        })
        .collect();
    places.sort_unstable();
    let mut text = text.to_owned();
    for (start, end, new) in places.into_iter().rev() {
        text.replace_range(start..end, new);
    }
    text
}

fn at(uri: &str, text: &str, place: &str) -> Value {
    json!({ "textDocument": { "uri": uri }, "position": position(text, text.find(place).unwrap()) })
}

#[test]
fn a_session_from_a_fault_to_the_exit() {
    let home = tempfile::tempdir().unwrap();
    let uri = "file:///games/hailglass/game.vgdl";
    let faulty = GAME.replacen("stepBack", "stepBakc", 1);
    assert_ne!(faulty, GAME);
    let mut client = Client::begin(home.path(), &["utf-16"]);
    client.open(uri, &faulty);
    let diagnostics = client.diagnostics(uri, 1);
    assert_eq!(diagnostics.len(), 1, "{diagnostics:?}");
    assert_eq!((&diagnostics[0]["code"], &diagnostics[0]["severity"]), (&json!("unknown-effect"), &json!(1)));
    assert!(diagnostics[0].get("codeDescription").is_none());
    assert!(diagnostics[0]["message"].as_str().unwrap().contains("did you mean `stepBack`?"));

    let asked = json!({ "textDocument": { "uri": uri }, "range": diagnostics[0]["range"], "context": { "diagnostics": diagnostics } });
    let actions = client.ask("textDocument/codeAction", &asked);
    assert_eq!(actions.as_array().unwrap().len(), 1);
    assert_eq!((&actions[0]["title"], &actions[0]["kind"]), (&json!("Write `stepBack`"), &json!("quickfix")));
    assert_eq!(actions[0]["diagnostics"], json!(diagnostics));
    let edits = &actions[0]["edit"]["changes"][uri];
    assert_eq!(edited(&faulty, edits), GAME);
    let changes: Vec<Value> = edits
        .as_array()
        .unwrap()
        .iter()
        .map(|edit| json!({ "range": edit["range"], "text": edit["newText"] }))
        .collect();
    client.change(uri, 2, &json!(changes));
    assert_eq!(client.diagnostics(uri, 2), Vec::<Value>::new());

    let hover = client.ask("textDocument/hover", &at(uri, GAME, "stepBack"));
    assert_eq!(hover["contents"]["kind"], "markdown");
    assert!(hover["contents"]["value"].as_str().unwrap().starts_with("**stepBack**"));
    let completion = client.ask("textDocument/completion", &at(uri, GAME, "stepBack"));
    let items = completion["items"].as_array().unwrap();
    assert!(
        items.iter().any(|item| item["label"] == "killSprite" && item["textEdit"]["newText"] == "killSprite")
    );

    let name = GAME.lines().skip_while(|line| line.trim() != "SpriteSet").nth(1).unwrap().trim();
    let name = name.split(' ').next().unwrap();
    let place = at(uri, GAME, &format!("{name} >"));
    let definition = client.ask("textDocument/definition", &place);
    assert_eq!(definition["range"]["start"], place["position"]);
    let prepared = client.ask("textDocument/prepareRename", &place);
    assert_eq!(prepared["placeholder"], name);
    let mut query = place.clone();
    query["context"] = json!({ "includeDeclaration": true });
    let references = client.ask("textDocument/references", &query);
    let mut query = place;
    query["newName"] = json!("quagga");
    let renamed = client.ask("textDocument/rename", &query);
    let edits = &renamed["changes"][uri];
    assert_eq!(edits.as_array().unwrap().len(), references.as_array().unwrap().len());
    let text_renamed = edited(GAME, edits);
    assert!(engine::Game::from_source(&text_renamed).is_ok(), "{text_renamed}");
    query["newName"] = json!("killSprite");
    let (code, message) = client.refused("textDocument/rename", &query);
    assert!(code == -32803 && message.contains("word of VGDL"), "{message}");

    let symbols = client.ask("textDocument/documentSymbol", &json!({ "textDocument": { "uri": uri } }));
    let names: Vec<&str> =
        symbols.as_array().unwrap().iter().map(|symbol| symbol["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["SpriteSet", "LevelMapping", "InteractionSet", "TerminationSet"]);

    let loose = GAME.replace("    ", "  ");
    client.change(uri, 3, &json!([{ "text": loose }]));
    let options =
        json!({ "textDocument": { "uri": uri }, "options": { "tabSize": 4, "insertSpaces": true } });
    let edits = client.ask("textDocument/formatting", &options);
    fs::write(home.path().join("loose.vgdl"), &loose).unwrap();
    assert_eq!(edited(&loose, &edits), text(&run(home.path(), &["fmt", "loose.vgdl"], 0).stdout));
    client.change(uri, 4, &json!([{ "text": "BasicGame\n SpriteSet\n  a Immovable\n" }]));
    let (code, message) = client.refused("textDocument/formatting", &options);
    assert!(code == -32803 && message.contains("fix"), "{message}");

    client.tell("textDocument/didClose", &json!({ "textDocument": { "uri": uri } }));
    let (code, _) = client.refused("textDocument/hover", &at(uri, GAME, "stepBack"));
    assert_eq!(code, -32602);
    assert_eq!(client.leave().code(), Some(0));
}

#[test]
fn levels_follow_their_game() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().join("a game");
    fs::create_dir(&folder).unwrap();
    let game = "BasicGame\n    SpriteSet\n        nut > Immovable\n        hero > MovingAvatar\n    LevelMapping\n        n > nut\n        h > hero\n    InteractionSet\n        nut hero > killSprite\n    TerminationSet\n        SpriteCounter stype=nut win=True\n        Timeout limit=99\n";
    fs::write(folder.join("game.vgdl"), game).unwrap();
    fs::write(folder.join("lvl1.txt"), "hn n\n").unwrap();
    let root = format!("file://{}/a%20game", home.path().display());
    let (level, source) = (format!("{root}/lvl0.txt"), format!("{root}/game.vgdl"));
    let mut client = Client::begin(home.path(), &["utf-16"]);
    // The game is only on disk.
    client.open(&level, "h m\n");
    let found = client.diagnostics(&level, 1);
    assert_eq!(found[0]["code"], "undefined-character");
    let hover = client.ask("textDocument/hover", &at(&level, "h m\n", "h"));
    assert!(hover["contents"]["value"].as_str().unwrap().contains("`hero`: MovingAvatar"), "{hover}");
    // The game is open, and has a different character.
    let open = game.replace("n > nut", "m > nut");
    client.open(&source, &open);
    assert_eq!(client.diagnostics(&level, 1), Vec::<Value>::new());
    let definition = client.ask("textDocument/definition", &at(&level, "h m\n", "m"));
    assert_eq!(definition["uri"], source.as_str());
    // A character is renamed in the game, in the open level and in the level on disk.
    client.change(&source, 2, &json!([{ "text": game }]));
    client.change(&level, 2, &json!([{ "text": "h n\n" }]));
    let mut query = at(&source, game, "n > nut");
    query["newName"] = json!("k");
    let changes = client.ask("textDocument/rename", &query)["changes"].clone();
    assert_eq!(edited("h n\n", &changes[level.as_str()]), "h k\n");
    assert_eq!(edited("hn n\n", &changes[format!("{root}/lvl1.txt")]), "hk k\n");
    assert_eq!(edited(game, &changes[source.as_str()]), game.replace("n > nut", "k > nut"));
    assert_eq!(client.leave().code(), Some(0));
}

#[test]
fn positions_are_counted_as_agreed() {
    let home = tempfile::tempdir().unwrap();
    let game = "BasicGame\n  SpriteSet\n    a > Immovable img=é😀 speed=x\n";
    for (encodings, column) in [(&["utf-16"][..], 32), (&["utf-8", "utf-16"], 35), (&[], 32)] {
        let mut client = Client::begin(home.path(), encodings);
        client.open("untitled:x", game);
        let found = client.diagnostics("untitled:x", 1);
        let wrong = found.iter().find(|problem| problem["code"] == "wrong-type").unwrap();
        assert_eq!(wrong["range"]["start"], json!({ "line": 2, "character": column }), "{encodings:?}");
        assert_eq!(client.leave().code(), Some(0));
    }
}

/// Applies 200 random range changes. Afterwards, the server's answers about the document must equal its
/// answers about a new document with the client's text.
#[test]
fn changes_by_ranges_equal_whole_texts() {
    let home = tempfile::tempdir().unwrap();
    let mut client = Client::begin(home.path(), &[]);
    let mut sampler: Sampler = Seed::from_text("language server").sampler();
    let uri = "file:///a/game.vgdl";
    let mut own = GAME.to_owned();
    client.open(uri, &own);
    let pieces = ["x", "\n", " ", "    fox > Missile\r\n", "😀é", "=", "", "#", "SpriteSet", "\n\n"];
    for version in 2..202 {
        let boundary = |sampler: &mut Sampler, text: &str| {
            let places: Vec<usize> = text.char_indices().map(|(at, _)| at).chain([text.len()]).collect();
            *sampler.choose(&places)
        };
        let start = boundary(&mut sampler, &own);
        let rest = boundary(&mut sampler, &own[start..]);
        let end = start + own[start..start + rest.min(40)].char_indices().last().map_or(0, |(at, _)| at);
        let piece = *sampler.choose(&pieces);
        // A client never splits `\r
        // `, and neither may the ranges of this test.
        if own[..start].ends_with('\r') || own[..end].ends_with('\r') {
            client.change(uri, version, &json!([]));
        } else {
            let range = json!({ "start": position(&own, start), "end": position(&own, end) });
            client.change(uri, version, &json!([{ "range": range, "text": piece }]));
            own.replace_range(start..end, piece);
        }
        if version % 20 != 1 {
            continue;
        }
        let other = format!("file:///b{version}/game.vgdl");
        client.open(&other, &own);
        assert_eq!(client.diagnostics(uri, version), client.diagnostics(&other, 1), "{own}");
        for method in ["textDocument/documentSymbol", "textDocument/formatting"] {
            let mut answers = [uri, &other]
                .map(|uri| client.answer(method, &json!({ "textDocument": { "uri": uri }, "options": {} })));
            answers.iter_mut().for_each(|answer| answer["id"] = Value::Null);
            assert_eq!(answers[0], answers[1], "{own}");
        }
    }
    assert_ne!(own, GAME);
    assert_eq!(client.leave().code(), Some(0));
}

#[test]
fn hostile_messages_are_answered() {
    let home = tempfile::tempdir().unwrap();
    let mut client = Client::start(home.path());
    let codes = |client: &mut Client| client.receive()["error"]["code"].as_i64();
    for (message, code) in [
        (&b"{\"jsonrpc\":\"2.0\",\"method\":"[..], -32700),
        (b"", -32700),
        (b"\xff\xfe", -32700),
        (b"[1,2]", -32600),
        (b"{\"id\":1}", -32600),
        (b"{\"id\":1,\"method\":\"textDocument/hover\"}", -32002),
    ] {
        client.send(message);
        assert_eq!(codes(&mut client), Some(code), "{}", String::from_utf8_lossy(message));
    }
    client.input.write_all(b"Content-Length: many\r\n\r\nContent-Type: x\n\n").unwrap();
    assert_eq!([codes(&mut client), codes(&mut client)], [Some(-32700); 2]);
    client.ask("initialize", &json!({ "capabilities": 5 }));
    assert_eq!(client.refused("nonsense/😀", &json!({})).0, -32601);
    for params in [json!(null), json!([1]), json!({ "textDocument": 3, "position": {} })] {
        for method in ["hover", "completion", "rename", "codeAction", "formatting", "documentSymbol"] {
            assert_eq!(
                client.refused(&format!("textDocument/{method}"), &params).0,
                -32602,
                "{method} {params}"
            );
        }
        for method in ["didOpen", "didChange", "didClose", "didSave"] {
            client.tell(&format!("textDocument/{method}"), &params);
        }
    }
    let uri = "file:///game.vgdl";
    client.open(uri, "BasicGame\n");
    for position in [json!({ "line": u64::MAX, "character": u64::MAX }), json!({ "line": 0, "character": 4 })]
    {
        client.ask("textDocument/hover", &json!({ "textDocument": { "uri": uri }, "position": position }));
        client
            .ask("textDocument/completion", &json!({ "textDocument": { "uri": uri }, "position": position }));
    }
    let negative = json!({ "textDocument": { "uri": uri }, "position": { "line": -1, "character": 0.5 } });
    assert_eq!(client.refused("textDocument/hover", &negative).0, -32602);
    assert_eq!(client.leave().code(), Some(0));
}

#[test]
fn huge_documents_are_told_as_such() {
    let home = tempfile::tempdir().unwrap();
    let mut client = Client::begin(home.path(), &[]);
    let uri = "file:///game.vgdl";
    for line in ["        a > Immovable color=RED\n", "x", "\n"] {
        client.open(uri, &line.repeat(10_000_000 / line.len()));
        let found = client.diagnostics(uri, 1);
        assert_eq!((found.len(), &found[0]["code"]), (1, &json!("too-large")), "{found:?}");
        let place = json!({ "textDocument": { "uri": uri }, "position": { "line": 0, "character": 0 } });
        client.ask("textDocument/hover", &place);
        client.ask("textDocument/completion", &place);
    }
    assert_eq!(client.leave().code(), Some(0));
}

#[test]
fn a_client_that_leaves_without_a_word_is_status_1() {
    let home = tempfile::tempdir().unwrap();
    let mut client = Client::begin(home.path(), &[]);
    client.tell("exit", &Value::Null);
    assert_eq!(client.process.wait().unwrap().code(), Some(1));
    let Client { mut process, input, .. } = Client::begin(home.path(), &[]);
    drop(input);
    assert_eq!(process.wait().unwrap().code(), Some(1));
    // This client no longer reads. A process that another test is starting may briefly hold the closed end,
    // so the first answer may still find a reader.
    let Client { mut process, mut input, output, .. } = Client::begin(home.path(), &[]);
    drop(output);
    while process.try_wait().unwrap().is_none() {
        let _ = input.write_all(b"Content-Length: 1\r\n\r\n{");
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    assert_eq!(process.wait().unwrap().code(), Some(1));
}
