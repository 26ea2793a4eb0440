//! The service over lines that fail: two network namespaces with a line between them that loses and delays packets,
//! or is cut. Tests that need a namespace are listed as skipped where this process may not make one.

#[path = "../../../tests/common/attempts.rs"]
mod attempts;
mod bad_line;
#[path = "../../../tests/common/free_port.rs"]
mod free_port;
mod line;
mod line_tests;
mod namespace;
mod noise;
mod noise_tests;
mod observer;
mod outage;
mod outage_tests;
#[allow(dead_code)]
#[path = "../../../tests/common/pauses.rs"]
mod pauses;
mod planner;
mod process;
mod raw;
mod security;
mod served;
mod several;
mod shaper;
mod snippets;
#[allow(dead_code)]
#[path = "../../../tests/common/tools.rs"]
mod tools;
mod tun;

use line::Line;
use std::io::ErrorKind;

/// Makes a line. Returns `None` if the program `ip` or the device `/dev/net/tun` is missing, or if this process may not
/// make a line. The test is then listed as skipped. There is one exception: if `ip` is missing, and the environment
/// variable CI is "true", this function fails the test.
fn permitted_line(seed: u64) -> Option<Line> {
    const PART: &str = "a line between two namespaces";
    if !tools::available("ip", PART) {
        return None;
    }
    match Line::new(seed) {
        Ok(line) => Some(line),
        Err(error) if error.kind() == ErrorKind::PermissionDenied => {
            tools::not_permitted(PART, &format!("namespaces and tun interfaces need root: {error}"));
            None
        }
        Err(error) if error.kind() == ErrorKind::NotFound => {
            let remedy = "load the kernel module tun, or give the container the device /dev/net/tun";
            tools::not_permitted(PART, &format!("tun interfaces are missing ({error}): {remedy}"));
            None
        }
        Err(error) => panic!("cannot make {PART}: {error}"),
    }
}
