/* Each argument of a call is evaluated once. A compound literal can be an argument, and a call can be the body of an if
   without braces. The program needs C99 or a later standard. */
#include <stddef.h>
#include "Sun2Xp.h"
#include "check.h"

int main(void)
{
    float Poses[2][3] = {{0.0f, 0.5f, 0.9f}, {0.1f, 0.5f, 0.9f}};
    float Received[2][3];
    float (*Row)[3] = Poses, (*Into)[3] = Received;
    int finger = 1;

    CHECK(OpenHand() == 0);
    CHECK(SendPos(finger++, *Row++) == 0);
    CHECK(finger == 2 && Row == Poses + 1);
    CHECK(GetPos(finger++, *Into++) == 0);
    CHECK(finger == 3 && Into == Received + 1);
    CHECK(SendPos(1, (double[]){0.0, 0.5, 0.9}) == 0);
    CHECK(SendKx(1, (float[3][3]){{3, 0, 0}, {0, 3, 0}, {0, 0, 3}}) == 0);
    if (finger == 3)
        SendPos(1, Poses[0]);
    else
        SendPos(1, Poses[1]);
    CHECK(CloseHand() == 0);
    return 0;
}
