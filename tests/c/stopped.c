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

static int fault_of(int i)
{
    struct Fault Fault;
    Fault.Size = sizeof Fault;
    CHECK(GetFault(i, &Fault) == 0);
    return Fault.Number;
}

static void stop_one_finger(void)
{
    double Pos[3];
    int wait;

    CHECK(StopFinger(0) == -1 && errno == EINVAL);
    CHECK(StopFinger(2) == 0);
    for (wait = 0; fault_of(2) != FAULT_STOP_CALL; wait++) {
        CHECK(wait < 1000);
        PAUSE_MS(2);
    }
    CHECK(GetPosD(2, Pos) == -1 && errno == EIO);
    CHECK(fault_of(1) == 0 && GetPosD(1, Pos) == 0);
    CHECK(fault_of(3) == 0 && GetPosD(3, Pos) == 0);
    CHECK(RecoverHand(2) == 0);
    CHECK(GetPosD(2, Pos) == 0);
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
        for (wait = 0; fault_of(i) != FAULT_EMERGENCY_STOP_CALL; wait++) {
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
    stop_one_finger();
    return CloseHand();
}
