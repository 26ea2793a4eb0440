//! The built-in simulated boards of a hand.

use crate::hand::{Fingers, HandError};
use crate::model::FingerNumber;
use crate::model::configuration::{Configuration, FINGERS, RealTime, Unusable};
use crate::model::{Section, UnusableConfiguration};
use crate::realtime::Priority;
use crate::simulated::{
    CoupledPorts, CoupledPortsError, ObjectState, ObjectView, Pace, Scene, SimulatedBoard, SimulatedBoardError,
    SimulatedFinger, SimulatedPort,
};
use std::path::PathBuf;

/// Highest SCHED_FIFO priority of a simulated board. A servo has priority 80 by default, so a board does not delay it.
/// The priority of a board is never higher than that of its finger. If the finger has no SCHED_FIFO priority, its board
/// does not have one either.
const SIMULATED_BOARD_PRIORITY: u8 = 20;

/// The boards of the fingers whose port is `simulated`.
pub struct SimulatedHand {
    /// Boards with a thread each. There are none if the hand has an object.
    separate: [Option<SimulatedPort>; FINGERS],
    /// Boards whose fingers can touch the object. One thread runs all of them.
    coupled: Option<CoupledPorts>,
}

impl SimulatedHand {
    /// Starts a simulated board at a pseudo-terminal for each of these fingers that the hand has and whose port is
    /// `simulated`.
    pub fn start(configuration: &Configuration, fingers: Fingers) -> Result<Self, HandError> {
        let simulated = |number: &FingerNumber| {
            configuration.hand.fingers.contains(*number) && configuration.fingers[number.index()].simulated()
        };
        let members = || fingers.members().filter(simulated);
        let mut hand = Self { separate: [const { None }; FINGERS], coupled: None };
        if let (Some(scene), Some(_)) = (Scene::new(configuration), members().next()) {
            let priorities = members().map(|number| priority(configuration, number).fifo);
            let priority = Priority { fifo: priorities.min().unwrap_or_default(), core: None };
            let ports = CoupledPorts::start(configuration, members(), scene, priority);
            hand.coupled = Some(ports.map_err(|error| match error {
                CoupledPortsError::Board { finger, source } => unusable(finger, &source),
                CoupledPortsError::System(source) => HandError::SimulatedPort(source),
            })?);
            return Ok(hand);
        }
        for number in members() {
            let board = SimulatedBoard::new(configuration, &[number]).map_err(|source| unusable(number, &source))?;
            let pace = Pace::patient(configuration.hand.rate);
            let port = SimulatedPort::start(board, pace, priority(configuration, number));
            hand.separate[number.index()] = Some(port.map_err(HandError::SimulatedPort)?);
        }
        Ok(hand)
    }

    /// Returns the path of a finger's simulated port, or `None` if the finger is not simulated.
    pub fn path(&self, finger: FingerNumber) -> Option<PathBuf> {
        let separate = self.separate[finger.index()].as_ref().map(SimulatedPort::path);
        separate.or_else(|| self.coupled.as_ref()?.path(finger))
    }

    /// Calls `act` with a simulated finger. Returns `None` if the finger is not simulated.
    pub fn with_finger<R>(&self, finger: FingerNumber, act: impl FnOnce(&mut SimulatedFinger) -> R) -> Option<R> {
        match (&self.separate[finger.index()], &self.coupled) {
            // The board of a simulated finger has only this finger.
            (Some(port), _) => port.with_board(|board| board.fingers().first_mut().map(act)),
            (None, Some(ports)) => ports.with_finger(finger, act),
            (None, None) => None,
        }
    }

    /// Sets the gravity that acts on the object, if there is one, m/s^2 in the palm's frame.
    pub fn set_object_gravity(&self, gravity: [f64; 3]) {
        self.coupled.iter().for_each(|ports| ports.set_object_gravity(gravity.into()));
    }

    /// Returns the state of the object, or `None` if there is no object.
    pub fn object(&self) -> Option<ObjectState> {
        self.object_view().map(|view| view.state())
    }

    /// Returns the view of the object's state, or `None` if there is no object.
    pub fn object_view(&self) -> Option<ObjectView> {
        self.coupled.as_ref().map(|ports| ports.object().clone())
    }
}

fn priority(configuration: &Configuration, number: FingerNumber) -> Priority {
    let fifo = match configuration.hand.real_time {
        RealTime::Ignore => 0,
        _ => configuration.fingers[number.index()].priority.min(SIMULATED_BOARD_PRIORITY),
    };
    Priority { fifo, core: None }
}

fn unusable(finger: FingerNumber, source: &SimulatedBoardError) -> HandError {
    let unusable = Unusable { key: "simulation", reason: source.to_string() };
    UnusableConfiguration { section: Section::Finger(finger), unusable }.into()
}
