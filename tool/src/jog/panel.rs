//! The controls of `sun2xp jog`: what the person has chosen, and the lines that show it.

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
    /// The push on each finger in the palm's frame, N.
    pub forces: [[f64; 3]; 3],
    /// The result of the last command in words, and whether it was refused.
    pub result: Option<(String, bool)>,
}

impl JogPanel {
    /// Returns the controls at the start.
    pub fn new(real: bool) -> Self {
        Self { finger: 1, mode: Mode::Joints, step: 2, real, forces: [[0.0; 3]; 3], result: None }
    }

    /// Makes the steps larger or smaller.
    pub fn change_step(&mut self, larger: bool) {
        let most = if self.real { REAL_STEPS } else { JOINT_STEPS.len() } - 1;
        self.step = if larger { (self.step + 1).min(most) } else { self.step.saturating_sub(1) };
    }

    /// Returns the push on the chosen finger, N.
    pub fn force(&mut self) -> Option<&mut [f64; 3]> {
        let index = usize::try_from(self.finger - 1).ok()?;
        self.forces.get_mut(index)
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
    let pushed = panel.forces.iter().zip(1..).filter(|(force, _)| **force != [0.0; 3]);
    for ([x, y, z], finger) in pushed {
        let text = format!(" pushes finger {finger} with {x:.2} {y:.2} {z:.2} N in the palm's frame; key 0 ends it");
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
