//! A program with more privileges than its caller ignores configurations of the caller.

#[allow(dead_code)]
#[path = "../../tests/common/tools.rs"]
mod tools;

use std::fs::{Permissions, copy, create_dir_all, set_permissions, write};
use std::os::unix::fs::{MetadataExt, PermissionsExt, chown};
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// A group that owns no files.
const NOBODY: u32 = 65534;

/// The file that such a program reads.
const SYSTEM_FILE: &str = "/etc/xdg/sun2xp/sun2xp.toml";

/// A copy of the tool that runs with another group than its caller. None if this user cannot make one.
fn setgid_tool() -> Option<(TempDir, PathBuf)> {
    // The folder is not in /tmp, which may be mounted nosuid.
    let folder = tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).expect("a folder");
    let tool = folder.path().join("sun2xp");
    copy(env!("CARGO_BIN_EXE_sun2xp"), &tool).expect("a copy");
    let Some(group) = another_group().filter(|&group| chown(&tool, None, Some(group)).is_ok()) else {
        tools::skip("setgid", "this user is in one group only, and so cannot make a program that is setgid");
        return None;
    };
    set_permissions(&tool, Permissions::from_mode(0o2755)).expect("still allowed");
    assert_eq!(tool.metadata().expect("there").gid(), group);
    Some((folder, tool))
}

/// A group that this process may give to a file and that is not its own.
fn another_group() -> Option<u32> {
    // SAFETY: these functions have no arguments and always succeed.
    let (user, own) = unsafe { (libc::geteuid(), libc::getegid()) };
    if user == 0 {
        return Some(NOBODY);
    }
    let mut groups = [0; 1024];
    // SAFETY: the array has as many places as the first argument says.
    let count = unsafe { libc::getgroups(groups.len() as libc::c_int, groups.as_mut_ptr()) };
    groups.iter().take(usize::try_from(count).ok()?).copied().find(|&group| group != own)
}

/// Runs the tool. Returns whether it used the rate of the caller's configuration, and its output.
fn rate(tool: &Path, folder: &Path, environment: &[(&str, &Path)]) -> (bool, String) {
    let mut command = Command::new(tool);
    command
        .args(["schedule", "--costs"])
        .arg(folder.join("costs.toml"))
        .current_dir(folder)
        .env_remove("SUN2XP_CONFIG");
    command.env("HOME", folder.join("nowhere")).env_remove("XDG_CONFIG_HOME").env_remove("XDG_CONFIG_DIRS");
    let run = command.envs(environment.iter().copied()).output().expect("the tool starts");
    let said = String::from_utf8_lossy(&[run.stdout, run.stderr].concat()).into_owned();
    (said.contains("777 Hz"), said)
}

#[test]
fn a_setgid_program_ignores_configurations_of_its_caller() {
    let Some((folder, tool)) = setgid_tool() else { return };
    let folder = folder.path();
    if Path::new(SYSTEM_FILE).exists() {
        tools::skip("the simulated hand", "this machine has a configuration of its own");
        return;
    }
    write(folder.join("costs.toml"), "wake_up = 1\nwrite = 1\nread = 1\ncompute = 1\n").expect("written");
    let text = "[hand]\nrate = 777\n";
    for name in ["named.toml", "home/.config/sun2xp/sun2xp.toml", "xdg/sun2xp/sun2xp.toml", "sun2xp.toml"] {
        let file = folder.join(name);
        create_dir_all(file.parent().expect("a folder")).expect("made");
        write(&file, text).expect("written");
    }
    let ordinary = Path::new(env!("CARGO_BIN_EXE_sun2xp"));
    let (home, xdg, named) = (folder.join("home"), folder.join("xdg"), folder.join("named.toml"));
    for environment in
        [vec![], vec![("HOME", &*home)], vec![("XDG_CONFIG_HOME", &*xdg)], vec![("XDG_CONFIG_DIRS", &*xdg)]]
    {
        let (taken, said) = rate(&tool, folder, &environment);
        assert!(!taken && said.contains("1000 Hz"), "{environment:?}: {said}");
        // A program without such privileges uses the same files.
        let (taken, said) = rate(ordinary, folder, &environment);
        assert!(taken, "{environment:?}: {said}");
    }
    let (taken, said) = rate(&tool, folder, &[("SUN2XP_CONFIG", &named)]);
    assert!(!taken && said.contains("does not trust its environment") && said.contains(SYSTEM_FILE), "{said}");
    assert!(rate(ordinary, folder, &[("SUN2XP_CONFIG", &named)]).0);
}
