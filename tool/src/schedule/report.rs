//! The result of `sun2xp schedule`, for people and for other programs.

use super::fastest::{Fastest, Limit};
use super::off_line::{Costs, Scheduled, Sensor, Violation, off_line_schedule, touches};
use crate::print::{Cell, Look, Screen, Table, painted};
use serde::Serialize;
use std::io::{self, Write};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::{Configuration, RATES};

/// Where the costs come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Source {
    /// A file.
    File,
    /// A measurement: the maximum of each time of [`Costs`].
    MeasuredMaximum,
    /// A measurement: the 99.9 % value of each time of [`Costs`].
    Measured999,
}

/// The output of `--json`.
#[derive(Debug, Serialize)]
pub struct Report {
    /// Whether every deadline is met at the configured rate.
    pub pass: bool,
    /// The configured rate, Hz.
    rate: f64,
    source: Source,
    /// Whether the costs were measured on a virtual machine.
    virtual_machine: bool,
    costs: Costs,
    /// The hand as it is configured.
    configured: Schedule,
    /// The hand with one more sensor on each finger.
    with_sensor: Schedule,
}

/// The schedule of a hand.
#[derive(Debug, Serialize)]
struct Schedule {
    sensor: Sensor,
    threads: Vec<Thread>,
    fastest: Fastest,
}

/// One servo thread at the configured rate.
#[derive(Debug, Serialize)]
struct Thread {
    #[serde(flatten)]
    scheduled: Scheduled,
    /// Largest number of tactile events that the thread fetches in a period.
    tactile_events: usize,
}

impl Schedule {
    fn new(hand: &Configuration, costs: &Costs, sensor: Sensor) -> Self {
        let rate = hand.hand.rate;
        let threads = off_line_schedule(hand, rate, costs, &sensor).into_iter();
        let with_touch = |scheduled: Scheduled| Thread {
            tactile_events: touches(hand, &scheduled.fingers, &sensor, rate),
            scheduled,
        };
        Self { sensor, threads: threads.map(with_touch).collect(), fastest: Fastest::of(hand, costs, &sensor) }
    }

    /// The highest rate, and what prevents a higher one, as a sentence that begins with `condition`.
    fn summary(&self, condition: &str) -> String {
        let Some(Limit { missed: violation, thread }) = self.fastest.limit else {
            let highest = RATES.end();
            return format!(
                "{condition}every deadline is met at the highest rate that can be configured, {highest} Hz."
            );
        };
        let reason = format!("{} (thread {thread})", missed(violation));
        match self.fastest.rate {
            Some(rate) => format!(
                "{condition}the highest rate at which every deadline is met is {rate} Hz: at {} Hz, {reason}.",
                rate + 1
            ),
            None => {
                let lowest = RATES.start();
                format!("{condition}no rate that can be configured meets every deadline: at {lowest} Hz, {reason}.")
            }
        }
    }

    /// Returns a sentence that says why a deadline may be missed at `rate`, Hz, although every deadline is met at a
    /// higher rate. Returns an empty text if every deadline is met at `rate`, or if no higher rate meets every
    /// deadline.
    fn exception(&self, rate: f64) -> String {
        let violated = self.threads.iter().any(|thread| thread.scheduled.violation.is_some());
        match self.fastest.rate {
            Some(fastest) if violated && f64::from(fastest) > rate => format!(
                " At {rate:.0} Hz a deadline may be missed: at this lower rate the line has time for more tactile \
                 events, and fetching them makes the cycle longer."
            ),
            _ => String::new(),
        }
    }

    fn table(&self) -> Table {
        let header =
            ["thread", "fingers", "core", "priority", "computing", "line busy", "replies by", "done by", "deadlines"];
        let mut table = Table::new(header).numeric(3..8);
        for Thread { scheduled, .. } in &self.threads {
            let fingers = scheduled.fingers.iter().map(FingerNumber::to_string).collect::<Vec<_>>().join(", ");
            let by = |time: Option<f64>| Cell::from(time.map_or("-".into(), |time| format!("{time:.0} us")));
            table.row([
                scheduled.thread.to_string().into(),
                fingers.into(),
                scheduled.core.map_or("any".into(), |core| core.to_string()).into(),
                scheduled.priority.to_string().into(),
                format!("{:.1} %", 100.0 * scheduled.load).into(),
                format!("{:.0} %", 100.0 * scheduled.line).into(),
                by(scheduled.response.map(|response| response.0)),
                by(scheduled.response.map(|response| response.1)),
                scheduled
                    .violation
                    .map_or(Cell::new(Look::Good, "met"), |violation| Cell::new(Look::Bad, missed(violation))),
            ]);
        }
        table
    }
}

impl Report {
    pub fn new(hand: &Configuration, costs: Costs, source: Source, virtual_machine: bool, sensor: Sensor) -> Self {
        let configured = Schedule::new(hand, &costs, Sensor::default());
        Self {
            pass: configured.threads.iter().all(|thread| thread.scheduled.violation.is_none()),
            rate: hand.hand.rate,
            source,
            virtual_machine: virtual_machine && source != Source::File,
            costs,
            with_sensor: Schedule::new(hand, &costs, sensor),
            configured,
        }
    }

    /// Returns the message that a deadline may be missed at the configured rate, with the reason and the remedy.
    pub fn complaint(&self) -> String {
        let change = match self.configured.fastest.rate {
            Some(fastest) if f64::from(fastest) > self.rate => format!("raise hand.rate to {fastest}"),
            Some(_) => "lower hand.rate".into(),
            None => {
                "reduce the wake-up latency and the computing time (sun2xp doctor shows what increases them)".into()
            }
        };
        let mut violations: Vec<_> =
            self.configured.threads.iter().filter_map(|thread| thread.scheduled.violation).collect();
        violations.sort_unstable();
        violations.dedup();
        let causes: Vec<_> = violations.iter().map(|violation| missed(*violation)).collect();
        // The cores have no influence on the load of the line.
        let others = match violations == [Violation::Line] {
            true => " or raise finger.baud",
            false => ", raise finger.baud or spread the fingers over cores",
        };
        format!("at {:.0} Hz a deadline may be missed, because {}: {change}{others}", self.rate, causes.join(" and "))
    }

    pub fn write(&self, out: &mut impl Write, screen: &Screen) -> io::Result<()> {
        let title = |text: &str| painted(screen, Look::Title, text);
        let Costs { wake_up, write, read, compute } = self.costs;
        let costs = match self.source {
            Source::Measured999 => "99.9 % values",
            Source::File | Source::MeasuredMaximum => "Worst cases",
        };
        writeln!(out, "{costs}, us: wake-up {wake_up:.1}, write {write:.1}, read {read:.1}, compute {compute:.1}")?;
        if let Some(caveat) = self.caveat() {
            writeln!(out, "{} {caveat}", painted(screen, Look::Warning, "This machine is virtual."))?;
        }
        writeln!(out, "\n{}\n", title(&format!("{:.0} Hz", self.rate)))?;
        write!(out, "{}", self.configured.table().text(screen))?;
        let Sensor { bytes, compute } = self.with_sensor.sensor;
        let more = format!(
            "{:.0} Hz with an additional sensor on each finger: it adds {bytes} bytes to the reply and {compute:.0} us \
             to the computing time of the finger",
            self.rate
        );
        writeln!(out, "\n{}\n", title(&more))?;
        writeln!(out, "{}", self.with_sensor.table().text(screen))?;
        for Thread { scheduled, tactile_events } in self.configured.threads.iter().filter(|one| one.tactile_events > 0)
        {
            let thread = scheduled.thread;
            writeln!(out, "Thread {thread} fetches up to {tactile_events} tactile events in every period.")?;
        }
        for (schedule, condition) in [(&self.configured, ""), (&self.with_sensor, "With the sensor, ")] {
            writeln!(out, "{}{}", capitalized(&schedule.summary(condition)), schedule.exception(self.rate))?;
        }
        out.flush()
    }

    /// What a virtual machine does to the measured times.
    fn caveat(&self) -> Option<&'static str> {
        match (self.virtual_machine, self.source) {
            (true, Source::MeasuredMaximum) => Some(
                "Its host may pause it at any time and for any duration. The worst cases include such pauses, and a \
                 longer measurement finds longer ones. These worst cases do not hold for a physical machine. Use \
                 --p999 to leave most pauses out.",
            ),
            (true, Source::Measured999) => Some(
                "Its host may pause it at any time and for any duration. The 99.9 % values leave most pauses out, so \
                 a deadline may be missed in every pause.",
            ),
            _ => None,
        }
    }
}

fn capitalized(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

fn missed(violation: Violation) -> &'static str {
    match violation {
        Violation::Line => "the line is too busy",
        Violation::Replies => "replies may arrive too late",
        Violation::Cycle => "a cycle may end too late",
    }
}
