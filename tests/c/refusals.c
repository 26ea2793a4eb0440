/* Refusals of an open hand: each has its errno and text, and leaves outputs unchanged. The hand keeps running. */
#include <errno.h>
#include <math.h>
#include <string.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"
#include "refused.h"

static float Pos[3] = {0.0f, 0.5f, 0.9f};
static double Kx[3][3] = {{3, 0, 0}, {0, 3, 0}, {0, 0, 3}}, Force[3] = {0, 0, 0};

static void refuses_other_fingers(void)
{
    float Output[3] = {7.0f, 8.0f, 9.0f};
    double OutputD[3] = {7.0, 8.0, 9.0};
    int finger;

    for (finger = -1; finger <= 4; finger += finger == 0 ? 4 : 1) {
        REFUSED(SendPos(finger, Pos), EINVAL, "1, 2 and 3");
        REFUSED(SendKx(finger, Kx), EINVAL, "1, 2 and 3");
        REFUSED(GetPos(finger, Output), EINVAL, "1, 2 and 3");
        REFUSED(GetPos(finger, OutputD), EINVAL, "1, 2 and 3");
        REFUSED(sun2xp_push(HAND, finger, Force), EINVAL, "1, 2 and 3");
    }
    CHECK(Output[0] == 7.0f && Output[1] == 8.0f && Output[2] == 9.0f);
    CHECK(OutputD[0] == 7.0 && OutputD[1] == 8.0 && OutputD[2] == 9.0);
}

static void refuses_what_is_not_finite(void)
{
    Pos[1] = NAN;
    REFUSED(SendPos(1, Pos), EINVAL, "SendPos");
    Pos[1] = -INFINITY;
    REFUSED(SendPos(1, Pos), EINVAL, "Pos");
    Pos[1] = 0.5f;
    Kx[2][1] = NAN;
    REFUSED(SendKx(1, Kx), EINVAL, "Kx");
    Kx[2][1] = 0;
    Force[2] = INFINITY;
    REFUSED(sun2xp_push(HAND, 1, Force), EINVAL, "Force");
}

static void refuses_what_is_out_of_range(void)
{
    Pos[2] = 0.0f;
    REFUSED(SendPos(1, Pos), ERANGE, "joint 2");
    Pos[2] = 2.2f;
    REFUSED(SendPos(1, Pos), ERANGE, "joint 2");
    Kx[0][0] = 6.1;
    REFUSED(SendKx(1, Kx), ERANGE, "Kx");
    Kx[0][0] = 6.0;
    CHECK(SendKx(1, Kx) == 0);
}

static void refuses_what_is_no_spring(void)
{
    Kx[0][1] = 0.01;
    REFUSED(SendKx(1, Kx), EDOM, "symmetric");
    Kx[0][1] = 0.005;
    CHECK(SendKx(1, Kx) == 0);
    Kx[0][1] = 0;
    Kx[2][2] = -0.1;
    REFUSED(SendKx(1, Kx), EDOM, "eigenvalue");
    Kx[2][2] = -0.005;
    CHECK(SendKx(1, Kx) == 0);
    Kx[2][2] = 0;
    CHECK(SendKx(1, Kx) == 0);
    memset(Kx, 0, sizeof Kx);
    CHECK(SendKx(1, Kx) == 0);
}

static void leaves_a_refused_struct_alone(void)
{
    struct sun2xp_status Status, Untouched;

    memset(&Status, 7, sizeof Status);
    Status.size = 8;
    Untouched = Status;
    REFUSED(sun2xp_status(HAND, 1, &Status), EINVAL, "size");
    Status.size = Untouched.size = sizeof Status;
    REFUSED(sun2xp_status(HAND, 0, &Status), EINVAL, "1, 2 and 3");
    CHECK(memcmp(&Status, &Untouched, sizeof Status) == 0);
}

int main(void)
{
    const float Fine[3] = {0.0f, 0.5f, 0.9f};
    float Output[3] = {7.0f, 8.0f, 9.0f};

    CHECK(strcmp(HandError(), "") == 0);
    CHECK(OpenHand() == 0);
    CHECK(strcmp(HandError(), "") == 0);
    refuses_other_fingers();
    refuses_what_is_not_finite();
    refuses_what_is_out_of_range();
    refuses_what_is_no_spring();
    leaves_a_refused_struct_alone();

    errno = 0;
    REFUSED(OpenHand(), EBUSY, "already open");
    CHECK(SendPos(1, Fine) == 0);
    CHECK(GetPos(1, Output) == 0);
    CHECK(Output[0] != 7.0f);
    CHECK(CloseHand() == 0);
    return 0;
}
