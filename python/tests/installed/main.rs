//! Builds the wheel, installs it into empty virtual environments without the network, and runs pytest there.

#[path = "../../../tests/common/cargo.rs"]
mod cargo;
mod environment;
mod package;
mod ros;
#[allow(dead_code)]
#[path = "../../../tests/common/tools.rs"]
mod tools;
