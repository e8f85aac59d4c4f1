//! The page, the scene and the sessions, at 127.0.0.1: five paths, and nothing else.

use super::guard::Guard;
use super::page;
use super::protocol::{Command, Message, Remark};
use super::session;
use super::solvers::Solver;
use super::stage::Stage;
use axum::Router;
use axum::body::Bytes;
use axum::extract::ws::{Message as Packet, WebSocket, WebSocketUpgrade};
use axum::extract::{Request, State};
use axum::http::StatusCode;
use axum::http::header::{
    CACHE_CONTROL, CONTENT_SECURITY_POLICY, CONTENT_TYPE, HeaderName, HeaderValue, REFERRER_POLICY,
    X_CONTENT_TYPE_OPTIONS,
};
use axum::middleware::{self, Next};
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use std::io;
use std::net::TcpListener;
use std::sync::Arc;
use std::sync::mpsc::{SyncSender, TrySendError, sync_channel};
use tokio::sync::{Semaphore, mpsc};

/// What is served.
pub struct Hall {
    /// The scene.
    pub stage: Stage,
    /// The solver that begins.
    pub solver: Solver,
    /// `/scene.json`.
    pub description: String,
    /// `/geometry.bin`.
    pub geometry: Vec<u8>,
    /// Who is let in.
    pub guard: Guard,
    /// Windows that may still be opened.
    pub seats: Arc<Semaphore>,
}

/// Windows at once: each has a solver that may work. Who opens more has lost sight of them.
pub const SEATS: usize = 16;

/// The longest message of a page, in bytes, is one with a reflectance for each surface, three numbers of 20 digits or so, and
/// the light of each patch, 12 bytes in base64.
const LONGEST: usize = 1 << 16;
const LONGEST_OF_SURFACE: usize = 80;
const LONGEST_OF_PATCH: usize = 16;

/// Commands that a page may be ahead of its solver.
const AHEAD: usize = 256;

/// Frames that a solver may be ahead of its page: one that is on its way, and one to follow it.
const FRAMES: usize = 2;

/// Serves until the process ends.
pub fn serve(listener: TcpListener, hall: Arc<Hall>) -> io::Result<()> {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    runtime.block_on(async {
        listener.set_nonblocking(true)?;
        axum::serve(tokio::net::TcpListener::from_std(listener)?, router(hall)).await
    })
}

fn router(hall: Arc<Hall>) -> Router {
    Router::new()
        .route("/", get(|| async { file("text/html; charset=utf-8", page::HTML) }))
        .route("/viewer.js", get(|| async { file("text/javascript; charset=utf-8", page::SCRIPT) }))
        .route("/viewer.css", get(|| async { file("text/css; charset=utf-8", page::STYLE) }))
        .route("/scene.json", get(scene))
        .route("/geometry.bin", get(geometry))
        .route("/session", get(session))
        .layer(middleware::from_fn_with_state(Arc::clone(&hall), guarded))
        .with_state(hall)
}

fn file(kind: &'static str, content: impl IntoResponse) -> Response {
    ([(CONTENT_TYPE, kind)], content).into_response()
}

async fn scene(State(hall): State<Arc<Hall>>) -> Response {
    file("application/json", hall.description.clone())
}

async fn geometry(State(hall): State<Arc<Hall>>) -> Response {
    file("application/octet-stream", hall.geometry.clone())
}

/// Lets in whom the guard lets in, and tells the browser to load nothing from anywhere else.
async fn guarded(State(hall): State<Arc<Hall>>, request: Request, next: Next) -> Response {
    let mut response = match hall.guard.refusal(request.headers()) {
        Some(why) => (StatusCode::FORBIDDEN, why).into_response(),
        None => next.run(request).await,
    };
    let headers = response.headers_mut();
    for (name, value) in [
        (CONTENT_SECURITY_POLICY, POLICY),
        (X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (REFERRER_POLICY, "no-referrer"),
        (CACHE_CONTROL, "no-store"),
        (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
    ] {
        headers.insert(name, HeaderValue::from_static(value));
    }
    response
}

const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; \
                      img-src 'self' data: blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

async fn session(State(hall): State<Arc<Hall>>, upgrade: WebSocketUpgrade) -> Response {
    let Ok(seat) = Arc::clone(&hall.seats).try_acquire_owned() else {
        return (StatusCode::SERVICE_UNAVAILABLE, format!("{SEATS} windows are open; close one"))
            .into_response();
    };
    let Stage { scene, patches, .. } = &hall.stage;
    let longest = LONGEST + LONGEST_OF_SURFACE * scene.surfaces.len() + LONGEST_OF_PATCH * patches.len();
    upgrade.max_message_size(longest).max_frame_size(longest).on_upgrade(async move |socket| {
        converse(socket, hall).await;
        drop(seat);
    })
}

/// Carries commands and messages between a page and its solver, which has a thread of its own, until one of them is gone.
async fn converse(mut socket: WebSocket, hall: Arc<Hall>) {
    let (tell, heard) = sync_channel(AHEAD);
    let (say, mut said) = mpsc::channel(FRAMES);
    let work = move || {
        session::serve(&hall.stage, hall.solver, &heard, &mut |message| say.blocking_send(message).is_ok());
    };
    if std::thread::Builder::new().name("session".into()).spawn(work).is_err() {
        return;
    }
    loop {
        let going = tokio::select! {
            packet = socket.recv() => match packet {
                Some(Ok(packet)) => match answer(packet, &tell) {
                    Answer::Nothing => Ok(()),
                    Answer::Remark(remark) => socket.send(wrap((&remark).into())).await,
                    Answer::End => break,
                },
                _ => break,
            },
            message = said.recv() => match message {
                Some(message) => socket.send(wrap(message)).await,
                None => break,
            },
        };
        if going.is_err() {
            break;
        }
    }
}

/// What a packet is answered.
enum Answer {
    Nothing,
    Remark(Remark),
    End,
}

/// Hands a command on, or says what is wrong with it.
fn answer(packet: Packet, tell: &SyncSender<Command>) -> Answer {
    let message = match packet {
        Packet::Text(text) => match serde_json::from_str(&text) {
            Ok(command) => match tell.try_send(command) {
                Ok(()) => return Answer::Nothing,
                Err(TrySendError::Full(_)) => "too much is asked for at once; this was left out".to_owned(),
                Err(TrySendError::Disconnected(_)) => return Answer::End,
            },
            Err(error) => format!("this is no command: {error}"),
        },
        Packet::Binary(_) => "commands are JSON, in text".to_owned(),
        Packet::Ping(_) | Packet::Pong(_) => return Answer::Nothing,
        Packet::Close(_) => return Answer::End,
    };
    Answer::Remark(Remark::Error { message })
}

fn wrap(message: Message) -> Packet {
    match message {
        Message::Text(text) => Packet::Text(text.into()),
        Message::Bytes(bytes) => Packet::Binary(Bytes::from(bytes)),
    }
}
