//! A black box is written to a temporary file, which then replaces the target in one step.

use crate::recorded::recorded;
use std::fs;
use std::io;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;
use std::process::Command;
use sun2xp::finger::Recording;

fn names(folder: &Path) -> Vec<String> {
    let name = |entry: io::Result<fs::DirEntry>| entry.expect("an entry").file_name().to_string_lossy().into_owned();
    fs::read_dir(folder).expect("a folder").map(name).collect()
}

/// Environment variable with the file that the second process replaces.
const FILE: &str = "SUN2XP_TEST_FILE";

#[test]
fn a_full_disk_leaves_the_old_file() {
    if let Some(file) = std::env::var_os(FILE) {
        // This is the second process. It can write at most 16 KiB into a file.
        let error = recorded().opening.save(Path::new(&file)).expect_err("too large");
        assert_eq!(error.raw_os_error(), Some(libc::EFBIG), "{error}");
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("finger-1.jsonl");
    recorded().opening.save(&file).expect("written");
    let before = fs::read(&file).expect("read");
    assert!(before.len() > 16 * 1024, "{}", before.len());
    // The shell ignores SIGXFSZ, because this signal would kill the process. A write beyond the limit then fails as on
    // a full disk. A block of a shell has 512 or 1024 bytes.
    let limited = "trap '' XFSZ; ulimit -f 16; exec \"$@\"";
    let test = "writing::a_full_disk_leaves_the_old_file";
    let run = Command::new("sh")
        .args(["-c", limited, "sh"])
        .arg(std::env::current_exe().expect("this program"))
        .args(["--exact", test])
        .env(FILE, &file)
        .output()
        .expect("run");
    let reported = String::from_utf8_lossy(&run.stdout);
    assert!(run.status.success() && reported.contains("1 passed"), "{reported}");
    assert!(fs::read(&file).expect("read") == before, "the old file has changed");
    assert_eq!(names(folder.path()), ["finger-1.jsonl"]);
}

#[test]
fn a_link_in_the_place_of_the_file_is_not_followed() {
    let folder = tempfile::tempdir().expect("a folder");
    let (victim, link) = (folder.path().join("victim"), folder.path().join("finger-1.jsonl"));
    fs::write(&victim, "precious").expect("written");
    symlink(&victim, &link).expect("made");
    let error = recorded().opening.save(&link).expect_err("refused").to_string();
    assert!(error.contains("a symbolic link"), "{error}");
    assert_eq!(fs::read_to_string(&victim).expect("read"), "precious");
    assert_eq!(names(folder.path()).len(), 2);
}

#[test]
fn an_old_file_is_replaced_with_its_permissions() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("finger-1.jsonl");
    fs::write(&file, "old").expect("written");
    fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).expect("set");
    let reader = fs::File::open(&file).expect("open");
    recorded().opening.save(&file).expect("written");
    assert_eq!(fs::metadata(&file).expect("there").permissions().mode() & 0o7777, 0o640);
    assert_eq!(Recording::open(&file).expect("a recording").cycles.len(), recorded().opening.cycles.len());
    // A reader that has opened the old file reads the old contents to the end.
    assert!(io::read_to_string(reader).expect("read") == "old", "the old file was written over");
    assert_eq!(names(folder.path()), ["finger-1.jsonl"]);
}
