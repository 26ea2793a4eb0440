/* A planner with a floating-point environment of its own, which the first argument selects: "upward" rounding,
   denormals "flushed" to zero, or "trapping" exceptions. The library computes in the default environment, both in its
   threads and in the calls, and every call restores the planner's environment and exception flags. The black box goes
   to the file in the second argument. */
#define _GNU_SOURCE
#include <errno.h>
#include <fenv.h>
#include <math.h>
#include <string.h>
#if defined(__x86_64__)
#include <xmmintrin.h>
#endif
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"

static int rounding, traps;
#if defined(__x86_64__)
static unsigned csr;
#endif

/* Clears every flag and stores the rest of the environment. */
static void note(void)
{
    feclearexcept(FE_ALL_EXCEPT);
    rounding = fegetround();
    traps = fegetexcept();
#if defined(__x86_64__)
    csr = _mm_getcsr();
#endif
}

static int is_as_noted(void)
{
#if defined(__x86_64__)
    if (_mm_getcsr() != csr)
        return 0;
#endif
    return fetestexcept(FE_ALL_EXCEPT) == 0 && fegetround() == rounding && fegetexcept() == traps;
}

#define KEEPS(Call) \
    do { \
        note(); \
        Call; \
        CHECK(is_as_noted()); \
    } while (0)

static double Pos[3] = {0.1, 0.5, 0.8}, Kx[3][3] = {{3, 0.1, 0}, {0.1, 3, 0}, {0, 0, 2.3}}, Measured[3];

static void change_environment(const char *way)
{
    if (strcmp(way, "upward") == 0)
        fesetround(FE_UPWARD);
    if (strcmp(way, "trapping") == 0)
        feenableexcept(FE_UNDERFLOW | FE_OVERFLOW | FE_DIVBYZERO | FE_INVALID | FE_INEXACT);
#if defined(__x86_64__)
    if (strcmp(way, "flushed") == 0)
        _mm_setcsr(_mm_getcsr() | 0x8040);
#endif
}

static void quick_calls(void)
{
    double Tip[3] = {0.0, -6.0, 8.0}, Normal[3] = {0.3, -1, 0.2}, Stiff = 3.1, Tiny[3] = {1e-310, 0.5, 0.8};
    float Single[3] = {0.1f, 0.5f, 0.8f};
    struct sun2xp_tip Found;
    struct sun2xp_status Status;
    struct sun2xp_timing Timing;
    struct sun2xp_record Record;
    struct sun2xp_fault Fault;

    Found.size = sizeof Found;
    Status.size = sizeof Status;
    Timing.size = sizeof Timing;
    Record.size = sizeof Record;
    Fault.size = sizeof Fault;
    KEEPS(CHECK(SendPos(1, Pos) == 0));
    KEEPS(CHECK(SendPos(2, Single) == 0));
    KEEPS(CHECK(SendPos(3, Tiny) == 0));
    KEEPS(CHECK(SendKx(1, Kx) == 0));
    KEEPS(CHECK(GetPos(1, Measured) == 0));
    KEEPS(CHECK(GetPos(1, Single) == 0));
    KEEPS(CHECK(sun2xp_send_tip(HAND, 1, Tip) == 0));
    KEEPS(CHECK(sun2xp_tip(HAND, 1, &Found) == 0));
    KEEPS(CHECK(sun2xp_send_contact(HAND, 2, 1, &Stiff, Normal) == 0));
    KEEPS(CHECK(sun2xp_send_damping(HAND, 2, 1.0) == 0));
    KEEPS(CHECK(sun2xp_status(HAND, 1, &Status) == 0));
    KEEPS(CHECK(sun2xp_timing(HAND, 1, SUN2XP_STAGE_COMPUTE, &Timing) == 0));
    KEEPS(CHECK(sun2xp_record(HAND, 1, 0, &Record) == 0));
    KEEPS(CHECK(sun2xp_fault(HAND, 1, &Fault) == 0));
}

/* These refusals write numbers into their texts. */
static void refused_calls(void)
{
    Kx[0][1] = 2.7;
    KEEPS(CHECK(SendKx(1, Kx) == -1 && errno == EDOM));
    Pos[0] = 1e9 / 3.0;
    KEEPS(CHECK(SendPos(1, Pos) == -1 && errno == ERANGE));
}

static void slow_calls(const char *black_box)
{
    KEEPS(CHECK(sun2xp_adjust(HAND, 1, "tendon.minimum = 6.1") == 0));
    PAUSE_MS(200);
    KEEPS(CHECK(sun2xp_zero(HAND, 2) == 0));
    KEEPS(CHECK(sun2xp_write_black_box(HAND, 1, black_box) == 0));
    KEEPS(sun2xp_stop_all());
    PAUSE_MS(50);
    KEEPS(CHECK(sun2xp_recover(HAND, 1) == 0));
}

int main(int count, char **arguments)
{
    int round;

    CHECK(count == 3);
    change_environment(arguments[1]);
    KEEPS(CHECK(GetPos(1, Measured) == -1 && errno == ENODEV));
    KEEPS(CHECK(OpenHand() == 0));
    for (round = 0; round < 20; round++) {
        quick_calls();
        PAUSE_MS(10);
    }
    refused_calls();
    slow_calls(arguments[2]);
    KEEPS(CHECK(CloseHand() == 0));
    return 0;
}
