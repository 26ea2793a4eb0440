/* Moves a finger, softens it, and stiffens it again: at the end it has the commanded pose. The program is K&R C, and
   passes Kx as nine floats. */
#include <stdio.h>
extern OpenHand(), SendPos(), SendKx(), GetPos(), CloseHand();

diagonal(i, k)
int i;
double k;
{
    float kx[9];
    register int n;

    for (n = 0; n < 9; n++)
        kx[n] = 0.0;
    kx[0] = kx[4] = kx[8] = k;
    return SendKx(i, kx);
}

main(argc, argv)
int argc;
char **argv;
{
    static float pos[3] = {0.0, 0.8, 0.8};
    double k;

    if (OpenHand() == -1)
        exit(1);
    SendPos(3, pos);
    for (k = 5.0; k > 1.0; k -= 0.5) {
        printf("%.1f: %d\n", k, diagonal(3, k));
        usleep(200000);
    }
    printf("7: %d\n", diagonal(3, 7.0));
    diagonal(3, 5.5);
    sleep(4);
    GetPos(3, pos);
    printf("%.2f %.2f %.2f\n", pos[0], pos[1], pos[2]);
    CloseHand();
    exit(0);
}
