/* Opens and closes the hand in a loop, as a menu-driven program does. */
#include <stdio.h>
#include <unistd.h>
#include "Sun2Xp.h"

int main(void)
{
    float pos[3];
    int turn;

    for (turn = 0; turn < 5; turn++) {
        pos[0] = 0.0f, pos[1] = 0.4f + 0.1f * turn, pos[2] = 0.8f;
        printf("turn %d: open %d, ", turn, OpenHand());
        printf("send %d, ", SendPos(1, pos));
        sleep(turn == 4 ? 4 : 1);
        printf("get %d, ", GetPos(1, pos));
        printf("close %d\n", CloseHand());
        printf("get after close %d\n", GetPos(1, pos));
    }
    return 0;
}
