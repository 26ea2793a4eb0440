/* While the servos run, the planner's alarm signals keep arriving, and only on the planner's own thread. The timer and
   the handler of these signals stay as the planner has set them. */
#include <pthread.h>
#include <signal.h>
#include <string.h>
#include <sys/time.h>
#include "Sun2Xp.h"
#include "check.h"

static pthread_t planner;
static volatile sig_atomic_t alarms, strangers;

static void on_alarm(int number)
{
    (void)number;
    alarms++;
    if (!pthread_equal(pthread_self(), planner))
        strangers++;
}

int main(void)
{
    struct sigaction action, found;
    struct itimerval period, left;
    float Pos[3];
    struct timespec begin, now;

    planner = pthread_self();
    memset(&action, 0, sizeof action);
    action.sa_handler = on_alarm;
    CHECK(sigaction(SIGALRM, &action, NULL) == 0);
    period.it_interval.tv_sec = period.it_value.tv_sec = 0;
    period.it_interval.tv_usec = period.it_value.tv_usec = 5000;
    CHECK(setitimer(ITIMER_REAL, &period, NULL) == 0);

    CHECK(OpenHand() == 0);
    alarms = 0;
    clock_gettime(CLOCK_MONOTONIC, &begin);
    do {
        CHECK(GetPos(1, Pos) == 0);
        CHECK(SendPos(1, Pos) == 0);
        PAUSE_MS(1);
        clock_gettime(CLOCK_MONOTONIC, &now);
    } while (now.tv_sec - begin.tv_sec + 1e-9 * (now.tv_nsec - begin.tv_nsec) < 2.0);
    /* 400 are due. A pause of the whole machine merges some of them. */
    printf("%d alarms, %d of them on other threads\n", (int)alarms, (int)strangers);
    CHECK(alarms > 200);
    CHECK(strangers == 0);

    CHECK(getitimer(ITIMER_REAL, &left) == 0);
    CHECK(left.it_interval.tv_usec == 5000 && left.it_interval.tv_sec == 0);
    CHECK(sigaction(SIGALRM, NULL, &found) == 0);
    CHECK(found.sa_handler == on_alarm);
    CHECK(CloseHand() == 0);
    CHECK(strangers == 0);
    return 0;
}
