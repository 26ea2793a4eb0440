/* Memory runs out while a hand is open: malloc and its relatives return NULL from some moment on. The hand keeps
   running, and no call ends the process: quick calls work, slow calls are refused with ENOMEM, and CloseHand closes
   the hand. */
#include <errno.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"

/* The glibc functions behind the names that this program redefines. */
extern void *__libc_malloc(size_t), *__libc_calloc(size_t, size_t), *__libc_realloc(void *, size_t);
extern void *__libc_memalign(size_t, size_t);

static volatile int is_out;

static void *nothing(void)
{
    errno = ENOMEM;
    return NULL;
}

void *malloc(size_t size) { return is_out ? nothing() : __libc_malloc(size); }
void *calloc(size_t count, size_t size) { return is_out ? nothing() : __libc_calloc(count, size); }
void *realloc(void *block, size_t size) { return is_out ? nothing() : __libc_realloc(block, size); }

int posix_memalign(void **block, size_t alignment, size_t size)
{
    *block = is_out ? NULL : __libc_memalign(alignment, size);
    return *block == NULL ? ENOMEM : 0;
}

#define REFUSED(Call, Number, Words) \
    do { \
        errno = 0; \
        CHECK((Call) < 0 && errno == (Number)); \
        CHECK(strstr(HandError(), Words) != NULL); \
    } while (0)

static void quick_calls(void)
{
    float Pos[3] = {0.1f, 0.5f, 0.9f};
    double Kx[3][3] = {{3, 0, 0}, {0, 3, 0}, {0, 0, 3}}, Tip[3] = {0.0, -6.0, 8.0};
    struct sun2xp_status Status;
    struct sun2xp_timing Timing;
    struct sun2xp_tip At;
    struct sun2xp_record Record;
    struct sun2xp_fault Fault;

    Status.size = sizeof Status;
    Timing.size = sizeof Timing;
    At.size = sizeof At;
    Record.size = sizeof Record;
    Fault.size = sizeof Fault;
    CHECK(SendPos(1, Pos) == 0);
    CHECK(SendKx(1, Kx) == 0);
    CHECK(sun2xp_send_tip(HAND, 1, Tip) == 0);
    CHECK(sun2xp_send_contact(HAND, 1, 3, &Kx[0][0], NULL) == 0);
    CHECK(sun2xp_send_damping(HAND, 1, 1.0) == 0);
    CHECK(GetPos(1, Pos) == 0);
    CHECK(sun2xp_tip(HAND, 1, &At) == 0);
    CHECK(sun2xp_status(HAND, 1, &Status) == 0 && Status.state == SUN2XP_STATE_RUNNING);
    CHECK(sun2xp_timing(HAND, 1, SUN2XP_STAGE_CYCLE, &Timing) == 0);
    CHECK(sun2xp_reset_timing(HAND, 1) == 0);
    CHECK(sun2xp_record(HAND, 1, 0, &Record) == 0);
    CHECK(sun2xp_fault(HAND, 1, &Fault) == 0 && Fault.number == 0);
    REFUSED(SendPos(9, Pos), EINVAL, "no finger 9");
    REFUSED(SendPos(1, (float *)NULL), EFAULT, "null pointer");
    CHECK(sun2xp_set_gravity(HAND, Tip) == 0);
    Tip[1] = 101;
    REFUSED(sun2xp_set_gravity(HAND, Tip), EINVAL, "gravity[1] is 101.0 m/s^2");
    Pos[0] = 9;
    REFUSED(SendPos(1, Pos), ERANGE, "outside the limits");
}

#define THREADS 8
#define TURNS 2000
static volatile int go;

/* Runs in several threads at once, so that they wait for the same locks. */
static void *another_thread(void *own)
{
    int turn;

    while (!go)
        PAUSE_MS(1);
    for (turn = 0; turn < TURNS; turn++)
        quick_calls();
    return own;
}

int main(void)
{
    pthread_t threads[THREADS];
    float Pos[3] = {0.1f, 0.5f, 0.9f};
    struct sun2xp_fault Fault;
    int number;
    Fault.size = sizeof Fault;

    is_out = 1;
    REFUSED(OpenHand(), ENOMEM, "memory");
    is_out = 0;
    CHECK(OpenHand() == 0);
    for (number = 0; number < THREADS; number++)
        CHECK(pthread_create(&threads[number], NULL, another_thread, Pos) == 0);
    PAUSE_MS(50);

    is_out = 1;
    quick_calls();
    go = 1;
    for (number = 0; number < THREADS; number++) {
        void *end = NULL;
        CHECK(pthread_join(threads[number], &end) == 0 && end == Pos);
    }
    REFUSED(sun2xp_adjust(HAND, 1, "tendon.minimum = 6"), ENOMEM, "memory");
    REFUSED(sun2xp_write_black_box(HAND, 1, "no_memory.jsonl"), ENOMEM, "memory");
    REFUSED(sun2xp_zero(HAND, 1), ENOMEM, "memory");
    /* Meanwhile the library's own threads do their periodic work, every 50 ms and every second. The pause is also
       longer than a black box takes to become full. */
    PAUSE_MS(3500);
    quick_calls();
    CHECK(sun2xp_stop_all() == 0);
    PAUSE_MS(200);
    CHECK(sun2xp_fault(HAND, 1, &Fault) == 0 && Fault.number == SUN2XP_FAULT_EMERGENCY_STOP_CALL);
    REFUSED(SendPos(1, Pos), EIO, "faulted");
    REFUSED(sun2xp_recover(HAND, 1), ENOMEM, "memory");
    CHECK(CloseHand() == 0);
    REFUSED(SendPos(1, Pos), ENODEV, "no hand is open");
    is_out = 0;
    CHECK(OpenHand() == 0);
    CHECK(CloseHand() == 0);
    return 0;
}
