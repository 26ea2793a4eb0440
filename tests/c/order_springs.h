/* order_springs.h - the part of order.c for springs: wrong values on a faulted finger. */

static void wrong_springs(void)
{
    static double Rigid[9] = {1e5, 0, 0, 0, 1, 0, 0, 0, 1};

    REFUSED("SendKx", SendKx(1, three(Nan)), "NaN");
    REFUSED("SendKx", SendKx(1, three(Skew)), "symmetric");
    REFUSED("SendKx", SendKx(1, three(Stiff)), "bound");
    REFUSED("SendKx", SendKx(1, three(Soft)), "stop");
    REFUSED("SendContact", SendContact(1, 99, Nan[0], NoNormal), "99");
    REFUSED("SendContact", SendContact(1, 4, Nan[0], NoNormal), "NaN");
    REFUSED("SendContact", SendContact(1, 4, Skew[0], NanNormal), "NaN");
    REFUSED("SendContact", SendContact(1, 4, Skew[0], NoNormal), "symmetric");
    REFUSED("SendContact", SendContact(1, 4, Stiff[0], NoNormal), "direction");
    REFUSED("SendContact", SendContact(1, 4, Stiff[0], Normal), "bound");
    REFUSED("SendContact", SendContact(1, 4, Soft[0], Normal), "stop");
    REFUSED("SendDamping", SendDamping(1, NAN), "NaN");
    REFUSED("SendDamping", SendDamping(1, 99), "stop");
    REFUSED("SendJointStiffness", SendJointStiffness(1, three(Nan)), "NaN");
    REFUSED("SendJointStiffness", SendJointStiffness(1, three(Skew)), "symmetric");
    REFUSED("SendJointStiffness", SendJointStiffness(1, Rigid), "bound");
    REFUSED("SendJointStiffness", SendJointStiffness(1, three(Soft)), "stop");
    REFUSED("SendJointTorque", SendJointTorque(1, NanForce), "NaN");
    REFUSED("SendJointTorque", SendJointTorque(1, StrongForce), "tendons");
    REFUSED("SendJointTorque", SendJointTorque(1, Force), "stop");
}
