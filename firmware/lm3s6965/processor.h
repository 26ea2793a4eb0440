/* What of the LM3S6965 is used: clock, SysTick, a timer, UART 0, and the pins of port F. */

#ifndef FIRMWARE_PROCESSOR_H
#define FIRMWARE_PROCESSOR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Clock at 50 MHz, a wake-up every half millisecond, the UART at 1 000 000 baud. */
void processor_start(void);

/* us since power-up. */
uint32_t timer_microseconds(void);

/* One byte that has arrived and when, us. False: none. */
bool uart_take(uint8_t *byte, uint32_t *arrived_at);

/* Queues all of it, or nothing where there is no room. */
void uart_send(const uint8_t *bytes, size_t length);

/* Pin 0 to 7 of port F. */
void pin_set(unsigned pin, bool high);

/* Sleeps until an interrupt, the next wake-up at the latest, unless a byte waits already. */
void sleep(void);

/* For the table of vectors. */
void systick_interrupt(void);
void wake_up_interrupt(void);
void uart_interrupt(void);

#endif
