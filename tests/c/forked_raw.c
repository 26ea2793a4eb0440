/* Children in which no fork handler of the library has run: those of _Fork and of raw system calls, and a child in
   which a handler of the planner, registered before OpenHand, makes the calls. Calls that open, close, read or command
   a hand are refused. sun2xp_stop_all is not refused. The parent's hand keeps running. */
#define _GNU_SOURCE
#include <errno.h>
#include <pthread.h>
#include <signal.h>
#include <string.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"

/* A child that hangs is ended by SIGALRM after this time. */
#define PATIENCE_S 20

static double Pos[3] = {0.1, 0.5, 0.9};
static int in_handler;

static int refuses_all_but_stop_all(void)
{
    struct sun2xp_status Status;
    Status.size = sizeof Status;
#define REFUSED(Call) ((errno = 0, (Call)) < 0 && errno == EPERM)
    return REFUSED(SendPos(1, Pos)) && REFUSED(GetPos(1, Pos)) && REFUSED(sun2xp_status(HAND, 1, &Status))
        && REFUSED(sun2xp_adjust(HAND, 1, "tendon.minimum = 6")) && REFUSED(sun2xp_write_black_box(HAND, 1,
                "child.jsonl"))
        && REFUSED(sun2xp_recover(HAND, 1)) && REFUSED(OpenHand()) && REFUSED(CloseHand()) && sun2xp_stop_all() == 0
        && strstr(HandError(), "forked") != NULL;
}

static void in_child(void)
{
    alarm(PATIENCE_S);
    if (in_handler)
        _exit(refuses_all_but_stop_all() ? 0 : 2);
}

static pid_t by_atfork_handler(void)
{
    pid_t child;
    in_handler = 1;
    child = fork();
    in_handler = 0;
    return child;
}

static pid_t by_system_call(void) { return (pid_t)syscall(SYS_clone, SIGCHLD, 0, 0, 0, 0); }

#if defined(__GLIBC__) && (__GLIBC__ > 2 || (__GLIBC__ == 2 && __GLIBC_MINOR__ >= 34))
static pid_t by_fork_without_handlers(void) { return _Fork(); }
#else
#define by_fork_without_handlers by_system_call
#endif

int main(void)
{
    static pid_t (*const ways[])(void) = {by_atfork_handler, by_system_call, by_fork_without_handlers};
    unsigned way;
    struct sun2xp_status Before, After;

    Before.size = After.size = sizeof Before;
    CHECK(pthread_atfork(NULL, NULL, in_child) == 0);
    CHECK(OpenHand() == 0);
    for (way = 0; way < sizeof ways / sizeof *ways; way++) {
        int status;
        pid_t child = ways[way]();
        CHECK(child >= 0);
        if (child == 0) {
            alarm(PATIENCE_S);
            _exit(refuses_all_but_stop_all() ? 0 : 1);
        }
        CHECK(waitpid(child, &status, 0) == child);
        if (status != 0)
            fprintf(stderr, "way %u: status %x\n", way, (unsigned)status);
        CHECK(status == 0);
    }
    CHECK(sun2xp_status(HAND, 1, &Before) == 0);
    PAUSE_MS(100);
    CHECK(sun2xp_status(HAND, 1, &After) == 0);
    CHECK(After.state == SUN2XP_STATE_RUNNING && After.cycles > Before.cycles);
    CHECK(CloseHand() == 0);
    return 0;
}
