/* Calls with several things wrong at once. Each call corrects one more of them than the call before. Prints a line
   for each call: its name and the errno of its refusal. Finger 1 is on a real port, the others are simulated. */
#include <errno.h>
#include <math.h>
#include <string.h>
#include "Sun2Xp.h"
#include "check.h"
#include "order_refused.h"

static double Nan[4][4], Skew[4][4], Stiff[4][4], Soft[4][4];
static double NoNormal[3], NanNormal[3], Normal[3] = {0, -1, 0};
static double NanPos[3] = {9, 0.5, 0}, FarPos[3] = {9, 0.5, 0.9}, Pos[3] = {0, 0.5, 0.9};
static double NanTip[3] = {99, 0, 0}, FarTip[3] = {99, 0, 0}, Tip[3] = {0, -6, 8};
static double NanForce[3] = {1e4, 0, 0}, StrongForce[3] = {1e4, 0, 0}, Force[3];
static struct FingerStatus Status;
static struct FingerTiming Timing;
static struct FingerTip Fingertip;
static struct ObjectState Object;
static struct FingerRecord Record;
static struct FingerCommand Command[2];
static struct JointTorques Torques;
static struct PalmPose Pose;
static int Fingers[1] = {9};
static double J[9];
static struct Fault Fault;
static struct Event Event;

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

static void null_pointers(void)
{
    REFUSED("SendPos", SendPos(9, NULL), "Pos");
    REFUSED("SendKx", SendKx(9, NULL), "Kx");
    REFUSED("GetPos", GetPos(9, NULL), "Pos");
    REFUSED("GetStatus", GetStatus(9, NULL), "Status");
    REFUSED("GetTiming", GetTiming(9, 99, NULL), "Timing");
    REFUSED("SendTip", SendTip(9, NULL), "Tip");
    REFUSED("GetTip", GetTip(9, NULL), "Tip");
    REFUSED("SendContact", SendContact(9, 99, NULL, NULL), "K is");
    REFUSED("SendContact", SendContact(9, 4, Nan[0], NULL), "Normal");
    REFUSED("SendJointStiffness", SendJointStiffness(9, NULL), "K is");
    REFUSED("SendJointTorque", SendJointTorque(9, NULL), "Torque");
    REFUSED("SendGroup", SendGroup(9, NULL), "Commands");
    REFUSED("GetObject", GetObject(NULL), "Object");
    REFUSED("WaitFingers", WaitFingers(9, NULL, 9, NAN), "Fingers");
    REFUSED("GetJacobian", GetJacobian(9, NanPos, NULL), "J is");
    REFUSED("FindTip", FindTip(9, NULL, Tip), "Pos");
    REFUSED("FindTip", FindTip(9, NanPos, NULL), "Tip");
    REFUSED("FindPos", FindPos(9, NULL, Pos), "Tip");
    REFUSED("GetJointTorques", GetJointTorques(9, NULL), "Torques");
    REFUSED("GetPalmPose", GetPalmPose(9, NULL), "Pose");
    REFUSED("SendPath", SendPath(9, 999, NULL, NAN), "Poses");
    REFUSED("SendPosFor", SendPosFor(9, NULL, NAN), "Pos");
    REFUSED("AdjustFinger", AdjustFinger(9, NULL), "Keys");
    REFUSED("SetGravity", SetGravity(NULL), "Gravity");
    REFUSED("PushFinger", PushFinger(9, NULL), "Force");
    REFUSED("GetRecord", GetRecord(9, 99, NULL), "Record");
    REFUSED("WriteBlackBox", WriteBlackBox(9, NULL), "Path");
    REFUSED("GetFault", GetFault(9, NULL), "Fault");
    REFUSED("GetTouch", GetTouch(9, 9, NULL), "Touch");
    REFUSED("InstallReflex", InstallReflex(9, NULL), "Reflex");
    REFUSED("NextEvent", NextEvent(NULL), "Event");
    REFUSED("WaitEvent", WaitEvent(NULL, 0), "Event");
}

static void without_hand(void)
{
    REFUSED("SendPos", SendPos(9, NanPos), "OpenHand");
    REFUSED("SendKx", SendKx(9, three(Nan)), "OpenHand");
    REFUSED("GetPos", GetPos(9, Pos), "OpenHand");
    REFUSED("GetStatus", GetStatus(9, &Status), "OpenHand");
    REFUSED("GetTiming", GetTiming(9, 99, &Timing), "OpenHand");
    REFUSED("ResetTiming", ResetTiming(9), "OpenHand");
    REFUSED("SendTip", SendTip(9, NanTip), "OpenHand");
    REFUSED("GetTip", GetTip(9, &Fingertip), "OpenHand");
    REFUSED("SendContact", SendContact(9, 99, Nan[0], NoNormal), "OpenHand");
    REFUSED("SendDamping", SendDamping(9, NAN), "OpenHand");
    REFUSED("SendJointStiffness", SendJointStiffness(9, three(Nan)), "OpenHand");
    REFUSED("SendJointTorque", SendJointTorque(9, NanForce), "OpenHand");
    REFUSED("SendGroup", SendGroup(9, Command), "OpenHand");
    REFUSED("GetObject", GetObject(&Object), "OpenHand");
    REFUSED("WaitFingers", WaitFingers(1, Fingers, 9, NAN), "OpenHand");
    REFUSED("GetJacobian", GetJacobian(9, NanPos, J), "OpenHand");
    REFUSED("FindTip", FindTip(9, NanPos, Tip), "OpenHand");
    REFUSED("FindPos", FindPos(9, NanTip, Pos), "OpenHand");
    REFUSED("GetJointTorques", GetJointTorques(9, &Torques), "OpenHand");
    REFUSED("GetPalmPose", GetPalmPose(9, &Pose), "OpenHand");
    REFUSED("SendPath", SendPath(9, 999, Path, NAN), "OpenHand");
    REFUSED("SendPosFor", SendPosFor(9, NanPos, NAN), "OpenHand");
    REFUSED("AdjustFinger", AdjustFinger(9, "="), "OpenHand");
    REFUSED("PushFinger", PushFinger(9, NanForce), "OpenHand");
    REFUSED("GetRecord", GetRecord(9, 99, &Record), "OpenHand");
    REFUSED("WriteBlackBox", WriteBlackBox(9, "no/such/folder"), "OpenHand");
    REFUSED("ZeroFinger", ZeroFinger(9), "OpenHand");
    REFUSED("GetFault", GetFault(9, &Fault), "OpenHand");
    REFUSED("RecoverHand", RecoverHand(9), "OpenHand");
    REFUSED("NextEvent", NextEvent(&Event), "OpenHand");
    REFUSED("WaitEvent", WaitEvent(&Event, -1), "OpenHand");
    REFUSED("OnEvent", OnEvent(NULL, NULL), "OpenHand");
    REFUSED("EventDescriptor", EventDescriptor(), "OpenHand");
    REFUSED("StopFinger", StopFinger(9), "OpenHand");
    REFUSED("GetTouch", GetTouch(9, 9, &Touch), "OpenHand");
    REFUSED("TareTouch", TareTouch(9), "OpenHand");
    REFUSED("InstallReflex", InstallReflex(9, &Rule), "OpenHand");
    REFUSED("RemoveReflex", RemoveReflex(9, 9), "OpenHand");
    REFUSED("SetGravity", SetGravity(NanForce), "OpenHand");
}

static void small_structs(void)
{
    REFUSED("GetStatus", GetStatus(9, &Status), "Size");
    REFUSED("GetTiming", GetTiming(9, 99, &Timing), "Size");
    REFUSED("GetTip", GetTip(9, &Fingertip), "Size");
    REFUSED("GetRecord", GetRecord(9, 99, &Record), "Size");
    REFUSED("GetFault", GetFault(9, &Fault), "Size");
    REFUSED("GetObject", GetObject(&Object), "Size");
    Object.Size = sizeof Object;
    REFUSED("GetObject", GetObject(&Object), "no simulated object");
    REFUSED("SendGroup", SendGroup(1, Command), "Size");
    REFUSED("NextEvent", NextEvent(&Event), "Size");
    REFUSED("GetTouch", GetTouch(9, 9, &Touch), "Size");
    REFUSED("InstallReflex", InstallReflex(9, &Rule), "Size");
    REFUSED("WaitEvent", WaitEvent(&Event, -1), "Size");
    REFUSED("GetJointTorques", GetJointTorques(9, &Torques), "Size");
    REFUSED("GetPalmPose", GetPalmPose(9, &Pose), "Size");
    Torques.Size = sizeof Torques;
    Pose.Size = sizeof Pose;
    REFUSED("SendPath", SendPath(9, 2, Path, NAN), "Size");
    Path[0].Size = Path[1].Size = sizeof Path[0];
    Command[0].Size = Command[1].Size = sizeof Command[0];
    Status.Size = sizeof Status;
    Timing.Size = sizeof Timing;
    Fingertip.Size = sizeof Fingertip;
    Record.Size = sizeof Record;
    Fault.Size = sizeof Fault;
}

#define NO_FINGER "1, 2 and 3"

static void no_such_finger(void)
{
    REFUSED("SendPos", SendPos(9, NanPos), NO_FINGER);
    REFUSED("SendKx", SendKx(9, three(Nan)), NO_FINGER);
    REFUSED("GetPos", GetPos(9, Pos), NO_FINGER);
    REFUSED("GetStatus", GetStatus(9, &Status), NO_FINGER);
    REFUSED("GetTiming", GetTiming(9, 99, &Timing), NO_FINGER);
    REFUSED("ResetTiming", ResetTiming(9), NO_FINGER);
    REFUSED("SendTip", SendTip(9, NanTip), NO_FINGER);
    REFUSED("GetTip", GetTip(9, &Fingertip), NO_FINGER);
    REFUSED("SendContact", SendContact(9, 99, Nan[0], NoNormal), NO_FINGER);
    REFUSED("SendDamping", SendDamping(9, NAN), NO_FINGER);
    REFUSED("SendJointStiffness", SendJointStiffness(9, three(Nan)), NO_FINGER);
    REFUSED("SendJointTorque", SendJointTorque(9, NanForce), NO_FINGER);
    Command[0].Finger = Command[1].Finger = 9;
    Command[0].Kx = three(Nan);
    REFUSED("WaitFingers", WaitFingers(9, Fingers, 9, NAN), "and not 9");
    REFUSED("WaitFingers", WaitFingers(1, Fingers, 9, NAN), NO_FINGER);
    REFUSED("GetJacobian", GetJacobian(9, NanPos, J), NO_FINGER);
    REFUSED("FindTip", FindTip(9, NanPos, Tip), NO_FINGER);
    REFUSED("FindPos", FindPos(9, NanTip, Pos), NO_FINGER);
    REFUSED("GetJointTorques", GetJointTorques(9, &Torques), NO_FINGER);
    REFUSED("GetPalmPose", GetPalmPose(9, &Pose), NO_FINGER);
    REFUSED("SendGroup", SendGroup(9, Command), "and not 9");
    REFUSED("SendGroup", SendGroup(2, Command), NO_FINGER);
    REFUSED("SendPath", SendPath(9, 999, Path, NAN), "999 poses");
    REFUSED("SendPath", SendPath(9, 2, Path, NAN), "valid");
    REFUSED("SendPath", SendPath(9, 2, Path, 0), NO_FINGER);
    REFUSED("SendPosFor", SendPosFor(9, NanPos, NAN), "valid");
    REFUSED("SendPosFor", SendPosFor(9, NanPos, 0), NO_FINGER);
    REFUSED("AdjustFinger", AdjustFinger(9, "="), NO_FINGER);
    REFUSED("PushFinger", PushFinger(9, NanForce), NO_FINGER);
    REFUSED("GetRecord", GetRecord(9, 99999999, &Record), NO_FINGER);
    REFUSED("WriteBlackBox", WriteBlackBox(9, "no/such/folder"), NO_FINGER);
    REFUSED("ZeroFinger", ZeroFinger(9), NO_FINGER);
    REFUSED("GetFault", GetFault(9, &Fault), NO_FINGER);
    REFUSED("RecoverHand", RecoverHand(9), NO_FINGER);
    REFUSED("StopFinger", StopFinger(9), NO_FINGER);
}

#include "order_groups.h"
#include "order_reflexes.h"
#include "order_springs.h"

static void wrong_values_on_a_faulted_finger(void)
{
    wrong_paths();
    REFUSED("SendPosFor", SendPosFor(1, NanPos, 0), "NaN");
    REFUSED("SendPosFor", SendPosFor(1, FarPos, 0), "limits");
    REFUSED("SendPosFor", SendPosFor(1, Pos, 0), "stop");
    REFUSED("SendPos", SendPos(1, NanPos), "NaN");
    REFUSED("SendPos", SendPos(1, FarPos), "limits");
    REFUSED("SendPos", SendPos(1, Pos), "stop");
    REFUSED("GetPos", GetPos(1, Pos), "stop");
    REFUSED("GetTiming", GetTiming(1, 99, &Timing), "99");
    REFUSED("SendTip", SendTip(1, NanTip), "NaN");
    REFUSED("SendTip", SendTip(1, FarTip), "99");
    REFUSED("SendTip", SendTip(1, Tip), "stop");
    REFUSED("GetTip", GetTip(1, &Fingertip), "stop");
    wrong_springs();
    wrong_groups();
    wrong_kinematics();
    wrong_reflexes();
    REFUSED("AdjustFinger", AdjustFinger(1, "joints.maximum_degrees = [-60, 100, 120]\nport = \"other\"\n="), "line 3");
    REFUSED("AdjustFinger", AdjustFinger(1, "joints.maximum_degrees = [-60, 100, 120]\nport = \"other\""), "`port`");
    REFUSED("AdjustFinger", AdjustFinger(1, "joints.maximum_degrees = [-60, 100, 120]"), "minimum_degrees");
    REFUSED("AdjustFinger", AdjustFinger(1, "joints.maximum_degrees = [-50, 100, 120]"), "limits");
    REFUSED("AdjustFinger", AdjustFinger(1, "tendon.minimum = 6"), "stop");
    REFUSED("PushFinger", PushFinger(1, NanForce), "NaN");
    REFUSED("PushFinger", PushFinger(1, StrongForce), "real port");
    REFUSED("PushFinger", PushFinger(2, StrongForce), "1000");
    REFUSED("GetRecord", GetRecord(1, 99999999, &Record), "99999999");
    REFUSED("WriteBlackBox", WriteBlackBox(1, "no/such/folder"), "no/such/folder");
    REFUSED("ZeroFinger", ZeroFinger(1), "stop");
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
    configure("[finger.1]\nport = \"no/such/port\"\n");
    REFUSED("OpenHand", OpenHand(), "no/such/port");
}

static int faulted(int finger)
{
    CHECK(GetFault(finger, &Fault) == 0);
    return Fault.Number == FAULT_EMERGENCY_STOP_CALL;
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
    CHECK(StopHand() == 0);
    for (finger = 1; finger <= 3; finger++)
        for (wait = 0; !faulted(finger); wait++) {
            CHECK(wait < 1000);
            PAUSE_MS(2);
        }
    no_such_finger();
    wrong_values_on_a_faulted_finger();
    CHECK(RecoverHand(1) == 0);
    CHECK(SendPos(1, Pos) == 0 && SendKx(1, three(Soft)) == 0 && GetPos(1, Pos) == 0 && SendTip(1, Tip) == 0);
    CHECK(SendContact(1, 4, Soft[0], Normal) == 0 && SendDamping(1, 0.7) == 0 && PushFinger(2, Force) == 0);
    CHECK(SendGroup(1, Command) == 0);
    REFUSED("SendDamping", SendDamping(1, 99), "99");
    Soft[0][0] = 5.5;
    REFUSED("SendKx", SendKx(1, three(Soft)), "damping");
    REFUSED("SendContact", SendContact(1, 4, Soft[0], Normal), "damping");
    CHECK(GetTip(1, &Fingertip) == 0 && AdjustFinger(1, "tendon.minimum = 6") == 0);
    CHECK(CloseHand() == 0);
    configurations_of_a_closed_hand();
    return 0;
}
