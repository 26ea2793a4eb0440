//! A hand on another machine, over the network.

use crate::measured_rate::MeasuredRate;
use crate::refusals::{calibration_refusal, closed, recovery_refusal, refusal};
use crate::results;
use crate::stop_calls::{StopCalls, Stoppable};
use std::array::from_fn;
use std::sync::{Arc, Mutex, PoisonError, RwLock};
use std::thread::sleep;
use std::time::{Duration, Instant};
use sun2xp::calibration::Task;
use sun2xp::capi::{RemoteHand, RemoteRefusal};
use sun2xp::capi::{sun2xp_event, sun2xp_fault, sun2xp_limits, sun2xp_status, sun2xp_tip};
use sun2xp::groups::{FingerCommand, Pose, Until};
use sun2xp::hand::{Fingers, Ranges};
use sun2xp::nalgebra::Vector3;
use sun2xp::{Configuration, FingerNumber, HandError};
use sun2xp_remote_client as client;

/// Interval at which a wait inspects the newest records, which arrive at least every 10 ms.
const LOOK: Duration = Duration::from_millis(5);

/// Longest wait for an event before the thread checks whether the hand was closed.
const EVENT_CHECK: Duration = Duration::from_millis(100);

pub(crate) struct NetworkHand {
    /// None when the hand is closed.
    connection: RwLock<Option<Arc<Connection>>>,
    /// The planner's configuration, of which only the table `[hand]` is used.
    configuration: Configuration,
}

/// The parts of an open hand that end when it is closed.
struct Connection {
    hand: client::RemoteHand,
    events: client::RemoteEvents,
    /// The measured rate of each finger.
    rates: [Mutex<MeasuredRate>; 3],
    _stop_calls: StopCalls,
}

impl Stoppable for NetworkHand {
    fn stop_every_finger(&self) -> bool {
        // A closed hand has nothing to stop. Its refusal cannot be reported to the planner, because the call that
        // requested the stop has returned.
        let Ok(connection) = self.connection() else { return true };
        // If the planner has lost the hand, the stop must not be repeated: it would stop the hand of the next owner.
        connection.hand.emergency_stop().is_ok() || !connection.hand.is_owner()
    }
}

impl NetworkHand {
    /// Wraps an open hand of the client, so that the C calls can use it. `seen` is the number of emergency stop calls
    /// at the beginning of the opening.
    pub fn start(
        hand: client::RemoteHand,
        configuration: &Configuration,
        seen: u32,
    ) -> Result<Arc<dyn RemoteHand>, RemoteRefusal> {
        let own = Arc::new(Self { connection: RwLock::new(None), configuration: configuration.clone() });
        // The thread of `StopCalls` may stop the hand at once. This lock makes it wait until the connection is stored.
        let mut place = own.connection.write().unwrap_or_else(PoisonError::into_inner);
        let _stop_calls = StopCalls::watch(Arc::downgrade(&own), seen)?;
        let events = hand.events();
        let connection = Connection { hand, events, rates: Default::default(), _stop_calls };
        *place = Some(Arc::new(connection));
        drop(place);
        Ok(own)
    }

    fn connection(&self) -> Result<Arc<Connection>, RemoteRefusal> {
        self.connection.read().unwrap_or_else(PoisonError::into_inner).clone().ok_or_else(closed)
    }

    /// Checks a command as a hand of this machine does, with the same results. The server makes the other checks.
    fn admitted(
        &self,
        hand: &client::RemoteHand,
        command: &FingerCommand,
    ) -> Result<client::FingerCommand, RemoteRefusal> {
        let finger = member(hand, command.finger)?;
        let status = hand.finger_status(finger.get()).map_err(refusal)?;
        let ranges = Ranges {
            finger,
            joint_limits: (Vector3::from(status.low), Vector3::from(status.high)),
            stiffness_bound: status.stiffness_bound,
            out_of_range: self.configuration.hand.out_of_range,
        };
        let checked = || {
            let pose = match command.pose {
                Some(Pose::Joints(joints)) => Some(client::Pose::Joints(ranges.joints(joints)?.into())),
                Some(Pose::Tip(tip)) => {
                    ranges.finite("Tip", &tip)?;
                    Some(client::Pose::Tip(tip))
                }
                _ => None,
            };
            let kx = command.stiffness.map(|rows| ranges.kx(rows)).transpose()?;
            ranges.finite("Damping", command.damping.as_slice())?;
            // The client takes Kx as `rows[row][column]`.
            Ok((pose, kx.map(|kx| from_fn(|row| from_fn(|column| kx[(row, column)])))))
        };
        let (pose, stiffness) = checked().map_err(|error| RemoteRefusal::Hand(HandError::SetPoint(error)))?;
        let mut admitted = client::FingerCommand::new(finger.get());
        (admitted.pose, admitted.stiffness, admitted.damping) = (pose, stiffness, command.damping);
        Ok(admitted)
    }

    fn newest(&self, finger: i32) -> Result<(Arc<Connection>, client::Record), RemoteRefusal> {
        let connection = self.connection()?;
        let finger = member(&connection.hand, finger)?;
        // The record is read under the lock, so that records are noted in their order.
        let mut rate = connection.rates[finger.index()].lock().unwrap_or_else(PoisonError::into_inner);
        let record = connection.hand.record(finger.get()).map_err(refusal)?;
        rate.note(&record);
        drop(rate);
        Ok((connection, record))
    }
}

/// Returns the finger with this number. Refuses the number if the hand does not have this finger.
fn member(hand: &client::RemoteHand, number: i32) -> Result<FingerNumber, RemoteRefusal> {
    let finger = FingerNumber::new(number).ok_or(HandError::NoSuchFinger(number))?;
    let has = |number: FingerNumber| hand.fingers().iter().any(|finger| i32::from(finger.number()) == number.get());
    if has(finger) {
        return Ok(finger);
    }
    let members: Vec<FingerNumber> = FingerNumber::ALL.into_iter().filter(|&number| has(number)).collect();
    let fingers = Fingers::try_from(members).unwrap_or(Fingers::ALL);
    Err(HandError::NotInHand { finger, fingers }.into())
}

/// Refuses to wait for a finger that follows no set point, and will not follow one by itself.
fn follows_set_points(record: &client::Record) -> Result<(), RemoteRefusal> {
    use client::Stage::{Calibrating, Closed, Closing, Limp};
    let Some(finger) = FingerNumber::new(record.finger.number().into()) else { return Ok(()) };
    match record.stage {
        Limp => Err(HandError::Limp(finger).into()),
        Calibrating | Closing | Closed => Err(HandError::Busy(finger).into()),
        _ => Ok(()),
    }
}

/// Returns the finger with this number. Returns none for the number 0, which stands for all fingers.
fn one_or_all(hand: &client::RemoteHand, number: i32) -> Result<Option<i32>, RemoteRefusal> {
    if number == 0 { Ok(None) } else { member(hand, number).map(|finger| Some(finger.get())) }
}

impl RemoteHand for NetworkHand {
    fn send(&self, commands: &[FingerCommand]) -> Result<(), RemoteRefusal> {
        let connection = self.connection()?;
        let admitted: Vec<_> =
            commands.iter().map(|command| self.admitted(&connection.hand, command)).collect::<Result<_, _>>()?;
        connection.hand.send_group(&admitted).map_err(refusal)
    }

    fn position(&self, finger: i32) -> Result<[f64; 3], RemoteRefusal> {
        let connection = self.connection()?;
        let finger = member(&connection.hand, finger)?;
        connection.hand.position(finger.get()).map_err(refusal)
    }

    fn tip(&self, finger: i32) -> Result<sun2xp_tip, RemoteRefusal> {
        let (connection, record) = self.newest(finger)?;
        // Refuses a finger that has stopped, as a hand of this machine does.
        connection.hand.position(finger).map_err(refusal)?;
        Ok(results::tip(&record))
    }

    fn status(&self, finger: i32) -> Result<sun2xp_status, RemoteRefusal> {
        let (connection, newest) = self.newest(finger)?;
        let hand = connection.hand.status().map_err(refusal)?;
        let status = connection.hand.finger_status(finger).map_err(refusal)?;
        let rate = connection.rates[newest.finger.index()].lock().unwrap_or_else(PoisonError::into_inner).rate();
        Ok(results::status(&hand, &status, &newest, rate))
    }

    fn limits(&self, finger: i32) -> Result<sun2xp_limits, RemoteRefusal> {
        let connection = self.connection()?;
        let finger = member(&connection.hand, finger)?;
        Ok(results::limits(&connection.hand.finger_status(finger.get()).map_err(refusal)?))
    }

    fn fault(&self, finger: i32) -> Result<sun2xp_fault, RemoteRefusal> {
        let (connection, newest) = self.newest(finger)?;
        let status = connection.hand.finger_status(finger).map_err(refusal)?;
        Ok(results::fault(newest.stage, &status))
    }

    fn stop(&self, finger: i32) -> Result<(), RemoteRefusal> {
        let connection = self.connection()?;
        connection.hand.stop(one_or_all(&connection.hand, finger)?).map_err(refusal)
    }

    fn recover(&self, finger: i32) -> Result<(), RemoteRefusal> {
        let connection = self.connection()?;
        let finger = one_or_all(&connection.hand, finger)?;
        if !connection.hand.is_owner() {
            if finger.is_none() {
                return connection.hand.reopen().map_err(recovery_refusal);
            }
            // The other fingers stay stopped until the planner recovers them too.
            connection.hand.acquire().map_err(refusal)?;
        }
        connection.hand.recover(finger).map_err(recovery_refusal)
    }

    fn calibrate(&self, finger: i32, task: Task) -> Result<(), RemoteRefusal> {
        let connection = self.connection()?;
        let finger = member(&connection.hand, finger)?.get();
        let done = match task {
            Task::Zero => connection.hand.zero(finger),
            _ => connection.hand.identify(finger),
        };
        done.map_err(calibration_refusal)
    }

    fn wait(&self, finger: i32, until: Until, limit: Duration) -> Result<(), RemoteRefusal> {
        let begun = Instant::now();
        let asked = {
            let connection = self.connection()?;
            match one_or_all(&connection.hand, finger)? {
                Some(finger) => vec![finger],
                None => connection.hand.fingers().iter().map(|finger| finger.number().into()).collect(),
            }
        };
        loop {
            let mut missing = None;
            for &finger in &asked {
                // Refuses a finger that has stopped, and records that are too old.
                let connection = self.connection()?;
                let progress = connection.hand.progress(finger).map_err(refusal)?;
                follows_set_points(&connection.hand.record(finger).map_err(refusal)?)?;
                let there = match until {
                    Until::Arrived => progress.arrived,
                    _ => progress.settled,
                };
                if !there {
                    missing = FingerNumber::new(finger);
                }
            }
            let Some(missing) = missing else { return Ok(()) };
            if begun.elapsed() >= limit {
                return Err(HandError::NotThereInTime(missing).into());
            }
            sleep(LOOK);
        }
    }

    fn next_event(&self) -> Result<Option<sun2xp_event>, RemoteRefusal> {
        let connection = self.connection()?;
        let event = connection.events.next();
        Ok(event.map(|event| results::event(&event, connection.events.lost())))
    }

    fn wait_for_event(&self, limit: Option<Duration>) -> Result<(), RemoteRefusal> {
        let begun = Instant::now();
        loop {
            let connection = self.connection()?;
            let left = limit.map(|limit| limit.saturating_sub(begun.elapsed()));
            let step = left.unwrap_or(EVENT_CHECK).min(EVENT_CHECK);
            if connection.events.wait_until_ready(Some(step)) || left.is_some_and(|left| left <= step) {
                return Ok(());
            }
        }
    }

    fn close(&self) {
        let connection = self.connection.write().unwrap_or_else(PoisonError::into_inner).take();
        let Some(connection) = connection else { return };
        match Arc::try_unwrap(connection) {
            // Even if the server does not answer, the fingers go to their end state, because no set points arrive any
            // more.
            Ok(connection) => drop(connection.hand.close()),
            // A call in another thread still uses the connection, and drops it when the call ends. The hand is released
            // now.
            Err(shared) => drop(shared.hand.release()),
        }
    }
}
