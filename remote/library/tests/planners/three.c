/* Three fingers close and open together. Tables contain the poses. */
#include "Sun2Xp.c"
#include <stdio.h>
#include <unistd.h>

#define FINGERS 3

float closed[FINGERS][3] = {{0.1, 0.8, 1.0}, {-0.1, 0.8, 1.0}, {0.0, 0.7, 0.9}};
float opened[FINGERS][3] = {{0.0, 0.3, 0.5}, {0.0, 0.3, 0.5}, {0.0, 0.2, 0.4}};

void all(pose) float pose[FINGERS][3];
{
    int f;
    for (f = 1; f <= FINGERS; f++)
        if (SendPos(f, pose[f - 1]) < 0)
            printf("finger %d refused\n", f);
}

void where(word) char *word;
{
    int f;
    float p[3];
    for (f = 1; f <= FINGERS; f++) {
        GetPos(f, p);
        printf("%s %d: %.2f %.2f %.2f\n", word, f, p[0], p[1], p[2]);
    }
}

int main()
{
    if (OpenHand() < 0) {
        printf("%s\n", HandError());
        return 1;
    }
    all(closed);
    sleep(4);
    where("closed");
    all(opened);
    sleep(4);
    where("opened");
    return CloseHand();
}
