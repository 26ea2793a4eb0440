/* Threads that are cancelled inside calls. The call completes. After it, a deferred cancellation takes effect at the
   next cancellation point in the planner's own code. An asynchronous cancellation takes effect as soon as the call has
   returned. */
#include <errno.h>
#include <pthread.h>
#include <stdint.h>
#include <string.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"

#define HAMMERINGS 300

/* Exit status if a recovery is refused. A pause of the machine may delay the answers of the board by too much, and the
   test that runs this program measures such pauses. */
#define NOT_RECOVERED 2

static double Pos[3] = {0.0, 0.5, 0.8}, Kx[3][3] = {{3, 0, 0}, {0, 3, 0}, {0, 0, 3}};

/* The call that a thread makes, whether its cancellation is asynchronous, whether the thread has begun the call, and
   the result of the call. The result is 2 while the call has not returned. */
struct job {
    int (*call)(void);
    int asynchronous;
    volatile int begun;
    volatile int result;
};

static int zero(void) { return sun2xp_zero(HAND, 1); }
static int identify(void) { return sun2xp_identify(HAND, 2); }
static int write_black_box(void) { return sun2xp_write_black_box(HAND, 3, "cancelled.jsonl"); }
static int event_descriptor(void) { return sun2xp_event_descriptor(HAND) >= 0 ? 0 : -1; }
static int adjust(void) { return sun2xp_adjust(HAND, 3, "tendon.minimum = 6"); }

static sun2xp_hand *other;
static int open_another(void) { return sun2xp_open_named("nominal", &other); }
static int close_another(void) { return sun2xp_close(other); }

/* First takes the events that have happened already, because they would end the wait at once. */
static int wait_for_event(void)
{
    struct sun2xp_event event;
    event.size = sizeof event;
    while (sun2xp_next_event(other, &event) == 1)
        ;
    return sun2xp_wait_event(other, &event, 0.1) < 0 ? -1 : 0;
}

/* The reason of the last refused recovery. HandError returns it only in the thread that made the call. */
static char refusal[1000];

static int recover_finger(int finger)
{
    int result = sun2xp_recover(HAND, finger);
    if (result != 0)
        sprintf(refusal, "finger %d: %.900s", finger, HandError());
    return result;
}

static int recover(void) { return recover_finger(1); }

/* This refusal is the first of its kind in this process, so the library prints a message. */
static int refused(void) { return SendPos(1, NULL) == -1 && errno == EFAULT ? 0 : -1; }

static void *work(void *own)
{
    struct job *job = own;
    int unused;
    if (job->asynchronous)
        pthread_setcanceltype(PTHREAD_CANCEL_ASYNCHRONOUS, &unused);
    job->begun = 1;
    job->result = job->call();
    for (;;)
        pthread_testcancel();
    return NULL;
}

/* Cancels a thread some time after it has begun a call. Returns the result of the call. */
static int cancelled_in(int (*call)(void), int asynchronous, int milliseconds)
{
    struct job job;
    pthread_t thread;
    void *end;
    job.call = call;
    job.asynchronous = asynchronous;
    job.begun = 0;
    job.result = 2;
    CHECK(pthread_create(&thread, NULL, work, &job) == 0);
    while (!job.begun)
        PAUSE_MS(1);
    PAUSE_MS(milliseconds);
    CHECK(pthread_cancel(thread) == 0);
    CHECK(pthread_join(thread, &end) == 0);
    CHECK(end == PTHREAD_CANCELED);
    return job.result;
}

/* Cancels a thread some time after it has begun a call, which must complete. */
static void complete_in_cancelled_thread(int (*call)(void), int asynchronous, int milliseconds)
{
    int result = cancelled_in(call, asynchronous, milliseconds);
    /* An asynchronous cancellation may take effect before the thread can store the result. */
    CHECK(result == 0 || (asynchronous && result == 2));
}

/* Ends the program if a recovery was refused. */
static void check_recovery(int result)
{
    if (result < 0) {
        fprintf(stderr, "a recovery was refused: %s\n", refusal);
        exit(NOT_RECOVERED);
    }
}

/* Stops the hand, and cancels the thread that recovers finger 1. Then recovers every finger. */
static void recover_in_cancelled_thread(int asynchronous)
{
    int finger, result;
    CHECK(sun2xp_stop_all() == 0);
    PAUSE_MS(50);
    result = cancelled_in(recover, asynchronous, 10);
    check_recovery(result);
    CHECK(result == 0 || (asynchronous && result == 2));
    for (finger = 1; finger <= 3; finger++)
        check_recovery(recover_finger(finger));
}

/* Makes calls without a pause until it is cancelled. */
static void *hammer(void *own)
{
    int unused;
    double Measured[3];
    struct sun2xp_tip Tip;
    Tip.size = sizeof Tip;
    pthread_setcanceltype(*(int *)own ? PTHREAD_CANCEL_ASYNCHRONOUS : PTHREAD_CANCEL_DEFERRED, &unused);
    for (;;) {
        SendPos(1, Pos);
        GetPos(1, Measured);
        SendKx(1, Kx);
        SendPos(1, NULL);
        sun2xp_tip(HAND, 1, &Tip);
        HandError();
        sun2xp_fault_text(3);
        pthread_testcancel();
    }
    return NULL;
}

int main(void)
{
    struct job identifying = {identify, 0, 0, 2};
    int asynchronous, round;
    double Measured[3];
    pthread_t thread;
    void *end;

    for (asynchronous = 0; asynchronous < 2; asynchronous++) {
        complete_in_cancelled_thread(OpenHand, asynchronous, 20);
        CHECK(GetPos(1, Measured) == 0);
        if (!asynchronous)
            CHECK(cancelled_in(refused, 0, 0) == 0);
        complete_in_cancelled_thread(zero, asynchronous, 100);
        complete_in_cancelled_thread(write_black_box, asynchronous, 2);
        complete_in_cancelled_thread(adjust, asynchronous, 0);
        complete_in_cancelled_thread(event_descriptor, asynchronous, 0);
        complete_in_cancelled_thread(sun2xp_stop_all, asynchronous, 0);
        other = NULL;
        complete_in_cancelled_thread(open_another, asynchronous, 20);
        CHECK(other != NULL);
        complete_in_cancelled_thread(wait_for_event, asynchronous, 20);
        complete_in_cancelled_thread(close_another, asynchronous, 5);
        CHECK(sun2xp_close(other) < 0);
        recover_in_cancelled_thread(asynchronous);
        for (round = 0; round < HAMMERINGS; round++) {
            struct timespec span = {0, 0};
            span.tv_nsec = 20000 + 137 * round;
            CHECK(pthread_create(&thread, NULL, hammer, &asynchronous) == 0);
            nanosleep(&span, NULL);
            CHECK(pthread_cancel(thread) == 0);
            CHECK(pthread_join(thread, &end) == 0 && end == PTHREAD_CANCELED);
        }
        /* The cancelled calls must have released every lock. */
        CHECK(SendPos(1, Pos) == 0 && SendKx(1, Kx) == 0 && GetPos(1, Measured) == 0);
        complete_in_cancelled_thread(CloseHand, asynchronous, 5);
        CHECK(GetPos(1, Measured) == -1 && errno == ENODEV);
    }
    /* An identification takes a minute. CloseHand ends it early. */
    CHECK(OpenHand() == 0);
    CHECK(pthread_create(&thread, NULL, work, &identifying) == 0);
    PAUSE_MS(300);
    CHECK(pthread_cancel(thread) == 0);
    PAUSE_MS(100);
    CHECK(identifying.result == 2);
    CHECK(CloseHand() == 0);
    CHECK(pthread_join(thread, &end) == 0 && end == PTHREAD_CANCELED);
    CHECK(identifying.result < 0);
    return 0;
}
