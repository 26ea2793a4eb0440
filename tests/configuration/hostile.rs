//! Files that nobody writes by hand, or only by mistake. Each is either used as written or refused in one short line.

use crate::reading::{keys, read, usable, with_numbers, with_optional_keys};
use std::fmt::Write;
use std::time::{Duration, Instant};

/// Largest length of a reason, bytes. The longest reason contains a list of the keys of the largest table.
const LONGEST: usize = 400;

/// A little less than the size of the largest file that is read, bytes.
const LARGE: usize = (1 << 20) - 100;

/// Returns the line and the reason of a refusal. Checks that it was quick and that the reason suits a terminal.
fn refused(text: &str) -> (Option<usize>, String) {
    let start: String = text.chars().take(60).collect();
    let begun = Instant::now();
    let Err((line, reason)) = read(text) else { panic!("{start:?} was accepted") };
    assert!(begun.elapsed() < Duration::from_secs(10), "{start:?} took {:?}", begun.elapsed());
    assert!(reason.len() <= LONGEST, "{start:?} is refused with {} bytes", reason.len());
    assert!(!reason.contains(char::is_control), "{start:?}: {reason:?}");
    (line, reason)
}

#[test]
fn unusable_numbers_are_refused_in_every_key() {
    let mut tried = 0;
    let of_texts = |value: &str| value.starts_with(['"', 't', 'f']) || value.starts_with("[\"");
    for key in keys(&with_optional_keys()).iter().filter(|key| !of_texts(&key.value)) {
        for number in ["nan", "-nan", "inf", "-inf", "1e400", "-1e400", "99999999999999999999"] {
            let text = format!("\n[{}]\n{} = {}\n", key.table, key.name, with_numbers(&key.value, number));
            let (line, reason) = refused(&text);
            assert_eq!(line, Some(3), "{text}: {reason}");
            tried += 1;
        }
    }
    assert!(tried > 400, "only {tried} tried");
}

#[test]
fn a_duplicate_key_or_table_is_refused() {
    for text in [
        "[hand]\nrate = 1000\nrate = 1000\n",
        "[hand]\nrate = 1000\n\"rate\" = 1000\n",
        "[hand]\n[finger]\n[hand]\n",
        "[finger]\ntendon.minimum = 4\n[finger.tendon]\nmaximum = 50\n",
        "[finger.1]\nport = 'a'\n[finger.'1']\nport = 'b'\n",
    ] {
        assert_eq!(refused(text).1, "duplicate key", "{text}");
    }
}

#[test]
fn byte_order_marks_and_line_ends_of_editors_are_accepted() {
    for text in [
        "\u{feff}[hand]\nrate = 750\n",
        "[hand]\r\nrate = 750\r\n",
        "[hand]\nrate = 750",
        "\u{feff}\r\n[hand]\r\nrate=750",
    ] {
        assert_eq!(usable(text).hand.rate, 750.0, "{text:?}");
    }
    assert_eq!(refused("[hand]\r\n\r\nrat = 750\r\n").0, Some(3));
    // A byte order mark is valid only at the beginning of the file.
    assert_eq!(refused("[hand]\n\u{feff}rate = 750\n").0, Some(2));
    assert_eq!(refused("[hand]\rrate = 750\r").0, Some(1));
}

#[test]
fn other_encodings_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("sun2xp.toml");
    for (bytes, reason) in [
        (&b"[hand]\n# caf\xe9\nrate = 500\n"[..], "line 2 is not UTF-8 text"),
        (b"\xff\xfe[\0h\0a\0n\0d\0]\0", "line 1 is not UTF-8 text"),
        (b"[\0h\0a\0n\0d\0]\0\n\0", ":1: "),
    ] {
        std::fs::write(&file, bytes).expect("written");
        let refusal = sun2xp::hand::read_configuration(&file).expect_err("refused").to_string();
        assert!(refusal.contains(reason), "{refusal}");
    }
}

#[test]
fn no_nesting_depth_exhausts_the_stack() {
    let deep = |open: &str, close: &str| open.repeat(LARGE / 10) + &close.repeat(LARGE / 10);
    for (text, line) in [
        (format!("[hand]\nrate = {}", "[".repeat(LARGE)), Some(2)),
        (format!("[hand]\nrate = {}\n", deep("[", "]")), Some(2)),
        (format!("[hand]\nrate = {}\n", deep("{a=", "}")), Some(2)),
        (format!("[hand]\nrate = {}\n", deep("[{a=", "}]")), Some(2)),
        (format!("[hand]\nrate = {}{}\n", "[".repeat(79), "]".repeat(79)), Some(2)),
        (format!("[hand]\nrate{} = 1\n", ".a".repeat(LARGE / 2)), None),
        (format!("[finger{}]\n", ".a".repeat(LARGE / 2)), None),
        (format!("[finger{}]\n", ".a".repeat(78)), Some(1)),
        (format!("[finger{}]\nb = 1\n[finger.1{}]\nc = 1\n", ".a".repeat(78), ".a".repeat(77)), Some(3)),
    ] {
        // This stack is an eighth of the main thread's stack, and smaller than the stack of an ordinary thread.
        let thread = std::thread::Builder::new().stack_size(1 << 20).spawn(move || refused(&text));
        assert_eq!(thread.expect("a thread").join().expect("no overflow").0, line);
    }
}

#[test]
fn large_files_are_read_quickly() {
    let numbered = |format: fn(&mut String, usize)| {
        let mut text = String::new();
        (0..)
            .take_while(|&number| {
                format(&mut text, number);
                text.len() < LARGE - 100
            })
            .for_each(drop);
        text
    };
    let key = |text: &mut String, number| writeln!(text, "key{number} = 1").expect("text");
    let table = |text: &mut String, number| writeln!(text, "[finger.table{number}]").expect("text");
    for text in [
        numbered(key),
        format!("[finger]\n{}", numbered(key)),
        numbered(table),
        "[[finger]]\n".repeat(LARGE / 11),
        "=\n".repeat(LARGE / 2),
        "\"".repeat(LARGE),
        format!("[hand]\ngravity = [{}]\n", "1,".repeat(LARGE / 2)),
        format!("[hand]\nrate = {}\n", "9".repeat(LARGE)),
        format!("[hand]\nrate = 1e{}\n", "9".repeat(LARGE)),
    ] {
        refused(&text);
    }
    let comments = format!("[hand]\n{}rate = 750.{}\n", "# a comment\n".repeat(LARGE / 24), "0".repeat(LARGE / 2));
    assert_eq!(usable(&comments).hand.rate, 750.0);
}

#[test]
fn a_file_of_ten_megabytes_is_refused_by_its_size() {
    let file = tempfile::NamedTempFile::new().expect("a file");
    std::fs::write(file.path(), "# a comment\n".repeat(10_000_000 / 12)).expect("written");
    let refusal = sun2xp::hand::read_configuration(file.path()).expect_err("refused").to_string();
    assert!(refusal.contains("is larger than 1048576 bytes"), "{refusal}");
}

#[test]
fn texts_of_a_file_are_shown_shortened_and_escaped() {
    let hostile = "a\\n\\u001b[31mb".to_string() + &"c".repeat(LARGE / 2);
    for (text, line) in [
        (format!("\"{hostile}\" = 1\n"), 1),
        (format!("[\"{hostile}\"]\n"), 1),
        (format!("[hand]\n\"{hostile}\" = 1\n"), 2),
        (format!("[finger]\n\"{hostile}\" = 1\n"), 2),
        (format!("[finger.1.tendon]\n\"{hostile}\" = 1\n"), 2),
        (format!("[finger.{}]\n", "9".repeat(LARGE)), 1),
        (format!("[hand]\nclock = \"{hostile}\"\n"), 2),
        (format!("[hand]\nrate = \"{hostile}\"\n"), 2),
        (format!("[hand]\nrate = {{ \"{hostile}\" = 1 }}\n"), 2),
        (format!("[finger.3.simulation]\nsurface = {{ \"{hostile}\" = 1 }}\n"), 2),
        (format!("[finger]\nport = \"{hostile}\"\n"), 2),
        ("[finger]\nport = \"/dev/\\u001b[31m\"\n".into(), 2),
        ("[finger]\nport = \"/dev/tty\\u0000\"\n".into(), 2),
        (format!("[finger]\nport = '/{}'\n", "p".repeat(900)), 1),
        (format!("[hand]\nblack_box = \"{hostile}\"\n"), 2),
        (format!("[hand]\n{0} = 1\n{0} = 1\n", "k".repeat(LARGE / 2 - 10)), 3),
    ] {
        let (found, reason) = refused(&text);
        assert_eq!(found, Some(line), "{reason}");
    }
    let (_, reason) = refused("[hand]\n\"rate\\n\\u001b[31m\" = 1\n");
    assert!(reason.contains("unknown key `rate\\n\\u{1b}[31m`"), "{reason}");
}

#[test]
fn a_table_of_a_finger_that_does_not_exist_is_refused() {
    for (number, shown) in [("4", "4"), ("0", "0"), ("01", "01"), ("-1", "-1"), ("'2 '", "2 ")] {
        let (line, reason) = refused(&format!("[hand]\n[finger.{number}]\nport = '/dev/null'\n"));
        assert_eq!(line, Some(2));
        let known = format!("there is no finger {shown}: fingers are 1, 2 and 3");
        let unknown = format!("unknown key `{shown}`");
        assert!(reason == known || shown == "2 " && reason.contains(&unknown), "{reason}");
    }
}

/// A surface has several numbers with the same range, so the error names the part.
#[test]
fn a_wrong_surface_is_refused_with_the_key_of_its_wrong_part() {
    let wall = |point: &str, normal: &str, stiffness: &str| {
        format!("wall = {{ point = [4, {point}, 0], normal = [{normal}, 0, 0], stiffness = {stiffness} }}")
    };
    let ball = |centre: &str, radius: &str, stiffness: &str| {
        format!("ball = {{ centre = [0, {centre}, 6], radius = {radius}, stiffness = {stiffness} }}")
    };
    for (surface, key) in [
        (wall("2000", "1", "5"), "wall.point"),
        (wall("2", "0", "5"), "wall.normal"),
        (wall("2", "nan", "5"), "wall.normal"),
        (wall("2", "1", "-5"), "wall.stiffness"),
        (ball("-2000", "2", "5"), "ball.centre"),
        (ball("2", "0", "5"), "ball.radius"),
        (ball("2", "2", "1e6"), "ball.stiffness"),
    ] {
        let text = format!("[finger.3.simulation]\nsurface = {{ {surface} }}\n");
        let (line, reason) = read(&text).expect_err(&text);
        assert_eq!(line, Some(2), "{reason}");
        assert!(reason.contains(&format!("finger.3.simulation.surface.{key}")), "{text}: {reason}");
    }
}
