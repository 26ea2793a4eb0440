/* The planner's last thread ends with the hand open. The process must end as it would without the library: with the
   status 0, after its exit handlers, one of which closes the hand. With the argument "main", the last thread is that of
   main. With "other", it is another thread, which ends three seconds after that of main. */
#include <pthread.h>
#include <string.h>
#include "Sun2Xp.h"
#include "check.h"

static void close_at_exit(void)
{
    printf("closed: %d\n", CloseHand());
}

static void *stay(void *unused)
{
    double Pos[3];
    int round;
    for (round = 0; round < 300; round++) {
        CHECK(GetPos(1, Pos) == 0 && SendPos(1, Pos) == 0);
        PAUSE_MS(10);
    }
    printf("the last thread ends\n");
    return unused;
}

int main(int count, char **arguments)
{
    pthread_t thread;
    CHECK(count == 2);
    CHECK(atexit(close_at_exit) == 0);
    CHECK(OpenHand() == 0);
    if (strcmp(arguments[1], "other") == 0)
        CHECK(pthread_create(&thread, NULL, stay, NULL) == 0);
    pthread_exit(NULL);
}
