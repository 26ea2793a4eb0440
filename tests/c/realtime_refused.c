/* A planner that may not use SCHED_FIFO: its hand opens, runs, and gives a warning. */
#include <string.h>
#include "Sun2Xp.h"
#include "check.h"

int main(void)
{
    struct Fault Fault;

    CHECK(OpenHand() == 0);
    Fault.Size = sizeof Fault;
    CHECK(GetFault(1, &Fault) == 0 && Fault.Number == 0);
    /* On a busy machine the finger itself may give a warning first, because it is late without real time. */
    CHECK(Fault.Warning == FAULT_REALTIME_REFUSED || Fault.Warning == FAULT_OVERRUN
          || Fault.Warning == FAULT_LINE_NOISE);
    CHECK(strstr(FaultText(FAULT_REALTIME_REFUSED), "no real time") != NULL);
    CHECK(CloseHand() == 0);
    return 0;
}
