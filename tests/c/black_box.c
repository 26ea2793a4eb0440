/* A planner that writes the black box of a finger. */
#include "Sun2Xp.h"
#include "check.h"
#include <errno.h>
#include <string.h>

int main(int argc, char **argv)
{
    double Pos[3] = {0.1, 0.5, 1.1}, Time = 0.0;
    struct FingerRecord Record;
    unsigned long Cycle, Newest;

    CHECK(argc == 2);
    errno = 0;
    CHECK(WriteBlackBox(1, argv[1]) == -1 && errno == ENODEV);
    CHECK(OpenHand() == 0);
    CHECK(SendPosD(1, Pos) == 0);
    PAUSE_MS(500);
    Record.Size = sizeof Record;
    CHECK(GetRecord(1, 0, &Record) == 0);
    CHECK(Record.Cycle == Record.Newest && Record.Oldest < Record.Newest && Record.State == FINGER_RUNNING);
    CHECK(Record.Computed && Record.Follows && Record.PosSent[2] == Pos[2] && Record.Tension[3] > 1.0);
    Newest = Record.Newest;
    for (Cycle = Record.Oldest; Cycle <= Newest; Cycle++) {
        CHECK(GetRecord(1, Cycle, &Record) == 0 && Record.Cycle == Cycle && Record.Time > Time);
        Time = Record.Time;
    }
    errno = 0;
    CHECK(GetRecord(1, Newest + 1000000, &Record) == -1 && errno == ENOENT);
    CHECK(GetRecord(4, 0, &Record) == -1 && errno == EINVAL);
    CHECK(GetRecord(1, 0, NULL) == -1 && errno == EFAULT);
    Record.Size = sizeof Record - 1;
    CHECK(GetRecord(1, 0, &Record) == -1 && errno == EINVAL);
    CHECK(WriteBlackBox(1, argv[1]) == 0);
    CHECK(WriteBlackBox(1, NULL) == -1 && errno == EFAULT);
    CHECK(WriteBlackBox(0, argv[1]) == -1 && errno == EINVAL);
    CHECK(WriteBlackBox(1, "no/such/folder/file") == -1 && errno == ENOENT);
    CHECK(strstr(HandError(), "no/such/folder/file") != NULL);
    return CloseHand();
}
