//! Requests that the server refuses. These tests need no open hand, so the program waits for one.

use super::http::{connect, get, request, write_request};
use super::program::Program;
use super::socket::{Frame, Socket};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};
use std::io::{Read, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use std::{panic, thread};

/// A program that waits for a hand.
fn waiting() -> Program {
    Program::monitor("nobody")
}

#[test]
fn the_files_of_the_page_have_the_headers_that_protect_it() {
    let program = waiting();
    let host = program.address().to_string();
    let page = get(program.address(), "/", &[("Host", &host)]);
    assert_eq!(page.status, 200);
    let policy = page.header("content-security-policy").expect("a policy");
    for part in ["default-src 'none'", "script-src 'self'", "connect-src 'self'", "frame-ancestors 'none'"] {
        assert!(policy.contains(part), "{policy}");
    }
    assert_eq!(page.header("cache-control"), Some("no-cache"));
    assert_eq!(page.header("x-content-type-options"), Some("nosniff"));
    assert_eq!(page.header("cross-origin-resource-policy"), Some("same-origin"));
    assert!(String::from_utf8_lossy(&page.body).starts_with("<!DOCTYPE html>"));
    let tag = page.header("etag").expect("a tag");
    assert_eq!(get(program.address(), "/", &[("Host", &host), ("If-None-Match", tag)]).status, 304);
    for path in ["/nothing", "/../Cargo.toml", "/vendor/", "//etc/passwd", "/%2e%2e/Cargo.toml"] {
        assert_eq!(get(program.address(), path, &[("Host", &host)]).status, 404, "{path}");
    }
    assert_eq!(request(program.address(), "POST", "/", &[("Host", &host)], "x").status, 405);
}

#[test]
fn foreign_hosts_and_origins_get_nothing() {
    let program = waiting();
    let address = program.address();
    let own = address.to_string();
    for host in ["evil.example", "evil.example:80", &format!("evil.example:{}", address.port()), ""] {
        assert_eq!(get(address, "/", &[("Host", host)]).status, 421, "{host}");
        assert_eq!(Socket::open(address, "/stream", &[("Host", host)]).err(), Some(421), "{host}");
    }
    for origin in ["http://evil.example", "null", "https://127.0.0.1", "http://localhost:1"] {
        let headers = [("Host", own.as_str()), ("Origin", origin)];
        assert_eq!(get(address, "/", &headers).status, 403, "{origin}");
        assert_eq!(Socket::open(address, "/stream", &headers[1..]).err(), Some(403), "{origin}");
    }
    let same = format!("http://{own}");
    assert!(Socket::open(address, "/stream", &[("Origin", &same)]).is_ok());
    assert!(Socket::open(address, "/stream", &[]).is_ok());
}

#[test]
fn a_page_beyond_loopback_has_a_token() {
    let program = Program::start(&["monitor", "nobody", "--web", "--bind", "0.0.0.0"]);
    let address = program.address();
    let token = program.token().expect("the address has a token").to_owned();
    for wrong in ["/stream".to_owned(), "/stream?token=".into(), format!("/stream?token={}0", &token[1..])] {
        assert_eq!(Socket::open(address, &wrong, &[]).err(), Some(403), "{wrong}");
    }
    assert!(Socket::open(address, &format!("/stream?token={token}"), &[]).is_ok());
    let origin = [("Origin", "http://evil.example")];
    assert_eq!(Socket::open(address, &format!("/stream?token={token}"), &origin).err(), Some(403));
    assert!(waiting().token().is_none(), "the page on loopback needs none");
}

#[test]
fn a_message_that_is_too_long_ends_the_connection() {
    let program = waiting();
    let mut socket = Socket::open(program.address(), "/stream", &[]).expect("a socket");
    assert!(matches!(socket.next(), Frame::Text(_)), "the first message says why there is no hand");
    socket.send(&"x".repeat(20_000));
    assert!(matches!(socket.next(), Frame::Close(..) | Frame::End));
    assert!(Socket::open(program.address(), "/stream", &[]).is_ok(), "the server serves others");
}

#[test]
fn a_page_that_only_shows_takes_no_commands() {
    let program = waiting();
    let closed = |message: &str| {
        let mut socket = Socket::open(program.address(), "/stream", &[]).expect("a socket");
        assert!(matches!(socket.next(), Frame::Text(_)), "the first message says why there is no hand");
        socket.send(message);
        match socket.next() {
            Frame::Close(code, reason) => (code, reason),
            other => panic!("{message}: {other:?}"),
        }
    };
    for command in [
        r#"{"command":"stop"}"#,
        r#"{"command":"open"}"#,
        r#"{"command":"push","finger":1,"force":[0,0,1]}"#,
        r#"{"command":"joints","finger":1,"joints":[0,0.5,0.5]}"#,
    ] {
        assert_eq!(closed(command), (1008, "a command, but sun2xp runs without --control".into()), "{command}");
    }
    for nonsense in ["", "{", "[]", "null", r#"{"command":"explode"}"#, r#"{"received":-1}"#, r#"{"received":1,"x":2}"#]
    {
        assert_eq!(closed(nonsense).0, 1008, "{nonsense}");
    }
}

#[test]
fn random_bytes_at_the_port_end_only_their_own_connection() {
    let program = waiting();
    let mut random = Pcg64Mcg::seed_from_u64(0x5eb);
    for _ in 0..200 {
        let mut stream = connect(program.address());
        let mut bytes = vec![0; 1 + random.next_u32() as usize % 3000];
        random.fill_bytes(&mut bytes);
        // The server may close the connection before it has read all bytes.
        let _ = stream.write_all(&bytes);
        let _ = stream.shutdown(std::net::Shutdown::Write);
        let _ = stream.read_to_end(&mut Vec::new());
    }
    let mut socket = Socket::open(program.address(), "/stream", &[]).expect("a socket");
    assert!(matches!(socket.next(), Frame::Text(_)), "the first message says why there is no hand");
    for _ in 0..50 {
        let mut bytes = vec![0; 200];
        random.fill_bytes(&mut bytes);
        let text: String = bytes.iter().map(|byte| char::from(byte % 96 + 32)).collect();
        let mut socket = Socket::open(program.address(), "/stream", &[]).expect("a socket");
        socket.send(&text);
    }
    assert!(Socket::open(program.address(), "/stream", &[]).is_ok());
}

#[test]
fn the_number_of_pages_is_limited() {
    let program = waiting();
    let open = || Socket::open(program.address(), "/stream", &[]);
    let pages: Vec<_> = (0..16).map(|_| open().expect("a socket")).collect();
    assert_eq!(open().err(), Some(503));
    drop(pages);
    assert!((0..1000).any(|_| open().is_ok()), "the places of pages that have left are free again");
}

#[test]
fn connections_that_never_complete_their_header_leave_room_for_pages() {
    let program = waiting();
    let mut slow: Vec<_> = (0..64).map(|_| connect(program.address())).collect();
    for stream in &mut slow {
        stream.write_all(b"GET / HTTP/1.1\r\nX: ").expect("the server reads");
    }
    let done = AtomicBool::new(false);
    thread::scope(|scope| {
        scope.spawn(|| {
            while !done.load(Ordering::Relaxed) {
                thread::sleep(Duration::from_millis(500));
                // The server closes the connections, so a write may fail.
                slow.iter_mut().for_each(|stream| drop(stream.write_all(b"x")));
            }
        });
        let page = panic::catch_unwind(|| Socket::open(program.address(), "/stream", &[]).is_ok());
        done.store(true, Ordering::Relaxed);
        assert!(page.is_ok_and(|opened| opened), "a page opens while other connections are slow");
    });
}

#[test]
fn a_connection_has_one_request() {
    let program = waiting();
    let host = program.address().to_string();
    let mut stream = connect(program.address());
    write_request(&mut stream, "GET", "/", &[("Host", &host)], "");
    let mut all = Vec::new();
    stream.read_to_end(&mut all).expect("the server closes the connection after its answer");
    assert!(String::from_utf8_lossy(&all).starts_with("HTTP/1.1 200"));
}

#[test]
fn wrong_addresses_are_errors_with_a_reason() {
    let run = |arguments: &[&str]| {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_sun2xp"));
        let output = command.args(arguments).output().expect("the program runs");
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    let (code, text) = run(&["monitor", "--web", "--bind", "192.0.2.1"]);
    assert_eq!(code, Some(1));
    assert!(text.contains("cannot serve at 192.0.2.1"), "{text}");
    assert_eq!(run(&["monitor", "--web", "--bind", "example"]).0, Some(2));
    assert_eq!(run(&["monitor", "--port", "8080"]).0, Some(2), "a port needs --web");
    let taken = waiting();
    let port = taken.address().port().to_string();
    assert!(run(&["monitor", "--web", "--port", &port]).1.contains("cannot serve at 127.0.0.1"));
}
