//! The names of hands, and the errors for hands to which a reader cannot attach.

use crate::support::{OtherProcess, configuration, name, open, read_for, reader};
use std::os::linux::net::SocketAddrExt;
use std::os::unix::net::{SocketAddr, UnixListener};
use std::time::Duration;
use sun2xp::hand::Hand;
use sun2xp::telemetry::{AttachError, Reader, hands};

#[test]
fn hands_with_the_same_name_are_numbered() {
    let name = name("several");
    let first = open(&name);
    let second = open(&name);
    let other = OtherProcess::with_hand(&name);
    let numbered = [name.clone(), format!("{name}-2"), format!("{name}-3")];
    let open: Vec<String> = hands().expect("names").into_iter().filter(|found| found.starts_with(&name)).collect();
    assert_eq!(open, numbered);
    let mut readers = numbered.map(|name| reader(&name));
    for reader in &mut readers {
        read_for(reader, Duration::from_millis(100), &mut Vec::new());
    }
    assert_eq!(readers[1].description().name, format!("{name}-2"));
    assert_eq!(readers[2].description().process, other.child.id());
    // If no name is given, the user must choose among several hands.
    assert!(matches!(Reader::attach(None), Err(AttachError::Several(names)) if names.contains(&name)));
    drop((first, second));
    other.end();
    let error = Reader::attach(Some(&name)).err().expect("closed");
    assert!(matches!(&error, AttachError::Unknown { wanted, .. } if *wanted == name), "{error}");
}

#[test]
fn a_socket_of_another_program_whose_name_is_not_utf_8_hides_no_hand() {
    let name = name("beside");
    let hand = open(&name);
    let other = SocketAddr::from_abstract_name([&b"\xff"[..], name.as_bytes()].concat()).expect("a name");
    let _socket = UnixListener::bind_addr(&other).expect("a socket");
    assert!(hands().expect("names").contains(&name));
    drop(hand);
}

#[test]
fn a_table_of_sockets_that_cannot_be_read_has_a_remedy() {
    let text = AttachError::Names(std::io::ErrorKind::NotFound.into()).to_string();
    assert!(text.starts_with("cannot read the names of the open hands: ") && text.contains("Mount /proc"), "{text}");
}

#[test]
fn telemetry_can_be_turned_off() {
    let name = name("off");
    let mut configured = configuration(&name);
    configured.telemetry.enabled = false;
    let hand = Hand::open(configured).expect("open");
    assert!(!hands().expect("names").contains(&name));
    assert!(matches!(Reader::attach(Some(&name)), Err(AttachError::Unknown { .. })));
    drop(hand);
}
