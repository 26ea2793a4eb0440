/* Opens the hand. If this fails, prints the error on standard output and ends. Otherwise makes calls that are refused,
   before and after it closes the hand. */
#include <errno.h>
#include <string.h>
#include "Sun2Xp.h"
#include "check.h"

int main(void)
{
    const float Straight[3] = {0.0f, 0.0f, 0.0f}, Fine[3] = {0.0f, 0.5f, 0.9f};
    int opened = OpenHand();
    int failure = errno, round;

    if (opened != 0) {
        printf("%s: %s\n", strerror(failure), HandError());
        return 2;
    }
    for (round = 0; round < 3; round++) {
        SendPos(1, Straight);
        SendPos(2, Straight);
        SendPos(7, Fine);
    }
    CHECK(CloseHand() == 0);
    SendPos(1, Fine);
    SendPos(1, Fine);
    return 0;
}
