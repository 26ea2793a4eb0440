/* A planner whose own functions, types and numbers have names that a library for a hand could use too. It calls only
   the five calls of 1990 and HandError. If the library called one of the planner's functions by mistake, the planner
   would abort. */
#include "Sun2Xp.h"
#include "check.h"

#define FAULT_WATCHDOG "a guard dog"

enum { FINGER_RUNNING = 77, TIMING_AGE = 78 };

struct Fault { const char *Text; };
struct FingerStatus { short Size; };
struct FingerTiming { short Size; };
struct FingerTip { short Tip; };
struct FingerRecord { short Pos; };

/* These names are variables here, and not functions: a library that called one of them would crash. */
int GetRecord = 1, ResetTiming = 2;

#define OWN(Name) \
    double Name(double Number) \
    { \
        fprintf(stderr, "%s of the planner was called with %g\n", #Name, Number); \
        abort(); \
    }

double AdjustFinger(double), EventDescriptor(double), FaultText(double), FindPos(double), FindTip(double);
double GetFault(double), GetJacobian(double), GetJointTorques(double), GetObject(double), GetPalmPose(double);
double GetStatus(double), GetTiming(double), GetTip(double), GetTouch(double), IdentifyFinger(double);
double InstallReflex(double), NextEvent(double), OnEvent(double), PushFinger(double), RecoverHand(double);
double RemoveReflex(double), SendContact(double), SendDamping(double), SendGroup(double), SendPath(double);
double SendJointStiffness(double), SendJointTorque(double), SendPosFor(double), SendTip(double), SetGravity(double);
double StopFinger(double), StopHand(double), TareTouch(double), WaitEvent(double), WaitFingers(double);
double WriteBlackBox(double), ZeroFinger(double);

OWN(AdjustFinger)
OWN(EventDescriptor)
OWN(FaultText)
OWN(FindPos)
OWN(FindTip)
OWN(GetFault)
OWN(GetJacobian)
OWN(GetJointTorques)
OWN(GetObject)
OWN(GetPalmPose)
OWN(GetStatus)
OWN(GetTiming)
OWN(GetTip)
OWN(GetTouch)
OWN(IdentifyFinger)
OWN(InstallReflex)
OWN(NextEvent)
OWN(OnEvent)
OWN(PushFinger)
OWN(RecoverHand)
OWN(RemoveReflex)
OWN(SendContact)
OWN(SendDamping)
OWN(SendGroup)
OWN(SendJointStiffness)
OWN(SendJointTorque)
OWN(SendPath)
OWN(SendPosFor)
OWN(SendTip)
OWN(SetGravity)
OWN(StopFinger)
OWN(StopHand)
OWN(TareTouch)
OWN(WaitEvent)
OWN(WaitFingers)
OWN(WriteBlackBox)
OWN(ZeroFinger)

int main(void)
{
    double Kx[3][3] = {{3, 0, 0}, {0, 3, 0}, {0, 0, 3}};
    float Sent[3] = {0.1f, 0.5f, 0.9f}, Pos[3];
    int tries = 0;

    CHECK(OpenHand() == 0);
    CHECK(SendKx(1, Kx) == 0);
    CHECK(SendPos(1, Sent) == 0);
    do {
        PAUSE_MS(100);
        CHECK(GetPos(1, Pos) == 0);
    } while (APART(Pos[0], Sent[0]) > 0.02f && ++tries < 100);
    CHECK(tries < 100);
    Sent[0] = 9;
    CHECK(SendPos(1, Sent) == -1 && HandError()[0] != '\0');
    CHECK(FINGER_RUNNING + TIMING_AGE + GetRecord + ResetTiming == 158 && FAULT_WATCHDOG[0] == 'a');
    return CloseHand();
}
