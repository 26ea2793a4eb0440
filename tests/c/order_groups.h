/* order_groups.h - the part of order.c for groups and kinematics: wrong values on a faulted finger. */

static void wrong_groups(void)
{
    Command[0].Finger = Command[1].Finger = 1;
    REFUSED("SendGroup", SendGroup(2, Command), "two commands");
    Command[1].Finger = 2;
    Command[0].Pos = FarPos;
    Command[0].Tip = FarTip;
    REFUSED("SendGroup", SendGroup(2, Command), "Pos and Tip");
    Command[0].Tip = NULL;
    Command[0].Pos = NanPos;
    REFUSED("SendGroup", SendGroup(2, Command), "NaN");
    Command[0].Pos = Pos;
    Command[0].Kx = three(Skew);
    REFUSED("SendGroup", SendGroup(2, Command), "symmetric");
    Command[0].Kx = three(Stiff);
    REFUSED("SendGroup", SendGroup(2, Command), "bound");
    Command[0].Kx = three(Soft);
    REFUSED("SendGroup", SendGroup(2, Command), "stop");
}

static void wrong_kinematics(void)
{
    Fingers[0] = 1;
    REFUSED("SetGravity", SetGravity(StrongForce), "gravity");
    REFUSED("SetGravity", SetGravity(Force), "stop");
    REFUSED("WaitFingers", WaitFingers(1, Fingers, 9, NAN), "condition 9");
    REFUSED("WaitFingers", WaitFingers(1, Fingers, 1, NAN), "limit");
    REFUSED("WaitFingers", WaitFingers(1, Fingers, 1, 1.0), "stop");
    REFUSED("GetJacobian", GetJacobian(1, NanPos, J), "NaN");
    REFUSED("GetJacobian", GetJacobian(1, NULL, J), "stop");
    REFUSED("FindTip", FindTip(1, NanPos, Tip), "NaN");
    REFUSED("FindPos", FindPos(1, NanTip, Pos), "NaN");
    REFUSED("FindPos", FindPos(1, FarTip, Pos), "99");
    REFUSED("GetJointTorques", GetJointTorques(1, &Torques), "stop");
    REFUSED("GetPalmPose", GetPalmPose(1, &Pose), "stop");
}
