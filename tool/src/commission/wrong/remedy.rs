//! What to do about something that is wrong.

use super::Wrong;

/// Distance between a gauge zero and the end of the converter's range, counts. It is enough for drift and noise.
const MARGIN: f64 = 100.0;

impl Wrong {
    /// What to do, or what the tool has done.
    pub fn remedy(&self) -> String {
        match self {
            Self::EmergencyStop => {
                "Release it, reset the safety relay, and check the wires of its contact. If the board reports the \
                 stop only while the button is not pressed, correct the polarity of the input"
                    .into()
            }
            Self::EmergencyStopUnseen => {
                "Check the wires from the contact of the stop to the board. Without this signal the library does not \
                 know that the motors have no power"
                    .into()
            }
            Self::Supply => "Switch the supply on, and check the wire of its DC-OK output".into(),
            Self::EncodersExchanged(order) => format!("Swap the encoder cables: {}", moves(order)),
            Self::MotorsAndEncodersExchanged(order) => {
                format!("Swap motor and encoder cables together: {}", moves(order))
            }
            Self::MotorsExchanged(one, other) => {
                format!("Swap the cables of motors {one} and {other} at their drivers. The encoders are right")
            }
            Self::TendonsExchanged(one, other) => format!(
                "Put tendon {one} on the drum of motor {one}, and tendon {other} on the drum of motor {other}. Cables \
                 of motors, encoders and gauges are right"
            ),
            Self::GaugesExchanged(order) => format!("Swap the gauge cables: {}", moves(order)),
            _ => self.remedy_of_motors(),
        }
    }

    /// The remedies of motors and encoders.
    fn remedy_of_motors(&self) -> String {
        match self {
            Self::EncoderReversed(encoder) => {
                format!(
                    "Nothing to do: encoder.sign compensates it. Or swap the channels A and B of encoder {encoder} and \
                     repeat the step"
                )
            }
            Self::EncoderDead(encoder) => format!(
                "Check the cable and the supply of encoder {encoder}, and that its disc turns with the shaft. An \
                 encoder also does not count if one of its two channels is missing"
            ),
            Self::EncoderScale(..) => "Nothing to do: encoder.counts_per_revolution is corrected".into(),
            Self::EncoderUnclear(motor, _) => {
                format!(
                    "Turn motor {motor} by exactly one turn; a mark on its shaft helps. If the number stays the same, \
                     leave with q, correct encoder.counts_per_revolution in the configuration file, and start the tool \
                     again"
                )
            }
            Self::MotorReversed(motor) => {
                format!(
                    "Nothing to do: motor.sign compensates it. Or, if motor {motor} is brushed, swap its two wires and \
                     repeat the step"
                )
            }
            Self::MotorBlocked(motor) => format!("Free motor {motor}: its drum, brake, bearing or tendon blocks it"),
            Self::MotorDead(motor) => format!(
                "Check the wires of motor {motor}, and that its driver is enabled, has its supply and shows no fault"
            ),
            Self::MotorTorque(motor, _) => format!(
                "The hand works nevertheless. Check motor.torque_constant of motor {motor}, and the scale of its \
                 driver's current reference"
            ),
            Self::EncodersUnclear(_) => {
                "Do the step again. Turn only the motor that the tool names, by one full turn, and hold the finger \
                 still when the tool asks. If the result is the same, follow the cables of the encoders and of the \
                 motors to the board, and put each plug into the socket of its number"
                    .into()
            }
            Self::TurnedWrongWay => {
                "Do the step again. Turn each motor in the direction that makes its tendon loose".into()
            }
            _ => self.remedy_of_gauges(),
        }
    }

    /// The remedies of gauges.
    fn remedy_of_gauges(&self) -> String {
        match self {
            Self::GaugeReversed(gauge) => format!(
                "Nothing to do: the sign of gauge.newton_per_count compensates it. Or swap the two signal wires of \
                 gauge {gauge} and repeat the step"
            ),
            Self::GaugeDead(gauge) => {
                format!("Check the cable, the supply and the amplifier of gauge {gauge}, and that the weight bends it")
            }
            Self::GaugeScale(gauge, _) if self.suspect() => format!(
                "gauge.newton_per_count is corrected. But the tolerances of sound parts do not explain so large an \
                 error, so the cause is probably the wiring of gauge {gauge} or a wrong mass: check the masses, the \
                 supply of its bridge, the gain of its amplifier, and the wires of the bridge. After a repair, start \
                 the tool with --step gauges"
            ),
            Self::GaugeScale(..) => "Nothing to do: gauge.newton_per_count is corrected".into(),
            Self::GaugeZero(..) => "Nothing to do: gauge.zero is corrected".into(),
            Self::GaugeNoise(gauge, _) => {
                format!("Check the shield and the ground of gauge {gauge}, and keep motor wires away from its cable")
            }
            Self::GaugeNotLinear(gauge, _) => format!(
                "Check the masses of the weights, that they hang freely, and that nothing rubs on tendon {gauge}"
            ),
            Self::GaugeAtEnd(gauge, count, zero) => {
                // The count shows at which end of the range the gauge is. The zero that was
                // computed from the readings with weights is less certain.
                let direction = if *count < 1.0 { "up" } else { "down" };
                format!(
                    "Shift the offset of amplifier {gauge} {direction} by at least {:.0} counts, so that the count \
                     without load is inside the range. Then do the step again",
                    (zero - count).abs() + MARGIN
                )
            }
            Self::GaugesUnclear(_) => {
                "Do the step again. Hang the weight only on the tendon that the tool names, and let it hang freely. \
                 If the same gauge shows two weights again, check the cables of the gauges"
                    .into()
            }
            _ => self.remedy_of_tendons(),
        }
    }

    /// The remedies of tendons, the spring and the routines.
    fn remedy_of_tendons(&self) -> String {
        match self {
            Self::TendonLoose(tendon) => {
                format!("Check tendon {tendon}: it is off its drum or a pulley, broken, or has more than 8 mm of slack")
            }
            Self::TendonTension(tendon, part) if *part < 1.0 => {
                format!("Shorten tendon {tendon}, or look for friction in its path")
            }
            Self::TendonTension(tendon, _) => format!("Look for friction in the path of tendon {tendon}"),
            Self::SpringStiffness(..) => {
                "Either the push changed its direction, or the tendons were measured badly. Leave with q, and start \
                 the tool again with --step tendons --step spring. In the step \"spring\", push along one direction \
                 only"
                    .into()
            }
            Self::SpringReturn(_) => "The cause is friction. docs/tuning.md says how to compensate for it".into(),
            Self::InitialLowered(..) => {
                "stiffness.initial is lowered to the bound. sun2xp bound simulates variants of the finger. It shows \
                 the bound of each variant, and names what limits the lowest bound"
                    .into()
            }
            Self::PoseRefused(_) => {
                "If a jig held the finger, the finger probably trembled because the signals of its gauges arrive \
                 too late: zero the finger at its stops instead. For that, leave with q and set three keys of this \
                 finger in the configuration file: zeroing.method = \"stops\", and the angles of its stops in \
                 zeroing.lower_stop_degrees and zeroing.upper_stop_degrees. Then start the tool again: it reads the \
                 file only when it starts"
                    .into()
            }
            Self::Computer(_) => {
                "Until the cause is removed, later steps may stop with lost replies, and readings may be missing".into()
            }
            Self::NotPushed => "Push the tip before you press Enter".into(),
            Self::NotWeighed(tendon) => format!("Hang at least one weight on tendon {tendon}"),
            Self::NotPrepared => "Make it possible, or leave with q and do the step later".into(),
            Self::Refused(_) => {
                "If the configuration file must be changed, leave with q, change the file, and start the tool again. \
                 The tool reads the file only when it starts"
                    .into()
            }
            _ => String::new(),
        }
    }
}

/// Says which plug belongs where. `order[n]` is the number at which the plug of part n + 1 is found.
fn moves(order: &[usize; 4]) -> String {
    let wrong = order.iter().enumerate().filter(|&(place, &found)| place + 1 != found);
    let text = |(place, found): (usize, &usize)| format!("the plug in socket {found} belongs in socket {}", place + 1);
    wrong.map(text).collect::<Vec<_>>().join(", ")
}
