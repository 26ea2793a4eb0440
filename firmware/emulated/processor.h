/* What an emulated board requires of its processor, besides the clock and the line in cortex_m/. */

#ifndef FIRMWARE_PROCESSOR_H
#define FIRMWARE_PROCESSOR_H

#include <stdbool.h>
#include <stdint.h>

/* The first eight bytes of the unique number of every finger. */
extern const uint8_t processor_name[8];

/* Starts the clock, the line, and an interrupt that ends line_sleep every half millisecond. */
void processor_start(void);

/* Sets one of three pins, 0 to 2. */
void pin_set(unsigned pin, bool high);

#endif
