/* While a hand is open, the library locks at most as much memory as the first argument says, in mebibytes. After
   CloseHand it has none locked, whichever threads open and close the hand. Memory that the planner has locked stays
   locked. */
#include <pthread.h>
#include <string.h>
#include <sys/mman.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"

#define OPENINGS 50
#define OWN_KILOBYTES 64

/* VmLck of this process, kB. */
static long locked(void)
{
    char line[256];
    long kilobytes = -1;
    FILE *status = fopen("/proc/self/status", "r");
    CHECK(status != NULL);
    while (fgets(line, sizeof line, status) != NULL)
        if (sscanf(line, "VmLck: %ld kB", &kilobytes) == 1)
            break;
    fclose(status);
    CHECK(kilobytes >= 0);
    return kilobytes;
}

static long most;
static int unlocks;

static void *open_and_close(void *unused)
{
    struct sun2xp_status Status;
    char *own = malloc(1000);
    Status.size = sizeof Status;
    CHECK(own != NULL);
    CHECK(OpenHand() == 0);
    CHECK(sun2xp_status(HAND, 1, &Status) == 0);
    /* The checks of this program are meaningful only if memory can be locked. */
    CHECK(Status.memory_locked == 1);
    CHECK(locked() > 100);
    if (locked() > most)
        most = locked();
    if (unlocks) {
        /* memory_locked says that OpenHand has locked memory, even if the planner has unlocked it since. */
        CHECK(munlockall() == 0 && locked() == 0);
        CHECK(sun2xp_status(HAND, 1, &Status) == 0 && Status.memory_locked == 1);
    }
    CHECK(CloseHand() == 0);
    free(own);
    return unused;
}

int main(int count, char **arguments)
{
    pthread_t thread;
    int round;
    long before, limit;
    char *own;

    CHECK(count == 2);
    limit = atol(arguments[1]) * 1024;
    /* The planner locks a heap block. The pages at its ends may also hold memory that the library allocates. */
    own = malloc(OWN_KILOBYTES * 1024);
    CHECK(own != NULL && mlock(own, OWN_KILOBYTES * 1024) == 0);
    before = locked();
    for (round = 0; round < OPENINGS; round++) {
        CHECK(pthread_create(&thread, NULL, open_and_close, NULL) == 0);
        CHECK(pthread_join(thread, NULL) == 0);
        CHECK(locked() == before);
    }
    printf("%ld kB locked while a hand is open\n", most - before);
    CHECK(most - before <= limit);

    unlocks = 1;
    open_and_close(NULL);
    unlocks = 0;
    open_and_close(NULL);
    return 0;
}
