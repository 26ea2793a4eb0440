/* The clock tree. */

#ifndef FIRMWARE_CLOCK_H
#define FIRMWARE_CLOCK_H

#include <stdint.h>

/* Starts the crystal and the PLL. Returns the frequency of the processor, MHz: 168, or 16 if the crystal or the PLL
   does not start. The bus APB2 runs at half of 168 MHz, or at the whole of 16 MHz. */
uint32_t clock_start(void);

#endif
