//! The reference firmware on an emulated processor, and the physics that replaces its motors and sensors.

use std::ffi::CString;
use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Read, Write};
use std::num::NonZero;
use std::ops::Range;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex, MutexGuard};
use std::thread::JoinHandle;

use crate::priority::{run_first, runs_first, stays_on_processor};
use nalgebra::Vector3;
use sun2xp::board::protocol::Status;
use sun2xp::model::configuration::Configuration;
use sun2xp::plant::{PLANT_STEP_SECONDS, Plant, Sensors};
use tempfile::TempDir;

const FIRMWARE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/firmware");

/// A kind of board that the emulator knows, and the images of the firmware for the boards of a hand.
#[derive(Clone, Copy)]
pub struct Emulated {
    /// Name of the board in the emulator.
    pub board: &'static str,
    /// The images that a hand may use, one for each board.
    images: &'static [&'static str],
    /// Number of fingers on each board.
    fingers_a_board: usize,
}

/// A Cortex-M3 with three fingers.
pub const LM3S6965: Emulated = Emulated { board: "lm3s6965evb", images: &["lm3s6965.elf"], fingers_a_board: 3 };

/// An STM32F405, a Cortex-M4, for each finger.
pub const STM32F405: Emulated = Emulated {
    board: "netduinoplus2",
    images: &["netduinoplus2-1.elf", "netduinoplus2-2.elf", "netduinoplus2-3.elf"],
    fingers_a_board: 1,
};

impl Emulated {
    /// Number of boards of the hand. Each emulator of a board with one finger needs up to two thirds of a processor, so
    /// there are at most as many of these emulators as processors. A machine with a single processor nevertheless runs
    /// two, because the tests need finger 2. With three emulators on two processors, the kernel's threads that carry
    /// the bytes of the terminals get too little time, and replies are lost for a second.
    pub fn boards(self) -> usize {
        let processors = std::thread::available_parallelism().map_or(1, NonZero::get);
        self.images.len().min(processors.max(2))
    }

    /// Number of fingers of the hand.
    pub fn fingers(self) -> usize {
        self.boards() * self.fingers_a_board
    }

    /// Compiles the images of all emulated boards into `folder`.
    pub fn build(self, folder: &Path) {
        let output = Command::new("make")
            .args(["-C", FIRMWARE, "emulated"])
            .arg(format!("BUILD={}", folder.display()))
            .output()
            .expect("make runs");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
}

/// The boards of a hand.
pub struct Machine {
    /// Dropped before the plants.
    emulators: Vec<Emulator>,
    plants: Arc<[Mutex<Finger>]>,
}

impl Machine {
    /// Starts the boards with the images in `folder`.
    pub fn start(emulated: Emulated, folder: &Path) -> Self {
        let plants: Arc<[_]> = (0..emulated.fingers()).map(|index| Mutex::new(Finger::new(index))).collect();
        let fingers = emulated.fingers_a_board;
        // One emulator of three fingers needs more than one processor. If it stays on one, its measurements are so old
        // that the fingers oscillate while they come under tension.
        let stays = fingers == 1;
        let start = |(index, image)| {
            let processor = stays.then_some(index);
            Emulator::start(emulated.board, &folder.join(image), processor, plants.clone(), fingers * index)
        };
        Self { emulators: emulated.images[..emulated.boards()].iter().enumerate().map(start).collect(), plants }
    }

    /// The port of each board.
    pub fn ports(&self) -> Vec<PathBuf> {
        self.emulators.iter().map(|emulator| emulator.port.clone()).collect()
    }

    /// Process numbers of the emulators.
    pub fn processes(&self) -> Vec<u32> {
        self.emulators.iter().map(|emulator| emulator.process.id()).collect()
    }

    /// The indices of the fingers.
    pub fn fingers(&self) -> Range<usize> {
        0..self.plants.len()
    }

    /// Locks the finger with this index. The physics stands still meanwhile, so the lock must be brief.
    pub fn finger(&self, index: usize) -> MutexGuard<'_, Finger> {
        self.plants[index].lock().expect("no panic holding it")
    }
}

/// One running emulator. Dropping it kills its process, so the process ends even if the test fails.
struct Emulator {
    process: Child,
    port: PathBuf,
    /// Keeps the host end of the terminal open. While this end is closed, the emulator discards its output, and checks
    /// only once a second whether the end was opened.
    _end: File,
    _folder: TempDir,
    requests: File,
    thread: Option<JoinHandle<()>>,
}

impl Emulator {
    /// `processor` is the index of the processor on which the emulator stays. With `None` the emulator may use every
    /// processor. `first` is the index of the board's first finger.
    fn start(board: &str, image: &Path, processor: Option<usize>, plants: Arc<[Mutex<Finger>]>, first: usize) -> Self {
        let folder = tempfile::tempdir().expect("a scratch folder");
        let [to_plant, from_plant] = ["plant_to", "plant_from"].map(|name| pipe(&folder.path().join(name)));
        let mut command = Command::new("qemu-system-arm");
        let command = runs_first(&mut command);
        let command = match processor {
            Some(index) => stays_on_processor(index, command),
            None => command,
        };
        let mut process = command
            .args(["-M", board, "-display", "none", "-monitor", "none", "-serial", "pty"])
            .args(["-semihosting-config", "enable=on,target=native", "-kernel"])
            .arg(image)
            // The firmware opens the plant's pipes by name, so they are in the working directory.
            .current_dir(folder.path())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the emulator starts");
        let lines = BufReader::new(process.stdout.take().expect("the emulator's output is a pipe")).lines();
        // Example: "char device redirected to /dev/pts/3 (label serial0)".
        let port: PathBuf = lines
            .map(|line| line.expect("the emulator's output is text"))
            .find_map(|line| Some(line.split_whitespace().find(|word| word.starts_with("/dev/"))?.into()))
            .expect("the emulator names a terminal");
        let end = OpenOptions::new().read(true).write(true).custom_flags(libc::O_NOCTTY).open(&port);
        let requests = to_plant.try_clone().expect("a second descriptor");
        let serving = move || {
            run_first();
            serve(to_plant, from_plant, &plants[first..]);
        };
        // `PauseWatch` recognises board threads by this name.
        let thread = std::thread::Builder::new().name("sun2xp board".into()).spawn(serving).expect("a thread");
        Self { process, port, _end: end.expect("the terminal opens"), _folder: folder, requests, thread: Some(thread) }
    }
}

impl Drop for Emulator {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
        let _ = self.requests.write_all(&[END; REQUEST_LENGTH]);
        let _ = self.thread.take().map(JoinHandle::join);
    }
}

/// The firmware's last request. Its times are on the firmware's clock, us.
#[derive(Clone, Copy, Default)]
pub struct Asked {
    /// Number of requests that a host's Command or Configure caused.
    pub samples: u32,
    /// Arrival of the last Command or Configure that caused a request. A processor that was paused may handle this
    /// frame much later.
    pub arrived_at: u32,
    /// When a command or the firmware itself last set the currents.
    pub set_at: u32,
    /// Time of the request.
    pub now: u32,
    /// Currents of the motors, uA.
    pub currents: [i32; 4],
}

/// A finger without a board.
pub struct Finger {
    pub plant: Plant,
    sensors: Sensors,
    /// N m/A.
    torque_constants: [f64; 4],
    /// Time of the physics on the firmware's clock, us.
    time: Option<u32>,
    /// Time that is left over after the last whole step of the physics, s.
    rest: f64,
    /// How much longer the finger may move before the next sample, s. A real finger does not wait. On a busy machine,
    /// however, planner, emulator and plant are all delayed by more than any control loop tolerates.
    motion_left: f64,
    /// Faults that every answer to the firmware contains.
    pub faults: Status,
    /// Counts of the tactile elements; 0xFFFF for one that cannot be read.
    pub touch: [u16; 2],
    pub asked: Asked,
}

/// Longest motion of a driven finger after a sample, s: one period at 500 Hz.
const LONGEST_MOTION: f64 = 0.002;

impl Finger {
    fn new(index: usize) -> Self {
        let mut finger = Configuration::default().fingers[index].clone();
        finger.simulation.seed += index as u64;
        Self {
            plant: Plant::new(&finger, Vector3::zeros()).expect("a good finger"),
            sensors: Sensors::new(&finger),
            // 1 N cm/A is 0.01 N m/A.
            torque_constants: finger.motor.torque_constant.map(|constant| 0.01 * constant),
            time: None,
            rest: 0.0,
            motion_left: 0.0,
            faults: Status::default(),
            touch: [300, 500],
            asked: Asked::default(),
        }
    }

    fn answer(&mut self, request: &[u8; REQUEST_LENGTH]) -> Vec<u8> {
        let word = |offset: usize| u32::from_le_bytes(std::array::from_fn(|byte| request[offset + byte]));
        let (sample, now) = (request[1] == 1, word(4));
        let currents = std::array::from_fn(|motor| word(16 + 4 * motor) as i32);
        self.asked.now = now;
        self.asked.set_at = word(12);
        self.asked.currents = currents;
        self.advance(now.wrapping_sub(self.time.unwrap_or(now)), currents);
        self.time = Some(now);
        if sample {
            self.asked.samples += 1;
            self.asked.arrived_at = word(8);
            self.motion_left = LONGEST_MOTION;
        }
        let (encoders, gauges) = self.sensors.read(&self.plant);
        let encoders = encoders.iter().flat_map(|count| count.to_le_bytes());
        let gauges = gauges.iter().flat_map(|count| count.to_le_bytes());
        let touch = self.touch.iter().flat_map(|count| count.to_le_bytes());
        encoders.chain(gauges).chain(self.faults.0.to_le_bytes()).chain(touch).chain([0; 2]).collect()
    }

    fn advance(&mut self, microseconds: u32, currents: [i32; 4]) {
        let driven = currents != [0; 4];
        if driven {
            self.plant.release_brake();
        }
        let mut seconds = (1e-6 * f64::from(microseconds)).min(2.0 * LONGEST_MOTION);
        if driven {
            seconds = seconds.min(self.motion_left);
            self.motion_left -= seconds;
        }
        self.rest += seconds;
        let torques = std::array::from_fn(|motor| 1e-6 * f64::from(currents[motor]) * self.torque_constants[motor]);
        while self.rest >= PLANT_STEP_SECONDS {
            self.rest -= PLANT_STEP_SECONDS;
            self.plant.step(torques);
        }
    }
}

/// Length of a request, bytes, as in firmware/emulated/plant.h.
const REQUEST_LENGTH: usize = 32;

/// Sent in place of a finger's number when the machine is shut down.
const END: u8 = 0xFF;

/// Opens both ends at once, so that opening and reading do not depend on which side is first.
fn pipe(path: &Path) -> File {
    let name = CString::new(path.as_os_str().as_bytes()).expect("a path without zeros");
    // SAFETY: the name is a C string.
    assert_eq!(unsafe { libc::mkfifo(name.as_ptr(), 0o600) }, 0, "{}", path.display());
    OpenOptions::new().read(true).write(true).open(path).expect("a pipe")
}

fn serve(mut requests: File, mut answers: File, plants: &[Mutex<Finger>]) {
    let mut request = [0; REQUEST_LENGTH];
    while requests.read_exact(&mut request).is_ok() && request[0] != END {
        let finger = &plants[usize::from(request[0])];
        let answer = finger.lock().expect("no panic holding it").answer(&request);
        answers.write_all(&answer).expect("the firmware takes the answer");
    }
}
