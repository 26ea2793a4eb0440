//! A hand of three fingers over a table with an object. The palm faces down.

use crate::shared_cable::SharedCable;
use nalgebra::{Matrix3, Point3, Vector3};
use sun2xp::board::{Link, Terms};
use sun2xp::control::{Law, spatial};
use sun2xp::finger::events::EventKind;
use sun2xp::finger::{
    BlackBox, Bulletin, Condition, FingerServo, Mailbox, Reaction, Reflex, Reflexes, ServedPort, Servo, Stage,
};
use sun2xp::model::configuration::{Configuration, ConfiguredObject, FINGERS, ObjectShape};
use sun2xp::model::{FingerNumber, InverseKinematics};
use sun2xp::realtime::{Clock, Consumer, CycleTiming, Schedule, ring};
use sun2xp::simulated::{ObjectState, Scene, SimulatedBoard};

/// Radius of the ball, cm.
pub const RADIUS: f64 = 1.5;

/// Position of the object on the table, in the palm's frame, cm.
pub const START: Vector3<f64> = Vector3::new(0.0, 0.0, 10.5);

/// A hand with its servos.
pub struct GraspingHand {
    cable: SharedCable,
    servo: Servo<SharedCable, SharedCable>,
    mailboxes: Vec<Mailbox>,
    reflexes: Vec<Reflexes>,
    configuration: Configuration,
    _unread: Vec<(Consumer<CycleTiming>, BlackBox)>,
}

/// Returns the configuration of a hand whose fingers are around a ball on a table.
pub fn around_a_ball(mass: f64, friction: f64, seed: u64) -> Configuration {
    let mut configuration = Configuration::default();
    configuration.hand.gravity = [0.0, 0.0, 9.81];
    configuration.hand.simulated_object = Some(ConfiguredObject {
        shape: ObjectShape::Ball { radius: RADIUS },
        mass,
        friction,
        position: START.into(),
        table: Some(START.z + RADIUS),
        ..Default::default()
    });
    for finger in &mut configuration.fingers {
        // With the port "simulated", the servo would apply the longer time limits of a built-in simulated board.
        (finger.port, finger.thread) = ("in memory".into(), 1);
        finger.simulation.start_degrees = [0.0, -25.0, 80.0];
        finger.simulation.seed = seed;
    }
    configuration
}

/// Returns the directions from the middle of the ball to the contacts of the fingers, in the palm's frame.
pub fn directions() -> [Vector3<f64>; FINGERS] {
    let (sine, cosine) = 60.0f64.to_radians().sin_cos();
    [Vector3::new(sine, cosine, 0.0), Vector3::new(-sine, cosine, 0.0), Vector3::new(0.0, -1.0, 0.0)]
}

impl GraspingHand {
    /// Opens the hand.
    pub fn open(configuration: Configuration) -> Self {
        configuration.check().expect("usable");
        let cable = SharedCable::new(SimulatedBoard::new(&configuration, &FingerNumber::ALL).expect("a board"));
        let mut link = Link::new(cable.clone());
        let (mut fingers, mut mailboxes, mut unread) = (Vec::new(), Vec::new(), Vec::new());
        let (bulletin, mut reflexes) = (Bulletin::new(), Vec::new());
        for number in FingerNumber::ALL {
            let finger = &configuration.fingers[number.index()];
            let deadline = Clock::now(&cable) + 1_000_000_000;
            let terms = Terms::new(&configuration.hand, finger);
            let (identity, configured) =
                link.shake_hands(configuration.address(number), &terms, deadline).expect("the board answers");
            let (producer, timings) = ring(1000);
            let (recorder, black_box) = BlackBox::new(&configuration, number);
            let stiffness = finger.initial_stiffness();
            let (servo, mailbox) =
                FingerServo::new(&configuration, number, stiffness, &identity, &configured, (producer, recorder))
                    .expect("a finger");
            let (servo, rules) = servo.with_reflexes(number, &bulletin);
            fingers.push(servo);
            reflexes.push(rules);
            mailboxes.push(mailbox);
            unread.push((timings, black_box));
        }
        let period = configuration.hand.period();
        let schedule = Schedule::new(Clock::now(&cable) + period, period);
        let servo = Servo::new(cable.clone(), schedule, vec![ServedPort::new(link, fingers)]);
        let mut hand = Self { cable, servo, mailboxes, reflexes, configuration, _unread: unread };
        for _ in 0..10_000 {
            hand.servo.cycle();
            if hand.mailboxes.iter().all(|mailbox| mailbox.report().stage == Stage::Running) {
                return hand;
            }
        }
        panic!("not open: {:?}", hand.mailboxes.iter().map(|mailbox| mailbox.report().stage).collect::<Vec<_>>());
    }

    pub fn run(&mut self, cycles: usize) {
        for _ in 0..cycles {
            self.servo.cycle();
        }
    }

    /// Sets the anchor of a fingertip's spring, in the palm's frame, cm.
    pub fn send_tip(&self, number: FingerNumber, in_palm: Vector3<f64>) {
        let (finger, mailbox) = (&self.configuration.fingers[number.index()], &self.mailboxes[number.index()]);
        let tip = self.configuration.finger_to_palm(number).inverse_transform_point(&Point3::from(in_palm)).coords;
        let inverse = InverseKinematics::new(finger.links(), finger.joint_limits());
        let joints = inverse.joints(&tip, &mailbox.report().cycle.joints).expect("within reach");
        mailbox.send(|set_point| (set_point.joints, set_point.law) = (joints, Law::Exact)).expect("not faulted");
    }

    /// Sets the anchors of all fingertips around a point of the palm's frame, at this distance from it, cm.
    pub fn send_around(&self, middle: Vector3<f64>, distance: f64) {
        for (number, direction) in FingerNumber::ALL.into_iter().zip(directions()) {
            self.send_tip(number, middle + direction * distance);
        }
    }

    pub fn send_stiffness(&self, newton_per_cm: f64) {
        for mailbox in &self.mailboxes {
            let stiffness = spatial(&Matrix3::from_diagonal_element(newton_per_cm));
            mailbox.send(|set_point| set_point.stiffness = stiffness).expect("not faulted");
        }
    }

    /// Makes all fingers press harder toward the middle when the contact of one of them is about to slip.
    pub fn tighten_on_slip(&self, by: f64, most: f64) {
        for (number, outward) in FingerNumber::ALL.into_iter().zip(directions()) {
            let direction = self.configuration.finger_to_palm(number).inverse_transform_vector(&-outward);
            let reaction = Reaction::Grip { direction, by, most };
            for slipping in FingerNumber::ALL {
                let condition = if slipping == number {
                    Condition::Event(EventKind::Slip)
                } else {
                    Condition::OtherFinger { finger: slipping, event: EventKind::Slip }
                };
                let reflex = Reflex { condition, reaction, priority: 0, refractory: 0.0, inhibition: 0.0 };
                self.reflexes[number.index()].install(reflex).expect("a place");
            }
        }
    }

    pub fn object(&self) -> ObjectState {
        self.scene(|scene| scene.state())
    }

    pub fn scene<R>(&self, look: impl FnOnce(&mut Scene) -> R) -> R {
        look(self.cable.cable().board().scene().expect("an object"))
    }

    /// Ends the servo of a finger, 0 to 2.
    pub fn close_finger(&self, index: usize) {
        self.mailboxes[index].close();
    }

    pub fn stages(&self) -> Vec<Stage> {
        self.mailboxes.iter().map(|mailbox| mailbox.report().stage).collect()
    }

    /// Closes the fingers around the object on the table, and gives the object 500 cycles to come to rest.
    pub fn grasp(&mut self, squeeze: f64) {
        self.run(300);
        self.send_around(START, RADIUS + 0.4);
        self.run(700);
        for step in 1..=20 {
            let distance = RADIUS + 0.4 - (0.4 + squeeze) * f64::from(step) / 20.0;
            self.send_around(START, distance);
            self.run(30);
        }
        self.run(500);
    }

    /// Lifts the anchors of all fingertips by `height`, cm, within 1000 cycles, and then waits for 1000 cycles.
    pub fn lift(&mut self, height: f64, squeeze: f64) {
        for step in 1..=50 {
            let up = Vector3::new(0.0, 0.0, -height * f64::from(step) / 50.0);
            self.send_around(START + up, RADIUS - squeeze);
            self.run(20);
        }
        self.run(1000);
    }
}
