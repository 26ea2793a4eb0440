/* Tests sun2xp_fault with wrong arguments, and before and after the board of a finger dies. Tests that
   sun2xp_fault_text has a text for every fault.
   The argument is the process number of the board of finger 1. */
#include <errno.h>
#include <signal.h>
#include <string.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"

int main(int count, char **arguments)
{
    struct sun2xp_fault Fault;
    int tries, number;

    CHECK(count == 2);
    Fault.size = sizeof Fault;
    errno = 0;
    CHECK(sun2xp_fault(HAND, 1, &Fault) < 0 && errno == ENODEV);
    CHECK(OpenHand() == 0);
    errno = 0;
    CHECK(sun2xp_fault(HAND, 1, NULL) < 0 && errno == EFAULT);
    Fault.size = sizeof Fault - 1;
    errno = 0;
    CHECK(sun2xp_fault(HAND, 1, &Fault) < 0 && errno == EINVAL);
    Fault.size = sizeof Fault;
    errno = 0;
    CHECK(sun2xp_fault(HAND, 4, &Fault) < 0 && errno == EINVAL);
    CHECK(sun2xp_fault(HAND, 1, &Fault) == 0 && Fault.number == 0 && Fault.size == sizeof Fault);

    CHECK(kill((pid_t)atoi(arguments[1]), SIGKILL) == 0);
    for (tries = 0; Fault.number == 0 && tries < 100; tries++) {
        PAUSE_MS(10);
        CHECK(sun2xp_fault(HAND, 1, &Fault) == 0);
    }
    CHECK(Fault.number == SUN2XP_FAULT_PORT_VANISHED && Fault.part == 0);
    CHECK(strstr(sun2xp_fault_text(Fault.number), "port vanished") != NULL);
    CHECK(sun2xp_fault(HAND, 2, &Fault) == 0 && Fault.number == 0);

    for (number = 1; number <= SUN2XP_FAULT_WRONG_WIRING; number++)
        CHECK(strstr(sun2xp_fault_text(number), ". Likely cause: ") != NULL);
    /* If this check fails because a fault was added, make that fault the last one of the loop above. */
    CHECK(sun2xp_fault_text(number)[0] == '\0');
    CHECK(sun2xp_fault_text(0)[0] == '\0' && sun2xp_fault_text(-1)[0] == '\0' && sun2xp_fault_text(1000)[0] == '\0');
    CHECK(CloseHand() == 0);
    return 0;
}
