/* Consistent overhead byte stuffing (COBS): it removes all zeros, so that a zero can delimit frames. */

#ifndef FIRMWARE_STUFFING_H
#define FIRMWARE_STUFFING_H

#include <stddef.h>
#include <stdint.h>

/* Longest input that stuffing lengthens by only one byte. */
enum { STUFF_MOST = 254 };

/* Stuffs `length` bytes, at most STUFF_MOST, into length + 1 bytes. */
void stuff(const uint8_t *bytes, size_t length, uint8_t *stuffed);

/* The inverse. Returns the length, or 0 if the input is not validly stuffed or does not fit into `room` bytes. */
size_t unstuff(const uint8_t *stuffed, size_t length, uint8_t *bytes, size_t room);

#endif
