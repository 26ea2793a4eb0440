/* Tests two rules that no test vector can express. The watchdog restarts at the time at which a Command arrives, and
   not at the time at which the main loop reads it. A fault that the hardware reports only once is not lost. */

#include "fake_hardware.h"
#include "../core/protocol.h"
#include <stdio.h>
#include <string.h>

static struct finger finger;
static struct board board;
static int failures;

static void expect(bool holds, const char *what)
{
    if (!holds) {
        fprintf(stderr, "%s\n", what);
        failures++;
    }
}

static void say(const struct frame *frame)
{
    uint8_t wire[WIRE_MOST];
    fake.output_length = 0;
    fake_arrive(&board, wire, frame_to_wire(frame, wire));
}

static void command(void)
{
    struct frame frame;
    frame_begin(&frame, TYPE_COMMAND, 1, 0);
    frame_put8(&frame, FLAG_ENABLE);
    for (size_t i = 0; i < MOTORS; i++)
        frame_put16(&frame, 100);
    say(&frame);
}

/* Configures the finger with a watchdog of 20 ms. */
static void configure(void)
{
    struct frame frame;
    frame_begin(&frame, TYPE_CONFIGURE, 1, 0);
    frame_put8(&frame, PROTOCOL_VERSION);
    frame_put16(&frame, 20);
    for (size_t i = 0; i < 5; i++)
        frame_put8(&frame, 0);
    for (size_t i = 0; i < MOTORS; i++)
        frame_put16(&frame, 1000);
    for (size_t i = 0; i < MOTORS; i++)
        frame_put32(&frame, 0);
    say(&frame);
}

/* Enables the finger at `now`. */
static void enable(uint32_t now)
{
    memset(&fake, 0, sizeof fake);
    fake.now = now;
    finger_start(&finger, &fake_traits[0], 0);
    board_start(&board, 0, &finger, 1);
    configure();
    command();
    expect(finger.state == FINGER_ENABLED, "a Command did not enable the finger");
}

/* The emergency stop is so short that only one check sees it: not the check at the arrival of a Configure, but the
   check while the board handles this Configure. */
static void stop_during_a_configure(void)
{
    enable(0);
    fake.short_faults = STATUS_EMERGENCY_STOP;
    fake.calls_without_short = 1;
    configure();
    expect(fake.short_faults == 0, "the emergency stop was not reported");
    expect(finger.state == FINGER_ENDED && fake.currents[0][0] == 0, "an emergency stop has not taken the torque off");
    command();
    expect(finger.state == FINGER_ENDED && fake.currents[0][0] == 0, "a Command was obeyed after an emergency stop");
    expect(finger.latched == STATUS_EMERGENCY_STOP, "a short emergency stop was lost");
}

int main(void)
{
    /* Includes instants just before the timer wraps, and just before its highest bit is set. */
    static const uint32_t beginnings[] = {0, 0xFFFFFFFFu - 10000, 0x7FFFFFFFu - 10000};
    for (size_t i = 0; i < 3; i++) {
        enable(beginnings[i]);
        fake.now += 30000;
        fake.delay = 15000;
        command();
        expect(finger.state == FINGER_ENABLED, "a Command that came in time was not obeyed");
        fake.now += 6000;
        board_poll(&board);
        expect(finger.state == FINGER_ENDED, "the watchdog counts from the reading of the Command");

        enable(beginnings[i]);
        fake.now += 25000;
        command();
        expect(finger.state == FINGER_ENDED && fake.currents[0][0] == 0, "a Command that came too late was obeyed");

        /* The Command arrives in time, just after the board has found no input. */
        enable(beginnings[i]);
        fake.now += 19990;
        fake.gap = 20;
        board_poll(&board);
        fake.gap = 0;
        fake.delay = 15;
        command();
        expect(finger.state == FINGER_ENABLED, "the watchdog overtook a Command that came in time");

        /* An interrupt may read the timer slightly later than the main loop did. */
        enable(beginnings[i]);
        fake.delay = 0u - 50u;
        command();
        expect(finger.state == FINGER_ENABLED, "a Command from the near future tripped the watchdog");
    }
    stop_during_a_configure();
    printf("lateness: %d failures\n", failures);
    return failures != 0;
}
