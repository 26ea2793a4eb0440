/* Reflexes: installed, fired, refused and removed. */
#include <errno.h>
#include <string.h>
#include "Sun2Xp.h"
#include "check.h"

static struct Reflex rule(int condition, double bound, int reaction)
{
    struct Reflex rule;

    memset(&rule, 0, sizeof rule);
    rule.Size = sizeof rule;
    rule.Condition = condition;
    rule.Bound = bound;
    rule.Reaction = reaction;
    return rule;
}

static void refuse(struct Reflex wrong, int number, const char *text)
{
    errno = 0;
    CHECK(InstallReflex(1, &wrong) == -1 && errno == number && strstr(HandError(), text));
}

static void refused(void)
{
    struct Reflex good = rule(WHEN_FORCE_ABOVE, 1, THEN_HOLD), wrong;
    int count, last;

    wrong = good, wrong.Size = 8;
    refuse(wrong, EINVAL, "Size");
    wrong = good, wrong.Condition = 77;
    refuse(wrong, EINVAL, "WHEN_");
    wrong = good, wrong.Reaction = 0;
    refuse(wrong, EINVAL, "THEN_");
    wrong = good, wrong.Condition = WHEN_EVENT;
    refuse(wrong, EINVAL, "EVENT_");
    wrong = rule(WHEN_JOINT_ABOVE, 1, THEN_HOLD), wrong.Joint = 3;
    refuse(wrong, EINVAL, "joint");
    wrong = good, wrong.Bound = -1;
    refuse(wrong, ERANGE, "force");
    wrong = rule(WHEN_LINK_LOST, 1e9, THEN_HOLD);
    refuse(wrong, ERANGE, "time");
    wrong = rule(WHEN_OTHER_FINGER, 0, THEN_HOLD), wrong.Finger = 1, wrong.Event = EVENT_SLIP;
    refuse(wrong, EINVAL, "own event");
    wrong = rule(WHEN_FORCE_ABOVE, 1, THEN_RETRACT), wrong.Pos[0] = 9;
    refuse(wrong, ERANGE, "Pos[0]");
    wrong = rule(WHEN_FORCE_ABOVE, 1, THEN_SOFTEN), wrong.Kx[0][0] = -1;
    CHECK(InstallReflex(1, &wrong) == -1);
    CHECK(InstallReflex(4, &good) == -1 && errno == EINVAL);
    CHECK(RemoveReflex(1, 5) == -1 && errno == ENOENT && RemoveReflex(1, -5) == -1);
    for (count = 0, last = 0; count < 16; count++) {
        int number = InstallReflex(1, &good);
        CHECK(number > last);
        last = number;
    }
    refuse(good, ENOSPC, "16");
    CHECK(RemoveReflex(1, last) == 0 && RemoveReflex(1, last) == -1 && InstallReflex(1, &good) > last);
    CHECK(RemoveReflex(1, 0) == 0 && RemoveReflex(1, 0) == 0);
}

/* Finger 2 bends until its joint 2 is beyond a bound. Its reflex holds it there, and finger 1 softens. */
static void fired(void)
{
    static double start[3] = {0.0, 0.5, 0.8}, far[3] = {0.0, 0.5, 1.4}, found[3];
    struct Reflex hold = rule(WHEN_JOINT_ABOVE, 1.1, THEN_HOLD), soften = rule(WHEN_OTHER_FINGER, 0, THEN_SOFTEN);
    struct Event Event;
    int numbers[2], seen = 0;

    hold.Joint = 2;
    soften.Event = EVENT_REFLEX_FIRED;
    soften.Finger = 2;
    soften.Kx[0][0] = soften.Kx[1][1] = soften.Kx[2][2] = 0.5;
    memset(&Event, 0, sizeof Event);
    Event.Size = sizeof Event;
    CHECK(SendPos(2, start) == 0);
    do
        CHECK(WaitEvent(&Event, 20000) == 1);
    while (Event.Kind != EVENT_SETTLED || Event.Finger != 2);
    CHECK((numbers[1] = InstallReflex(2, &hold)) > 0 && (numbers[0] = InstallReflex(1, &soften)) > 0);
    CHECK(SendPos(2, far) == 0);
    while (seen != 3) {
        CHECK(WaitEvent(&Event, 20000) == 1);
        if (Event.Kind == EVENT_REFLEX_FIRED) {
            CHECK(Event.Finger <= 2 && Event.Values[0] == numbers[Event.Finger - 1]);
            seen |= Event.Finger;
        }
    }
    PAUSE_MS(500);
    CHECK(GetPos(2, found) == 0 && found[2] > 1.0 && found[2] < 1.3);
    CHECK(RemoveReflex(1, 0) == 0 && RemoveReflex(2, 0) == 0);
}

int main(void)
{
    struct Reflex good = rule(WHEN_FORCE_ABOVE, 1, THEN_HOLD);

    CHECK(InstallReflex(1, &good) == -1 && errno == ENODEV);
    CHECK(InstallReflex(1, NULL) == -1 && errno == EFAULT);
    CHECK(OpenHand() == 0);
    refused();
    fired();
    CloseHand();
    CHECK(RemoveReflex(1, 0) == -1 && errno == ENODEV);
    return 0;
}
