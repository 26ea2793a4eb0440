/* In a forked child every call that opens, closes, reads or commands a hand is refused, except sun2xp_stop_all, which
   does nothing. Many arguments are wrong on purpose: the refusal of a forked child must come before all others. The
   child ends without touching the hand. The parent's hand keeps running. */
#include <errno.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"

/* A test of the manual reads the lines with REFUSED or WORKS, and checks that no call of the library is missing. */
#define REFUSED(Call) (errno = 0, check_refused(#Call, (Call)))
#define WORKS(Condition) \
    do { \
        errno = 0; \
        CHECK((Condition) && errno == 0); \
    } while (0)

static sun2xp_hand *Opened;
static double Pos[3] = {0.0, 0.5, 0.9};

/* Checks that the last refusal is that of `call`, and that it has errno EPERM and the number SUN2XP_ERROR_FORKED. */
static void check_refused(const char *call, int result)
{
    int number = errno;
    struct sun2xp_error Error;

    Error.size = sizeof Error;
    CHECK(sun2xp_error(NULL, &Error) == 0);
    if (result < 0 && number == EPERM && Error.number == SUN2XP_ERROR_FORKED
        && (result == -1 || result == -SUN2XP_ERROR_FORKED) && strncmp(call, Error.call, strlen(Error.call)) == 0)
        return;
    fprintf(stderr, "%s: %d, errno %d (%s)\n", call, result, number, HandError());
    exit(1);
}

static void calls_of_1990(void)
{
    REFUSED(SendPos(1, Pos));
    REFUSED(SendPos(1, (float *)NULL));
    REFUSED(SendPosD(1, Pos));
    REFUSED(SendKx(1, (float *)NULL));
    REFUSED(SendKxD(9, NULL));
    REFUSED(GetPos(1, Pos));
    REFUSED(GetPosD(9, NULL));
    REFUSED(OpenHand());
    REFUSED(CloseHand());
    WORKS(strstr(HandError(), "forked") != NULL);
}

static void opening_and_closing(void)
{
    sun2xp_hand *Other = NULL;

    REFUSED(sun2xp_open(NULL, &Other));
    REFUSED(sun2xp_open_text("", &Other));
    REFUSED(sun2xp_open_named("nominal", &Other));
    REFUSED(sun2xp_open_io(NULL, 9, NULL, &Other));
    REFUSED(sun2xp_open_io_text("", 0, NULL, &Other));
    REFUSED(sun2xp_close(HAND));
    REFUSED(sun2xp_close(NULL));
    CHECK(Other == NULL);
}

static void set_points(void)
{
    REFUSED(sun2xp_send_position(HAND, 1, Pos));
    REFUSED(sun2xp_send_position_for(HAND, 9, Pos, -1));
    REFUSED(sun2xp_send_stiffness(HAND, 9, NULL));
    REFUSED(sun2xp_send_tip(HAND, 1, Pos));
    REFUSED(sun2xp_send_contact(HAND, 9, 9, NULL, NULL));
    REFUSED(sun2xp_send_damping(HAND, 1, 1));
    REFUSED(sun2xp_send_joint_stiffness(HAND, 9, NULL));
    REFUSED(sun2xp_send_joint_torque(HAND, 9, NULL));
    REFUSED(sun2xp_send_group(HAND, 9, NULL));
    REFUSED(sun2xp_send_path(HAND, 9, 999, NULL, -1));
    REFUSED(sun2xp_wait(HAND, 9, 99, -1));
    REFUSED(sun2xp_set_gravity(HAND, NULL));
    REFUSED(sun2xp_push(HAND, 1, Pos));
    REFUSED(sun2xp_adjust(HAND, 1, ""));
}

static void readings(void)
{
    struct sun2xp_tip Tip;
    struct sun2xp_object Object;

    Tip.size = sizeof Tip;
    Object.size = sizeof Object;
    REFUSED(sun2xp_position(HAND, 1, Pos));
    REFUSED(sun2xp_tip(HAND, 1, &Tip));
    REFUSED(sun2xp_object(HAND, &Object));
    REFUSED(sun2xp_jacobian(HAND, 9, NULL, NULL));
    REFUSED(sun2xp_forward_kinematics(HAND, 9, NULL, NULL));
    REFUSED(sun2xp_inverse_kinematics(HAND, 9, NULL, NULL));
    REFUSED(sun2xp_joint_torques(HAND, 9, NULL));
    REFUSED(sun2xp_palm_pose(HAND, 9, NULL));
    REFUSED(sun2xp_limits(HAND, 9, NULL));
    REFUSED(sun2xp_touch(HAND, 9, 9, NULL));
    REFUSED(sun2xp_tare_touch(HAND, 9));
}

static void states_and_faults(void)
{
    struct sun2xp_status Status;
    struct sun2xp_timing Timing;
    struct sun2xp_record Record;
    struct sun2xp_fault Fault;

    Status.size = sizeof Status;
    Timing.size = sizeof Timing;
    Record.size = sizeof Record;
    Fault.size = sizeof Fault;
    REFUSED(sun2xp_status(HAND, 1, &Status));
    REFUSED(sun2xp_timing(HAND, 1, SUN2XP_STAGE_CYCLE, &Timing));
    REFUSED(sun2xp_timing(HAND, 9, 99, NULL));
    REFUSED(sun2xp_reset_timing(HAND, 0));
    REFUSED(sun2xp_record(HAND, 1, 0, &Record));
    REFUSED(sun2xp_write_black_box(HAND, 1, "child.jsonl"));
    REFUSED(sun2xp_fault(HAND, 1, &Fault));
    REFUSED(sun2xp_stop(HAND, 1));
    REFUSED(sun2xp_recover(HAND, 1));
    REFUSED(sun2xp_zero(HAND, 1));
    REFUSED(sun2xp_identify(HAND, 1));
}

static void events_and_reflexes(void)
{
    REFUSED(sun2xp_next_event(HAND, NULL));
    REFUSED(sun2xp_wait_event(HAND, NULL, -1));
    REFUSED(sun2xp_on_event(HAND, NULL, NULL));
    REFUSED(sun2xp_event_descriptor(HAND));
    REFUSED(sun2xp_install_reflex(HAND, 9, NULL));
    REFUSED(sun2xp_remove_reflex(HAND, 9, 99));
    REFUSED(sun2xp_set_log(NULL, NULL));
}

static void permitted(void)
{
    struct sun2xp_error Error;

    Error.size = sizeof Error;
    WORKS(sun2xp_error(HAND, &Error) == 0);
    WORKS(strstr(sun2xp_error_text(NULL), "forked") != NULL);
    WORKS(strcmp(sun2xp_version(), SUN2XP_VERSION) == 0);
    WORKS(sun2xp_version_number() == SUN2XP_VERSION_NUMBER);
    WORKS(sun2xp_abi_version() == SUN2XP_ABI_VERSION);
    WORKS(sun2xp_default_hand() == Opened);
    WORKS(strstr(sun2xp_fault_text(SUN2XP_FAULT_WATCHDOG), "watchdog") != NULL);
    WORKS(sun2xp_stop_all() == 0);
}

static void child(void)
{
    opening_and_closing();
    set_points();
    readings();
    states_and_faults();
    events_and_reflexes();
    permitted();
    calls_of_1990();
    exit(0);
}

int main(void)
{
    float Now[3];
    int round, status;
    struct sun2xp_status Before, After;

    CHECK(OpenHand() == 0);
    Opened = HAND;
    Before.size = After.size = sizeof Before;
    for (round = 0; round < 3; round++) {
        pid_t process = fork();
        CHECK(process >= 0);
        if (process == 0)
            child();
        CHECK(waitpid(process, &status, 0) == process);
        CHECK(WIFEXITED(status) && WEXITSTATUS(status) == 0);
        CHECK(GetPos(1, Now) == 0);
    }
    CHECK(sun2xp_status(HAND, 1, &Before) == 0);
    PAUSE_MS(100);
    CHECK(sun2xp_status(HAND, 1, &After) == 0);
    CHECK(After.state == SUN2XP_STATE_RUNNING && After.cycles > Before.cycles);
    CHECK(CloseHand() == 0);
    return 0;
}
