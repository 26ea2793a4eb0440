/* Standard error is a pipe that nobody reads. The messages of the library are lost, but the planner survives: the
   library causes no SIGPIPE, and a SIGPIPE that was already pending stays pending. */
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "Sun2Xp.h"

/* CHECK prints to standard output, because this test replaces standard error. */
#define CHECK_OUTPUT stdout
#include "check.h"

static int is_pending(void)
{
    sigset_t pending;
    sigpending(&pending);
    return sigismember(&pending, SIGPIPE);
}

static int is_blocked(void)
{
    sigset_t mask;
    sigprocmask(SIG_BLOCK, NULL, &mask);
    return sigismember(&mask, SIGPIPE);
}

int main(void)
{
    int ends[2];
    double Pos[3] = {0.0, 0.5, 0.8}, Beyond[3] = {3.0, 0.5, 0.8};
    sigset_t pipe_only;

    CHECK(pipe(ends) == 0);
    CHECK(dup2(ends[1], 2) == 2);
    close(ends[0]);
    close(ends[1]);
    signal(SIGPIPE, SIG_DFL);

    /* The first refusal of each kind prints a message, even if no hand is open. */
    CHECK(SendPos(1, Pos) == -1 && errno == ENODEV);
    CHECK(strstr(HandError(), "no hand is open") != NULL);
    CHECK(!is_pending() && !is_blocked());

    /* The configuration names no port, so OpenHand prints a message. */
    CHECK(OpenHand() == 0);
    CHECK(!is_pending() && !is_blocked());

    /* The planner blocks SIGPIPE, and no SIGPIPE is pending. After the call, no SIGPIPE may be pending. */
    sigemptyset(&pipe_only);
    sigaddset(&pipe_only, SIGPIPE);
    CHECK(sigprocmask(SIG_BLOCK, &pipe_only, NULL) == 0);
    CHECK(SendPos(1, Beyond) == -1 && errno == ERANGE);
    CHECK(!is_pending() && is_blocked());

    /* A SIGPIPE is pending. It must stay pending. */
    raise(SIGPIPE);
    CHECK(SendPos(4, Pos) == -1 && errno == EINVAL);
    CHECK(is_pending() && is_blocked());
    CHECK(CloseHand() == 0);
    return 0;
}
