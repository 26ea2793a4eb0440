/* One finger of the board: the state diagram of docs/board-protocol.md, its watchdog, limits and latched faults. */

#ifndef FIRMWARE_FINGER_H
#define FIRMWARE_FINGER_H

#include "messages.h"

/* What a finger is, fixed when the board is built. */
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
    uint32_t torque_constants[MOTORS]; /* For a Configure that says 0; uN m/A, not 0. */
    int32_t largest_currents[MOTORS];  /* That driver and motor bear for ever, uA. */
};

enum finger_state { FINGER_IDLE, FINGER_READY, FINGER_ENABLED, FINGER_ENDED };

struct finger {
    const struct finger_traits *traits;
    unsigned index; /* For the hardware layer. */
    enum finger_state state;
    struct configure terms;
    int16_t torques[MOTORS]; /* That the motors give now, torque units. */
    bool holding;
    bool damaged;          /* A damaged frame came in since the last Reply. */
    uint16_t latched;      /* Status bits that stay until a Configure. */
    uint32_t commanded_at; /* The last Command that restarted the watchdog, us. */
    uint32_t held_since;   /* us. */
};

/* As after power-up: motors off, idle. */
void finger_start(struct finger *finger, const struct finger_traits *traits, unsigned index);

/* Faults, watchdog and the end of a hold. Every millisecond at least, and before anything that arrived at `now`, us. */
void finger_tick(struct finger *finger, uint32_t now);

/* Requests that arrived at `now`, us; each appends the answer's body to `answer`, or begins a Refused there instead. */
void finger_hello(struct finger *finger, const struct frame *request, uint16_t addresses, struct frame *answer);
void finger_configure(struct finger *finger, const struct frame *request, struct frame *answer);
void finger_command(struct finger *finger, const struct frame *request, uint32_t now, struct frame *answer);
void finger_stop(struct finger *finger, const struct frame *request, uint32_t now, struct frame *answer);

/* Makes `answer` a Refused. */
void finger_refuse(const struct finger *finger, const struct frame *request, uint8_t reason, uint16_t detail,
                   struct frame *answer);

#endif
