/* A board: one line and the fingers that are reached over it. */

#ifndef FIRMWARE_BOARD_H
#define FIRMWARE_BOARD_H

#include "finger.h"
#include "receiver.h"

struct board {
    unsigned line;
    struct receiver receiver;
    struct finger *fingers; /* Sorted by address. */
    size_t count;
};

/* The fingers must have been started with finger_start. */
void board_start(struct board *board, unsigned line, struct finger *fingers, size_t count);

/* Answers the requests that have arrived, then checks watchdogs and faults. Call it whenever bytes have arrived, and
   at least every millisecond. It never blocks: after a flood of bytes it leaves some of them for the next call. */
void board_poll(struct board *board);

#endif
