/* GetJacobian, FindTip, FindPos, GetJointTorques, GetPalmPose. */
#include <string.h>
#include "Sun2Xp.h"
#include "check.h"
#include "refused.h"

int main(void)
{
    static double Pos[3] = {0.2, 0.6, 1.1}, Far[3] = {0, 0, 999}, Down[3] = {9.81, 0, 0};
    double Tip[3], Found[3], J[3][3], Moved[3], Other[3];
    struct JointTorques Torques;
    struct PalmPose Pose;
    struct FingerTip Fingertip;
    int joint, axis, Fingers[1] = {1};

    CHECK(OpenHand() == 0);
    CHECK(SendPosD(1, Pos) == 0);
    CHECK(WaitFingers(1, Fingers, WAIT_SETTLED, 20.0) == 0);
    CHECK(FindTip(1, Pos, Tip) == 0);
    CHECK(FindPos(1, Tip, Found) == 0);
    for (joint = 0; joint < 3; joint++)
        CHECK(APART(Found[joint], Pos[joint]) < 1e-9);
    REFUSED(FindPos(1, Far, Found), ERANGE, "999");
    CHECK(GetJacobian(1, Pos, &J[0][0]) == 0);
    for (joint = 0; joint < 3; joint++) {
        memcpy(Moved, Pos, sizeof Moved);
        Moved[joint] += 1e-6;
        CHECK(FindTip(1, Moved, Other) == 0);
        for (axis = 0; axis < 3; axis++)
            CHECK(APART((Other[axis] - Tip[axis]) * 1e6, J[axis][joint]) < 1e-4);
    }
    CHECK(GetJacobian(1, NULL, &J[0][0]) == 0);
    Torques.Size = sizeof Torques;
    CHECK(GetJointTorques(1, &Torques) == 0 && Torques.Size == sizeof Torques);
    CHECK(APART(Torques.Measured[1], Torques.Commanded[1]) < 5.0);
    Pose.Size = sizeof Pose;
    Fingertip.Size = sizeof Fingertip;
    CHECK(GetPalmPose(1, &Pose) == 0 && GetTip(1, &Fingertip) == 0);
    for (axis = 0; axis < 3; axis++) {
        double tip = Pose.Base[axis];

        for (joint = 0; joint < 3; joint++)
            tip += Pose.Rotation[axis][joint] * Fingertip.Tip[joint];
        CHECK(APART(tip, Pose.Tip[axis]) < 0.1);
    }
    REFUSED(WaitFingers(1, Fingers, 3, 1.0), EINVAL, "condition 3");
    REFUSED(WaitFingers(1, Fingers, 1, -1.0), EINVAL, "limit");
    CHECK(SetGravity(Down) == 0);
    REFUSED(SetGravity(Far), EINVAL, "gravity");
    CHECK(SendPosD(1, Found) == 0);
    CHECK(WaitFingers(0, Fingers, WAIT_ARRIVED, 0.0) == 0);
    CHECK(CloseHand() == 0);
    return 0;
}
