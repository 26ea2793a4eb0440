//! Tests telemetry against processes that violate its protocol, and against processes of other users.

use crate::raw::RawSocket;
use crate::support::{name, open, read_for, reader};
use crate::tools;
use std::ptr::null_mut;
use std::time::Duration;
use sun2xp::telemetry::{AttachError, Reader};

/// What a reader sends first.
const REQUEST: &[u8] = b"sun2xp telemetry 1";

/// The user `nobody`.
const NOBODY: u32 = 65534;

/// Largest number of readers of a hand.
const MOST_READERS: usize = 16;

fn own_user() -> u32 {
    // SAFETY: the call takes no argument and cannot fail.
    unsafe { libc::geteuid() }
}

fn socket_name(hand: &str) -> String {
    format!("sun2xp/{}/{hand}", own_user())
}

/// Runs `act` in a thread of another user. The other threads of the process keep their user, because the system call
/// concerns one thread, unlike the function of the C library.
fn as_nobody<T: Send + 'static>(act: impl FnOnce() -> T + Send + 'static) -> Option<T> {
    if own_user() != 0 {
        tools::skip("another user", "the test does not run as root");
        return None;
    }
    let thread = std::thread::spawn(move || {
        // SAFETY: the call takes numbers only.
        let refused = unsafe { libc::syscall(libc::SYS_setresuid, NOBODY, NOBODY, NOBODY) };
        assert_eq!(refused, 0, "{}", std::io::Error::last_os_error());
        act()
    });
    Some(thread.join().expect("no panic"))
}

#[test]
fn the_memory_cannot_be_written() {
    let name = name("sealed");
    let hand = open(&name);
    let socket = RawSocket::connect(&socket_name(&name)).expect("connected");
    socket.send(REQUEST).expect("sent");
    let (_, file) = socket.receive(Duration::from_secs(5));
    let file = file.expect("the memory file");
    let bytes = file.metadata().expect("a file").len();
    let map = |protection| {
        use std::os::fd::AsRawFd;
        // SAFETY: the mapping is new. It is never accessed.
        let place =
            unsafe { libc::mmap(null_mut(), bytes as usize, protection, libc::MAP_SHARED, file.as_raw_fd(), 0) };
        place != libc::MAP_FAILED
    };
    assert!(map(libc::PROT_READ));
    assert!(!map(libc::PROT_READ | libc::PROT_WRITE), "the memory can be mapped for writing");
    use std::os::unix::fs::FileExt;
    assert!(file.write_at(b"x", 100).is_err(), "the memory can be written");
    assert!(file.set_len(10).is_err() && file.set_len(2 * bytes).is_err(), "the memory can change its size");
    drop(hand);
}

#[test]
fn another_version_is_refused_with_a_remedy() {
    let name = name("version");
    let hand = open(&name);
    let socket = RawSocket::connect(&socket_name(&name)).expect("connected");
    socket.send(b"sun2xp telemetry 7").expect("sent");
    let (answer, file) = socket.receive(Duration::from_secs(5));
    let text = String::from_utf8_lossy(&answer);
    assert!(file.is_none() && text.contains("use the sun2xp program of the same version"), "{text}");
    drop(hand);
}

#[test]
fn silent_and_noisy_connections_do_not_keep_readers_out() {
    let name = name("crowd");
    let hand = open(&name);
    let mut attached = reader(&name);
    // These connections send nothing, so they are dropped after two seconds.
    let silent: Vec<RawSocket> =
        (0..MOST_READERS).filter_map(|_| RawSocket::connect(&socket_name(&name)).ok()).collect();
    assert!(!silent.is_empty());
    let noisy = RawSocket::connect(&socket_name(&name));
    let mut messages = Vec::new();
    read_for(&mut attached, Duration::from_millis(2500), &mut messages);
    if let Ok(noisy) = noisy {
        for _ in 0..1000 {
            let _ = noisy.send(&[7; 1000]);
        }
    }
    let mut late = reader(&name);
    read_for(&mut late, Duration::from_millis(300), &mut messages);
    read_for(&mut attached, Duration::from_millis(300), &mut messages);
    assert_eq!((attached.lost(), late.lost()), ([0; 3], [0; 3]));
    // A hand has a limited number of readers.
    let more: Vec<_> = (0..MOST_READERS).map(|_| Reader::attach(Some(&name))).collect();
    let refused = more.iter().filter(|result| matches!(result, Err(AttachError::Refused { .. }))).count();
    assert_eq!(refused, 2, "two readers were attached before");
    drop(silent);
    drop(hand);
}

#[test]
fn a_reader_of_another_user_gets_nothing() {
    let name = name("owner");
    let hand = open(&name);
    let socket = socket_name(&name);
    let answer = as_nobody(move || {
        let socket = RawSocket::connect(&socket)?;
        // The hand may have closed the connection before the request.
        let _ = socket.send(REQUEST);
        let (answer, file) = socket.receive(Duration::from_secs(5));
        Ok::<_, std::io::Error>((answer, file.is_some()))
    });
    if let Some(answer) = answer {
        let (answer, file) = answer.expect("connected");
        assert!(!file && answer.is_empty(), "{answer:?}");
    }
    // The user's own readers are served as before.
    read_for(&mut reader(&name), Duration::from_millis(200), &mut Vec::new());
    drop(hand);
}

#[test]
fn a_hand_of_another_user_is_not_believed() {
    let name = name("impostor");
    let socket = socket_name(&name);
    let Some(_impostor) = as_nobody(move || RawSocket::listen(&socket).expect("a name")) else { return };
    assert!(matches!(Reader::attach(Some(&name)), Err(AttachError::Foreign(found)) if found == name));
    assert!(!sun2xp::telemetry::hands().expect("names").contains(&name));
    // The hand gets the next name.
    let hand = open(&name);
    assert_eq!(reader(&format!("{name}-2")).description().process, std::process::id());
    drop(hand);
}
