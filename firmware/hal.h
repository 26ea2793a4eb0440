/* The hardware layer: everything that the protocol core requires of a processor and its board. A port implements
   these functions. The core calls nothing else, never blocks, and needs neither heap nor operating system.

   A line is a UART. Lines and fingers are numbered from 0 in the order in which the port's main function starts
   them. The core calls these functions from the main loop, never from an interrupt. */

#ifndef FIRMWARE_HAL_H
#define FIRMWARE_HAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define MOTORS 4

/* The eight sensors of a finger, sampled at one instant. */
struct sensors {
    int32_t encoders[MOTORS]; /* Counts after quadrature; they wrap. */
    uint16_t gauges[MOTORS];  /* Raw converter counts. A gauge that cannot be read keeps its last count. */
};

/* Timer: us since power-up. It must count through all 32 bits before it wraps, which takes 71 minutes. */
uint32_t hal_microseconds(void);

/* UART input: takes at most `room` bytes that have arrived and returns their number, or 0 if there are none. It
   stops after the first zero byte. If the last byte taken is zero, `arrived_at` must be set to the time at which this
   byte arrived. An interrupt or DMA must record that time, so that a Command that arrived in time counts no matter how
   late the main loop reads it. */
size_t hal_receive(unsigned line, uint8_t *bytes, size_t room, uint32_t *arrived_at);

/* UART output: queues a whole frame and returns at once. A frame that does not fit is dropped as a whole. The queue
   must hold the answers to 15 Commands, 420 bytes. */
void hal_send(unsigned line, const uint8_t *bytes, size_t length);

/* Encoder counters and ADC: samples all eight sensors together. */
void hal_sample(unsigned finger, struct sensors *sensors);

/* Tactile element: its newest count. Returns false if the element cannot be read. Called only for a finger with
   CAPABILITY_TACTILE, once a millisecond or more often, so it must not wait for a converter. */
bool hal_touch(unsigned finger, unsigned element, uint16_t *count);

/* PWM: sets the currents that the motor drivers hold from now on, uA. The board defines the positive direction. All
   zeros must remove the torque, whatever state the drivers are in. */
void hal_set_currents(unsigned finger, const int32_t microamperes[MOTORS]);

/* Inputs: the bits of STATUS_FAULTS (core/protocol.h) that are present now. A fault that has come and ended since the
   last call may be reported too, once. */
uint16_t hal_faults(unsigned finger);

/* Sets the pin that carries the toggle bit. Does nothing on a board without this pin. */
void hal_set_toggle(unsigned finger, bool high);

#endif
