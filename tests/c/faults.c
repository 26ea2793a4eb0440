/* GetFault and FaultText: a finger without faults, one whose board dies, a struct that is too small, and every text.
   The argument is the process number of the board of finger 1. */
#include <errno.h>
#include <signal.h>
#include <string.h>
#include "Sun2Xp.h"
#include "check.h"

int main(int count, char **arguments)
{
    struct Fault Fault;
    int tries, number;

    CHECK(count == 2);
    Fault.Size = sizeof Fault;
    errno = 0;
    CHECK(GetFault(1, &Fault) == -1 && errno == ENODEV);
    CHECK(OpenHand() == 0);
    errno = 0;
    CHECK(GetFault(1, NULL) == -1 && errno == EFAULT);
    Fault.Size = sizeof Fault - 1;
    errno = 0;
    CHECK(GetFault(1, &Fault) == -1 && errno == EINVAL);
    Fault.Size = sizeof Fault;
    errno = 0;
    CHECK(GetFault(4, &Fault) == -1 && errno == EINVAL);
    CHECK(GetFault(1, &Fault) == 0 && Fault.Number == 0 && Fault.Size == sizeof Fault);

    CHECK(kill((pid_t)atoi(arguments[1]), SIGKILL) == 0);
    for (tries = 0; Fault.Number == 0 && tries < 100; tries++) {
        PAUSE_MS(10);
        CHECK(GetFault(1, &Fault) == 0);
    }
    CHECK(Fault.Number == FAULT_PORT_VANISHED && Fault.Part == 0);
    CHECK(strstr(FaultText(Fault.Number), "port vanished") != NULL);
    CHECK(GetFault(2, &Fault) == 0 && Fault.Number == 0);

    for (number = 1; number <= FAULT_WARM_MOTOR; number++)
        CHECK(strstr(FaultText(number), ". Likely cause: ") != NULL);
    CHECK(FaultText(0)[0] == '\0' && FaultText(-1)[0] == '\0' && FaultText(1000)[0] == '\0');
    CHECK(CloseHand() == 0);
    return 0;
}
