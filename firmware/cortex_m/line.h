/* The serial line: rings between the interrupt of the UART and the main loop, and the functions of hal.h that use them.
   Each processor has a file that moves bytes between its UART and these rings. */

#ifndef FIRMWARE_LINE_H
#define FIRMWARE_LINE_H

#include <stdbool.h>
#include <stdint.h>

/* For the interrupt of the UART: stores a received byte, and for a zero byte the present time as its arrival. A byte
   that does not fit is lost, as on any UART. The checksum reveals the damage. */
void line_received(uint8_t byte);

/* For uart_transmit: takes the next byte to send. Returns false if there is none. */
bool line_next(uint8_t *byte);

/* Implemented by the processor's file: writes bytes to the UART while it has room, and enables the transmit interrupt
   if more bytes may wait. Called by the interrupt of the UART, and by hal_send with interrupts masked. */
void uart_transmit(void);

/* Implemented by each port: called when hal_receive has taken the last byte of a frame. The byte arrived at
   `arrived_at`, us. */
void line_frame_taken(uint32_t arrived_at);

/* Sleeps until the next interrupt. Returns at once if a received byte waits. */
void line_sleep(void);

#endif
