/* A child has no hand; the parent keeps it, whatever the child does. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>
#include "Sun2Xp.h"

int main(void)
{
    float pos[3] = {0.1f, 0.7f, 0.7f};
    int child, status;

    if (OpenHand() != 0)
        return 1;
    for (child = 0; child < 3; child++) {
        fflush(stdout);
        if (fork() == 0) {
            int sent = SendPos(1, pos), code = errno;
            printf("child %d: %d %d %d\n", child, sent, code, GetPos(1, pos));
            printf("child %d: %s\n", child, HandError());
            if (child == 2)
                execl("/bin/true", "true", (char *)0);
            /* The exit handlers run in child 0, and do not run in child 1. */
            fflush(stdout);
            child == 0 ? exit(3) : _exit(3);
        }
        wait(&status);
        printf("child ended with %d\n", child == 2 ? 0 : WEXITSTATUS(status));
        pos[0] = 0.1f, pos[1] = 0.7f, pos[2] = 0.7f;
        printf("parent sends: %d\n", SendPos(1, pos));
    }
    sleep(3);
    printf("parent reads: %d", GetPos(1, pos));
    printf(" %.2f %.2f %.2f\n", pos[0], pos[1], pos[2]);
    return CloseHand();
}
