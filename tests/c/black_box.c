/* A planner that writes the black box of a finger. */
#include "Sun2Xp.h"
#include "check.h"
#include <errno.h>
#include <string.h>

int main(int argc, char **argv)
{
    double Pos[3] = {0.1, 0.5, 1.1};

    CHECK(argc == 2);
    errno = 0;
    CHECK(WriteBlackBox(1, argv[1]) == -1 && errno == ENODEV);
    CHECK(OpenHand() == 0);
    CHECK(SendPosD(1, Pos) == 0);
    PAUSE_MS(500);
    CHECK(WriteBlackBox(1, argv[1]) == 0);
    CHECK(WriteBlackBox(1, NULL) == -1 && errno == EFAULT);
    CHECK(WriteBlackBox(0, argv[1]) == -1 && errno == EINVAL);
    CHECK(WriteBlackBox(1, "no/such/folder/file") == -1 && errno == ENOENT);
    CHECK(strstr(HandError(), "no/such/folder/file") != NULL);
    return CloseHand();
}
