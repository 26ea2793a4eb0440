//! The error that a planner receives if the library of remote hands, the server or the table `[remote]` is missing or
//! wrong.

mod rig;

use rig::{Loading, Way, remote};
use std::fs;

/// Splits what `opens.c` prints into the result of OpenHand, the errno and the error text.
fn opened(said: &str) -> (i32, i32, String) {
    let mut words = said.trim_end().splitn(3, ' ');
    let mut number = || words.next().expect("a number").parse().expect("a number");
    let (result, errno) = (number(), number());
    (result, errno, words.next().unwrap_or_default().to_owned())
}

/// A port at which nothing listens.
const NOBODY: &str = "tcp/127.0.0.1:9";

#[test]
fn a_missing_library_is_named_with_the_remedy() {
    let loading = Loading::new(&remote(NOBODY));
    fs::remove_file(loading.place("library/sun2xp-remote/libsun2xp_remote.so.0")).expect("it was there");
    let (result, errno, text) = opened(&loading.said("opens.c", Way::Configured));
    assert_eq!((result, errno), (-1, libc::ELIBACC), "{text}");
    assert!(text.contains("libsun2xp_remote.so.0") && text.contains("make install-remote"), "{text}");
}

#[test]
fn a_library_of_another_version_is_refused() {
    let loading = Loading::new(&remote(NOBODY));
    loading.replace_library("unsigned sun2xp_abi_version(void) { return 0; }\n");
    let (result, errno, text) = opened(&loading.said("opens.c", Way::Configured));
    assert_eq!((result, errno), (-1, libc::ELIBBAD), "{text}");
    assert!(text.contains("from the same version"), "{text}");
}

#[test]
fn a_server_that_is_not_there_is_reported_as_not_connected() {
    let loading = Loading::new(&remote(NOBODY));
    for way in [Way::Configured, Way::Path] {
        let (result, errno, text) = opened(&loading.said("opens.c", way));
        assert_eq!((result, errno), (-1, libc::ENOTCONN), "{way:?} {text}");
        assert!(text.starts_with("OpenHand: ") && text.contains("127.0.0.1:9"), "{way:?} {text}");
    }
}

#[test]
fn the_remote_library_opens_no_hand_of_this_machine() {
    let loading = Loading::new("[finger]\nport = \"simulated\"\n");
    let (result, errno, text) = opened(&loading.said("opens.c", Way::Path));
    assert_eq!((result, errno), (-1, libc::EINVAL), "{text}");
    assert!(text.contains("[remote]") && text.contains("endpoint"), "{text}");
}

#[test]
fn a_key_that_is_wrong_is_named() {
    let loading = Loading::new(&format!("{}stale = 3\n", remote(NOBODY)));
    let (result, errno, text) = opened(&loading.said("opens.c", Way::Configured));
    assert_eq!((result, errno), (-1, libc::EINVAL), "{text}");
    assert!(text.contains("stale"), "{text}");
}
