/* Commands each finger in a thread of its own. Another thread reads all fingers meanwhile. */
#include <pthread.h>
#include <stdio.h>
#include <unistd.h>
#include "Sun2Xp.h"

static float ends[4][3] = {{0, 0, 0}, {0.2f, 0.6f, 0.8f}, {-0.2f, 0.7f, 0.9f}, {0.1f, 0.8f, 1.0f}};
static volatile int moving = 1;
static int refused[4];

static void *drive(void *finger)
{
    int f = (int)(long)finger, i;
    float pos[3];

    for (i = 1; i <= 100; i++) {
        pos[0] = ends[f][0] * i / 100;
        pos[1] = 0.3f + (ends[f][1] - 0.3f) * i / 100;
        pos[2] = 0.4f + (ends[f][2] - 0.4f) * i / 100;
        refused[f] += SendPos(f, pos) != 0;
        usleep(10000);
    }
    return 0;
}

static void *watch(void *none)
{
    float pos[3];
    int f;
    while (moving)
        for (f = 1; f <= 3; f++) {
            refused[0] += GetPos(f, pos) != 0;
            usleep(1000);
        }
    return none;
}

int main(void)
{
    pthread_t drivers[4], watcher;
    float pos[3];
    long f;

    if (OpenHand() != 0)
        return 1;
    pthread_create(&watcher, 0, watch, 0);
    for (f = 1; f <= 3; f++)
        pthread_create(&drivers[f], 0, drive, (void *)f);
    for (f = 1; f <= 3; f++)
        pthread_join(drivers[f], 0);
    sleep(3);
    moving = 0;
    pthread_join(watcher, 0);
    for (f = 1; f <= 3; f++) {
        GetPos((int)f, pos);
        printf("finger %ld refused %d: %.2f %.2f %.2f\n", f, refused[f], pos[0], pos[1], pos[2]);
    }
    printf("reads refused: %d\n", refused[0]);
    return CloseHand();
}
