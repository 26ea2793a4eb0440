/* A board: one line, and the fingers that are reached over it. */

#ifndef FIRMWARE_BOARD_H
#define FIRMWARE_BOARD_H

#include "finger.h"
#include "receiver.h"

struct board {
    unsigned line;
    struct receiver receiver;
    struct finger *fingers; /* In the order of their addresses. */
    size_t count;
};

/* Takes fingers that finger_start has started. */
void board_start(struct board *board, unsigned line, struct finger *fingers, size_t count);

/* Answers what has arrived, then looks after watchdogs and faults. Call it whenever bytes have arrived, and every millisecond
   at least; it never waits. */
void board_poll(struct board *board);

#endif
