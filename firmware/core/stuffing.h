/* Consistent overhead byte stuffing (COBS): it removes all zeros, so that a zero can delimit frames. receiver.c undoes
   it. */

#ifndef FIRMWARE_STUFFING_H
#define FIRMWARE_STUFFING_H

#include <stdint.h>

/* Longest input that stuffing lengthens by only one byte. */
enum { STUFF_MOST = 254 };

/* Stuffs at most STUFF_MOST bytes, one at a time. */
struct stuffing {
    uint8_t *distance_at; /* Receives the distance to the next zero. */
    uint8_t *next;
};

/* Begins at `stuffed`, which needs room for all bytes and one more. */
void stuff_begin(struct stuffing *stuffing, uint8_t *stuffed);
void stuff(struct stuffing *stuffing, uint8_t byte);

/* Completes the stuffed bytes, which end before `stuffing->next`. */
void stuff_end(struct stuffing *stuffing);

#endif
