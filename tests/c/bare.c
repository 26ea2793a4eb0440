/* Opens the hand while the three standard descriptors are closed. No port may take their numbers: otherwise, messages
   to standard error would go to a board. */
#include <sys/stat.h>
#include <unistd.h>
#include "Sun2Xp.h"
#include "check.h"

int main(void)
{
    struct stat null, standard;
    float Pos[3], Wrong[3] = {0, 0, 9};
    int descriptor, round;

    CHECK(stat("/dev/null", &null) == 0);
    for (round = 0; round < 2; round++) {
        for (descriptor = 0; descriptor < 3; descriptor++)
            close(descriptor);
        CHECK(OpenHand() == 0);
        for (descriptor = 0; descriptor < 3; descriptor++) {
            CHECK(fstat(descriptor, &standard) == 0);
            CHECK(standard.st_rdev == null.st_rdev);
        }
        CHECK(SendPos(1, Wrong) == -1);
        CHECK(GetPos(1, Pos) == 0);
        CHECK(CloseHand() == 0);
    }
    return 0;
}
