//! Measures whether the programs that show and record a hand delay its servos.

use super::chrome::Browser;
use super::program::{Program, hand};
use super::screen::Terminal;
use super::tools::available;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;
use sun2xp::realtime::{CycleStage, Distribution};
use sun2xp::{Hand, RealTime};

/// Number of measurements of each kind: without the programs and with them. The two kinds alternate.
const TURNS: usize = 12;

/// Duration of a measurement.
const TURN: Duration = Duration::from_secs(5);

/// Time that is left out of the measurement after the programs have started or ended.
const SETTLING: Duration = Duration::from_secs(2);

/// Largest ratio of the latency with the programs to the latency without them.
const LARGEST_RATIO: f64 = 1.1;

const TOOL: &str = env!("CARGO_BIN_EXE_sun2xp");

/// The latencies with or without the programs, us: the median and the 99.9 % value of the wake-ups. There is one
/// value for each measurement.
#[derive(Default)]
struct Side {
    medians: Vec<f64>,
    p999: Vec<f64>,
}

impl Side {
    fn measure(&mut self, hand: &Hand) {
        sleep(SETTLING);
        (1..=3).for_each(|finger| hand.reset_timing(finger).expect("reset"));
        sleep(TURN);
        let wake: Vec<Distribution> =
            (1..=3).map(|finger| hand.timing(finger, CycleStage::WakeUp).expect("times")).collect();
        self.medians.push(median(wake.iter().map(|wake| wake.median)));
        self.p999.push(median(wake.iter().map(|wake| wake.p999)));
    }

    fn row(&self, name: &str) {
        let [median, p999] = [&self.medians, &self.p999].map(|side| median(side.iter().copied()));
        println!("| {name} | {median:.1} us | {p999:.1} us |");
    }
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

#[test]
#[ignore = "takes three minutes, and needs a machine without other work"]
fn a_monitor_a_page_and_a_recorder_do_not_delay_the_servos() {
    for tool in ["chromium", "tmux"] {
        if !available(tool, "the delay of servos by programs that show them") {
            return;
        }
    }
    let (hand, name) = hand(|configuration| configuration.hand.real_time = RealTime::Enforce);
    let folder = tempfile::tempdir().expect("a folder");
    let (mut alone, mut watched, mut ratios) = (Side::default(), Side::default(), Vec::new());
    for turn in 0..TURNS {
        alone.measure(&hand);
        let terminal = Terminal::start("wake-up", (120, 40), &format!("{TOOL} monitor {name}"));
        terminal.until(&["finger 1", "live"]);
        let page = Program::monitor(&name);
        let browser = Browser::start(1280, 800);
        browser.open(&page.url);
        let mut recorder = Command::new(TOOL);
        recorder.args(["record", "--hand", &name, "-o"]).arg(folder.path().join(format!("{turn}.mcap")));
        let mut recorder = recorder.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("it starts");
        watched.measure(&hand);
        assert!(recorder.try_wait().is_ok_and(|ended| ended.is_none()), "the recorder has ended");
        recorder.kill().and_then(|()| recorder.wait()).expect("it ends");
        ratios.push(watched.p999[turn] / alone.p999[turn]);
    }
    println!("| wake-up | median | 99.9 % |\n|---|---|---|");
    alone.row("no program");
    watched.row("monitor, page in a browser, recorder");
    let ratio = median(ratios.into_iter());
    println!(
        "\nRatio of the 99.9 % latencies with and without the programs, median of the turns: {ratio:.2} (goal: at most \
         {LARGEST_RATIO})"
    );
    assert!(ratio <= LARGEST_RATIO);
}
