/* The board: its states and its answers. */

#ifndef BOARD_H
#define BOARD_H

#include "frame.h"
#include "plant.h"

enum { VERSION = 1, KIND = 0x8000, TORQUE_UNIT = 2000, TORQUE_LIMIT = 23750, WATCHDOG_SHORTEST = 2 };
enum { CAN_HOLD = 1 << 0, COUNTS_SURVIVE = 1 << 1 };

enum {
    IS_CONFIGURED = 1 << 0,
    IS_ENABLED = 1 << 1,
    WATCHDOG_TRIPPED = 1 << 2,
    HAS_ENDED = 1 << 3,
    IS_HOLDING = 1 << 4,
    ZERO_VALID = 1 << 5,
    TORQUE_CLIPPED = 1 << 10,
    DAMAGED_INPUT = 1 << 11
};

enum state { IDLE, READY, ENABLED, ENDED };

struct board {
    int line;
    unsigned address;
    enum state state;
    int tripped, holding, damaged;
    int64_t last_command, hold_until;
    /* How much longer the finger may move before the next Command, ns. */
    int64_t motion_left;

    uint8_t configure[32];
    int64_t watchdog, hold_time;
    int hold;
    int32_t hold_limit, limit[MOTORS], torque[MOTORS];

    /* Bytes since the last zero. If there are more than STUFFED_MAXIMUM, the frame is too long and is discarded. */
    unsigned collected;
    uint8_t stuffed[STUFFED_MAXIMUM + 1];

    struct plant plant;
};

/* The longest time for which the finger may move in one wake-up of the board, and between two Commands, ns. */
enum { MOTION_MOST = 2000000 };

/* Handles one byte from the line. */
void receive(struct board *board, uint8_t byte, int64_t now);

/* Trips the watchdog when no Command has arrived in time, and ends a hold when the time of the hold is over. */
void watch_time(struct board *board, int64_t now);

#endif
