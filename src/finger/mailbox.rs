//! The exchange between planners and one finger's servo. Set points go to the servo, reports to the planners, and
//! neither side waits for the other.
//!
//! Both directions use wait-free triple buffers of whole values. The set points of groups are in a ring instead,
//! because each group must take effect in all of its fingers, even if a newer set point follows. The two sides share no
//! lock and no channel: a lock without priority inheritance would let a planner stop a servo, and the receiver of a
//! channel may have to wait for a sender that was preempted. Only the planners share a lock.

mod adjustments;
pub(super) mod groups;
mod last_path;
pub(super) mod paths;
mod requests;
mod validity;

use crate::control::SetPoint;
use crate::finger::group_gate::GroupGate;
use crate::finger::path_buffer::PathBuffer;
use crate::finger::sent::SentSetPoint;
use crate::finger::validity::Renewal;
use crate::finger::{Adjustable, Fault, FingerReport, Order, Replaced, Stage, Validity, stop_calls};
use crate::realtime::atomics::{AtomicBool, AtomicU32};
use crate::realtime::{
    Consumer, Input, LockedMemory, Mutex, Output, Pages, Producer, SharedPages, ring, triple_buffer, triple_buffer_of,
};

/// The planners' end.
pub struct Mailbox {
    planners: Mutex<PlannersEnd>,
    requests: SharedPages<Requests>,
}

/// Requests that do not wait for the lock of the planners, because a signal handler may make them.
struct Requests {
    closing: AtomicBool,
    /// Number of requests to stop. It is a counter and not a flag, so that a finger that has recovered from one request
    /// stops at the next request.
    stops: AtomicU32,
    /// Number of requests to stop that were made before the opening or the last recovery began.
    answered_stops: AtomicU32,
    /// Number of emergency stop calls that were made before the opening or the last recovery began.
    answered_calls: AtomicU32,
}

struct PlannersEnd {
    sent: SentSetPoint,
    set_points: Input<SentSetPoint>,
    grouped: Producer<SentSetPoint>,
    renewals: Input<Renewal>,
    paths: Input<PathBuffer>,
    /// The last path.
    path: last_path::LastPath,
    adjustments: Input<Adjustable>,
    gravity: Input<[f64; 3]>,
    orders: Input<Order>,
    ordered: u32,
    reports: Output<FingerReport>,
}

/// Number of groups that can wait in a finger. Each of them takes effect within two periods.
const WAITING_GROUPS: usize = 16;

/// The servo's end. It never waits or allocates.
pub(super) struct ServoEnd {
    set_points: Output<SentSetPoint>,
    /// Whether the newest value of `set_points` must wait for a group.
    held: bool,
    grouped: Consumer<SentSetPoint>,
    /// The set point of the oldest group that has not taken effect yet, if the servo has taken it from `grouped`.
    next_group: Option<SentSetPoint>,
    /// Number of the newest group that has taken effect.
    in_effect: u64,
    gate: GroupGate,
    renewals: Output<Renewal>,
    paths: Output<PathBuffer>,
    adjustments: Output<Adjustable>,
    gravity: Output<[f64; 3]>,
    orders: Output<Order>,
    reports: Input<FingerReport>,
    requests: SharedPages<Requests>,
}

/// Creates a mailbox. Both ends begin with `report`, the set point of `report`, `adjustable` and `gravity`. Also
/// returns the memory that both ends share.
pub(super) fn mailbox(
    report: FingerReport,
    adjustable: &Adjustable,
    gravity: &[f64; 3],
) -> (Mailbox, ServoEnd, LockedMemory) {
    let mut memory = LockedMemory::default();
    let sent = SentSetPoint::held(&report);
    let (set_points_in, set_points_out) = shared(&sent, &mut memory);
    let (grouped_in, grouped_out) = ring(WAITING_GROUPS);
    grouped_in.add_to(&mut memory);
    let (renewals_in, renewals_out) = shared(&Renewal::default(), &mut memory);
    let (paths_in, paths_out) = triple_buffer_of(|| PathBuffer::new(&mut memory));
    paths_in.add_to(&mut memory);
    let (adjustments_in, adjustments_out) = shared(adjustable, &mut memory);
    let (gravity_in, gravity_out) = shared(gravity, &mut memory);
    let (reports_in, reports_out) = shared(&report, &mut memory);
    let (orders_in, orders_out) = shared(&Order::Nothing, &mut memory);
    let requests = Requests {
        closing: AtomicBool::new(false),
        stops: AtomicU32::new(0),
        answered_stops: AtomicU32::new(0),
        answered_calls: AtomicU32::new(stop_calls()),
    };
    let requests = SharedPages::from(Pages::new(requests));
    memory.add_shared(&requests);
    let planners = PlannersEnd {
        sent,
        set_points: set_points_in,
        grouped: grouped_in,
        renewals: renewals_in,
        paths: paths_in,
        path: last_path::LastPath::default(),
        adjustments: adjustments_in,
        gravity: gravity_in,
        orders: orders_in,
        ordered: 0,
        reports: reports_out,
    };
    let servo = ServoEnd {
        set_points: set_points_out,
        held: false,
        grouped: grouped_out,
        next_group: None,
        in_effect: 0,
        gate: GroupGate::new(),
        renewals: renewals_out,
        paths: paths_out,
        adjustments: adjustments_out,
        gravity: gravity_out,
        orders: orders_out,
        reports: reports_in,
        requests: requests.clone(),
    };
    (Mailbox { planners: Mutex::new(planners), requests }, servo, memory)
}

/// Returns a triple buffer, and adds its pages to `memory`.
fn shared<T: Clone + Send>(initial: &T, memory: &mut LockedMemory) -> (Input<T>, Output<T>) {
    let ends = triple_buffer(initial);
    ends.0.add_to(memory);
    ends
}

impl Mailbox {
    /// Returns the newest report.
    pub fn report(&self) -> FingerReport {
        self.with_report(|report| *report)
    }

    /// Calls `use_report` with the newest report in place, because a report is large.
    pub fn with_report<R>(&self, use_report: impl FnOnce(&FingerReport) -> R) -> R {
        use_report(self.planners.lock().reports.read())
    }

    /// Returns whether the servo has finished with the finger, or none while a planner's call uses the mailbox. A
    /// signal handler may call this function after it has interrupted such a call in its own thread. Waiting for the
    /// interrupted call would be a deadlock.
    pub fn ended(&self) -> Option<bool> {
        let mut planners = self.planners.try_lock()?;
        Some(matches!(planners.reports.read().stage, Stage::Closed | Stage::Faulted(_)))
    }

    /// Changes the last set point and sends it as a whole, unless the finger is faulted. A path in progress ends. If no
    /// set point was sent in the present spring phase ([`FingerReport::springs`]), the change starts from the set point
    /// that the servo holds. The new set point belongs to this phase: if the finger faults before the servo takes the
    /// set point, it is discarded. See [`FingerReport::springs`] for a phase that ends because its set point expires.
    ///
    /// # Errors
    /// Returns the fault if the finger is faulted. Nothing is sent in that case.
    pub fn send(&self, change: impl FnOnce(&mut SetPoint)) -> Result<(), Fault> {
        let planners = &mut *self.planners.lock();
        planners.begin()?;
        change(&mut planners.sent.set_point);
        planners.sent.replace(Replaced::Place, Validity::default());
        planners.set_points.write(planners.sent);
        Ok(())
    }

    /// Like [`Mailbox::send`], for a change that may fail. The change is made in a copy of the set point, which takes
    /// longer than a change in place. `replaced` is the part that changes, and `valid` is the time for which the set
    /// point is valid.
    ///
    /// # Errors
    /// Returns the fault if the finger is faulted. The inner result is the refusal of `change`. Nothing is sent in
    /// these cases.
    pub fn try_send<E>(
        &self,
        (replaced, valid): (Replaced, Validity),
        change: impl FnOnce(&mut SetPoint) -> Result<(), E>,
    ) -> Result<Result<(), E>, Fault> {
        let planners = &mut *self.planners.lock();
        planners.begin()?;
        let path = planners.path_kept_by(replaced);
        let next = planners.set_points.input_buffer_mut();
        *next = planners.sent;
        if let Err(refusal) = last_path::change_along(path, &mut next.set_point, change) {
            return Ok(Err(refusal));
        }
        next.replace(replaced, valid);
        planners.sent = *next;
        planners.set_points.publish();
        Ok(Ok(()))
    }

    /// Returns the last set point that was sent. If none was sent in the present spring phase, returns the set point
    /// that the servo holds.
    pub fn sent(&self) -> SetPoint {
        let planners = &mut *self.planners.lock();
        planners.sent.begin_with(planners.reports.read());
        planners.sent.set_point
    }

    /// Returns the newest report, and whether the set point that was sent last is in force in it. A set point that was
    /// discarded because it was sent in an earlier spring phase counts as not sent.
    pub fn newest_in_force(&self) -> (bool, FingerReport) {
        let planners = &mut *self.planners.lock();
        let report = *planners.reports.read();
        planners.sent.begin_with(&report);
        (planners.sent.number == report.set_point_number, report)
    }

    /// Gives an order to the servo, and returns the number of the order. [`FingerReport::orders`] reaches this number
    /// when the servo takes the order. Returns none, and gives no order, if the servo has not yet taken the previous
    /// order, or if the finger is neither in the stage `Running` nor `Limp`.
    ///
    /// # Errors
    /// Returns the fault if the finger is faulted. No order is given in that case.
    pub fn order(&self, order: Order) -> Result<Option<u32>, Fault> {
        self.planners.lock().order(order, None)
    }

    /// Replaces the data that the servo computes with, and makes the servo restart with it. Otherwise like
    /// [`Mailbox::order`].
    ///
    /// # Errors
    /// Returns the fault if the finger is faulted. Nothing is changed in that case.
    pub fn restart(&self, adjustable: Adjustable, limp: bool) -> Result<Option<u32>, Fault> {
        self.planners.lock().order(Order::Restart { limp }, Some(adjustable))
    }
}

impl PlannersEnd {
    /// Prepares the next change of the set point.
    fn begin(&mut self) -> Result<(), Fault> {
        let report = self.reports.read();
        if let Stage::Faulted(fault) = report.stage {
            return Err(fault);
        }
        self.sent.begin_with(report);
        Ok(())
    }

    /// Gives `order`. If `adjustable` is present, this data is written first, so that a servo that has the order also
    /// has the data.
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
    /// Returns the set point, if a planner has sent one since the last call. If the set point was sent after a group,
    /// it waits until the group is in effect.
    pub fn new_set_point(&mut self) -> Option<SentSetPoint> {
        self.held |= self.set_points.update();
        if !self.held {
            return None;
        }
        let sent = self.set_points.output_buffer();
        self.held = sent.group > self.in_effect;
        // If a group that was sent later is in effect, it includes this set point.
        (sent.group == self.in_effect).then_some(*sent)
    }

    /// Returns the order, if a planner has given one since the last call.
    pub fn new_order(&mut self) -> Option<Order> {
        self.orders.update().then(|| self.orders.output_buffer().clone())
    }

    /// Replaces the report.
    pub fn publish(&mut self, report: FingerReport) {
        self.reports.write(report);
    }
}
