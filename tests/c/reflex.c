/* Reflexes: installed, fired, refused and removed. */
#include <errno.h>
#include <string.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"

static struct sun2xp_reflex rule(int condition, double bound, int reaction)
{
    struct sun2xp_reflex rule;

    memset(&rule, 0, sizeof rule);
    rule.size = sizeof rule;
    rule.condition = condition;
    rule.bound = bound;
    rule.reaction = reaction;
    return rule;
}

static void refuse(struct sun2xp_reflex wrong, int number, const char *text)
{
    errno = 0;
    CHECK(sun2xp_install_reflex(HAND, 1, &wrong) < 0 && errno == number && strstr(HandError(), text));
}

static void refused(void)
{
    struct sun2xp_reflex good = rule(SUN2XP_WHEN_FORCE_ABOVE, 1, SUN2XP_THEN_HOLD), wrong;
    int count, last;

    wrong = good, wrong.size = 8;
    refuse(wrong, EINVAL, "size");
    wrong = good, wrong.condition = 77;
    refuse(wrong, EINVAL, "WHEN_");
    wrong = good, wrong.reaction = 0;
    refuse(wrong, EINVAL, "THEN_");
    wrong = good, wrong.condition = SUN2XP_WHEN_EVENT;
    refuse(wrong, EINVAL, "EVENT_");
    wrong = rule(SUN2XP_WHEN_JOINT_ABOVE, 1, SUN2XP_THEN_HOLD), wrong.joint = 3;
    refuse(wrong, EINVAL, "joint 3");
    wrong.joint = -1;
    refuse(wrong, EINVAL, "joint -1");
    wrong = good, wrong.bound = -1;
    refuse(wrong, ERANGE, "force");
    wrong = rule(SUN2XP_WHEN_LINK_LOST, 1e9, SUN2XP_THEN_HOLD);
    refuse(wrong, ERANGE, "time");
    wrong = rule(SUN2XP_WHEN_OTHER_FINGER, 0, SUN2XP_THEN_HOLD), wrong.finger = 1, wrong.event = SUN2XP_EVENT_SLIP;
    refuse(wrong, EINVAL, "of the same finger");
    wrong = rule(SUN2XP_WHEN_FORCE_ABOVE, 1, SUN2XP_THEN_RETRACT), wrong.position[0] = 9;
    refuse(wrong, ERANGE, "joint 0");
    wrong = rule(SUN2XP_WHEN_FORCE_ABOVE, 1, SUN2XP_THEN_SOFTEN), wrong.stiffness[0][0] = -1;
    CHECK(sun2xp_install_reflex(HAND, 1, &wrong) < 0);
    CHECK(sun2xp_install_reflex(HAND, 4, &good) < 0 && errno == EINVAL);
    CHECK(sun2xp_remove_reflex(HAND, 1, 5) < 0 && errno == ENOENT && sun2xp_remove_reflex(HAND, 1, -5) < 0);
    for (count = 0, last = 0; count < 16; count++) {
        int number = sun2xp_install_reflex(HAND, 1, &good);
        CHECK(number > last);
        last = number;
    }
    refuse(good, ENOSPC, "16");
    CHECK(sun2xp_remove_reflex(HAND, 1, last) == 0 && sun2xp_remove_reflex(HAND, 1, last) < 0 &&
        sun2xp_install_reflex(HAND, 1, &good) > last);
    CHECK(sun2xp_remove_reflex(HAND, 1, 0) == 0 && sun2xp_remove_reflex(HAND, 1, 0) == 0);
}

/* Finger 2 bends until its joint 2 is beyond a bound. Its reflex holds it there, and finger 1 softens. */
static void fired(void)
{
    static double start[3] = {0.0, 0.5, 0.8}, far[3] = {0.0, 0.5, 1.4}, found[3];
    struct sun2xp_reflex hold = rule(SUN2XP_WHEN_JOINT_ABOVE, 1.1, SUN2XP_THEN_HOLD),
            soften = rule(SUN2XP_WHEN_OTHER_FINGER, 0, SUN2XP_THEN_SOFTEN);
    struct sun2xp_event Event;
    int numbers[2], seen = 0;

    hold.joint = 2;
    soften.event = SUN2XP_EVENT_REFLEX_FIRED;
    soften.finger = 2;
    soften.stiffness[0][0] = soften.stiffness[1][1] = soften.stiffness[2][2] = 0.5;
    memset(&Event, 0, sizeof Event);
    Event.size = sizeof Event;
    CHECK(SendPos(2, start) == 0);
    do
        CHECK(sun2xp_wait_event(HAND, &Event, 20.0) == 1);
    while (Event.kind != SUN2XP_EVENT_SETTLED || Event.finger != 2);
    CHECK((numbers[1] = sun2xp_install_reflex(HAND, 2, &hold)) > 0 && (numbers[0] = sun2xp_install_reflex(HAND, 1,
            &soften)) > 0);
    CHECK(SendPos(2, far) == 0);
    while (seen != 3) {
        CHECK(sun2xp_wait_event(HAND, &Event, 20.0) == 1);
        if (Event.kind == SUN2XP_EVENT_REFLEX_FIRED) {
            CHECK(Event.finger <= 2 && Event.values[0] == numbers[Event.finger - 1]);
            seen |= Event.finger;
        }
    }
    PAUSE_MS(500);
    CHECK(GetPos(2, found) == 0 && found[2] > 1.0 && found[2] < 1.3);
    CHECK(sun2xp_remove_reflex(HAND, 1, 0) == 0 && sun2xp_remove_reflex(HAND, 2, 0) == 0);
}

int main(void)
{
    struct sun2xp_reflex good = rule(SUN2XP_WHEN_FORCE_ABOVE, 1, SUN2XP_THEN_HOLD);

    CHECK(sun2xp_install_reflex(HAND, 1, &good) < 0 && errno == ENODEV);
    CHECK(sun2xp_install_reflex(HAND, 1, NULL) < 0 && errno == EFAULT);
    CHECK(OpenHand() == 0);
    refused();
    fired();
    CloseHand();
    CHECK(sun2xp_remove_reflex(HAND, 1, 0) < 0 && errno == ENODEV);
    return 0;
}
