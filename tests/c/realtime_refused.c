/* A planner that may not have SCHED_FIFO: its hand opens, runs, and is warned. */
#include <string.h>
#include "Sun2Xp.h"
#include "check.h"

int main(void)
{
    struct Fault Fault;

    CHECK(OpenHand() == 0);
    Fault.Size = sizeof Fault;
    CHECK(GetFault(1, &Fault) == 0);
    CHECK(Fault.Number == 0 && Fault.Warning == FAULT_REALTIME_REFUSED);
    CHECK(strstr(FaultText(Fault.Warning), "no real time") != NULL);
    CHECK(CloseHand() == 0);
    return 0;
}
