/* The serial line: USART1, served by interrupts. */

#ifndef FIRMWARE_SERIAL_H
#define FIRMWARE_SERIAL_H

#include "registers.h"
#include <stdbool.h>

/* Starts the line at BAUD. `megahertz` is the clock of the bus APB2. */
void serial_start(uint32_t megahertz);

/* Control register 1 while nothing is sent. */
enum { SERIAL_RUN = USART_CR1_UE | USART_CR1_TE | USART_CR1_RE | USART_CR1_RXNEIE };

/* Whether the transmit interrupt is enabled. */
extern bool serial_transmits;

/* Handler for interrupt INTERRUPT_USART1. */
void serial_interrupt(void);

#endif
