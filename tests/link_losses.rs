//! Measures the cost of lost, damaged, late, doubled and foreign bytes on the cable of a finger, on simulated time.
//!
//! `SUN2XP_SECONDS=60 cargo test --test link_losses -- --nocapture` prints the table of docs/measurements.md.

#[allow(dead_code)]
#[path = "common/finger_on_a_cable.rs"]
mod finger_on_a_cable;

use finger_on_a_cable::{Hooks, ServedFinger, World};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use std::collections::VecDeque;
use sun2xp::board::protocol::Status;
use sun2xp::board::{PortError, Transport};
use sun2xp::finger::{FaultKind, FingerReport, Stage};
use sun2xp::model::configuration::{Configuration, EndState, Scheme};
use sun2xp::simulated::SimulatedCable;

const MS: u64 = 1_000_000;

/// What can happen to a reply.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Mishap {
    Dropped,
    Damaged,
    CutShort,
    Late,
    Doubled,
    AmongRubbish,
}

impl Mishap {
    const ALL: [Mishap; 6] =
        [Mishap::Dropped, Mishap::Damaged, Mishap::CutShort, Mishap::Late, Mishap::Doubled, Mishap::AmongRubbish];

    /// Returns whether the mishap costs a period. It does if the reply does not arrive in its own period.
    fn costs(self) -> bool {
        !matches!(self, Mishap::Doubled | Mishap::AmongRubbish)
    }
}

/// A cable that disturbs replies.
struct Line {
    random: Pcg64,
    /// Fraction of the replies that are affected.
    share: f64,
    /// Whether the board has stopped answering.
    silent: bool,
    arriving: VecDeque<u8>,
    late: Vec<u8>,
    /// Mishaps so far, by kind.
    happened: [u64; 6],
    cost: u64,
}

impl Line {
    fn mishap(&mut self) -> Option<Mishap> {
        let dice = self.random.next_u64();
        let hit = (dice >> 11) as f64 / (1u64 << 53) as f64 >= 1.0 - self.share;
        let index = (self.random.next_u64() % 6) as usize;
        let mishap = hit.then_some(Mishap::ALL[index])?;
        self.happened[index] += 1;
        self.cost += u64::from(mishap.costs());
        Some(mishap)
    }

    fn spoil(&mut self, mut reply: Vec<u8>) {
        let place = self.random.next_u64() as usize % reply.len();
        let other = self.random.next_u64();
        // A delayed reply arrives before the reply of this period.
        let mut bytes = std::mem::take(&mut self.late);
        match self.mishap() {
            None => bytes.extend(&reply),
            Some(Mishap::Dropped) => {}
            Some(Mishap::Damaged) => {
                reply[place] ^= 1 << (other % 8);
                bytes.extend(&reply);
            }
            Some(Mishap::CutShort) => bytes.extend(&reply[..place]),
            Some(Mishap::Late) => self.late = reply,
            Some(Mishap::Doubled) => {
                bytes.extend(&reply);
                bytes.extend(&reply);
            }
            Some(Mishap::AmongRubbish) => {
                bytes.extend(other.to_le_bytes());
                bytes.push(0);
                bytes.extend(&reply);
            }
        }
        self.arriving.extend(bytes);
    }
}

impl Hooks for Line {
    fn write(&mut self, cable: &mut SimulatedCable, bytes: &[u8]) -> Result<usize, PortError> {
        cable.write(bytes)?;
        let mut reply = [0; 512];
        let now = cable.now();
        let taken = cable.read_until(&mut reply, now)?;
        if taken > 0 && !self.silent {
            self.spoil(reply[..taken].to_vec());
        }
        Ok(bytes.len())
    }

    fn read_until(&mut self, cable: &mut SimulatedCable, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
        if self.arriving.is_empty() {
            cable.advance_to(deadline);
        }
        let taken = buffer.len().min(self.arriving.len());
        for (place, byte) in buffer.iter_mut().zip(self.arriving.drain(..taken)) {
            *place = byte;
        }
        Ok(taken)
    }

    fn discard_input(&mut self, _: &mut SimulatedCable) -> Result<(), PortError> {
        self.arriving.clear();
        Ok(())
    }
}

struct Rig {
    world: World<Line>,
    finger: ServedFinger<World<Line>>,
}

impl Rig {
    /// Opens finger 1 on a cable, and waits until it is running.
    fn new(configuration: &mut Configuration) -> Self {
        // The port must not be "simulated": the time limits of a built-in board are longer.
        configuration.fingers[0].port = "/dev/cable".into();
        let line = Line {
            random: Pcg64::seed_from_u64(11),
            share: 0.0,
            silent: false,
            arriving: VecDeque::new(),
            late: Vec::new(),
            happened: [0; 6],
            cost: 0,
        };
        let world = World::new(configuration, line);
        let finger = ServedFinger::new(&world, configuration);
        let mut rig = Self { world, finger };
        while rig.report().stage == Stage::Opening {
            rig.finger.servo.cycle();
        }
        assert_eq!(rig.report().stage, Stage::Running);
        rig
    }

    fn report(&self) -> FingerReport {
        self.finger.mailbox.report()
    }

    fn cycles(&mut self, count: u64) {
        for cycle in 0..count {
            self.finger.servo.cycle();
            if cycle % 100 == 0 {
                self.finger.black_box.collect();
            }
        }
        self.finger.black_box.collect();
    }
}

fn seconds() -> u64 {
    std::env::var("SUN2XP_SECONDS").map_or(4, |seconds| seconds.parse().expect("a number"))
}

#[test]
fn each_mishap_costs_its_own_period_and_no_more() {
    for (percent, faultless) in [(1, true), (5, true), (20, false)] {
        let mut rig = Rig::new(&mut Configuration::default());
        rig.world.place().hooks.share = f64::from(percent) / 100.0;
        let mut farthest = 0.0f64;
        for second in 0..seconds() {
            let target = [0.2, 0.6, if second % 2 == 0 { 1.1 } else { 0.9 }];
            rig.finger.mailbox.send(|set_point| set_point.joints = target.into()).expect("not faulted");
            rig.cycles(999);
            farthest = (rig.report().cycle.joints - nalgebra::Vector3::from(target)).amax().max(farthest);
            rig.cycles(1);
        }
        let (report, place) = (rig.report(), rig.world.place());
        let line = &place.hooks;
        println!(
            "{percent:2} %: {} cycles, mishaps {:?}, {} periods lost, {} replies late, {} twice, {} damaged frames, \
             off by {farthest:.4} rad",
            report.losses.cycles,
            Mishap::ALL.iter().zip(line.happened).collect::<Vec<_>>(),
            report.losses.lost_replies,
            report.losses.late_replies,
            report.losses.duplicate_replies,
            report.losses.damaged_frames
        );
        assert_eq!(report.losses.lost_replies, line.cost, "{percent} %");
        assert!(line.happened.iter().all(|&count| count > 0), "{:?}", line.happened);
        assert!(!faultless || report.stage == Stage::Running, "{percent} %: {:?}", report.stage);
        // The servo recognises a late or doubled reply by its sequence number. The last such reply may still be in
        // transit.
        let of = |mishap: Mishap| line.happened[mishap as usize];
        let near = |counted: u64, happened: u64| counted <= happened && counted + 1 >= happened;
        assert!(near(report.losses.late_replies, of(Mishap::Late)), "{percent} %: {report:?}");
        assert!(near(report.losses.duplicate_replies, of(Mishap::Doubled)), "{percent} %: {report:?}");
        assert!(farthest < 0.03, "{percent} %: {farthest} rad");
        let recording = rig.finger.black_box.recording().expect("a recording");
        let replayed = recording.replay().expect("replayable");
        assert!(replayed.different == 0 && replayed.cycles >= 2000, "{replayed:?}");
    }
}

/// The commands stop abruptly, as they do after SIGKILL of the planner.
#[test]
fn a_board_without_its_planner_is_in_its_end_state_within_the_watchdogs_time() {
    for (end_state, rest) in [(EndState::Release, 0.0), (EndState::Hold, 0.2)] {
        let mut configuration = Configuration::default();
        (configuration.hand.end_state, configuration.hand.hold_torque_limit) = (end_state, 0.2);
        let mut rig = Rig::new(&mut configuration);
        rig.cycles(200);
        let last = rig.report().last;
        drop(rig.finger.servo);
        let cable = &mut rig.world.place().cable;
        let mut now = last;
        while !cable.board().finger(1).expect("finger 1").status().has(Status::ENDED) {
            now += MS / 10;
            cable.advance_to(now);
            assert!(now - last < 25 * MS, "never ends");
        }
        let strongest = cable.board().finger(1).expect("finger 1").motor_torques().amax();
        println!("{end_state:?}: in its end state {:.1} ms after the last command", (now - last) as f64 * 1e-6);
        // The simulated board checks its watchdog only at steps of the physics, so it may trip slightly late.
        assert!(now - last <= 18 * MS + MS / 2, "{} ns", now - last);
        assert!((strongest - rest).abs() < 1e-3, "{strongest} N cm");
    }
}

#[test]
fn a_finger_whose_board_falls_silent_is_held_faded_and_faulted_within_20_ms() {
    let mut configuration = Configuration::default();
    // After a lost reply, Figure 10 repeats its last command. State feedback would compute a new one from predictions.
    configuration.fingers[0].controller.scheme = Some(Scheme::Figure10);
    let mut rig = Rig::new(&mut configuration);
    rig.cycles(200);
    // The last good reply has the sample that the board takes when the command of this cycle arrives. So the times
    // below count from this cycle.
    rig.finger.servo.cycle();
    let good = rig.report().last;
    rig.world.place().hooks.silent = true;
    let torques = |rig: &Rig| rig.world.place().cable.board().finger(1).expect("finger 1").motor_torques();
    let (before, mut at_rest) = (torques(&rig), None);
    while rig.report().stage == Stage::Running {
        rig.finger.servo.cycle();
        let after = rig.report().last - good;
        let strongest = torques(&rig).amax();
        if after < 4 * MS {
            assert!((torques(&rig) - before).amax() < 0.1 * before.amax(), "not held after {after} ns");
        }
        if strongest == 0.0 {
            at_rest.get_or_insert(after);
        }
    }
    let at_rest = at_rest.expect("at rest before it faults");
    assert!((10 * MS..=12 * MS).contains(&at_rest), "at rest after {at_rest} ns");
    let Stage::Faulted(fault) = rig.report().stage else { panic!("{:?}", rig.report().stage) };
    assert_eq!(fault.kind, FaultKind::LostReplies);
    rig.finger.servo.cycle();
    let ended = Transport::now(&rig.world) - good;
    let status = rig.world.place().cable.board().finger(1).expect("finger 1").status();
    assert!(status.has(Status::ENDED) && !status.has(Status::WATCHDOG_TRIPPED), "{status:?}");
    assert!(ended <= 20 * MS, "stopped after {ended} ns");
    println!("at rest {at_rest} ns after the last good reply, stopped within {ended} ns");
}
