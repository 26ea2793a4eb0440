//! Checks of a configuration before a motor may move.

mod contact;
mod events;
mod links;
mod monitors;
mod motion;
mod object;
mod pretension;
mod ranges;
mod rotors;
mod sharing;
mod simulation;
mod telemetry;
mod touch;

use crate::model::configuration::{
    BAUDS, Configuration, ConfiguredFinger, ConfiguredHand, LARGEST_GRAVITY, RATES, RealTime, Unusable,
};
use crate::model::physics::{LARGEST_INERTIA, SMALLEST_INERTIA};
use crate::model::{FingerNumber, TendonsError};
use ranges::{each, path, unusable, within};
use std::fmt;

/// A section of the configuration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Section {
    /// `[hand]`
    Hand,
    /// `[telemetry]`
    Telemetry,
    /// `[finger]` and the table of this finger.
    Finger(FingerNumber),
}

impl fmt::Display for Section {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Section::Hand => formatter.write_str("hand"),
            Section::Telemetry => formatter.write_str("telemetry"),
            Section::Finger(number) => write!(formatter, "finger.{number}"),
        }
    }
}

/// A configuration that cannot be used: the section, the key and the reason.
#[derive(Clone, Debug, PartialEq)]
pub struct UnusableConfiguration {
    /// The section.
    pub section: Section,
    /// The key and the reason.
    pub unusable: Unusable,
}

impl Configuration {
    /// Checks every value, and every relation between values that can be checked without a port.
    ///
    /// # Errors
    /// Returns the first unusable value.
    pub fn check(&self) -> Result<(), UnusableConfiguration> {
        self.hand.check().map_err(|unusable| UnusableConfiguration { section: Section::Hand, unusable })?;
        let of_telemetry = |unusable| UnusableConfiguration { section: Section::Telemetry, unusable };
        self.telemetry.check().map_err(of_telemetry)?;
        for (number, finger) in FingerNumber::ALL.into_iter().zip(&self.fingers) {
            let section = Section::Finger(number);
            finger.check().map_err(|unusable| UnusableConfiguration { section, unusable })?;
            let present = self.hand.fingers.contains(number);
            if present && finger.priority == 0 && self.hand.real_time == RealTime::Enforce {
                let reason = "0 is not a real-time priority, but hand.real_time is \"enforce\": set 1 to 99".into();
                return Err(UnusableConfiguration { section, unusable: Unusable { key: "priority", reason } });
            }
        }
        // A finger that the hand does not have may have any port and thread.
        for second in self.hand.fingers.members() {
            for first in self.hand.fingers.members().take_while(|&first| first < second) {
                let between = self.check_sharing(first, second);
                let section = Section::Finger(second);
                between.map_err(|unusable| UnusableConfiguration { section, unusable })?;
            }
        }
        Ok(())
    }
}

impl ConfiguredHand {
    /// Checks every value of `[hand]`.
    ///
    /// # Errors
    /// Returns the first unusable value.
    pub fn check(&self) -> Result<(), Unusable> {
        let (least, most) = (*RATES.start(), *RATES.end());
        if self.rate < least {
            let reason = format!(
                "{} Hz is below {least} Hz, the lowest rate at which every finger is known to be stable: raise it",
                self.rate
            );
            return unusable("rate", reason);
        }
        within("rate", self.rate, least, most, "Hz")?;
        within("hold_time_ms", self.hold_time_ms.into(), 1.0, 60_000.0, "ms")?;
        within("hold_torque_limit", self.hold_torque_limit, 0.0, 1000.0, "N cm")?;
        within("release_ramp_ms", self.release_ramp_ms.into(), 0.0, 5000.0, "ms")?;
        within("open_timeout_ms", self.open_timeout_ms.into(), 10.0, 60_000.0, "ms")?;
        within("watchdog_ms", self.watchdog_ms.into(), 2.0, 1000.0, "ms")?;
        let period_ms = 1000.0 / self.rate;
        if f64::from(self.watchdog_ms) < 2.0 * period_ms {
            let reason = format!(
                "{} ms is less than two periods of {period_ms} ms: one lost command would stop the motors. Raise it",
                self.watchdog_ms
            );
            return unusable("watchdog_ms", reason);
        }
        path("black_box", self.black_box.as_deref().unwrap_or_default())?;
        self.search_ports.iter().try_for_each(|pattern| path("search_ports", pattern))?;
        each("gravity", &self.gravity, -LARGEST_GRAVITY, LARGEST_GRAVITY, "m/s^2")?;
        self.check_simulated_object()
    }
}

impl ConfiguredFinger {
    /// Checks every value of the finger and every relation between them.
    ///
    /// # Errors
    /// Returns the first unusable value.
    pub fn check(&self) -> Result<(), Unusable> {
        if self.port.is_empty() {
            return unusable("port", "is empty: set it to the path of a serial port or to \"simulated\"".into());
        }
        path("port", &self.port)?;
        within("baud", self.baud.into(), (*BAUDS.start()).into(), (*BAUDS.end()).into(), "baud")?;
        within("address", self.address.into(), 0.0, 15.0, "")?;
        within("thread", self.thread.into(), 0.0, 3.0, "")?;
        within("priority", self.priority.into(), 0.0, 99.0, "")?;
        each("base", &self.base.unwrap_or_default(), -100.0, 100.0, "cm")?;
        within("turn_degrees", self.turn_degrees.unwrap_or_default(), -360.0, 360.0, "degrees")?;
        self.check_mechanism()?;
        self.check_sensors_and_motors()?;
        self.check_limits()?;
        self.check_controller()?;
        self.check_mechanics()?;
        self.check_pretension()?;
        self.check_rotors()?;
        self.monitors.check()?;
        self.events.check()?;
        self.touch.check()?;
        self.contact.check()?;
        self.motion.check()?;
        self.check_calibration()?;
        self.check_simulation()
    }

    fn check_mechanism(&self) -> Result<(), Unusable> {
        each("geometry.links", &self.geometry.links, 0.1, 100.0, "cm")?;
        self.geometry.r.iter().try_for_each(|row| each("geometry.r", row, -20.0, 20.0, "cm"))?;
        each("geometry.motor_radius", &self.geometry.motor_radius, 1e-3, 20.0, "cm")?;
        within("tendon.minimum", self.tendon.minimum, 0.1, 1000.0, "N")?;
        within("tendon.maximum", self.tendon.maximum, 0.1, 1000.0, "N")?;
        each("tendon.stiffness", &self.tendon.stiffness, 1.0, 1e6, "N/cm")?;
        within("tendon.stiffness_tolerance", self.tendon.stiffness_tolerance, 0.0, 1.0, "")?;
        if let Some(ghost) = &self.geometry.ghost_row {
            each("geometry.ghost_row", ghost, -100.0, 100.0, "")?;
        }
        let tendons = self.tendons().or_else(|error| {
            let key = match error {
                TendonsError::Singular(_) => "geometry.r",
                TendonsError::GhostColumn(_) if self.geometry.ghost_row.is_some() => "geometry.ghost_row",
                TendonsError::GhostColumn(_) => "geometry.r",
            };
            unusable(key, error.to_string())
        })?;
        let largest = tendons.pretension(self.tendon.minimum).max();
        if self.tendon.maximum <= largest {
            let reason = format!(
                "{} N is too low: with tendon.minimum = {} N one tendon needs {largest:.3} N for its pretension alone. \
                 Raise tendon.maximum, or lower tendon.minimum",
                self.tendon.maximum, self.tendon.minimum
            );
            return unusable("tendon.maximum", reason);
        }
        Ok(())
    }

    fn check_sensors_and_motors(&self) -> Result<(), Unusable> {
        let signs = |key, signs: &[i8; 4]| match signs.iter().all(|sign| sign.abs() == 1) {
            true => Ok(()),
            false => unusable(key, format!("{signs:?} has an entry other than 1 and -1: set each sign to 1 or -1")),
        };
        signs("motor.sign", &self.motor.sign)?;
        signs("encoder.sign", &self.encoder.sign)?;
        each("motor.torque_limit", &self.motor.torque_limit, 1e-3, 6000.0, "N cm")?;
        each("motor.torque_constant", &self.motor.torque_constant, 1e-3, 1e4, "N cm/A")?;
        each("encoder.counts_per_revolution", &self.encoder.counts_per_revolution.map(f64::from), 4.0, 1e7, "")?;
        each("gauge.newton_per_count", &self.gauge.newton_per_count.map(f64::abs), 1e-6, 10.0, "N per count")?;
        each("gauge.zero", &self.gauge.zero, -65_536.0, 65_536.0, "counts")
    }

    fn check_limits(&self) -> Result<(), Unusable> {
        each("joints.minimum_degrees", &self.joints.minimum_degrees, -180.0, 180.0, "degrees")?;
        each("joints.maximum_degrees", &self.joints.maximum_degrees, -180.0, 180.0, "degrees")?;
        for joint in 0..3 {
            let (low, high) = (self.joints.minimum_degrees[joint], self.joints.maximum_degrees[joint]);
            if low >= high {
                let reason = format!(
                    "the lower limit of joint {joint}, {low:.4} degrees, is not below its upper limit, {high:.4} \
                     degrees: lower joints.minimum_degrees, or raise joints.maximum_degrees"
                );
                return unusable("joints.minimum_degrees", reason);
            }
        }
        if self.joints.minimum_degrees[2] <= 0.0 {
            let reason = format!(
                "{} degrees lets joint 2 straighten the finger, and a straight finger is singular: set it above 0",
                self.joints.minimum_degrees[2]
            );
            return unusable("joints.minimum_degrees", reason);
        }
        if let Some(bound) = self.stiffness.bound {
            within("stiffness.bound", bound, 1e-3, 1000.0, "N/cm")?;
        }
        self.stiffness.initial.iter().try_for_each(|row| each("stiffness.initial", row, -1000.0, 1000.0, "N/cm"))
    }

    fn check_controller(&self) -> Result<(), Unusable> {
        let optional = |key, value: Option<f64>, low, high, unit| {
            value.map_or(Ok(()), |value| within(key, value, low, high, unit))
        };
        let controller = &self.controller;
        optional("controller.tension_gain", controller.tension_gain, 0.0, 100.0, "")?;
        optional("controller.tension_integral", controller.tension_integral, 0.0, 1e4, "1/s")?;
        optional("controller.motor_damping", controller.motor_damping, 0.0, 1e4, "N s/m")?;
        optional("controller.rate_time", controller.rate_time, 0.0, 1.0, "s")?;
        optional("controller.speed_filter", controller.speed_filter, 1.0, 1e4, "Hz")?;
        optional("controller.stretch_filter", controller.stretch_filter, 0.1, 1e4, "Hz")?;
        optional("controller.set_point_speed", controller.set_point_speed, 1e-3, 1e3, "rad/s")?;
        optional("controller.adaptation_gain", controller.adaptation_gain, 0.0, 30.0, "1/s")?;
        optional("controller.inertia_gain", controller.inertia_gain, 0.1, 20.0, "")?;
        optional("controller.damping_ratio", controller.damping_ratio, 0.05, 0.45, "")?;
        optional("controller.set_point_time", controller.set_point_time, 1e-3, 0.02, "s")?;
        optional("controller.dither", controller.dither, 0.0, 10.0, "")?;
        optional("controller.tension_dither", controller.tension_dither, 0.0, 0.4, "")?;
        optional("controller.friction_share", controller.friction_share, 0.0, 1.0, "")
    }

    fn check_mechanics(&self) -> Result<(), Unusable> {
        each("motor.inertia", &self.motor.inertia, SMALLEST_INERTIA, LARGEST_INERTIA, "kg m^2")?;
        each("motor.viscous_friction", &self.motor.viscous_friction, 0.0, 1.0, "N m s/rad")?;
        each("motor.continuous_torque", &self.motor.continuous_torque, 1e-3, 6000.0, "N cm")?;
        within("motor.thermal_time", self.motor.thermal_time, 0.1, 1e4, "s")?;
        each("links.masses", &self.links.masses, 1e-6, 10.0, "kg")?;
        each("links.radii", &self.links.radii, 1e-4, 1.0, "m")?;
        each("friction.motor_coulomb", &self.friction.motor_coulomb, 0.0, 1000.0, "N cm")?;
        each("friction.conduit", &self.friction.conduit, 0.0, 1.0, "")?;
        each("friction.pulley", &self.friction.pulley, 0.0, 1.0, "")?;
        each("friction.joint_coulomb", &self.friction.joint_coulomb, 0.0, 1000.0, "N cm")?;
        each("friction.joint_viscous", &self.friction.joint_viscous, 0.0, 100.0, "N cm s/rad")
    }

    fn check_calibration(&self) -> Result<(), Unusable> {
        let zeroing = &self.zeroing;
        each("zeroing.pose_degrees", &zeroing.pose_degrees, -180.0, 180.0, "degrees")?;
        each("zeroing.lower_stop_degrees", &zeroing.lower_stop_degrees.unwrap_or_default(), -270.0, 270.0, "degrees")?;
        each("zeroing.upper_stop_degrees", &zeroing.upper_stop_degrees.unwrap_or_default(), -270.0, 270.0, "degrees")?;
        let ((lower, upper), (low, high)) = (self.stops(), self.joint_limits());
        for joint in 0..3 {
            let inside = |key, stop: f64, limit: f64| {
                let (stop, limit) = (stop.to_degrees(), limit.to_degrees());
                unusable(
                    key,
                    format!(
                        "joint {joint}: a stop at {stop:.4} degrees is inside the limit of {limit:.4}: set it at the \
                         limit or beyond"
                    ),
                )
            };
            if lower[joint] > low[joint] {
                return inside("zeroing.lower_stop_degrees", lower[joint], low[joint]);
            }
            if upper[joint] < high[joint] {
                return inside("zeroing.upper_stop_degrees", upper[joint], high[joint]);
            }
        }
        within("zeroing.torque", zeroing.torque, 1e-3, 95.0, "N cm")?;
        within("zeroing.speed", zeroing.speed, 1e-2, 10.0, "rad/s")?;
        within("zeroing.time_limit_s", zeroing.time_limit_s, 1.0, 3600.0, "s")
    }
}
