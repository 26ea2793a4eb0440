/* Events: taken, waited for, by callback and by descriptor. CloseHand ends every wait, also in the callback. */
#include <poll.h>
#include <pthread.h>
#include <stddef.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include "Sun2Xp.h"
#include "check.h"
#include "refused.h"

enum { PATIENCE_MS = 20000 };

static double Near[3] = {0.1, 0.5, 1.0}, Far[3] = {0.2, 0.6, 1.1};
static volatile int calls, settled, closed;
static int context;

/* Waits until this finger has settled. */
static void wait_until_settled(int finger)
{
    struct Event Event;

    do {
        memset(&Event, 0, sizeof Event);
        Event.Size = sizeof Event;
        CHECK(WaitEvent(&Event, PATIENCE_MS) == 1);
        CHECK(Event.Size == sizeof Event && Event.Lost == 0);
    } while (Event.Kind != EVENT_SETTLED || Event.Finger != finger);
    CHECK(Event.Part == 0 && APART(Event.Values[2], Far[2]) + APART(Event.Values[2], Near[2]) < 0.3);
}

static void taken_in_order(void)
{
    struct Event Event;
    struct FingerRecord Record;
    double time = 0;
    int arrived = 0;

    memset(&Event, 0, sizeof Event);
    CHECK(SendPos(2, Far) == 0);
    do {
        Event.Size = sizeof Event;
        if (NextEvent(&Event) == 0) {
            PAUSE_MS(1);
            continue;
        }
        CHECK(Event.Time >= time);
        time = Event.Time;
        arrived |= Event.Finger == 2 && Event.Kind == EVENT_ARRIVED;
    } while (Event.Kind != EVENT_SETTLED || Event.Finger != 2);
    CHECK(arrived);
    /* The record of the cycle of an event is there before the event. */
    Record.Size = sizeof Record;
    CHECK(GetRecord(2, Event.Cycle, &Record) == 0 && Record.Cycle == Event.Cycle);
    CHECK(NextEvent(&Event) == 0 && WaitEvent(&Event, 0) == 0 && WaitEvent(&Event, 20) == 0);
    Event.Size = offsetof(struct Event, Values);
    REFUSED(NextEvent(&Event), EINVAL, "Size");
}

static void note(const struct Event *Event, void *Context)
{
    double Pos[3];

    CHECK(Context == &context && Event->Size == sizeof *Event);
    CHECK(GetPos(Event->Finger, Pos) == 0);
    calls++;
    settled += Event->Kind == EVENT_SETTLED;
}

static void by_callback(void)
{
    int before;

    CHECK(OnEvent(note, &context) == 0);
    CHECK(SendPos(1, Far) == 0);
    wait_until_settled(1);
    for (before = 0; settled == 0; before++) {
        CHECK(before < PATIENCE_MS);
        PAUSE_MS(1);
    }
    CHECK(OnEvent(NULL, NULL) == 0);
    before = calls;
    CHECK(SendPos(1, Near) == 0);
    wait_until_settled(1);
    CHECK(calls == before);
}

static void by_descriptor(void)
{
    struct pollfd Ready;
    struct Event Event;
    int done = 0;

    Ready.fd = EventDescriptor();
    Ready.events = POLLIN;
    CHECK(Ready.fd > 2 && EventDescriptor() == Ready.fd);
    Event.Size = sizeof Event;
    while (NextEvent(&Event) == 1)
        ;
    CHECK(poll(&Ready, 1, 0) == 0);
    CHECK(SendPos(3, Far) == 0);
    while (!done) {
        CHECK(poll(&Ready, 1, PATIENCE_MS) == 1 && Ready.revents == POLLIN);
        while (NextEvent(&Event) == 1)
            done |= Event.Kind == EVENT_SETTLED;
    }
    CHECK(poll(&Ready, 1, 20) == 0);
}

static void in_a_child(void)
{
    struct Event Event;
    int status;
    pid_t process = fork();

    CHECK(process >= 0);
    if (process == 0) {
        Event.Size = sizeof Event;
        REFUSED(NextEvent(&Event), EPERM, "forked");
        REFUSED(WaitEvent(&Event, -1), EPERM, "forked");
        REFUSED(OnEvent(note, &context), EPERM, "forked");
        REFUSED(EventDescriptor(), EPERM, "forked");
        _exit(0);
    }
    CHECK(waitpid(process, &status, 0) == process && WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

static void *wait_without_limit(void *unused)
{
    struct Event Event;

    (void)unused;
    Event.Size = sizeof Event;
    while (WaitEvent(&Event, -1) == 1)
        ;
    CHECK(errno == ENODEV);
    return NULL;
}

static void close_inside(const struct Event *Event, void *Context)
{
    (void)Event;
    (void)Context;
    CHECK(CloseHand() == 0);
    CHECK(OnEvent(NULL, NULL) == -1 && errno == ENODEV);
    closed = 1;
}

int main(void)
{
    pthread_t waiting[2];
    int place, tries;

    CHECK(OpenHand() == 0);
    taken_in_order();
    by_callback();
    by_descriptor();
    in_a_child();
    for (place = 0; place < 2; place++)
        CHECK(pthread_create(&waiting[place], NULL, wait_without_limit, NULL) == 0);
    CHECK(OnEvent(note, &context) == 0);
    PAUSE_MS(20);
    CHECK(CloseHand() == 0);
    for (place = 0; place < 2; place++)
        CHECK(pthread_join(waiting[place], NULL) == 0);

    CHECK(OpenHand() == 0 && OnEvent(close_inside, NULL) == 0 && SendPos(1, Far) == 0);
    for (tries = 0; !closed; tries++) {
        CHECK(tries < PATIENCE_MS);
        PAUSE_MS(1);
    }
    CHECK(CloseHand() == 0);

    /* The exit handlers run while a callback is installed and a thread waits. */
    CHECK(OpenHand() == 0 && OnEvent(note, &context) == 0);
    CHECK(pthread_create(&waiting[0], NULL, wait_without_limit, NULL) == 0);
    CHECK(SendPos(1, Far) == 0);
    PAUSE_MS(20);
    return 0;
}
