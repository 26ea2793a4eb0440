//! A finger with its servo, its link and its board in memory, on simulated time, so that every run is identical.

use std::cell::{RefCell, RefMut};
use std::rc::Rc;
use sun2xp::board::protocol::Identity;
use sun2xp::board::{Link, PortError, Terms, Transport};
use sun2xp::finger::events::EventLog;
use sun2xp::finger::{
    BlackBox, Bulletin, Elements, FingerServo, LinkRepairEnd, Mailbox, Reflexes, ServedPort, Servo, link_handover,
};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::Configuration;
use sun2xp::realtime::{Clock, Consumer, CycleTiming, Schedule, ring};
use sun2xp::simulated::{SimulatedBoard, SimulatedCable};

/// Functions that stand between a servo and the cable to its board. A test can replace them to disturb the line. The
/// default functions pass every call to the cable.
pub trait Hooks {
    fn write(&mut self, cable: &mut SimulatedCable, bytes: &[u8]) -> Result<usize, PortError> {
        cable.write(bytes)
    }

    fn read_until(&mut self, cable: &mut SimulatedCable, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
        cable.read_until(buffer, deadline)
    }

    fn discard_input(&mut self, cable: &mut SimulatedCable) -> Result<(), PortError> {
        cable.discard_input()
    }

    fn sleep_until(&mut self, cable: &mut SimulatedCable, deadline: u64) {
        cable.advance_to(deadline);
    }

    /// Returns the time of the host, ns.
    fn now(&self, cable: &SimulatedCable) -> u64 {
        cable.now()
    }
}

/// A cable and its hooks.
pub struct Place<H> {
    pub cable: SimulatedCable,
    pub hooks: H,
}

/// The host's end of a cable and the host's clock. Clones share the cable.
pub struct World<H>(Rc<RefCell<Place<H>>>);

impl<H> Clone for World<H> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

impl<H> World<H> {
    /// Constructs a cable to a simulated board with finger 1.
    pub fn new(configuration: &Configuration, hooks: H) -> Self {
        let board = SimulatedBoard::new(configuration, &[FingerNumber::ONE]).expect("a board");
        Self(Rc::new(RefCell::new(Place { cable: SimulatedCable::new(board), hooks })))
    }

    pub fn place(&self) -> RefMut<'_, Place<H>> {
        self.0.borrow_mut()
    }
}

impl<H: Hooks> Transport for World<H> {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        let Place { cable, hooks } = &mut *self.place();
        hooks.write(cable, bytes)
    }

    fn read_until(&mut self, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
        let Place { cable, hooks } = &mut *self.place();
        hooks.read_until(cable, buffer, deadline)
    }

    fn discard_input(&mut self) -> Result<(), PortError> {
        let Place { cable, hooks } = &mut *self.place();
        hooks.discard_input(cable)
    }

    fn now(&self) -> u64 {
        Clock::now(self)
    }
}

impl<H: Hooks> Clock for World<H> {
    fn now(&self) -> u64 {
        let place = self.place();
        place.hooks.now(&place.cable)
    }

    fn sleep_until(&self, deadline: u64) {
        let Place { cable, hooks } = &mut *self.place();
        hooks.sleep_until(cable, deadline);
    }
}

/// Finger 1 with everything that its planner and its servo need.
pub struct ServedFinger<W> {
    pub servo: Servo<W, W>,
    pub mailbox: Mailbox,
    pub repair_end: LinkRepairEnd<W>,
    pub timings: Consumer<CycleTiming>,
    pub black_box: BlackBox,
    pub identity: Identity,
    pub touch: Elements,
    pub reflexes: Reflexes,
    pub events: EventLog,
}

impl<W: Transport + Clock + Clone> ServedFinger<W> {
    /// Shakes hands with the board. The finger begins to open in the first cycle of the servo.
    pub fn new(world: &W, configuration: &Configuration) -> Self {
        Self::believing(world, configuration, configuration)
    }

    /// Does the same as [`ServedFinger::new`], but gives the servo the configuration `belief`, which may differ from
    /// that of the board.
    pub fn believing(world: &W, configuration: &Configuration, belief: &Configuration) -> Self {
        let period = (1e9 / configuration.hand.rate) as u64;
        let schedule = Schedule::new(Clock::now(world) + period, period);
        Self::in_thread(world, configuration, belief, schedule, |finger| finger)
    }

    /// Does the same as [`ServedFinger::believing`], with the schedule of one of several servo threads. `change`
    /// changes the finger before its first cycle.
    pub fn in_thread(
        world: &W,
        configuration: &Configuration,
        belief: &Configuration,
        schedule: Schedule,
        change: impl FnOnce(FingerServo) -> FingerServo,
    ) -> Self {
        let (hand, finger) = (&configuration.hand, &configuration.fingers[0]);
        let mut link = Link::new(world.clone());
        let deadline = Clock::now(world) + 1_000_000_000;
        let (identity, configured) =
            link.shake_hands(1, &Terms::new(hand, finger), deadline).expect("the board answers");
        let (producer, timings) = ring(100_000);
        let (recorder, black_box) = BlackBox::new(configuration, FingerNumber::ONE);
        let stiffness = finger.initial_stiffness();
        let (finger, mailbox) =
            FingerServo::new(belief, FingerNumber::ONE, stiffness, &identity, &configured, (producer, recorder))
                .expect("a finger");
        let (finger, reflexes) = finger.with_reflexes(FingerNumber::ONE, &Bulletin::new());
        let (touch, events) = (finger.touch().clone(), finger.event_log().clone());
        let (handover, repair_end) = link_handover();
        let ports = vec![ServedPort::new(link, vec![change(finger)]).with_handover(handover).with_requests(1)];
        let servo = Servo::new(world.clone(), schedule, ports);
        Self { servo, mailbox, repair_end, timings, black_box, identity, touch, reflexes, events }
    }
}
