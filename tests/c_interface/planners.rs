//! Compiles and runs planners and examples in several dialects of C and in C++. Most of them check their own results.

use crate::c::{self, Bench, STRICT, c_compiler, said, tool};
use crate::{strict, succeed};
use std::process::Command;

#[test]
fn a_planner_with_float_arrays_arrives() {
    succeed(&strict(&["-ansi", "-DREAL=float"]), &["reach.c"]);
}

#[test]
fn a_program_opens_several_hands_and_a_wrong_handle_is_refused() {
    succeed(&strict(&["-std=c89"]), &["handles.c"]);
}

#[test]
fn each_hand_decides_whether_its_refusals_are_reported() {
    succeed(&strict(&["-std=c89"]), &["silent.c"]);
}

#[test]
fn a_planner_with_double_arrays_arrives() {
    succeed(&strict(&["-std=c17", "-DREAL=double"]), &["reach.c"]);
}

#[test]
fn a_planner_arrives_where_the_compiler_has_no_generic() {
    succeed(&strict(&["-ansi", "-DREAL=double", "-DSUN2XP_NO_GENERIC"]), &["reach.c"]);
}

#[test]
fn a_planner_in_k_and_r_c_without_include_arrives_with_float_and_with_double() {
    succeed(&["-std=gnu89", "-DREAL=float"], &["old.c"]);
    let double = ["-std=gnu89", "-DREAL=double", "-DSendPos=SendPosD", "-DSendKx=SendKxD", "-DGetPos=GetPosD"];
    succeed(&double, &["old.c"]);
}

#[test]
fn a_planner_in_cpp_arrives() {
    for standard in ["-std=c++98", "-std=c++17"] {
        succeed(&strict(&[standard]), &["reach.cpp"]);
    }
}

#[test]
fn a_header_inside_extern_c_serves() {
    succeed(&strict(&[]), &["inside_extern_c.cpp"]);
}

#[test]
fn a_planners_own_declarations_and_addresses_of_calls_work() {
    succeed(&strict(&["-DSUN2XP_REAL=float", "-DREAL=float"]), &["own.c"]);
    succeed(&strict(&["-DSUN2XP_REAL=double", "-DREAL=double"]), &["own.c"]);
    succeed(&strict(&["-DSUN2XP_H", "-DANSI_DECLARATIONS", "-DREAL=float"]), &["own.c"]);
}

#[test]
fn two_files_may_include_the_c_file_of_1990() {
    succeed(&strict(&[]), &["two_files.c", "two_files_other.c"]);
}

#[test]
fn arguments_are_evaluated_once() {
    succeed(&strict(&["-std=c99"]), &["once.c"]);
    succeed(&strict(&["-std=c99", "-DSUN2XP_NO_GENERIC"]), &["once.c"]);
}

#[test]
fn arrays_of_variable_length_are_what_their_elements_are() {
    succeed(&strict(&["-std=c99"]), &["variable_length.c"]);
    succeed(&strict(&["-std=c99", "-DSUN2XP_NO_GENERIC"]), &["variable_length.c"]);
}

#[test]
fn events_are_taken_and_waited_for_in_every_way() {
    succeed(&strict(&["-ansi"]), &["events.c"]);
}

#[test]
fn the_example_of_events_reports_a_refused_command_and_does_not_wait() {
    let bench = Bench::new();
    bench.write("named.toml", "[hand]\nfingers = [2]\n[finger]\nport = \"simulated\"\n");
    let source = c::root().join("c_examples/Settle.c");
    let settle = bench.build(c_compiler(), &["-std=c89"], &[source.to_str().expect("the path is text")]);
    let run = bench.run(Command::new(settle));
    assert_eq!(run.status.code(), Some(1), "{}", said(&run));
    assert!(said(&run).contains("this hand has no finger 1"), "{}", said(&run));
    assert!(!said(&run).contains("rests"), "{}", said(&run));
}

#[test]
fn the_example_of_events_says_that_a_finger_has_not_come_to_rest() {
    let bench = Bench::new();
    let source = std::fs::read_to_string(c::root().join("c_examples/Settle.c")).expect("the example");
    let impatient = source.replace("LONGEST_WAIT 5.0", "LONGEST_WAIT 0.0");
    assert_ne!(impatient, source);
    let source = bench.write("impatient.c", &impatient);
    let run = bench.run(Command::new(bench.build(c_compiler(), &["-std=c89"], &[&source])));
    assert_eq!(run.status.code(), Some(1), "{}", said(&run));
    assert!(said(&run).contains("has not come to rest in time: "), "{}", said(&run));
}

#[test]
fn reflexes_fire_and_are_refused_and_removed() {
    succeed(&strict(&["-std=c99"]), &["reflex.c"]);
}

#[test]
fn hardware_of_the_program_is_a_hand() {
    let examples = c::root().join("c_examples");
    succeed(&strict(&["-std=c99", "-I", examples.to_str().expect("the path is text")]), &["io.c"]);
}

#[test]
fn a_hand_with_drives_at_a_can_bus_moves() {
    let bench = Bench::new();
    let source = |name: &str| c::root().join("c_examples").join(name).to_str().expect("the path is text").to_string();
    let flags = strict(&["-std=gnu99"]);
    let [drives, hand] = ["CanDrives.c", "Can.c"].map(|name| bench.build(c_compiler(), &flags, &[&source(name)]));
    // Can.c starts the program CanDrives, which simulates the drives, from the folder of its own program.
    std::fs::rename(drives, bench.path().join("CanDrives")).expect("renamed");
    let run = bench.run(Command::new(hand));
    assert!(run.status.success(), "{}", said(&run));
    assert_eq!(str::from_utf8(&run.stdout).expect("text").matches("rests at").count(), 3, "{}", said(&run));
}

#[test]
fn late_frames_of_a_can_bus_make_no_sample() {
    let examples = c::root().join("c_examples");
    succeed(&strict(&["-std=gnu99", "-I", examples.to_str().expect("the path is text")]), &["late_frames.c"]);
}

#[test]
fn only_torques_renew_the_watchdog_of_a_drive_at_a_can_bus() {
    let examples = c::root().join("c_examples");
    succeed(&strict(&["-std=gnu99", "-I", examples.to_str().expect("the path is text")]), &["drive_watchdog.c"]);
}

#[test]
fn a_finger_with_a_drive_at_a_can_bus_that_does_not_arrive_is_reported() {
    let examples = c::root().join("c_examples");
    succeed(&strict(&["-std=gnu99", "-I", examples.to_str().expect("the path is text")]), &["off_target.c"]);
}

#[test]
fn the_example_in_c17_says_why_the_pose_that_must_be_refused_was_accepted() {
    let bench = Bench::new();
    bench.write("named.toml", "[hand]\nfingers = [2]\nout_of_range = \"clamp\"\n[finger]\nport = \"simulated\"\n");
    let source = c::root().join("c_examples/Modern.c");
    let modern = bench.build(c_compiler(), &["-std=c17"], &[source.to_str().expect("the path is text")]);
    let run = bench.run(Command::new(modern));
    assert_eq!(run.status.code(), Some(1), "{}", said(&run));
    assert!(said(&run).contains("was accepted: set hand.out_of_range = \"refuse\""), "{}", said(&run));
}

#[test]
fn null_pointers_are_refused() {
    succeed(&strict(&["-ansi"]), &["null.c"]);
}

#[test]
fn refusals_have_their_errno_and_text_and_change_nothing() {
    succeed(&strict(&["-std=c99"]), &["refusals.c"]);
}

#[test]
fn without_a_hand_calls_are_refused_and_close_is_done() {
    succeed(&strict(&["-std=c99"]), &["closed.c"]);
}

#[test]
fn a_forked_child_is_refused() {
    succeed(&strict(&[]), &["forked.c"]);
}

#[test]
fn the_alarms_of_a_planner_are_its_own() {
    succeed(&strict(&[]), &["signals.c"]);
}

#[test]
fn threads_may_call_at_once() {
    succeed(&strict(&[]), &["threads.c"]);
}

#[test]
fn a_planner_without_standard_descriptors_prints_nothing_to_its_ports() {
    succeed(STRICT, &["bare.c"]);
}

#[test]
fn dlclose_leaves_the_hand() {
    succeed(&strict(&[]), &["loaded.c"]);
}

#[test]
fn a_finger_is_zeroed() {
    succeed(&strict(&[]), &["zero.c"]);
}

#[test]
fn the_status_shows_the_state_of_a_finger() {
    succeed(&strict(&[]), &["states.c"]);
}

#[test]
fn a_signal_handler_stops_the_hand_and_the_planner_recovers_it() {
    succeed(&strict(&[]), &["stopped.c"]);
}

#[test]
fn a_black_box_is_written_and_replayed() {
    let bench = Bench::new();
    let program = bench.build(c_compiler(), &strict(&[]), &["black_box.c"]);
    let file = bench.path().join("finger-1.jsonl");
    let mut command = Command::new(&program);
    command.arg(&file);
    let run = bench.run(command);
    assert!(run.status.success(), "{}", said(&run));
    let run = Command::new(tool()).arg("replay").arg(&file).output().expect("the tool runs");
    assert!(run.status.success() && said(&run).contains("the same to the last bit"), "{}", said(&run));
}

#[test]
fn the_status_shows_the_state_of_the_servo() {
    succeed(&strict(&[]), &["status.c"]);
}

#[test]
fn the_status_shows_a_servo_that_does_not_run() {
    succeed(&strict(&["-std=gnu99"]), &["held.c"]);
}

#[test]
fn a_planner_that_packs_structs_and_redefines_words_of_c_is_served() {
    succeed(&strict(&["-std=c99", "-Wno-keyword-macro"]), &["packed.c"]);
    succeed(&strict(&["-std=c99", "-DSUN2XP_NO_GENERIC"]), &["packed.c"]);
}

#[test]
fn the_timing_shows_every_stage_of_a_cycle() {
    succeed(&strict(&["-std=c99"]), &["timing.c"]);
}

#[test]
fn a_group_of_fingers_is_commanded_as_a_whole_or_not_at_all() {
    succeed(&strict(&["-ansi"]), &["group.c"]);
}

#[test]
fn the_joints_of_a_finger_become_springs() {
    succeed(&strict(&["-ansi"]), &["spring.c"]);
}

#[test]
fn the_kinematics_of_a_finger_are_read() {
    succeed(&strict(&["-ansi"]), &["kinematics.c"]);
}

#[test]
fn a_path_is_followed_as_a_whole_or_not_at_all() {
    succeed(&strict(&["-ansi"]), &["path.c"]);
}

#[test]
fn a_fingertip_is_sent_read_and_made_a_contact() {
    succeed(&strict(&["-ansi"]), &["tip.c"]);
}

#[test]
fn the_object_of_the_simulated_hand_is_read() {
    let bench = Bench::new();
    let program = bench.build(c_compiler(), &strict(&["-ansi"]), &["object.c"]);
    let mut without = Command::new(&program);
    without.arg("none");
    let run = bench.run(without);
    assert!(run.status.success(), "{}", said(&run));
    let object = "[hand]\ngravity = [0, 0, 9.81]\n[hand.simulated_object]\nposition = [0, 0, 20]\ntable = 22\n";
    std::fs::write(bench.path().join("sun2xp.toml"), object).expect("a configuration file");
    let run = bench.run(Command::new(&program));
    assert!(run.status.success(), "{}", said(&run));
}
