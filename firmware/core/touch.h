/* The tactile elements of a finger: their contacts, and the queue of their events. */

#ifndef FIRMWARE_TOUCH_H
#define FIRMWARE_TOUCH_H

#include "messages.h"

enum { TOUCH_ELEMENTS_MOST = 16, TOUCH_QUEUE = 16 };

/* The properties of the elements. They are fixed when the board is built. The thresholds `made`, `lost` and `step` are
   in counts of the converter. The excess of an element is its count minus its count at its first reading. */
struct touch_traits {
    uint16_t elements; /* 0 to TOUCH_ELEMENTS_MOST. */
    uint16_t made;     /* An element becomes pressed when its excess is above this value. */
    uint16_t lost;     /* A pressed element is released when its excess is below this value. Less than `made`. */
    uint16_t step;     /* A pressed element causes a pressure event when its count has changed by at least this value
                          since its last event. */
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

/* Reads the elements of a finger with hal_touch, to which it passes `finger`, and queues what has changed. */
void touch_scan(struct touch *touch, const struct touch_traits *traits, unsigned finger, uint32_t now);

/* Deletes the event `received` and all events before it, and returns the oldest event that is left. */
struct tactile_event touch_fetch(struct touch *touch, uint8_t received);

#endif
