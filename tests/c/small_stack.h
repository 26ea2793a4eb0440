/* The part of small_stack.c with most calls of sun2xp.h. Each function returns 0 if its calls have the expected
   results. */

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
/* The functions of the hardware are missing. */
static int open_io(void) { return sun2xp_open_io(NULL, 3, Io, &Other) + SUN2XP_ERROR_ARGUMENT; }
static int open_io_text(void) { return sun2xp_open_io_text("[hand]\nfingers = [1]\n", 0, NULL, &Other); }

static int versions(void)
{
    return sun2xp_version() == NULL || sun2xp_version_number() != SUN2XP_VERSION_NUMBER
        || sun2xp_abi_version() != SUN2XP_ABI_VERSION;
}

static int get_error(void)
{
    struct sun2xp_error Found;
    Found.size = sizeof Found;
    return sun2xp_error(HAND, &Found);
}

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

static int get_joint_torques(void)
{
    struct sun2xp_joint_torques Found;
    Found.size = sizeof Found;
    return sun2xp_joint_torques(HAND, 1, &Found);
}

static int get_palm_pose(void)
{
    struct sun2xp_palm_pose Found;
    Found.size = sizeof Found;
    return sun2xp_palm_pose(HAND, 1, &Found);
}

static int get_limits(void)
{
    struct sun2xp_limits Found;
    Found.size = sizeof Found;
    return sun2xp_limits(HAND, 1, &Found);
}

static int get_touch(void)
{
    struct sun2xp_touch Found;
    Found.size = sizeof Found;
    return sun2xp_touch(HAND, 1, 0, &Found) + SUN2XP_ERROR_ARGUMENT;
}

static int get_object(void)
{
    struct sun2xp_object Found;
    Found.size = sizeof Found;
    return sun2xp_object(HAND, &Found) + SUN2XP_ERROR_NOT_SUPPORTED;
}

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
