//! The server, which has one thread. It gives the files of the page to everybody who opens its address, and data to
//! those who may have it. It refuses requests that come from other pages.

use super::access::{Access, Refusal};
use super::control::Control;
use super::files::{self, POLICY};
use super::hub::Hub;
use super::listener::Limited;
use super::place::Place;
use super::session::{LARGEST_MESSAGE, Session};
use crate::interrupt::Interrupt;
use axum::Router;
use axum::body::Body;
use axum::extract::ws::WebSocketUpgrade;
use axum::extract::{ConnectInfo, Query, Request, State};
use axum::http::{HeaderMap, HeaderValue, Response, StatusCode, Uri, header};
use axum::middleware::{self, Next};
use axum::routing::get;
use serde::Deserialize;
use std::io;
use std::sync::Arc;
use std::time::Duration;
use tokio::net::TcpListener;
use tokio::sync::Semaphore;

/// Largest number of pages, in browsers, that receive data at the same time.
const PAGES: usize = 16;

/// Interval at which the server checks whether a signal requests its end.
const BETWEEN_LOOKS: Duration = Duration::from_millis(50);

/// What the server serves.
#[derive(Clone)]
pub struct Server {
    /// Who may read.
    pub access: Arc<Access>,
    /// Distributes the messages of the hand to the pages.
    pub hub: Arc<Hub>,
    /// The hand that pages may move; none without `--control`.
    pub control: Option<Arc<Control>>,
}

#[derive(Clone)]
struct Shared {
    server: Server,
    pages: Arc<Semaphore>,
}

#[derive(Deserialize)]
struct Credentials {
    token: Option<String>,
}

impl Server {
    /// Serves until the end is requested.
    ///
    /// # Errors
    /// Returns an error if the listener fails, or if the system refuses to watch the signals.
    pub async fn run(self, listener: std::net::TcpListener) -> io::Result<()> {
        let interrupt = Interrupt::watch()?;
        listener.set_nonblocking(true)?;
        let limited = Limited::new(TcpListener::from_std(listener)?);
        let access = Arc::clone(&self.access);
        let shared = Shared { server: self, pages: Arc::new(Semaphore::new(PAGES)) };
        let router = Router::new()
            .route("/stream", get(stream))
            .fallback(get(file))
            .layer(middleware::from_fn_with_state(access, guard))
            .with_state(shared)
            .into_make_service_with_connect_info::<Place>();
        tokio::select! {
            result = axum::serve(limited, router) => result,
            () = ended(interrupt) => Ok(()),
        }
    }
}

/// Waits until a signal requests the end of the server.
async fn ended(interrupt: Interrupt) {
    while !interrupt.requested() {
        tokio::time::sleep(BETWEEN_LOOKS).await;
    }
}

/// Checks every request, and adds the headers that every response has.
async fn guard(
    State(access): State<Arc<Access>>,
    ConnectInfo(place): ConnectInfo<Place>,
    request: Request,
    next: Next,
) -> Response<Body> {
    place.header_arrived();
    let mut response = match access.check(request.headers()) {
        Ok(()) => next.run(request).await,
        Err(refusal) => refused(refusal),
    };
    let headers = response.headers_mut();
    for (name, value) in [
        (header::CONTENT_SECURITY_POLICY, POLICY),
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (header::REFERRER_POLICY, "no-referrer"),
        (header::HeaderName::from_static("cross-origin-opener-policy"), "same-origin"),
        (header::HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
    ] {
        headers.insert(name, HeaderValue::from_static(value));
    }
    if response.status() != StatusCode::SWITCHING_PROTOCOLS {
        // The connection ends with this response. A client that kept it open would take a place from other clients,
        // because the number of connections is limited.
        response.headers_mut().insert(header::CONNECTION, HeaderValue::from_static("close"));
    }
    response
}

async fn file(uri: Uri, headers: HeaderMap) -> Response<Body> {
    files::response(uri.path(), &headers)
}

async fn stream(
    State(shared): State<Shared>,
    ConnectInfo(place): ConnectInfo<Place>,
    Query(credentials): Query<Credentials>,
    upgrade: WebSocketUpgrade,
) -> Response<Body> {
    if let Err(refusal) = shared.server.access.check_token(credentials.token.as_deref()) {
        return refused(refusal);
    }
    let Ok(permit) = shared.pages.try_acquire_owned() else {
        return files::status(StatusCode::SERVICE_UNAVAILABLE, "Too many pages are open: close one of them.\n");
    };
    let Server { hub, control, .. } = shared.server;
    upgrade.max_message_size(LARGEST_MESSAGE).max_frame_size(LARGEST_MESSAGE).on_upgrade(async move |socket| {
        place.leave();
        Session::new(socket, hub, control).run().await;
        drop(permit);
    })
}

fn refused(refusal: Refusal) -> Response<Body> {
    let code = match refusal {
        Refusal::Host => StatusCode::MISDIRECTED_REQUEST,
        Refusal::Origin | Refusal::Token => StatusCode::FORBIDDEN,
    };
    files::status(code, refusal.text())
}
