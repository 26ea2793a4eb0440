/* A hardware layer made of memory, for tests: time passes when it is told to, what is put in arrives, what is sent is kept. */

#ifndef FIRMWARE_FAKE_HARDWARE_H
#define FIRMWARE_FAKE_HARDWARE_H

#include "../core/board.h"

enum { FAKE_FINGERS = 2 };

struct fake_hardware {
    uint32_t now;   /* us. */
    uint32_t delay; /* How long bytes have been there before the board looks, us. */
    const uint8_t *input;
    size_t input_length;
    uint8_t output[4096];
    size_t output_length;
    uint16_t faults;
    int32_t currents[FAKE_FINGERS][MOTORS];
    struct sensors sensors;
};

extern struct fake_hardware fake;

/* Fingers 1 and 2 of a board that can do all that the core can. */
extern const struct finger_traits fake_traits[FAKE_FINGERS];

/* The torque that a finger's motor truly gives, torque units: from the current on it, by the torque constant in uN m/A. */
int32_t fake_torque(unsigned finger, size_t motor, uint32_t torque_constant);

/* These bytes arrive now; polls the board until all are taken. */
void fake_arrive(struct board *board, const uint8_t *bytes, size_t length);

/* Time passes in steps of half a millisecond, as a timer would wake the main loop. */
void fake_wait(struct board *board, uint32_t microseconds);

#endif
