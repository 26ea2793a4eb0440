//! Between planners and one finger's servo: set points down, reports up, neither side waiting for the other.
//!
//! Both ways go through a triple buffer: whole values, wait-free. A lock would let a planner stop a servo (no priority
//! inheritance), and a channel is not lock-free when a real-time thread shares a core with a preempted sender. The
//! planners' own side is locked among themselves only.

use crate::control::SetPoint;
use crate::finger::{Adjustable, Fault, FingerReport, Order, Stage};
use crate::realtime::{Input, LockedMemory, Output, Pages, SharedPages, triple_buffer};
use parking_lot::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// The planners' end.
pub struct Mailbox {
    planners: Mutex<PlannersEnd>,
    closing: SharedPages<AtomicBool>,
}

struct PlannersEnd {
    sent: SentSetPoint,
    set_points: Input<SentSetPoint>,
    adjustments: Input<Adjustable>,
    orders: Input<Order>,
    ordered: u32,
    reports: Output<FingerReport>,
}

/// A set point for one stretch of a finger's life as a spring. Servo and planners tell stretches by their number,
/// because planners change parts of a set point: what they start from must be what the servo holds, and when that
/// changes is the servo's to say.
#[derive(Clone, Copy)]
struct SentSetPoint {
    /// [`FingerReport::springs`].
    spring: u32,
    set_point: SetPoint,
}

/// The servo's end. Nothing here waits or allocates.
pub(super) struct ServoEnd {
    set_points: Output<SentSetPoint>,
    adjustments: Output<Adjustable>,
    orders: Output<Order>,
    reports: Input<FingerReport>,
    closing: SharedPages<AtomicBool>,
}

/// A mailbox whose both ends hold `report`, with its set point, and `adjustable`; and the memory that they share.
pub(super) fn mailbox(report: FingerReport, adjustable: &Adjustable) -> (Mailbox, ServoEnd, LockedMemory) {
    let mut memory = LockedMemory::default();
    let sent = SentSetPoint { spring: report.springs, set_point: report.set_point };
    let (set_points_in, set_points_out) = shared(&sent, &mut memory);
    let (adjustments_in, adjustments_out) = shared(adjustable, &mut memory);
    let (reports_in, reports_out) = shared(&report, &mut memory);
    let (orders_in, orders_out) = shared(&Order::Nothing, &mut memory);
    let closing = SharedPages::from(Pages::new(AtomicBool::new(false)));
    memory.add_shared(&closing);
    let planners = PlannersEnd {
        sent,
        set_points: set_points_in,
        adjustments: adjustments_in,
        orders: orders_in,
        ordered: 0,
        reports: reports_out,
    };
    let servo = ServoEnd {
        set_points: set_points_out,
        adjustments: adjustments_out,
        orders: orders_out,
        reports: reports_in,
        closing: closing.clone(),
    };
    (Mailbox { planners: Mutex::new(planners), closing }, servo, memory)
}

/// A triple buffer, and where it is.
fn shared<T: Clone + Send>(initial: &T, memory: &mut LockedMemory) -> (Input<T>, Output<T>) {
    let ends = triple_buffer(initial);
    ends.0.add_to(memory);
    ends
}

impl Mailbox {
    /// The newest report.
    pub fn report(&self) -> FingerReport {
        self.look(|report| *report)
    }

    /// Looks at the newest report where it is: it is large.
    pub fn look<R>(&self, look: impl FnOnce(&FingerReport) -> R) -> R {
        look(self.planners.lock().reports.read())
    }

    /// Whether the servo has nothing more to do for the finger; none where a planner's call is just using the mailbox,
    /// perhaps one that the calling thread has left for a signal handler, so that waiting for it would be for ever.
    pub fn ended(&self) -> Option<bool> {
        let mut planners = self.planners.try_lock()?;
        Some(matches!(planners.reports.read().stage, Stage::Closed | Stage::Faulted(_)))
    }

    /// Changes the set point that was sent last and sends it whole, unless the finger is faulted. Where none was sent
    /// since it became a spring, that is the one it holds. It counts for this spring only: a finger that faults
    /// meanwhile forgets it.
    ///
    /// # Errors
    /// The fault; nothing is sent then.
    pub fn send(&self, change: impl FnOnce(&mut SetPoint)) -> Result<(), Fault> {
        let planners = &mut *self.planners.lock();
        planners.begin()?;
        change(&mut planners.sent.set_point);
        planners.set_points.write(planners.sent);
        Ok(())
    }

    /// The same with a change that may refuse the set point that it starts from. It is made in a copy, which takes
    /// longer.
    ///
    /// # Errors
    /// The fault, or inside it what the change refuses; nothing is sent then.
    pub fn try_send<E>(&self, change: impl FnOnce(&mut SetPoint) -> Result<(), E>) -> Result<Result<(), E>, Fault> {
        let planners = &mut *self.planners.lock();
        planners.begin()?;
        let next = planners.set_points.input_buffer_mut();
        *next = planners.sent;
        if let Err(refusal) = change(&mut next.set_point) {
            return Ok(Err(refusal));
        }
        planners.sent = *next;
        planners.set_points.publish();
        Ok(Ok(()))
    }

    /// The set point that was sent last; where none was since the finger became a spring, the one it holds.
    pub fn sent(&self) -> SetPoint {
        let planners = &mut *self.planners.lock();
        planners.sent.begin_with(planners.reports.read());
        planners.sent.set_point
    }

    /// Gives the servo something else to compute with, unless the finger is faulted.
    ///
    /// # Errors
    /// The fault; nothing is changed then.
    pub fn adjust(&self, adjustable: Adjustable) -> Result<(), Fault> {
        let mut planners = self.planners.lock();
        if let Stage::Faulted(fault) = planners.reports.read().stage {
            return Err(fault);
        }
        planners.adjustments.write(adjustable);
        Ok(())
    }

    /// Gives an order and its number, which is that of [`FingerReport::orders`] as soon as it is taken; none while
    /// another order is being carried out.
    ///
    /// # Errors
    /// The fault; nothing is ordered then.
    pub fn order(&self, order: Order) -> Result<Option<u32>, Fault> {
        self.planners.lock().order(order, None)
    }

    /// Gives the servo something else to compute with, which it begins anew with. Otherwise like [`Mailbox::order`].
    ///
    /// # Errors
    /// The fault; nothing is changed then.
    pub fn restart(&self, adjustable: Adjustable, limp: bool) -> Result<Option<u32>, Fault> {
        self.planners.lock().order(Order::Restart { limp }, Some(adjustable))
    }

    /// Asks the servo to bring the finger to its end state.
    pub fn close(&self) {
        self.closing.store(true, Ordering::Release);
    }
}

impl SentSetPoint {
    /// What the next change starts from: what was sent last; in a new stretch what the servo holds.
    fn begin_with(&mut self, report: &FingerReport) {
        if report.springs != self.spring {
            *self = Self { spring: report.springs, set_point: report.set_point };
        }
    }
}

impl PlannersEnd {
    /// Makes what was sent last what the next change starts from.
    fn begin(&mut self) -> Result<(), Fault> {
        let report = self.reports.read();
        if let Stage::Faulted(fault) = report.stage {
            return Err(fault);
        }
        self.sent.begin_with(report);
        Ok(())
    }

    /// What is handed over goes first: a servo that has the order has that too.
    fn order(&mut self, order: Order, adjustable: Option<Adjustable>) -> Result<Option<u32>, Fault> {
        let report = *self.reports.read();
        match report.stage {
            Stage::Faulted(fault) => return Err(fault),
            Stage::Running | Stage::Limp if report.orders == self.ordered => {}
            _ => return Ok(None),
        }
        if let Some(adjustable) = adjustable {
            self.adjustments.write(adjustable);
        }
        self.ordered += 1;
        self.orders.write(order);
        Ok(Some(self.ordered))
    }
}

impl ServoEnd {
    /// The set point, if a planner has sent one since the last call, and for this spring.
    pub fn new_set_point(&mut self, spring: u32) -> Option<SetPoint> {
        let sent = self.set_points.update().then(|| *self.set_points.output_buffer());
        sent.filter(|sent| sent.spring == spring).map(|sent| sent.set_point)
    }

    /// What the servo shall compute with, if a planner has changed it since the last call.
    pub fn new_adjustable(&mut self) -> Option<&Adjustable> {
        self.adjustments.update().then(|| self.adjustments.output_buffer())
    }

    /// The order, if a planner has given one since the last call.
    pub fn new_order(&mut self) -> Option<Order> {
        self.orders.update().then(|| self.orders.output_buffer().clone())
    }

    /// Whether the finger shall be brought to its end state.
    pub fn closing(&self) -> bool {
        self.closing.load(Ordering::Acquire)
    }

    /// Replaces the report.
    pub fn publish(&mut self, report: FingerReport) {
        self.reports.write(report);
    }
}
