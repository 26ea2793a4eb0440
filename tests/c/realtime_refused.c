/* A planner without permission to use SCHED_FIFO: its hand opens, runs, and gives a warning. */
#include <string.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"

int main(void)
{
    struct sun2xp_fault Fault;

    CHECK(OpenHand() == 0);
    Fault.size = sizeof Fault;
    CHECK(sun2xp_fault(HAND, 1, &Fault) == 0 && Fault.number == 0);
    /* On a busy machine the finger itself may give a warning first, because it is late without real time. */
    CHECK(Fault.warning == SUN2XP_FAULT_REALTIME_REFUSED || Fault.warning == SUN2XP_FAULT_OVERRUN
          || Fault.warning == SUN2XP_FAULT_LINE_NOISE);
    CHECK(strstr(sun2xp_fault_text(SUN2XP_FAULT_REALTIME_REFUSED), "real time refused") != NULL);
    CHECK(CloseHand() == 0);
    return 0;
}
