/* Tests the effects and the refusals of sun2xp_send_tip, sun2xp_tip, sun2xp_send_contact, sun2xp_send_damping and
   sun2xp_adjust, and the effect of sun2xp_push. */
#include <errno.h>
#include <string.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"
#include "refused.h"

static double square_of_distance(const double *One, const double *Other)
{
    double x = One[0] - Other[0], y = One[1] - Other[1], z = One[2] - Other[2];

    return x * x + y * y + z * z;
}

/* Waits until the tip is within 1 mm of the wanted position. */
static void arrive(int finger, const double *Wanted, struct sun2xp_tip *Tip)
{
    int tries;

    for (tries = 0; tries < 500; tries++) {
        CHECK(sun2xp_tip(HAND, finger, Tip) == 0);
        if (square_of_distance(Tip->position, Wanted) < 0.01)
            return;
        PAUSE_MS(20);
    }
    fprintf(stderr, "the tip is at %g %g %g\n", Tip->position[0], Tip->position[1], Tip->position[2]);
    exit(1);
}

static struct { struct sun2xp_tip Known; unsigned char Later[64]; } Larger;
static struct sun2xp_tip *const Tip = &Larger.Known;
static double Wanted[3] = {1.0, -6.0, 8.0}, Nan[3] = {0, 0, 0};
static double Soft[4][4] = {{3, 0, 0, 0}, {0, 3, 0, 0}, {0, 0, 3, 0}, {0, 0, 0, 20}};
static double Hard[9] = {3, 0.5, 0, 0.5, 3, 0, 0, 0, 3}, Normal[3] = {0, -2, 0}, Point = 3.0;

static void without_a_hand(void)
{
    Tip->size = sizeof Larger;
    REFUSED(sun2xp_send_tip(HAND, 1, Wanted), ENODEV, "sun2xp_open");
    REFUSED(sun2xp_tip(HAND, 1, Tip), ENODEV, "sun2xp_open");
    REFUSED(sun2xp_send_contact(HAND, 1, 3, Hard, NULL), ENODEV, "sun2xp_open");
    REFUSED(sun2xp_send_contact(HAND, 1, 2, Hard, NULL), ENODEV, "sun2xp_open");
    REFUSED(sun2xp_send_damping(HAND, 1, 1.0), ENODEV, "sun2xp_open");
    REFUSED(sun2xp_adjust(HAND, 1, "tendon.minimum = 6"), ENODEV, "sun2xp_open");
    REFUSED(sun2xp_send_tip(HAND, 1, NULL), EFAULT, "tip");
    REFUSED(sun2xp_tip(HAND, 1, NULL), EFAULT, "tip");
    REFUSED(sun2xp_send_contact(HAND, 1, 3, NULL, Normal), EFAULT, "stiffness is");
    REFUSED(sun2xp_send_contact(HAND, 1, 4, &Soft[0][0], NULL), EFAULT, "normal");
    REFUSED(sun2xp_send_contact(HAND, 1, 1, &Point, NULL), EFAULT, "normal");
    REFUSED(sun2xp_adjust(HAND, 1, NULL), EFAULT, "keys");
}

static void fingertip(void)
{
    double Far[3] = {0.0, 0.0, 14.0}, Near[3] = {0.0, 0.0, 4.0}, Behind[3] = {9.0, -2.0, -6.0};
    struct sun2xp_tip Untouched;
    int byte;

    CHECK(sun2xp_send_tip(HAND, 1, Wanted) == 0);
    memset(&Larger, 0x55, sizeof Larger);
    Tip->size = sizeof Larger;
    arrive(1, Wanted, Tip);
    CHECK(Tip->size == sizeof Larger);
    for (byte = 0; byte < 64; byte++)
        CHECK(Larger.Later[byte] == 0);
    CHECK(Tip->force_directions == 3);
    CHECK(Tip->tensions[0] > 3.0 && Tip->tensions[0] < 60.0);
    CHECK(APART(Tip->stiffness[0][0], 3.0) < 1e-6 && APART(Tip->stiffness[2][0], 0.0) < 1e-6);

    Untouched = *Tip;
    REFUSED(sun2xp_send_tip(HAND, 4, Wanted), EINVAL, "1, 2 and 3");
    REFUSED(sun2xp_send_tip(HAND, 1, Nan), EINVAL, "Tip");
    REFUSED(sun2xp_send_tip(HAND, 1, Far), ERANGE, "outstretched");
    REFUSED(sun2xp_send_tip(HAND, 1, Near), ERANGE, "folded");
    REFUSED(sun2xp_send_tip(HAND, 1, Behind), ERANGE, "joint 0");
    REFUSED(sun2xp_tip(HAND, 0, Tip), EINVAL, "1, 2 and 3");
    Tip->size = Untouched.size = 8;
    REFUSED(sun2xp_tip(HAND, 1, Tip), EINVAL, "tip->size");
    CHECK(memcmp(Tip, &Untouched, sizeof Untouched) == 0);
    Tip->size = sizeof *Tip;
}

/* The tip at Wanted is 8.06 cm from the axis of joint 0. No other joint turns the tip about y, so 20 N cm/rad about y
   are 0.31 N/cm at this distance. */
static void soft_finger(void)
{
    double Turned = 20.0 / 65.0;
    int tries;

    CHECK(sun2xp_send_contact(HAND, 1, 4, &Soft[0][0], Normal) == 0);
    for (tries = 0; tries < 250; tries++) {
        CHECK(sun2xp_tip(HAND, 1, Tip) == 0);
        if (APART(Tip->stiffness[0][0], 3.0 + Turned * 64 / 65) < 0.02)
            break;
        PAUSE_MS(20);
    }
    CHECK(tries < 250);
    CHECK(APART(Tip->stiffness[0][2], -Turned * 8 / 65) < 0.02);
    CHECK(APART(Tip->stiffness[0][2], Tip->stiffness[2][0]) < 1e-9);
    CHECK(APART(Tip->stiffness[1][1], 3.0) < 1e-6 && APART(Tip->stiffness[2][2], 3.0 + Turned / 65) < 0.02);
}

static void contact(void)
{
    double Skewed[9] = {3, 0.5, 0, 0, 3, 0, 0, 0, 3}, Nothing[3] = {0, 0, 0};
    double Lengths[9] = {-1, 1e-323, 1e-170, -1e-150, 1e-7, 1e154, 1e160, -1e200, 1.7e308};
    int length;

    CHECK(sun2xp_send_contact(HAND, 1, 4, &Soft[0][0], Normal) == 0);
    CHECK(sun2xp_send_contact(HAND, 1, 1, &Point, Normal) == 0);
    CHECK(sun2xp_send_contact(HAND, 1, 3, Hard, NULL) == 0);
    REFUSED(sun2xp_send_contact(HAND, 4, 3, Hard, NULL), EINVAL, "1, 2 and 3");
    REFUSED(sun2xp_send_contact(HAND, 1, 2, Hard, Normal), EINVAL, "2 dimensions");
    REFUSED(sun2xp_send_contact(HAND, 1, 4, &Soft[0][0], Nothing), EDOM, "the normal is zero");
    REFUSED(sun2xp_send_contact(HAND, 1, 4, &Soft[0][0], Nan), EINVAL, "finite");
    REFUSED(sun2xp_send_contact(HAND, 1, 3, Skewed, NULL), EDOM, "symmetric");
    Soft[3][3] = -1;
    REFUSED(sun2xp_send_contact(HAND, 1, 4, &Soft[0][0], Normal), EDOM, "eigenvalue");
    Soft[3][3] = 1000;
    for (length = 0; length < 9; length++) {
        Normal[1] = Lengths[length];
        CHECK(sun2xp_send_contact(HAND, 1, 1, &Point, Normal) == 0);
        REFUSED(sun2xp_send_contact(HAND, 1, 4, &Soft[0][0], Normal), ERANGE, "bound");
    }
}

static void damping(void)
{
    double Stiff[3][3] = {{6, 0, 0}, {0, 6, 0}, {0, 0, 6}};
    int refused;

    CHECK(sun2xp_send_damping(HAND, 1, 0.8) == 0);
    CHECK(sun2xp_send_damping(HAND, 1, 1.4) == 0);
    refused = SendKx(1, Stiff); /* without REFUSED, whose string would be longer than C89 guarantees */
    CHECK(refused < 0 && errno == ERANGE && strstr(HandError(), "0.94 to 1.00") != NULL);
    CHECK(sun2xp_send_damping(HAND, 1, 1.0) == 0);
    CHECK(SendKx(1, Stiff) == 0);
    REFUSED(sun2xp_send_damping(HAND, 1, 1.5), ERANGE, "0.94 to 1.00");
    CHECK(SendKx(1, Hard) == 0);
    REFUSED(sun2xp_send_damping(HAND, 4, 1.0), EINVAL, "1, 2 and 3");
    REFUSED(sun2xp_send_damping(HAND, 1, 0.1), ERANGE, "0.72 to 1.43");
    REFUSED(sun2xp_send_damping(HAND, 1, Nan[1]), EINVAL, "Ratio");
}

static void adjustment(void)
{
    int tries, tendon;

    REFUSED(sun2xp_adjust(HAND, 4, "tendon.minimum = 6"), EINVAL, "1, 2 and 3");
    REFUSED(sun2xp_adjust(HAND, 1, "tendon.minimum = "), EINVAL, "line 1");
    REFUSED(sun2xp_adjust(HAND, 1, "tendon.minimum = 6\ntendon.maximum = 7"), EINVAL, "tendon.maximum");
    REFUSED(sun2xp_adjust(HAND, 1, "priority = 3"), EBUSY, "priority");
    REFUSED(sun2xp_adjust(HAND, 1, "joints.maximum_degrees = [60, 40, 40]"), ERANGE, "sent last");
    REFUSED(sun2xp_adjust(HAND, 1, "tendon.minimum = 6\n\377"), EINVAL,
        "line 2 of the keys to adjust: the line is not UTF-8");
    CHECK(sun2xp_adjust(HAND, 1, "tendon.minimum = 8\ncontroller.tension_gain = 3") == 0);
    for (tries = 0; tries < 250; tries++) {
        CHECK(sun2xp_tip(HAND, 1, Tip) == 0);
        for (tendon = 0; tendon < 4 && Tip->tensions[tendon] > 7.0; tendon++)
            ;
        if (tendon == 4)
            break;
        PAUSE_MS(20);
    }
    CHECK(tries < 250);
}

static void force(void)
{
    double Force[3] = {0, 0, -1};
    int tries;

    CHECK(sun2xp_push(HAND, 1, Force) == 0);
    for (tries = 0; tries < 250; tries++) {
        CHECK(sun2xp_tip(HAND, 1, Tip) == 0);
        if (Tip->force[2] > 0.6 && Tip->force[2] < 1.4 && APART(Tip->force[0], 0.0) < 0.4)
            break;
        PAUSE_MS(20);
    }
    CHECK(tries < 250);
}

int main(void)
{
    Nan[1] = strtod("nan", NULL);
    without_a_hand();
    CHECK(OpenHand() == 0);
    fingertip();
    soft_finger();
    contact();
    damping();
    adjustment();
    force();
    CHECK(CloseHand() == 0);
    return 0;
}
