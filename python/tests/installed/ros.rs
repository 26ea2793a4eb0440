//! Runs the tests of the ROS 2 node, ros/tests. If permitted, they run in a network namespace of their own, so that
//! they find no other nodes.

use crate::environment::{Environment, ROOT, run};
use std::path::Path;
use std::process::Command;

/// Arguments of `unshare`. It runs the program that follows them in a network namespace with only the loopback
/// interface.
const ALONE: [&str; 4] = ["--net", "sh", "-c", "ip link set lo up && exec \"$0\" \"$@\""];

/// Returns a command that runs a program in a network namespace of its own. If that is not permitted, the command runs
/// the program beside the other nodes of this machine.
fn command(program: &Path) -> Command {
    // Root keeps its own user namespace. In another one the servos would not get real-time priorities, and a busy
    // machine would stop the fingers.
    for options in [&[][..], &["--map-root-user"]] {
        let alone = |program: &Path| {
            let mut alone = Command::new("unshare");
            alone.args(options).args(ALONE).arg(program);
            alone
        };
        if alone(Path::new("true")).output().is_ok_and(|probe| probe.status.success()) {
            return alone(program);
        }
    }
    println!("This process cannot make a network namespace. The nodes use the loopback interface of the machine.");
    let mut beside = Command::new(program);
    // ROS domains up to 101 use no ephemeral ports.
    beside.env("ROS_DOMAIN_ID", (1 + std::process::id() % 101).to_string());
    beside
}

#[test]
fn the_ros_node_works_with_rclpy() {
    let Some(environment) = Environment::new("the ROS 2 node", "ros/tests/requirements.txt", "ros") else { return };
    // The build writes into the source, so it gets a copy.
    let source = environment.folder.join("source");
    run(Command::new("cp").arg("-r").arg(Path::new(ROOT).join("ros")).arg(&source));
    environment.install(&["--no-build-isolation", "--no-deps", source.to_str().expect("a plain name")]);
    let mut pytest = command(&environment.python());
    pytest.args(["-m", "pytest", "-p", "no:cacheprovider"]).arg(Path::new(ROOT).join("ros/tests"));
    pytest.current_dir(&environment.folder).env("PYTHONDONTWRITEBYTECODE", "1").env_remove("SUN2XP_CONFIG");
    pytest.env("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST").env("ROS_LOG_DIR", environment.folder.join("log"));
    println!("{}", run(&mut pytest));
    environment.delete();
}
