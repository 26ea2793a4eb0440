/* Standard error is a file that has reached the largest size the process may write. The messages of the library are
   lost, and the planner gets no SIGXFSZ for them. */
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>
#include "Sun2Xp.h"

/* CHECK of check.h cannot be used, because it prints to standard error. */
#include <stdio.h>
#include <stdlib.h>
#define HOLDS(Condition) \
    do { \
        if (!(Condition)) { \
            printf("%s:%d: not so: %s (HandError: %s)\n", __FILE__, __LINE__, #Condition, HandError()); \
            exit(1); \
        } \
    } while (0)

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
    HOLDS(file >= 0);
    HOLDS(write(file, full, LARGEST) == LARGEST);
    HOLDS(setrlimit(RLIMIT_FSIZE, &limit) == 0);
    HOLDS(dup2(file, 2) == 2);

    /* Without a hand, the first refusal of its kind prints a message. Opening the simulated hand prints another. */
    HOLDS(SendPos(1, Pos) == -1 && errno == ENODEV);
    HOLDS(OpenHand() == 0);
    HOLDS(!is_pending());

    /* A signal that was already pending must stay pending. */
    sigemptyset(&only);
    sigaddset(&only, SIGXFSZ);
    HOLDS(sigprocmask(SIG_BLOCK, &only, NULL) == 0);
    HOLDS(raise(SIGXFSZ) == 0);
    HOLDS(SendPos(4, Pos) == -1 && errno == EINVAL);
    HOLDS(is_pending());
    HOLDS(CloseHand() == 0);
    HOLDS(lseek(file, 0, SEEK_END) == LARGEST);
    return 0;
}
