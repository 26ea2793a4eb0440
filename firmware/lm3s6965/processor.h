/* The used parts of the LM3S6965: clock, SysTick, a timer, UART 0, and the pins of port F. */

#ifndef FIRMWARE_PROCESSOR_H
#define FIRMWARE_PROCESSOR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Starts the clock at 50 MHz, a wake-up every half millisecond, and the UART at 1 000 000 baud. */
void processor_start(void);

/* us since power-up. */
uint32_t timer_microseconds(void);

/* Takes one received byte and its arrival, us. Returns false if there is none. */
bool uart_take(uint8_t *byte, uint32_t *arrived_at);

/* Queues all bytes, or none if they do not fit. */
void uart_send(const uint8_t *bytes, size_t length);

/* Sets pin 0 to 7 of port F. */
void pin_set(unsigned pin, bool high);

/* Sleeps until the next interrupt, at the latest the next wake-up. Returns at once if a received byte waits. */
void sleep(void);

/* Handlers for the vector table. */
void systick_interrupt(void);
void wake_up_interrupt(void);
void uart_interrupt(void);

#endif
