//! Frames a second of `fredholm view`: five windows on the Cornell box in 50 000 patches, each with a solver that shoots.
//!
//! `cargo bench -p fredholm-cli --bench view`, on this machine's loopback alone.

use std::error::Error;
use std::io::{self, BufRead, BufReader, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};
use tungstenite::{Message, client};

type Result<T> = std::result::Result<T, Box<dyn Error + Send + Sync>>;

const WINDOWS: usize = 5;
const PATCHES: &str = "50000";
const SECONDS: u64 = 20;

fn main() -> Result<()> {
    let mut server = Command::new(env!("CARGO_BIN_EXE_fredholm"))
        .args(["view", "--no-open", "--port", "0", "--patch-count", PATCHES])
        .stdout(Stdio::piped())
        .spawn()?;
    let measured = measure(&mut server);
    server.kill()?;
    server.wait()?;
    let mut out = io::stdout().lock();
    for (window, (frames, shots, bytes)) in measured?.into_iter().enumerate() {
        let per_second = |count: f64| count / SECONDS as f64;
        writeln!(
            out,
            "window {window}: {:.1} frames/s, {:.1} shots/s, {:.1} MB/s",
            per_second(frames as f64),
            per_second(f64::from(shots)),
            per_second(bytes as f64) / 1e6
        )?;
    }
    Ok(())
}

/// Frames, shots and bytes of each window.
fn measure(server: &mut Child) -> Result<Vec<(usize, u32, usize)>> {
    let mut line = String::new();
    BufReader::new(server.stdout.take().ok_or("no output")?).read_line(&mut line)?;
    let port = line.split("127.0.0.1:").nth(1).and_then(|rest| rest.split('/').next()).ok_or("no address")?;
    let port: u16 = port.parse()?;
    let windows: Vec<_> = (0..WINDOWS).map(|_| thread::spawn(move || watch(port))).collect();
    windows.into_iter().map(|window| window.join().map_err(|_| "a window panics")?).collect()
}

fn watch(port: u16) -> Result<(usize, u32, usize)> {
    let stream = TcpStream::connect(("127.0.0.1", port))?;
    let (mut socket, _) = client(format!("ws://127.0.0.1:{port}/session"), stream)?;
    socket.send(Message::Text("{\"type\": \"play\", \"passes\": 1000}".into()))?;
    // The first frame is of before the first shot, and the second of how long it took to get going.
    let mut warm = 2;
    let (mut begin, mut first) = (Instant::now(), 0);
    let (mut frames, mut last, mut bytes) = (0, 0, 0);
    while begin.elapsed() < Duration::from_secs(SECONDS) {
        let Message::Binary(frame) = socket.read()? else { continue };
        last = u32::from_le_bytes(frame[12..16].try_into()?);
        if warm > 0 {
            warm -= 1;
            (begin, first) = (Instant::now(), last);
            continue;
        }
        frames += 1;
        bytes += frame.len();
    }
    Ok((frames, last - first, bytes))
}
