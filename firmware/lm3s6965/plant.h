/* What stands in for motors and sensors: a plant on the machine that emulates this processor. It takes the motors' currents and
   gives back what the sensors read. A real board has PWM, counters and a converter here instead.

   It is reached by semihosting, through two files that the plant has made: a whole request or answer costs one trap. A UART of
   the emulator carries byte by byte, and took 1 ms for the same.

   Request, in plant_to: u8 finger; u8 1 for a sample that a host asked for, else 0; u16 0; u32 this timer, us; u32 when the
   last frame had arrived, us; u32 when the currents were last set, us; 4 x i32 currents that have flowed since the last request, uA.
   Answer, in plant_from: 4 x i32 encoder counts; 4 x u16 gauge counts; u16 faults; u16 0. */

#ifndef FIRMWARE_PLANT_H
#define FIRMWARE_PLANT_H

#include "../hal.h"

enum { PLANT_FINGERS = 3 };

/* Waits for the plant. */
void plant_start(void);

/* The last byte of a frame came in then, us. */
void plant_note_frame(uint32_t arrived_at);

/* Asks for every finger that no host has asked for in a while. */
void plant_poll(void);

#endif
