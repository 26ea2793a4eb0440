//! The tactile elements of a simulated finger: what touches the tip, and the answers to requests.

use super::SimulatedFinger;
use crate::board::protocol::{TactileEvent, TactileRequest};
use crate::simulated::pads::TipContact;
use nalgebra::Vector3;

impl SimulatedFinger {
    /// Returns the answer to a request, or `None` if the finger has no tactile elements.
    pub(in crate::simulated) fn touched(&mut self, request: &TactileRequest) -> Option<TactileEvent> {
        self.pads.exist().then(|| self.pads.fetch(request.received))
    }

    /// Passes the force on the tip and its sliding velocity to the tactile elements.
    pub(super) fn feel(&mut self) {
        if self.pads.exist() {
            let turn = self.plant.links().tip_rotation(&self.plant.joints()).inverse();
            let force = turn * self.plant.force_on_tip();
            // A tip that touches no fixed surface can slip only on the shared object. Without such an object, `sliding`
            // is zero: an external force comes from no surface, so nothing slips.
            let on_surface = self.plant.contact_force().norm() > 0.0;
            let velocity = if on_surface { self.plant.tip_velocity() } else { self.sliding };
            self.pads.step(self.clock, &TipContact { force, velocity: turn * velocity });
        }
    }

    /// Sets the velocity of the tip relative to an object that several fingers share, cm/s, in the finger's frame.
    pub(in crate::simulated) fn set_sliding(&mut self, velocity: Vector3<f64>) {
        self.sliding = velocity;
    }

    /// Makes every tactile element readable.
    pub(in crate::simulated) fn repair_elements(&mut self) {
        self.pads.repair();
    }

    /// Makes a tactile element, counted from 0, unreadable. Returns false if there is no such element.
    pub(in crate::simulated) fn break_element(&mut self, element: usize) -> bool {
        self.pads.set_broken(element, true, self.clock)
    }
}
