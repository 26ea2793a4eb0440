/* Exit handlers of a planner that leaves its hand open. A handler that was registered after OpenHand runs while the
   hand is open. A handler that was registered before OpenHand runs only after the library has closed the hand. In
   this second handler, calls that read still work, and calls that would move or open a hand are refused. Each handler
   prints a line, so that a handler that does not run is noticed. */
#include <errno.h>
#include <string.h>
#include <unistd.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
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

/* Calls that would move or open a hand are refused. The stop call still works. */
static void commands_are_refused(void)
{
    static const double Kx[9] = {3, 0, 0, 0, 3, 0, 0, 0, 3}, Three[3] = {0.1, 0.5, 0.9};
    static struct sun2xp_reflex Guard;

    Guard.size = sizeof Guard;
    Guard.condition = SUN2XP_WHEN_EVENT;
    Guard.event = SUN2XP_EVENT_CONTACT;
    Guard.reaction = SUN2XP_THEN_HOLD;
    REFUSED(OpenHand(), ESHUTDOWN, "before exit");
    REFUSED(SendPosD(1, Three), ESHUTDOWN, "before exit");
    REFUSED(SendKxD(1, Kx), ESHUTDOWN, "before exit");
    REFUSED(sun2xp_send_tip(HAND, 1, Three), ESHUTDOWN, "before exit");
    REFUSED(sun2xp_send_contact(HAND, 1, 3, Kx, NULL), ESHUTDOWN, "before exit");
    REFUSED(sun2xp_send_contact(HAND, 1, 2, Kx, NULL), ESHUTDOWN, "before exit");
    REFUSED(sun2xp_send_damping(HAND, 1, 1.0), ESHUTDOWN, "before exit");
    REFUSED(sun2xp_adjust(HAND, 1, "tendon.minimum = 6"), ESHUTDOWN, "before exit");
    REFUSED(sun2xp_push(HAND, 1, Three), ESHUTDOWN, "before exit");
    REFUSED(sun2xp_zero(HAND, 1), ESHUTDOWN, "before exit");
    REFUSED(sun2xp_identify(HAND, 1), ESHUTDOWN, "before exit");
    REFUSED(sun2xp_recover(HAND, 1), ESHUTDOWN, "before exit");
    REFUSED(sun2xp_install_reflex(HAND, 1, &Guard), ESHUTDOWN, "before exit");
    REFUSED(SendPosD(1, (double *)NULL), EFAULT, "null");
    CHECK(sun2xp_stop_all() == 0);
}

static void after_the_hand_was_closed(void)
{
    double Pos[3];
    struct sun2xp_status Status;
    struct sun2xp_tip Tip;
    struct sun2xp_fault Fault;

    Status.size = sizeof Status;
    Tip.size = sizeof Tip;
    Fault.size = sizeof Fault;
    CHECK(sun2xp_status(HAND, 1, &Status) == 0 && Status.state == SUN2XP_STATE_CLOSED);
    CHECK(GetPosD(1, Pos) == 0 && sun2xp_tip(HAND, 1, &Tip) == 0);
    CHECK(sun2xp_fault(HAND, 1, &Fault) == 0 && Fault.number == 0);
    CHECK(sun2xp_write_black_box(HAND, 1, "exit.jsonl") == 0);
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
