/* The numbers of docs/board-protocol.md, version 1. */

#ifndef FIRMWARE_PROTOCOL_H
#define FIRMWARE_PROTOCOL_H

enum { PROTOCOL_VERSION = 1 };

/* Frame types, which are the high half of the header. The top bit marks an answer. */
enum {
    TYPE_HELLO = 0x1,
    TYPE_CONFIGURE = 0x2,
    TYPE_COMMAND = 0x3,
    TYPE_STOP = 0x4,
    TYPE_TACTILE_REQUEST = 0x6,
    TYPE_IDENTITY = 0x9,
    TYPE_CONFIGURED = 0xA,
    TYPE_REPLY = 0xB,
    TYPE_STOPPED = 0xC,
    TYPE_REFUSED = 0xD,
    TYPE_TACTILE_EVENT = 0xE,
    TYPE_IS_ANSWER = 0x8
};

/* Body lengths of the requests that a board receives. */
enum { HELLO_LENGTH = 2, CONFIGURE_LENGTH = 32, COMMAND_LENGTH = 9, STOP_LENGTH = 0, TACTILE_REQUEST_LENGTH = 1 };

/* A Hello to address 0 is for the finger with the lowest address on the board. */
enum { ANY_ADDRESS = 0, HIGHEST_ADDRESS = 15 };

/* Reasons of a Refused. */
enum {
    REASON_VERSION = 1,
    REASON_VALUE = 2,
    REASON_NOT_CONFIGURED = 3,
    REASON_RUNNING = 4,
    REASON_FAULT = 5,
    REASON_UNKNOWN_FRAME = 6
};

/* Offsets of the fields of a Configure, counted from the header. FIELD_TORQUE_LIMITS is the offset of the limit of
   motor 1; each further motor adds 2. The detail of a Refused with REASON_VALUE is the offset of a field. */
enum { FIELD_VERSION = 2, FIELD_WATCHDOG = 3, FIELD_END_STATE = 5, FIELD_TORQUE_LIMITS = 10 };

/* Flags of a Command. */
enum { FLAG_TOGGLE = 1 << 0, FLAG_ENABLE = 1 << 1 };

/* Changes of a tactile element. */
enum {
    CHANGE_NOTHING = 0,
    CHANGE_MADE = 1,
    CHANGE_LOST = 2,
    CHANGE_SLIP = 3,
    CHANGE_PRESSURE = 4,
    CHANGE_INVALID = 5
};

/* Bits of the status. */
enum {
    STATUS_CONFIGURED = 1 << 0,
    STATUS_ENABLED = 1 << 1,
    STATUS_WATCHDOG_TRIPPED = 1 << 2,
    STATUS_ENDED = 1 << 3,
    STATUS_HOLDING = 1 << 4,
    STATUS_ZERO_VALID = 1 << 5,
    STATUS_EMERGENCY_STOP = 1 << 6,
    STATUS_SUPPLY_FAULT = 1 << 7,
    STATUS_DRIVER_FAULT = 1 << 8,
    STATUS_SENSOR_FAULT = 1 << 9,
    STATUS_TORQUE_CLIPPED = 1 << 10,
    STATUS_DAMAGED_INPUT = 1 << 11,
    STATUS_FAULTS = STATUS_EMERGENCY_STOP | STATUS_SUPPLY_FAULT | STATUS_DRIVER_FAULT | STATUS_SENSOR_FAULT
};

/* Capabilities of an Identity. */
enum {
    CAPABILITY_HOLD = 1 << 0,
    CAPABILITY_KEEPS_ZERO = 1 << 1,
    CAPABILITY_EMERGENCY_STOP = 1 << 2,
    CAPABILITY_TOGGLE_PIN = 1 << 3,
    CAPABILITY_TACTILE = 1 << 4
};

enum { KIND_REFERENCE_FIRMWARE = 2 };

#endif
