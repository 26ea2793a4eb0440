/* Opens the hand, sends every finger to one pose, prints a line, and ends with the hand open. The argument selects
   how the program ends: "return" from main, "exit", "_exit" without exit handlers, or "wait" for a fatal signal. */
#include <string.h>
#include <unistd.h>
#include "Sun2Xp.h"
#include "check.h"

int main(int count, char **arguments)
{
    const double Sent[3] = {0.2, 0.6, 1.1};
    int finger;

    CHECK(count == 2);
    CHECK(OpenHand() == 0);
    for (finger = 1; finger <= 3; finger++)
        CHECK(SendPos(finger, Sent) == 0);
    PAUSE_MS(1500);
    printf("there\n");
    fflush(stdout);
    if (strcmp(arguments[1], "wait") == 0)
        for (;;)
            pause();
    if (strcmp(arguments[1], "_exit") == 0)
        _exit(3);
    if (strcmp(arguments[1], "exit") == 0)
        exit(3);
    return 3;
}
