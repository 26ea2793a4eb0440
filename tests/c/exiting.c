/* Exit handlers of a planner that leaves its hand open. One registered after OpenHand runs while the hand is open. One
   registered before runs after the library has closed the hand: there calls that read still work, and calls that would
   move or open a hand are refused. Each prints a line, so that a handler that does not run is noticed. */
#include <errno.h>
#include <string.h>
#include <unistd.h>
#include "Sun2Xp.h"
#include "check.h"
#include "refused.h"

/* An exit handler must not call exit. */
#undef CHECK
#define CHECK(Condition) \
    do { \
        if (!(Condition)) { \
            fprintf(stderr, "%s:%d: not so: %s (HandError: %s)\n", __FILE__, __LINE__, #Condition, HandError()); \
            _exit(1); \
        } \
    } while (0)

/* Every call that would move or open a hand. */
static void commands_are_refused(void)
{
    static const double Kx[9] = {3, 0, 0, 0, 3, 0, 0, 0, 3}, Three[3] = {0.1, 0.5, 0.9};

    REFUSED(OpenHand(), ESHUTDOWN, "before exit");
    REFUSED(SendPosD(1, Three), ESHUTDOWN, "before exit");
    REFUSED(SendKxD(1, Kx), ESHUTDOWN, "before exit");
    REFUSED(SendTip(1, Three), ESHUTDOWN, "before exit");
    REFUSED(SendContact(1, 3, Kx, NULL), ESHUTDOWN, "before exit");
    REFUSED(SendContact(1, 2, Kx, NULL), ESHUTDOWN, "before exit");
    REFUSED(SendDamping(1, 1.0), ESHUTDOWN, "before exit");
    REFUSED(AdjustFinger(1, "tendon.minimum = 6"), ESHUTDOWN, "before exit");
    REFUSED(PushFinger(1, Three), ESHUTDOWN, "before exit");
    REFUSED(ZeroFinger(1), ESHUTDOWN, "before exit");
    REFUSED(IdentifyFinger(1), ESHUTDOWN, "before exit");
    REFUSED(RecoverHand(1), ESHUTDOWN, "before exit");
    REFUSED(SendPosD(1, (double *)NULL), EFAULT, "null");
    CHECK(StopHand() == 0);
}

static void after_the_hand_was_closed(void)
{
    double Pos[3];
    struct FingerStatus Status;
    struct FingerTip Tip;
    struct Fault Fault;

    Status.Size = sizeof Status;
    Tip.Size = sizeof Tip;
    Fault.Size = sizeof Fault;
    CHECK(GetStatus(1, &Status) == 0 && Status.State == FINGER_CLOSED);
    CHECK(GetPosD(1, Pos) == 0 && GetTip(1, &Tip) == 0);
    CHECK(GetFault(1, &Fault) == 0 && Fault.Number == 0);
    CHECK(WriteBlackBox(1, "exit.jsonl") == 0);
    commands_are_refused();

    CHECK(CloseHand() == 0);
    REFUSED(GetPosD(1, Pos), ENODEV, "no hand is open");
    commands_are_refused();
    CHECK(CloseHand() == 0);
    CHECK(write(STDOUT_FILENO, "after\n", 6) == 6);
}

static void while_the_hand_is_open(void)
{
    double Pos[3];

    CHECK(GetPosD(1, Pos) == 0 && SendPosD(1, Pos) == 0);
    CHECK(CloseHand() == 0);
    CHECK(OpenHand() == 0);
    CHECK(GetPosD(1, Pos) == 0 && SendPosD(1, Pos) == 0);
    CHECK(write(STDOUT_FILENO, "before\n", 7) == 7);
}

int main(void)
{
    CHECK(atexit(after_the_hand_was_closed) == 0);
    CHECK(OpenHand() == 0);
    CHECK(atexit(while_the_hand_is_open) == 0);
    return 7;
}
