/* Runs all calls of Sun2Xp.h and sun2xp.h, each in a thread with a stack of 64 KiB. The stack is filled with PAINT
   before the call. The program prints the number of bytes that each call has overwritten. */
#define _GNU_SOURCE
#include <errno.h>
#include <pthread.h>
#include <string.h>
#include <sys/mman.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"

#define STACK_BYTES (64 * 1024)
/* The limit for one call (chapter 5 of sun2xp.h, "Stack"). The bytes that the thread itself uses are not counted. */
#define PROMISED_BYTES (16 * 1024)
#define PROMISED_FOR_MANY (48 * 1024)   /* for the calls that get many set points */
#define PAINT 0xA5

static double Pos[3] = {0.0, 0.5, 0.8}, Beyond[3] = {9.0, 0.5, 0.8};
static double Tip[3] = {0.0, -6.0, 8.0}, Push[3], Normal[3] = {0, -1, 0};
static double Kx[3][3] = {{3, 0, 0}, {0, 3, 0}, {0, 0, 3}}, Skewed[3][3] = {{3, 1, 0}, {0, 3, 0}, {0, 0, 3}};
static double K[4][4] = {{3, 0, 0, 0}, {0, 3, 0, 0}, {0, 0, 3, 0}, {0, 0, 0, 20}};
static float Single[3] = {0.0f, 0.5f, 0.8f}, SingleKx[3][3] = {{3, 0, 0}, {0, 3, 0}, {0, 0, 3}};

static int nothing(void) { return 0; }
static int refused_without_hand(void) { return SendPos(1, Pos) + 1; }
static int send_pos(void) { return SendPos(1, Single); }
static int send_pos_double(void) { return SendPos(1, Pos); }
static int send_pos_beyond(void) { return SendPos(1, Beyond) + 1; }
static int send_kx(void) { return SendKx(1, SingleKx); }
static int send_kx_double(void) { return SendKx(1, Kx); }
static int send_kx_skewed(void) { return SendKx(1, Skewed) + 1; }
static int get_pos(void) { return GetPos(1, Single); }
static int get_pos_double(void) { return GetPos(1, Pos); }
static int hand_error(void) { return HandError() == NULL; }
static int send_tip(void) { return sun2xp_send_tip(HAND, 1, Tip); }
static int send_contact(void) { return sun2xp_send_contact(HAND, 1, 4, &K[0][0], Normal); }
static int send_damping(void) { return sun2xp_send_damping(HAND, 1, 1.0); }
static int adjust_finger(void) { return sun2xp_adjust(HAND, 1, "tendon.minimum = 6\ncontroller.tension_gain = 3"); }
static int adjust_refused(void) { return sun2xp_adjust(HAND, 1,
        "tendon.minimum = 6\ncontroller.tensoin_gain = 3") + SUN2XP_ERROR_CONFIGURATION; }
static int push_finger(void) { return sun2xp_push(HAND, 1, Push); }
static int fault_text(void) { return sun2xp_fault_text(1) == NULL; }
static int write_black_box(void) { return sun2xp_write_black_box(HAND, 1, "small_stack.jsonl"); }
static int zero_finger(void) { return sun2xp_zero(HAND, 1); }
static int identify_refused(void) { return sun2xp_identify(HAND, 7) + SUN2XP_ERROR_ARGUMENT; }
static int recover_hand(void) { sun2xp_stop_all(); PAUSE_MS(50); return sun2xp_recover(HAND, 1); }

/* Defines a function that makes a call. The call fills a struct. */
#define GETTER(function, type, call) \
    static int function(void) \
    { \
        struct type Found; \
        Found.size = sizeof Found; \
        return call; \
    }

GETTER(get_tip, sun2xp_tip, sun2xp_tip(HAND, 1, &Found))
GETTER(get_status, sun2xp_status, sun2xp_status(HAND, 1, &Found))
GETTER(get_timing, sun2xp_timing, sun2xp_timing(HAND, 1, SUN2XP_STAGE_COMPUTE, &Found) + sun2xp_reset_timing(HAND, 0))
GETTER(get_record, sun2xp_record, sun2xp_record(HAND, 1, 0, &Found))
GETTER(get_fault, sun2xp_fault, sun2xp_fault(HAND, 1, &Found))

static double Kj[9] = {60, 0, 0, 0, 60, 0, 0, 0, 40}, Zero[3];
static struct sun2xp_set_point Group[3];
static struct sun2xp_path_pose Path[128];
static struct sun2xp_reflex Rule;
static struct sun2xp_io Io[3];
static sun2xp_hand *Other;

/* Runs in the main thread, which has a large stack. */
static void make_arguments(void)
{
    int place;

    for (place = 0; place < 3; place++) {
        Group[place].size = sizeof Group[place];
        Group[place].finger = Io[place].finger = place + 1;
        Group[place].position = Pos;
        Group[place].stiffness = &Kx[0][0];
        Group[place].damping = 1.0;
        Io[place].size = sizeof Io[place];
    }
    for (place = 0; place < 128; place++) {
        Path[place].size = sizeof Path[place];
        Path[place].time = 1.0 + 0.1 * place;
        memcpy(Path[place].place, Pos, sizeof Pos);
        Path[place].stiffness = &Kx[0][0];
    }
    Rule.size = sizeof Rule;
    Rule.condition = SUN2XP_WHEN_FORCE_ABOVE;
    Rule.bound = 1000;
    Rule.reaction = SUN2XP_THEN_HOLD;
}

static void ignore_message(int severity, const char *text, void *user)
{
    (void)severity;
    (void)text;
    (void)user;
}

static void ignore_event(const struct sun2xp_event *event, void *context)
{
    (void)event;
    (void)context;
}

static int default_hand(void) { return sun2xp_default_hand() == NULL; }
static int error_text(void) { return sun2xp_error_text(HAND) == NULL; }
static int set_log(void) { return sun2xp_set_log(ignore_message, NULL) != 0 || sun2xp_set_log(NULL, NULL) != 0; }
static int send_position(void) { return sun2xp_send_position(HAND, 1, Pos); }
static int wait_settled(void) { return sun2xp_wait(HAND, 1, SUN2XP_WAIT_SETTLED, 20.0); }
static int send_path(void) { return sun2xp_send_path(HAND, 1, 128, Path, 0); }
static int send_position_for(void) { return sun2xp_send_position_for(HAND, 1, Pos, 60.0); }
static int send_group(void) { return sun2xp_send_group(HAND, 3, Group); }
static int send_joint_stiffness(void) { return sun2xp_send_joint_stiffness(HAND, 1, Kj); }
static int send_joint_torque(void) { return sun2xp_send_joint_torque(HAND, 1, Zero); }
static int send_stiffness(void) { return sun2xp_send_stiffness(HAND, 1, &Kx[0][0]); }
static int tare_touch(void) { return sun2xp_tare_touch(HAND, 1); }
static int install_reflex(void) { return sun2xp_install_reflex(HAND, 1, &Rule) <= 0; }
static int remove_reflex(void) { return sun2xp_remove_reflex(HAND, 1, 0); }
static int event_descriptor(void) { return sun2xp_event_descriptor(HAND) < 0; }
static int on_event(void) { return sun2xp_on_event(HAND, ignore_event, NULL) || sun2xp_on_event(HAND, NULL, NULL); }
static int set_gravity(void) { return sun2xp_set_gravity(HAND, Zero); }
static int stop_finger(void) { return sun2xp_stop(HAND, 2); }
static int open_simulated(void) { return sun2xp_open(NULL, &Other); }
static int close_other(void) { return sun2xp_close(Other); }
static int open_text(void) { return sun2xp_open_text("[hand]\nfingers = [1]\n", &Other); }
static int open_named(void) { return sun2xp_open_named("nominal", &Other); }
/* The call is refused, because the functions in Io are NULL. */
static int open_io(void) { return sun2xp_open_io(NULL, 3, Io, &Other) + SUN2XP_ERROR_ARGUMENT; }
static int open_io_text(void) { return sun2xp_open_io_text("[hand]\nfingers = [1]\n", 0, NULL, &Other); }

static int versions(void)
{
    return sun2xp_version() == NULL || sun2xp_version_number() != SUN2XP_VERSION_NUMBER
        || sun2xp_abi_version() != SUN2XP_ABI_VERSION;
}

GETTER(get_error, sun2xp_error, sun2xp_error(HAND, &Found))

static int get_position(void)
{
    double Found[3];
    return sun2xp_position(HAND, 1, Found);
}

static int get_kinematics(void)
{
    double Found[3], Jacobian[9];
    return sun2xp_jacobian(HAND, 1, NULL, Jacobian) || sun2xp_forward_kinematics(HAND, 1, Pos, Found)
        || sun2xp_inverse_kinematics(HAND, 1, Tip, Found);
}

GETTER(get_joint_torques, sun2xp_joint_torques, sun2xp_joint_torques(HAND, 1, &Found))
GETTER(get_palm_pose, sun2xp_palm_pose, sun2xp_palm_pose(HAND, 1, &Found))
GETTER(get_limits, sun2xp_limits, sun2xp_limits(HAND, 1, &Found))
GETTER(get_touch, sun2xp_touch, sun2xp_touch(HAND, 1, 0, &Found) + SUN2XP_ERROR_ARGUMENT)
GETTER(get_object, sun2xp_object, sun2xp_object(HAND, &Found) + SUN2XP_ERROR_NOT_SUPPORTED)

/* sun2xp_wait_event waits, because no event is left. */
static int take_events(void)
{
    struct sun2xp_event Found;
    int result;
    Found.size = sizeof Found;
    while ((result = sun2xp_next_event(HAND, &Found)) == 1)
        ;
    return result < 0 || sun2xp_wait_event(HAND, &Found, 0.01) < 0;
}

static const struct job {
    const char *name;
    int (*call)(void);                  /* NULL for open_again, which is defined below */
} jobs[] = {
    {"no call", nothing},
    {"SendPos without a hand", refused_without_hand},
    {"OpenHand", OpenHand},
    {"OpenHand again", NULL},
    {"sun2xp_default_hand", default_hand},
    {"sun2xp_version and others", versions},
    {"sun2xp_error", get_error},
    {"sun2xp_error_text", error_text},
    {"sun2xp_set_log", set_log},
    {"SendPos", send_pos},
    {"SendPosD", send_pos_double},
    {"SendPosD beyond a limit", send_pos_beyond},
    {"SendKx", send_kx},
    {"SendKxD", send_kx_double},
    {"SendKxD, not symmetric", send_kx_skewed},
    {"GetPos", get_pos},
    {"GetPosD", get_pos_double},
    {"HandError", hand_error},
    {"sun2xp_send_position", send_position},
    {"sun2xp_wait", wait_settled},
    {"sun2xp_send_path", send_path},
    {"sun2xp_send_position_for", send_position_for},
    {"sun2xp_send_group", send_group},
    {"sun2xp_send_joint_stiffness", send_joint_stiffness},
    {"sun2xp_send_joint_torque", send_joint_torque},
    {"sun2xp_send_stiffness", send_stiffness},
    {"sun2xp_position", get_position},
    {"sun2xp_jacobian and others", get_kinematics},
    {"sun2xp_joint_torques", get_joint_torques},
    {"sun2xp_palm_pose", get_palm_pose},
    {"sun2xp_limits", get_limits},
    {"sun2xp_touch, no element", get_touch},
    {"sun2xp_tare_touch", tare_touch},
    {"sun2xp_object, no object", get_object},
    {"sun2xp_install_reflex", install_reflex},
    {"sun2xp_remove_reflex", remove_reflex},
    {"sun2xp_next_event and wait_event", take_events},
    {"sun2xp_event_descriptor", event_descriptor},
    {"sun2xp_on_event", on_event},
    {"sun2xp_send_tip", send_tip},
    {"sun2xp_tip", get_tip},
    {"sun2xp_send_contact", send_contact},
    {"sun2xp_send_damping", send_damping},
    {"sun2xp_adjust", adjust_finger},
    {"sun2xp_adjust with a wrong key", adjust_refused},
    {"sun2xp_push", push_finger},
    {"sun2xp_status", get_status},
    {"sun2xp_timing, sun2xp_reset_timing", get_timing},
    {"sun2xp_record", get_record},
    {"sun2xp_fault", get_fault},
    {"sun2xp_fault_text", fault_text},
    {"sun2xp_write_black_box", write_black_box},
    {"sun2xp_zero", zero_finger},
    {"sun2xp_identify, no such finger", identify_refused},
    {"sun2xp_set_gravity", set_gravity},
    {"sun2xp_stop", stop_finger},
    {"sun2xp_stop_all, sun2xp_recover", recover_hand},
    {"CloseHand", CloseHand},
    {"sun2xp_open", open_simulated},
    {"sun2xp_close", close_other},
    {"sun2xp_open_text", open_text},
    {"sun2xp_close", close_other},
    {"sun2xp_open_named", open_named},
    {"sun2xp_close", close_other},
    {"sun2xp_open_io without functions", open_io},
    {"sun2xp_open_io_text", open_io_text},
    {"sun2xp_close", close_other},
};

static int open_again(void) { return OpenHand() == -1 && errno == EBUSY ? 0 : 1; }

static void *work(void *own)
{
    const struct job *job = own;
    int result = job->call == NULL ? open_again() : job->call();
    if (result != 0)
        fprintf(stderr, "%s: %d (%s)\n", job->name, result, HandError());
    return result == 0 ? own : NULL;
}

/* Bytes of stack that a job and its thread have used. */
static size_t used_by(const struct job *job)
{
    pthread_t thread;
    pthread_attr_t attributes;
    void *end = NULL;
    size_t untouched = 0;
    unsigned char *stack;
    /* The lowest page is a guard page. */
    stack = mmap(NULL, STACK_BYTES + 4096, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    CHECK(stack != MAP_FAILED);
    stack += 4096;
    CHECK(mprotect(stack, STACK_BYTES, PROT_READ | PROT_WRITE) == 0);
    memset(stack, PAINT, STACK_BYTES);
    CHECK(pthread_attr_init(&attributes) == 0);
    CHECK(pthread_attr_setstack(&attributes, stack, STACK_BYTES) == 0);
    CHECK(pthread_create(&thread, &attributes, work, (void *)job) == 0);
    CHECK(pthread_join(thread, &end) == 0);
    CHECK(end == job);
    while (untouched < STACK_BYTES && stack[untouched] == PAINT)
        untouched++;
    pthread_attr_destroy(&attributes);
    munmap(stack - 4096, STACK_BYTES + 4096);
    return STACK_BYTES - untouched;
}

int main(void)
{
    size_t number, most = 0, thread = used_by(&jobs[0]);
    make_arguments();
    for (number = 1; number < sizeof jobs / sizeof *jobs; number++) {
        size_t used = used_by(&jobs[number]) - thread;
        printf("%-32s %6lu bytes\n", jobs[number].name, (unsigned long)used);
        fflush(stdout);
        if (jobs[number].call == send_path || jobs[number].call == send_group)
            CHECK(used <= PROMISED_FOR_MANY);
        else if (used > most)
            most = used;
    }
    printf("all calls but sun2xp_send_path and sun2xp_send_group: at most %lu bytes\n", (unsigned long)most);
    CHECK(most <= PROMISED_BYTES);
    return 0;
}
