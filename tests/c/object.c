/* Tests the result of sun2xp_object for a ball on a table, and refusals of this call. With the argument "none", no
   object is configured. */
#include <string.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"
#include "refused.h"

static struct { struct sun2xp_object Known; unsigned char Later[32]; } Larger;

int main(int argc, char **argv)
{
    struct sun2xp_object *Object = &Larger.Known;
    int axis, other;

    REFUSED(sun2xp_object(HAND, NULL), EFAULT, "object");
    REFUSED(sun2xp_object(HAND, Object), ENODEV, "sun2xp_open");
    CHECK(OpenHand() == 0);
    Object->size = sizeof *Object - 1;
    REFUSED(sun2xp_object(HAND, Object), EINVAL, "object->size");
    /* The struct of a later version is larger. */
    Object->size = sizeof Larger;
    if (argc > 1 && strcmp(argv[1], "none") == 0) {
        REFUSED(sun2xp_object(HAND, Object), ENOTSUP, "simulated_object");
        CHECK(CloseHand() == 0);
        return 0;
    }
    CHECK(sun2xp_object(HAND, Object) == 0);
    CHECK(Object->size == sizeof Larger && Object->touching == 0 && Object->time > 0);
    CHECK(APART(Object->position[0], 0) < 1e-6 && APART(Object->position[1], 0) < 1e-6);
    CHECK(APART(Object->position[2], 20) < 0.1);
    for (axis = 0; axis < 3; axis++) {
        CHECK(APART(Object->velocity[axis], 0) < 2 && APART(Object->angular_velocity[axis], 0) < 1e-6);
        for (other = 0; other < 3; other++) {
            CHECK(APART(Object->rotation[axis][other], axis == other) < 1e-6);
            CHECK(Object->force[axis][other] == 0);
        }
    }
    CHECK(CloseHand() == 0);
    REFUSED(sun2xp_object(HAND, Object), ENODEV, "sun2xp_open");
    return 0;
}
