//! The program sun2xp-serve as a person starts it: options, exit statuses, signals, and the scheduling of its threads.

mod common;
#[allow(dead_code)]
#[path = "../../tests/common/tools.rs"]
mod tools;

use common::{Client, free_port, wait_for};
use std::fs::{read_dir, read_to_string, write};
use std::io::{BufRead, BufReader};
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use sun2xp_remote_client::{RemoteConfiguration, RemoteHand};

const PROGRAM: &str = env!("CARGO_BIN_EXE_sun2xp-serve");

fn run(arguments: &[&str]) -> Output {
    Command::new(PROGRAM).args(arguments).output().expect("the program")
}

/// A running program. Dropping this value kills the program.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        // The program has ended already, except after a failed test.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Starts the program with these tables, and waits until it is ready.
fn start(folder: &Path, text: &str, prepare: fn() -> std::io::Result<()>) -> (Running, Vec<String>) {
    let file = folder.join("sun2xp.toml");
    write(&file, text).expect("a file");
    let mut command = Command::new(PROGRAM);
    command.arg("--config").arg(file).stdout(Stdio::piped());
    // SAFETY: `prepare` only makes a system call.
    #[allow(unsafe_code)]
    let command = unsafe { command.pre_exec(prepare) };
    let mut child = command.spawn().expect("the program");
    let lines = BufReader::new(child.stdout.take().expect("its output")).lines().map_while(Result::ok);
    let mut said = Vec::new();
    for line in lines {
        said.push(line);
        if said.last().is_some_and(|line| line == "ready") {
            break;
        }
    }
    assert_eq!(said.last().map(String::as_str), Some("ready"), "{said:?}");
    (Running(child), said)
}

fn terminate(child: &Child) {
    send_signal(child, libc::SIGTERM);
}

fn send_signal(child: &Child, signal: i32) {
    let process = i32::try_from(child.id()).expect("a process number");
    // SAFETY: the process is a child that has not been waited for.
    #[allow(unsafe_code)]
    let sent = unsafe { libc::kill(process, signal) };
    assert_eq!(sent, 0);
}

fn table(port: u16) -> String {
    format!(
        "[finger]\nport = 'simulated'\n[serve]\nname = 'cell'\n\
         listen = ['tcp/127.0.0.1:{port}']\n[serve.clients]\nalice = 'command'\n"
    )
}

#[test]
fn a_hand_is_offered_until_a_signal_comes() {
    let folder = tempfile::tempdir().expect("a folder");
    let port = free_port();
    // Server and clients on one machine may share a file.
    let remote = format!("[remote]\nendpoint = 'tcp/127.0.0.1:{port}'\nhand = 'cell'\nclient = 'alice'\n");
    let text = table(port) + &remote;
    let (mut running, said) = start(folder.path(), &text, || Ok(()));
    assert!(said[0].contains("`cell` at tcp/127.0.0.1:"), "{said:?}");
    assert!(said[1].starts_with("without TLS") && said[1].contains("--make-certificates"), "{said:?}");
    let configuration = RemoteConfiguration::from_text(&text, folder.path()).expect("usable").expect("a table");
    let hand = RemoteHand::open(&configuration).unwrap_or_else(|error| panic!("{error}"));
    hand.send_position(1, [0.1, 0.5, 0.9]).expect("sent");
    terminate(&running.0);
    assert_eq!(running.0.wait().expect("an end").code(), Some(0));
    wait_for("news of the end", || hand.send_position(1, [0.1, 0.5, 0.9]).err());
}

/// Sets what this process does when its terminal closes: SIG_DFL or SIG_IGN.
fn at_hangup(action: libc::sighandler_t) -> std::io::Result<()> {
    // SAFETY: the call concerns this process. `action` is SIG_DFL or SIG_IGN, so no function of the process runs.
    #[allow(unsafe_code)]
    let earlier = unsafe { libc::signal(libc::SIGHUP, action) };
    if earlier == libc::SIG_ERR { Err(std::io::Error::last_os_error()) } else { Ok(()) }
}

#[test]
fn a_terminal_that_closes_ends_the_server_in_an_orderly_way() {
    let folder = tempfile::tempdir().expect("a folder");
    // The tests themselves may run with the signal ignored, as under `nohup`.
    let (mut running, _) = start(folder.path(), &table(free_port()), || at_hangup(libc::SIG_DFL));
    send_signal(&running.0, libc::SIGHUP);
    assert_eq!(running.0.wait().expect("an end").code(), Some(0));
}

#[test]
fn an_ignored_signal_stays_ignored() {
    let folder = tempfile::tempdir().expect("a folder");
    let port = free_port();
    let (mut running, _) = start(folder.path(), &table(port), || at_hangup(libc::SIG_IGN));
    // The State messages and the exit status do not show whether the server ignores SIGHUP: a server that ends in an
    // orderly way may still publish them, and its exit status is 0 too. The mask of ignored signals shows it. Its
    // lowest bit is that of signal 1, SIGHUP.
    let status = read_to_string(format!("/proc/{}/status", running.0.id())).expect("the status of the process");
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:")).expect("the ignored signals").trim();
    assert_eq!(u64::from_str_radix(ignored, 16).expect("a mask") & 1, 1, "SIGHUP is not ignored: {ignored}");
    send_signal(&running.0, libc::SIGHUP);
    let client = Client::connect_to(&format!("tcp/127.0.0.1:{port}"), "cell", "alice", None).expect("connected");
    wait_for("States", || client.state());
    terminate(&running.0);
    assert_eq!(running.0.wait().expect("an end").code(), Some(0));
}

#[test]
fn an_output_that_is_full_or_closed_does_not_matter() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("sun2xp.toml");
    let full = || std::fs::OpenOptions::new().write(true).open("/dev/full").expect("a full device");
    let port = free_port();
    write(&file, table(port)).expect("a file");
    let mut command = Command::new(PROGRAM);
    let child = command.arg("--config").arg(&file).stdout(full()).stderr(full()).spawn().expect("the program");
    let mut running = Running(child);
    let connect = || Client::connect_to(&format!("tcp/127.0.0.1:{port}"), "cell", "alice", None).ok();
    let client = wait_for("the server", connect);
    wait_for("States", || client.state());
    terminate(&running.0);
    assert_eq!(running.0.wait().expect("an end").code(), Some(0));
    // Nobody reads the error.
    let (reader, writer) = std::io::pipe().expect("a pipe");
    drop(reader);
    write(&file, "[serve]\n\nlead = 3\n").expect("a file");
    let status = Command::new(PROGRAM).arg("--config").arg(&file).stderr(writer).status().expect("the program");
    assert_eq!(status.code(), Some(1));
}

#[test]
fn arguments_cannot_change_the_state_of_a_terminal() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path().join("certificates");
    let folder = folder.to_str().expect("a name");
    let hostile = "a\u{1b}[31m";
    for arguments in [
        &["--make-certificates", folder, "--client", hostile][..],
        &["--make-certificates", folder, "--server", hostile],
        &["--name", hostile],
        &[hostile],
    ] {
        let output = run(arguments);
        assert!(matches!(output.status.code(), Some(1 | 2)), "{output:?}");
        assert!(!output.stderr.is_empty() && !output.stderr.contains(&0x1b), "{output:?}");
        assert!(!output.stdout.contains(&0x1b), "{output:?}");
    }
    assert!(!Path::new(folder).exists(), "a refused command creates no folder");
}

#[test]
fn what_is_wrong_is_said_with_its_remedy() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("sun2xp.toml");
    let name = file.to_str().expect("a name");
    for (text, words) in [
        ("[serve]\nlisten = ['tcp/0.0.0.0:7447']\n", "--make-certificates"),
        ("[serve]\n\nlead = 3\n", "sun2xp.toml:3"),
        ("[hand]\nrat = 3\n", "sun2xp.toml:2"),
    ] {
        write(&file, text).expect("a file");
        let output = run(&["--config", name]);
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{output:?}");
        assert!(error.starts_with("sun2xp-serve: ") && error.contains(words), "{error}");
    }
    let output = run(&["--make-certificates", &format!("{name}.d"), "--server", "fe80::1"]);
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(error.contains("the name of a server") && error.contains("are given with --address"), "{error}");
    assert_eq!(run(&["--rooter"]).status.code(), Some(2));
    assert_eq!(run(&["--client", "alice"]).status.code(), Some(2), "only with --make-certificates");
    let busy = std::net::TcpListener::bind("127.0.0.1:0").expect("a port");
    write(&file, table(busy.local_addr().expect("an address").port())).expect("a file");
    let output = run(&["--config", name]);
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(1) && error.contains("free port"), "{error}");
}

#[test]
fn certificates_are_made() {
    let folder = tempfile::tempdir().expect("a folder");
    let certificates = folder.path().join("certificates");
    let certificates = certificates.to_str().expect("a name");
    let make = |client| run(&["--make-certificates", certificates, "--client", client]);
    let made = run(&["--make-certificates", certificates, "--server", "cell", "--address", "10.0.0.5"]);
    assert_eq!(String::from_utf8_lossy(&made.stdout).lines().count(), 4, "{made:?}");
    assert_eq!(make("planner").status.code(), Some(0));
    assert_eq!(make("planner").status.code(), Some(1), "nothing is overwritten");
}

/// The scheduling policy of each thread, by the name of the thread.
fn policies(process: u32) -> Vec<(String, u32)> {
    let tasks = read_dir(format!("/proc/{process}/task")).expect("threads");
    let policies = tasks.filter_map(|task| {
        let path = task.ok()?.path();
        let stat = read_to_string(path.join("stat")).ok()?;
        let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
        // The policy is field 41 in proc(5). `fields` begins with field 3.
        Some((read_to_string(path.join("comm")).ok()?.trim().to_owned(), fields[38].parse().ok()?))
    });
    policies.collect()
}

#[test]
fn the_threads_of_the_network_are_ordinary_in_a_real_time_process() {
    fn real_time() -> std::io::Result<()> {
        let parameters = libc::sched_param { sched_priority: 20 };
        // SAFETY: the parameters are valid during the call, which concerns this process.
        #[allow(unsafe_code)]
        let result = unsafe { libc::sched_setscheduler(0, libc::SCHED_FIFO, &parameters) };
        if result == 0 { Ok(()) } else { Err(std::io::Error::last_os_error()) }
    }
    let mut permitted = Command::new("true");
    // SAFETY: `real_time` only makes a system call.
    #[allow(unsafe_code)]
    let permitted = unsafe { permitted.pre_exec(real_time) }.status();
    if let Err(error) = permitted {
        tools::not_permitted("threads with real-time priority", &error.to_string());
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let port = free_port();
    let (mut running, _) = start(folder.path(), &table(port), real_time);
    let client = Client::connect_to(&format!("tcp/127.0.0.1:{port}"), "cell", "alice", None).expect("connected");
    wait_for("States", || client.state());
    let of_network = |name: &str| ["app-", "net-", "acc-", "rx-", "tx-"].iter().any(|prefix| name.starts_with(prefix));
    let found: Vec<(String, u32)> = policies(running.0.id());
    let network: Vec<&(String, u32)> = found.iter().filter(|(name, _)| of_network(name)).collect();
    assert!(network.len() >= 4 && network.iter().all(|(_, policy)| *policy == 0), "{found:?}");
    assert!(found.iter().any(|(_, policy)| *policy != 0), "the process was started with real-time priority: {found:?}");
    terminate(&running.0);
    assert_eq!(running.0.wait().expect("an end").code(), Some(0));
}

/// The manual page is packaging/sun2xp-serve.1. The help of the program names these signals too.
#[test]
fn the_manual_page_names_every_signal_that_ends_the_server() {
    let page = include_str!("../../packaging/sun2xp-serve.1");
    for signal in ["SIGINT", "SIGTERM", "SIGHUP"] {
        assert!(page.contains(signal), "{signal}");
    }
}
