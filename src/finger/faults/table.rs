//! The table of all faults: texts, the constants of the C header and `docs/faults.md` come from here.
//!
//! Numbers are for ever: a new fault takes the next one, and one that is no longer found keeps its own.

use super::kind::{Description, Part, Quantity, Severity};

macro_rules! faults {
    ($($number:literal $kind:ident $constant:literal $severity:ident $part:ident $quantity:ident
        $name:literal, $text:literal, $cause:literal, $remedy:literal;)*) => {
        /// Everything that has a name of its own when it goes wrong.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u8)]
        pub enum FaultKind {
            $(#[doc = concat!($name, ": ", $text, ".")] $kind = $number,)*
        }

        impl FaultKind {
            /// All of them, in the order of their numbers.
            pub const ALL: &[FaultKind] = &[$(FaultKind::$kind,)*];

            /// What is to be said about it.
            pub fn description(self) -> &'static Description {
                match self {
                    $(FaultKind::$kind => &Description {
                        constant: $constant,
                        severity: Severity::$severity,
                        part: Part::$part,
                        quantity: Quantity::$quantity,
                        name: $name,
                        text: $text,
                        cause: $cause,
                        remedy: $remedy,
                    },)*
                }
            }
        }
    };
}

faults! {
    1 SlackTendon "SLACK_TENDON" Fault Tendon Tension "slack tendon",
        "a tendon does not come under tension within hand.open_timeout_ms, or does not keep it, though its motor pulls",
        "a knot or clamp slips, the tendon is off its pulley, or a sign or zero of motor or gauge is wrong",
        "Look after the tendon, RecoverHand; for wrong signs and zeros: CloseHand, sun2xp calibrate";
    2 BrokenTendon "BROKEN_TENDON" Fault Tendon Tension "broken tendon",
        "the tension of a tendon is gone while its motor turns, and the finger no longer holds the others tight",
        "the tendon is torn or has come off",
        "Replace the tendon, RecoverHand, ZeroFinger";
    3 OverTension "OVER_TENSION" Fault Tendon Tension "over-tension",
        "a tendon is pulled far beyond finger.tendon.maximum",
        "the finger was struck or bent by force, a joint jams, or the gauge's scale is wrong",
        "Take away what loads the finger, RecoverHand; check finger.tendon.maximum and the gauge's scale";
    4 GaugeStuck "GAUGE_STUCK" Fault Gauge Counts "gauge stuck",
        "a strain gauge shows the same count whatever happens",
        "its wire is broken, or its amplifier or converter has failed",
        "Check the gauge's wiring and the board, RecoverHand, ZeroFinger";
    5 GaugeOutOfRange "GAUGE_OUT_OF_RANGE" Fault Gauge Counts "gauge out of range",
        "a strain gauge is at the end of its converter, or far below no tension",
        "a short circuit or a broken wire, or finger.gauge.zero is wrong",
        "Check the gauge's wiring, RecoverHand, ZeroFinger";
    6 GaugeDisagrees "GAUGE_DISAGREES" Fault Gauge Tension "gauge against encoders",
        "the tensions no longer fit the stretch that the four encoders tell",
        "a gauge drifts, an encoder or a pulley slipped, or a tendon has stretched for good",
        "RecoverHand, ZeroFinger; if it comes back, look after the gauge and the tendon that are named";
    7 EncoderJump "ENCODER_JUMP" Fault Encoder Counts "encoder jump",
        "an encoder moved farther in one cycle than its motor can",
        "interference on the encoder's lines, a loose plug, or a board that lost its counts",
        "Check the encoder's cable and screen, RecoverHand, ZeroFinger";
    8 StalledMotor "STALLED_MOTOR" Fault Motor Tension "stalled motor",
        "a motor does not turn though its torque and its tendon are far out of balance",
        "the motor or its gear jams, its wires are broken, or its driver is off",
        "Turn the motor by hand with the power off, check its wiring, RecoverHand";
    9 OverheatedMotor "OVERHEATED_MOTOR" Fault Motor Share "over-heated motor",
        "a motor has been as warm as it may be for too long, by the square of its torque over time",
        "the finger presses or holds more than it can for ever",
        "Let it cool, RecoverHand, ask for less; check finger.motor.continuous_torque and thermal_time";
    10 JointAtStop "JOINT_AT_STOP" Warning Joint Angle "joint at its stop",
        "a joint is beyond its limit, at its mechanical stop",
        "something pushes the finger, or the zero of the encoders is wrong",
        "Take the load away; if nothing pushes, zero the finger";
    11 ImpossiblePose "IMPOSSIBLE_POSE" Fault Joint Angle "impossible pose",
        "a joint reads an angle that it cannot reach",
        "a tendon is broken or off its pulley, an encoder lost its zero, or an encoder sign is wrong",
        "Look after the tendons, RecoverHand; if it comes back: CloseHand, sun2xp calibrate";
    12 SlackInMotion "SLACK_IN_MOTION" Warning Tendon Tension "slack in motion",
        "a tendon lost its tension for a moment",
        "a motion or a blow faster than the motors follow",
        "Move more slowly, or raise finger.tendon.minimum";
    13 LostReplies "LOST_REPLIES" Fault Finger Time "lost replies",
        "no valid reply from the board for so long",
        "the cable is out, the board has no power, there is too much noise on the line, or the board sends without end",
        "Check cable, power and the board's firmware, RecoverHand";
    14 DamagedReplies "DAMAGED_REPLIES" Fault Finger Share "damaged replies",
        "replies come in damaged (their CRC is wrong), too many to go on",
        "interference, a bad earth, a cable too long for the baud rate",
        "Check the cable's screen and earth, RecoverHand; or lower finger.baud";
    15 LineNoise "LINE_NOISE" Warning Finger Share "noise on the line",
        "replies are lost or damaged now and then",
        "interference, a loose plug, a USB adapter that holds bytes back",
        "Check cable and adapter before it gets worse";
    16 Watchdog "WATCHDOG" Fault Finger Status "watchdog",
        "the board's watchdog stopped the motors: commands came too late",
        "the servo is not real-time, or the machine is overloaded or was suspended",
        "Permit real time (README) or free the machine, RecoverHand; or raise hand.watchdog_ms";
    17 BoardStopped "BOARD_STOPPED" Fault Finger Status "board stopped",
        "the board stopped the motors by itself and names no fault",
        "another program told it to stop, or its firmware did",
        "See the status bits in docs/board-protocol.md; RecoverHand";
    18 EmergencyStopInput "EMERGENCY_STOP_INPUT" Fault Finger Status "emergency stop, input",
        "the emergency stop input of the board is active, or was",
        "somebody pressed the button, or its wire is broken",
        "Make sure that it is safe, release the button, RecoverHand";
    19 EmergencyStopCall "EMERGENCY_STOP_CALL" Fault Finger Nothing "emergency stop, call",
        "the planner called for an emergency stop",
        "the planner or its user saw a danger",
        "Make sure that it is safe, RecoverHand";
    20 SupplyFault "SUPPLY_FAULT" Fault Finger Status "motor supply",
        "the motor supply is missing or out of range",
        "the supply is off or overloaded, or a fuse is blown",
        "Check the supply, RecoverHand";
    21 DriverFault "DRIVER_FAULT" Fault Finger Status "motor driver",
        "a motor driver reports over-current, over-temperature or a short circuit",
        "a motor is hot, jammed or short-circuited",
        "Let it cool, look after motors and wires, RecoverHand";
    22 SensorFault "SENSOR_FAULT" Fault Finger Status "sensor, by the board",
        "the board cannot read an encoder or a gauge",
        "a sensor's cable is out",
        "Check the sensors' cables, RecoverHand, ZeroFinger";
    23 BoardReset "BOARD_RESET" Fault Finger Nothing "board reset",
        "the board refuses commands because it is not configured: it was switched on or lost its power meanwhile",
        "the board's power failed or it was reset",
        "Check its power, RecoverHand";
    24 CommandRefused "COMMAND_REFUSED" Fault Finger Reason "command refused",
        "the board refuses the frames of this finger",
        "another program is using the board, or its firmware is wrong",
        "End the other program, RecoverHand; or CloseHand and update the firmware";
    25 PortVanished "PORT_VANISHED" Fault Finger Nothing "port vanished",
        "the serial port is gone",
        "the cable was unplugged, or the adapter or board lost its power; of a simulated finger: the planner closed descriptors of the library",
        "Plug it in, RecoverHand; without finger.reconnect CloseHand, OpenHand";
    26 PortFailed "PORT_FAILED" Fault Finger Errno "port failed",
        "reading or writing the serial port failed",
        "the adapter or its driver failed",
        "Plug the adapter out and in, RecoverHand; without finger.reconnect CloseHand, OpenHand";
    27 PortMissing "PORT_MISSING" Refusal Finger Nothing "port missing",
        "the configured serial port does not exist",
        "the cable is out, the board off, or finger.port is wrong",
        "Check cable, power and finger.port (ls -l /dev/serial/by-id)";
    28 PortBusy "PORT_BUSY" Refusal Finger Nothing "port busy",
        "another program uses the serial port",
        "a planner or a terminal program is still running",
        "Close it (fuser -v PORT names it), or configure another port";
    29 PortPermission "PORT_PERMISSION" Refusal Finger Nothing "port forbidden",
        "no permission to open the serial port",
        "the user is not in the port's group",
        "Add the user to the group (usually dialout) and log in again";
    30 PortUnusable "PORT_UNUSABLE" Refusal Finger Nothing "port unusable",
        "the port cannot be set up as configured",
        "finger.port is no serial port, or cannot run at finger.baud",
        "Configure another port or baud rate";
    31 BoardSilent "BOARD_SILENT" Refusal Finger Time "board silent",
        "not one byte came from the board",
        "it is off, the cable is out, transmit and receive are crossed, or it is another port's board",
        "Check power, cable and finger.port";
    32 Unintelligible "UNINTELLIGIBLE" Refusal Finger Nothing "no protocol",
        "bytes came, but no frame of this protocol",
        "the baud rate differs from the board's, or something else is at the port",
        "Check finger.baud and finger.port";
    33 Unanswered "UNANSWERED" Refusal Finger Nothing "finger silent",
        "the board sends frames, but not the answer that was asked for",
        "the board's firmware is wrong, or several boards answer",
        "Update the firmware; one board a port";
    34 WrongVersion "WRONG_VERSION" Refusal Finger Nothing "wrong protocol version",
        "board and library have no protocol version in common",
        "one of them is older",
        "Update the older one";
    35 WrongFinger "WRONG_FINGER" Refusal Finger Nothing "wrong finger",
        "the board at this port has no finger with this address",
        "ports are swapped, or finger.address is wrong",
        "Check finger.port and finger.address";
    36 UnsuitableBoard "UNSUITABLE_BOARD" Refusal Finger Nothing "wrong board",
        "the board cannot keep what is configured, or confirms something else",
        "it is another board than the configuration was made for",
        "Connect the right board, or change what the text of HandError names";
    37 IdentityChanged "IDENTITY_CHANGED" Fault Finger Nothing "identity changed",
        "another board answers than before",
        "boards or cables were exchanged while the hand was open",
        "Put the cables back as they were, RecoverHand; or CloseHand, OpenHand with the new board";
    38 ZeroLost "ZERO_LOST" Fault Finger Status "zero lost",
        "the board no longer vouches for its encoder counts",
        "the board or its encoders lost their power",
        "CloseHand, OpenHand, ZeroFinger";
    39 Overrun "OVERRUN" Warning Finger Share "overrun",
        "the servo comes late and skips periods",
        "the machine is overloaded, or the rate is too high for it",
        "Permit real time, give the servo a core, lower hand.rate";
    40 RealtimeRefused "REALTIME_REFUSED" Warning Finger Nothing "no real time",
        "the system does not let the servo run in real time",
        "CAP_SYS_NICE or an rtprio limit is missing",
        "See README, or set finger.priority = 0 to do without";
    41 ServoPanic "SERVO_PANIC" Fault Finger Nothing "servo failed",
        "the servo thread failed",
        "a defect of this library",
        "Report it, please; CloseHand, OpenHand";
    42 CurrentLimit "CURRENT_LIMIT" Warning Finger Nothing "current limit",
        "the board clips torques to its limits",
        "its limits are lower than finger.motor.torque_limit",
        "Lower finger.motor.torque_limit";
    43 TorqueNotAdmitted "TORQUE_NOT_ADMITTED" Warning Finger Share "torque not admitted",
        "the tension limits let only this part of the wanted joint torque through",
        "the set point is far away, or stiffness or load are more than the tendons may carry",
        "Send nearer set points, or a softer Kx";
    44 CalibrationFailed "CALIBRATION_FAILED" Warning Finger Nothing "calibration failed",
        "the last calibration gave up; the finger is limp, its calibration as it was",
        "something stood in the way: see the text of the call",
        "Do what that text says and calibrate again";
    45 WarmMotor "WARM_MOTOR" Warning Motor Share "warm motor",
        "a motor is near what it may bear for ever, and its torque is being limited",
        "the finger presses or holds more than it can for ever",
        "Ask for less, or let it rest";
    46 Companion "COMPANION" Fault Finger Nothing "stopped with another",
        "another finger of the hand has faulted, and hand.on_fault is \"hand\"",
        "what the fault of that finger says",
        "Mend that, then RecoverHand for every finger";
    47 PortClosed "PORT_CLOSED" Fault Finger Nothing "port closed",
        "another part of the program has closed the descriptor of the port",
        "the planner closes descriptors that it has not opened, as a program does that makes itself a daemon",
        "CloseHand, OpenHand; make the planner a daemon before it calls OpenHand";
    48 OpeningTimedOut "OPENING_TIMED_OUT" Fault Finger Time "opening timed out",
        "the tendons were not all under tension when hand.open_timeout_ms was over, because the servo ran too few of its cycles",
        "the machine is overloaded, or the board's replies are lost",
        "Free the machine or permit real time (README), or raise hand.open_timeout_ms; RecoverHand, or OpenHand";
    49 SameNumber "SAME_NUMBER" Refusal Finger Nothing "same number",
        "boards at two ports have one unique number, so that nobody can tell them apart",
        "their firmware gives every board the same number",
        "Give every board a number of its own in its firmware";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_1_2_3_and_so_on_and_constants_are_unique() {
        for (index, kind) in FaultKind::ALL.iter().enumerate() {
            assert_eq!(usize::from(kind.number()), index + 1);
            assert_eq!(FaultKind::from_number(index as i32 + 1), Some(*kind));
            let same =
                FaultKind::ALL.iter().filter(|other| other.description().constant == kind.description().constant);
            assert_eq!(same.count(), 1, "{}", kind.description().constant);
        }
        assert_eq!(FaultKind::from_number(0), None);
        assert_eq!(FaultKind::from_number(-1), None);
    }

    #[test]
    fn texts_are_sentences_without_their_ends() {
        for kind in FaultKind::ALL {
            let told = kind.description();
            for part in [told.name, told.text, told.cause, told.remedy] {
                assert!(!part.is_empty() && !part.ends_with('.') && !part.contains("*/"), "{kind:?}: {part}");
            }
            assert!(told.remedy.starts_with(char::is_uppercase), "{kind:?}: {}", told.remedy);
        }
    }
}
