/* A planner takes events, waits for them, and gets them by a callback and by a descriptor. CloseHand ends every wait.
   The callback may call it too. */
#include <poll.h>
#include <pthread.h>
#include <stddef.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"
#include "refused.h"

enum { PATIENCE_MS = 20000 };

static double Near[3] = {0.1, 0.5, 1.0}, Far[3] = {0.2, 0.6, 1.1};
static volatile int calls, settled, closed, entered;
static int context;

/* Waits until a callback has set this number. */
static void wait_for(volatile int *number)
{
    int tries;

    for (tries = 0; *number == 0; tries++) {
        CHECK(tries < PATIENCE_MS);
        PAUSE_MS(1);
    }
}

/* Waits until this finger has settled. */
static void wait_until_settled(int finger)
{
    struct sun2xp_event Event;

    do {
        memset(&Event, 0, sizeof Event);
        Event.size = sizeof Event;
        CHECK(sun2xp_wait_event(HAND, &Event, PATIENCE_MS / 1000.0) == 1);
        CHECK(Event.size == sizeof Event && Event.lost == 0);
    } while (Event.kind != SUN2XP_EVENT_SETTLED || Event.finger != finger);
    CHECK(Event.part == 0 && APART(Event.values[2], Far[2]) + APART(Event.values[2], Near[2]) < 0.3);
}

static void taken_in_order(void)
{
    struct sun2xp_event Event;
    struct sun2xp_record Record;
    double time = 0;
    int arrived = 0;

    memset(&Event, 0, sizeof Event);
    CHECK(SendPos(2, Far) == 0);
    do {
        Event.size = sizeof Event;
        if (sun2xp_next_event(HAND, &Event) == 0) {
            PAUSE_MS(1);
            continue;
        }
        CHECK(Event.time >= time);
        time = Event.time;
        arrived |= Event.finger == 2 && Event.kind == SUN2XP_EVENT_ARRIVED;
    } while (Event.kind != SUN2XP_EVENT_SETTLED || Event.finger != 2);
    CHECK(arrived);
    /* The record of a cycle can be read before the events of this cycle arrive. */
    Record.size = sizeof Record;
    CHECK(sun2xp_record(HAND, 2, Event.cycle, &Record) == 0 && Record.cycle == Event.cycle);
    CHECK(sun2xp_next_event(HAND, &Event) == 0 && sun2xp_wait_event(HAND, &Event, 0) == 0 &&
        sun2xp_wait_event(HAND, &Event, 0.02) == 0);
    Event.size = offsetof(struct sun2xp_event, values);
    REFUSED(sun2xp_next_event(HAND, &Event), EINVAL, "size");
}

static void note(const struct sun2xp_event *Event, void *Context)
{
    double Pos[3];

    CHECK(Context == &context && Event->size == sizeof *Event);
    CHECK(GetPos(Event->finger, Pos) == 0);
    calls++;
    settled += Event->kind == SUN2XP_EVENT_SETTLED;
}

static void by_callback(void)
{
    int before;

    CHECK(sun2xp_on_event(HAND, note, &context) == 0);
    CHECK(SendPos(1, Far) == 0);
    wait_until_settled(1);
    wait_for(&settled);
    CHECK(sun2xp_on_event(HAND, NULL, NULL) == 0);
    before = calls;
    CHECK(SendPos(1, Near) == 0);
    wait_until_settled(1);
    CHECK(calls == before);
}

static void by_descriptor(void)
{
    struct pollfd Ready;
    struct sun2xp_event Event;
    int done = 0;

    Ready.fd = sun2xp_event_descriptor(HAND);
    Ready.events = POLLIN;
    CHECK(Ready.fd > 2 && sun2xp_event_descriptor(HAND) == Ready.fd);
    Event.size = sizeof Event;
    while (sun2xp_next_event(HAND, &Event) == 1)
        ;
    CHECK(poll(&Ready, 1, 0) == 0);
    CHECK(SendPos(3, Far) == 0);
    while (!done) {
        CHECK(poll(&Ready, 1, PATIENCE_MS) == 1 && Ready.revents == POLLIN);
        while (sun2xp_next_event(HAND, &Event) == 1)
            done |= Event.kind == SUN2XP_EVENT_SETTLED;
    }
    CHECK(poll(&Ready, 1, 20) == 0);
}

static void in_a_child(void)
{
    struct sun2xp_event Event;
    int status;
    pid_t process = fork();

    CHECK(process >= 0);
    if (process == 0) {
        Event.size = sizeof Event;
        REFUSED(sun2xp_next_event(HAND, &Event), EPERM, "forked");
        REFUSED(sun2xp_wait_event(HAND, &Event, -1), EPERM, "forked");
        REFUSED(sun2xp_on_event(HAND, note, &context), EPERM, "forked");
        REFUSED(sun2xp_event_descriptor(HAND), EPERM, "forked");
        _exit(0);
    }
    CHECK(waitpid(process, &status, 0) == process && WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

static void *wait_without_limit(void *unused)
{
    struct sun2xp_event Event;

    (void)unused;
    Event.size = sizeof Event;
    while (sun2xp_wait_event(HAND, &Event, -1) == 1)
        ;
    CHECK(errno == ENODEV);
    return NULL;
}

static void close_inside(const struct sun2xp_event *Event, void *Context)
{
    (void)Event;
    (void)Context;
    CHECK(CloseHand() == 0);
    CHECK(sun2xp_on_event(HAND, NULL, NULL) < 0 && errno == ENODEV);
    closed = 1;
}

/* Calls OpenHand until main is in CloseHand, which waits for this callback. Every call is refused with EBUSY: at first
   because the hand is open, and then because main closes it. */
static void open_inside(const struct sun2xp_event *Event, void *Context)
{
    int tries;

    (void)Event;
    (void)Context;
    entered = 1;
    for (tries = 0; strstr(HandError(), "event callback must not wait") == NULL; tries++) {
        CHECK(tries < PATIENCE_MS && OpenHand() == -1 && errno == EBUSY);
        PAUSE_MS(1);
    }
    REFUSED(CloseHand(), EBUSY, "return from the callback");
}

int main(void)
{
    pthread_t waiting[2];
    int place;

    CHECK(OpenHand() == 0);
    taken_in_order();
    by_callback();
    by_descriptor();
    in_a_child();
    for (place = 0; place < 2; place++)
        CHECK(pthread_create(&waiting[place], NULL, wait_without_limit, NULL) == 0);
    CHECK(sun2xp_on_event(HAND, note, &context) == 0);
    PAUSE_MS(20);
    CHECK(CloseHand() == 0);
    for (place = 0; place < 2; place++)
        CHECK(pthread_join(waiting[place], NULL) == 0);

    CHECK(OpenHand() == 0 && sun2xp_on_event(HAND, close_inside, NULL) == 0 && SendPos(1, Far) == 0);
    wait_for(&closed);
    CHECK(CloseHand() == 0);

    CHECK(OpenHand() == 0 && sun2xp_on_event(HAND, open_inside, NULL) == 0 && SendPos(1, Far) == 0);
    wait_for(&entered);
    CHECK(CloseHand() == 0);

    /* The exit handlers run while a callback is installed and a thread waits. */
    CHECK(OpenHand() == 0 && sun2xp_on_event(HAND, note, &context) == 0);
    CHECK(pthread_create(&waiting[0], NULL, wait_without_limit, NULL) == 0);
    CHECK(SendPos(1, Far) == 0);
    PAUSE_MS(20);
    return 0;
}
