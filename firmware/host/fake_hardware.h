/* A hardware layer in memory, for tests. The test advances the time, supplies the input and reads the output. */

#ifndef FIRMWARE_FAKE_HARDWARE_H
#define FIRMWARE_FAKE_HARDWARE_H

#include "../core/board.h"

enum { FAKE_FINGERS = 2 };

struct fake_hardware {
    uint32_t now;   /* us. */
    uint32_t delay; /* Time that the bytes have been waiting when the board reads them, us. */
    uint32_t gap;   /* Time that passes while the board finds that there is no input, us. */
    const uint8_t *input;
    size_t input_length;
    uint8_t output[4096];
    size_t output_length;
    uint16_t faults;
    uint16_t short_faults;        /* Faults that only one call of hal_faults reports. */
    unsigned calls_without_short; /* Number of calls of hal_faults before the one that reports the short faults. */
    int32_t currents[FAKE_FINGERS][MOTORS];
    struct sensors sensors;
    uint16_t touch[TOUCH_ELEMENTS_MOST];
    bool touch_broken[TOUCH_ELEMENTS_MOST];
};

extern struct fake_hardware fake;

/* Fingers 1 and 2 of a board with every capability that the core supports, except that only finger 2 has tactile
   elements. */
extern const struct finger_traits fake_traits[FAKE_FINGERS];

/* The torque that corresponds to the current of a motor, torque units. The torque constant is in uN m/A. */
int32_t fake_torque(unsigned finger, size_t motor, uint32_t torque_constant);

/* Delivers these bytes now, and polls the board until it has taken all of them. */
void fake_arrive(struct board *board, const uint8_t *bytes, size_t length);

/* Advances the time in steps of half a millisecond, like a timer that wakes the main loop. */
void fake_wait(struct board *board, uint32_t microseconds);

#endif
