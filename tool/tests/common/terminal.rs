//! Runs the tool on a pseudo-terminal, as a person does.

use std::fs::File;
use std::io::Read;
use std::os::fd::{AsFd, FromRawFd};
use std::process::{Command, Stdio};
use std::ptr::null;

/// What a program has written on a terminal with this number of columns, and its exit status. Its standard error goes
/// to the terminal too if `errors` is true.
pub fn on_terminal(command: &mut Command, columns: u16, errors: bool) -> (String, Option<i32>) {
    let size = libc::winsize { ws_row: 40, ws_col: columns, ws_xpixel: 0, ws_ypixel: 0 };
    let (mut leader, mut follower) = (-1, -1);
    let name = std::ptr::null_mut();
    // SAFETY: the pointers are valid for the call. The name and the settings of the terminal are optional.
    let made = unsafe { libc::openpty(&mut leader, &mut follower, name, null(), &size) };
    assert_eq!(made, 0, "no pseudo-terminal: {}", std::io::Error::last_os_error());
    // SAFETY: openpty has opened both descriptors, and nothing else owns them.
    let (mut leader, follower) = unsafe { (File::from_raw_fd(leader), File::from_raw_fd(follower)) };
    let end = || Stdio::from(follower.as_fd().try_clone_to_owned().expect("a descriptor"));
    command.env("TERM", "xterm-256color").stdin(Stdio::null()).stdout(end());
    command.stderr(if errors { end() } else { Stdio::null() });
    let mut process = command.spawn().expect("the tool runs");
    // The reading below ends when no process has the terminal open. `command` still holds descriptors of the terminal,
    // so they are replaced, and `follower` is closed.
    command.stdout(Stdio::null()).stderr(Stdio::null());
    drop(follower);
    let mut written = Vec::new();
    // At the end of a pseudo-terminal, `read` returns the error EIO instead of 0 bytes.
    let _ = leader.read_to_end(&mut written);
    let status = process.wait().expect("the tool ends");
    (String::from_utf8(written).expect("text").replace("\r\n", "\n"), status.code())
}

/// The text without escape sequences.
#[allow(dead_code)]
pub fn bare(text: &str) -> String {
    let mut parts = text.split("\u{1b}[");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |bare, part| {
        bare + part.split_once(|end: char| end.is_ascii_alphabetic()).map_or("", |(_, rest)| rest)
    })
}
