//! The C interface as C programs see it: the programs are compiled, linked against the shared library, and move the
//! simulated hand.

#[allow(dead_code)]
#[path = "../c/mod.rs"]
mod c;
mod endings;
mod libraries;
mod opening;
mod planners;

use c::{Bench, STRICT};

fn succeed(flags: &[&str], sources: &[&str]) {
    Bench::new().succeed(flags, sources);
}

fn strict<'a>(flags: &[&'a str]) -> Vec<&'a str> {
    [STRICT, flags].concat()
}
