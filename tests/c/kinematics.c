/* Tests the calls for kinematics, joint torques, the palm pose, limits and gravity. */
#include <string.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"
#include "refused.h"

int main(void)
{
    static double Pos[3] = {0.2, 0.6, 1.1}, Far[3] = {0, 0, 999}, Down[3] = {9.81, 0, 0};
    double Tip[3], Found[3], J[3][3], Moved[3], Other[3];
    struct sun2xp_joint_torques Torques;
    struct sun2xp_palm_pose Pose;
    struct sun2xp_limits Limits;
    struct sun2xp_tip Fingertip;
    int joint, axis;

    CHECK(OpenHand() == 0);
    CHECK(SendPosD(1, Pos) == 0);
    CHECK(sun2xp_wait(HAND, 1, SUN2XP_WAIT_SETTLED, 20.0) == 0);
    CHECK(sun2xp_forward_kinematics(HAND, 1, Pos, Tip) == 0);
    CHECK(sun2xp_inverse_kinematics(HAND, 1, Tip, Found) == 0);
    for (joint = 0; joint < 3; joint++)
        CHECK(APART(Found[joint], Pos[joint]) < 1e-9);
    REFUSED(sun2xp_inverse_kinematics(HAND, 1, Far, Found), ERANGE, "999");
    CHECK(sun2xp_jacobian(HAND, 1, Pos, &J[0][0]) == 0);
    for (joint = 0; joint < 3; joint++) {
        memcpy(Moved, Pos, sizeof Moved);
        Moved[joint] += 1e-6;
        CHECK(sun2xp_forward_kinematics(HAND, 1, Moved, Other) == 0);
        for (axis = 0; axis < 3; axis++)
            CHECK(APART((Other[axis] - Tip[axis]) * 1e6, J[axis][joint]) < 1e-4);
    }
    CHECK(sun2xp_jacobian(HAND, 1, NULL, &J[0][0]) == 0);
    Torques.size = sizeof Torques;
    CHECK(sun2xp_joint_torques(HAND, 1, &Torques) == 0 && Torques.size == sizeof Torques);
    CHECK(APART(Torques.measured[1], Torques.commanded[1]) < 5.0);
    Pose.size = sizeof Pose;
    Fingertip.size = sizeof Fingertip;
    CHECK(sun2xp_palm_pose(HAND, 1, &Pose) == 0 && sun2xp_tip(HAND, 1, &Fingertip) == 0);
    for (axis = 0; axis < 3; axis++) {
        double tip = Pose.base[axis];

        for (joint = 0; joint < 3; joint++)
            tip += Pose.rotation[axis][joint] * Fingertip.position[joint];
        CHECK(APART(tip, Pose.tip[axis]) < 0.1);
    }
    REFUSED(sun2xp_wait(HAND, 1, 3, 1.0), EINVAL, "condition 3");
    REFUSED(sun2xp_wait(HAND, 1, 1, -1.0), EINVAL, "limit");
    Limits.size = sizeof Limits;
    CHECK(sun2xp_limits(HAND, 1, &Limits) == 0 && Limits.stiffness == 6.0);
    CHECK(APART(Limits.joint_maximum[1], 1.7453) < 1e-4);
    CHECK(sun2xp_set_gravity(HAND, Down) == 0);
    REFUSED(sun2xp_set_gravity(HAND, Far), EINVAL, "gravity");
    CHECK(SendPosD(1, Found) == 0);
    CHECK(sun2xp_wait(HAND, SUN2XP_ALL_FINGERS, SUN2XP_WAIT_ARRIVED, 0.0) < 0 && errno == ETIMEDOUT);
    CHECK(CloseHand() == 0);
    return 0;
}
