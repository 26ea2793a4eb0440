/* Never calls CloseHand: exit closes the hand. An exit handler that was registered before the hand was opened finds it
   closed. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
#include "Sun2Xp.h"

static double pos[3] = {0.0, 0.5, 0.8};

static void before(void)
{
    int sent = SendPos(1, pos), code = errno;
    printf("registered before: %d %d\n", sent, sent ? code : 0);
    fflush(stdout);
}

static void after(void)
{
    printf("registered after: %d\n", SendPos(1, pos));
}

int main(void)
{
    atexit(before);
    printf("open %d\n", OpenHand());
    atexit(after);
    printf("send %d\n", SendPos(1, pos));
    sleep(2);
    exit(5);
}
