/* If the board of finger 1 dies, GetPos, SendPos and SendKx are refused for this finger with EIO and a reason, GetPos
   leaves its output unchanged, and the hand can be closed. The argument is the process number of the board. */
#include <errno.h>
#include <signal.h>
#include <string.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"

int main(int count, char **arguments)
{
    float Pos[3] = {0.0f, 0.5f, 0.9f}, Kx[9] = {3, 0, 0, 0, 3, 0, 0, 0, 3};
    float Output[3];
    struct sun2xp_status Status;
    int tries, result = 0;

    CHECK(count == 2);
    CHECK(OpenHand() == 0);
    CHECK(SendPos(1, Pos) == 0);
    errno = 0;
    CHECK(sun2xp_push(HAND, 1, (double[3]){0, 0, 0}) < 0 && errno == ENOTSUP);
    CHECK(kill((pid_t)atoi(arguments[1]), SIGKILL) == 0);
    for (tries = 0; result == 0 && tries < 100; tries++) {
        PAUSE_MS(10);
        Output[0] = Output[1] = Output[2] = 7.0f;
        errno = 0;
        result = GetPos(1, Output);
    }
    CHECK(result < 0 && errno == EIO);
    CHECK(Output[0] == 7.0f && Output[1] == 7.0f && Output[2] == 7.0f);
    CHECK(strstr(HandError(), "finger 1 is faulted") != NULL);
    errno = 0;
    CHECK(SendPos(1, Pos) == -1 && errno == EIO);
    errno = 0;
    CHECK(SendKx(1, Kx) == -1 && errno == EIO);
    Status.size = sizeof Status;
    CHECK(sun2xp_status(HAND, 1, &Status) == 0 && Status.state == SUN2XP_STATE_FAULTED);
    CHECK(CloseHand() == 0);
    return 0;
}
