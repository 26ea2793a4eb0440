//! Effects of the library on the process of a planner, and things that a planner may do in its process: signals,
//! cancellation, floating-point environments, stacks, locked memory and the end of the process.

#[path = "common/attempts.rs"]
mod attempts;
#[allow(dead_code)]
mod c;

use attempts::attempts;
use c::pauses::{self, Part};
use c::{Bench, STRICT, c_compiler, said};
use std::fs;
use std::process::Command;
use std::time::Duration;

/// A scratch folder with a configuration in which sun2xp_zero assumes that the finger is in a known pose. Such a call
/// takes a second. A search for the stops takes most of a minute, and these tests are about the call, not about its
/// result.
fn bench() -> Bench {
    let bench = Bench::new();
    let configuration = "[finger]\nport = \"simulated\"\n[finger.zeroing]\nmethod = \"pose\"\n";
    fs::write(bench.path().join("named.toml"), configuration).expect("a configuration file");
    bench
}

fn succeed(sources: &[&str]) {
    bench().succeed(STRICT, sources);
}

/// The configuration of this program names no port, so OpenHand prints a message.
fn succeed_with_message(sources: &[&str]) {
    let bench = bench();
    fs::write(bench.path().join("named.toml"), "[hand]\nrate = 1000\n").expect("a configuration file");
    bench.succeed(STRICT, sources);
}

#[test]
fn messages_on_a_closed_pipe_leave_the_planner_alive() {
    succeed_with_message(&["broken_pipe.c"]);
}

#[test]
fn messages_into_a_file_of_the_largest_size_leave_the_planner_alive() {
    succeed_with_message(&["full_file.c"]);
}

#[test]
fn arguments_may_lie_in_pages_that_a_handler_makes_accessible() {
    succeed(&["pages_on_demand.c"]);
}

#[test]
fn a_child_in_which_no_fork_handler_ran_is_refused_too() {
    succeed(&["forked_raw.c"]);
}

#[test]
fn a_planner_may_have_much_thread_local_data() {
    let bench = bench();
    for kibibytes in [96, 1024] {
        let size = format!("-DKIBIBYTES={kibibytes}");
        bench.succeed(&[STRICT, &[&size]].concat(), &["thread_local.c"]);
    }
}

#[test]
fn a_process_out_of_memory_keeps_its_hand_and_gets_enomem() {
    // The program replaces malloc and calls the original by a second name, which only glibc offers.
    if cfg!(target_env = "gnu") {
        succeed(&["no_memory.c"]);
    }
}

/// A recovery asks a board every 50 ms, and gives it 300 ms to answer. A pause of less than 100 ms leaves enough time.
const TOLERATED_PAUSE: Duration = Duration::from_millis(100);

#[test]
fn a_cancelled_thread_ends_after_its_call() {
    let bench = bench();
    let program = bench.build(c_compiler(), STRICT, &["cancelled.c"]);
    attempts("threads that are cancelled in calls", TOLERATED_PAUSE, |watch| {
        let process = bench.start(Command::new(&program));
        watch.also(process.id(), Part::Servo);
        let run = process.wait_with_output().expect("the program ends");
        match run.status.code() {
            Some(0) => Ok(()),
            // A recovery was refused. No other failure is excused.
            Some(2) => Err(said(&run)),
            _ => panic!("{}\n{}", run.status, said(&run)),
        }
    });
}

/// Rounding mode, flushed denormals and trapping exceptions of a planner affect neither the servos, whose cycles the
/// replay recomputes to the last bit, nor the results of the calls.
#[test]
fn the_floating_point_environment_of_a_planner_is_its_own() {
    let bench = bench();
    let program = bench.build(c_compiler(), STRICT, &["rounding.c"]);
    for way in ["default", "upward", "flushed", "trapping"] {
        let file = bench.path().join(format!("{way}.jsonl"));
        let mut command = Command::new(&program);
        command.arg(way).arg(&file);
        let run = bench.run(command);
        assert!(run.status.success(), "{way}: {}\n{}", run.status, said(&run));
        let run = Command::new(c::tool()).arg("replay").arg(&file).output().expect("the tool runs");
        assert!(run.status.success() && said(&run).contains("the same to the last bit"), "{way}: {}", said(&run));
    }
}

#[test]
fn a_small_stack_is_enough_for_every_call() {
    // The finger is moving when the program calls sun2xp_zero. With the method "pose", the call would be refused.
    Bench::new().succeed(STRICT, &["small_stack.c"]);
}

#[test]
fn a_call_completes_after_the_planner_has_jumped_out_of_it() {
    let bench = bench();
    let program = bench.build(c_compiler(), STRICT, &["jumped.c"]);
    // A call that never returns would hang the test.
    let mut command = Command::new("timeout");
    command.args(["--signal=KILL", "120"]).arg(&program);
    let run = bench.run(command);
    assert!(run.status.success(), "{}\n{}", run.status, said(&run));
}

#[test]
fn the_process_ends_with_the_last_thread_of_the_planner() {
    let bench = bench();
    let program = bench.build(c_compiler(), STRICT, &["last_thread.c"]);
    for (way, last_words) in [("main", "closed: 0\n"), ("other", "the last thread ends\nclosed: 0\n")] {
        let mut command = Command::new("timeout");
        command.args(["--signal=KILL", "20"]).arg(&program).arg(way);
        let run = bench.run(command);
        assert!(run.status.success(), "{way}: {}\n{}", run.status, said(&run));
        assert_eq!(String::from_utf8_lossy(&run.stdout), last_words, "{way}");
    }
}

#[test]
fn exit_handlers_command_the_hand_only_while_it_is_open() {
    let bench = Bench::new();
    let program = bench.build(c_compiler(), &[STRICT, &["-std=c99"]].concat(), &["exiting.c"]);
    let run = bench.run(Command::new(&program));
    assert_eq!(run.status.code(), Some(7), "{}", said(&run));
    assert_eq!(String::from_utf8_lossy(&run.stdout), "before\nafter\n");
}

#[test]
fn locked_memory_is_what_the_documentation_says_and_is_unlocked_at_close() {
    let page = fs::read_to_string(c::root().join("docs/real-time.md")).expect("the page");
    let page: String = page.split_whitespace().collect::<Vec<_>>().join(" ");
    let (before, _) = page.split_once(" MiB in all at 1000 Hz until CloseHand").expect("the page states the size");
    let mebibytes = before.rsplit(' ').next().expect("a number");
    let bench = bench();
    let program = bench.build(c_compiler(), STRICT, &["locked_memory.c"]);
    let mut command = Command::new(&program);
    command.arg(mebibytes);
    let run = bench.run(command);
    assert!(run.status.success(), "{}\n{}", run.status, said(&run));
}
