//! The orders of `sun2xp board`.

use super::faults::Trouble;
use super::manual;
use sun2xp::model::configuration::Surface;
use sun2xp::model::{Counted, Shown};
use sun2xp::nalgebra::Vector3;
use sun2xp::simulated::SimulatedFinger;

/// An order: one line of standard input.
#[derive(Debug, PartialEq)]
pub enum Order {
    For(u8, Action),
    Trouble(Trouble),
    Quit,
}

/// An action on one finger, or a query of its state.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    Force([f64; 3]),
    Touch(Surface),
    Hold,
    /// Holds the finger at these joint angles, rad.
    HoldAt([f64; 3]),
    Free,
    /// Turns a motor, 0 to 3, by hand, rad.
    Turn(usize, f64),
    Tighten,
    /// Hangs a weight on a tendon, 0 to 3, N.
    Hang(usize, f64),
    State,
}

impl Order {
    /// Reads an order. Returns `None` for an empty line.
    pub fn read(line: &str) -> Result<Option<Self>, String> {
        let words: Vec<&str> = line.split_whitespace().collect();
        if let Some(trouble) = Trouble::read(&words)? {
            return Ok(Some(Order::Trouble(trouble)));
        }
        let (name, finger, numbers) = match words[..] {
            [] => return Ok(None),
            ["quit"] => return Ok(Some(Order::Quit)),
            ["quit", ..] => return Err("quit does not take these words: type quit alone".into()),
            [name, ..] if !manual::names().any(|order| order == name) => return Err(manual::unknown(name)),
            [name] => return Err(format!("{} needs the number of a finger", Shown(name))),
            [name, finger, ref numbers @ ..] => (name, finger, numbers),
        };
        let finger = finger.parse().map_err(|_| format!("{} is not the number of a finger", Shown(finger)))?;
        Ok(Some(Order::For(finger, Action::new(name, &numbers_in(numbers)?)?)))
    }
}

fn numbers_in(words: &[&str]) -> Result<Vec<f64>, String> {
    words.iter().map(|word| word.trim().parse().map_err(|_| format!("{} is not a number", Shown(word)))).collect()
}

impl Action {
    /// Reads the value of an option: numbers separated by commas.
    pub fn from_list(name: &str, list: &str) -> Result<Self, String> {
        let words: Vec<&str> = list.split(',').collect();
        Self::new(name, &numbers_in(&words)?)
    }

    fn new(name: &str, numbers: &[f64]) -> Result<Self, String> {
        if let Some(number) = numbers.iter().find(|number| !number.is_finite()) {
            return Err(format!("{number} is not finite"));
        }
        match (name, numbers) {
            ("force", &[x, y, z]) => Ok(Action::Force([x, y, z])),
            ("wall" | "ball", &[_, _, .., stiffness]) if stiffness < 0.0 => Err("the stiffness is negative".into()),
            ("wall", &[px, py, pz, nx, ny, nz, stiffness]) => {
                if [nx, ny, nz] == [0.0; 3] {
                    return Err("the normal has no direction".into());
                }
                Ok(Action::Touch(Surface::Wall { point: [px, py, pz], normal: [nx, ny, nz], stiffness }))
            }
            ("ball", &[_, _, _, radius, _]) if radius <= 0.0 => Err("the radius is not above zero".into()),
            ("ball", &[x, y, z, radius, stiffness]) => {
                Ok(Action::Touch(Surface::Ball { centre: [x, y, z], radius, stiffness }))
            }
            ("turn" | "hang", &[part, _]) if ![1.0, 2.0, 3.0, 4.0].contains(&part) => {
                Err(format!("{part} is not 1, 2, 3 or 4"))
            }
            ("turn", &[motor, turns]) => Ok(Action::Turn(motor as usize - 1, turns * std::f64::consts::TAU)),
            ("hang", &[tendon, newton]) => Ok(Action::Hang(tendon as usize - 1, newton)),
            ("tighten", []) => Ok(Action::Tighten),
            ("hold", []) => Ok(Action::Hold),
            ("hold", &[a, b, c]) => Ok(Action::HoldAt([a, b, c].map(f64::to_radians))),
            ("free", []) => Ok(Action::Free),
            ("state", []) => Ok(Action::State),
            ("force" | "wall" | "ball" | "hold" | "free" | "turn" | "tighten" | "hang" | "state", _) => {
                let given = Counted(numbers.len() as u64, "number", "numbers");
                Err(format!("{name} does not take {given}; see sun2xp board --help"))
            }
            _ => Err(format!("{name} does not take these words; see sun2xp board --help")),
        }
    }

    /// Executes the action and returns the answer.
    pub fn apply(&self, finger: &mut SimulatedFinger) -> String {
        let (torques, status) = (finger.motor_torques(), finger.status());
        let times = [Some(finger.clock()), finger.commanded_at(), finger.ended_at()];
        let plant = finger.plant();
        match *self {
            Action::Force(force) => plant.set_external_force(force.into()),
            Action::Touch(surface) => plant.set_surface(Some(surface)),
            Action::Hold => plant.hold(plant.joints()),
            Action::HoldAt(joints) => plant.hold(joints.into()),
            Action::Turn(motor, angle) => plant.turn_motor(motor, angle),
            Action::Tighten => plant.take_up_by_hand(),
            Action::Hang(tendon, newton) => plant.hang(tendon, newton),
            Action::Free => {
                plant.release();
                plant.set_external_force(Vector3::zeros());
                plant.set_surface(None);
            }
            Action::State => {
                let listed =
                    |numbers: &[f64]| numbers.iter().map(|number| format!("{number:.5}")).collect::<Vec<_>>().join(" ");
                return format!(
                    "state joints {} tip {} tensions {} torques {} times {} status {:#06x}",
                    listed(plant.joints().as_slice()),
                    listed(plant.tip().as_slice()),
                    listed(plant.tensions().as_slice()),
                    listed(torques.as_slice()),
                    listed(&times.map(|time| time.map_or(f64::NAN, |time| time as f64 * 1e-6))),
                    status.0
                );
            }
        }
        "ok".into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_are_read() {
        let force = Order::For(2, Action::Force([1.0, -0.5, 0.0]));
        assert_eq!(Order::read("force 2 1 -0.5 0"), Ok(Some(force)));
        let ball = Surface::Ball { centre: [1.0, 2.0, 3.0], radius: 4.0, stiffness: 5.0 };
        assert_eq!(Order::read(" ball 1  1 2 3 4 5 "), Ok(Some(Order::For(1, Action::Touch(ball)))));
        assert_eq!(Order::read("hold 3"), Ok(Some(Order::For(3, Action::Hold))));
        assert_eq!(Order::read(""), Ok(None));
        assert_eq!(Order::read("quit"), Ok(Some(Order::Quit)));
    }

    #[test]
    fn every_order_of_the_manual_is_an_order() {
        let names: Vec<&str> = manual::names().collect();
        assert!(names.len() > 30, "{names:?}");
        for name in names {
            // Without its numbers an order is incomplete, but it is known.
            let known = Order::read(name).err().is_none_or(|error| !error.contains("there is no order"));
            assert!(known, "{name}");
            assert_ne!(Trouble::read(&[name]).is_ok_and(|read| read.is_none()), is_trouble(name), "{name}");
        }
    }

    fn is_trouble(name: &str) -> bool {
        !["force", "wall", "ball", "hold", "turn", "tighten", "hang", "free", "state", "quit"].contains(&name)
    }

    #[test]
    fn wrong_orders_are_named() {
        for (line, part) in [
            ("force 1 1 2", "does not take 2 numbers"),
            ("force 1 1", "does not take 1 number;"),
            ("force one 1 2 3", "one is not the number of a finger"),
            ("force 1 1 2 x", "x is not a number"),
            ("force 1 1 2 NaN", "not finite"),
            ("wall 1 0 0 0 0 0 0 10", "no direction"),
            ("wall 1 0 0 0 1 0 0 -10", "negative"),
            ("ball 1 0 0 0 1 -10", "negative"),
            ("ball 1 0 0 0 -1 10", "radius"),
            ("ball 1 0 0 0 0 10", "radius"),
            ("turn 1 2.5 1", "2.5 is not 1, 2, 3 or 4"),
            (
                "shove 1",
                "no order shove: the orders are force, wall, ball, hold, turn, tighten, hang, free, state, quit, cut, \
                 slack, ",
            ),
            ("shove", "drop, corrupt, delay, duplicate, reorder, stall, commands, good, unplug, replug; see"),
            ("good 1", "does not take these words"),
            ("quit now", "quit does not take these words"),
            ("state", "state needs the number of a finger"),
        ] {
            let error = Order::read(line).unwrap_err();
            assert!(error.contains(part), "{line}: {error}");
        }
    }
}
