/* A planner that writes the black box of a finger. */
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"
#include <errno.h>
#include <string.h>

int main(int argc, char **argv)
{
    double Pos[3] = {0.1, 0.5, 1.1}, Time = 0.0;
    struct sun2xp_record Record;
    unsigned long Cycle, Newest;

    CHECK(argc == 2);
    errno = 0;
    CHECK(sun2xp_write_black_box(HAND, 1, argv[1]) < 0 && errno == ENODEV);
    CHECK(OpenHand() == 0);
    CHECK(SendPosD(1, Pos) == 0);
    PAUSE_MS(500);
    Record.size = sizeof Record;
    CHECK(sun2xp_record(HAND, 1, 0, &Record) == 0);
    CHECK(Record.cycle == Record.newest && Record.oldest < Record.newest && Record.state == SUN2XP_STATE_RUNNING);
    CHECK(Record.computed && Record.follows && Record.position_sent[2] == Pos[2] && Record.tension[3] > 1.0);
    Newest = Record.newest;
    for (Cycle = Record.oldest; Cycle <= Newest; Cycle++) {
        CHECK(sun2xp_record(HAND, 1, Cycle, &Record) == 0 && Record.cycle == Cycle && Record.time > Time);
        Time = Record.time;
    }
    errno = 0;
    CHECK(sun2xp_record(HAND, 1, Newest + 1000000, &Record) < 0 && errno == ENOENT);
    CHECK(sun2xp_record(HAND, 4, 0, &Record) < 0 && errno == EINVAL);
    CHECK(sun2xp_record(HAND, 1, 0, NULL) < 0 && errno == EFAULT);
    Record.size = sizeof Record - 1;
    CHECK(sun2xp_record(HAND, 1, 0, &Record) < 0 && errno == EINVAL);
    CHECK(sun2xp_write_black_box(HAND, 1, argv[1]) == 0);
    CHECK(sun2xp_write_black_box(HAND, 1, NULL) < 0 && errno == EFAULT);
    CHECK(sun2xp_write_black_box(HAND, 0, argv[1]) < 0 && errno == EINVAL);
    CHECK(sun2xp_write_black_box(HAND, 1, "no/such/folder/file") < 0 && errno == ENOENT);
    CHECK(strstr(HandError(), "no/such/folder/file") != NULL);
    return CloseHand();
}
