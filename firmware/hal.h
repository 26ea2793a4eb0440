/* The hardware layer: all that the protocol core asks of a processor and its board. A port writes these functions; the core
   calls nothing else, waits for nothing and needs neither heap nor operating system.

   A line is a UART, and a finger one of the board's, both counted from 0 as the port's main function sets them up. Everything
   here is called from the main loop, never from an interrupt. */

#ifndef FIRMWARE_HAL_H
#define FIRMWARE_HAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define MOTORS 4

/* What all eight sensors of a finger said at one instant. */
struct sensors {
    int32_t encoders[MOTORS]; /* Whole counts after quadrature; they wrap. */
    uint16_t gauges[MOTORS];  /* Raw counts of the converters; one that cannot be read keeps its last. */
};

/* Timer: us since power-up. It wraps after 71 minutes, and must count through all 32 bits before it does. */
uint32_t hal_microseconds(void);

/* UART in: takes bytes that have arrived, `room` at most, and says how many. They must not go beyond the first zero byte, and
   `arrived_at` is when the last of them arrived: the interrupt or the DMA notes it, so that a Command that came in time counts
   however late the main loop gets to it. 0 bytes: there is nothing. */
size_t hal_receive(unsigned line, uint8_t *bytes, size_t room, uint32_t *arrived_at);

/* UART out: queues a whole frame and returns at once. Without room for all of it, none of it is sent. The queue must hold
   the answers to 15 Commands, 420 bytes. */
void hal_send(unsigned line, const uint8_t *bytes, size_t length);

/* Encoder counters and ADC: samples all eight together. */
void hal_sample(unsigned finger, struct sensors *sensors);

/* PWM: the currents that the motor drivers keep from now on, uA. Positive is the direction that the board calls positive.
   All zeros must take the torque off whatever state the drivers are in. */
void hal_set_currents(unsigned finger, const int32_t microamperes[MOTORS]);

/* Inputs: which of STATUS_FAULTS (core/protocol.h) are there now. */
uint16_t hal_faults(unsigned finger);

/* The pin with the toggle bit; does nothing on a board without. */
void hal_set_toggle(unsigned finger, bool high);

#endif
