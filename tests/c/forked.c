/* A forked child is refused all calls but three and ends without touching the hand. The parent's hand keeps running. */
#include <errno.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include "Sun2Xp.h"
#include "check.h"

#define REFUSED(Call) CHECK((errno = 0, (Call)) == -1 && errno == EPERM)

static void child(void)
{
    double Pos[3] = {0.0, 0.5, 0.9};
    struct FingerStatus Status;
    struct FingerTiming Timing;
    struct FingerTip Tip;
    struct FingerRecord Record;
    struct Fault Fault;
    struct ObjectState Object;

    Object.Size = sizeof Object;
    Status.Size = sizeof Status;
    Timing.Size = sizeof Timing;
    Tip.Size = sizeof Tip;
    Record.Size = sizeof Record;
    Fault.Size = sizeof Fault;
    REFUSED(GetTiming(1, TIMING_CYCLE, &Timing));
    REFUSED(GetTiming(9, 99, NULL));
    REFUSED(ResetTiming(0));
    REFUSED(SendTip(1, Pos));
    REFUSED(GetTip(1, &Tip));
    REFUSED(SendContact(9, 9, NULL, NULL));
    REFUSED(SendDamping(1, 1));
    REFUSED(AdjustFinger(1, ""));
    REFUSED(GetObject(&Object));
    REFUSED(GetRecord(1, 0, &Record));
    REFUSED(WriteBlackBox(1, "child.jsonl"));
    REFUSED(ZeroFinger(1));
    REFUSED(IdentifyFinger(1));
    REFUSED(GetFault(1, &Fault));
    REFUSED(RecoverHand(1));
    CHECK(strstr(FaultText(FAULT_WATCHDOG), "watchdog") != NULL);
    errno = 0;
    CHECK(StopHand() == 0 && errno == 0);
    REFUSED(SendPos(1, Pos));
    REFUSED(SendPos(1, (float *)NULL));
    REFUSED(SendKx(1, (float *)NULL));
    REFUSED(GetPos(1, Pos));
    REFUSED(GetStatus(1, &Status));
    REFUSED(PushFinger(1, Pos));
    REFUSED(OpenHand());
    REFUSED(CloseHand());
    CHECK(strstr(HandError(), "forked") != NULL);
    exit(0);
}

int main(void)
{
    float Pos[3];
    int round, status;
    struct FingerStatus Before, After;

    CHECK(OpenHand() == 0);
    Before.Size = After.Size = sizeof Before;
    for (round = 0; round < 3; round++) {
        pid_t process = fork();
        CHECK(process >= 0);
        if (process == 0)
            child();
        CHECK(waitpid(process, &status, 0) == process);
        CHECK(WIFEXITED(status) && WEXITSTATUS(status) == 0);
        CHECK(GetPos(1, Pos) == 0);
    }
    CHECK(GetStatus(1, &Before) == 0);
    PAUSE_MS(100);
    CHECK(GetStatus(1, &After) == 0);
    CHECK(After.State == FINGER_RUNNING && After.Cycles > Before.Cycles);
    CHECK(CloseHand() == 0);
    return 0;
}
