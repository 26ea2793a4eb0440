/* A finger that is recovering reports that state, not that it is calibrated. A hand that exit has closed reports
   that it is closed. */
#include <unistd.h>
#include "Sun2Xp.h"
#include "check.h"

static int state_of(int finger)
{
    struct FingerStatus Status;

    Status.Size = sizeof Status;
    CHECK(GetStatus(finger, &Status) == 0);
    return Status.State;
}

/* Registered before the library's own exit handler, so it runs after that. Its result becomes the program's. */
static void look_at_the_closed_hand(void)
{
    int finger;

    for (finger = 1; finger <= 3; finger++)
        if (state_of(finger) != FINGER_CLOSED) {
            fprintf(stderr, "finger %d reads %d when exit has closed the hand\n", finger, state_of(finger));
            _exit(1);
        }
    _exit(0);
}

int main(void)
{
    struct FingerRecord Record;
    unsigned long Cycle;
    int wait, tensioning = 0;

    CHECK(atexit(look_at_the_closed_hand) == 0);
    CHECK(OpenHand() == 0);
    CHECK(state_of(1) == FINGER_RUNNING);
    CHECK(StopHand() == 0);
    for (wait = 0; state_of(1) != FINGER_FAULTED; wait++) {
        CHECK(wait < 1000);
        PAUSE_MS(2);
    }
    CHECK(RecoverHand(1) == 0 && RecoverHand(2) == 0 && RecoverHand(3) == 0);
    CHECK(state_of(1) == FINGER_RUNNING);
    Record.Size = sizeof Record;
    CHECK(GetRecord(1, 0, &Record) == 0);
    for (Cycle = Record.Oldest; GetRecord(1, Cycle, &Record) == 0; Cycle++) {
        CHECK(Record.State == FINGER_TENSIONING || Record.State == FINGER_RUNNING || Record.State == FINGER_FAULTED);
        if (Record.State == FINGER_TENSIONING)
            tensioning++;
    }
    printf("%d cycles under tension, at cycle %lu\n", tensioning, Cycle);
    CHECK(tensioning > 0);
    return 3;
}
