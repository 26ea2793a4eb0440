//! If several things are wrong with a call, the call must report the errno that its entry in the manual lists before
//! the others.

use super::c::board::Board;
use super::c::{Bench, STRICT, c_compiler, said};
use super::manual::Manual;
use std::collections::BTreeMap;
use std::process::Command;

/// Errnos that tests/c/order.c cannot try, because they cannot occur together with the other errnos. Most of them come
/// from boards, from the system, from calibrations and recoveries in progress, or from calls in callbacks.
const NOT_TRIED: &[(&str, &[&str])] = &[
    ("OpenHand", &["EACCES", "EIO", "ETIMEDOUT", "EPERM", "ENOMEM"]),
    ("CloseHand", &["EBUSY"]),
    ("sun2xp_send_group", &["EBUSY"]),
    ("sun2xp_on_event", &["EAGAIN"]),
    ("sun2xp_event_descriptor", &["EMFILE", "ENFILE", "EAGAIN"]),
    ("sun2xp_wait", &["EBUSY", "ETIMEDOUT"]),
    ("sun2xp_send_path", &["ENOMEM", "EBUSY", "EAGAIN"]),
    ("sun2xp_zero", &["EBUSY", "ECANCELED", "ETIMEDOUT", "EACCES", "ENOSPC"]),
    ("sun2xp_recover", &["EIO", "ENOENT", "EACCES", "ETIMEDOUT"]),
    ("sun2xp_write_black_box", &["EACCES", "ENOSPC"]),
    ("sun2xp_open", &["EPERM", "ENOMEM", "EACCES", "EIO", "ETIMEDOUT", "EINVAL", "EBUSY", "EMFILE"]),
    ("sun2xp_open_io", &["ENOMEM", "EMFILE", "EACCES"]),
    ("sun2xp_close", &["EBUSY"]),
    ("sun2xp_set_log", &["EBUSY"]),
];

#[test]
fn calls_report_the_first_refusal_of_their_entries() {
    let manuals = Manual::both();
    let bench = Bench::new();
    let _board = Board::start(&bench);
    let program = bench.build(c_compiler(), &[STRICT, &["-std=c99"]].concat(), &["order.c"]);
    let run = bench.run(Command::new(&program));
    assert!(run.status.success(), "{}", said(&run));
    let mut reported = BTreeMap::<&str, Vec<&str>>::new();
    let lines = str::from_utf8(&run.stdout).expect("errnos");
    for (call, errno) in lines.lines().filter_map(|line| line.split_once(' ')) {
        reported.entry(call).or_default().push(errno);
    }
    for entry in manuals.iter().flat_map(|manual| &manual.entries).filter(|entry| !entry.errnos().is_empty()) {
        let mut listed = entry.errnos().into_iter();
        assert_eq!(listed.next(), Some("EPERM"), "{}: a forked child gets this errno first", entry.call);
        let reported = reported.remove(entry.call.as_str()).unwrap_or_default();
        for (index, errno) in reported.iter().enumerate() {
            // Several reasons may share a line of the list.
            let again = index > 0 && reported[index - 1] == *errno;
            let next = again || listed.any(|listed| listed == *errno);
            assert!(next, "{} reported {reported:?}, against its entry:\n{}", entry.call, entry.text);
        }
        let untried = NOT_TRIED.iter().find(|(call, _)| *call == entry.call).map_or(&[][..], |(_, errnos)| errnos);
        let forgotten =
            entry.errnos().into_iter().skip(1).find(|errno| !reported.contains(errno) && !untried.contains(errno));
        assert_eq!(
            forgotten, None,
            "tests/c/order.c should try this refusal of {}. If it cannot occur with the others, add it to NOT_TRIED",
            entry.call
        );
    }
    assert!(reported.is_empty(), "calls without a list of refusals: {reported:?}");
}
