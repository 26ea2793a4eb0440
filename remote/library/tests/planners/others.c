/* Calls that a hand on another machine does not support. Each must return -16. Those with a handle must also set errno
   to ENOTSUP, and report their name and the reason. */
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include "Sun2Xp.h"
#include "sun2xp.h"

static sun2xp_hand *hand;
static int other;

static void is_refused(const char *name, int result)
{
    struct sun2xp_error error;
    int code = errno;

    error.size = sizeof error;
    sun2xp_error(hand, &error);
    if (result == -SUN2XP_ERROR_NOT_SUPPORTED && code == ENOTSUP && strcmp(error.call, name) == 0 &&
        strstr(error.text, "on another machine"))
        return;
    printf("%s: returned %d, errno %d, %s\n", name, result, code, error.text);
    other++;
}

static void on_event(const struct sun2xp_event *event, void *context)
{
    (void)event, (void)context;
}

int main(void)
{
    static struct sun2xp_record record;
    static struct sun2xp_joint_torques torques;
    static struct sun2xp_palm_pose palm;
    static struct sun2xp_touch touch;
    static struct sun2xp_object object;
    static struct sun2xp_timing timing;
    static struct sun2xp_reflex reflex;
    static struct sun2xp_path_pose pose;
    double three[3] = {0.0, 0.5, 0.8}, nine[9] = {3, 0, 0, 0, 3, 0, 0, 0, 3};
    sun2xp_hand *second;

    record.size = sizeof record, torques.size = sizeof torques, palm.size = sizeof palm, touch.size = sizeof touch;
    object.size = sizeof object, timing.size = sizeof timing, reflex.size = sizeof reflex, pose.size = sizeof pose;
    reflex.condition = SUN2XP_WHEN_EVENT, reflex.event = SUN2XP_EVENT_CONTACT, reflex.reaction = SUN2XP_THEN_HOLD;
    pose.time = 1.0, pose.place[1] = 0.5, pose.place[2] = 0.8;
    if (sun2xp_open(NULL, &hand) != 0) {
        puts(sun2xp_error_text(NULL));
        return 1;
    }
    is_refused("sun2xp_send_contact", sun2xp_send_contact(hand, 1, 3, nine, NULL));
    is_refused("sun2xp_send_joint_stiffness", sun2xp_send_joint_stiffness(hand, 1, nine));
    is_refused("sun2xp_send_joint_torque", sun2xp_send_joint_torque(hand, 1, three));
    is_refused("sun2xp_send_path", sun2xp_send_path(hand, 1, 1, &pose, 0));
    is_refused("sun2xp_send_position_for", sun2xp_send_position_for(hand, 1, three, 1.0));
    is_refused("sun2xp_jacobian", sun2xp_jacobian(hand, 1, three, nine));
    is_refused("sun2xp_forward_kinematics", sun2xp_forward_kinematics(hand, 1, three, nine));
    is_refused("sun2xp_inverse_kinematics", sun2xp_inverse_kinematics(hand, 1, three, nine));
    is_refused("sun2xp_joint_torques", sun2xp_joint_torques(hand, 1, &torques));
    is_refused("sun2xp_palm_pose", sun2xp_palm_pose(hand, 1, &palm));
    is_refused("sun2xp_set_gravity", sun2xp_set_gravity(hand, three));
    is_refused("sun2xp_touch", sun2xp_touch(hand, 1, 0, &touch));
    is_refused("sun2xp_tare_touch", sun2xp_tare_touch(hand, 1));
    is_refused("sun2xp_object", sun2xp_object(hand, &object));
    is_refused("sun2xp_push", sun2xp_push(hand, 1, three));
    is_refused("sun2xp_adjust", sun2xp_adjust(hand, 1, "tendon.minimum = 6"));
    is_refused("sun2xp_timing", sun2xp_timing(hand, 1, 0, &timing));
    is_refused("sun2xp_reset_timing", sun2xp_reset_timing(hand, 1));
    is_refused("sun2xp_install_reflex", sun2xp_install_reflex(hand, 1, &reflex));
    is_refused("sun2xp_remove_reflex", sun2xp_remove_reflex(hand, 1, 0));
    is_refused("sun2xp_record", sun2xp_record(hand, 1, 0, &record));
    is_refused("sun2xp_write_black_box", sun2xp_write_black_box(hand, 1, "box.jsonl"));
    is_refused("sun2xp_on_event", sun2xp_on_event(hand, on_event, NULL));
    is_refused("sun2xp_event_descriptor", sun2xp_event_descriptor(hand));
    printf("open_io %d\n", sun2xp_open_io(NULL, 0, NULL, &second));
    printf("others %d\n", other);
    return sun2xp_close(hand);
}
