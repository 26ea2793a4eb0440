//! The program `sun2xp-serve`, which `sun2xp serve` starts.

fn main() {}
