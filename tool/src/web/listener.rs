//! The listening socket: a limited number of connections, and none that stays silent or slow.

use super::place::{HEADER, Place};
use axum::extract::connect_info::Connected;
use axum::serve::{IncomingStream, Listener};
use std::future::Future;
use std::io::{self, ErrorKind};
use std::net::SocketAddr;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};
use tokio::time::{Instant, Sleep, sleep};

/// Largest number of connections that are not the WebSocket of a page. A browser opens up to six connections to load
/// the files of a page. Each of them is closed after its answer. A further connection becomes the WebSocket.
const CONNECTIONS: usize = 64;

/// A connection that sends nothing for this time is closed. The server pings each WebSocket more often than this, and
/// browsers answer every ping.
pub const SILENCE: Duration = Duration::from_secs(30);

/// Time after which the listener tries again if it cannot accept a connection, for example because the system has no
/// more file descriptors.
const RETRY: Duration = Duration::from_millis(100);

/// A listener that limits the number of open connections that are not the WebSocket of a page. A further connection
/// waits until another one is closed or becomes such a WebSocket.
pub struct Limited {
    listener: TcpListener,
    free: Arc<Semaphore>,
}

/// A connection.
pub struct Connection {
    stream: TcpStream,
    silence: Pin<Box<Sleep>>,
    /// The end of the time for the header, and then of the time for the answer.
    deadline: Pin<Box<Sleep>>,
    accepted: Instant,
    place: Place,
}

impl Connected<IncomingStream<'_, Limited>> for Place {
    fn connect_info(stream: IncomingStream<'_, Limited>) -> Self {
        stream.io().place.clone()
    }
}

impl Connection {
    fn new(stream: TcpStream, permit: OwnedSemaphorePermit) -> Self {
        let (silence, deadline) = (Box::pin(sleep(SILENCE)), Box::pin(sleep(HEADER)));
        let place = Place::new(permit);
        Self { stream, silence, deadline, accepted: Instant::now(), place }
    }

    /// Returns whether the time for the header or the answer is over. If this time is not over, the task is woken at
    /// its end.
    fn late(&mut self, context: &mut Context) -> bool {
        while self.deadline.as_mut().poll(context).is_ready() {
            let Some(time) = self.place.time() else { return false };
            let end = self.accepted + time;
            if end <= Instant::now() {
                return true;
            }
            self.deadline.as_mut().reset(end);
        }
        false
    }

    /// Returns the result. For a late connection, a pending result becomes a time-out error.
    fn in_time<T>(&mut self, result: Poll<io::Result<T>>, context: &mut Context) -> Poll<io::Result<T>> {
        if result.is_pending() && self.late(context) { Poll::Ready(Err(ErrorKind::TimedOut.into())) } else { result }
    }
}

impl Limited {
    /// Limits the connections of a listener.
    pub fn new(listener: TcpListener) -> Self {
        Self { listener, free: Arc::new(Semaphore::new(CONNECTIONS)) }
    }

    async fn next(&self) -> io::Result<(Connection, SocketAddr)> {
        let permit = Arc::clone(&self.free).acquire_owned().await.map_err(io::Error::other)?;
        let (stream, peer) = self.listener.accept().await?;
        // A page gets its samples in small batches. The kernel must not delay them to collect more bytes.
        stream.set_nodelay(true)?;
        Ok((Connection::new(stream, permit), peer))
    }
}

impl Listener for Limited {
    type Io = Connection;
    type Addr = SocketAddr;

    async fn accept(&mut self) -> (Connection, SocketAddr) {
        loop {
            match self.next().await {
                Ok(accepted) => return accepted,
                // Only this connection has failed. The next one may be waiting.
                Err(error) if matches!(error.kind(), ErrorKind::ConnectionAborted | ErrorKind::ConnectionReset) => {}
                Err(_) => sleep(RETRY).await,
            }
        }
    }

    fn local_addr(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }
}

impl AsyncRead for Connection {
    fn poll_read(mut self: Pin<&mut Self>, context: &mut Context, buffer: &mut ReadBuf) -> Poll<io::Result<()>> {
        match Pin::new(&mut self.stream).poll_read(context, buffer) {
            Poll::Pending if self.silence.as_mut().poll(context).is_ready() => {
                Poll::Ready(Err(ErrorKind::TimedOut.into()))
            }
            Poll::Ready(result) => {
                self.silence.as_mut().reset(Instant::now() + SILENCE);
                Poll::Ready(result)
            }
            Poll::Pending => self.in_time(Poll::Pending, context),
        }
    }
}

impl AsyncWrite for Connection {
    fn poll_write(mut self: Pin<&mut Self>, context: &mut Context, bytes: &[u8]) -> Poll<io::Result<usize>> {
        let result = Pin::new(&mut self.stream).poll_write(context, bytes);
        self.in_time(result, context)
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context) -> Poll<io::Result<()>> {
        let result = Pin::new(&mut self.stream).poll_flush(context);
        self.in_time(result, context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context) -> Poll<io::Result<()>> {
        let result = Pin::new(&mut self.stream).poll_shutdown(context);
        self.in_time(result, context)
    }
}
