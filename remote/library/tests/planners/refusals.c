/* Refusals that a planner of 1990 can provoke with wrong calls and wrong arguments: result, errno and text. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "Sun2Xp.h"

static void say(const char *what, int result)
{
    int code = errno;
    printf("%s: %d %d %s\n", what, result, result == 0 ? 0 : code, result == 0 ? "" : HandError());
    errno = 0;
}

int main(void)
{
    float pos[3] = {0.0f, 0.5f, 0.8f}, bad[3];
    double kx[3][3] = {{3, 0, 0}, {0, 3, 0}, {0, 0, 3}};

    printf("text before: '%s'\n", HandError());
    say("send before open", SendPos(1, pos));
    say("get before open", GetPos(1, pos));
    say("close before open", CloseHand());
    say("open", OpenHand());
    say("open twice", OpenHand());
    say("finger 0", SendPos(0, pos));
    say("finger 4", SendPos(4, pos));
    say("finger -1", GetPos(-1, bad));
    say("null", SendPos(1, (float *)0));
    say("null to get", GetPos(1, (double *)0));
    bad[0] = 0.0f, bad[1] = (float)NAN, bad[2] = 0.5f;
    say("not a number", SendPos(1, bad));
    bad[1] = (float)INFINITY;
    say("infinite", SendPos(1, bad));
    bad[1] = 2.5f;
    say("beyond a limit", SendPos(1, bad));
    bad[1] = 0.5f, bad[2] = 0.0f;
    say("below a limit", SendPos(1, bad));
    say("good", SendPos(1, pos));
    kx[0][1] = 2.0;
    say("not symmetric", SendKx(1, kx));
    kx[0][1] = 0.0, kx[2][2] = -1.0;
    say("negative", SendKx(1, kx));
    kx[2][2] = 50.0;
    say("too stiff", SendKx(1, kx));
    kx[2][2] = NAN;
    say("no number in Kx", SendKx(1, kx));
    kx[2][2] = 2.0;
    say("good Kx", SendKx(1, kx));
    say("Kx of finger 9", SendKx(9, kx));
    say("close", CloseHand());
    say("send after close", SendPos(1, pos));
    say("close again", CloseHand());
    return 0;
}
