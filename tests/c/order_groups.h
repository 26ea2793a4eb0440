/* order_groups.h - the part of order.c for groups and kinematics. The finger is faulted by an emergency stop. */

static void wrong_groups(void)
{
    Command[0].finger = Command[1].finger = 1;
    REFUSED("sun2xp_send_group", sun2xp_send_group(HAND, 2, Command), "two commands");
    Command[1].finger = 2;
    Command[0].position = FarPos;
    Command[0].tip = FarTip;
    REFUSED("sun2xp_send_group", sun2xp_send_group(HAND, 2, Command), "position of the tip");
    Command[0].tip = NULL;
    Command[1].stiffness = Nan[0];
    Command[0].position = FarPos;
    REFUSED("sun2xp_send_group", sun2xp_send_group(HAND, 2, Command), "NaN");
    Command[0].stiffness = three(Nan);
    Command[1].stiffness = NULL;
    REFUSED("sun2xp_send_group", sun2xp_send_group(HAND, 2, Command), "NaN");
    Command[0].position = NanPos;
    REFUSED("sun2xp_send_group", sun2xp_send_group(HAND, 2, Command), "NaN");
    Command[0].position = Pos;
    Command[0].stiffness = three(Skew);
    REFUSED("sun2xp_send_group", sun2xp_send_group(HAND, 2, Command), "symmetric");
    Command[0].stiffness = three(Stiff);
    REFUSED("sun2xp_send_group", sun2xp_send_group(HAND, 2, Command), "bound");
    Command[0].stiffness = three(Soft);
    Command[1].position = FarPos;
    REFUSED("sun2xp_send_group", sun2xp_send_group(HAND, 2, Command), "limits");
    Command[1].position = NULL;
    REFUSED("sun2xp_send_group", sun2xp_send_group(HAND, 2, Command), "stop");
}

static void wrong_kinematics(void)
{
    REFUSED("sun2xp_set_gravity", sun2xp_set_gravity(HAND, StrongForce), "gravity");
    REFUSED("sun2xp_set_gravity", sun2xp_set_gravity(HAND, Force), "stop");
    REFUSED("sun2xp_wait", sun2xp_wait(HAND, 1, 9, NAN), "condition 9");
    REFUSED("sun2xp_wait", sun2xp_wait(HAND, 1, 1, NAN), "limit");
    REFUSED("sun2xp_wait", sun2xp_wait(HAND, 1, 1, 1.0), "stop");
    REFUSED("sun2xp_jacobian", sun2xp_jacobian(HAND, 1, NanPos, J), "NaN");
    REFUSED("sun2xp_jacobian", sun2xp_jacobian(HAND, 1, NULL, J), "stop");
    REFUSED("sun2xp_forward_kinematics", sun2xp_forward_kinematics(HAND, 1, NanPos, Tip), "NaN");
    REFUSED("sun2xp_inverse_kinematics", sun2xp_inverse_kinematics(HAND, 1, NanTip, Pos), "NaN");
    REFUSED("sun2xp_inverse_kinematics", sun2xp_inverse_kinematics(HAND, 1, FarTip, Pos), "99");
    REFUSED("sun2xp_joint_torques", sun2xp_joint_torques(HAND, 1, &Torques), "stop");
    REFUSED("sun2xp_palm_pose", sun2xp_palm_pose(HAND, 1, &Pose), "stop");
}
