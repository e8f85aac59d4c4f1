//! `fredholm view`: what the server gives, to whom, and what it does with nonsense; and the page of its own of `--html`.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the message, in its helpers too")]

mod run;

use run::{folder, fredholm, json, names, refuse, text};
use serde_json::{Value, json as said};
use std::fs;
use std::io::{BufRead, BufReader, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::Duration;
use tungstenite::client::IntoClientRequest;
use tungstenite::{Message, WebSocket, client};

/// A server with the Cornell box in some 200 patches.
struct Server {
    child: Child,
    port: u16,
}

impl Drop for Server {
    fn drop(&mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
    }
}

impl Server {
    fn start(words: &str) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fredholm"));
        command.args(["view", "--no-open", "--port", "0"]).args(words.split_whitespace());
        let mut child = command.stdout(Stdio::piped()).spawn().unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let port = line.split("127.0.0.1:").nth(1).and_then(|rest| rest.split('/').next());
        Self { child, port: port.unwrap_or_else(|| panic!("no address in `{line}`")).parse().unwrap() }
    }

    fn cornell() -> Self {
        Self::start("--patch-count 200")
    }

    fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
        stream
    }

    /// What is answered to these lines of a request, to be followed by the end of its head.
    fn ask(&self, lines: &str) -> (u16, String, Vec<u8>) {
        let mut stream = self.connect();
        stream.write_all(format!("{lines}\r\nConnection: close\r\n\r\n").as_bytes()).unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        let end = answer.windows(4).position(|w| w == b"\r\n\r\n").unwrap_or(answer.len() - 4);
        let head = text(&answer[..end]).to_lowercase();
        let code = head.split_whitespace().nth(1).and_then(|code| code.parse().ok()).unwrap();
        (code, head, answer[end + 4..].to_vec())
    }

    fn get(&self, path: &str) -> (u16, String, Vec<u8>) {
        self.ask(&format!("GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{}", self.port))
    }

    fn scene(&self) -> Value {
        json(&self.get("/scene.json").2)
    }

    fn session(&self, origin: Option<&str>) -> Result<Session, Box<tungstenite::Error>> {
        let mut request = format!("ws://127.0.0.1:{}/session", self.port).into_client_request().unwrap();
        if let Some(origin) = origin {
            request.headers_mut().insert("origin", origin.parse().unwrap());
        }
        match client(request, self.connect()) {
            Ok((socket, _)) => Ok(Session(socket)),
            Err(tungstenite::HandshakeError::Failure(error)) => Err(Box::new(error)),
            Err(tungstenite::HandshakeError::Interrupted(_)) => panic!("the handshake takes a minute"),
        }
    }
}

struct Session(WebSocket<TcpStream>);

impl Session {
    fn say(&mut self, command: &Value) {
        self.0.send(Message::Text(command.to_string().into())).unwrap();
    }

    fn start(&mut self, scene: &Value, solver: &str) {
        let reflectance: Vec<_> =
            scene["surfaces"].as_array().unwrap().iter().map(|s| s["reflectance"].clone()).collect();
        let lamps = vec![1.0; scene["lamps"].as_array().unwrap().len()];
        self.say(&said!({"type": "start", "solvers": [solver], "lamps": lamps, "reflectance": reflectance}));
    }

    /// The next message that is as wanted.
    fn hear<T>(&mut self, wanted: impl Fn(&Message) -> Option<T>) -> T {
        loop {
            if let Some(found) = wanted(&self.0.read().unwrap()) {
                return found;
            }
        }
    }

    fn error(&mut self) -> String {
        self.hear(|message| {
            let remark: Value = serde_json::from_str(message.to_text().ok()?).ok()?;
            (remark["type"] == "error").then(|| remark["message"].as_str().unwrap().to_owned())
        })
    }

    /// Run, iteration, state and residual of the next frame, and its radiosities.
    fn frame(&mut self) -> (u32, u32, u32, f64, Vec<f32>) {
        self.hear(|message| match message {
            Message::Binary(bytes) if bytes[0] == 1 => {
                let word = |k: usize| u32::from_le_bytes(bytes[4 * k..][..4].try_into().unwrap());
                let residual = f64::from_le_bytes(bytes[32..40].try_into().unwrap());
                let n = (bytes.len() - 56) / 16;
                let light = bytes[56..][..12 * n].chunks(4);
                let light = light.map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect();
                Some((word(2), word(3), word(5), residual, light))
            }
            _ => None,
        })
    }

    /// The first frame of a run that has ended.
    fn ended(&mut self, run: u32) -> (f64, Vec<f32>) {
        loop {
            let (of, _, state, residual, light) = self.frame();
            if of == run && state == 1 {
                return (residual, light);
            }
        }
    }
}

#[test]
fn the_page_and_the_scene_are_served_and_nothing_else() {
    let server = Server::cornell();
    for (path, kind) in [("/", "text/html"), ("/viewer.js", "text/javascript"), ("/viewer.css", "text/css")] {
        let (code, head, body) = server.get(path);
        assert_eq!((code, head.contains(kind)), (200, true), "{path}: {head}");
        assert!(
            body.len() > 1000 && head.contains("default-src 'none'") && head.contains("nosniff"),
            "{head}"
        );
    }
    let scene = server.scene();
    let n = scene["patches"].as_u64().unwrap();
    assert!((200..260).contains(&n) && scene["units"]["exitance"] == "W/m²", "{scene}");
    assert_eq!(server.get("/geometry.bin").2.len() as u64, 48 * n);
    for path in [
        "/../../../../etc/passwd",
        "/%2e%2e/%2e%2e/etc/passwd",
        "/viewer.js/../../Cargo.toml",
        "//etc/passwd",
        "/..%2f..%2fCargo.toml",
        "/viewer.js%00.html",
        "/page/index.html",
        "/scene.json/",
    ] {
        let (code, _, body) = server.get(path);
        assert_eq!((code, body.len()), (404, 0), "{path}");
    }
    let post = format!("POST / HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nContent-Length: 0", server.port);
    assert_eq!(server.ask(&post).0, 405);
}

#[test]
fn other_sites_and_other_names_are_refused() {
    let server = Server::cornell();
    let port = server.port;
    for lines in [
        "GET / HTTP/1.1\r\nHost: evil.example".to_owned(),
        format!("GET /scene.json HTTP/1.1\r\nHost: evil.example:{port}"),
        format!("GET /scene.json HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nOrigin: http://evil.example"),
        format!("GET /nothing HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nOrigin: null"),
    ] {
        let (code, _, body) = server.ask(&lines);
        assert_eq!(code, 403, "{lines}");
        assert!(!text(&body).contains("patches"), "{lines}");
    }
    assert!(server.session(Some("http://evil.example")).is_err());
    assert!(server.session(Some(&format!("http://127.0.0.1:{port}"))).is_ok());
}

#[test]
fn nonsense_is_told_and_survived() {
    let server = Server::cornell();
    let mut session = server.session(None).unwrap();
    for (nonsense, words) in [
        ("", "no command"),
        ("{", "no command"),
        ("[1, 2]", "no command"),
        ("{\"type\": \"format\"}", "no command"),
        ("{\"type\": \"play\", \"passes\": 1e999}", "no command"),
        ("{\"type\": \"play\", \"passes\": 0}", "positive"),
        ("{\"type\": \"play\", \"passes\": 1, \"more\": 1}", "no command"),
        ("{\"type\": \"factors\", \"patch\": 4000000000}", "no patch"),
        ("{\"type\": \"factors\", \"patch\": -1}", "no command"),
        ("{\"type\": \"relight\", \"reflectance\": [], \"version\": 1}", "give one for each"),
        (
            "{\"type\": \"start\", \"solvers\": [\"direct\"], \"lamps\": [1], \"reflectance\": []}",
            "no command",
        ),
        ("{\"type\": \"export\", \"format\": \"exe\"}", "no command"),
        (
            "{\"type\": \"export\", \"format\": \"png\", \"camera\": {\"position\": [0, 0, 0], \"target\": [0, 0, 0], \
             \"up\": [0, 1, 0], \"vertical_angle\": 40, \"aspect\": 1}}",
            "camera",
        ),
    ] {
        session.0.send(Message::Text(nonsense.into())).unwrap();
        let error = session.error();
        assert!(error.contains(words), "`{nonsense}`: {error}");
    }
    session.0.send(Message::Binary(vec![1; 100].into())).unwrap();
    assert!(session.error().contains("JSON"));
    session.say(&said!({"type": "step"}));
    while session.frame().1 != 1 {}
    // A message beyond all measure ends its own session, and no other.
    let mut other = server.session(None).unwrap();
    let _ = other.0.send(Message::Text("x".repeat(1 << 18).into()));
    let ended = loop {
        if let Err(error) = other.0.read() {
            break error;
        }
    };
    assert!(
        !matches!(&ended, tungstenite::Error::Io(error) if error.kind() == ErrorKind::WouldBlock),
        "it goes on"
    );
    // So does a page that goes without a word.
    drop(server.session(None).unwrap().0.into_inner());
    session.say(&said!({"type": "step"}));
    while session.frame().1 != 2 {}
}

#[test]
fn every_window_has_a_solver_of_its_own_and_all_come_to_the_same_light() {
    let server = Server::cornell();
    let scene = server.scene();
    let solvers = ["southwell", "gauss-seidel", "jacobi", "successive", "gmres"];
    let lights: Vec<Vec<f32>> = std::thread::scope(|scope| {
        let watch = |solver: &'static str| {
            let (server, scene) = (&server, &scene);
            scope.spawn(move || {
                let mut session = server.session(None).unwrap();
                session.start(scene, solver);
                session.say(&said!({"type": "play", "passes": 1000}));
                let (residual, light) = session.ended(2);
                assert!(residual < 1e-4, "{solver}: {residual}");
                light
            })
        };
        let watched: Vec<_> = solvers.map(watch).into_iter().collect();
        watched.into_iter().map(|window| window.join().unwrap()).collect()
    });
    let brightest = lights[0].iter().copied().fold(0.0, f32::max);
    for (solver, light) in solvers.iter().zip(&lights) {
        let off = light.iter().zip(&lights[0]).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(off < 1e-5 * brightest, "{solver} is off by {off} of {brightest}");
    }
}

#[test]
fn a_dimmed_lamp_is_half_the_light_by_a_new_start_and_by_adding() {
    let server = Server::cornell();
    let scene = server.scene();
    let mut session = server.session(None).unwrap();
    session.start(&scene, "gauss-seidel");
    session.say(&said!({"type": "play", "passes": 1000}));
    let (_, full) = session.ended(2);
    let reflectance: Vec<_> =
        scene["surfaces"].as_array().unwrap().iter().map(|s| s["reflectance"].clone()).collect();
    session.say(&said!({"type": "relight", "reflectance": reflectance, "version": 7}));
    let lamp = session.hear(|message| match message {
        Message::Binary(bytes) if bytes[0] == 3 && bytes[12] == 1 && bytes[8] == 7 => Some(bytes.to_vec()),
        _ => None,
    });
    let lamp: Vec<f32> = lamp[16..].chunks(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect();
    session.say(&said!({"type": "start", "solvers": ["jacobi"], "lamps": [0.5], "reflectance": reflectance}));
    let (_, half) = session.ended(3);
    let brightest = full.iter().copied().fold(0.0, f32::max);
    for i in 0..full.len() {
        assert!((lamp[i] - full[i]).abs() < 1e-3 * brightest, "{} {}", lamp[i], full[i]);
        assert!((half[i] - 0.5 * full[i]).abs() < 1e-5 * brightest, "{} {}", half[i], full[i]);
    }
}

#[test]
fn the_light_of_now_can_be_had_in_every_format() {
    let server = Server::cornell();
    let scene = server.scene();
    let mut session = server.session(None).unwrap();
    session.start(&scene, "gauss-seidel");
    session.say(&said!({"type": "play", "passes": 1000}));
    session.ended(2);
    let mut file = |format: &str| {
        session.say(&said!({"type": "export", "format": format}));
        session.hear(|message| match message {
            Message::Binary(bytes) if bytes[0] == 4 => {
                let end = 8 + bytes[4] as usize;
                Some((text(&bytes[8..end]), bytes[end..].to_vec()))
            }
            _ => None,
        })
    };
    let (name, table) = file("csv");
    let rows = text(&table).lines().count() as u64;
    assert_eq!((name.as_str(), rows), ("cornell-box.csv", scene["patches"].as_u64().unwrap() + 1));
    assert!(file("npz").1.starts_with(b"PK"));
    assert!(file("png").1.starts_with(b"\x89PNG"));
    let (name, cells) = file("vtu");
    assert!(name == "cornell-box.vtu" && text(&cells).contains("radiosity (W/m²)"));
    assert!(file("glb").1.starts_with(b"glTF"));
    let report = json(&file("json").1);
    assert_eq!((&report["method"], &report["space"]), (&"galerkin".into(), &"p0".into()));
    // The same as without a window.
    let folder = folder("view-same");
    let solved = json(&fredholm(&folder, "radiosity --patch-count 200 --json -").stdout);
    for k in 0..16 {
        for key in ["mean_radiosity", "mean_irradiance"] {
            let [a, b] = [&report, &solved].map(|r| r["surfaces"][k][key][0].as_f64().unwrap());
            assert!((a - b).abs() < 1e-4 * b.abs().max(1e-2), "{key} of surface {k}: {a} and {b}");
        }
    }
}

#[test]
fn a_file_is_of_the_light_that_a_page_sends_back() {
    let server = Server::cornell();
    let scene = server.scene();
    let mut session = server.session(None).unwrap();
    session.start(&scene, "gauss-seidel");
    let patches = scene["patches"].as_u64().unwrap() as usize;
    let reflectance: Vec<_> =
        scene["surfaces"].as_array().unwrap().iter().map(|s| s["reflectance"].clone()).collect();
    // 12 bytes a patch are 16 letters: (1, 2, 4), or no number at all.
    let shown = |letters: &str, lamps: &[f64]| {
        said!({"type": "export", "format": "csv", "shown": {
            "radiosity": letters.repeat(patches), "lamps": lamps, "reflectance": reflectance }})
    };
    for (bad, words) in [
        (shown("AACAPwAAAEAAAIBA", &[1.0, 1.0]), "factors for 1 lamps"),
        (shown("AACAPwAAAEAAAIBAAACAPwAAAEAAAIBA", &[1.0]), "the light that is shown has"),
        (shown("AADAfwAAwH8AAMB/", &[1.0]), "not finite"),
        (shown("AACAPwAAAEAAAI!A", &[1.0]), "base64"),
    ] {
        session.say(&bad);
        let error = session.error();
        assert!(error.contains(words), "{error}");
    }
    session.say(&shown("AACAPwAAAEAAAIBA", &[1.0]));
    let table = session.hear(|message| match message {
        Message::Binary(bytes) if bytes[0] == 4 => Some(text(&bytes[8 + bytes[4] as usize..])),
        _ => None,
    });
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    let at = rows[0].iter().position(|name| *name == "radiosity_r").unwrap();
    assert_eq!(rows.len(), patches + 1);
    assert!(rows[1..].iter().all(|row| row[at..at + 3] == ["1", "2", "4"]), "{:?}", rows[1]);
}

#[test]
fn windows_have_an_end() {
    let server = Server::cornell();
    let mut open: Vec<_> = (0..16).map(|_| server.session(None).unwrap()).collect();
    assert!(server.session(None).is_err(), "a seventeenth is let in");
    open.pop().unwrap().0.close(None).unwrap();
    // A seat is free as soon as the server has seen that one is gone.
    assert!((0..100).any(|_| server.session(None).is_ok() || {
        std::thread::sleep(Duration::from_millis(20));
        false
    }));
}

#[test]
fn what_cannot_be_shown_is_refused() {
    let folder = folder("view-refused");
    fs::write(folder.join("empty.obj"), "").unwrap();
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port();
    refuse(
        &folder,
        &[
            ("view nothing.obj --no-open", 1, &["nothing.obj"]),
            ("view empty.obj --no-open", 1, &["empty.obj"]),
            ("view --no-open --solver direct", 1, &["no steps"]),
            ("view --no-open --solver jacobi --patch-count 21000", 1, &["only southwell"]),
            ("view --no-open --bands spectral", 1, &["red, green and blue", "--html FILE"]),
            ("view --no-open --patch-size 1e-9", 1, &["larger"]),
            ("view --port 99999", 2, &["99999"]),
            ("radiosity --html box.html --solver direct", 1, &["no steps"]),
            ("radiosity --html box.htm", 2, &[".html"]),
            ("radiosity --html no/box.html", 1, &["no/box.html"]),
            ("radiosity --html box.html --accuracy 1%", 2, &["--accuracy"]),
        ],
        |words| fredholm(&folder, words),
    );
    refuse(&folder, &[("view --no-open --port", 1, &["--port 0 takes a free one"])], |words| {
        fredholm(&folder, &format!("{words} {port}"))
    });
}

#[test]
fn a_page_of_its_own_has_all_that_it_shows() {
    let folder = folder("view-html");
    let output = fredholm(&folder, "radiosity --patch-count 200 --solver southwell --html box.html --json -");
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(names(&folder), ["box.html"]);
    let page = fs::read_to_string(folder.join("box.html")).unwrap();
    let recorded =
        page.split("type=\"application/json\">").nth(1).unwrap().split("</script>").next().unwrap();
    let recorded: Value = serde_json::from_str(recorded).unwrap();
    let report = json(&output.stdout);
    let n = report["patches"].as_u64().unwrap() as usize;
    let frames = recorded["frames"].as_array().unwrap();
    assert!(frames.len() > 20 && recorded["scene"]["patches"] == n, "{} frames", frames.len());
    // Base64: four letters for three bytes.
    let length = 4 * (56 + 8 + 8 * n).div_ceil(3);
    assert!(frames.iter().all(|frame| frame.as_str().unwrap().len() == length));
}
