/* The clock of the board: systick.c, or another timer where an emulator needs one. */

#ifndef FIRMWARE_TIME_H
#define FIRMWARE_TIME_H

#include <stdint.h>

/* Returns the time since power-up, us. The interrupt handler of the serial line calls this function too. */
uint32_t time_microseconds(void);

#endif
