//! `sun2xp plot`: pictures of a recording, as SVG or PNG.

mod axis;
mod faults;
mod figure;
mod palette;
mod panel;
mod png;
mod step;
mod stiffness;
mod svg;
mod tensions;
mod timing;

use crate::failure::{Failure, unwritable, wrong_usage};
use crate::trace::{self, Item};
use clap::ValueEnum;
use figure::Figure;
use std::ffi::OsStr;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use sun2xp::files::replace_file;
use sun2xp::model::ShownPath;

/// Draws a recording as SVG or PNG.
///
/// Exit status: 0 if the picture was written, 1 if not, 2 for wrong usage.
#[derive(clap::Args)]
pub struct Arguments {
    /// A recording of sun2xp record, or a black box.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// What is drawn.
    #[arg(long, value_enum, default_value_t = Kind::Step)]
    kind: Kind,
    /// The picture, whose name ends in .svg or .png. The default is a PNG in the current folder.
    #[arg(long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Only this finger. The default is the first finger of the recording, or all fingers for timing and faults.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(i32).range(1..=3))]
    finger: Option<i32>,
    /// Beginning of the time that is drawn, s since the first cycle.
    #[arg(long, value_name = "S", value_parser = seconds)]
    from: Option<f64>,
    /// End of the time that is drawn, s since the first cycle. The kind `stiffness` shows the stiffness at this time.
    #[arg(long, value_name = "S", value_parser = seconds)]
    to: Option<f64>,
    /// Width of the picture, pixels.
    #[arg(
        long,
        value_name = "PIXELS",
        default_value_t = 1200,
        value_parser = clap::value_parser!(u32).range(300..=8000)
    )]
    width: u32,
}

/// A curve has a gap where the controller has not run for this time, s. Single periods, which a busy servo skips, make
/// no gap.
const LONGEST_PAUSE: f64 = 0.05;

/// The error if a kind of plot needs cycles, and the selection has none.
const NO_CYCLE: &str = "the selected part of the recording has no cycle of the selected fingers: select another \
    part or other fingers (--from, --to, --finger), or make another recording";

/// The error if a kind of plot needs values of the controller, and the selection has none.
const NOT_CONTROLLED: &str = "the selected part of the recording has no cycle in which the controller of this finger \
    ran: select another part or finger (--from, --to, --finger), or record while the finger runs";

/// What a picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// Joints and tip against their set points.
    Step,
    /// Measured and wanted tensions, with their bounds.
    Tensions,
    /// The stiffness of the tip as ellipses, with the force of the tip.
    Stiffness,
    /// Histograms of the wake-ups and of the ends of the cycles.
    Timing,
    /// Stages, faults, lost replies and events on a time line.
    Faults,
}

/// The part of a recording that is drawn.
#[derive(Clone, Debug)]
struct Selection {
    /// Name of the recording.
    name: String,
    finger: Option<i32>,
    from: Option<f64>,
    to: Option<f64>,
}

/// A kind of picture: it receives the items of a recording, and then draws.
trait Plot {
    /// Receives an item with its time since the first cycle, s.
    fn take(&mut self, item: &Item, seconds: f64);

    /// Returns the picture, or the reason why there is none.
    fn draw(&self, selection: &Selection) -> Result<Figure, Failure>;
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(seconds) if (0.0..=1e9).contains(&seconds) => Ok(seconds),
        _ => Err("not a time from 0 to 1e9 s".into()),
    }
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let output = arguments.output()?;
    let picture = output.extension().and_then(OsStr::to_str).map(str::to_ascii_lowercase);
    let as_png = match picture.as_deref() {
        Some("svg") => false,
        Some("png") => true,
        _ => return Err(wrong_usage(format!("{}: the name must end in .svg or .png", ShownPath(&output)))),
    };
    let mut selection = Selection {
        name: arguments.file.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        finger: arguments.finger,
        from: arguments.from,
        to: arguments.to,
    };
    let mut plot: Box<dyn Plot> = match arguments.kind {
        Kind::Step => Box::new(step::Step::default()),
        Kind::Tensions => Box::new(tensions::Tensions::default()),
        Kind::Stiffness => Box::new(stiffness::Stiffness::default()),
        Kind::Timing => Box::new(timing::Timing::default()),
        Kind::Faults => Box::new(faults::Faults::default()),
    };
    let one_finger = !matches!(arguments.kind, Kind::Timing | Kind::Faults);
    collect(&arguments.file, &mut selection, one_finger, plot.as_mut())?;
    let figure = plot.draw(&selection)?;
    let svg = figure.finish(arguments.width.into());
    let bytes = if as_png { png::draw(&svg)? } else { svg.into_bytes() };
    replace_file(&output, |file| file.write_all(&bytes)).map_err(|error| unwritable(&output, &error))?;
    // The picture has been written, even if nobody reads its name.
    let _ = writeln!(io::stdout(), "{}", output.display());
    Ok(())
}

/// Passes the selected part of a recording to a plot. If `one_finger` is true and no finger is selected, selects the
/// first finger of the recording.
fn collect(file: &Path, selection: &mut Selection, one_finger: bool, plot: &mut dyn Plot) -> Result<(), Failure> {
    let mut start = trace::first_cycle(file)?;
    trace::read(file, "plot", &mut |item| {
        let (time, finger) = match &item {
            Item::Finger(finger) => {
                if one_finger {
                    selection.finger.get_or_insert(finger.number);
                }
                (None, Some(finger.number))
            }
            Item::Cycle(row) => (Some(row.sample.began), Some(row.sample.finger.get())),
            Item::Mark(mark) => (Some(mark.time), mark.finger),
            Item::Object(..) => return Ok(()),
        };
        let seconds = time.map_or(0.0, |time| {
            let start = *start.get_or_insert(time);
            time.wrapping_sub(start).cast_signed() as f64 * 1e-9
        });
        let selected = finger.is_none_or(|finger| selection.finger.is_none_or(|selected| selected == finger));
        let in_time = selection.from.is_none_or(|from| seconds >= from) && selection.to.is_none_or(|to| seconds <= to);
        if selected && (in_time || time.is_none()) {
            plot.take(&item, seconds);
        }
        Ok(())
    })
}

impl Arguments {
    fn output(&self) -> Result<PathBuf, Failure> {
        if let Some(output) = &self.output {
            return Ok(output.clone());
        }
        let kind = self.kind.to_possible_value().map_or_else(String::new, |kind| kind.get_name().to_owned());
        Ok(PathBuf::from(format!("{}-{kind}.png", trace::stem(&self.file)?)))
    }
}
