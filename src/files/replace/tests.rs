//! Tests of the replacement of files.

use super::*;
use std::collections::BTreeSet;
use std::env;
use std::os::unix::fs::symlink;
use std::process::Command;
use tempfile::{TempDir, tempdir};

fn write(text: &'static str) -> impl FnOnce(&mut dyn Write) -> io::Result<()> {
    move |output| output.write_all(text.as_bytes())
}

fn folder() -> (TempDir, PathBuf) {
    let folder = tempdir().expect("a folder");
    let file = folder.path().join("file");
    (folder, file)
}

fn names(folder: &TempDir) -> Vec<String> {
    let entries = fs::read_dir(folder.path()).expect("a folder");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

fn mode(file: &Path) -> u32 {
    fs::metadata(file).expect("there").mode() & 0o7777
}

#[test]
fn a_file_is_created_or_replaced() {
    let (folder, file) = folder();
    for text in ["one", "another"] {
        replace_file(&file, write(text)).expect("written");
        assert_eq!(fs::read_to_string(&file).expect("read"), text);
        assert_eq!(names(&folder), ["file"]);
    }
}

#[test]
fn a_failed_write_changes_nothing_and_leaves_no_file() {
    let (folder, file) = folder();
    let fail = |output: &mut dyn Write| {
        output.write_all(b"the first half")?;
        Err(io::Error::from_raw_os_error(libc::ENOSPC))
    };
    assert_eq!(replace_file(&file, fail).expect_err("failed").raw_os_error(), Some(libc::ENOSPC));
    assert!(names(&folder).is_empty());
    fs::write(&file, "old").expect("written");
    assert_eq!(replace_file(&file, fail).expect_err("failed").raw_os_error(), Some(libc::ENOSPC));
    assert_eq!(fs::read_to_string(&file).expect("read"), "old");
    assert_eq!(names(&folder), ["file"]);
    create_file(folder.path(), ["file".into(), "other".into()], fail).expect_err("failed");
    assert_eq!(names(&folder), ["file"]);
}

#[test]
fn links_and_devices_are_refused() {
    let (folder, file) = folder();
    fs::write(folder.path().join("victim"), "precious").expect("written");
    symlink("victim", &file).expect("made");
    assert_eq!(replace_file(&file, write("new")).expect_err("refused").kind(), ErrorKind::InvalidInput);
    assert_eq!(fs::read_to_string(&file).expect("read"), "precious");
    for path in [Path::new("/dev/null"), folder.path()] {
        assert_eq!(replace_file(path, write("new")).expect_err("refused").kind(), ErrorKind::InvalidInput);
    }
    assert_eq!(names(&folder), ["file", "victim"]);
}

#[test]
fn permissions_are_inherited_without_special_bits() {
    let (_folder, file) = folder();
    fs::write(&file, "old").expect("written");
    for (before, after) in [(0o600, 0o600), (0o664, 0o664), (0o4750, 0o750)] {
        fs::set_permissions(&file, Permissions::from_mode(before)).expect("set");
        replace_file(&file, write("new")).expect("written");
        assert_eq!(mode(&file), after);
    }
}

#[test]
fn a_file_with_the_wanted_name_is_not_overwritten() {
    let (folder, file) = folder();
    fs::write(&file, "old").expect("written");
    symlink("nowhere", folder.path().join("link")).expect("made");
    let candidates = ["file", "link", "third"].map(String::from);
    let path = create_file(folder.path(), candidates.clone(), write("new")).expect("written");
    assert_eq!(path, folder.path().join("third"));
    assert_eq!(fs::read_to_string(&file).expect("read"), "old");
    let error = create_file(folder.path(), candidates, write("new")).expect_err("every name is taken");
    assert_eq!(error.kind(), ErrorKind::AlreadyExists);
    assert_eq!(names(&folder), ["file", "link", "third"]);
}

/// Environment variable of a process that only creates files. Its value is the folder of these files.
const CREATES_IN: &str = "SUN2XP_TEST_CREATES_IN";

/// Number of files that each process creates.
const CREATED: usize = 100;

/// Creates files under unpredictable names and returns the random part of each name.
fn create_in(folder: &Path) -> Vec<u64> {
    let create = || create_unpredictable(folder, 0o600).expect("made").0;
    iter::repeat_with(create).take(CREATED).map(|path| random_part(&path)).collect()
}

fn random_part(path: &Path) -> u64 {
    let name = path.file_name().and_then(|name| name.to_str()).expect("a text");
    let digits = name.strip_prefix(".sun2xp-").and_then(|name| name.strip_suffix(".new")).expect("a temporary name");
    assert_eq!(digits.len(), 16, "{name}");
    u64::from_str_radix(digits, 16).expect("hexadecimal digits")
}

/// Names made from a counter, the number of the process or the time would have bits that never change. A generator with
/// a constant seed would make the same names in every process.
#[test]
fn every_bit_of_a_temporary_name_is_random() {
    if let Some(folder) = env::var_os(CREATES_IN) {
        create_in(Path::new(&folder));
        return;
    }
    let (folder, _) = folder();
    let own = create_in(folder.path());
    let differing = own.iter().fold(0, |differing, bits| differing | bits ^ own[0]);
    // One of 64 random bits is the same in 100 names once in 2^93 runs.
    assert_eq!(!differing, 0, "these bits are the same in every name: {:x}", !differing);

    let (others, _) = self::folder();
    let mut another = Command::new(env::current_exe().expect("this program"));
    another.args(["--exact", "files::replace::tests::every_bit_of_a_temporary_name_is_random"]);
    let run = another.env(CREATES_IN, others.path()).output().expect("this program starts again");
    assert!(run.status.success(), "{run:?}");
    let of_another: BTreeSet<u64> = names(&others).iter().map(|name| random_part(Path::new(name))).collect();
    assert_eq!(of_another.len(), CREATED, "the other process did not run this test");
    assert!(own.iter().all(|bits| !of_another.contains(bits)), "{own:x?}\n{of_another:x?}");
}

/// An attacker who guesses a temporary name cannot make this process write another file.
#[test]
fn a_link_or_a_file_under_a_temporary_name_is_neither_followed_nor_written() {
    let (folder, _) = folder();
    let place = |name: &str| folder.path().join(name);
    for file in ["victim", "file"] {
        fs::write(place(file), "precious").expect("written");
    }
    symlink("victim", place("link")).expect("made");
    symlink("absent", place("dangling link")).expect("made");
    fs::hard_link(place("victim"), place("hard link")).expect("made");
    let taken = ["link", "dangling link", "hard link", "file"].map(String::from);
    let create = |names: &[String]| create_under_free_name(folder.path(), names.to_vec(), 0o600);

    let refused = create(&taken).expect_err("every name is taken");
    assert_eq!(refused.kind(), ErrorKind::AlreadyExists);
    let (path, mut file) = create(&[&taken[..], &["free".into()]].concat()).expect("the last name is free");
    assert_eq!(path, place("free"));
    file.write_all(b"new").expect("written");
    assert_eq!(fs::read_to_string(&path).expect("read"), "new");
    for file in ["victim", "link", "hard link", "file"] {
        assert_eq!(fs::read_to_string(place(file)).expect("read"), "precious", "{file}");
    }
    assert_eq!(names(&folder), ["dangling link", "file", "free", "hard link", "link", "victim"]);
}
