/* A planner that closes descriptors it has not opened, as old daemons do, and at once opens files of its own, which
   get the numbers of the closed ones. Its files must stay intact, and no thread may spin. If a descriptor of the
   library was closed, a fault must report this. CloseHand must leave the planner's files open. The arguments are the
   limit of descriptors for the process and the highest descriptor that is closed. */
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"

#define MOST 4096
#define OWN 4 /* bytes in every file */

#define TERMINALS 8

static int own[MOST], owned, terminals[TERMINALS];
static char folder[] = "/tmp/sun2xp-descriptors-XXXXXX";

/* Opens one more file. It gets the number `wanted` unless that is negative. */
static void open_one(int wanted)
{
    char name[64];
    int file;

    sprintf(name, "%s/%d", folder, owned);
    file = open(name, O_RDWR | O_CREAT | O_EXCL, 0600);
    CHECK(file >= 0);
    CHECK(write(file, "mine", OWN) == OWN && lseek(file, 0, SEEK_SET) == 0);
    if (wanted >= 0 && file != wanted) {
        CHECK(dup2(file, wanted) == wanted);
        close(file);
        file = wanted;
    }
    CHECK(unlink(name) == 0);
    own[owned++] = file;
}

/* Opens pseudo-terminals, which get the names of those that were closed. */
static void open_terminals(void)
{
    int number;

    for (number = 0; number < TERMINALS; number++) {
        terminals[number] = posix_openpt(O_RDWR | O_NOCTTY);
        CHECK(terminals[number] >= 0 && unlockpt(terminals[number]) == 0);
    }
}

static void check_files(void)
{
    char content[2 * OWN];
    struct pollfd sent;
    int number;

    for (number = 0; number < TERMINALS; number++) {
        sent.fd = terminals[number];
        sent.events = POLLIN;
        CHECK(poll(&sent, 1, 0) >= 0 && (sent.revents & POLLIN) == 0);
    }

    for (number = 0; number < owned; number++) {
        CHECK(lseek(own[number], 0, SEEK_CUR) == 0);
        CHECK(pread(own[number], content, sizeof content, 0) == OWN && memcmp(content, "mine", OWN) == 0);
    }
}

static double cpu_seconds(void)
{
    struct timespec used;

    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
    return used.tv_sec + 1e-9 * used.tv_nsec;
}

static int taken[MOST], takes;

static void close_descriptors(int highest)
{
    int descriptor;

    takes = 0;
    for (descriptor = 3; descriptor <= highest; descriptor++)
        if (close(descriptor) == 0)
            taken[takes++] = descriptor;
}

/* The first files get the lowest free numbers. The others then take the remaining numbers that were closed. */
static void open_files(void)
{
    int number;

    owned = 0;
    for (number = 0; number < 30; number++)
        open_one(-1);
    for (number = 0; number < takes; number++)
        if (fcntl(taken[number], F_GETFD) < 0)
            open_one(taken[number]);
}

static void close_own(void)
{
    int number;

    for (number = 0; number < owned; number++)
        CHECK(close(own[number]) == 0);
    for (number = 0; number < TERMINALS; number++)
        CHECK(close(terminals[number]) == 0);
}

static void check_fingers(int all)
{
    struct sun2xp_fault Fault;
    float Pos[3];
    int finger;

    for (finger = 1; finger <= 3; finger++) {
        Fault.size = sizeof Fault;
        CHECK(sun2xp_fault(HAND, finger, &Fault) == 0);
        printf("%d descriptors were open, finger %d: fault %d\n", takes, finger, Fault.number);
        if (!all) {
            CHECK(Fault.number == 0 && GetPos(finger, Pos) == 0);
            continue;
        }
        /* If the descriptors of a simulated board are closed first, the board ends and its port vanishes. */
        CHECK(Fault.number == SUN2XP_FAULT_PORT_CLOSED || Fault.number == SUN2XP_FAULT_PORT_VANISHED);
        CHECK(GetPos(finger, Pos) == -1 && errno == EIO);
        CHECK(strstr(HandError(), "CloseHand, OpenHand") != NULL);
    }
}

int main(int count, char **arguments)
{
    struct rlimit limit;
    double used;
    int all, highest, descriptor, round;

    CHECK(count == 3);
    alarm(60);
    CHECK(mkdtemp(folder) != NULL);
    for (descriptor = 3; descriptor < MOST; descriptor++)
        close(descriptor); /* inherited descriptors */
    CHECK(getrlimit(RLIMIT_NOFILE, &limit) == 0);
    limit.rlim_cur = atoi(arguments[1]);
    CHECK(setrlimit(RLIMIT_NOFILE, &limit) == 0);
    highest = atoi(arguments[2]);
    all = highest + 1 >= (int)limit.rlim_cur;
    for (round = 0; round < 3; round++) {
        CHECK(OpenHand() == 0);
        close_descriptors(highest);
        open_files();
        open_terminals();
        PAUSE_MS(300);
        used = cpu_seconds();
        PAUSE_MS(500);
        used = cpu_seconds() - used;
        printf("round %d: %.3f s of processor time\n", round, used);
        check_files();
        check_fingers(all);
        CHECK(all == (takes > 0));
        CHECK(!all || used < 0.25); /* A thread that does not wait uses 0.5 s. */
        CHECK(CloseHand() == 0);
        check_files();
        close_own();
    }
    CHECK(rmdir(folder) == 0);
    return 0;
}
