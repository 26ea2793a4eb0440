/* One finger of the board: the state diagram of docs/board-protocol.md with watchdog, limits and latched faults. */

#ifndef FIRMWARE_FINGER_H
#define FIRMWARE_FINGER_H

#include "messages.h"
#include "touch.h"

/* The properties of a finger that are fixed when the board is built. */
struct finger_traits {
    uint8_t address; /* 1 to 15. */
    uint8_t unique_number[12];
    uint8_t firmware_version[3];
    uint32_t counts_per_revolution;
    uint8_t gauge_bits;
    uint32_t torque_unit; /* nN m. */
    uint16_t torque_limit;
    uint16_t shortest_watchdog_ms;
    uint32_t capabilities;
    uint32_t torque_constants[MOTORS]; /* uN m/A, never 0. A Configure with 0 selects this value. */
    int32_t largest_currents[MOTORS];  /* Currents that driver and motor can carry continuously, uA. */
    struct touch_traits touch;         /* Used with CAPABILITY_TACTILE. */
};

enum finger_state { FINGER_IDLE, FINGER_READY, FINGER_ENABLED, FINGER_ENDED };

struct finger {
    const struct finger_traits *traits;
    unsigned index; /* The finger's number in the hardware layer. */
    enum finger_state state;
    struct configure terms;
    int16_t torques[MOTORS]; /* Present motor torques, torque units. */
    bool holding;
    bool damaged;          /* A damaged frame has arrived since the last Reply. */
    uint16_t latched;      /* Status bits that stay set until the next Configure. */
    uint32_t commanded_at; /* Arrival of the last Command that restarted the watchdog, us. */
    uint32_t held_since;   /* Start of the hold, us. */
    struct touch touch;
};

/* Puts the finger into the state after power-up: idle, with the motors off. */
void finger_start(struct finger *finger, const struct finger_traits *traits, unsigned index);

/* Checks faults, watchdog and hold time at the time `now`, us. Call it at least every millisecond. Also call it before
   each request, with the time at which the request arrived. */
void finger_tick(struct finger *finger, uint32_t now);

/* These functions carry out requests. Each one writes its answer, or a Refused, to `answer`. `now` is the time at which
   the request arrived, us. */
void finger_hello(struct finger *finger, const struct frame *request, uint16_t addresses, struct frame *answer);
void finger_configure(struct finger *finger, const struct frame *request, struct frame *answer);
void finger_command(struct finger *finger, const struct frame *request, uint32_t now, struct frame *answer);
void finger_touch(struct finger *finger, const struct frame *request, struct frame *answer);
void finger_stop(struct finger *finger, const struct frame *request, uint32_t now, struct frame *answer);

/* Turns `answer` into a Refused. */
void finger_refuse(const struct finger *finger, const struct frame *request, uint8_t reason, uint16_t detail,
                   struct frame *answer);

#endif
