//! The help.

use super::palette::Palette;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, BorderType, Paragraph};

const KEYS: &[(&str, &str)] = &[
    ("q, Esc", "quit (Esc first closes help and detail)"),
    ("space", "freeze the picture; pressed again, let it continue"),
    ("1 2 3, tab", "show a finger in detail"),
    ("s", "write the state (JSON) and the screen (text, SVG)"),
    ("up, down", "scroll long fault texts"),
];

const JOG_KEYS: &[(&str, &str)] = &[
    ("SPACE", "EMERGENCY STOP of all fingers"),
    ("1 2 3, tab", "choose the finger"),
    ("j t f", "the arrow keys move joints (j), move the tip (t) or push the tip (f)"),
    ("left right", "joint 0, or x of the palm"),
    ("up down", "joint 1, or z: away from the palm"),
    ("PgUp PgDn, < >", "joint 2, or y"),
    ("[ ]", "smaller or larger steps"),
    ("- +", "softer or stiffer: Kx times 0.8 or 1.25"),
    ("0", "end the push of the chosen finger"),
    ("o c", "open or close the grip"),
    ("r", "recover the finger"),
    ("d p s", "detail, freeze the picture, snapshot"),
    ("{ }", "scroll long fault texts"),
    ("q", "close the hand and quit"),
];

const SIGNS: &[(&str, &str)] = &[
    ("├─━●─◆┤", "joint: the thick line ends at the measured angle ●, ◆ is the set point"),
    ("│███·┃··│", "tension from t_min to t_max: measured █, wanted ┃"),
    ("‹", "the tendon is slack, below 0.8 t_min"),
    ("F, Fc", "tip force from the tensions, and contact estimate"),
    ("Kx+", "Kx has entries off its diagonal: see the detail"),
    ("not seen", "cycles that this view has missed; the servo ran them"),
];

/// Draws the keys and the signs.
pub fn draw(frame: &mut Frame, area: Rect, palette: &Palette, jog: bool) {
    let mut lines = Vec::new();
    for part in [if jog { JOG_KEYS } else { KEYS }, SIGNS] {
        for (sign, meaning) in part {
            lines.push(Line::from(vec![Span::styled(format!(" {sign:<16}"), palette.selected), Span::raw(*meaning)]));
        }
        lines.push(Line::default());
    }
    let title = Span::styled(" help: ? closes it ", palette.title);
    let block = Block::bordered().border_type(BorderType::Rounded).border_style(palette.dim).title(title);
    frame.render_widget(Paragraph::new(lines).block(block), area);
}
