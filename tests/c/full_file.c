/* Standard error is a file that has reached the largest size the process may write. The messages of the library are
   lost, and the planner gets no SIGXFSZ for them. */
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>
#include "Sun2Xp.h"

/* CHECK prints to standard output, because this test replaces standard error. */
#define CHECK_OUTPUT stdout
#include "check.h"

#define LARGEST 64

static int is_pending(void)
{
    sigset_t pending;
    sigpending(&pending);
    return sigismember(&pending, SIGXFSZ);
}

int main(void)
{
    char full[LARGEST];
    double Pos[3] = {0.0, 0.5, 0.8};
    struct rlimit limit;
    sigset_t only;
    int file, number;

    for (number = 0; number < LARGEST; number++)
        full[number] = '.';
    limit.rlim_cur = limit.rlim_max = LARGEST;
    file = open("lines", O_RDWR | O_CREAT | O_APPEND, 0600);
    CHECK(file >= 0);
    CHECK(write(file, full, LARGEST) == LARGEST);
    CHECK(setrlimit(RLIMIT_FSIZE, &limit) == 0);
    CHECK(dup2(file, 2) == 2);

    /* The refusal of SendPos prints a message, and so does OpenHand, because the configuration names no port. */
    CHECK(SendPos(1, Pos) == -1 && errno == ENODEV);
    CHECK(OpenHand() == 0);
    CHECK(!is_pending());

    /* A signal that was already pending must stay pending. */
    sigemptyset(&only);
    sigaddset(&only, SIGXFSZ);
    CHECK(sigprocmask(SIG_BLOCK, &only, NULL) == 0);
    CHECK(raise(SIGXFSZ) == 0);
    CHECK(SendPos(4, Pos) == -1 && errno == EINVAL);
    CHECK(is_pending());
    CHECK(CloseHand() == 0);
    CHECK(lseek(file, 0, SEEK_END) == LARGEST);
    return 0;
}
