//! The keys of `sun2xp jog`.

use super::commands::Command;
use super::panel::{JOINT_STEPS, JogPanel, Mode, PUSH_STEPS, TIP_STEPS};
use super::stopper::Stopper;
use super::worker::Worker;
use crate::monitor::show::Pressed;
use crate::monitor::view::View;
use ratatui::crossterm::event::{Event, KeyCode, KeyEvent, KeyModifiers};
use sun2xp::FingerNumber;
use sun2xp::model::configuration::Configuration;
use sun2xp::nalgebra::Vector3;

/// Factor by which a key makes a finger stiffer.
const STIFFER: f64 = 1.25;

/// Stops all fingers if the key is the space bar. The thread that reads the keys calls this, so that a stop does not
/// wait for the screen.
pub fn stop(stopper: &Stopper, event: &Event) {
    if let Event::Key(KeyEvent { code: KeyCode::Char(' '), .. }) = event {
        stopper.stop();
    }
}

/// Handles a key.
pub fn press(view: &mut View, worker: &Worker, configuration: &Configuration, key: KeyEvent) -> Pressed {
    let Some(mut panel) = view.jog.clone() else { return Pressed::Handled };
    match key.code {
        KeyCode::Char(' ') => {
            worker.stopper().stop();
            panel.result = Some(("EMERGENCY STOP: all fingers are stopped. r recovers the chosen finger".into(), true));
        }
        KeyCode::Char('c') if key.modifiers.contains(KeyModifiers::CONTROL) => return Pressed::Quit,
        KeyCode::Char('q') => return Pressed::Quit,
        KeyCode::Char('s') => return Pressed::Snapshot,
        KeyCode::Char('?' | 'h') => view.help = !view.help,
        KeyCode::Esc => (view.help, view.selected) = (false, None),
        KeyCode::Char('p') => view.toggle_frozen(),
        KeyCode::Char('d') => view.select(panel.finger),
        KeyCode::Char(digit @ '1'..='3') => panel.finger = digit as i32 - '0' as i32,
        KeyCode::Tab => panel.finger = panel.finger % 3 + 1,
        KeyCode::Char('j') => panel.mode = Mode::Joints,
        KeyCode::Char('t') => panel.mode = Mode::Tip,
        KeyCode::Char('f') => panel.mode = Mode::Push,
        KeyCode::Char('[') => panel.change_step(false),
        KeyCode::Char(']') => panel.change_step(true),
        KeyCode::Char('{') => view.scroll = view.scroll.saturating_sub(1),
        KeyCode::Char('}') => view.scroll = view.scroll.saturating_add(1),
        code => {
            if let Some(command) = command(&mut panel, configuration, code) {
                let sent = worker.send(command);
                panel.note(&command, sent);
            }
        }
    }
    if view.selected.is_some() && view.selected != Some(panel.finger) {
        view.selected = Some(panel.finger);
    }
    view.jog = Some(panel);
    Pressed::Handled
}

/// Returns the command of a key; none if the key has no command. [`JogPanel::note`] informs the panel whether the
/// command was sent.
pub fn command(panel: &mut JogPanel, configuration: &Configuration, code: KeyCode) -> Option<Command> {
    let finger = panel.finger;
    Some(match code {
        KeyCode::Char('+' | '=') => Command::ScaleStiffness { finger, factor: STIFFER },
        KeyCode::Char('-') => Command::ScaleStiffness { finger, factor: 1.0 / STIFFER },
        KeyCode::Char('o') => Command::Open,
        KeyCode::Char('c') => Command::Close,
        KeyCode::Char('r') => Command::Recover { finger },
        KeyCode::Char('0') => {
            panel.push(finger)?.wanted = [0.0; 3];
            Command::Push { finger, force: [0.0; 3] }
        }
        code => {
            let (axis, sign) = direction(code, panel.mode)?;
            let mut by = [0.0; 3];
            match panel.mode {
                Mode::Joints => {
                    by[axis] = sign * JOINT_STEPS[panel.step].to_radians();
                    Command::MoveJoints { finger, by }
                }
                Mode::Tip => {
                    by[axis] = sign * TIP_STEPS[panel.step];
                    Command::MoveTip { finger, by: in_finger(configuration, finger, by) }
                }
                Mode::Push => {
                    let step = sign * PUSH_STEPS[panel.step];
                    let force = &mut panel.push(finger)?.wanted;
                    force[axis] += step;
                    // Decimal steps such as 0.1 N have no exact binary value. Rounding keeps their sum free of errors.
                    force[axis] = (force[axis] * 1e6).round() / 1e6;
                    Command::Push { finger, force: in_finger(configuration, finger, *force) }
                }
            }
        }
    })
}

/// Returns the joint or the axis of the palm, and the sign.
fn direction(code: KeyCode, mode: Mode) -> Option<(usize, f64)> {
    let joints = mode == Mode::Joints;
    Some(match code {
        KeyCode::Left => (0, -1.0),
        KeyCode::Right => (0, 1.0),
        KeyCode::Down => (if joints { 1 } else { 2 }, -1.0),
        KeyCode::Up => (if joints { 1 } else { 2 }, 1.0),
        KeyCode::PageDown | KeyCode::Char('<' | ',') => (if joints { 2 } else { 1 }, -1.0),
        KeyCode::PageUp | KeyCode::Char('>' | '.') => (if joints { 2 } else { 1 }, 1.0),
        _ => return None,
    })
}

/// Turns a vector from the palm's frame into the finger's.
fn in_finger(configuration: &Configuration, finger: i32, vector: [f64; 3]) -> [f64; 3] {
    let Some(number) = FingerNumber::new(finger) else { return vector };
    let to_palm = configuration.finger_to_palm(number).rotation;
    to_palm.inverse_transform_vector(&Vector3::from(vector)).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_arrow_keys_move_along_the_axes_of_the_palm() {
        let configuration = Configuration::default();
        let mut panel = JogPanel::new(false);
        let press = |panel: &mut JogPanel, code| command(panel, &configuration, code);
        let by = [0.0, 1f64.to_radians(), 0.0];
        assert_eq!(press(&mut panel, KeyCode::Up), Some(Command::MoveJoints { finger: 1, by }));
        (panel.mode, panel.finger) = (Mode::Tip, 3);
        // Finger 3 is turned by 180 degrees about z.
        let Some(Command::MoveTip { finger: 3, by: [x, y, z] }) = press(&mut panel, KeyCode::Right) else { panic!() };
        assert!((x + 0.1).abs() < 1e-12 && y.abs() < 1e-12 && z == 0.0, "{x} {y} {z}");
        assert_eq!(press(&mut panel, KeyCode::Up), Some(Command::MoveTip { finger: 3, by: [0.0, 0.0, 0.1] }));
        panel.mode = Mode::Push;
        press(&mut panel, KeyCode::Down);
        assert_eq!(press(&mut panel, KeyCode::Down), Some(Command::Push { finger: 3, force: [0.0, 0.0, -0.4] }));
        assert_eq!(press(&mut panel, KeyCode::Char('0')), Some(Command::Push { finger: 3, force: [0.0; 3] }));
        assert_eq!((panel.push(3).expect("there").wanted, press(&mut panel, KeyCode::F(5))), ([0.0; 3], None));
    }

    #[test]
    fn the_steps_of_a_real_hand_are_limited() {
        let mut panel = JogPanel::new(true);
        (0..10).for_each(|_| panel.change_step(true));
        assert!(JOINT_STEPS[panel.step].to_radians() < crate::jog::commands::REAL_JOINT_STEP);
        assert!(TIP_STEPS[panel.step] <= crate::jog::commands::REAL_TIP_STEP);
        (0..10).for_each(|_| panel.change_step(false));
        assert_eq!(panel.step, 0);
    }
}
