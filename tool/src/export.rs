//! `sun2xp export`: a recording as CSV files, for spreadsheets and data analysis programs.

mod columns;
mod output;

use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::trace::{self, Finger, Item, Mark, Row};
use clap::ValueEnum;
use columns::{Column, Value, columns, object_columns};
use output::Output;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use sun2xp::files::write_remedy;
use sun2xp::model::ShownPath;
use sun2xp::simulated::ObjectState;

/// Writes a recording as CSV: one file for each finger, one for the events, and one for the object of a simulated hand.
///
/// The first line of a file names the columns and their units. Numbers have enough digits to restore the recorded bits.
/// A value that a cycle does not have is an empty field. The long format leaves its row out.
///
/// Exit status: 0 if everything was written, 1 if not, 2 for wrong usage.
#[derive(clap::Args)]
pub struct Arguments {
    /// A recording of sun2xp record, or a black box.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// The folder of the CSV files. The default is the folder of FILE. With `-`, everything goes to standard output, in
    /// the long format.
    #[arg(long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    /// One row for each cycle, or one row for each value.
    #[arg(long, value_enum, default_value_t = Format::Wide)]
    format: Format,
    /// Only this finger. May be repeated.
    #[arg(long = "finger", value_name = "N", value_parser = clap::value_parser!(i32).range(1..=3))]
    fingers: Vec<i32>,
    /// Replace files that exist.
    #[arg(long)]
    force: bool,
}

/// The arrangement of the values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    /// A row has all values of a cycle, each in its column.
    Wide,
    /// A row has one value: time, finger, cycle, name, unit, value.
    Long,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let standard_output = arguments.output.as_deref() == Some(Path::new("-"));
    let start = trace::first_cycle(&arguments.file)?;
    let mut files = Files { arguments, standard_output, start, open: BTreeMap::new() };
    // An interrupted export must return instead of ending the process: dropping `files` removes the unfinished files.
    let interrupt = Interrupt::watch()?;
    trace::read(&arguments.file, "export", &mut |item| {
        if interrupt.requested() {
            return Err("the export was interrupted".into());
        }
        files.take(item).map_err(|failure| if standard_output { failure } else { arguments.explained(failure) })
    })?;
    files.finish()
}

/// The CSV files of a recording.
struct Files<'a> {
    arguments: &'a Arguments,
    standard_output: bool,
    /// Beginning of the first cycle, ns.
    start: Option<u64>,
    /// The file of every finger, and the files of [`EVENTS`] and [`OBJECT`].
    open: BTreeMap<i32, Output>,
}

/// The key of the file of events.
const EVENTS: i32 = 0;

/// The key of the file of the object.
const OBJECT: i32 = -1;

const EVENT_COLUMNS: &str = "time_s,time_ns,finger,cycle,kind,text";
const LONG_COLUMNS: &str = "time_s,finger,cycle,name,unit,value";

impl Files<'_> {
    fn take(&mut self, item: Item) -> Result<(), Failure> {
        let wanted = |finger: i32| self.arguments.fingers.is_empty() || self.arguments.fingers.contains(&finger);
        match item {
            Item::Finger(Finger { .. }) => Ok(()),
            Item::Cycle(row) if !wanted(row.sample.finger.get()) => Ok(()),
            Item::Mark(Mark { finger: Some(finger), .. }) if !wanted(finger) => Ok(()),
            Item::Cycle(row) => self.cycle(&row),
            Item::Mark(mark) => self.mark(&mark),
            Item::Object(time, object) => self.object(time, &object),
        }
    }

    /// Time since the first cycle, s. It is negative for an event that is a little older than the first cycle.
    fn seconds(&mut self, time: u64) -> f64 {
        let start = *self.start.get_or_insert(time);
        time.wrapping_sub(start).cast_signed() as f64 * 1e-9
    }

    fn cycle(&mut self, row: &Row) -> Result<(), Failure> {
        let (finger, cycle) = (row.sample.finger.get(), row.sample.cycle);
        let seconds = self.seconds(row.sample.began);
        self.row(finger, seconds, &format!("{finger},{cycle}"), &columns(row))
    }

    fn object(&mut self, time: u64, object: &ObjectState) -> Result<(), Failure> {
        let seconds = self.seconds(time);
        self.row(OBJECT, seconds, ",", &object_columns(object))
    }

    /// Writes the values that belong to one time. `place` contains the finger and the cycle. Only the long format needs
    /// it.
    fn row(&mut self, key: i32, seconds: f64, place: &str, columns: &[Column]) -> Result<(), Failure> {
        if self.arguments.format == Format::Wide && !self.standard_output {
            let names = columns.iter().map(Column::full_name).collect::<Vec<_>>().join(",");
            let file = self.file(key, &format!("time_s,{names}"))?;
            write!(file, "{seconds}")?;
            columns.iter().try_for_each(|column| write!(file, ",{}", column.value))?;
            writeln!(file)?;
            return Ok(());
        }
        let file = self.file(key, LONG_COLUMNS)?;
        for column in columns.iter().filter(|column| column.value != Value::None && column.name != "cycle") {
            writeln!(file, "{seconds},{place},{},{},{}", column.name, column.unit, column.value)?;
        }
        Ok(())
    }

    fn mark(&mut self, mark: &Mark) -> Result<(), Failure> {
        let seconds = self.seconds(mark.time);
        let number = |number: Option<String>| number.unwrap_or_default();
        let (finger, cycle) = (number(mark.finger.map(|n| n.to_string())), number(mark.cycle.map(|n| n.to_string())));
        let (kind, text) = (mark.kind.name(), quoted(&mark.text));
        if self.standard_output {
            writeln!(self.file(EVENTS, LONG_COLUMNS)?, "{seconds},{finger},{cycle},{kind},,{text}")?;
        } else {
            let time = mark.time;
            writeln!(self.file(EVENTS, EVENT_COLUMNS)?, "{seconds},{time},{finger},{cycle},{kind},{text}")?;
        }
        Ok(())
    }

    /// Returns the file of a finger, of the events or of the object. A new file begins with its header.
    fn file(&mut self, key: i32, header: &str) -> Result<&mut dyn Write, Failure> {
        let key = if self.standard_output { EVENTS } else { key };
        let output = match self.open.entry(key) {
            Entry::Occupied(open) => open.into_mut(),
            Entry::Vacant(place) => {
                let mut output = if self.standard_output {
                    Output::standard()
                } else {
                    Output::file(self.arguments.path(key)?, self.arguments.force)?
                };
                writeln!(output.writer(), "{header}")?;
                place.insert(output)
            }
        };
        Ok(output.writer())
    }

    /// Gives the files their names. Until then they have temporary names, and no existing file has changed.
    fn finish(mut self) -> Result<(), Failure> {
        self.open.values_mut().try_for_each(Output::flush)?;
        let force = self.arguments.force;
        let mut paths: Vec<PathBuf> = Vec::new();
        for output in self.open.into_values() {
            match output.place(force) {
                Ok(path) => paths.extend(path),
                Err(failure) if force => return Err(in_part(failure, paths)),
                Err(failure) => {
                    // None of these names existed before.
                    for path in &paths {
                        let _ = fs::remove_file(path);
                    }
                    return Err(failure);
                }
            }
        }
        paths.sort();
        for path in paths {
            // The files have been written, even if nobody reads their names.
            let _ = writeln!(io::stdout(), "{}", path.display());
        }
        Ok(())
    }
}

impl Arguments {
    /// The path of a CSV file.
    fn path(&self, key: i32) -> Result<PathBuf, Failure> {
        let name = match key {
            EVENTS => self.name("events"),
            OBJECT => self.name("object"),
            finger => self.name(&format!("finger{finger}")),
        }?;
        Ok(self.folder().join(name))
    }

    /// The folder of the CSV files.
    fn folder(&self) -> &Path {
        self.output.as_deref().or_else(|| self.file.parent()).unwrap_or(Path::new(""))
    }

    /// Adds the folder to an error of the system, such as a full disk.
    fn explained(&self, failure: Failure) -> Failure {
        let folder = Some(self.folder()).filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        match failure.downcast_ref::<io::Error>() {
            Some(error) => format!("cannot write into {}: {error}{}", ShownPath(folder), write_remedy(error)).into(),
            None => failure,
        }
    }

    /// The name of a CSV file: the name of the recording without its extension, and the part.
    fn name(&self, part: &str) -> Result<String, Failure> {
        Ok(format!("{}-{part}.csv", trace::stem(&self.file)?))
    }
}

/// Extends the failure of one file by the names of the files that are in place already. The files that they have
/// replaced cannot be restored.
fn in_part(failure: Failure, mut paths: Vec<PathBuf>) -> Failure {
    if paths.is_empty() {
        return failure;
    }
    paths.sort();
    let names = paths.iter().map(|path| ShownPath(path).to_string()).collect::<Vec<_>>().join(", ");
    let remedy = "remove the cause, and export again, so that all files are of the same recording";
    format!("{failure}. This export has written {names} already, and no other file: {remedy}").into()
}

/// A field of a CSV file (RFC 4180).
fn quoted(text: &str) -> String {
    let special = text.contains([',', '"', '\n', '\r']);
    if special { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arguments(folder: &Path, force: bool) -> Arguments {
        let (file, output) = (folder.join("hand.mcap"), Some(folder.to_path_buf()));
        Arguments { file, output, format: Format::Wide, fingers: Vec::new(), force }
    }

    #[test]
    fn if_a_file_does_not_get_its_name_no_file_gets_one() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name);
        let arguments = arguments(folder.path(), false);
        let mut files = Files { arguments: &arguments, standard_output: false, start: None, open: BTreeMap::new() };
        for finger in [1, 2] {
            files.file(finger, "time_s").expect("begun");
        }
        // Somebody else makes the second file meanwhile.
        fs::write(path("hand-finger2.csv"), "other").expect("written");
        assert!(files.finish().is_err());
        let names: Vec<_> =
            fs::read_dir(folder.path()).expect("a folder").flatten().map(|one| one.file_name()).collect();
        assert_eq!(names, ["hand-finger2.csv"]);
        assert_eq!(fs::read_to_string(path("hand-finger2.csv")).expect("read"), "other");
    }

    #[test]
    fn a_forced_export_that_fails_names_the_files_that_it_has_replaced() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name);
        let arguments = arguments(folder.path(), true);
        let mut files = Files { arguments: &arguments, standard_output: false, start: None, open: BTreeMap::new() };
        for finger in [1, 2, 3] {
            files.file(finger, "time_s").expect("begun");
        }
        // Somebody else makes a folder meanwhile, which no file can replace.
        fs::create_dir(path("hand-finger2.csv")).expect("made");
        let failure = files.finish().expect_err("no file can replace a folder").to_string();
        let written = format!("has written {} already", ShownPath(&path("hand-finger1.csv")));
        assert!(failure.contains(&written) && !failure.contains("finger3"), "{failure}");
    }
}
