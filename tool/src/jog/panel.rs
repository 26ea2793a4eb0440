//! The controls of `sun2xp jog`: what the person has chosen, and the lines that show it.

use super::commands::Command;
use super::push::Push;
use super::worker::Outcome;
use crate::monitor::draw::Palette;
use crate::monitor::view::View;
use crate::monitor::words::wrap;
use ratatui::text::{Line, Span};

/// What the arrow keys do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// They move joints.
    Joints,
    /// They move the tip.
    Tip,
    /// They push the tip.
    Push,
}

/// The steps of the joints, degrees.
pub const JOINT_STEPS: [f64; 6] = [0.1, 0.3, 1.0, 3.0, 5.0, 10.0];

/// The steps of the tip, cm.
pub const TIP_STEPS: [f64; 6] = [0.01, 0.03, 0.1, 0.3, 0.5, 1.0];

/// The steps of the push, N.
pub const PUSH_STEPS: [f64; 6] = [0.05, 0.1, 0.2, 0.5, 1.0, 2.0];

/// A real finger may use only this number of steps, from the smallest one on. Its largest steps are 3 degrees and 0.3
/// cm.
const REAL_STEPS: usize = 4;

/// The controls.
#[derive(Clone, Debug)]
pub struct JogPanel {
    /// The chosen finger, 1 to 3.
    pub finger: i32,
    /// What the arrow keys do.
    pub mode: Mode,
    /// Index of the step. All modes use the same index.
    pub step: usize,
    /// Whether the hand has a real finger. Then steps are limited.
    pub real: bool,
    /// The push on each finger.
    pushes: [Push; 3],
    /// The result of the last command in words, and whether it was refused.
    pub result: Option<(String, bool)>,
}

impl JogPanel {
    /// Returns the controls at the start.
    pub fn new(real: bool) -> Self {
        Self { finger: 1, mode: Mode::Joints, step: 2, real, pushes: Default::default(), result: None }
    }

    /// Makes the steps larger or smaller.
    pub fn change_step(&mut self, larger: bool) {
        let most = if self.real { REAL_STEPS } else { JOINT_STEPS.len() } - 1;
        self.step = if larger { (self.step + 1).min(most) } else { self.step.saturating_sub(1) };
    }

    /// Returns the push on a finger; none if there is no finger with this number.
    pub fn push(&mut self, finger: i32) -> Option<&mut Push> {
        let index = usize::try_from(finger - 1).ok()?;
        self.pushes.get_mut(index)
    }

    /// Notes whether a command was sent.
    pub fn note(&mut self, command: &Command, sent: bool) {
        if let Command::Push { finger, .. } = *command
            && let Some(push) = self.push(finger)
        {
            push.note(sent);
        }
        if !sent {
            self.result = Some(("the hand still carries out earlier commands: wait for it".into(), true));
        }
    }

    /// Shows what became of a command that was sent.
    pub fn conclude(&mut self, Outcome { command, result }: Outcome) {
        if let Command::Push { finger, .. } = command
            && let Some(push) = self.push(finger)
        {
            push.conclude(matches!(result, Some(Ok(_))));
        }
        // The text of the emergency stop stays if the stop has dropped the command.
        match result {
            Some(Ok(text)) => self.result = Some((text, false)),
            Some(Err(text)) => self.result = Some((text, true)),
            None => {}
        }
    }
}

/// Returns the lines of the controls; none for a view without controls.
pub fn lines(view: &View, palette: &Palette, width: usize) -> Vec<Line<'static>> {
    let Some(panel) = &view.jog else { return Vec::new() };
    let step = panel.step;
    let mut spans = vec![Span::styled(format!(" jog finger {} ", panel.finger), palette.selected)];
    for (mode, key, name, step) in [
        (Mode::Joints, 'j', "joints", format!("{}°", JOINT_STEPS[step])),
        (Mode::Tip, 't', "tip", format!("{} cm", TIP_STEPS[step])),
        (Mode::Push, 'f', "force", format!("{} N", PUSH_STEPS[step])),
    ] {
        let chosen = mode == panel.mode;
        let text = format!(" {}{key} {name} {step}{}", if chosen { "[" } else { " " }, if chosen { "]" } else { " " });
        spans.push(Span::styled(text, if chosen { palette.title } else { palette.dim }));
    }
    let arrows = match panel.mode {
        Mode::Joints => "  ←→ joint 0  ↑↓ joint 1  <> joint 2",
        Mode::Tip | Mode::Push => "  ←→ x  <> y  ↑↓ z",
    };
    spans.push(Span::styled(arrows, palette.dim));
    let mut lines = vec![Line::from(spans)];
    let pushed = panel.pushes.iter().map(Push::acting).zip(1..).filter(|(force, _)| *force != [0.0; 3]);
    for ([x, y, z], finger) in pushed {
        let text = format!(
            " push on finger {finger}: {x:.2} {y:.2} {z:.2} N in the palm's frame. To end it, press {finger}, then 0"
        );
        lines.push(Line::styled(text, palette.warning));
    }
    let (text, style) = match &panel.result {
        Some((text, true)) => (text.as_str(), palette.bad),
        Some((text, false)) => (text.as_str(), palette.good),
        None if panel.real => ("a real hand: steps are limited, the space bar stops all fingers", palette.warning),
        None => ("the simulated hand", palette.dim),
    };
    let texts = wrap(text, width.saturating_sub(2));
    lines.extend(texts.into_iter().map(|line| Line::styled(format!(" {line}"), style)));
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(panel: &JogPanel) -> String {
        let mut view = View::new(String::new());
        view.jog = Some(panel.clone());
        lines(&view, &Palette::plain(), 80).iter().map(Line::to_string).collect()
    }

    fn pushing(force: f64) -> Command {
        Command::Push { finger: 2, force: [0.0, 0.0, force] }
    }

    fn press(panel: &mut JogPanel, force: f64, sent: bool) {
        panel.push(2).expect("there").wanted = [0.0, 0.0, force];
        panel.note(&pushing(force), sent);
    }

    fn conclude(panel: &mut JogPanel, force: f64, result: Option<Result<&str, &str>>) {
        let result = result.map(|result| result.map(String::from).map_err(String::from));
        panel.conclude(Outcome { command: pushing(force), result });
    }

    #[test]
    fn a_push_is_shown_while_it_acts_and_a_refused_one_is_shown_as_refused() {
        let mut panel = JogPanel::new(false);
        press(&mut panel, 0.2, true);
        press(&mut panel, 0.4, true);
        assert!(!shown(&panel).contains("push on"), "nothing acts yet");
        conclude(&mut panel, 0.2, Some(Ok("pushed")));
        assert!(shown(&panel).contains("push on finger 2: 0.00 0.00 0.20 N"), "{}", shown(&panel));
        conclude(&mut panel, 0.4, Some(Err("too strong")));
        assert!(shown(&panel).contains("0.20 N") && shown(&panel).contains("too strong"), "{}", shown(&panel));
        assert_eq!(panel.result, Some(("too strong".into(), true)));
        press(&mut panel, 0.4, false);
        assert!(shown(&panel).contains("0.20 N") && shown(&panel).contains("wait for it"), "{}", shown(&panel));
        // An emergency stop drops the next push.
        press(&mut panel, 0.4, true);
        conclude(&mut panel, 0.4, None);
        assert!(shown(&panel).contains("0.20 N") && shown(&panel).contains("wait for it"), "{}", shown(&panel));
        press(&mut panel, 0.0, true);
        assert!(shown(&panel).contains("0.20 N"), "it acts until the hand has ended it");
        conclude(&mut panel, 0.0, Some(Ok("no push")));
        assert!(!shown(&panel).contains("push on"));
    }
}
