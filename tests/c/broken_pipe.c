/* Standard error is a pipe that nobody reads. The messages of the library are lost, but the planner survives: the
   library causes no SIGPIPE, and a SIGPIPE that was already pending stays pending. */
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "Sun2Xp.h"

/* CHECK of check.h cannot be used, because it prints to standard error. */
#define HOLDS(Condition) \
    do { \
        if (!(Condition)) { \
            printf("%s:%d: not so: %s (HandError: %s)\n", __FILE__, __LINE__, #Condition, HandError()); \
            exit(1); \
        } \
    } while (0)

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

    HOLDS(pipe(ends) == 0);
    HOLDS(dup2(ends[1], 2) == 2);
    close(ends[0]);
    close(ends[1]);
    signal(SIGPIPE, SIG_DFL);

    /* Without a hand, the first refusal of its kind prints a message. */
    HOLDS(SendPos(1, Pos) == -1 && errno == ENODEV);
    HOLDS(strstr(HandError(), "no hand is open") != NULL);
    HOLDS(!is_pending() && !is_blocked());

    /* Opening the simulated hand prints a message. */
    HOLDS(OpenHand() == 0);
    HOLDS(!is_pending() && !is_blocked());

    /* The planner blocks SIGPIPE, and none is pending: none may be pending afterwards. */
    sigemptyset(&pipe_only);
    sigaddset(&pipe_only, SIGPIPE);
    HOLDS(sigprocmask(SIG_BLOCK, &pipe_only, NULL) == 0);
    HOLDS(SendPos(1, Beyond) == -1 && errno == ERANGE);
    HOLDS(!is_pending() && is_blocked());

    /* One is pending: it must stay pending. */
    raise(SIGPIPE);
    HOLDS(SendPos(4, Pos) == -1 && errno == EINVAL);
    HOLDS(is_pending() && is_blocked());
    HOLDS(CloseHand() == 0);
    return 0;
}
