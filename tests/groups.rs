//! Groups of fingers in two servo threads, on simulated time: the set points of a group take effect in the same period,
//! whenever the planner sends them.

#[allow(dead_code)]
#[path = "common/finger_on_a_cable.rs"]
mod finger_on_a_cable;

use finger_on_a_cable::{Hooks, ServedFinger, World};
use nalgebra::Vector3;
use std::cell::{Cell, RefCell};
use std::convert::Infallible;
use std::rc::Rc;
use sun2xp::board::{PortError, Transport};
use sun2xp::finger::{FingerReport, GroupGate, Mailbox, Replaced, Servo, Stage, Validity};
use sun2xp::model::configuration::Configuration;
use sun2xp::realtime::Schedule;
use sun2xp::simulated::SimulatedCable;

/// Number of groups in each test in which the planner sends at random moments.
const GROUPS: u32 = 10_000;

/// Pseudo-random numbers (xorshift).
struct Random(Cell<u64>);

impl Random {
    /// Returns true once in `of` calls on average.
    fn one_in(&self, of: u64) -> bool {
        let mut state = self.0.get();
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        self.0.set(state);
        state.is_multiple_of(of)
    }
}

/// The planner. It sends a group when a servo reads its clock or its port and the random number says so.
struct Planner {
    gate: GroupGate,
    mailboxes: RefCell<Vec<Mailbox>>,
    random: Random,
    sending: Cell<bool>,
    sent: Cell<u32>,
}

/// The joint angles of a group, rad. Every group has its own.
fn pose(group: u32) -> Vector3<f64> {
    Vector3::new(0.0, 0.5, 0.8 + 1e-6 * f64::from(group))
}

/// Returns the group whose set point is in effect, or 0 before the first group.
fn group_of(report: &FingerReport) -> u32 {
    let joints = report.set_point.joints;
    if joints.xy() == pose(0).xy() { ((joints[2] - 0.8) * 1e6).round() as u32 } else { 0 }
}

impl Planner {
    fn perhaps_send(&self) {
        if self.sending.get() && self.random.one_in(6) {
            self.send();
        }
    }

    fn send(&self) {
        let mailboxes = self.mailboxes.borrow();
        let group = self.sent.get() + 1;
        let mut prepared = [const { None }; 3];
        for (mailbox, place) in mailboxes.iter().zip(&mut prepared) {
            let change = mailbox.prepare((Replaced::Place, Validity::default()), |set_point| {
                set_point.joints = pose(group);
                Ok::<_, Infallible>(())
            });
            let Ok(change) = change.expect("not faulted");
            // There is no room if the planner sends groups faster than the servos take them. In this case
            // `Hand::send_group` refuses the group.
            if !change.has_room() {
                return;
            }
            *place = Some(change);
        }
        self.gate.send(prepared);
        self.sent.set(group);
    }
}

/// Calls the planner whenever the servo reads the clock or the port, and makes some cycles late.
struct Moments {
    planner: Rc<Planner>,
    late: bool,
}

impl Hooks for Moments {
    fn now(&self, cable: &SimulatedCable) -> u64 {
        self.planner.perhaps_send();
        cable.now()
    }

    fn sleep_until(&mut self, cable: &mut SimulatedCable, deadline: u64) {
        let late = self.late && self.planner.sending.get() && self.planner.random.one_in(50);
        cable.advance_to(if late { deadline + 2_700_000 } else { deadline });
    }

    fn read_until(&mut self, cable: &mut SimulatedCable, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
        self.planner.perhaps_send();
        cable.read_until(buffer, deadline)
    }
}

type Place = World<Moments>;

/// Two fingers in two servo threads.
struct Pair {
    planner: Rc<Planner>,
    servos: Vec<Servo<Place, Place>>,
}

impl Pair {
    /// Opens the fingers. If `late` is true, cycles of the second thread are late now and then.
    fn open(seed: u64, late: bool) -> Self {
        let mut configuration = Configuration::default();
        configuration.fingers[0].port = "in memory".into();
        let planner = Rc::new(Planner {
            gate: GroupGate::new(),
            mailboxes: RefCell::default(),
            random: Random(Cell::new(seed)),
            sending: Cell::new(false),
            sent: Cell::new(0),
        });
        let mut servos = Vec::new();
        for place in 0..2 {
            let world = World::new(&configuration, Moments { planner: planner.clone(), late: late && place == 1 });
            let schedule = Schedule::staggered(10_000_000, 1_000_000, place, 2);
            let in_groups = |finger: sun2xp::finger::FingerServo| finger.in_groups(planner.gate.clone());
            let served = ServedFinger::in_thread(&world, &configuration, &configuration, schedule, in_groups);
            planner.mailboxes.borrow_mut().push(served.mailbox);
            servos.push(served.servo);
        }
        let mut pair = Self { planner, servos };
        while pair.reports().iter().any(|report| report.stage != Stage::Running) {
            pair.cycle();
        }
        pair.planner.sending.set(true);
        pair
    }

    fn reports(&self) -> [FingerReport; 2] {
        let mailboxes = self.planner.mailboxes.borrow();
        [0, 1].map(|place| mailboxes[place].report())
    }

    /// Runs the cycle that begins first. Returns the place of its servo and its report.
    fn cycle(&mut self) -> (usize, FingerReport) {
        let [first, second] = self.reports();
        let place = usize::from(second.next < first.next);
        self.servos[place].cycle();
        let report = self.reports()[place];
        assert!(!matches!(report.stage, Stage::Faulted(_)), "{}", report.stage);
        (place, report)
    }
}

#[test]
fn ten_thousand_groups_take_effect_in_the_same_period() {
    let mut pair = Pair::open(0x5eed, false);
    // The newest group in effect in each period, for each finger.
    let mut in_effect = [const { Vec::new() }; 2];
    while pair.planner.sent.get() < GROUPS {
        let (place, report) = pair.cycle();
        in_effect[place].push((report.period, group_of(&report), report.set_point_period));
    }
    let [first, second] = &in_effect;
    let compared = first.len().min(second.len());
    assert!(compared > 1000, "{compared} periods");
    assert_eq!(first[..compared], second[..compared]);
    assert!(first.windows(2).all(|pair| pair[1].0 == pair[0].0 + 1 && pair[1].1 >= pair[0].1));
    // In most periods the newest group differs from that of the period before.
    let changes = first.windows(2).filter(|pair| pair[1].1 != pair[0].1).count();
    assert!(changes * 10 > compared * 7, "{changes} changes in {compared} periods");
}

#[test]
fn a_finger_whose_servo_skips_the_period_follows_in_its_next_cycle() {
    let mut pair = Pair::open(0xfeed, true);
    let mut in_effect = [const { Vec::new() }; 2];
    while pair.planner.sent.get() < GROUPS {
        let (place, report) = pair.cycle();
        in_effect[place].push((report.period, group_of(&report)));
    }
    let [punctual, late] = &in_effect;
    let skipped = late.windows(2).filter(|pair| pair[1].0 > pair[0].0 + 1).count();
    assert!(skipped > 20, "{skipped} skips");
    for &(period, group) in late {
        // In every period in which both servos ran, both fingers have the same group.
        if let Ok(index) = punctual.binary_search_by_key(&period, |entry| entry.0) {
            assert_eq!(punctual[index].1, group, "period {period}");
        }
    }
}

#[test]
fn a_later_set_point_of_one_finger_does_not_bring_its_group_forward() {
    let mut pair = Pair::open(0xbeef, false);
    pair.planner.sending.set(false);
    for _ in 0..4 {
        pair.cycle();
    }
    let before = pair.reports().map(|report| report.period);
    pair.planner.send();
    let group = pair.planner.sent.get();
    pair.planner.mailboxes.borrow()[0].send(|set_point| set_point.damping = 1.1).expect("not faulted");
    let mut seen = [None; 2];
    while seen.contains(&None) {
        let (place, report) = pair.cycle();
        if group_of(&report) == group {
            seen[place].get_or_insert(report.period);
        } else {
            assert_ne!(report.set_point.damping, 1.1, "the set point includes the pose of the group");
        }
    }
    assert_eq!(seen[0], seen[1]);
    assert!(seen[0] > before.into_iter().max());
    assert_eq!(pair.reports()[0].set_point.damping, 1.1, "sent after the group");
    assert_eq!(pair.reports()[1].set_point.damping, 1.0);
}
