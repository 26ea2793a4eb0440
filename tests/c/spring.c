/* Tests sun2xp_send_joint_stiffness and sun2xp_send_joint_torque: the deflection of a joint, and the refusals. */
#include <string.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"
#include "refused.h"

/* Waits until the finger rests, and returns how far a joint is from its set point, rad. */
static double deflection(int joint, const double *Pos)
{
    double Now[3];

    PAUSE_MS(300);
    CHECK(sun2xp_wait(HAND, 1, SUN2XP_WAIT_SETTLED, 20.0) == 0);
    CHECK(GetPosD(1, Now) == 0);
    return Now[joint] - Pos[joint];
}

int main(void)
{
    static double Pos[3] = {0.2, 0.6, 1.1}, Zero[3], Torque[3] = {0, 6, 0}, Much[3] = {0, 1e4, 0};
    static double K[9] = {60, 0, 0, 0, 60, 0, 0, 0, 40}, Rigid[9] = {1e5, 0, 0, 0, 60, 0, 0, 0, 40};
    static double Skew[9] = {60, 20, 0, 0, 60, 0, 0, 0, 40}, Kx[9] = {3, 0, 0, 0, 3, 0, 0, 0, 3};
    double moved;

    CHECK(OpenHand() == 0);
    CHECK(SendPosD(1, Pos) == 0);
    CHECK(sun2xp_wait(HAND, 1, SUN2XP_WAIT_SETTLED, 20.0) == 0);
    CHECK(sun2xp_send_joint_stiffness(HAND, 1, K) == 0);
    CHECK(sun2xp_send_joint_torque(HAND, 1, Torque) == 0);
    /* 6 N cm turn a joint of 60 N cm/rad by 0.1 rad, or by somewhat more or less because of the joint's friction. */
    moved = deflection(1, Pos);
    CHECK(moved > 0.06 && moved < 0.14);
    CHECK(sun2xp_send_joint_torque(HAND, 1, Zero) == 0);
    moved = deflection(1, Pos);
    CHECK(APART(moved, 0.0) < 0.04);
    REFUSED(sun2xp_send_joint_stiffness(HAND, 1, Skew), EDOM, "symmetric");
    REFUSED(sun2xp_send_joint_stiffness(HAND, 1, Rigid), ERANGE, "bound of 96");
    REFUSED(sun2xp_send_joint_torque(HAND, 1, Much), ERANGE, "joint 1");
    REFUSED(sun2xp_send_joint_stiffness(HAND, 1, NULL), EFAULT, "stiffness is");
    CHECK(SendKxD(1, Kx) == 0);
    CHECK(CloseHand() == 0);
    return 0;
}
