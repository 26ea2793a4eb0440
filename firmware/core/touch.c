#include "touch.h"
#include "protocol.h"
#include <string.h>

/* A full queue drops the newest event, so that the numbers that the host receives have no gaps. */
static void note(struct touch *touch, uint16_t element, uint8_t change, uint16_t count, uint32_t now)
{
    if (touch->count == TOUCH_QUEUE) {
        touch->dropped++;
        return;
    }
    touch->number = touch->number == 255 ? 1 : (uint8_t)(touch->number + 1);
    struct tactile_event *event = &touch->queue[(touch->first + touch->count) % TOUCH_QUEUE];
    memset(event, 0, sizeof *event);
    event->number = touch->number;
    event->change = change;
    event->element = element;
    event->count = count;
    event->noticed_at = now;
    touch->count++;
}

static void scan(struct touch *touch, const struct touch_traits *traits, uint16_t index, bool readable, uint16_t count,
                 uint32_t now)
{
    struct touch_element *element = &touch->elements[index];
    if (!readable) {
        if (!element->unreadable)
            note(touch, index, CHANGE_INVALID, 0, now);
        element->unreadable = true;
        element->pressed = false;
        return;
    }
    element->unreadable = false;
    if (!element->known) {
        element->known = true;
        element->rest = element->reported = count;
        return;
    }
    int32_t above = (int32_t)count - element->rest;
    int32_t moved = (int32_t)count - element->reported;
    uint8_t change = CHANGE_NOTHING;
    if (!element->pressed && above > traits->made)
        change = CHANGE_MADE;
    else if (element->pressed && above < traits->lost)
        change = CHANGE_LOST;
    else if (element->pressed && (moved >= traits->step || -moved >= traits->step))
        change = CHANGE_PRESSURE;
    if (change == CHANGE_NOTHING)
        return;
    element->pressed = change != CHANGE_LOST;
    element->reported = count;
    note(touch, index, change, count, now);
}

void touch_scan(struct touch *touch, const struct touch_traits *traits, unsigned finger, uint32_t now)
{
    for (uint16_t index = 0; index < traits->elements && index < TOUCH_ELEMENTS_MOST; index++) {
        uint16_t count = 0;
        bool readable = hal_touch(finger, index, &count);
        scan(touch, traits, index, readable, count, now);
    }
}

struct tactile_event touch_fetch(struct touch *touch, uint8_t received)
{
    size_t delivered = 0;
    for (size_t i = 0; i < touch->count; i++)
        if (touch->queue[(touch->first + i) % TOUCH_QUEUE].number == received)
            delivered = i + 1;
    touch->first = (touch->first + delivered) % TOUCH_QUEUE;
    touch->count -= delivered;
    struct tactile_event event = {0};
    if (touch->count > 0)
        event = touch->queue[touch->first];
    event.waiting = (uint8_t)touch->count;
    event.lost = touch->dropped;
    return event;
}
