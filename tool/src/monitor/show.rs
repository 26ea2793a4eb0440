//! The loop of `sun2xp monitor` and `sun2xp jog`: it takes the news of the hand, handles keys and draws pictures.

use super::draw::{Palette, draw};
use super::snapshot;
use super::source::{News, Source};
use super::state::Tracker;
use super::terminal::Screen;
use super::view::{Link, View};
use crate::failure::Failure;
use ratatui::crossterm::event::{Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use sun2xp::realtime::now;

/// Interval between two frames: 15 frames per second.
const INTERVAL: Duration = Duration::from_millis(66);

/// What a key has done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pressed {
    /// The key was handled, or has no effect.
    Handled,
    /// The key asks for a snapshot.
    Snapshot,
    /// The key ends the program.
    Quit,
}

/// What a subcommand, such as `sun2xp jog`, adds to the views of `sun2xp monitor`.
pub struct Controls<Keys, Tick, Urgent> {
    /// Handles a key.
    pub keys: Keys,
    /// Is called before each picture.
    pub tick: Tick,
    /// Gets each key first, in another thread, see [`Screen::open`].
    pub urgent: Urgent,
}

/// Shows the hands of `source` until a key or a signal ends the program. Snapshots are written into `folder`.
///
/// # Errors
/// Returns an error if the terminal or a thread fails.
pub fn show(
    view: &mut View,
    source: &Source,
    folder: &Path,
    controls: Controls<impl Fn(&mut View, KeyEvent) -> Pressed, impl Fn(&mut View), impl Fn(&Event) + Send + 'static>,
) -> Result<(), Failure> {
    let Controls { keys, tick, urgent } = controls;
    let palette = if std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty()) {
        Palette::plain()
    } else {
        Palette::coloured()
    };
    let mut screen = Screen::open(urgent)
        .map_err(|error| format!("cannot use the terminal: {error}. Run the command in a terminal, or use --web"))?;
    while !screen.ended() {
        view.now = now();
        take_news(view, source);
        tick(view);
        screen.terminal.draw(|frame| draw(frame, view, &palette))?;
        let next = Instant::now() + INTERVAL;
        while !screen.ended() {
            let left = next.saturating_duration_since(Instant::now());
            let key = match screen.event(left)? {
                Some(Event::Key(key)) if key.kind != KeyEventKind::Release => key,
                Some(_) => continue,
                None => break,
            };
            view.now = now();
            match keys(view, key) {
                Pressed::Handled => {}
                Pressed::Snapshot => take_snapshot(view, &mut screen, &palette, folder)?,
                Pressed::Quit => return Ok(()),
            }
        }
    }
    Ok(())
}

fn take_news(view: &mut View, source: &Source) {
    for piece in source.news.try_iter() {
        match piece {
            // The last picture of an ended hand stays until the next hand is there.
            News::Missing(text) if view.tracker.is_none() => view.link = Link::Waiting(text),
            News::Missing(_) => {}
            News::Attached(description) => {
                view.tracker = Some(Tracker::new(&description));
                view.link = Link::Live;
            }
            News::Messages(messages, lost) => {
                view.tracker.iter_mut().for_each(|tracker| tracker.apply(&messages, lost));
            }
            News::Ended(reason) => view.link = Link::Ended(reason),
        }
    }
}

fn take_snapshot(view: &mut View, screen: &mut Screen, palette: &Palette, folder: &Path) -> Result<(), Failure> {
    let Some((hand, _)) = view.shown() else {
        view.notify("no snapshot was written, because this view has not found a hand yet".into());
        return Ok(());
    };
    let picture = screen.terminal.draw(|frame| draw(frame, view, palette))?.buffer;
    let notice = match snapshot::write(folder, hand, picture) {
        Ok([json, ..]) => format!("wrote {}, and the screen beside it as .txt and .svg", absolute(json)),
        Err(error) => snapshot::refusal(&absolute(folder.into()), &error),
    };
    view.notify(notice);
    Ok(())
}

fn absolute(path: PathBuf) -> String {
    std::path::absolute(&path).unwrap_or(path).display().to_string()
}

/// Handles the keys of `sun2xp monitor`.
pub fn monitor_key(view: &mut View, key: KeyEvent) -> Pressed {
    match key.code {
        KeyCode::Char('c') if key.modifiers.contains(KeyModifiers::CONTROL) => return Pressed::Quit,
        KeyCode::Char('q') => return Pressed::Quit,
        KeyCode::Esc if view.help => view.help = false,
        KeyCode::Esc if view.selected.is_some() => view.selected = None,
        KeyCode::Esc => return Pressed::Quit,
        KeyCode::Char('?' | 'h') => view.help = !view.help,
        KeyCode::Char(' ') => view.toggle_frozen(),
        KeyCode::Char(digit @ '1'..='3') => view.select(digit as i32 - '0' as i32),
        KeyCode::Tab => view.select_next(),
        KeyCode::Char('s') => return Pressed::Snapshot,
        KeyCode::Down => view.scroll = view.scroll.saturating_add(1),
        KeyCode::Up => view.scroll = view.scroll.saturating_sub(1),
        _ => {}
    }
    Pressed::Handled
}
