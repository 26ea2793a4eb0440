/* A planner that stops the hand from a signal handler and continues. */
#include <errno.h>
#include <signal.h>
#include "Sun2Xp.h"
#include "check.h"

static void on_signal(int number)
{
    (void)number;
    StopHand();
}

static int faulted_by_stop(int i)
{
    struct Fault Fault;
    Fault.Size = sizeof Fault;
    CHECK(GetFault(i, &Fault) == 0);
    return Fault.Number == FAULT_EMERGENCY_STOP_CALL;
}

int main(void)
{
    double Pos[3];
    int i, wait;

    CHECK(RecoverHand(1) == -1 && errno == ENODEV);
    CHECK(StopHand() == 0);
    CHECK(OpenHand() == 0);
    CHECK(GetPosD(1, Pos) == 0);
    CHECK(signal(SIGUSR1, on_signal) != SIG_ERR);
    errno = 0;
    CHECK(raise(SIGUSR1) == 0 && errno == 0);
    for (i = 1; i <= 3; i++) {
        for (wait = 0; !faulted_by_stop(i); wait++) {
            CHECK(wait < 1000);
            PAUSE_MS(2);
        }
        CHECK(GetPosD(i, Pos) == -1 && errno == EIO);
        CHECK(SendPosD(i, Pos) == -1 && errno == EIO);
    }
    CHECK(RecoverHand(0) == -1 && errno == EINVAL);
    for (i = 1; i <= 3; i++) {
        CHECK(RecoverHand(i) == 0);
        CHECK(GetPosD(i, Pos) == 0 && SendPosD(i, Pos) == 0);
    }
    CHECK(RecoverHand(1) == 0);
    return CloseHand();
}
