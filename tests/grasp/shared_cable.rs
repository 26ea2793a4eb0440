//! The host's end of a cable in memory, and the clock of the host.

use std::cell::{RefCell, RefMut};
use std::rc::Rc;
use sun2xp::board::{PortError, Transport};
use sun2xp::realtime::Clock;
use sun2xp::simulated::{SimulatedBoard, SimulatedCable};

/// A cable that the link of a port and the servo's clock share.
#[derive(Clone)]
pub struct SharedCable(Rc<RefCell<SimulatedCable>>);

impl SharedCable {
    pub fn new(board: SimulatedBoard) -> Self {
        Self(Rc::new(RefCell::new(SimulatedCable::new(board))))
    }

    pub fn cable(&self) -> RefMut<'_, SimulatedCable> {
        self.0.borrow_mut()
    }
}

impl Transport for SharedCable {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        self.cable().write(bytes)
    }

    fn read_until(&mut self, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
        self.cable().read_until(buffer, deadline)
    }

    fn discard_input(&mut self) -> Result<(), PortError> {
        self.cable().discard_input()
    }

    fn now(&self) -> u64 {
        self.cable().now()
    }
}

impl Clock for SharedCable {
    fn now(&self) -> u64 {
        self.cable().now()
    }

    fn sleep_until(&self, deadline: u64) {
        self.cable().advance_to(deadline);
    }
}
