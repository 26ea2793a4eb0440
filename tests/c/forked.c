/* In a forked child every call that opens, closes, reads or commands a hand is refused, except sun2xp_stop_all, which
   does nothing. The child ends without touching the hand. The parent's hand keeps running. */
#include <errno.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"

#define REFUSED(Call) CHECK((errno = 0, (Call)) < 0 && errno == EPERM)

static void child(void)
{
    double Pos[3] = {0.0, 0.5, 0.9};
    struct sun2xp_status Status;
    struct sun2xp_timing Timing;
    struct sun2xp_tip Tip;
    struct sun2xp_record Record;
    struct sun2xp_fault Fault;
    struct sun2xp_object Object;

    Object.size = sizeof Object;
    Status.size = sizeof Status;
    Timing.size = sizeof Timing;
    Tip.size = sizeof Tip;
    Record.size = sizeof Record;
    Fault.size = sizeof Fault;
    REFUSED(sun2xp_timing(HAND, 1, SUN2XP_STAGE_CYCLE, &Timing));
    REFUSED(sun2xp_timing(HAND, 9, 99, NULL));
    REFUSED(sun2xp_reset_timing(HAND, 0));
    REFUSED(sun2xp_send_tip(HAND, 1, Pos));
    REFUSED(sun2xp_tip(HAND, 1, &Tip));
    REFUSED(sun2xp_send_contact(HAND, 9, 9, NULL, NULL));
    REFUSED(sun2xp_send_damping(HAND, 1, 1));
    REFUSED(sun2xp_adjust(HAND, 1, ""));
    REFUSED(sun2xp_object(HAND, &Object));
    REFUSED(sun2xp_record(HAND, 1, 0, &Record));
    REFUSED(sun2xp_write_black_box(HAND, 1, "child.jsonl"));
    REFUSED(sun2xp_zero(HAND, 1));
    REFUSED(sun2xp_identify(HAND, 1));
    REFUSED(sun2xp_fault(HAND, 1, &Fault));
    REFUSED(sun2xp_recover(HAND, 1));
    CHECK(strstr(sun2xp_fault_text(SUN2XP_FAULT_WATCHDOG), "watchdog") != NULL);
    errno = 0;
    CHECK(sun2xp_stop_all() == 0 && errno == 0);
    REFUSED(SendPos(1, Pos));
    REFUSED(SendPos(1, (float *)NULL));
    REFUSED(SendKx(1, (float *)NULL));
    REFUSED(GetPos(1, Pos));
    REFUSED(sun2xp_status(HAND, 1, &Status));
    REFUSED(sun2xp_push(HAND, 1, Pos));
    REFUSED(OpenHand());
    REFUSED(CloseHand());
    CHECK(strstr(HandError(), "forked") != NULL);
    exit(0);
}

int main(void)
{
    float Pos[3];
    int round, status;
    struct sun2xp_status Before, After;

    CHECK(OpenHand() == 0);
    Before.size = After.size = sizeof Before;
    for (round = 0; round < 3; round++) {
        pid_t process = fork();
        CHECK(process >= 0);
        if (process == 0)
            child();
        CHECK(waitpid(process, &status, 0) == process);
        CHECK(WIFEXITED(status) && WEXITSTATUS(status) == 0);
        CHECK(GetPos(1, Pos) == 0);
    }
    CHECK(sun2xp_status(HAND, 1, &Before) == 0);
    PAUSE_MS(100);
    CHECK(sun2xp_status(HAND, 1, &After) == 0);
    CHECK(After.state == SUN2XP_STATE_RUNNING && After.cycles > Before.cycles);
    CHECK(CloseHand() == 0);
    return 0;
}
