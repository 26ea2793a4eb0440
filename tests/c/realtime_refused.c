/* A planner that may not have SCHED_FIFO: its hand opens, runs, and is warned. */
#include <string.h>
#include "Sun2Xp.h"
#include "check.h"

int main(void)
{
    struct Fault Fault;
    int tries = 0;

    CHECK(OpenHand() == 0);
    Fault.Size = sizeof Fault;
    /* What the finger itself is warned of comes first: without real time it may be late. */
    do {
        CHECK(tries++ < 2000);
        PAUSE_MS(10);
        CHECK(GetFault(1, &Fault) == 0 && Fault.Number == 0);
    } while (Fault.Warning != FAULT_REALTIME_REFUSED);
    CHECK(strstr(FaultText(Fault.Warning), "no real time") != NULL);
    CHECK(CloseHand() == 0);
    return 0;
}
