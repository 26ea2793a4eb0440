/* The records of a recovering finger have the state "tensioning", and not "calibrating". When the library has closed
   the hand in its exit handler, the fingers report the state "closed". */
#include <unistd.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"

static int state_of(int finger)
{
    struct sun2xp_status Status;

    Status.size = sizeof Status;
    CHECK(sun2xp_status(HAND, finger, &Status) == 0);
    return Status.state;
}

/* This exit handler is registered before that of the library, so it runs after that of the library. The program ends
   with the status that this handler passes to _exit. */
static void look_at_the_closed_hand(void)
{
    int finger;

    for (finger = 1; finger <= 3; finger++)
        if (state_of(finger) != SUN2XP_STATE_CLOSED) {
            fprintf(stderr, "finger %d reports state %d after exit has closed the hand\n", finger, state_of(finger));
            _exit(1);
        }
    _exit(0);
}

int main(void)
{
    struct sun2xp_record Record;
    unsigned long Cycle;
    int wait, tensioning = 0;

    CHECK(atexit(look_at_the_closed_hand) == 0);
    CHECK(OpenHand() == 0);
    CHECK(state_of(1) == SUN2XP_STATE_RUNNING);
    CHECK(sun2xp_stop_all() == 0);
    for (wait = 0; state_of(1) != SUN2XP_STATE_FAULTED; wait++) {
        CHECK(wait < 1000);
        PAUSE_MS(2);
    }
    CHECK(sun2xp_recover(HAND, 1) == 0 && sun2xp_recover(HAND, 2) == 0 && sun2xp_recover(HAND, 3) == 0);
    CHECK(state_of(1) == SUN2XP_STATE_RUNNING);
    Record.size = sizeof Record;
    CHECK(sun2xp_record(HAND, 1, 0, &Record) == 0);
    for (Cycle = Record.oldest; sun2xp_record(HAND, 1, Cycle, &Record) == 0; Cycle++) {
        CHECK(Record.state == SUN2XP_STATE_TENSIONING || Record.state == SUN2XP_STATE_RUNNING ||
            Record.state == SUN2XP_STATE_FAULTED);
        if (Record.state == SUN2XP_STATE_TENSIONING)
            tensioning++;
    }
    printf("%d cycles in the state tensioning, up to cycle %lu\n", tensioning, Cycle);
    CHECK(tensioning > 0);
    return 3;
}
