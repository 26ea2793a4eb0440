//! Measures in real time how soon fingers react to a contact. The delay is the time from the contact at a tactile
//! element of a simulated fingertip to the first changed motor command. It is measured for the touched finger, and for
//! the fingers in other threads.
//!
//! The board reports which motor command is in force when the contact begins. The records of the servos show which
//! command is the first one with the set point of the reaction. A delay is the difference of the period numbers of
//! these two commands, so it includes the periods that a late servo skips.

use crate::Failure;
use crate::attempts::Attempts;
use crate::delays::{Delay, Delays};
use crate::explain::Watchers;
use crate::fingers::{Finger, reach_with};
use crate::under_control::under_control;
use clap::Args;
use nalgebra::{Vector3, Vector4};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::thread::{JoinHandle, sleep};
use std::time::{Duration, Instant};
use sun2xp::control::Activity;
use sun2xp::finger::events::EventKind;
use sun2xp::finger::{
    BlackBox, Bulletin, Condition, ControlRecord, CycleRecord, Mailbox, Reaction, Reflex, Reflexes, Servo, Stage,
};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::{Configuration, TouchElement};
use sun2xp::realtime::{MonotonicClock, Priority, spawn};
use sun2xp::simulated::SimulatedPort;

/// Measures the periods from a contact at a tactile element to the first changed motor command.
#[derive(Args)]
pub struct Arguments {
    /// Number of contacts.
    #[arg(long, default_value_t = Self::default().contacts)]
    contacts: u32,
}

impl Default for Arguments {
    fn default() -> Self {
        Self { contacts: 5000 }
    }
}

const PERIOD: u64 = 1_000_000;

/// Priorities of the servos and the boards, as in a hand, and of the threads that detect pauses of the machine.
const PRIORITY: u8 = 80;
const BOARD_PRIORITY: u8 = 20;
const WATCH_PRIORITY: u8 = 90;

/// The machine counts as paused during a delay if the pauses of one core within the delay add up to at least this
/// time, ns. A core pauses while it does not run its watch thread, whose priority is above that of all servos. The
/// transmission of Command and Reply takes a part of each period. If a board or a servo loses this much of the
/// remaining time, it can miss its period.
const PAUSE: u64 = PERIOD / 5;

/// Longest time until the fingers are under control.
const OPENING: Duration = Duration::from_secs(30);

/// The finger that is touched. It and the other two fingers react.
const TOUCHED: FingerNumber = FingerNumber::TWO;

/// Set point before each contact, rad.
const POSE: Vector3<f64> = Vector3::new(0.0, 0.5, 0.8);

/// Force that presses the element, along the last link, N.
const PRESS: f64 = 0.3;

/// Duration of a contact, and of the rest after it.
const CONTACT: Duration = Duration::from_millis(10);
const REST: Duration = Duration::from_millis(10);

/// Largest difference between a commanded torque and the torque of the board, N cm. The board's torques are rounded.
const ROUNDING: f64 = 1e-3;

/// One finger: the parts that remain outside its servo thread.
struct Member {
    mailbox: Mailbox,
    board: SimulatedPort,
    black_box: BlackBox,
    /// Beginning of period 0, ns.
    start: u64,
    _reflexes: Reflexes,
}

/// The reactions so far: those of the touched finger, and those of the other fingers.
struct Measured {
    own: Delays,
    others: Delays,
    /// Number of contacts, including those whose period is unknown.
    contacts: u32,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let watchers = Watchers::start(WATCH_PRIORITY)?;
    let (mut measured, mut attempts) = (Measured::default(), Attempts::default());
    attempts.measure("reactions", || measured.with_new_fingers(arguments.contacts));
    let pauses = watchers.finish();
    let Measured { own, others, contacts } = measured;
    let made = own.contacts();
    println!(
        "| contact at a tactile element of the simulated board, until the first changed motor command | reactions | \
         within the goal | 99.9 % | worst | none | during pauses of the machine | within the goal, without pauses |\n\
         |---|---|---|---|---|---|---|---|"
    );
    own.print("of the touched finger (goal: 99.9 % within 2 periods)", PAUSE, &pauses);
    others.print("of the other two fingers, each in its own thread (goal: 99.9 % within 3 periods)", PAUSE, &pauses);
    println!("\n{contacts} of {} contacts were made. {attempts}.\n", arguments.contacts);
    Ok(attempts.check([("contacts", made)])?)
}

impl Default for Measured {
    fn default() -> Self {
        Self { own: Delays::new(2), others: Delays::new(3), contacts: 0 }
    }
}

impl Measured {
    /// Starts three fingers and touches one of them until `wanted` contacts were made, including those of earlier
    /// calls.
    fn with_new_fingers(&mut self, wanted: u32) -> Result<(), Failure> {
        let (configuration, ended) = (configuration(), Arc::new(AtomicBool::new(false)));
        let (mut members, servos) = start(&configuration, &ended)?;
        let measured = opened(&mut members).and_then(|()| {
            while self.contacts < wanted {
                self.touch(&mut members, &configuration)?;
            }
            Ok(())
        });
        ended.store(true, Relaxed);
        servos
            .into_iter()
            .try_for_each(|servo| servo.join().map_err(|_| "a servo panicked: standard error has its message"))?;
        measured
    }

    /// Touches the finger once. A contact during which a finger has faulted does not count.
    fn touch(&mut self, members: &mut [Member], configuration: &Configuration) -> Result<(), Failure> {
        let address = configuration.address(TOUCHED);
        for member in members.iter() {
            member.mailbox.send(|set_point| set_point.joints = POSE).map_err(|fault| fault.to_string())?;
        }
        // The contacts begin at any time within a period.
        sleep(REST + Duration::from_micros(u64::from(self.contacts) * 997 % 1000));
        let acting = press(&members[TOUCHED.index()].board, address, PRESS)?;
        sleep(CONTACT);
        press(&members[TOUCHED.index()].board, address, 0.0)?;
        members.iter_mut().for_each(|member| member.black_box.collect());
        check(members)?;
        self.contacts += 1;
        let Some(touched) = members[TOUCHED.index()].period_of(&acting) else {
            // The records of this time were lost, because this thread did not run.
            return Ok(());
        };
        for (member, number) in members.iter().zip(FingerNumber::ALL) {
            let delays = if number == TOUCHED { &mut self.own } else { &mut self.others };
            delays.add(member.reaction(touched).map(|reacted| member.delay(touched, reacted)));
        }
        Ok(())
    }
}

fn configuration() -> Configuration {
    let mut configuration = Configuration::default();
    let element = TouchElement { position: [0.0; 3], normal: [0.0, 0.0, 1.0], newton_per_count: 0.001, zero: 200 };
    configuration.fingers[TOUCHED.index()].touch.elements = vec![element];
    configuration
}

/// Starts a servo thread for each finger.
fn start(
    configuration: &Configuration,
    ended: &Arc<AtomicBool>,
) -> Result<(Vec<Member>, Vec<JoinHandle<()>>), Failure> {
    let bulletin = Bulletin::new();
    let mut rules = Vec::new();
    let fingers = reach_with(configuration, PERIOD, BOARD_PRIORITY, |number, servo| {
        let (servo, reflexes) = servo.with_reflexes(number, &bulletin);
        rules.push(reflexes);
        servo
    })?;
    let (mut members, mut servos) = (Vec::new(), Vec::new());
    for ((finger, reflexes), number) in fingers.into_iter().zip(rules).zip(FingerNumber::ALL) {
        let event = EventKind::TouchMade;
        let condition = match number {
            TOUCHED => Condition::Event(event),
            _ => Condition::OtherFinger { finger: TOUCHED, event },
        };
        let hold = Reflex { condition, reaction: Reaction::Hold, priority: 0, refractory: 0.0, inhibition: 0.0 };
        reflexes.install(hold).ok_or("no place for a rule")?;
        let Finger { mailbox, port, schedule, board, uncollected: (timings, black_box), start } = finger;
        let ended = ended.clone();
        servos.push(spawn("servo", Priority { fifo: PRIORITY, core: None }, move |_| {
            // A hand in which every finger has its own line constructs its servos in the same way.
            let mut servo = Servo::new(MonotonicClock, schedule, vec![port.with_requests(1)]);
            while !ended.load(Relaxed) {
                servo.cycle();
            }
            drop(timings);
        })?);
        members.push(Member { mailbox, board, black_box, start, _reflexes: reflexes });
    }
    Ok((members, servos))
}

/// Waits until all fingers are springs.
fn opened(members: &mut [Member]) -> Result<(), Failure> {
    let begun = Instant::now();
    while members.iter().any(|member| member.mailbox.report().stage == Stage::Opening) && begun.elapsed() < OPENING {
        sleep(REST);
        members.iter_mut().for_each(|member| member.black_box.collect());
    }
    check(members)
}

/// Checks that all fingers are springs.
fn check(members: &[Member]) -> Result<(), Failure> {
    let stages = members.iter().map(|member| member.mailbox.report().stage);
    Ok((1..).zip(stages).try_for_each(|(finger, stage)| under_control(finger, &stage))?)
}

/// Presses the element with a force, N, and returns the torques of the motors at this moment, N cm.
fn press(board: &SimulatedPort, address: u8, force: f64) -> Result<Vector4<f64>, Failure> {
    let pressed = board.with_finger(address, |finger| {
        let acting = finger.motor_torques();
        let turn = finger.plant().links().tip_rotation(&finger.plant().joints());
        finger.plant().set_external_force(turn * Vector3::new(0.0, 0.0, -force));
        acting
    });
    Ok(pressed.ok_or("the board has no such finger")?)
}

impl Member {
    /// Returns the period whose command has these torques, N cm.
    fn period_of(&self, torques: &Vector4<f64>) -> Option<u64> {
        let distance = |control: &ControlRecord| (control.command.motor_torques - torques).amax();
        let records = self.newest().filter_map(|record| Some((record.began, distance(&record.control?))));
        let (began, nearest) = records.min_by(|one, other| one.1.total_cmp(&other.1))?;
        (nearest < ROUNDING).then(|| self.period(began))
    }

    /// Returns the period of the first command after period `from` that follows another set point than [`POSE`].
    fn reaction(&self, from: u64) -> Option<u64> {
        let reacts = |record: &CycleRecord| {
            record.control.is_some_and(|control| match control.input.activity {
                Activity::Follow(set_point) => set_point.joints != POSE,
                _ => false,
            })
        };
        let later = self.newest().filter(|record| self.period(record.began) > from && reacts(record));
        later.map(|record| self.period(record.began)).min()
    }

    /// Returns the records of the newest contact.
    fn newest(&self) -> impl Iterator<Item = CycleRecord> {
        let newest = self.black_box.record(None).map_or(0, |kept| kept.newest);
        let length = (CONTACT.as_nanos() as u64 + REST.as_nanos() as u64) / PERIOD;
        (newest.saturating_sub(length)..=newest).filter_map(|cycle| Some(self.black_box.record(Some(cycle))?.record))
    }

    /// Returns the delay from period `touched` to period `reacted` of this finger.
    fn delay(&self, touched: u64, reacted: u64) -> Delay {
        let time = [touched, reacted + 1].map(|period| self.start + period * PERIOD);
        Delay { periods: reacted - touched, time }
    }

    /// Returns the number of the period that contains the time `began`, ns.
    fn period(&self, began: u64) -> u64 {
        began.saturating_sub(self.start) / PERIOD
    }
}
