//! The names of hands and of their sockets.

use super::socket::{Socket, own_user};
use std::collections::BTreeSet;
use std::fs;
use std::io;

/// The table of all Unix sockets. Abstract names begin with @ there.
const SOCKETS: &str = "/proc/net/unix";

/// The flags of a listening socket in the table [`SOCKETS`].
const LISTENS: &str = "00010000";

/// Largest number of hands of one user with the same name.
const MOST_HANDS: u32 = 99;

/// Returns the abstract name of the socket of a hand of this user.
pub(super) fn socket_name(hand: &str) -> String {
    format!("{}{hand}", prefix())
}

fn prefix() -> String {
    format!("sun2xp/{}/", own_user())
}

/// Listens at the name, or, if another hand has it, at the name with a number. Returns the socket and the name.
///
/// # Errors
/// Returns `AddrInUse` if all numbers are in use.
pub(super) fn listen(name: &str) -> io::Result<(Socket, String)> {
    let numbered = (2..=MOST_HANDS).map(|number| format!("{name}-{number}"));
    for candidate in [name.to_owned()].into_iter().chain(numbered) {
        match Socket::listen(&socket_name(&candidate)) {
            Err(error) if error.kind() == io::ErrorKind::AddrInUse => {}
            result => return result.map(|socket| (socket, candidate)),
        }
    }
    let reason = format!("{MOST_HANDS} open hands have the name {name}: set another telemetry.name, or close a hand");
    Err(io::Error::new(io::ErrorKind::AddrInUse, reason))
}

/// Returns the names of the open hands of this user whose telemetry is enabled, in alphabetical order.
///
/// # Errors
/// Returns an error if the system's table of sockets cannot be read.
pub fn hands() -> io::Result<Vec<String>> {
    // Other programs may use names that are not UTF-8.
    let names = listed(&String::from_utf8_lossy(&fs::read(SOCKETS)?), &prefix());
    Ok(names.into_iter().filter(|name| is_open(name)).collect())
}

/// Returns the names of those listening sockets in the table whose names begin with `prefix`. The prefix is removed.
fn listed(table: &str, prefix: &str) -> BTreeSet<String> {
    let name = |line: &str| {
        let columns: Vec<&str> = line.split_whitespace().collect();
        let path = columns.get(7)?.strip_prefix('@')?;
        let hand = path.strip_prefix(prefix)?;
        (columns[3] == LISTENS).then(|| hand.to_owned())
    };
    table.lines().filter_map(name).collect()
}

/// Returns whether a living process of this user listens. This must be checked, because a forked child may keep the
/// socket of a hand open after the process of the hand has ended.
fn is_open(name: &str) -> bool {
    match Socket::connect(&socket_name(name)) {
        Ok(socket) => socket.peer().is_ok_and(|peer| peer.user == own_user() && is_alive(peer.process)),
        // The queue of connections is full, because the hand has not accepted the earlier ones yet.
        Err(error) => error.kind() == io::ErrorKind::WouldBlock,
    }
}

#[allow(unsafe_code, reason = "a system call")]
fn is_alive(process: i32) -> bool {
    // A process in another namespace has the number 0 here.
    // SAFETY: signal 0 is not sent. The call only checks whether the process exists.
    process == 0 || unsafe { libc::kill(process, 0) } == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_sockets_of_hands_that_listen_are_listed() {
        let table = "Num       RefCount Protocol Flags    Type St Inode Path\n\
            0000000000000000: 00000002 00000000 00010000 0005 01 1 @sun2xp/7/left\n\
            0000000000000000: 00000003 00000000 00000000 0005 03 2 @sun2xp/7/right\n\
            0000000000000000: 00000002 00000000 00010000 0005 01 3 @sun2xp/77/hand\n\
            0000000000000000: 00000002 00000000 00010000 0001 01 4 /run/sun2xp/7/hand\n\
            0000000000000000: 00000002 00000000 00010000 0001 01 5\n";
        assert_eq!(listed(table, "sun2xp/7/"), ["left".to_owned()].into());
        assert!(listed("@sun2xp/7/x", "sun2xp/7/").is_empty());
    }

    #[test]
    fn a_name_of_which_no_number_is_free_is_refused_with_the_remedy() {
        let name = format!("crowded-{}", std::process::id());
        let _taken: Vec<_> = (0..MOST_HANDS).map(|_| listen(&name).expect("a free number")).collect();
        let refused = listen(&name).err().expect("no free number");
        assert_eq!(refused.kind(), io::ErrorKind::AddrInUse);
        assert!(refused.to_string().contains("set another telemetry.name"), "{refused}");
    }
}
