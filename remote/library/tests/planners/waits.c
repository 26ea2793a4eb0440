/* Calls sun2xp_wait for a finger that is being zeroed (refused with EBUSY), and then stops the zeroing. */
#include <errno.h>
#include <pthread.h>
#include <stdio.h>
#include <unistd.h>
#include "sun2xp.h"

static sun2xp_hand *hand;
static int zeroed, code;

static void *zero(void *none)
{
    zeroed = sun2xp_zero(hand, 1);
    code = errno;
    return none;
}

static int state(void)
{
    struct sun2xp_status status;

    status.size = sizeof status;
    return sun2xp_status(hand, 1, &status) == 0 ? status.state : 0;
}

int main(void)
{
    pthread_t thread;
    int tries, waited;

    if (sun2xp_open(NULL, &hand) != 0 || pthread_create(&thread, NULL, zero, NULL) != 0)
        return 1;
    for (tries = 0; tries < 20000 && state() != SUN2XP_STATE_CALIBRATING; tries++)
        usleep(1000);
    waited = sun2xp_wait(hand, 1, SUN2XP_WAIT_SETTLED, 60.0);
    printf("wait %d, busy %d\n", waited, errno == EBUSY);
    printf("stop %d\n", sun2xp_stop(hand, 1));
    pthread_join(thread, NULL);
    printf("zero %d, cancelled %d\n", zeroed, code == ECANCELED);
    return sun2xp_close(hand);
}
