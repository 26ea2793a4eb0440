/* order_springs.h - the part of order.c for springs. The finger is faulted by an emergency stop. The error text of
   each call names a wrong value or the stop. The range of the damping is checked after the stop, so the text for the
   damping 99 names the stop. */

static void wrong_springs(void)
{
    static double Rigid[9] = {1e5, 0, 0, 0, 1, 0, 0, 0, 1};

    REFUSED("SendKx", SendKx(1, three(Nan)), "NaN");
    REFUSED("SendKx", SendKx(1, three(Skew)), "symmetric");
    REFUSED("SendKx", SendKx(1, three(Stiff)), "bound");
    REFUSED("SendKx", SendKx(1, three(Soft)), "stop");
    REFUSED("sun2xp_send_stiffness", sun2xp_send_stiffness(HAND, 1, three(Nan)), "NaN");
    REFUSED("sun2xp_send_stiffness", sun2xp_send_stiffness(HAND, 1, three(Skew)), "symmetric");
    REFUSED("sun2xp_send_stiffness", sun2xp_send_stiffness(HAND, 1, three(Stiff)), "bound");
    REFUSED("sun2xp_send_stiffness", sun2xp_send_stiffness(HAND, 1, three(Soft)), "stop");
    REFUSED("sun2xp_send_contact", sun2xp_send_contact(HAND, 1, 99, Nan[0], NoNormal), "99");
    REFUSED("sun2xp_send_contact", sun2xp_send_contact(HAND, 1, 4, Nan[0], NoNormal), "NaN");
    REFUSED("sun2xp_send_contact", sun2xp_send_contact(HAND, 1, 4, Skew[0], NanNormal), "NaN");
    REFUSED("sun2xp_send_contact", sun2xp_send_contact(HAND, 1, 4, Skew[0], NoNormal), "symmetric");
    REFUSED("sun2xp_send_contact", sun2xp_send_contact(HAND, 1, 4, Stiff[0], NoNormal), "direction");
    REFUSED("sun2xp_send_contact", sun2xp_send_contact(HAND, 1, 4, Stiff[0], Normal), "bound");
    REFUSED("sun2xp_send_contact", sun2xp_send_contact(HAND, 1, 4, Soft[0], Normal), "stop");
    REFUSED("sun2xp_send_damping", sun2xp_send_damping(HAND, 1, NAN), "NaN");
    REFUSED("sun2xp_send_damping", sun2xp_send_damping(HAND, 1, 99), "stop");
    REFUSED("sun2xp_send_joint_stiffness", sun2xp_send_joint_stiffness(HAND, 1, three(Nan)), "NaN");
    REFUSED("sun2xp_send_joint_stiffness", sun2xp_send_joint_stiffness(HAND, 1, three(Skew)), "symmetric");
    REFUSED("sun2xp_send_joint_stiffness", sun2xp_send_joint_stiffness(HAND, 1, Rigid), "bound");
    REFUSED("sun2xp_send_joint_stiffness", sun2xp_send_joint_stiffness(HAND, 1, three(Soft)), "stop");
    REFUSED("sun2xp_send_joint_torque", sun2xp_send_joint_torque(HAND, 1, NanForce), "NaN");
    REFUSED("sun2xp_send_joint_torque", sun2xp_send_joint_torque(HAND, 1, StrongForce), "tendons");
    REFUSED("sun2xp_send_joint_torque", sun2xp_send_joint_torque(HAND, 1, Force), "stop");
}
