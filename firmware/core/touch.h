/* The tactile elements of a finger: their contacts, and the queue of their events. */

#ifndef FIRMWARE_TOUCH_H
#define FIRMWARE_TOUCH_H

#include "messages.h"

enum { TOUCH_ELEMENTS_MOST = 16, TOUCH_QUEUE = 16 };

/* The properties of the elements that are fixed when the board is built, in counts of their converter. */
struct touch_traits {
    uint16_t elements; /* 0 to TOUCH_ELEMENTS_MOST. */
    uint16_t made;     /* An element is pressed when its count exceeds its count at power-up by more than this. */
    uint16_t lost;     /* It is released when its count exceeds that count by less than this. Below `made`. */
    uint16_t step;     /* A change by this much since the last event causes a pressure event. */
};

struct touch_element {
    uint16_t rest;     /* Count at the first reading. */
    uint16_t reported; /* Count of the last event. */
    bool known, pressed, unreadable;
};

struct touch {
    struct touch_element elements[TOUCH_ELEMENTS_MOST];
    struct tactile_event queue[TOUCH_QUEUE];
    size_t first, count;
    uint8_t number; /* Number of the last event; 0 before the first. */
    uint8_t dropped;
};

/* Reads the elements of the finger with this number in the hardware layer, and queues what has changed. */
void touch_scan(struct touch *touch, const struct touch_traits *traits, unsigned finger, uint32_t now);

/* Deletes the event `received` and all events before it, and returns the oldest event that is left. */
struct tactile_event touch_fetch(struct touch *touch, uint8_t received);

#endif
