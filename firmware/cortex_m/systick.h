/* The clock of the board, from SysTick (ARMv7-M Architecture Reference Manual, B3.3). */

#ifndef FIRMWARE_SYSTICK_H
#define FIRMWARE_SYSTICK_H

#include <stdint.h>

/* Starts the clock on a processor that runs at `megahertz`. SysTick keeps its reset priority, the highest one. */
void systick_start(uint32_t megahertz);

/* Handler for vector 15. */
void systick_interrupt(void);

#endif
