/* Part of order.c: calls with null pointers, and calls without a hand. */

static void null_pointers(void)
{
    REFUSED("SendPos", SendPos(9, NULL), "Pos");
    REFUSED("SendKx", SendKx(9, NULL), "Kx");
    REFUSED("GetPos", GetPos(9, NULL), "Pos");
    REFUSED("sun2xp_send_position", sun2xp_send_position(HAND, 9, NULL), "position");
    REFUSED("sun2xp_send_stiffness", sun2xp_send_stiffness(HAND, 9, NULL), "stiffness");
    REFUSED("sun2xp_position", sun2xp_position(HAND, 9, NULL), "position");
    REFUSED("sun2xp_open", sun2xp_open("no/such/file", NULL), "hand");
    REFUSED("sun2xp_open_text", sun2xp_open_text("rat = 1", NULL), "hand");
    REFUSED("sun2xp_open_named", sun2xp_open_named("nominal", NULL), "hand");
    REFUSED("sun2xp_open_io", sun2xp_open_io("no/such/file", 9, NULL, &Other), "io");
    REFUSED("sun2xp_open_io", sun2xp_open_io("no/such/file", 9, &Io, NULL), "hand");
    REFUSED("sun2xp_open_io_text", sun2xp_open_io_text(NULL, 9, &Io, &Other), "configuration");
    REFUSED("sun2xp_status", sun2xp_status(HAND, 9, NULL), "status");
    REFUSED("sun2xp_timing", sun2xp_timing(HAND, 9, 99, NULL), "timing");
    REFUSED("sun2xp_send_tip", sun2xp_send_tip(HAND, 9, NULL), "tip");
    REFUSED("sun2xp_tip", sun2xp_tip(HAND, 9, NULL), "tip");
    REFUSED("sun2xp_send_contact", sun2xp_send_contact(HAND, 9, 99, NULL, NULL), "stiffness is");
    REFUSED("sun2xp_send_contact", sun2xp_send_contact(HAND, 9, 4, Nan[0], NULL), "normal");
    REFUSED("sun2xp_send_joint_stiffness", sun2xp_send_joint_stiffness(HAND, 9, NULL), "stiffness is");
    REFUSED("sun2xp_send_joint_torque", sun2xp_send_joint_torque(HAND, 9, NULL), "torque");
    REFUSED("sun2xp_send_group", sun2xp_send_group(HAND, 9, NULL), "set_points");
    REFUSED("sun2xp_object", sun2xp_object(HAND, NULL), "object");
    REFUSED("sun2xp_jacobian", sun2xp_jacobian(HAND, 9, NanPos, NULL), "jacobian is");
    REFUSED("sun2xp_forward_kinematics", sun2xp_forward_kinematics(HAND, 9, NULL, Tip), "position");
    REFUSED("sun2xp_forward_kinematics", sun2xp_forward_kinematics(HAND, 9, NanPos, NULL), "tip");
    REFUSED("sun2xp_inverse_kinematics", sun2xp_inverse_kinematics(HAND, 9, NULL, Pos), "tip");
    REFUSED("sun2xp_joint_torques", sun2xp_joint_torques(HAND, 9, NULL), "torques");
    REFUSED("sun2xp_palm_pose", sun2xp_palm_pose(HAND, 9, NULL), "pose");
    REFUSED("sun2xp_limits", sun2xp_limits(HAND, 9, NULL), "limits");
    REFUSED("sun2xp_send_path", sun2xp_send_path(HAND, 9, 999, NULL, NAN), "poses");
    REFUSED("sun2xp_send_position_for", sun2xp_send_position_for(HAND, 9, NULL, NAN), "position");
    REFUSED("sun2xp_adjust", sun2xp_adjust(HAND, 9, NULL), "keys");
    REFUSED("sun2xp_set_gravity", sun2xp_set_gravity(HAND, NULL), "gravity");
    REFUSED("sun2xp_push", sun2xp_push(HAND, 9, NULL), "force");
    REFUSED("sun2xp_record", sun2xp_record(HAND, 9, 99, NULL), "record");
    REFUSED("sun2xp_write_black_box", sun2xp_write_black_box(HAND, 9, NULL), "path");
    REFUSED("sun2xp_fault", sun2xp_fault(HAND, 9, NULL), "fault");
    REFUSED("sun2xp_touch", sun2xp_touch(HAND, 9, 9, NULL), "touch");
    REFUSED("sun2xp_install_reflex", sun2xp_install_reflex(HAND, 9, NULL), "reflex");
    REFUSED("sun2xp_next_event", sun2xp_next_event(HAND, NULL), "event");
    REFUSED("sun2xp_wait_event", sun2xp_wait_event(HAND, NULL, 0), "event");
}

static void without_hand(void)
{
    REFUSED("SendPos", SendPos(9, NanPos), "OpenHand");
    REFUSED("SendKx", SendKx(9, three(Nan)), "OpenHand");
    REFUSED("GetPos", GetPos(9, Pos), "OpenHand");
    REFUSED("sun2xp_send_position", sun2xp_send_position(HAND, 9, NanPos), "sun2xp_open");
    REFUSED("sun2xp_send_stiffness", sun2xp_send_stiffness(HAND, 9, three(Nan)), "sun2xp_open");
    REFUSED("sun2xp_position", sun2xp_position(HAND, 9, Pos), "sun2xp_open");
    REFUSED("sun2xp_close", sun2xp_close(HAND), "sun2xp_open");
    REFUSED("sun2xp_open", sun2xp_open("no/such/file", &Other), "no/such/file");
    REFUSED("sun2xp_open_named", sun2xp_open_named("golden", &Other), "worn");
    REFUSED("sun2xp_open_io", sun2xp_open_io("no/such/file", 9, &Io, &Other), "size");
    REFUSED("sun2xp_open_io", sun2xp_open_io("no/such/file", 0, NULL, &Other), "no/such/file");
    REFUSED("sun2xp_status", sun2xp_status(HAND, 9, &Status), "sun2xp_open");
    REFUSED("sun2xp_timing", sun2xp_timing(HAND, 9, 99, &Timing), "sun2xp_open");
    REFUSED("sun2xp_reset_timing", sun2xp_reset_timing(HAND, 9), "sun2xp_open");
    REFUSED("sun2xp_send_tip", sun2xp_send_tip(HAND, 9, NanTip), "sun2xp_open");
    REFUSED("sun2xp_tip", sun2xp_tip(HAND, 9, &Fingertip), "sun2xp_open");
    REFUSED("sun2xp_send_contact", sun2xp_send_contact(HAND, 9, 99, Nan[0], NoNormal), "sun2xp_open");
    REFUSED("sun2xp_send_damping", sun2xp_send_damping(HAND, 9, NAN), "sun2xp_open");
    REFUSED("sun2xp_send_joint_stiffness", sun2xp_send_joint_stiffness(HAND, 9, three(Nan)), "sun2xp_open");
    REFUSED("sun2xp_send_joint_torque", sun2xp_send_joint_torque(HAND, 9, NanForce), "sun2xp_open");
    REFUSED("sun2xp_send_group", sun2xp_send_group(HAND, 9, Command), "sun2xp_open");
    REFUSED("sun2xp_object", sun2xp_object(HAND, &Object), "sun2xp_open");
    REFUSED("sun2xp_wait", sun2xp_wait(HAND, 9, 9, NAN), "sun2xp_open");
    REFUSED("sun2xp_jacobian", sun2xp_jacobian(HAND, 9, NanPos, J), "sun2xp_open");
    REFUSED("sun2xp_forward_kinematics", sun2xp_forward_kinematics(HAND, 9, NanPos, Tip), "sun2xp_open");
    REFUSED("sun2xp_inverse_kinematics", sun2xp_inverse_kinematics(HAND, 9, NanTip, Pos), "sun2xp_open");
    REFUSED("sun2xp_joint_torques", sun2xp_joint_torques(HAND, 9, &Torques), "sun2xp_open");
    REFUSED("sun2xp_palm_pose", sun2xp_palm_pose(HAND, 9, &Pose), "sun2xp_open");
    REFUSED("sun2xp_limits", sun2xp_limits(HAND, 9, &Limits), "sun2xp_open");
    REFUSED("sun2xp_send_path", sun2xp_send_path(HAND, 9, 999, Path, NAN), "sun2xp_open");
    REFUSED("sun2xp_send_position_for", sun2xp_send_position_for(HAND, 9, NanPos, NAN), "sun2xp_open");
    REFUSED("sun2xp_adjust", sun2xp_adjust(HAND, 9, "="), "sun2xp_open");
    REFUSED("sun2xp_push", sun2xp_push(HAND, 9, NanForce), "sun2xp_open");
    REFUSED("sun2xp_record", sun2xp_record(HAND, 9, 99, &Record), "sun2xp_open");
    REFUSED("sun2xp_write_black_box", sun2xp_write_black_box(HAND, 9, "no/such/folder"), "sun2xp_open");
    REFUSED("sun2xp_zero", sun2xp_zero(HAND, 9), "sun2xp_open");
    REFUSED("sun2xp_fault", sun2xp_fault(HAND, 9, &Fault), "sun2xp_open");
    REFUSED("sun2xp_recover", sun2xp_recover(HAND, 9), "sun2xp_open");
    REFUSED("sun2xp_next_event", sun2xp_next_event(HAND, &Event), "sun2xp_open");
    REFUSED("sun2xp_wait_event", sun2xp_wait_event(HAND, &Event, -1), "sun2xp_open");
    REFUSED("sun2xp_on_event", sun2xp_on_event(HAND, NULL, NULL), "sun2xp_open");
    REFUSED("sun2xp_event_descriptor", sun2xp_event_descriptor(HAND), "sun2xp_open");
    REFUSED("sun2xp_stop", sun2xp_stop(HAND, 9), "sun2xp_open");
    REFUSED("sun2xp_touch", sun2xp_touch(HAND, 9, 9, &Touch), "sun2xp_open");
    REFUSED("sun2xp_tare_touch", sun2xp_tare_touch(HAND, 9), "sun2xp_open");
    REFUSED("sun2xp_install_reflex", sun2xp_install_reflex(HAND, 9, &Rule), "sun2xp_open");
    REFUSED("sun2xp_remove_reflex", sun2xp_remove_reflex(HAND, 9, 9), "sun2xp_open");
    REFUSED("sun2xp_set_gravity", sun2xp_set_gravity(HAND, NanForce), "sun2xp_open");
}
