/* Tests the tactile elements: contact and loss, pressure, elements that cannot be read, and the queue of events. */

#include "fake_hardware.h"
#include "../core/protocol.h"
#include <stdio.h>

static struct finger finger;
static unsigned failures;

static void expect(bool holds, const char *what)
{
    if (!holds) {
        printf("touch: this was expected: %s\n", what);
        failures++;
    }
}

/* Fetches the next event, and checks that it has these values and the present time. */
static void expect_event(uint8_t *received, uint8_t change, uint16_t element, uint16_t count, const char *what)
{
    struct tactile_event event = touch_fetch(&finger.touch, *received);
    expect(event.waiting > 0 && event.change == change && event.element == element && event.count == count, what);
    expect(event.noticed_at == fake.now, "an event with the present time");
    *received = event.number;
}

static void press(uint16_t element, uint16_t count)
{
    fake.touch[element] = count;
    finger_tick(&finger, fake.now);
}

int main(void)
{
    uint8_t received = 0;
    fake.now = 4000000000u;
    fake.touch[0] = 300;
    fake.touch[1] = 500;
    finger_start(&finger, &fake_traits[1], 1);
    finger_tick(&finger, fake.now);
    expect(touch_fetch(&finger.touch, received).waiting == 0, "no event at rest");
    press(0, 350);
    expect(touch_fetch(&finger.touch, received).waiting == 0, "no event at the threshold");
    press(0, 351);
    expect_event(&received, CHANGE_MADE, 0, 351, "an event of contact");
    press(0, 450);
    expect(touch_fetch(&finger.touch, received).waiting == 0, "no event for a change below a step");
    press(0, 451);
    expect_event(&received, CHANGE_PRESSURE, 0, 451, "an event of pressure");
    press(0, 324);
    expect_event(&received, CHANGE_LOST, 0, 324, "an event of lost contact");
    fake.touch_broken[1] = true;
    finger_tick(&finger, fake.now);
    finger_tick(&finger, fake.now);
    expect_event(&received, CHANGE_INVALID, 1, 0, "an event of an element that cannot be read");
    expect(touch_fetch(&finger.touch, received).waiting == 0, "only one event of an element that cannot be read");
    for (int i = 0; i < TOUCH_QUEUE / 2 + 2; i++) {
        press(0, 400);
        press(0, 300);
    }
    struct tactile_event oldest = touch_fetch(&finger.touch, received);
    expect(oldest.waiting == TOUCH_QUEUE && oldest.lost == 4, "a full queue, and a count of the lost events");
    for (int i = 0; i < TOUCH_QUEUE; i++) {
        struct tactile_event event = touch_fetch(&finger.touch, received);
        expect(event.number == (uint8_t)(received + 1) && event.waiting == TOUCH_QUEUE - i, "the events in order");
        received = event.number;
    }
    expect(touch_fetch(&finger.touch, received).waiting == 0, "an empty queue");
    printf("touch: %u failures\n", failures);
    return failures > 0;
}
