//! Tests of served players. They play the same moves over the network as when called directly, and report
//! errors in the format of the real APIs.

use crate::sweeping;
use base::Seed;
use engine::{Action, Game, Observation, Outcome, State};
use evaluation::answer::Reading;
use evaluation::client::{ChatMessage, ChatRequest, Decoding, Model, ModelOptions, Role, connect};
use evaluation::prompt::{Attempt, Mode, Past, PromptSettings, Prompter, Rules};
use evaluation::serve::{PromptPlayer, Running, Server};
use evaluation::{Before, Commitment, Subject, SubjectFacts, Turn};
use loopback::Bounds;
use serde_json::{Value, json};
use std::io::{ErrorKind, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::time::Duration;

/// The maximum number of decisions per episode.
const LIMIT: u64 = 200;

/// Reads a corpus game with only its first level.
fn corpus_game(folder: &Path) -> Subject {
    let text = |file: &str| std::fs::read_to_string(folder.join(file)).unwrap();
    let name = folder.file_name().unwrap().to_str().unwrap();
    subject(name, &text("game.vgdl"), &text("lvl0.txt"))
}

fn subject(name: &str, source: &str, level: &str) -> Subject {
    Subject::read(name, source, &[(0, level.to_owned(), None)], SubjectFacts::default()).unwrap()
}

fn corpus() -> Vec<Subject> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpora");
    let entries = std::fs::read_dir(root).unwrap().map(|entry| entry.unwrap().path());
    let mut folders: Vec<_> = entries.filter(|path| path.join("game.vgdl").exists()).collect();
    folders.sort();
    folders.iter().map(|folder| corpus_game(folder)).collect()
}

fn offered(game: &Game, state: &State) -> Vec<Action> {
    [Action::Nil].iter().chain(game.actions(state)).copied().collect()
}

/// Plays a level with the given answers to its prompts. Returns the actions and the outcome.
fn episode(
    subject: &Subject,
    settings: &PromptSettings,
    answer: impl Fn(&[ChatMessage]) -> String,
) -> (Vec<Action>, Outcome) {
    beginning(LIMIT, subject, settings, answer)
}

/// Plays the first decisions of a level, up to `limit`.
fn beginning(
    limit: u64,
    subject: &Subject,
    settings: &PromptSettings,
    answer: impl Fn(&[ChatMessage]) -> String,
) -> (Vec<Action>, Outcome) {
    let prompter = Prompter::new(subject, settings.clone()).unwrap();
    let game = &subject.game;
    let mut state = game.start(&subject.levels[0].level, Seed::from_text("served").child(&subject.id, 0));
    let (mut actions, mut past): (Vec<Action>, Vec<Past>) = (Vec::new(), Vec::new());
    let mut before: Option<(Observation, Action, f64)> = None;
    while !state.is_over() && (actions.len() as u64) < limit {
        let (observation, score) = (game.observe(&state), state.score());
        let turn = Turn {
            subject,
            level: 0,
            number: actions.len() as u64,
            limit,
            commit: Commitment::ONE,
            played: &[],
            observation: &observation,
            before: before.as_ref().map(|(observation, action, reward)| Before {
                observation,
                action: *action,
                reward: *reward,
            }),
            actions: &offered(game, &state),
            series: None,
            cause: None,
        };
        let prompt = prompter.prompt(&turn, &past, &[]);
        let answer = answer(&prompt.messages);
        let action = match prompter.read(&answer, &turn) {
            Reading::Strict(actions) => actions[0],
            other => panic!("{}: {other:?}: {answer}", subject.id),
        };
        game.step(&mut state, action);
        actions.push(action);
        past.push(Past::new(prompt.shown, &[Attempt { answer, complaint: None }], action));
        before = Some((observation, action, state.score() - score));
    }
    (actions, state.outcome())
}

fn directly(player: &PromptPlayer) -> impl Fn(&[ChatMessage]) -> String {
    |messages| player.answer(messages).unwrap()
}

fn spawn(player: &str) -> Running {
    Server::bind(player.parse().unwrap(), 0).unwrap().spawn()
}

/// Posts a request, and returns the status and the JSON document in the reply.
fn post(server: &Running, path: &str, body: &str) -> (u16, Value) {
    let agent: ureq::Agent = ureq::Agent::config_builder().http_status_as_error(false).build().into();
    let request = agent.post(format!("{}{path}", server.base_url()));
    let mut reply = request.content_type("application/json").send(body).unwrap();
    let text = reply.body_mut().read_to_string().unwrap();
    (reply.status().as_u16(), serde_json::from_str(&text).unwrap())
}

fn body(model: &str, messages: &[ChatMessage]) -> String {
    let role = |role: Role| match role {
        Role::System => "system",
        Role::User => "user",
        Role::Assistant => "assistant",
    };
    let messages: Vec<Value> =
        messages.iter().map(|message| json!({"role": role(message.role), "content": message.text})).collect();
    json!({"model": model, "messages": messages, "temperature": 0.7}).to_string()
}

/// Sends a conversation through a model client, and returns the answer.
fn through(model: &dyn Model, messages: &[ChatMessage]) -> String {
    let (messages, sample) = (messages.to_vec(), Seed::from_text("through"));
    model.chat(&ChatRequest { messages, decoding: Decoding::default(), sample }).unwrap().text
}

#[test]
fn network_moves_equal_direct_calls() {
    let (games, limit) = if sweeping() { (4, LIMIT) } else { (2, LIMIT / 4) };
    for (name, mode) in [("random", Mode::ZeroShot), ("reflex", Mode::ZeroShot), ("reflex", Mode::Contextual)]
    {
        let (player, server): (PromptPlayer, Running) = (name.parse().unwrap(), spawn(name));
        let base_url = Some(server.base_url().to_owned());
        let remote =
            connect(&ModelOptions { base_url, ..ModelOptions::new(&format!("openai:{name}")) }).unwrap();
        let settings = PromptSettings { mode, ..PromptSettings::default() };
        let mut played = 0;
        for subject in corpus().iter().take(games) {
            let direct = beginning(limit, subject, &settings, |messages| through(&player, messages));
            let remotely = beginning(limit, subject, &settings, |messages| through(&*remote.model, messages));
            assert_eq!(remotely, direct, "{name} on {}", subject.id);
            played += direct.0.len();
        }
        assert!(played > 20 * games, "{name} played {played} moves only");
    }
}

#[test]
fn reflex_is_better_than_random() {
    let settings = PromptSettings::default();
    let wins = |player: &PromptPlayer| {
        let won = |subject: &&Subject| episode(subject, &settings, directly(player)).1 == Outcome::Won;
        corpus().iter().step_by(if sweeping() { 1 } else { 3 }).filter(won).count()
    };
    let (random, reflex) = (wins(&PromptPlayer::Random), wins(&PromptPlayer::Reflex));
    assert!(reflex > random, "{reflex} {random}");
}

/// A game with a lamp behind a gate that a key opens, a deadly moth, and a bat that must be shot.
const LAMP: &str = "BasicGame\n  SpriteSet\n    floor > Immovable\n    lamp > Door\n    gate > Immovable\n    key > Resource limit=2\n    moth > Immovable\n    bat > Immovable\n    dart > Missile\n    avatar > ShootAvatar stype=dart\n  LevelMapping\n    . > floor\n    A > avatar floor\n    l > lamp floor\n    g > gate floor\n    k > key floor\n    m > moth floor\n    b > bat floor\n  InteractionSet\n    avatar wall > stepBack\n    gate avatar > killIfOtherHasMore resource=key limit=1\n    avatar gate > stepBack\n    key avatar > collectResource\n    avatar moth bat > killSprite\n    bat dart > killBoth\n    dart wall > killSprite\n    lamp avatar > killSprite scoreChange=5\n  TerminationSet\n    MultiSpriteCounter stype1=lamp stype2=bat win=True\n    SpriteCounter stype=avatar win=False\n";

#[test]
fn reflex_follows_the_rules() {
    let reflex = PromptPlayer::Reflex;
    let check = |level: &str, limit: usize| {
        for rules in [Rules::Described, Rules::Vgdl] {
            let settings = PromptSettings { rules, ..PromptSettings::default() };
            let (actions, outcome) = episode(&subject("lamp", LAMP, level), &settings, directly(&reflex));
            assert_eq!(outcome, Outcome::Won, "{level}{rules:?} {actions:?}");
            assert!(actions.len() <= limit, "{level}{rules:?} {actions:?}");
        }
    };
    // The player must go straight to the lamp, go around the moth, take the key before the gate, or shoot the
    // bat from a distance.
    check("wwwwww\nwA..lw\nwwwwww\n", 12);
    check("wwwwwww\nwA.m.lw\nw.....w\nwwwwwww\n", 24);
    check("wwwwwwww\nw.A.wl.w\nw...g..w\nwk..w..w\nwwwwwwww\n", 60);
    check("wwwwwwww\nwA....bw\nw......w\nwwwwwwww\n", 12);
}

/// The rules state a shot's price as `1 key`, but the turn states the resources as `2 keys`.
#[test]
fn reflex_counts_what_it_holds() {
    let check = |game: &str, level: &str| {
        let (actions, outcome) = episode(
            &subject("lamp", game, level),
            &PromptSettings::default(),
            directly(&PromptPlayer::Reflex),
        );
        assert_eq!(outcome, Outcome::Won, "{level} {actions:?}");
    };
    let costly = LAMP.replace("key limit=1", "key limit=2");
    check(&costly, "wwwwwwww\nw.A.wl.w\nw...g..w\nwkk.w..w\nwwwwwwww\n");
    let paid = LAMP.replace("stype=dart", "stype=dart ammo=key");
    check(&paid, "wwwwwwww\nwA.k..bw\nwwwwwwww\n");
}

/// A game with two crates that must be pushed past each other onto two drains.
const CELLAR: &str = "BasicGame\n  SpriteSet\n    floor > Immovable\n    drain > Door\n    crate > Passive\n    avatar > MovingAvatar\n  LevelMapping\n    . > floor\n    A > avatar floor\n    x > crate floor\n    o > drain floor\n  InteractionSet\n    avatar wall > stepBack\n    crate avatar > bounceForward\n    crate wall crate > undoAll\n    crate drain > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype=crate win=True\n    Timeout limit=100 win=False\n";
const CELLAR_LEVEL: &str = "wwwwwww\nw...o.w\nw.x...w\nw.Ax.ow\nw.....w\nwwwwwww\n";

#[test]
fn a_planner_wins_from_the_position_in_the_prompt() {
    let cellar = subject("cellar", CELLAR, CELLAR_LEVEL);
    let player: PromptPlayer = "planner:mcts".parse().unwrap();
    // The player's random choices are derived from the prompt, so different characters on the board give
    // different choices.
    let wins = (0..5).filter(|&number| {
        let settings = PromptSettings {
            rules: Rules::Vgdl,
            shuffled_symbols: Some(number),
            ..PromptSettings::default()
        };
        episode(&cellar, &settings, directly(&player)).1 == Outcome::Won
    });
    let wins = wins.count();
    assert!(wins >= 3, "{wins} of 5 won");
}

#[test]
fn planners_refuse_games_with_hidden_state() {
    let refusal = |source: &str, level: &str, settings: &PromptSettings| {
        let subject = subject("refused", source, level);
        let player: PromptPlayer = "planner:mcts:20".parse().unwrap();
        let prompter = Prompter::new(&subject, settings.clone()).unwrap();
        let state = subject.game.start(&subject.levels[0].level, Seed::from_text("refused"));
        let observation = subject.game.observe(&state);
        let actions = &offered(&subject.game, &state);
        let (subject, observation) = (&subject, &observation);
        let turn = Turn {
            subject,
            level: 0,
            number: 0,
            limit: 9,
            commit: Commitment::ONE,
            observation,
            before: None,
            played: &[],
            actions,
            series: None,
            cause: None,
        };
        player.answer(&prompter.prompt(&turn, &[], &[]).messages).unwrap_err().to_string()
    };
    let vgdl = PromptSettings { rules: Rules::Vgdl, ..PromptSettings::default() };
    let check = |source: &str, settings: &PromptSettings, words: &str| {
        let message = refusal(source, CELLAR_LEVEL, settings);
        assert!(message.starts_with("`planner:mcts:20` cannot plan from this prompt: "), "{message}");
        assert!(message.contains(words), "{message}");
    };
    check(CELLAR, &PromptSettings::default(), "the planner needs the rules as VGDL");
    check(&CELLAR.replace("crate > Passive", "crate > RandomNPC"), &vgdl, "the game is stochastic");
    check(
        &CELLAR.replace("drain > Door", "drain > Door hidden=True"),
        &vgdl,
        "the drain affects play but is not visible",
    );
    check(
        &CELLAR.replace("crate > Passive", "crate > Missile orientation=LEFT"),
        &vgdl,
        "sprites move by themselves",
    );
    check(&CELLAR.replace("MovingAvatar", "MovingAvatar cooldown=3"), &vgdl, "when the avatar can move");
    check(
        &CELLAR.replace("crate drain > killSprite", "crate drain > subtractHealthPoints"),
        &vgdl,
        "`subtractHealthPoints`",
    );
    let mut blind = vgdl.clone();
    blind.encodings.grid = false;
    check(CELLAR, &blind, "no board");
}

#[test]
fn errors_have_the_format_of_the_real_apis() {
    let server = spawn("random");
    let check = |path: &str, body: &str, status: u16, code: &str| {
        let (got, document) = post(&server, path, body);
        assert_eq!((got, &document["error"]["code"]), (status, &Value::from(code)), "{document}");
        assert!(document["error"]["message"].as_str().is_some_and(|message| !message.is_empty()));
        assert_eq!(document["error"]["type"], "invalid_request_error");
    };
    let user = |text: &str| vec![ChatMessage { role: Role::User, text: text.to_owned(), image: None }];
    check("/chat/completions", "{", 400, "invalid_json");
    check("/chat/completions", "{\"model\":\"random\"}", 400, "invalid_json");
    check("/chat/completions", &body("gpt", &user("hi")), 404, "model_not_found");
    check("/chat/completions", &body("random", &user("hi")), 400, "unanswerable");
    check("/chat/completions", &body("random", &[]), 400, "unanswerable");
    check("/chat/completions", &body("random", &user("hi")).replace("user", "judge"), 400, "invalid_role");
    let streamed = body("random", &user("hi")).replace("\"temperature\":0.7", "\"stream\":true");
    check("/chat/completions", &streamed, 400, "unsupported_value");
    check("/embeddings", "{}", 404, "unknown_url");
    check("/models", "{}", 405, "method_not_supported");
    check("/chat/completions", &" ".repeat(33 << 20), 413, "unreadable_body");
}

#[test]
fn handwritten_requests_are_answered() {
    let server = spawn("random");
    let text = "## Actions\nnil, use\n\n## Turn\nTick 3 of at most 9. Score 0.";
    let parts = json!([{"type": "text", "text": text}, {"type": "image_url", "image_url": {"url": "data:"}}]);
    let request =
        json!({"model": "random", "messages": [{"role": "user", "content": parts}], "n": 1, "stream": false});
    let (status, reply) = post(&server, "/chat/completions", &request.to_string());
    assert_eq!(status, 200, "{reply}");
    let choice = &reply["choices"][0];
    assert_eq!(choice["message"], json!({"role": "assistant", "content": "ACTION: use", "refusal": null}));
    assert_eq!((&choice["finish_reason"], &reply["model"]), (&"stop".into(), &"random".into()));
    let prompt = text.len().div_ceil(4);
    let usage = json!({"prompt_tokens": prompt, "completion_tokens": 3, "total_tokens": prompt + 3});
    assert_eq!(reply["usage"], usage);
    let mut models = ureq::get(format!("{}/models", server.base_url())).call().unwrap();
    let models: Value = serde_json::from_str(&models.body_mut().read_to_string().unwrap()).unwrap();
    assert_eq!(models["data"][0]["id"], "random");
}

/// Opens a connection whose reads time out after `patience`.
fn connection(server: &Running, patience: Duration) -> TcpStream {
    let address = server.base_url().strip_prefix("http://").unwrap().strip_suffix("/v1").unwrap();
    let stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(patience)).unwrap();
    stream
}

const GENEROUS: Duration = Duration::from_secs(60);

/// Sends bytes and returns the whole reply.
fn raw(server: &Running, bytes: &str) -> String {
    let mut stream = connection(server, GENEROUS);
    stream.write_all(bytes.as_bytes()).unwrap();
    let mut reply = String::new();
    stream.read_to_string(&mut reply).unwrap();
    reply
}

/// A web page from another site, opened in a browser on this machine, gets no answers from a served player.
#[test]
fn foreign_pages_are_refused() {
    let server = spawn("random");
    let check = |headers: &str, status: &str, code: &str| {
        let request = format!(
            "POST /v1/chat/completions HTTP/1.1\r\n{headers}Connection: close\r\nContent-Length: 2\r\n\r\n{{}}"
        );
        let reply = raw(&server, &request);
        assert!(
            reply.starts_with(&format!("HTTP/1.1 {status}")) && reply.contains(code),
            "{headers}: {reply}"
        );
    };
    let json = "Content-Type: application/json\r\n";
    check(&format!("Host: localhost:1\r\n{json}"), "400", "invalid_json");
    check(&format!("Host: [::1]\r\nOrigin: http://localhost:3000\r\n{json}"), "400", "invalid_json");
    check(&format!("Host: evil.example\r\n{json}"), "421", "foreign_host");
    check(json, "421", "foreign_host");
    check(&format!("Host: localhost\r\nOrigin: https://evil.example\r\n{json}"), "403", "foreign_origin");
    check(&format!("Host: localhost\r\nOrigin: null\r\n{json}"), "403", "foreign_origin");
    check("Host: localhost\r\nContent-Type: text/plain\r\n", "415", "unsupported_content_type");
    check("Host: localhost\r\n", "415", "unsupported_content_type");
    check("Host: localhost\r\nContent-Type: application/json; charset=utf-8\r\n", "400", "invalid_json");
    let models = raw(&server, "GET /v1/models HTTP/1.1\r\nHost: evil.example\r\nConnection: close\r\n\r\n");
    assert!(models.starts_with("HTTP/1.1 421"), "{models}");
}

fn bounded(bounds: Bounds) -> Running {
    Server::bind("random".parse().unwrap(), 0).unwrap().within(bounds).spawn()
}

const HEAD: &str = "POST /v1/chat/completions HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nConnection: close\r\n";

/// Slow clients are disconnected, whether they are slow in the head or in the body of a request.
#[test]
fn slow_clients_are_disconnected() {
    let short = Duration::from_millis(200);
    let server = bounded(Bounds { head_time: short, body_time: short, ..Bounds::default() });
    for bytes in ["", "POST /v1/chat/comp", HEAD] {
        let reply = raw(&server, bytes);
        assert!(reply.is_empty() || reply.starts_with("HTTP/1.1 408"), "{bytes}: {reply}");
    }
    let reply = raw(&server, &format!("{HEAD}Content-Length: 100\r\n\r\n{{"));
    assert!(reply.starts_with("HTTP/1.1 408") && reply.contains("request_timeout"), "{reply}");
}

/// If all connections are taken, the client that has been silent for the longest time is disconnected. This
/// affects idle clients, and clients that send requests but read nothing.
#[test]
fn idle_and_slow_clients_give_way() {
    let ask = "GET /v1/models HTTP/1.1\r\nHost: localhost\r\n";
    let last = format!("{ask}Connection: close\r\n\r\n");
    let server = bounded(Bounds { connections: 2, head_time: GENEROUS, ..Bounds::default() });
    let mut idle = [connection(&server, GENEROUS), connection(&server, GENEROUS)];
    for _ in 0..4 {
        assert!(raw(&server, &last).starts_with("HTTP/1.1 200"));
    }
    // There are never more than two open connections.
    assert_eq!(idle[0].read(&mut [0; 1]).unwrap_or(0), 0);
    let mut greedy = [connection(&server, GENEROUS), connection(&server, GENEROUS)];
    for client in &mut greedy {
        client.set_write_timeout(Some(Duration::from_millis(300))).unwrap();
        // The client writes until neither side can send more.
        while client.write_all(format!("{ask}\r\n").repeat(1000).as_bytes()).is_ok() {}
    }
    for _ in 0..4 {
        assert!(raw(&server, &last).starts_with("HTTP/1.1 200"));
    }
}

/// A client that reads nothing is disconnected, even if no other client connects.
#[test]
fn clients_that_read_nothing_are_disconnected() {
    let short = Duration::from_millis(200);
    let server = bounded(Bounds { write_time: short, head_time: GENEROUS, ..Bounds::default() });
    let mut client = connection(&server, GENEROUS);
    let many = "GET /v1/models HTTP/1.1\r\nHost: localhost\r\n\r\n".repeat(1000);
    // A write fails only because the server has closed the connection.
    client.set_write_timeout(Some(GENEROUS)).unwrap();
    let gone = std::iter::repeat_with(|| client.write_all(many.as_bytes())).find_map(Result::err).unwrap();
    assert!(!matches!(gone.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut), "{gone}");
}

/// The total memory for bodies in flight stays within its bound.
#[test]
fn bodies_are_bounded() {
    let server =
        bounded(Bounds { body: 48 << 10, bodies: 64 << 10, body_time: GENEROUS, ..Bounds::default() });
    let mut half = connection(&server, GENEROUS);
    half.write_all(format!("{HEAD}Content-Length: {}\r\n\r\n{{", 48 << 10).as_bytes()).unwrap();
    // The server has read the first part of the body, so it has reserved space for the whole body.
    half.flush().unwrap();
    let request = format!("{HEAD}Content-Length: {}\r\n\r\n{}", 32 << 10, " ".repeat(32 << 10));
    // There is still enough space for a small body.
    assert!(raw(&server, &format!("{HEAD}Content-Length: 2\r\n\r\n{{}}")).starts_with("HTTP/1.1 400"));
    let mut waiting = connection(&server, Duration::from_millis(500));
    waiting.write_all(request.as_bytes()).unwrap();
    let kind = waiting.read(&mut [0; 1]).unwrap_err().kind();
    assert!(matches!(kind, ErrorKind::WouldBlock | ErrorKind::TimedOut), "{kind:?}");
    drop(half);
    waiting.set_read_timeout(Some(GENEROUS)).unwrap();
    let mut reply = String::new();
    waiting.read_to_string(&mut reply).unwrap();
    assert!(reply.starts_with("HTTP/1.1 400") && reply.contains("invalid_json"), "{reply}");
    // The body is too large according to its stated length, or turns out to be too large when sent in chunks.
    let much = (48 << 10) + 1;
    let stated = raw(&server, &format!("{HEAD}Content-Length: {much}\r\n\r\n{}", " ".repeat(much)));
    assert!(stated.starts_with("HTTP/1.1 413"), "{stated}");
    let piece = format!("{:x}\r\n{}\r\n0\r\n\r\n", 49 << 10, " ".repeat(49 << 10));
    let mut pieces = connection(&server, GENEROUS);
    let _ = pieces.write_all(format!("{HEAD}Transfer-Encoding: chunked\r\n\r\n{piece}").as_bytes());
    let mut start = [0; 12];
    pieces.read_exact(&mut start).unwrap();
    assert_eq!(&start, b"HTTP/1.1 413");
}
