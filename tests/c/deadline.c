/* A planner under SCHED_DEADLINE may not start threads without SCHED_FLAG_RESET_ON_FORK, and HandError says so. With
   the flag the hand opens. Exits with 77 if the system does not permit SCHED_DEADLINE. */
#define _GNU_SOURCE
#include <errno.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>
#include "Sun2Xp.h"
#include "check.h"

#define DEADLINE 6
#define RESET_ON_FORK 1

/* A copy of the kernel's struct sched_attr under another name, because recent C libraries define it too. */
struct attributes {
    unsigned size, policy;
    unsigned long flags;
    int nice;
    unsigned priority;
    unsigned long runtime, deadline, period;
};

static int run_under_deadline(unsigned long flags)
{
    struct attributes attributes;
    memset(&attributes, 0, sizeof attributes);
    attributes.size = sizeof attributes;
    attributes.policy = DEADLINE;
    attributes.flags = flags;
    attributes.runtime = 5000000;
    attributes.deadline = attributes.period = 100000000;
    return (int)syscall(SYS_sched_setattr, 0, &attributes, 0);
}

int main(void)
{
    if (run_under_deadline(0) != 0)
        return 77;
    CHECK(OpenHand() == -1 && errno == EAGAIN);
    CHECK(strstr(HandError(), "SCHED_DEADLINE") != NULL);
    CHECK(strstr(HandError(), "SCHED_FLAG_RESET_ON_FORK") != NULL);
    CHECK(strstr(HandError(), "ulimit") == NULL);
    CHECK(run_under_deadline(RESET_ON_FORK) == 0);
    CHECK(OpenHand() == 0);
    CHECK(CloseHand() == 0);
    return 0;
}
