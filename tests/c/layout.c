/* The layout of every struct of sun2xp.h on 64-bit machines, as the first release has it. It never changes: members are
   only added at the end. */
#include "sun2xp.h"

#define AT(Struct, Member, Offset) \
    typedef char Struct##_##Member##_at_##Offset[offsetof(struct Struct, Member) == (Offset) ? 1 : -1]
#define BYTES(Struct, Bytes) typedef char Struct##_bytes[sizeof(struct Struct) == (Bytes) ? 1 : -1]

#ifdef __LP64__
BYTES(sun2xp_error, 40);
AT(sun2xp_error, size, 0);
AT(sun2xp_error, number, 8);
AT(sun2xp_error, system_errno, 12);
AT(sun2xp_error, call, 16);
AT(sun2xp_error, text, 24);
AT(sun2xp_error, remedy, 32);

BYTES(sun2xp_tip, 208);
AT(sun2xp_tip, size, 0);
AT(sun2xp_tip, force_directions, 8);
AT(sun2xp_tip, position, 16);
AT(sun2xp_tip, force, 40);
AT(sun2xp_tip, tensions, 64);
AT(sun2xp_tip, stiffness, 96);
AT(sun2xp_tip, contact_force, 168);
AT(sun2xp_tip, slide_speed, 192);
AT(sun2xp_tip, touching, 200);

BYTES(sun2xp_set_point, 48);
AT(sun2xp_set_point, size, 0);
AT(sun2xp_set_point, finger, 8);
AT(sun2xp_set_point, position, 16);
AT(sun2xp_set_point, tip, 24);
AT(sun2xp_set_point, stiffness, 32);
AT(sun2xp_set_point, damping, 40);

BYTES(sun2xp_path_pose, 56);
AT(sun2xp_path_pose, size, 0);
AT(sun2xp_path_pose, is_tip, 8);
AT(sun2xp_path_pose, time, 16);
AT(sun2xp_path_pose, place, 24);
AT(sun2xp_path_pose, stiffness, 48);

BYTES(sun2xp_joint_torques, 56);
AT(sun2xp_joint_torques, size, 0);
AT(sun2xp_joint_torques, measured, 8);
AT(sun2xp_joint_torques, commanded, 32);

BYTES(sun2xp_palm_pose, 200);
AT(sun2xp_palm_pose, size, 0);
AT(sun2xp_palm_pose, base, 8);
AT(sun2xp_palm_pose, rotation, 32);
AT(sun2xp_palm_pose, tip, 104);
AT(sun2xp_palm_pose, tip_rotation, 128);

BYTES(sun2xp_limits, 112);
AT(sun2xp_limits, size, 0);
AT(sun2xp_limits, joint_minimum, 8);
AT(sun2xp_limits, joint_maximum, 32);
AT(sun2xp_limits, tension_minimum, 56);
AT(sun2xp_limits, tension_maximum, 64);
AT(sun2xp_limits, motor_torque, 72);
AT(sun2xp_limits, stiffness, 104);

BYTES(sun2xp_touch, 40);
AT(sun2xp_touch, size, 0);
AT(sun2xp_touch, valid, 8);
AT(sun2xp_touch, pressed, 12);
AT(sun2xp_touch, count, 16);
AT(sun2xp_touch, force, 24);
AT(sun2xp_touch, lost_events, 32);

BYTES(sun2xp_object, 240);
AT(sun2xp_object, size, 0);
AT(sun2xp_object, touching, 8);
AT(sun2xp_object, time, 16);
AT(sun2xp_object, position, 24);
AT(sun2xp_object, rotation, 48);
AT(sun2xp_object, velocity, 120);
AT(sun2xp_object, angular_velocity, 144);
AT(sun2xp_object, force, 168);

BYTES(sun2xp_status, 120);
AT(sun2xp_status, size, 0);
AT(sun2xp_status, state, 8);
AT(sun2xp_status, realtime, 12);
AT(sun2xp_status, rate, 16);
AT(sun2xp_status, measured_rate, 24);
AT(sun2xp_status, wake_up_median, 32);
AT(sun2xp_status, wake_up_p99, 40);
AT(sun2xp_status, wake_up_maximum, 48);
AT(sun2xp_status, torque_scale, 56);
AT(sun2xp_status, cycles, 64);
AT(sun2xp_status, skipped_periods, 72);
AT(sun2xp_status, lost_replies, 80);
AT(sun2xp_status, damaged_replies, 88);
AT(sun2xp_status, calibration, 96);
AT(sun2xp_status, memory_locked, 104);
AT(sun2xp_status, on_core, 108);
AT(sun2xp_status, stiffness_scale, 112);

BYTES(sun2xp_timing, 128);
AT(sun2xp_timing, size, 0);
AT(sun2xp_timing, stage, 8);
AT(sun2xp_timing, count, 16);
AT(sun2xp_timing, minimum, 24);
AT(sun2xp_timing, median, 32);
AT(sun2xp_timing, p99, 40);
AT(sun2xp_timing, p999, 48);
AT(sun2xp_timing, maximum, 56);
AT(sun2xp_timing, cycles, 64);
AT(sun2xp_timing, overruns, 72);
AT(sun2xp_timing, skipped_periods, 80);
AT(sun2xp_timing, lost_replies, 88);
AT(sun2xp_timing, late_replies, 96);
AT(sun2xp_timing, damaged_replies, 104);
AT(sun2xp_timing, duplicate_replies, 112);
AT(sun2xp_timing, foreign_frames, 120);

BYTES(sun2xp_fault, 48);
AT(sun2xp_fault, size, 0);
AT(sun2xp_fault, number, 8);
AT(sun2xp_fault, part, 12);
AT(sun2xp_fault, warning, 16);
AT(sun2xp_fault, warning_part, 20);
AT(sun2xp_fault, value, 24);
AT(sun2xp_fault, warning_value, 32);
AT(sun2xp_fault, warnings, 40);

BYTES(sun2xp_event, 80);
AT(sun2xp_event, size, 0);
AT(sun2xp_event, finger, 8);
AT(sun2xp_event, kind, 12);
AT(sun2xp_event, part, 16);
AT(sun2xp_event, cycle, 24);
AT(sun2xp_event, lost, 32);
AT(sun2xp_event, time, 40);
AT(sun2xp_event, values, 48);

BYTES(sun2xp_reflex, 168);
AT(sun2xp_reflex, size, 0);
AT(sun2xp_reflex, condition, 8);
AT(sun2xp_reflex, event, 12);
AT(sun2xp_reflex, finger, 16);
AT(sun2xp_reflex, joint, 20);
AT(sun2xp_reflex, reaction, 24);
AT(sun2xp_reflex, priority, 28);
AT(sun2xp_reflex, bound, 32);
AT(sun2xp_reflex, value, 40);
AT(sun2xp_reflex, largest, 48);
AT(sun2xp_reflex, refractory, 56);
AT(sun2xp_reflex, inhibition, 64);
AT(sun2xp_reflex, position, 72);
AT(sun2xp_reflex, stiffness, 96);

BYTES(sun2xp_record, 208);
AT(sun2xp_record, size, 0);
AT(sun2xp_record, state, 8);
AT(sun2xp_record, cycle, 16);
AT(sun2xp_record, oldest, 24);
AT(sun2xp_record, newest, 32);
AT(sun2xp_record, time, 40);
AT(sun2xp_record, answered, 48);
AT(sun2xp_record, status_bits, 52);
AT(sun2xp_record, computed, 56);
AT(sun2xp_record, follows, 60);
AT(sun2xp_record, position, 64);
AT(sun2xp_record, position_sent, 88);
AT(sun2xp_record, tension, 112);
AT(sun2xp_record, tension_sent, 144);
AT(sun2xp_record, torque, 176);


BYTES(sun2xp_io_terms, 112);
AT(sun2xp_io_terms, size, 0);
AT(sun2xp_io_terms, finger, 8);
AT(sun2xp_io_terms, hold, 12);
AT(sun2xp_io_terms, rate, 16);
AT(sun2xp_io_terms, watchdog, 24);
AT(sun2xp_io_terms, hold_time, 32);
AT(sun2xp_io_terms, hold_torque, 40);
AT(sun2xp_io_terms, torque_limits, 48);
AT(sun2xp_io_terms, torque_constants, 80);

BYTES(sun2xp_io_command, 64);
AT(sun2xp_io_command, size, 0);
AT(sun2xp_io_command, number, 8);
AT(sun2xp_io_command, enable, 16);
AT(sun2xp_io_command, torques, 24);
AT(sun2xp_io_command, deadline, 56);

BYTES(sun2xp_io_sample, 72);
AT(sun2xp_io_sample, size, 0);
AT(sun2xp_io_sample, time, 8);
AT(sun2xp_io_sample, tensions, 16);
AT(sun2xp_io_sample, encoders, 48);
AT(sun2xp_io_sample, faults, 64);

BYTES(sun2xp_io, 72);
AT(sun2xp_io, size, 0);
AT(sun2xp_io, finger, 8);
AT(sun2xp_io, holds, 12);
AT(sun2xp_io, in_step, 16);
AT(sun2xp_io, shortest_watchdog, 24);
AT(sun2xp_io, tension_unit, 32);
AT(sun2xp_io, user, 40);
AT(sun2xp_io, start, 48);
AT(sun2xp_io, exchange, 56);
AT(sun2xp_io, stop, 64);
#endif

/* A translation unit must not be empty. */
typedef int compiled;
