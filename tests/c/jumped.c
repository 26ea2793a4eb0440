/* An alarm handler that jumps out of slow calls, as planners of 1990 did to limit the time of a call. The abandoned
   call completes in the background. Later calls are served, or refused with EBUSY until it has completed. */
#include <errno.h>
#include <setjmp.h>
#include <signal.h>
#include <string.h>
#include <sys/time.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"

static sigjmp_buf out;

static void on_alarm(int number)
{
    siglongjmp(out, number);
}

/* Jumps out of a call after the given time. Returns 1 if the jump happened before the call returned. */
static int jumped_out_of(int (*call)(void), long microseconds)
{
    struct itimerval soon;
    if (sigsetjmp(out, 1) != 0)
        return 1;
    memset(&soon, 0, sizeof soon);
    soon.it_value.tv_usec = microseconds;
    CHECK(setitimer(ITIMER_REAL, &soon, NULL) == 0);
    call();
    memset(&soon, 0, sizeof soon);
    CHECK(setitimer(ITIMER_REAL, &soon, NULL) == 0);
    return 0;
}

static int zero(void) { return sun2xp_zero(HAND, 1); }
static int write_black_box(void) { return sun2xp_write_black_box(HAND, 1, "jumped.jsonl"); }

int main(void)
{
    double Pos[3];
    int jumps = 0, round;

    signal(SIGALRM, on_alarm);
    for (round = 0; round < 20; round++) {
        jumps += jumped_out_of(OpenHand, 500 + 1700 * round);
        /* An opening that has begun completes in the background. CloseHand waits for its end. */
        CHECK(OpenHand() == 0 || errno == EBUSY);
        jumps += jumped_out_of(CloseHand, 300 + 1300 * round);
        CHECK(CloseHand() == 0);
        CHECK(GetPos(1, Pos) == -1 && errno == ENODEV);
    }
    CHECK(jumps >= 20);

    CHECK(OpenHand() == 0);
    CHECK(jumped_out_of(zero, 100000) == 1);
    CHECK(sun2xp_zero(HAND, 1) < 0 && errno == EBUSY);
    for (round = 0; round < 50; round++)
        jumped_out_of(write_black_box, 100 + 500 * round);
    while (sun2xp_zero(HAND, 1) != 0) {
        /* Until the values that the first call found are in force, EBUSY is the only errno. */
        CHECK(errno == EBUSY);
        PAUSE_MS(1);
    }
    CHECK(GetPos(1, Pos) == 0 && SendPos(1, Pos) == 0);
    CHECK(CloseHand() == 0);
    return 0;
}
