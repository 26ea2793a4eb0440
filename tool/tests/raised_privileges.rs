//! A program with more privileges than its caller ignores configurations of the caller.

#[allow(dead_code)]
#[path = "../../tests/common/tools.rs"]
mod tools;

use std::ffi::CString;
use std::fs::{Permissions, copy, create_dir_all, set_permissions, write};
use std::io;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::{MetadataExt, PermissionsExt, chown};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::{Mutex, PoisonError};
use tempfile::{TempDir, tempdir_in};

/// The number of the user `nobody`, and of a group that owns no files.
const NOBODY: u32 = 65534;

/// A capability that root keeps in most containers, so that a program can get it there too.
const CAP_NET_BIND_SERVICE: u32 = 10;

/// The configuration file that a program with more privileges than its caller reads.
const SYSTEM_FILE: &str = "/etc/xdg/sun2xp/sun2xp.toml";

/// Held by one test at a time. A child that one test forks while another test copies a program inherits the open file,
/// and a program that is open for writing cannot be started.
static TURN: Mutex<()> = Mutex::new(());

/// The tool twice, and the user who runs it.
struct Programs {
    /// Contains `raised`, and may contain `ordinary`. The user can read this folder.
    folder: TempDir,
    /// The tool with more privileges than its user.
    raised: PathBuf,
    /// The tool without such privileges.
    ordinary: PathBuf,
    /// `None` is the user of this test.
    user: Option<u32>,
}

/// A tool that runs with a group other than that of its caller. None if this user cannot make one.
fn setgid_tool() -> Option<Programs> {
    // The folder is not in /tmp, which may be mounted nosuid.
    let folder = tempdir_in(env!("CARGO_TARGET_TMPDIR")).expect("a folder");
    let ordinary = PathBuf::from(env!("CARGO_BIN_EXE_sun2xp"));
    let raised = copied(&ordinary, &folder.path().join("sun2xp"));
    let Some(group) = another_group().filter(|&group| chown(&raised, None, Some(group)).is_ok()) else {
        tools::skip("setgid", "this user is in one group only, and so cannot make a program that is setgid");
        return None;
    };
    set_permissions(&raised, Permissions::from_mode(0o2755)).expect("still allowed");
    assert_eq!(raised.metadata().expect("there").gid(), group);
    Some(Programs { folder, raised, ordinary, user: None })
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

/// A tool whose file has a capability that its user does not have. Its user and group are those of its caller. None if
/// the system does not permit such a program.
fn capable_tool() -> Option<Programs> {
    // Another user must be able to read what this process creates.
    // SAFETY: the call has no precondition. All tests of this process may use this mask.
    unsafe { libc::umask(0o022) };
    let mut refusals = Vec::new();
    // Other users may have no access to the folder of the build.
    for parent in [env!("CARGO_TARGET_TMPDIR"), "/var/tmp"] {
        match capable_tool_in(parent) {
            Ok(programs) => return Some(programs),
            Err(refusal) => refusals.push(format!("{parent}: {refusal}")),
        }
    }
    tools::not_permitted("file capabilities", &format!("no program gets one ({})", refusals.join("; ")));
    None
}

fn capable_tool_in(parent: &str) -> io::Result<Programs> {
    let folder = tempdir_in(parent)?;
    set_permissions(&folder, Permissions::from_mode(0o755))?;
    // A program that is not under test shows whether the system gives the capability here.
    let cat = copied(Path::new("/bin/cat"), &folder.path().join("cat"));
    give_capability(&cat)?;
    let shown = Command::new(cat).arg("/proc/self/status").current_dir("/").uid(NOBODY).gid(NOBODY).output()?;
    if !has_capability(&shown) {
        return Err(io::Error::other("the system ignores it, as with the mount option nosuid"));
    }
    let tool = Path::new(env!("CARGO_BIN_EXE_sun2xp"));
    let [raised, ordinary] = ["capable", "ordinary"].map(|name| copied(tool, &folder.path().join(name)));
    give_capability(&raised)?;
    Ok(Programs { folder, raised, ordinary, user: Some(NOBODY) })
}

/// Copies a program, so that every user may run the copy. Returns the path of the copy.
fn copied(program: &Path, place: &Path) -> PathBuf {
    copy(program, place).expect("a copy");
    set_permissions(place, Permissions::from_mode(0o755)).expect("an own file");
    place.into()
}

/// Does what `setcap cap_net_bind_service+ep` does. The program setcap need not be installed.
fn give_capability(program: &Path) -> io::Result<()> {
    // The kernel's struct vfs_cap_data: revision 2 with the effective bit, then the sets of permitted and of
    // inheritable capabilities, first for the capabilities 0 to 31 and then for those from 32 up.
    let attribute = [0x0200_0001, 1 << CAP_NET_BIND_SERVICE, 0, 0, 0].map(u32::to_le_bytes);
    let name = CString::new(program.as_os_str().as_bytes())?;
    // SAFETY: both names are C strings, and the value is readable for its size.
    let refused = unsafe {
        let value = attribute.as_ptr().cast();
        libc::setxattr(name.as_ptr(), c"security.capability".as_ptr(), value, size_of_val(&attribute), 0)
    };
    if refused == 0 { Ok(()) } else { Err(io::Error::last_os_error()) }
}

/// Whether a program that printed its /proc/self/status had the capability.
fn has_capability(run: &Output) -> bool {
    let status = String::from_utf8_lossy(&run.stdout);
    let permitted = status.lines().find_map(|line| line.strip_prefix("CapPrm:"));
    let bits = permitted.and_then(|bits| u64::from_str_radix(bits.trim(), 16).ok());
    bits.is_some_and(|bits| bits & 1 << CAP_NET_BIND_SERVICE != 0)
}

/// Runs the tool. Returns whether it used the rate of the caller's configuration, and its output.
fn rate(tool: &Path, programs: &Programs, environment: &[(&str, &Path)]) -> (bool, String) {
    let folder = programs.folder.path();
    let mut command = Command::new(tool);
    command
        .args(["schedule", "--costs"])
        .arg(folder.join("costs.toml"))
        .current_dir(folder)
        .env_remove("SUN2XP_CONFIG");
    command.env("HOME", folder.join("nowhere")).env_remove("XDG_CONFIG_HOME").env_remove("XDG_CONFIG_DIRS");
    if let Some(user) = programs.user {
        command.uid(user).gid(user);
    }
    let run = command.envs(environment.iter().copied()).output().expect("the tool starts");
    let said = String::from_utf8_lossy(&[run.stdout, run.stderr].concat()).into_owned();
    (said.contains("777 Hz"), said)
}

fn ignores_configurations_of_its_caller(make: fn() -> Option<Programs>) {
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    let Some(programs) = make() else { return };
    let folder = programs.folder.path();
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
    let (home, xdg, named) = (folder.join("home"), folder.join("xdg"), folder.join("named.toml"));
    for environment in
        [vec![], vec![("HOME", &*home)], vec![("XDG_CONFIG_HOME", &*xdg)], vec![("XDG_CONFIG_DIRS", &*xdg)]]
    {
        let (taken, said) = rate(&programs.raised, &programs, &environment);
        assert!(!taken && said.contains("1000 Hz"), "{environment:?}: {said}");
        // A program without such privileges uses the same files.
        let (taken, said) = rate(&programs.ordinary, &programs, &environment);
        assert!(taken, "{environment:?}: {said}");
    }
    let (taken, said) = rate(&programs.raised, &programs, &[("SUN2XP_CONFIG", &named)]);
    assert!(!taken && said.contains("does not trust its environment") && said.contains(SYSTEM_FILE), "{said}");
    assert!(rate(&programs.ordinary, &programs, &[("SUN2XP_CONFIG", &named)]).0);
}

#[test]
fn a_setgid_program_ignores_configurations_of_its_caller() {
    ignores_configurations_of_its_caller(setgid_tool);
}

/// The user and the group of a program with file capabilities are those of its caller. So a comparison of users and
/// groups does not show that the program has more privileges.
#[test]
fn a_program_with_file_capabilities_ignores_configurations_of_its_caller() {
    ignores_configurations_of_its_caller(capable_tool);
}
