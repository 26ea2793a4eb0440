//! Orders of `sun2xp board` that cause faults.

use sun2xp::model::Shown;
use sun2xp::realtime::with_terminal_remedy;
use sun2xp::simulated::{Defect, LineFault, SimulatedFinger, SimulatedPort, WiredPart};

/// A fault of the board or its cable, or the end of faults.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Trouble {
    /// A defect of the finger with this number.
    Finger(u8, Defect),
    /// The end of all defects of the finger with this number.
    Repair(u8),
    /// A fault of frames from the board, with this probability and duration, ns.
    Line(LineFault, f64, u64),
    /// A fault of frames to the board, with this probability and duration, ns.
    LineToBoard(LineFault, f64, u64),
    /// The end of all line faults.
    GoodLine,
    Unplug,
    PlugIn,
}

/// The answer to an order for a finger that the board does not have.
pub fn no_finger(number: u8) -> String {
    format!("error this board has no finger {number}: name one of the fingers that the board was started with")
}

/// A duration longer than any program runs, ns.
const FOREVER: u64 = u64::MAX;

impl Trouble {
    /// Reads an order. Returns `None` if the order does not cause or end a fault.
    pub fn read(words: &[&str]) -> Result<Option<Self>, String> {
        let [name, rest @ ..] = words else { return Ok(None) };
        let numbers = || -> Result<Vec<f64>, String> { rest.iter().map(|word| number(word)).collect() };
        let trouble = match *name {
            "unplug" | "replug" | "good" if rest.is_empty() => match *name {
                "unplug" => Trouble::Unplug,
                "replug" => Trouble::PlugIn,
                _ => Trouble::GoodLine,
            },
            "drop" | "corrupt" | "duplicate" | "reorder" => {
                let fault = match *name {
                    "drop" => LineFault::Drop,
                    "corrupt" => LineFault::Corrupt,
                    "duplicate" => LineFault::Duplicate,
                    _ => LineFault::Reorder,
                };
                match numbers()?[..] {
                    [chance] => Trouble::Line(fault, probability(chance)?, FOREVER),
                    [chance, time] => Trouble::Line(fault, probability(chance)?, nanoseconds(time)?),
                    _ => return Err(format!("usage: {name} PROBABILITY [MS]")),
                }
            }
            "delay" => match numbers()?[..] {
                [chance, delay] => Trouble::Line(LineFault::Delay(nanoseconds(delay)?), probability(chance)?, FOREVER),
                [chance, delay, time] => {
                    let fault = LineFault::Delay(nanoseconds(delay)?);
                    Trouble::Line(fault, probability(chance)?, nanoseconds(time)?)
                }
                _ => return Err("usage: delay PROBABILITY DELAY_MS [MS]".into()),
            },
            "stall" => match numbers()?[..] {
                [time] => Trouble::Line(LineFault::Stall, 1.0, nanoseconds(time)?),
                _ => return Err("usage: stall MS".into()),
            },
            "commands" => match Self::read(if rest.first() == Some(&"commands") { &[] } else { rest })? {
                Some(Trouble::Line(fault, probability, time)) => Trouble::LineToBoard(fault, probability, time),
                _ => {
                    return Err("usage: commands FAULT, such as commands drop 0.01; FAULT is drop, corrupt, delay, \
                                duplicate, reorder or stall with its numbers"
                        .into());
                }
            },
            "repair" => match numbers()?[..] {
                [finger] => Trouble::Repair(whole(finger)?),
                _ => return Err("usage: repair FINGER".into()),
            },
            _ => return Self::read_defect(name, rest),
        };
        Ok(Some(trouble))
    }

    fn read_defect(name: &str, rest: &[&str]) -> Result<Option<Self>, String> {
        const NAMES: [&str; 13] = [
            "cut",
            "slack",
            "jam",
            "hot",
            "dead-gauge",
            "drift-gauge",
            "jump",
            "dead-element",
            "zero-lost",
            "emergency",
            "supply",
            "sensor",
            "reset",
        ];
        if !NAMES.contains(&name) && !WIRING.contains(&name) {
            return Ok(None);
        }
        let numbers: Vec<f64> = rest.iter().map(|word| number(word)).collect::<Result<_, _>>()?;
        let (finger, numbers) = match numbers[..] {
            [finger, ref numbers @ ..] => (whole(finger)?, numbers),
            [] => return Err(format!("{name} needs the number of a finger")),
        };
        let defect = match (name, numbers) {
            ("cut", &[tendon]) => Defect::CutTendon(part(tendon)?),
            ("slack", &[tendon, grip]) if grip >= 0.0 => Defect::SlippingTendon { tendon: part(tendon)?, grip },
            ("jam", &[motor]) => Defect::JammedMotor(part(motor)?),
            ("hot", &[motor]) => Defect::HotMotor(part(motor)?),
            ("dead-gauge", &[gauge]) => Defect::DeadGauge { gauge: part(gauge)?, count: None },
            ("dead-gauge", &[gauge, count]) if (0.0..=65_535.0).contains(&count) => {
                Defect::DeadGauge { gauge: part(gauge)?, count: Some(count as u16) }
            }
            ("drift-gauge", &[gauge, speed]) => Defect::DriftingGauge { gauge: part(gauge)?, speed },
            ("jump", &[encoder, counts]) => Defect::EncoderJump { encoder: part(encoder)?, counts: counts as i32 },
            ("dead-element", &[element]) => Defect::DeadElement(whole(element)?),
            ("zero-lost", &[]) => Defect::ZeroLost,
            ("emergency", &[]) => Defect::EmergencyStop,
            ("supply", &[]) => Defect::Supply,
            ("sensor", &[]) => Defect::Sensor,
            ("reset", &[]) => Defect::Reset,
            (name, numbers) if WIRING.contains(&name) => wiring_defect(name, numbers)?,
            _ => return Err(format!("{name} does not take these numbers; see sun2xp board --help")),
        };
        Ok(Some(Trouble::Finger(finger, defect)))
    }

    /// Causes or ends the fault, and returns the answer. `address` maps the number of a finger to its address.
    pub fn apply(&self, port: &SimulatedPort, seed: u64, address: impl Fn(u8) -> Option<u8>) -> String {
        let finger = |number: u8, act: &dyn Fn(&mut SimulatedFinger) -> bool| match address(number)
            .and_then(|address| port.with_finger(address, |finger| act(finger)))
        {
            Some(true) => "ok".into(),
            Some(false) => {
                format!("error finger {number} has no tactile element with this number: see finger.touch.elements")
            }
            None => no_finger(number),
        };
        match *self {
            Trouble::Finger(number, defect) => finger(number, &|finger| finger.inject(&defect)),
            Trouble::Repair(number) => finger(number, &|finger| {
                finger.repair();
                true
            }),
            Trouble::Line(fault, probability, time) => {
                port.inject(fault, probability, time, seed);
                "ok".into()
            }
            Trouble::LineToBoard(fault, probability, time) => {
                port.inject_to_board(fault, probability, time, seed);
                "ok".into()
            }
            Trouble::GoodLine => {
                port.clear();
                "ok".into()
            }
            Trouble::Unplug => {
                port.unplug();
                "ok".into()
            }
            Trouble::PlugIn => match port.plug_in() {
                Ok(()) => format!("ok {}", port.path().display()),
                Err(error) => format!("error {}", with_terminal_remedy(&error)),
            },
        }
    }
}

/// The orders that change the wiring.
const WIRING: [&str; 10] = [
    "swap-motors",
    "swap-encoders",
    "swap-gauges",
    "swap-tendons",
    "reverse-motor",
    "reverse-encoder",
    "reverse-gauge",
    "gauge-gain",
    "dead-motor",
    "dead-encoder",
];

/// Reads the numbers of an order that changes the wiring.
fn wiring_defect(name: &str, numbers: &[f64]) -> Result<Defect, String> {
    Ok(match (name, numbers) {
        ("swap-motors", &[one, other]) => Defect::Swapped(WiredPart::Motor, part(one)?, part(other)?),
        ("swap-encoders", &[one, other]) => Defect::Swapped(WiredPart::Encoder, part(one)?, part(other)?),
        ("swap-gauges", &[one, other]) => Defect::Swapped(WiredPart::Gauge, part(one)?, part(other)?),
        ("swap-tendons", &[one, other]) => Defect::Swapped(WiredPart::Tendon, part(one)?, part(other)?),
        ("reverse-motor", &[motor]) => Defect::Reversed(WiredPart::Motor, part(motor)?),
        ("reverse-encoder", &[encoder]) => Defect::Reversed(WiredPart::Encoder, part(encoder)?),
        ("reverse-gauge", &[gauge]) => Defect::Reversed(WiredPart::Gauge, part(gauge)?),
        ("gauge-gain", &[gauge, ratio]) if (0.0..=10.0).contains(&ratio) => {
            Defect::GaugeGain { gauge: part(gauge)?, ratio }
        }
        ("dead-motor", &[motor]) => Defect::DeadMotor(part(motor)?),
        ("dead-encoder", &[encoder]) => Defect::DeadEncoder(part(encoder)?),
        _ => return Err(format!("{name} does not take these numbers; see sun2xp board --help")),
    })
}

/// The number of a motor, encoder, gauge or tendon.
fn part(number: f64) -> Result<u8, String> {
    match whole(number)? {
        part @ 1..=4 => Ok(part),
        part => Err(format!("{part} is not between 1 and 4")),
    }
}

fn number(word: &str) -> Result<f64, String> {
    let number: Option<f64> = word.parse().ok().filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| format!("{} is not a number", Shown(word)))
}

fn whole(number: f64) -> Result<u8, String> {
    let fits = number.fract() == 0.0 && (0.0..=255.0).contains(&number);
    if fits { Ok(number as u8) } else { Err(format!("{number} is not a whole number from 0 to 255")) }
}

fn probability(number: f64) -> Result<f64, String> {
    if (0.0..=1.0).contains(&number) { Ok(number) } else { Err(format!("{number} is not a probability from 0 to 1")) }
}

fn nanoseconds(milliseconds: f64) -> Result<u64, String> {
    if milliseconds >= 0.0 {
        Ok((milliseconds * 1e6) as u64)
    } else {
        Err(format!("{milliseconds} is not a time of 0 ms or more"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(line: &str) -> Result<Option<Trouble>, String> {
        Trouble::read(&line.split_whitespace().collect::<Vec<_>>())
    }

    #[test]
    fn troubles_are_read() {
        for (line, trouble) in [
            ("cut 1 3", Trouble::Finger(1, Defect::CutTendon(3))),
            ("slack 2 4 1.5", Trouble::Finger(2, Defect::SlippingTendon { tendon: 4, grip: 1.5 })),
            ("dead-gauge 1 2", Trouble::Finger(1, Defect::DeadGauge { gauge: 2, count: None })),
            ("dead-gauge 1 2 4095", Trouble::Finger(1, Defect::DeadGauge { gauge: 2, count: Some(4095) })),
            ("jump 1 2 -300", Trouble::Finger(1, Defect::EncoderJump { encoder: 2, counts: -300 })),
            ("dead-element 1 0", Trouble::Finger(1, Defect::DeadElement(0))),
            ("swap-gauges 1 2 4", Trouble::Finger(1, Defect::Swapped(WiredPart::Gauge, 2, 4))),
            ("reverse-motor 1 3", Trouble::Finger(1, Defect::Reversed(WiredPart::Motor, 3))),
            ("gauge-gain 2 1 0.8", Trouble::Finger(2, Defect::GaugeGain { gauge: 1, ratio: 0.8 })),
            ("reset 3", Trouble::Finger(3, Defect::Reset)),
            ("repair 3", Trouble::Repair(3)),
            ("drop 0.05", Trouble::Line(LineFault::Drop, 0.05, FOREVER)),
            ("corrupt 1 20", Trouble::Line(LineFault::Corrupt, 1.0, 20_000_000)),
            ("delay 0.5 3 100", Trouble::Line(LineFault::Delay(3_000_000), 0.5, 100_000_000)),
            ("stall 50", Trouble::Line(LineFault::Stall, 1.0, 50_000_000)),
            ("commands drop 0.05", Trouble::LineToBoard(LineFault::Drop, 0.05, FOREVER)),
            ("commands stall 50", Trouble::LineToBoard(LineFault::Stall, 1.0, 50_000_000)),
            ("unplug", Trouble::Unplug),
            ("replug", Trouble::PlugIn),
            ("good", Trouble::GoodLine),
        ] {
            assert_eq!(read(line), Ok(Some(trouble)), "{line}");
        }
        assert_eq!(read("state 1"), Ok(None));
    }

    #[test]
    fn wrong_troubles_are_named() {
        for (line, part) in [
            ("cut 1 5", "not between 1 and 4"),
            ("cut 1", "does not take these numbers"),
            ("cut", "cut needs the number of a finger"),
            ("cut one 2", "one is not a number"),
            ("drop 1.5", "not a probability"),
            ("drop", "PROBABILITY [MS]"),
            ("stall -1", "not a time"),
            ("commands corrupt 2", "not a probability"),
            ("commands repair 1", "FAULT is drop, corrupt"),
            ("commands", "FAULT is drop, corrupt"),
            ("slack 1 2 -3", "does not take these numbers"),
        ] {
            let error = read(line).unwrap_err();
            assert!(error.contains(part), "{line}: {error}");
        }
    }
}
