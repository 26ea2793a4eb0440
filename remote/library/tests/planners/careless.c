/* Sends nonsense between good commands, and checks no result. */
#include <stdio.h>
#include <unistd.h>
#include "Sun2Xp.h"

int main(void)
{
    double good[3] = {0.05, 0.7, 0.7}, far[3] = {3.0, 0.7, 0.7}, not_a_number[3] = {0.0, 0.0, 0.0};
    double lopsided[3][3] = {{3, 1, 0}, {0, 3, 0}, {0, 0, 3}};
    double zero = 0.0, here[3];
    int i;

    not_a_number[1] = zero / zero;
    OpenHand();
    OpenHand();
    for (i = 0; i < 300; i++) {
        SendPos(3, far);
        SendPos(3, not_a_number);
        SendPos(7, good);
        SendKx(3, lopsided);
        SendPos(3, good);
        usleep(10000);
    }
    GetPos(3, here);
    printf("%.2f %.2f %.2f\n", here[0], here[1], here[2]);
    CloseHand();
    CloseHand();
    return 0;
}
