//! The tactile elements of a simulated finger, and their queue of events.

use crate::board::protocol::{TactileChange, TactileEvent};
use crate::model::configuration::{ConfiguredTouch, TouchElement};
use crate::model::direction;
use nalgebra::Vector3;
use std::collections::VecDeque;

/// Number of events that the queue holds.
const QUEUE: usize = 16;

/// Force above which an element is pressed, N.
const PRESSED: f64 = 0.05;

/// Force below which a pressed element is no longer pressed, N.
const RELEASED: f64 = 0.025;

/// A change of the force by this much since the last event of the element causes a pressure event, N.
const STEP: f64 = 0.1;

/// A contact slips if the tip moves along the surface faster than this, cm/s.
const SLIPPING: f64 = 0.5;

/// Shortest time between two slip events of an element, ns.
const SLIP_PAUSE: u64 = 20_000_000;

/// Largest count of an element.
const FULL_SCALE: f64 = 4095.0;

/// The elements of one finger.
#[derive(Debug)]
pub(super) struct Pads {
    pads: Vec<Pad>,
    queue: VecDeque<TactileEvent>,
    /// Number of the last event; 0 before the first.
    number: u8,
    /// Number of lost events, modulo 256.
    lost: u8,
}

#[derive(Debug)]
struct Pad {
    /// Outward unit normal in the axes of the last link.
    normal: Vector3<f64>,
    newton_per_count: f64,
    zero: u16,
    pressed: bool,
    broken: bool,
    /// Force at the last event, N.
    reported: f64,
    slipped_at: Option<u64>,
}

/// The contact at the fingertip, in the axes of the last link.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct TipContact {
    /// Force on the tip, N.
    pub force: Vector3<f64>,
    /// Velocity of the tip relative to what it touches, cm/s.
    pub velocity: Vector3<f64>,
}

impl Pads {
    pub fn new(touch: &ConfiguredTouch) -> Self {
        let pad = |element: &TouchElement| Pad {
            // A configuration with a normal of length 0 is refused.
            normal: direction(&Vector3::from(element.normal)).unwrap_or_else(Vector3::z),
            newton_per_count: element.newton_per_count,
            zero: element.zero,
            pressed: false,
            broken: false,
            reported: 0.0,
            slipped_at: None,
        };
        let pads = touch.elements.iter().map(pad).collect();
        Self { pads, queue: VecDeque::with_capacity(QUEUE), number: 0, lost: 0 }
    }

    /// Returns whether the finger has elements.
    pub fn exist(&self) -> bool {
        !self.pads.is_empty()
    }

    /// Makes an element unreadable, or readable again. Returns false if there is no such element.
    pub fn set_broken(&mut self, element: usize, broken: bool, now: u64) -> bool {
        let Some(pad) = self.pads.get_mut(element) else { return false };
        if broken && !pad.broken {
            self.note(now, element, TactileChange::Invalid, 0.0);
        }
        let pad = &mut self.pads[element];
        (pad.broken, pad.pressed, pad.reported) = (broken, false, 0.0);
        true
    }

    /// Forgets all events and contacts, as a loss of power does. The numbers of the events begin at 1 again.
    pub fn reset(&mut self) {
        self.queue.clear();
        (self.number, self.lost) = (0, 0);
        self.pads.iter_mut().for_each(|pad| (pad.pressed, pad.reported, pad.slipped_at) = (false, 0.0, None));
    }

    /// Makes every element readable.
    pub fn repair(&mut self) {
        self.pads.iter_mut().for_each(|pad| pad.broken = false);
    }

    /// Notes the contact at `now`, ns. An element carries the part of the force that presses it along its normal. The
    /// positions of the elements have no effect, because the simulated contact is a single point.
    pub fn step(&mut self, now: u64, contact: &TipContact) {
        for element in 0..self.pads.len() {
            let pad = &mut self.pads[element];
            if pad.broken {
                continue;
            }
            let force = (-contact.force.dot(&pad.normal)).max(0.0);
            let across = contact.velocity - pad.normal * contact.velocity.dot(&pad.normal);
            let rested = pad.slipped_at.is_none_or(|slipped| now - slipped >= SLIP_PAUSE);
            let change = if !pad.pressed && force > PRESSED {
                TactileChange::Made
            } else if pad.pressed && force < RELEASED {
                TactileChange::Lost
            } else if pad.pressed && rested && across.norm() > SLIPPING {
                pad.slipped_at = Some(now);
                TactileChange::Slip
            } else if pad.pressed && (force - pad.reported).abs() >= STEP {
                TactileChange::Pressure
            } else {
                continue;
            };
            pad.pressed = change != TactileChange::Lost;
            pad.reported = force;
            self.note(now, element, change, force);
        }
    }

    /// Appends an event to the queue. If the queue is full, this event is lost.
    fn note(&mut self, now: u64, element: usize, change: TactileChange, force: f64) {
        if self.queue.len() == QUEUE {
            self.lost = self.lost.wrapping_add(1);
            return;
        }
        self.number = if self.number == u8::MAX { 1 } else { self.number + 1 };
        let pad = &self.pads[element];
        let count = (f64::from(pad.zero) + force / pad.newton_per_count).round().clamp(0.0, FULL_SCALE) as u16;
        let count = if change == TactileChange::Invalid { 0 } else { count };
        let noticed_at = (now / 1000) as u32;
        let (number, element) = (self.number, element as u16);
        self.queue.push_back(TactileEvent { waiting: 0, number, change, element, count, noticed_at, lost: 0 });
    }

    /// Deletes the event `received` and all events before it, and returns the oldest event that is left.
    pub fn fetch(&mut self, received: u8) -> TactileEvent {
        if let Some(place) = self.queue.iter().position(|event| event.number == received) {
            self.queue.drain(..=place);
        }
        let oldest = self.queue.front().copied().unwrap_or_default();
        TactileEvent { waiting: self.queue.len() as u8, lost: self.lost, ..oldest }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pads() -> Pads {
        let element = |normal| TouchElement { position: [0.0; 3], normal, newton_per_count: 0.001, zero: 100 };
        Pads::new(&ConfiguredTouch { elements: vec![element([0.0, 0.0, 1.0]), element([0.0, -1.0, 0.0])] })
    }

    fn pressing(force: [f64; 3]) -> TipContact {
        TipContact { force: force.into(), velocity: Vector3::zeros() }
    }

    #[test]
    fn an_element_reports_a_contact_a_changed_pressure_and_the_end_of_the_contact() {
        let mut pads = pads();
        let mut received = 0;
        // A force in the direction of -z presses the element whose normal is z.
        let forces = [-0.04, -0.06, -0.1, -0.2, -0.03, -0.02];
        let expected = [
            None,
            Some((TactileChange::Made, 160)),
            None,
            Some((TactileChange::Pressure, 300)),
            Some((TactileChange::Pressure, 130)),
            Some((TactileChange::Lost, 120)),
        ];
        for (time, (force, expected)) in forces.into_iter().zip(expected).enumerate() {
            pads.step(1_000_000 * time as u64, &pressing([0.0, 0.0, force]));
            let event = pads.fetch(received);
            let found = (event.waiting > 0).then_some((event.change, event.count));
            assert_eq!(found, expected, "{force} N");
            if found.is_some() {
                assert_eq!((event.element, event.noticed_at), (0, 1000 * time as u32));
                received = event.number;
            }
        }
    }

    #[test]
    fn a_repeated_request_fetches_the_same_event_and_a_full_queue_counts_what_it_drops() {
        let mut pads = pads();
        for time in 0..20 {
            pads.step(time, &pressing([0.0, 0.2 * (time % 2) as f64, 0.0]));
        }
        let first = pads.fetch(0);
        assert_eq!((first.waiting, first.number, first.lost), (16, 1, 3));
        assert_eq!(pads.fetch(0), first);
        assert_eq!(pads.fetch(first.number).number, 2);
    }

    #[test]
    fn a_broken_element_is_reported_once_and_then_says_nothing() {
        let mut pads = pads();
        assert!(pads.set_broken(1, true, 5000) && pads.set_broken(1, true, 5000) && !pads.set_broken(2, true, 0));
        pads.step(0, &pressing([0.0, 1.0, 0.0]));
        let event = pads.fetch(0);
        assert_eq!((event.waiting, event.change, event.element, event.count), (1, TactileChange::Invalid, 1, 0));
    }
}
