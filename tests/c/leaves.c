/* Ends with the hand open and the status 3. The argument selects how: "return" returns from main, "exit" calls exit,
   "handler" calls exit in a signal handler, and "thread" returns from main while other threads make calls. With
   "killed" the process ends by a signal. */
#include <pthread.h>
#include <signal.h>
#include <string.h>
#include <sys/time.h>
#include "Sun2Xp.h"
#include "check.h"

static void leave(int number)
{
    (void)number;
    exit(3);
}

static void *hammer(void *unused)
{
    float Pos[3];
    for (;;)
        if (GetPos(1, Pos) == 0)
            SendPos(1, Pos);
    return unused;
}

int main(int count, char **arguments)
{
    pthread_t thread;

    CHECK(count == 2);
    CHECK(OpenHand() == 0);
    if (strcmp(arguments[1], "exit") == 0)
        exit(3);
    if (strcmp(arguments[1], "handler") == 0) {
        struct itimerval soon;
        memset(&soon, 0, sizeof soon);
        soon.it_value.tv_usec = 20000;
        signal(SIGALRM, leave);
        CHECK(setitimer(ITIMER_REAL, &soon, NULL) == 0);
        hammer(NULL);
    }
    if (strcmp(arguments[1], "thread") == 0) {
        CHECK(pthread_create(&thread, NULL, hammer, NULL) == 0);
        CHECK(pthread_create(&thread, NULL, hammer, NULL) == 0);
        PAUSE_MS(50);
    }
    if (strcmp(arguments[1], "killed") == 0)
        raise(SIGKILL);
    return 3;
}
