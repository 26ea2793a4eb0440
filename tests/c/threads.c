/* Calls from several threads at once: each thread has its own error text, all calls are served, and only one thread
   opens the hand. */
#include <errno.h>
#include <pthread.h>
#include <string.h>
#include "Sun2Xp.h"
#include "check.h"

#define THREADS 4
#define ROUNDS 20000

static int opened[THREADS];

static void *open_it(void *own)
{
    int *result = own;
    *result = OpenHand();
    CHECK(*result == 0 || errno == EBUSY);
    return NULL;
}

static void *call(void *own)
{
    int finger = (int)((int *)own - opened), round;
    double Pos[3] = {0.0, 0.5, 0.9}, Kx[3][3] = {{3, 0, 0}, {0, 3, 0}, {0, 0, 3}}, Measured[3];

    for (round = 0; round < ROUNDS; round++) {
        if (finger == 0) {
            CHECK(SendPos(0, Pos) == -1 && errno == EINVAL);
            CHECK(strstr(HandError(), "SendPos: ") == HandError());
        } else {
            CHECK(SendPos(finger, Pos) == 0);
            CHECK(SendKx(finger, Kx) == 0);
            CHECK(GetPos(finger, Measured) == 0);
            CHECK(Measured[2] > 0.0 && Measured[2] < 2.2);
            CHECK(strcmp(HandError(), "") == 0);
        }
    }
    return NULL;
}

static void all(void *(*function)(void *))
{
    pthread_t threads[THREADS];
    int number;
    for (number = 0; number < THREADS; number++)
        CHECK(pthread_create(&threads[number], NULL, function, &opened[number]) == 0);
    for (number = 0; number < THREADS; number++)
        CHECK(pthread_join(threads[number], NULL) == 0);
}

int main(void)
{
    int number, hands = 0;

    all(open_it);
    for (number = 0; number < THREADS; number++)
        hands += opened[number] == 0;
    CHECK(hands == 1);
    all(call);
    CHECK(CloseHand() == 0);
    return 0;
}
