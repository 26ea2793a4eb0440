/* Carries out a table of commands in ASCII: a state machine with goto, in C99. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "Sun2Xp.h"

static const char program[] =
    "M 1 0.00 0.40 0.60\nM 2 0.10 0.50 0.70\nW 3\nK 1 2.0\nK 2 9.0\nM 1 0.10 0.60 0.80\nM 4 0 0 0\nW 4\nR 1\nR 2\nE\n";

int main(void)
{
    char text[sizeof program], *line, *rest;
    memcpy(text, program, sizeof program);
    if (OpenHand() != 0)
        goto failed;
    line = strtok_r(text, "\n", &rest);
next:
    if (!line)
        goto failed;
    switch (line[0]) {
    case 'M': {
        int finger;
        double p[3];
        sscanf(line, "M %d %lf %lf %lf", &finger, &p[0], &p[1], &p[2]);
        printf("%s -> %d\n", line, SendPos(finger, p));
        break;
    }
    case 'K': {
        int finger;
        float k;
        sscanf(line, "K %d %f", &finger, &k);
        printf("%s -> %d\n", line, SendKx(finger, (float[9]){k, 0, 0, 0, k, 0, 0, 0, k}));
        break;
    }
    case 'W':
        sleep((unsigned)atoi(line + 2));
        break;
    case 'R': {
        double p[3];
        printf("%s -> %d", line, GetPos(atoi(line + 2), p));
        printf(" %.2f %.2f %.2f\n", p[0], p[1], p[2]);
        break;
    }
    default:
        return CloseHand();
    }
    line = strtok_r(NULL, "\n", &rest);
    goto next;
failed:
    puts(HandError());
    return 1;
}
