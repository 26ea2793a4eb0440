/* A forked child is refused everything, ends without touching the hand, and the parent's hand goes on. */
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

    Status.Size = sizeof Status;
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
