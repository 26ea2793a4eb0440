//! The table of all faults. The texts of faults, the constants of the C header and the table in `docs/faults.md` are
//! generated from it.
//!
//! A row has these columns: number, kind, constant, severity, part, quantity and name; then text, cause and remedy;
//! then the actions that the remedy names. [`Description`] explains the columns.
//!
//! Numbers are permanent: a new fault gets the next free number, and a fault that is no longer detected keeps its
//! number.

use super::action::Action;
use super::description::{Description, PartKind, Quantity, Severity};
use super::table_macro::faults;

faults! {
    1 SlackTendon "SLACK_TENDON" Fault Tendon Tension "slack tendon",
        "a tendon does not come to rest under tension within hand.open_timeout_ms, or loses its tension although its \
         motor pulls",
        "a knot or clamp slips, the tendon is off its pulley, the finger is moved while it takes up slack, there is \
         more slack than the motor winds in before the time-out, or the sign or zero of a motor or gauge is wrong",
        "Repair the tendon and recover the finger; if a sign or zero is wrong, close the hand and run sun2xp calibrate",
        [Recover, Close];
    2 BrokenTendon "BROKEN_TENDON" Fault Tendon Tension "broken tendon",
        "a tendon shows almost no tension although the encoders and the other gauges indicate that it is stretched, or \
         shows almost none for half a second",
        "the tendon is torn or has come off",
        "Replace the tendon, then recover and zero the finger", [Recover, Zero];
    3 OverTension "OVER_TENSION" Fault Tendon Tension "over-tension",
        "the tension of a tendon is far above finger.tendon.maximum",
        "the finger was hit or bent by force, a joint is jammed, or the scale of the gauge is wrong",
        "Remove the load from the finger, or free its joint, and recover it; check finger.tendon.maximum and \
         finger.gauge.newton_per_count", [Recover];
    4 GaugeStuck "GAUGE_STUCK" Fault Gauge Counts "gauge stuck",
        "the count of a strain gauge no longer changes",
        "the wire of the gauge is broken, or its amplifier or converter has failed",
        "Check the wiring of the gauge and the board, then recover and zero the finger", [Recover, Zero];
    5 GaugeOutOfRange "GAUGE_OUT_OF_RANGE" Fault Gauge Counts "gauge out of range",
        "a strain gauge reads the end of its converter's range, or a value far below zero tension",
        "a short circuit, a broken wire, or a wrong finger.gauge.zero",
        "Check the wiring of the gauge, then recover and zero the finger", [Recover, Zero];
    6 GaugeDisagrees "GAUGE_DISAGREES" Fault Gauge Tension "gauge against encoders",
        "the measured tensions do not agree with the stretch of the tendons that the four encoders measure",
        "a gauge drifts, an encoder or a pulley has slipped, or a tendon has stretched permanently",
        "Recover and zero the finger; if the fault returns, inspect this gauge and its tendon", [Recover, Zero];
    7 EncoderJump "ENCODER_JUMP" Fault Encoder Counts "encoder jump",
        "the count of an encoder changed by more in one cycle than its motor can turn",
        "interference on the lines of the encoder, a loose plug, or a board that has lost counts",
        "Check the encoder's cable and its shield, then recover and zero the finger", [Recover, Zero];
    8 StalledMotor "STALLED_MOTOR" Fault Motor Tension "stalled motor",
        "a motor does not turn although its torque and the tension of its tendon are far out of balance",
        "the motor or its gear is jammed, its wires are broken, or its driver is off",
        "With the motor supply off, turn the motor by hand and check its wiring; then recover the finger", [Recover];
    9 OverheatedMotor "OVERHEATED_MOTOR" Fault Motor Share "overheated motor",
        "a motor has been at its thermal limit for too long; its heat is computed as a moving average of its squared \
         torque",
        "the finger presses or holds more than the motor can carry continuously",
        "Let the motor cool, recover the finger and command less force; check finger.motor.continuous_torque and \
         finger.motor.thermal_time", [Recover];
    10 JointAtStop "JOINT_AT_STOP" Warning Joint Angle "joint at its stop",
        "a joint is beyond its limit, at its mechanical stop",
        "something pushes the finger, or the zero of the encoders is wrong",
        "Remove what pushes the finger; if nothing does, zero the finger", [Zero];
    11 ImpossiblePose "IMPOSSIBLE_POSE" Fault Joint Angle "impossible pose",
        "the measured angle of a joint is one that the joint cannot reach",
        "a tendon is broken or off its pulley, an encoder has lost its zero, or the sign of an encoder is wrong",
        "Inspect the tendons and recover the finger; if the fault returns, close the hand and run sun2xp calibrate",
        [Recover, Close];
    12 SlackInMotion "SLACK_IN_MOTION" Warning Tendon Tension "slack in motion",
        "a tendon lost its tension for a moment",
        "a motion or an impact that is faster than the motors can follow",
        "Move more slowly, or raise finger.tendon.minimum", [];
    13 LostReplies "LOST_REPLIES" Fault Finger Time "lost replies",
        "the board has sent no valid reply for too long; the value is this time",
        "the cable is unplugged, the board has no power, the line is too noisy, the board sends without a pause, or \
         this computer is too busy to receive in time",
        "Check the cable, the power and the firmware of the board, and the load of this computer (run sun2xp doctor); \
         then recover the finger", [Recover];
    14 DamagedReplies "DAMAGED_REPLIES" Fault Finger Share "damaged replies",
        "too many replies have a wrong checksum",
        "interference, a bad ground connection, or a cable that is too long for the baud rate",
        "Check the shield and the ground of the cable and recover the finger; or lower the board's baud rate and \
         finger.baud", [Recover];
    15 LineNoise "LINE_NOISE" Warning Finger Share "noise on the line",
        "replies are lost or damaged from time to time",
        "interference, a loose plug, or a USB adapter that delays bytes",
        "Check the cable and the adapter before more replies are lost", [];
    16 Watchdog "WATCHDOG" Fault Finger Status "watchdog",
        "the watchdog of the board stopped the motors because commands came too late",
        "the servo does not run in real time, or the machine is overloaded or was suspended",
        "Permit real-time scheduling (run sun2xp doctor) or reduce the load of the machine, then recover the \
         finger; or raise hand.watchdog_ms", [Recover];
    17 BoardStopped "BOARD_STOPPED" Fault Finger Status "board stopped",
        "the board stopped the motors and reports no fault",
        "another program sent the board a Stop frame, or the firmware stopped the motors without a command",
        "End other programs that use the board, or correct its firmware, then recover the finger", [Recover];
    18 EmergencyStopInput "EMERGENCY_STOP_INPUT" Fault Finger Status "emergency stop, input",
        "the emergency stop input of the board is active, or was active",
        "somebody pressed the button, or the wire of the button is broken",
        "Make sure that the hand can move safely, release or repair the button, then recover the finger", [Recover];
    19 EmergencyStopCall "EMERGENCY_STOP_CALL" Fault Finger Nothing "emergency stop, call",
        "the program requested an emergency stop",
        "the program or its user detected a danger",
        "Make sure that the hand can move safely, then recover the finger", [Recover];
    20 SupplyFault "SUPPLY_FAULT" Fault Finger Status "motor supply",
        "the supply of the motors is missing or out of range",
        "the supply is off or overloaded, or a fuse is blown",
        "Check the supply, then recover the finger", [Recover];
    21 DriverFault "DRIVER_FAULT" Fault Finger Status "motor driver",
        "a motor driver reports over-current, over-temperature or a short circuit",
        "a motor is hot, jammed or short-circuited",
        "Let the motors cool, check the motors and their wires, then recover the finger", [Recover];
    22 SensorFault "SENSOR_FAULT" Fault Finger Status "sensor fault, reported by the board",
        "the board cannot read an encoder or a gauge",
        "the cable of a sensor is unplugged or broken",
        "Check the cables of the sensors, then recover and zero the finger", [Recover, Zero];
    23 BoardReset "BOARD_RESET" Fault Finger Nothing "board reset",
        "the board refuses commands because it has restarted and is not configured",
        "the board lost its power, or it was reset",
        "Check the power of the board, then recover the finger", [Recover];
    24 CommandRefused "COMMAND_REFUSED" Fault Finger Reason "command refused",
        "the board refuses the frames of this finger",
        "another program uses the board, or the firmware of the board is faulty",
        "End the other program and recover the finger; or close the hand and update the firmware", [Recover, Close];
    25 PortVanished "PORT_VANISHED" Fault Finger Nothing "port vanished",
        "the serial port no longer exists",
        "the cable was unplugged, or the adapter or the board lost its power; for a simulated finger: the program \
         closed descriptors of the library",
        "Plug the cable in; then recover the finger if its port is real and finger.reconnect is true, otherwise close \
         the hand and open it again", [Recover, Close, Open];
    26 PortFailed "PORT_FAILED" Fault Finger Errno "port failed",
        "reading or writing the serial port failed",
        "the adapter or its driver failed",
        "Unplug and replug the adapter; then recover the finger if finger.reconnect is true, otherwise close the hand \
         and open it again", [Recover, Close, Open];
    27 PortMissing "PORT_MISSING" Refusal Finger Nothing "port missing",
        "the configured serial port does not exist",
        "the cable is unplugged, the board is off, or finger.port is wrong",
        "Check the cable, the power and finger.port (ls -l /dev/serial/by-id)", [];
    28 PortBusy "PORT_BUSY" Refusal Finger Nothing "port busy",
        "another program, or another hand of this program, uses the serial port",
        "a planner or a terminal program is still running, or two hands have the same port",
        "End that program (fuser -v PORT names it), close that hand, or configure another port", [Close];
    29 PortPermission "PORT_PERMISSION" Refusal Finger Nothing "no permission for the port",
        "this user has no permission to use the serial port",
        "the user is not in the group of the port",
        "Add the user to the group (usually dialout) and log in again", [];
    30 PortUnusable "PORT_UNUSABLE" Refusal Finger Nothing "port unusable",
        "the port cannot be used as configured",
        "finger.port is not a serial port, the port cannot run at finger.baud or is not ready, its adapter or driver \
         has failed, a sandbox or container forbids a system call, or a system limit is reached",
        "Correct finger.port or finger.baud; try again after half a minute; check the adapter and its driver (dmesg); \
         or permit the system call or raise the limit that the error text names", [];
    31 BoardSilent "BOARD_SILENT" Refusal Finger Time "board silent",
        "no byte came from the board",
        "the board is off, the cable is unplugged, the transmit output of one side is not connected to the receive \
         input of the other, or another device is at the port",
        "Check the power, the cable and finger.port", [];
    32 Unintelligible "UNINTELLIGIBLE" Refusal Finger Nothing "no protocol",
        "bytes came, but no frame of the board protocol",
        "the baud rate differs from the board's, or another device is at the port",
        "Check finger.baud and finger.port", [];
    33 Unanswered "UNANSWERED" Refusal Finger Nothing "finger silent",
        "the board sends valid frames, but no answer to the request",
        "the firmware of the board is faulty, or several boards answer",
        "Update the firmware; connect only one board to each port", [];
    34 WrongVersion "WRONG_VERSION" Refusal Finger Nothing "wrong protocol version",
        "the board and the library have no protocol version in common",
        "one of them is older",
        "Update the older one", [];
    35 WrongFinger "WRONG_FINGER" Refusal Finger Nothing "wrong finger",
        "the board at this port has no finger with this address",
        "ports are swapped, or finger.address is wrong",
        "Check finger.port and finger.address", [];
    36 UnsuitableBoard "UNSUITABLE_BOARD" Refusal Finger Nothing "wrong board",
        "the board does not support the configuration, or confirms other values than those that were sent to it",
        "the configuration was made for another board, or the firmware of the board is faulty",
        "Connect the right board, change the setting that the error text names, or update the firmware", [];
    37 IdentityChanged "IDENTITY_CHANGED" Fault Finger Nothing "identity changed",
        "the board at the port is not the one that was there when the hand was opened",
        "boards or cables were exchanged while the hand was open",
        "Put the cables back and recover the finger; or close the hand and open it again to use the new board",
        [Recover, Close, Open];
    38 ZeroLost "ZERO_LOST" Fault Finger Status "zero lost",
        "the encoder counts of the board are no longer valid",
        "the board or its encoders lost their power",
        "Close the hand, open it again and zero the finger", [Close, Open, Zero];
    39 Overrun "OVERRUN" Warning Finger Share "overrun",
        "the servo misses its deadlines and skips periods",
        "the machine is overloaded, or the rate is too high for it",
        "Permit real-time scheduling (run sun2xp doctor), give the servo a core of its own (finger.core), or \
         lower hand.rate", [];
    40 RealtimeRefused "REALTIME_REFUSED" Warning Finger Nothing "real time refused",
        "the system does not permit the servo to run in real time",
        "CAP_SYS_NICE or an rtprio limit is missing",
        "Grant the permission (run sun2xp doctor), or set finger.priority = 0 to run without real time", [];
    41 ServoPanic "SERVO_PANIC" Fault Finger Nothing "servo failed",
        "the servo thread has failed",
        "a defect of this library",
        "Close the hand and open it again, and please report the defect", [Close, Open];
    42 CurrentLimit "CURRENT_LIMIT" Warning Finger Nothing "current limit",
        "the board clips torques to its own limits",
        "finger.motor.torque_limit needs more current than the board permits, or finger.motor.torque_constant is wrong",
        "Correct finger.motor.torque_constant, or lower finger.motor.torque_limit", [];
    43 TorqueNotAdmitted "TORQUE_NOT_ADMITTED" Warning Finger Share "torque not admitted",
        "the tension limits permit only a part of the desired joint torque; the value is this part",
        "the set point is far away, or the stiffness or the load is more than the tendons can carry",
        "Send set points that are nearer, or a softer Kx", [];
    44 CalibrationFailed "CALIBRATION_FAILED" Warning Finger Nothing "calibration failed",
        "the last calibration failed; the finger is limp, and its previous calibration is in force",
        "a tendon is slack, a gauge or encoder is dead, a joint is blocked or meets no stop, or the finger was moved",
        "Check the part that the calibration call's text names, let nothing push the finger, and calibrate again", [];
    45 WarmMotor "WARM_MOTOR" Warning Motor Share "warm motor",
        "a motor is near its thermal limit, and its torque is being limited",
        "the finger presses or holds more than the motor can carry continuously",
        "Command less force, or let the motor rest", [];
    46 Companion "COMPANION" Fault Finger Nothing "fault of another finger",
        "another finger of the hand has faulted, and hand.on_fault is \"hand\"",
        "the fault of that finger",
        "Remove the cause of that fault, then recover every finger", [Recover];
    47 PortClosed "PORT_CLOSED" Fault Finger Nothing "port closed",
        "another part of the program has closed the descriptor of the port",
        "the program closes descriptors that it has not opened, as a program does when it becomes a daemon",
        "Close the hand and open it again; a daemon must detach before it opens the hand", [Close, Open];
    48 OpeningTimedOut "OPENING_TIMED_OUT" Fault Finger Time "opening timed out",
        "not all tendons were under tension at the end of hand.open_timeout_ms, because the servo ran too few of its \
         cycles",
        "the machine is overloaded, or the board's replies are lost",
        "Reduce the load of the machine or permit real-time scheduling (sun2xp doctor), then recover the finger; or \
         raise hand.open_timeout_ms, which needs the hand to be closed and opened again", [Recover];
    49 SameNumber "SAME_NUMBER" Refusal Finger Nothing "same number",
        "the boards at two ports report the same unique number, so they cannot be distinguished",
        "their firmware gives every board the same number",
        "Give every board its own number in its firmware", [];
    50 FingerStopCall "STOP_CALL" Fault Finger Nothing "stop of the finger, call",
        "the program requested that this finger stop",
        "the program or its user wants this finger to be at rest, or detected a danger",
        "Make sure that the finger can move safely, then recover it", [Recover];
    51 SetPointExpired "SET_POINT_EXPIRED" Fault Finger Time "set point expired",
        "the planner has sent nothing since its last set point expired (if finger.motion.on_expiry = \"hold\", for \
         finger.motion.end_state_ms after that); with sun2xp serve: no target has arrived for serve.end_ms",
        "the planner hangs, is stopped in a debugger, or plans for longer than its set points are valid; with sun2xp \
         serve also: the planner was killed, or the network is cut or loses packets",
        "Recover the finger and send set points in time, or raise finger.motion.valid_ms, finger.motion.end_state_ms \
         or serve.end_ms", [Recover];
    52 ReflexStop "REFLEX_STOP" Fault Finger Nothing "stopped by a reflex",
        "the condition of a reflex was true, and its reaction stops the finger",
        "the planner installed the reflex for this case; the last event \"reflex fired\" has the number of the reflex",
        "Remove the cause, or remove the reflex, then recover the finger", [Recover];
    53 HardwareFailed "HARDWARE_FAILED" Refusal Finger Errno "hardware failed",
        "the hardware that the program provides for this finger does not start or stop",
        "the program's own function \"start\" or \"stop\" for this hardware has failed; the value is its errno",
        "Check the power and the cables of the hardware, end other programs that use it, and look up the errno in the \
         documentation of the program or of its hardware", [];
    54 WrongWiring "WRONG_WIRING" Refusal Finger Nothing "wrong wiring",
        "the self-test at open has found a part that is wired wrongly or dead; the error names it",
        "motors, encoders, gauges or tendons are swapped, a motor or sensor is connected backwards or not at all, or \
         the scale of a gauge has changed",
        "Correct the cable, the tendon, the sign or the scale that the error names, then open the hand again", [Open];
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
    fn texts_are_sentences_without_the_full_stop() {
        for kind in FaultKind::ALL {
            let row = kind.description();
            for part in [row.name, row.text, row.cause, row.remedy] {
                assert!(!part.is_empty() && !part.ends_with('.') && !part.contains("*/"), "{kind:?}: {part}");
            }
            assert!(row.remedy.starts_with(char::is_uppercase), "{kind:?}: {}", row.remedy);
        }
    }

    #[test]
    fn actions_are_those_that_the_remedy_names() {
        let (open, close) = ((Action::Open, "open"), (Action::Close, "close"));
        let verbs = [open, close, (Action::Recover, "recover"), (Action::Zero, "zero the")];
        for row in FaultKind::ALL.iter().map(|kind| kind.description()) {
            for (action, verb) in verbs {
                let named = row.remedy.to_lowercase().contains(&format!("{verb} "));
                assert_eq!(row.actions.contains(&action), named, "{action:?}: {}", row.remedy);
            }
        }
    }
}
