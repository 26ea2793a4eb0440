/* Closes the hand while another thread waits for an event. Another client then opens the hand at once. */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "sun2xp.h"

static sun2xp_hand *hand;
static volatile int waiting;

static void *wait_for_events(void *none)
{
    struct sun2xp_event event;

    event.size = sizeof event;
    waiting = 1;
    while (sun2xp_wait_event(hand, &event, -1.0) == 1)
        ;
    return none;
}

/* Reads the configuration of this planner, and changes the client's name in it to "another". */
static int read_configuration(char *text, size_t size)
{
    FILE *file = fopen(getenv("SUN2XP_CONFIG"), "r");
    char *name;

    if (!file)
        return 0;
    text[fread(text, 1, size - 1, file)] = '\0';
    fclose(file);
    name = strstr(text, "planner");
    return name && memcpy(name, "another", strlen("another"));
}

int main(void)
{
    static char text[4096];
    pthread_t thread;
    sun2xp_hand *second;

    if (!read_configuration(text, sizeof text) || sun2xp_open(NULL, &hand) != 0)
        return 1;
    if (pthread_create(&thread, NULL, wait_for_events, NULL) != 0)
        return 2;
    while (!waiting)
        usleep(1000);
    usleep(300000);
    printf("close %d\n", sun2xp_close(hand));
    printf("another %d\n", sun2xp_open_text(text, &second));
    pthread_join(thread, NULL);
    printf("close %d\n", sun2xp_close(second));
    return 0;
}
