/* A planner that stops the hand from a signal handler and continues. */
#include <errno.h>
#include <signal.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"

static void on_signal(int number)
{
    (void)number;
    sun2xp_stop_all();
}

static int fault_of(int i)
{
    struct sun2xp_fault Fault;
    Fault.size = sizeof Fault;
    CHECK(sun2xp_fault(HAND, i, &Fault) == 0);
    return Fault.number;
}

static void stop_one_finger(void)
{
    double Pos[3];
    int wait;

    CHECK(sun2xp_stop(HAND, 4) < 0 && errno == EINVAL);
    CHECK(sun2xp_stop(HAND, 2) == 0);
    for (wait = 0; fault_of(2) != SUN2XP_FAULT_STOP_CALL; wait++) {
        CHECK(wait < 1000);
        PAUSE_MS(2);
    }
    CHECK(GetPosD(2, Pos) == -1 && errno == EIO);
    CHECK(fault_of(1) == 0 && GetPosD(1, Pos) == 0);
    CHECK(fault_of(3) == 0 && GetPosD(3, Pos) == 0);
    CHECK(sun2xp_recover(HAND, 2) == 0);
    CHECK(GetPosD(2, Pos) == 0);
}

int main(void)
{
    double Pos[3];
    int i, wait;

    CHECK(sun2xp_recover(HAND, 1) < 0 && errno == ENODEV);
    CHECK(sun2xp_stop_all() == 0);
    CHECK(OpenHand() == 0);
    CHECK(GetPosD(1, Pos) == 0);
    CHECK(signal(SIGUSR1, on_signal) != SIG_ERR);
    errno = 0;
    CHECK(raise(SIGUSR1) == 0 && errno == 0);
    for (i = 1; i <= 3; i++) {
        for (wait = 0; fault_of(i) != SUN2XP_FAULT_EMERGENCY_STOP_CALL; wait++) {
            CHECK(wait < 1000);
            PAUSE_MS(2);
        }
        CHECK(GetPosD(i, Pos) == -1 && errno == EIO);
        CHECK(SendPosD(i, Pos) == -1 && errno == EIO);
    }
    CHECK(sun2xp_recover(HAND, 4) < 0 && errno == EINVAL);
    CHECK(sun2xp_recover(HAND, SUN2XP_ALL_FINGERS) == 0);
    for (i = 1; i <= 3; i++) {
        CHECK(sun2xp_recover(HAND, i) == 0);
        CHECK(GetPosD(i, Pos) == 0 && SendPosD(i, Pos) == 0);
    }
    CHECK(sun2xp_recover(HAND, 1) == 0);
    stop_one_finger();
    return CloseHand();
}
