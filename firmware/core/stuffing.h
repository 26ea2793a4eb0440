/* Consistent overhead byte stuffing (COBS): bytes without zeros, so that a zero can end a frame. */

#ifndef FIRMWARE_STUFFING_H
#define FIRMWARE_STUFFING_H

#include <stddef.h>
#include <stdint.h>

/* Longest input for which one byte more is enough. */
enum { STUFF_MOST = 254 };

/* Stuffs `length` bytes, STUFF_MOST at most, into length + 1 bytes. */
void stuff(const uint8_t *bytes, size_t length, uint8_t *stuffed);

/* The inverse; returns the length, or 0 where this is no stuffing or does not fit into `room` bytes. */
size_t unstuff(const uint8_t *stuffed, size_t length, uint8_t *bytes, size_t room);

#endif
