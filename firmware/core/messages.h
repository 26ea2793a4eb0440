/* The frames of the protocol as structures: those that a board receives and those that it sends. Units are those of
   docs/board-protocol.md. */

#ifndef FIRMWARE_MESSAGES_H
#define FIRMWARE_MESSAGES_H

#include "frame.h"
#include "../hal.h"

struct hello {
    uint8_t lowest_version, highest_version;
};

struct configure {
    uint8_t version;
    uint16_t watchdog_ms;
    uint8_t end_state;
    uint16_t hold_time_ms;
    uint16_t hold_torque_limit;
    uint16_t torque_limits[MOTORS];
    uint32_t torque_constants[MOTORS]; /* uN m/A; 0 selects the board's own value. */
};

enum { END_STATE_RELEASE = 0, END_STATE_HOLD = 1 };

struct command {
    bool toggle, enable;
    int16_t torques[MOTORS];
};

struct identity {
    uint8_t version;
    uint16_t addresses;
    uint16_t kind;
    uint8_t unique_number[12];
    uint8_t firmware_version[3];
    uint32_t counts_per_revolution;
    uint8_t gauge_bits;
    uint32_t torque_unit; /* nN m. */
    uint16_t torque_limit;
    uint16_t shortest_watchdog_ms;
    uint32_t capabilities;
};

struct tactile_event {
    uint8_t waiting, number, change;
    uint16_t element, count;
    uint32_t noticed_at; /* us. */
    uint8_t lost;
};

/* Type and length of the frame must have been checked. */
void read_hello(const struct frame *frame, struct hello *hello);
void read_configure(const struct frame *frame, struct configure *configure);
void read_command(const struct frame *frame, struct command *command);

/* These functions append a body to a frame that frame_begin has started. */
void write_identity(struct frame *frame, const struct identity *identity);
void write_configured(struct frame *frame, const struct configure *terms, const struct sensors *sensors,
                      uint16_t status);
void write_reply(struct frame *frame, uint16_t status, const struct sensors *sensors, uint16_t sampled_at);
void write_tactile_event(struct frame *frame, const struct tactile_event *event);
void write_stopped(struct frame *frame, uint16_t status);
void write_refused(struct frame *frame, uint8_t type, uint8_t reason, uint16_t detail);

#endif
