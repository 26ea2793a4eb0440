/* Makes calls with several errors at once. Most calls have one error fewer than the previous call of the same function.
   Prints a line for each refused call: its name and the errno of its refusal. Finger 1 is at the port of
   `sun2xp board`. The library itself simulates the other fingers. */
#include <errno.h>
#include <math.h>
#include <string.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"
#include "order_refused.h"

static double Nan[4][4], Skew[4][4], Stiff[4][4], Soft[4][4];
static double NoNormal[3], NanNormal[3], Normal[3] = {0, -1, 0};
static double NanPos[3] = {9, 0.5, 0}, FarPos[3] = {9, 0.5, 0.9}, Pos[3] = {0, 0.5, 0.9};
static double NanTip[3] = {99, 0, 0}, FarTip[3] = {99, 0, 0}, Tip[3] = {0, -6, 8};
static double NanForce[3] = {1e4, 0, 0}, StrongForce[3] = {1e4, 0, 0}, Force[3];
static struct sun2xp_status Status;
static struct sun2xp_timing Timing;
static struct sun2xp_tip Fingertip;
static struct sun2xp_object Object;
static struct sun2xp_record Record;
static struct sun2xp_set_point Command[2];
static struct sun2xp_joint_torques Torques;
static struct sun2xp_palm_pose Pose;
static struct sun2xp_limits Limits;
static struct sun2xp_io Io;
static double J[9];
static sun2xp_hand *Other;
static struct sun2xp_fault Fault;
static struct sun2xp_event Event;

static void make_arguments(void)
{
    int row;

    for (row = 0; row < 4; row++) {
        Soft[row][row] = 3;
        Stiff[row][row] = Skew[row][row] = Nan[row][row] = 100;
    }
    Skew[0][2] = Nan[0][2] = 50;
    Nan[0][1] = NanPos[2] = NanTip[2] = NanForce[2] = NanNormal[2] = NAN;
}

/* The upper left 3 x 3 block of a 4 x 4 matrix. */
static double *three(double K[4][4])
{
    static double Kx[9];
    int row;

    for (row = 0; row < 3; row++)
        memcpy(Kx + 3 * row, K[row], 3 * sizeof(double));
    return Kx;
}

#include "order_paths.h"

#include "order_handles.h"

static void small_structs(void)
{
    REFUSED("sun2xp_status", sun2xp_status(HAND, 9, &Status), "size");
    REFUSED("sun2xp_timing", sun2xp_timing(HAND, 9, 99, &Timing), "size");
    REFUSED("sun2xp_tip", sun2xp_tip(HAND, 9, &Fingertip), "size");
    REFUSED("sun2xp_record", sun2xp_record(HAND, 9, 99, &Record), "size");
    REFUSED("sun2xp_fault", sun2xp_fault(HAND, 9, &Fault), "size");
    REFUSED("sun2xp_object", sun2xp_object(HAND, &Object), "size");
    Object.size = sizeof Object;
    REFUSED("sun2xp_object", sun2xp_object(HAND, &Object), "no simulated object");
    REFUSED("sun2xp_send_group", sun2xp_send_group(HAND, 9, Command), "size");
    REFUSED("sun2xp_next_event", sun2xp_next_event(HAND, &Event), "size");
    REFUSED("sun2xp_touch", sun2xp_touch(HAND, 9, 9, &Touch), "size");
    REFUSED("sun2xp_install_reflex", sun2xp_install_reflex(HAND, 9, &Rule), "size");
    REFUSED("sun2xp_wait_event", sun2xp_wait_event(HAND, &Event, -1), "size");
    REFUSED("sun2xp_joint_torques", sun2xp_joint_torques(HAND, 9, &Torques), "size");
    REFUSED("sun2xp_palm_pose", sun2xp_palm_pose(HAND, 9, &Pose), "size");
    REFUSED("sun2xp_limits", sun2xp_limits(HAND, 9, &Limits), "size");
    Limits.size = sizeof Limits;
    Torques.size = sizeof Torques;
    Pose.size = sizeof Pose;
    REFUSED("sun2xp_send_path", sun2xp_send_path(HAND, 9, 999, Path, NAN), "size");
    Path[0].size = Path[1].size = sizeof Path[0];
    Command[0].size = Command[1].size = sizeof Command[0];
    Status.size = sizeof Status;
    Timing.size = sizeof Timing;
    Fingertip.size = sizeof Fingertip;
    Record.size = sizeof Record;
    Fault.size = sizeof Fault;
}

#define NO_FINGER "1, 2 and 3"

static void no_such_finger(void)
{
    REFUSED("SendPos", SendPos(9, NanPos), NO_FINGER);
    REFUSED("SendKx", SendKx(9, three(Nan)), NO_FINGER);
    REFUSED("GetPos", GetPos(9, Pos), NO_FINGER);
    REFUSED("sun2xp_send_position", sun2xp_send_position(HAND, 9, NanPos), NO_FINGER);
    REFUSED("sun2xp_send_stiffness", sun2xp_send_stiffness(HAND, 9, three(Nan)), NO_FINGER);
    REFUSED("sun2xp_position", sun2xp_position(HAND, 9, Pos), NO_FINGER);
    REFUSED("sun2xp_status", sun2xp_status(HAND, 9, &Status), NO_FINGER);
    REFUSED("sun2xp_timing", sun2xp_timing(HAND, 9, 99, &Timing), NO_FINGER);
    REFUSED("sun2xp_reset_timing", sun2xp_reset_timing(HAND, 9), NO_FINGER);
    REFUSED("sun2xp_send_tip", sun2xp_send_tip(HAND, 9, NanTip), NO_FINGER);
    REFUSED("sun2xp_tip", sun2xp_tip(HAND, 9, &Fingertip), NO_FINGER);
    REFUSED("sun2xp_send_contact", sun2xp_send_contact(HAND, 9, 99, Nan[0], NoNormal), NO_FINGER);
    REFUSED("sun2xp_send_damping", sun2xp_send_damping(HAND, 9, NAN), NO_FINGER);
    REFUSED("sun2xp_send_joint_stiffness", sun2xp_send_joint_stiffness(HAND, 9, three(Nan)), NO_FINGER);
    REFUSED("sun2xp_send_joint_torque", sun2xp_send_joint_torque(HAND, 9, NanForce), NO_FINGER);
    Command[0].finger = Command[1].finger = 9;
    Command[0].stiffness = three(Nan);
    REFUSED("sun2xp_wait", sun2xp_wait(HAND, 9, 9, NAN), NO_FINGER);
    REFUSED("sun2xp_jacobian", sun2xp_jacobian(HAND, 9, NanPos, J), NO_FINGER);
    REFUSED("sun2xp_forward_kinematics", sun2xp_forward_kinematics(HAND, 9, NanPos, Tip), NO_FINGER);
    REFUSED("sun2xp_inverse_kinematics", sun2xp_inverse_kinematics(HAND, 9, NanTip, Pos), NO_FINGER);
    REFUSED("sun2xp_joint_torques", sun2xp_joint_torques(HAND, 9, &Torques), NO_FINGER);
    REFUSED("sun2xp_palm_pose", sun2xp_palm_pose(HAND, 9, &Pose), NO_FINGER);
    REFUSED("sun2xp_limits", sun2xp_limits(HAND, 9, &Limits), NO_FINGER);
    REFUSED("sun2xp_send_group", sun2xp_send_group(HAND, 9, Command), "and not 9");
    REFUSED("sun2xp_send_group", sun2xp_send_group(HAND, 2, Command), NO_FINGER);
    REFUSED("sun2xp_send_path", sun2xp_send_path(HAND, 9, 999, Path, NAN), "999 poses");
    REFUSED("sun2xp_send_path", sun2xp_send_path(HAND, 9, 2, Path, NAN), "valid");
    REFUSED("sun2xp_send_path", sun2xp_send_path(HAND, 9, 2, Path, 0), NO_FINGER);
    REFUSED("sun2xp_send_position_for", sun2xp_send_position_for(HAND, 9, NanPos, NAN), "valid");
    REFUSED("sun2xp_send_position_for", sun2xp_send_position_for(HAND, 9, NanPos, 0), NO_FINGER);
    REFUSED("sun2xp_adjust", sun2xp_adjust(HAND, 9, "="), NO_FINGER);
    REFUSED("sun2xp_push", sun2xp_push(HAND, 9, NanForce), NO_FINGER);
    REFUSED("sun2xp_record", sun2xp_record(HAND, 9, 99999999, &Record), NO_FINGER);
    REFUSED("sun2xp_write_black_box", sun2xp_write_black_box(HAND, 9, "no/such/folder"), NO_FINGER);
    REFUSED("sun2xp_zero", sun2xp_zero(HAND, 9), NO_FINGER);
    REFUSED("sun2xp_fault", sun2xp_fault(HAND, 9, &Fault), NO_FINGER);
    REFUSED("sun2xp_recover", sun2xp_recover(HAND, 9), NO_FINGER);
    REFUSED("sun2xp_stop", sun2xp_stop(HAND, 9), NO_FINGER);
}

#include "order_groups.h"
#include "order_reflexes.h"
#include "order_springs.h"

static void wrong_values_on_a_faulted_finger(void)
{
    wrong_paths();
    REFUSED("sun2xp_send_position_for", sun2xp_send_position_for(HAND, 1, NanPos, 0), "NaN");
    REFUSED("sun2xp_send_position_for", sun2xp_send_position_for(HAND, 1, FarPos, 0), "limits");
    REFUSED("sun2xp_send_position_for", sun2xp_send_position_for(HAND, 1, Pos, 0), "stop");
    REFUSED("sun2xp_send_position", sun2xp_send_position(HAND, 1, NanPos), "NaN");
    REFUSED("sun2xp_send_position", sun2xp_send_position(HAND, 1, FarPos), "limits");
    REFUSED("sun2xp_send_position", sun2xp_send_position(HAND, 1, Pos), "stop");
    REFUSED("sun2xp_position", sun2xp_position(HAND, 1, Pos), "stop");
    REFUSED("SendPos", SendPos(1, NanPos), "NaN");
    REFUSED("SendPos", SendPos(1, FarPos), "limits");
    REFUSED("SendPos", SendPos(1, Pos), "stop");
    REFUSED("GetPos", GetPos(1, Pos), "stop");
    REFUSED("sun2xp_timing", sun2xp_timing(HAND, 1, 99, &Timing), "99");
    REFUSED("sun2xp_send_tip", sun2xp_send_tip(HAND, 1, NanTip), "NaN");
    REFUSED("sun2xp_send_tip", sun2xp_send_tip(HAND, 1, FarTip), "99");
    REFUSED("sun2xp_send_tip", sun2xp_send_tip(HAND, 1, Tip), "stop");
    REFUSED("sun2xp_tip", sun2xp_tip(HAND, 1, &Fingertip), "stop");
    wrong_springs();
    wrong_groups();
    wrong_kinematics();
    wrong_reflexes();
    REFUSED("sun2xp_adjust", sun2xp_adjust(HAND, 1, "joints.maximum_degrees = [-60, 100, 120]\nport = \"other\"\n="),
            "line 3");
    REFUSED("sun2xp_adjust", sun2xp_adjust(HAND, 1, "joints.maximum_degrees = [-60, 100, 120]\nport = \"other\""),
            "`port`");
    REFUSED("sun2xp_adjust", sun2xp_adjust(HAND, 1, "joints.maximum_degrees = [-60, 100, 120]"), "minimum_degrees");
    REFUSED("sun2xp_adjust", sun2xp_adjust(HAND, 1, "joints.maximum_degrees = [-50, 100, 120]"), "limits");
    REFUSED("sun2xp_adjust", sun2xp_adjust(HAND, 1, "tendon.minimum = 6"), "stop");
    REFUSED("sun2xp_push", sun2xp_push(HAND, 1, NanForce), "NaN");
    REFUSED("sun2xp_push", sun2xp_push(HAND, 1, StrongForce), "not simulated");
    REFUSED("sun2xp_push", sun2xp_push(HAND, 2, StrongForce),
            "component of the force on finger 2 has a magnitude of 1.000e4 N, above 1000 N");
    REFUSED("sun2xp_record", sun2xp_record(HAND, 1, 99999999, &Record), "99999999");
    REFUSED("sun2xp_write_black_box", sun2xp_write_black_box(HAND, 1, "no/such/folder"), "no/such/folder");
    REFUSED("sun2xp_zero", sun2xp_zero(HAND, 1), "stop");
}

/* Writes a configuration file and names it in SUN2XP_CONFIG. */
static void configure(const char *text)
{
    FILE *file = fopen("order.toml", "w");

    CHECK(file != NULL && fputs(text, file) >= 0 && fclose(file) == 0);
    CHECK(setenv("SUN2XP_CONFIG", "order.toml", 1) == 0);
}

static void configurations_of_a_closed_hand(void)
{
    REFUSED("OpenHand", OpenHand(), "missing.toml");
    configure("[hand]\nrat = 1\n[finger.1]\nport = \"no/such/port\"\n");
    REFUSED("OpenHand", OpenHand(), "rat");
    configure("[hand]\nfingers = [1]\n[finger.1]\nport = \"no/such/port\"\n");
    REFUSED("OpenHand", OpenHand(), "no/such/port");
}

static int faulted(int finger)
{
    CHECK(sun2xp_fault(HAND, finger, &Fault) == 0);
    return Fault.number == SUN2XP_FAULT_EMERGENCY_STOP_CALL;
}

int main(void)
{
    int finger, wait;

    make_arguments();
    null_pointers();
    without_hand();
    CHECK(OpenHand() == 0);
    CHECK(setenv("SUN2XP_CONFIG", "missing.toml", 1) == 0);
    REFUSED("OpenHand", OpenHand(), "already open");
    small_structs();
    CHECK(sun2xp_stop_all() == 0);
    for (finger = 1; finger <= 3; finger++)
        for (wait = 0; !faulted(finger); wait++) {
            CHECK(wait < 1000);
            PAUSE_MS(2);
        }
    no_such_finger();
    wrong_values_on_a_faulted_finger();
    CHECK(sun2xp_recover(HAND, 1) == 0);
    CHECK(SendPos(1, Pos) == 0 && SendKx(1, three(Soft)) == 0 && GetPos(1, Pos) == 0 &&
        sun2xp_send_tip(HAND, 1, Tip) == 0);
    CHECK(sun2xp_send_contact(HAND, 1, 4, Soft[0], Normal) == 0 && sun2xp_send_damping(HAND, 1, 0.7) == 0 &&
        sun2xp_push(HAND, 2, Force) == 0);
    CHECK(sun2xp_send_group(HAND, 1, Command) == 0);
    REFUSED("sun2xp_send_damping", sun2xp_send_damping(HAND, 1, 99), "99");
    Soft[0][0] = 5.5;
    REFUSED("SendKx", SendKx(1, three(Soft)), "damping");
    REFUSED("sun2xp_send_stiffness", sun2xp_send_stiffness(HAND, 1, three(Soft)), "damping");
    REFUSED("sun2xp_send_contact", sun2xp_send_contact(HAND, 1, 4, Soft[0], Normal), "damping");
    CHECK(sun2xp_tip(HAND, 1, &Fingertip) == 0 && sun2xp_adjust(HAND, 1, "tendon.minimum = 6") == 0);
    CHECK(CloseHand() == 0);
    configurations_of_a_closed_hand();
    return 0;
}
