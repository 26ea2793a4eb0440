//! Hardware for the tests: the physics of a finger, and a switchboard that makes it fail.

use std::f64::consts::TAU;
use std::io;
use std::sync::Arc;
use std::thread::sleep;
use std::time::Duration;
use sun2xp::io::{FingerIo, IoCommand, IoFaults, IoProperties, IoSample, IoTerms};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::Configuration;
use sun2xp::nalgebra::Vector3;
use sun2xp::plant::{PLANT_STEP_SECONDS, Plant};
use sun2xp::realtime::Mutex;

/// The values that the tests set and read. The calls in the servo thread lock them. Code for real hardware must not
/// wait for a lock there.
#[derive(Default)]
pub struct Switchboard {
    /// The errno with which every start fails, if any.
    pub start_fails: Option<i32>,
    /// Duration of the next start.
    pub start_takes: Option<Duration>,
    /// The errno with which every exchange fails, if any.
    pub exchange_fails: Option<i32>,
    /// Number of stops that still fail.
    pub stops_fail: u32,
    /// Delay of the next exchange.
    pub delay: Option<Duration>,
    /// Replaces the tension of a gauge.
    pub tension: Option<(usize, f64)>,
    /// The numbers that are added to the counts of the encoders.
    pub encoder: [i32; 4],
    pub faults: IoFaults,
    /// Force on the tip, N.
    pub force: Vector3<f64>,
    pub terms: Option<IoTerms>,
    pub starts: u32,
    pub stops: u32,
    pub exchanges: u64,
    pub last: Option<IoCommand>,
}

pub type Switches = Arc<Mutex<Switchboard>>;

/// Returns the numbers of successful starts and stops.
pub fn starts_and_stops(switches: &Switches) -> (u32, u32) {
    let switches = switches.lock();
    (switches.starts, switches.stops)
}

/// The physics of a finger.
pub struct PlantIo {
    plant: Plant,
    steps: u32,
    number: u64,
    time: u64,
    pub switches: Switches,
    pub properties: IoProperties,
}

impl PlantIo {
    /// The physics advances by one period in each exchange with a new command. `in_step` says whether the servo waits
    /// for the physics.
    pub fn new(configuration: &Configuration, finger: FingerNumber, in_step: bool) -> Self {
        let configured = &configuration.fingers[finger.index()];
        let plant = Plant::new(configured, configuration.gravity(finger)).expect("tendons that hold the finger");
        let steps = (1.0 / configuration.hand.rate / PLANT_STEP_SECONDS).round() as u32;
        let properties = IoProperties { in_step, ..Default::default() };
        Self { plant, steps, number: 0, time: 0, switches: Switches::default(), properties }
    }

    fn sample(&self, switches: &Switchboard) -> IoSample {
        let angles = self.plant.motor_angles();
        let mut tensions: [f64; 4] = self.plant.tensions().into();
        switches.tension.iter().for_each(|&(gauge, tension)| tensions[gauge] = tension);
        IoSample {
            time: Some(self.time),
            encoders: std::array::from_fn(|motor| {
                ((angles[motor] * 2000.0 / TAU).floor() as i32).wrapping_add(switches.encoder[motor])
            }),
            tensions,
            faults: switches.faults,
        }
    }
}

fn fails(errno: Option<i32>) -> io::Result<()> {
    errno.map_or(Ok(()), |errno| Err(io::Error::from_raw_os_error(errno)))
}

impl FingerIo for PlantIo {
    fn properties(&self) -> IoProperties {
        self.properties
    }

    fn start(&mut self, terms: &IoTerms) -> io::Result<IoSample> {
        let mut switches = self.switches.lock();
        fails(switches.start_fails)?;
        switches.start_takes.take().into_iter().for_each(sleep);
        assert_eq!(switches.starts, switches.stops, "every start is followed by a stop before the next start");
        switches.starts += 1;
        switches.terms = Some(*terms);
        self.number = 0;
        Ok(self.sample(&switches))
    }

    fn exchange(&mut self, command: &IoCommand) -> io::Result<IoSample> {
        let mut switches = self.switches.lock();
        switches.delay.take().into_iter().for_each(sleep);
        fails(switches.exchange_fails)?;
        switches.exchanges += 1;
        switches.last = Some(*command);
        if command.enable {
            self.plant.release_brake();
        }
        self.plant.set_external_force(switches.force);
        let sample = self.sample(&switches);
        if command.number != self.number {
            self.number = command.number;
            (0..self.steps).for_each(|_| self.plant.step((command.torques * 0.01).into()));
            self.time += u64::from(self.steps) * (PLANT_STEP_SECONDS * 1e9) as u64;
        }
        Ok(sample)
    }

    fn stop(&mut self) -> io::Result<()> {
        let mut switches = self.switches.lock();
        if switches.stops_fail > 0 {
            switches.stops_fail -= 1;
            return fails(Some(libc::EIO));
        }
        switches.stops += 1;
        Ok(())
    }
}
