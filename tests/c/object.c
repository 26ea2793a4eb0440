/* GetObject: its result for a ball on a table, and every refusal. With the argument "none" no object is configured. */
#include <string.h>
#include "Sun2Xp.h"
#include "check.h"
#include "refused.h"

static struct { struct ObjectState Known; unsigned char Later[32]; } Larger;

int main(int argc, char **argv)
{
    struct ObjectState *Object = &Larger.Known;
    int axis, other;

    REFUSED(GetObject(NULL), EFAULT, "Object");
    REFUSED(GetObject(Object), ENODEV, "OpenHand");
    CHECK(OpenHand() == 0);
    Object->Size = sizeof *Object - 1;
    REFUSED(GetObject(Object), EINVAL, "Object->Size");
    /* The struct of a later version is larger. */
    Object->Size = sizeof Larger;
    if (argc > 1 && strcmp(argv[1], "none") == 0) {
        REFUSED(GetObject(Object), ENOTSUP, "simulated_object");
        CHECK(CloseHand() == 0);
        return 0;
    }
    CHECK(GetObject(Object) == 0);
    CHECK(Object->Size == sizeof *Object && Object->Touching == 0 && Object->Time > 0);
    CHECK(APART(Object->Position[0], 0) < 1e-6 && APART(Object->Position[1], 0) < 1e-6);
    CHECK(APART(Object->Position[2], 20) < 0.1);
    for (axis = 0; axis < 3; axis++) {
        CHECK(APART(Object->Velocity[axis], 0) < 2 && APART(Object->Spin[axis], 0) < 1e-6);
        for (other = 0; other < 3; other++) {
            CHECK(APART(Object->Rotation[axis][other], axis == other) < 1e-6);
            CHECK(Object->Force[axis][other] == 0);
        }
    }
    CHECK(CloseHand() == 0);
    REFUSED(GetObject(Object), ENODEV, "OpenHand");
    return 0;
}
