/* Replaces motors and sensors by a plant on the machine that emulates the processor. The plant receives the motor
   currents and returns the sensor counts. A real board has PWM, counters and a converter here instead.

   The firmware reaches the plant by semihosting, through two files that the plant has created. A whole request or
   answer costs one trap. A UART of the emulator transfers single bytes and took 1 ms for the same exchange.

   Request, in plant_to: u8 finger, from 0; u8 1 for a sample that a host requested, else 0; u16 0; u32 time of the
   firmware's timer, us; u32 arrival of the last frame, us; u32 when the currents were last set, us; 4 x i32 present
   currents, uA. The plant applies these currents to the whole time since the last request.

   Answer, in plant_from: 4 x i32 encoder counts; 4 x u16 gauge counts; u16 faults; 2 x u16 counts of the tactile
   elements, 0xFFFF for one that cannot be read; u16 0. */

#ifndef FIRMWARE_PLANT_H
#define FIRMWARE_PLANT_H

#include "../hal.h"

/* Set by the Makefile: number of fingers, and address of the first one. */
#ifndef FINGERS
#define FINGERS 3
#endif
#ifndef FIRST_ADDRESS
#define FIRST_ADDRESS 1
#endif

enum { PLANT_FINGERS = FINGERS, PLANT_ELEMENTS = 2 };

/* Opens the two files of the plant. */
void plant_start(void);

/* Queries the plant for every finger that no host has sampled for a while. */
void plant_poll(void);

#endif
