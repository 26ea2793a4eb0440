//! The hardware that the program provides for some fingers, and the connections to the hardware of all fingers.

use crate::board::{Connection, FingerIo, HandIo, IoBoard, IoProperties, Link, Port, TensionScale, ZERO_COUNT};
use crate::hand::HandError;
use crate::hand::notice::print_notice;
use crate::model::configuration::{Configuration, ConfiguredFinger, ConfiguredGauge, FINGERS, Unusable};
use crate::model::{FingerNumber, Fingers, Section, ShownPath, UnusableConfiguration};
use std::path::Path;

/// Largest ratio of a gauge's calibrated scale to `tension_unit`, and of `tension_unit` to this scale. The library
/// converts the tensions of the hardware, N, into counts of the size `tension_unit`, so a calibration changes the scale
/// of a gauge by only some per cent.
const LARGEST_RATIO: f64 = 2.0;

/// Largest distance of a gauge's calibrated zero from [`ZERO_COUNT`], counts.
const LARGEST_ZERO: f64 = 8000.0;

/// The hardware of a finger, and what the library knows about it. The hardware is asked only once, so that every part
/// of the library uses the same properties.
struct Provided {
    io: Box<dyn FingerIo>,
    properties: IoProperties,
}

/// The hardware of fingers 1, 2 and 3.
#[derive(Default)]
pub(super) struct Hardware([Option<Provided>; FINGERS]);

impl Hardware {
    pub fn new(io: HandIo) -> Self {
        Self(io.map(|io| io.map(|io| Provided { properties: io.properties(), io })))
    }

    /// Returns the fingers whose hardware the program provides.
    pub fn members(&self) -> impl Iterator<Item = FingerNumber> {
        FingerNumber::ALL.into_iter().filter(|finger| self.0[finger.index()].is_some())
    }

    /// Replaces the port of every finger whose hardware the program provides, and the scale and zero of its gauges if
    /// they have their default values.
    ///
    /// # Errors
    /// Returns an error if such a finger is not opened, or if its configured gauges cannot belong to its hardware.
    pub fn prepare(&self, configuration: &mut Configuration, opened: Fingers) -> Result<(), HandError> {
        for number in self.members() {
            if !configuration.hand.fingers.contains(number) {
                return Err(HandError::NotInHand { finger: number, fingers: configuration.hand.fingers });
            }
            if !opened.contains(number) {
                return Err(HandError::NotOpened(number));
            }
            let Some(provided) = &self.0[number.index()] else { continue };
            let finger = &mut configuration.fingers[number.index()];
            finger.provide(number);
            fit(&mut finger.gauge, provided.properties.tension_unit)
                .map_err(|unusable| UnusableConfiguration { section: Section::Finger(number), unusable })?;
        }
        Ok(())
    }

    /// Connects to the hardware of the program for this finger if there is one, and otherwise opens the port.
    ///
    /// # Errors
    /// Returns an error if the port cannot be opened.
    pub fn connect(
        &mut self,
        configuration: &Configuration,
        finger: FingerNumber,
        path: &Path,
    ) -> Result<Link<Connection>, HandError> {
        let provided = self.0[finger.index()].take();
        // `prepare` has checked the step of the tensions, so `IoBoard::new` does not refuse it.
        if let Some(board) =
            provided.and_then(|Provided { io, properties }| IoBoard::new(configuration, finger, io, properties))
        {
            return Ok(Link::new(board.into()));
        }
        let port = Port::open(path, configuration.fingers[finger.index()].baud);
        let port = port.map_err(|error| HandError::Link { finger, source: error.into() })?;
        warn_of_latency(&port);
        Ok(Link::new(port.into()))
    }
}

/// Sets the scale and the zero of the gauges for tensions that are stored in steps of `unit`, N. Calibrated values are
/// kept.
fn fit(gauge: &mut ConfiguredGauge, unit: f64) -> Result<(), Unusable> {
    if TensionScale::new(unit).is_none() {
        let reason = format!(
            "the hardware that the program provides has the tension_unit {unit} N: set it, in struct sun2xp_io or \
             IoProperties, to a finite number above 0"
        );
        return Err(Unusable { key: "gauge.newton_per_count", reason });
    }
    let default = ConfiguredGauge::default();
    if gauge.newton_per_count == default.newton_per_count {
        gauge.newton_per_count = [unit; 4];
    }
    if gauge.zero == default.zero {
        gauge.zero = [f64::from(ZERO_COUNT); 4];
    }
    let foreign = |scale: f64| !(unit / LARGEST_RATIO..=unit * LARGEST_RATIO).contains(&scale.abs());
    if let Some(scale) = gauge.newton_per_count.into_iter().find(|&scale| foreign(scale)) {
        let reason = format!(
            "{scale} N per count is configured, but the hardware that the program provides gives tensions in steps of \
             {unit} N: remove the key, which was set for another board, and calibrate the finger with this hardware"
        );
        return Err(Unusable { key: "gauge.newton_per_count", reason });
    }
    let away = |zero: f64| (zero - f64::from(ZERO_COUNT)).abs() > LARGEST_ZERO;
    if let Some(zero) = gauge.zero.into_iter().find(|&zero| away(zero)) {
        let reason = format!(
            "count {zero} is configured for zero tension, but the hardware that the program provides has zero tension \
             near count {ZERO_COUNT}: remove the key, which was set for another board, and zero the finger with this \
             hardware"
        );
        return Err(Unusable { key: "gauge.zero", reason });
    }
    Ok(())
}

/// Prints a notice if hardware of the program has no reference for its encoder counts when it starts. The finger is
/// opened nevertheless, because it can be zeroed only when it is open.
pub(super) fn warn_of_lost_zero(number: FingerNumber, finger: &ConfiguredFinger, zero_valid: bool) {
    if finger.has_io() && !zero_valid {
        print_notice(&format!(
            "the hardware of finger {number} starts without a reference for its encoder counts (zero lost), so its \
             joint angles are wrong: zero the finger before it moves"
        ));
    }
}

/// Prints the notice for hardware of the program that was opened without a reference for its encoder counts, and still
/// has none when it starts for a recovery. The library cannot see whether the hardware has continued its counts.
pub(super) fn warn_of_doubtful_zero(number: FingerNumber) {
    print_notice(&format!(
        "the hardware of finger {number} starts again without a reference for its encoder counts (zero lost). If the \
         hardware has restarted its counts since the finger was zeroed, the joint angles of the finger are wrong: zero \
         the finger again"
    ));
}

/// Prints a notice if a USB adapter delays bytes, because then cycles lose their replies.
fn warn_of_latency(port: &Port) {
    if let Some(milliseconds) = port.latency_timer_ms().filter(|&milliseconds| milliseconds > 1) {
        print_notice(&format!(
            "the adapter at {} delays bytes by up to {milliseconds} ms (its latency timer): write 1 to latency_timer \
             under /sys/bus/usb-serial/devices, or add a udev rule that does so",
            ShownPath(port.path())
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gauges_get_the_scale_of_the_hardware_and_keep_their_calibration() {
        let mut gauge = ConfiguredGauge::default();
        fit(&mut gauge, 0.005).expect("not calibrated");
        assert_eq!((gauge.newton_per_count, gauge.zero), ([0.005; 4], [8192.0; 4]));
        let calibrated = ConfiguredGauge {
            newton_per_count: [0.0052, -0.0048, 0.005, 0.005],
            zero: [8190.0, 8195.5, 8192.0, 8300.0],
            ..gauge
        };
        let mut gauge = calibrated.clone();
        fit(&mut gauge, 0.005).expect("calibrated with this hardware");
        assert_eq!(gauge, calibrated);
    }

    #[test]
    fn gauges_of_another_board_are_refused() {
        let gauge = ConfiguredGauge { newton_per_count: [0.025; 4], zero: [8192.0; 4], ..Default::default() };
        let refused = fit(&mut gauge.clone(), 0.005).expect_err("another scale");
        assert!(refused.key == "gauge.newton_per_count" && refused.reason.contains("0.025 N"), "{refused:?}");
        let mut gauge = ConfiguredGauge { newton_per_count: [0.005; 4], zero: [180.0; 4], ..gauge };
        let refused = fit(&mut gauge, 0.005).expect_err("another zero");
        assert!(refused.key == "gauge.zero" && refused.reason.contains("180"), "{refused:?}");
        for unit in [0.0, f64::NAN, -0.005] {
            assert!(fit(&mut ConfiguredGauge::default(), unit).is_err(), "{unit}");
        }
    }
}
