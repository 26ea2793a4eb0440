/* The parts of the board: pins, drivers, encoders, gauges, inputs and the independent watchdog. */

#ifndef FIRMWARE_PARTS_H
#define FIRMWARE_PARTS_H

#include "../hal.h"

/* Gives every pin its function. Before the pins become outputs, their levels are set: CS of the converter high, all
   others low. */
void pins_start(void);

/* Starts the PWM with all outputs off. */
void drivers_start(void);

/* Removes the torque. A fault handler may call it at any time. */
void drivers_off(void);

/* Sets the currents, uA; all zeros turn the drivers off. */
void drivers_set(const int32_t microamperes[MOTORS]);

/* Returns whether an emergency stop, even a very short one, has turned the PWM off in hardware since the last call. */
bool drivers_were_stopped(void);

void encoders_start(void);

/* Reads the counters now. */
void encoders_latch(void);

/* Reads the counts at the last latch. Two counters have only 16 bits, so call encoders_latch and this function before
   an encoder has delivered 32 768 edges. An encoder with 3 million edges per second delivers them in 10.9 ms. */
void encoders_read(int32_t counts[MOTORS]);

void gauges_start(void);

/* Starts a conversion of all four gauges, which samples them at this instant. */
void gauges_convert(void);

/* Checks whether the converter has begun. Call it 0.1 to 1.5 us after gauges_convert. */
void gauges_confirm(void);

/* Waits for the end of the conversion and reads the result. This takes 6 to 11 us in all. */
void gauges_read(uint16_t counts[MOTORS]);

/* Whether each of the last three conversions failed: the converter did not answer, or a gauge was at an end of its
   range. */
bool gauges_failed(void);

/* `crystal_runs` is false if the clock is not accurate. The board then reports a sensor fault. */
void faults_start(bool crystal_runs);

/* Samples the sensors if no host has done so for a while. This keeps the extended encoder counts and the faults up to
   date. */
void sensors_poll(void);

/* Starts the watchdog that resets the processor. It cannot be stopped. */
void watchdog_start(void);
void watchdog_feed(void);

#endif
