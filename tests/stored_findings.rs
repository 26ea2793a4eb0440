//! Findings of many processes and threads in one configuration file: each stores its findings, and none is lost.

use nalgebra::Vector3;
use std::fs::{self, File, Permissions};
use std::io::{BufRead, BufReader};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use sun2xp::calibration::{Findings, Identified, Tolerances, Zeros};
use sun2xp::hand::{ConfigurationError, Found, read_configuration, store_findings};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::{Configuration, ConfiguredFinger};
use tempfile::{TempDir, tempdir};

const FILE: &str = "# The hand on the desk.\n[hand]\nrate = 500 # slow cable\n\n[finger.encoder]\n\
     zero = [1, 2, 3, 4]\n\n[finger.2.tendon]\nstiffness = [ 300.0, 300, # new\n  310.0, 300.0 ] # N/cm\n";

/// A worker that stores the same kind of finding repeatedly. No two workers store the same kind for the same finger.
#[derive(Clone, Copy, Debug)]
struct Worker {
    finger: FingerNumber,
    what: What,
}

#[derive(Clone, Copy, Debug)]
enum What {
    Zeros,
    Friction,
    Bound,
}

/// Only finger 2 gets a bound, because no worker stores its friction. A bound of finger 1 or 3 would become invalid
/// when another worker stores the friction of that finger.
const WORKERS: [Worker; 6] = [
    Worker { finger: FingerNumber::ONE, what: What::Zeros },
    Worker { finger: FingerNumber::ONE, what: What::Friction },
    Worker { finger: FingerNumber::TWO, what: What::Zeros },
    Worker { finger: FingerNumber::TWO, what: What::Bound },
    Worker { finger: FingerNumber::THREE, what: What::Zeros },
    Worker { finger: FingerNumber::THREE, what: What::Friction },
];

impl Worker {
    /// The worker's finding in a turn, based on a configuration that it read long before.
    fn found(self, turn: i32, configuration: &Configuration) -> Found {
        let number = f64::from(turn + 1);
        let findings = match self.what {
            What::Zeros => Findings::Zeros(Zeros {
                encoder: [turn; 4],
                gauge: [number; 4],
                joint_error: Vector3::zeros(),
                range_error: None,
            }),
            What::Friction => Findings::Identified(Identified {
                tendon_stiffness: [100.0 + number; 4].into(),
                stiffness_tolerance: 0.03,
                travel_residual: 0.0,
                tolerances: Tolerances { friction: 0.2, moment_arms: None, gauges: 0.05 },
                motor_coulomb: [0.07; 4].into(),
                conduit: [0.05; 4].into(),
                pulley: [0.02; 4].into(),
                gauge_gain: [1.0; 4].into(),
                motor_ratio: [1.0; 4].into(),
                joint_coulomb: Vector3::repeat(number),
                joint_viscous: Vector3::repeat(0.05),
                rotor_inertia: None,
                moment_arms: None,
            }),
            What::Bound => return Found::bound(10.0 + number, self.finger, configuration),
        };
        Found::by_calibration(&findings, self.finger, configuration)
    }

    /// Returns whether the file contains the finding of a turn.
    fn is_stored(self, turn: i32, path: &Path) -> bool {
        let hand = read_configuration(path).unwrap_or_else(|error| panic!("{self:?}, turn {turn}: {error}"));
        let ConfiguredFinger { encoder, gauge, tendon, friction, stiffness, .. } = &hand.fingers[self.finger.index()];
        let number = f64::from(turn + 1);
        match self.what {
            What::Zeros => encoder.zero == [turn; 4] && gauge.zero == [number; 4],
            What::Friction => tendon.stiffness == [100.0 + number; 4] && friction.joint_coulomb == [number; 3],
            What::Bound => stiffness.bound == Some(10.0 + number),
        }
    }

    /// Stores a finding in every turn and checks that it is in the file. Prints a line for each.
    fn work(self, path: &Path, turns: i32) {
        let configuration = read_configuration(path).expect("usable");
        for turn in 0..turns {
            let stored = store_findings(path, &[self.found(turn, &configuration)]);
            stored.unwrap_or_else(|error| panic!("{self:?}, turn {turn}: {error}"));
            assert!(self.is_stored(turn, path), "{self:?}, turn {turn}: lost");
            println!("stored {turn}");
        }
    }
}

fn hand() -> (TempDir, PathBuf) {
    let folder = tempdir().expect("a folder");
    let path = folder.path().join("hand.toml");
    fs::write(&path, FILE).expect("written");
    (folder, path)
}

/// Environment variables that give another process of this program its file, its worker and the number of turns.
const PATH: &str = "SUN2XP_TEST_FILE";
const NUMBER: &str = "SUN2XP_TEST_WORKER";
const TURNS: &str = "SUN2XP_TEST_TURNS";

/// Starts another process of this program.
fn process(worker: usize, path: &Path, turns: i32) -> Child {
    Command::new(std::env::current_exe().expect("this program"))
        .args(["--exact", "threads_and_processes_store_at_once", "--nocapture"])
        .envs([(NUMBER, worker.to_string()), (TURNS, turns.to_string())])
        .env(PATH, path)
        .stdout(Stdio::piped())
        .spawn()
        .expect("started")
}

#[test]
fn threads_and_processes_store_at_once() {
    if let Some(path) = std::env::var_os(PATH) {
        let number = |name| std::env::var(name).expect("set").parse::<usize>().expect("a number");
        WORKERS[number(NUMBER)].work(Path::new(&path), number(TURNS) as i32);
        return;
    }
    const STORES: i32 = 50;
    let (folder, path) = hand();
    let processes = [1, 3, 5].map(|worker| process(worker, &path, STORES));
    std::thread::scope(|scope| {
        for worker in [0, 2, 4] {
            let path = &path;
            scope.spawn(move || WORKERS[worker].work(path, STORES));
        }
    });
    for process in processes {
        let output = process.wait_with_output().expect("ended");
        let stores = String::from_utf8_lossy(&output.stdout).matches("stored").count();
        assert!(output.status.success() && stores == STORES as usize, "{stores} stores");
    }
    assert!(WORKERS.iter().all(|worker| worker.is_stored(STORES - 1, &path)));
    let text = fs::read_to_string(&path).expect("read");
    for kept in ["# The hand on the desk.\n[hand]\nrate = 500 # slow cable\n\n", "300, # new\n  310.0, 300.0 ] # N/cm"]
    {
        assert!(text.contains(kept), "{text}");
    }
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1, "temporary files are left");
}

#[test]
fn a_finding_based_on_an_old_reading_reverts_nothing() {
    let (_folder, path) = hand();
    let read_before = read_configuration(&path).expect("usable");
    WORKERS[0].work(&path, 1);
    let worker = WORKERS[2];
    store_findings(&path, &[worker.found(5, &read_before)]).expect("stored");
    store_findings(&path, &[WORKERS[3].found(6, &read_before)]).expect("stored");
    assert!(WORKERS[0].is_stored(0, &path) && worker.is_stored(5, &path) && WORKERS[3].is_stored(6, &path));
}

/// Kills a process while it stores: the file must be intact, its lock must be free, and leftovers of the process must
/// do no harm.
#[test]
fn a_killed_process_leaves_a_whole_file_and_no_lock() {
    let (_folder, path) = hand();
    for lines in 1..=12 {
        let mut process = process(0, &path, 1_000_000);
        let output = BufReader::new(process.stdout.take().expect("piped"));
        let stored = output.lines().map_while(Result::ok).filter(|line| line.contains("stored")).take(lines).count();
        process.kill().expect("killed");
        process.wait().expect("ended");
        assert_eq!(stored, lines);
        let turn = 10_000 + lines as i32;
        store_findings(&path, &[WORKERS[4].found(turn, &read_configuration(&path).expect("usable"))]).expect("stored");
        assert!(WORKERS[4].is_stored(turn, &path));
    }
}

#[test]
fn a_store_waits_for_another_one() {
    let (_folder, path) = hand();
    let lock = File::open(&path).expect("open");
    lock.lock().expect("locked");
    std::thread::scope(|scope| {
        let storing = scope.spawn(|| WORKERS[0].work(&path, 1));
        // This thread has the file open and holds the lock. The storing thread has come to the lock when it has the
        // file open too.
        while fs::read_dir("/proc/self/fd").expect("Linux").flatten().filter(|fd| links_to(&fd.path(), &path)).count()
            < 2
        {
            std::thread::yield_now();
        }
        assert!(!storing.is_finished());
        assert_eq!(fs::read_to_string(&path).expect("read"), FILE);
        drop(lock);
    });
    assert!(WORKERS[0].is_stored(0, &path));
}

fn links_to(link: &Path, path: &Path) -> bool {
    fs::read_link(link).is_ok_and(|target| target == path)
}

/// Runs `body` on a thread without the rights of root. The other threads keep theirs.
fn as_nobody(body: impl FnOnce() + Send) {
    std::thread::scope(|scope| {
        let thread = scope.spawn(|| {
            // SAFETY: the system call changes the user of the calling thread only, which ends after `body`.
            let changed = unsafe { libc::syscall(libc::SYS_setresuid, -1, 65_534, -1) };
            // If the test does not run as root, the call fails, but the thread has no rights of root anyway.
            assert!(changed == 0 || unsafe { libc::geteuid() } != 0);
            body();
        });
        thread.join().expect("no panic");
    });
}

#[test]
fn a_file_that_this_user_may_not_write_stays_unchanged_and_is_named() {
    let (folder, path) = hand();
    let found = WORKERS[0].found(7, &read_configuration(&path).expect("usable"));
    let set = |path: &Path, mode| fs::set_permissions(path, Permissions::from_mode(mode)).expect("set");
    for (folder_mode, file_mode) in [(0o555, 0o666), (0o777, 0o444)] {
        set(folder.path(), folder_mode);
        set(&path, file_mode);
        as_nobody(|| {
            let error = store_findings(&path, std::slice::from_ref(&found)).expect_err("refused");
            assert!(matches!(error, ConfigurationError::Unwritable { .. }) && error.errno() == libc::EACCES, "{error}");
            assert!(error.to_string().contains("hand.toml: Permission denied"), "{error}");
        });
        assert_eq!(fs::read_to_string(&path).expect("read"), FILE);
    }
    set(&path, 0o666);
    as_nobody(|| store_findings(&path, std::slice::from_ref(&found)).expect("stored"));
    assert!(WORKERS[0].is_stored(7, &path));
    assert_eq!(fs::metadata(&path).expect("there").permissions().mode() & 0o777, 0o666);
}
