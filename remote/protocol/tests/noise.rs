//! Random and damaged payloads make no decoder panic. A message that a decoder accepts can be encoded again.

mod common;

use common::{Noise, decode_every_kind, messages};
use std::time::Instant;

/// Decodes `count` payloads: random bytes, and good messages with damage. Returns how many of them were accepted.
fn run(count: u64, seed: u64) -> u64 {
    let (messages, mut noise) = (messages(), Noise(seed));
    let mut payload = Vec::new();
    let mut accepted = 0;
    for _ in 0..count {
        noise.payload(&messages, &mut payload);
        accepted += u64::from(decode_every_kind(&payload));
    }
    accepted
}

#[test]
fn no_payload_makes_a_decoder_panic() {
    let accepted = run(200_000, 1);
    // Damage in a number or in a reserved byte gives another good message.
    assert!((20_000..180_000).contains(&accepted), "{accepted} of 200000 payloads were accepted");
}

#[test]
#[ignore = "it takes some ten seconds: cargo test -p sun2xp-remote-protocol --test noise -- --ignored --nocapture"]
fn ten_million_payloads_make_no_decoder_panic() {
    let start = Instant::now();
    let accepted = run(10_000_000, 2);
    println!("10000000 payloads in {:.1} s, {accepted} of them accepted", start.elapsed().as_secs_f64());
    assert!((1_000_000..9_000_000).contains(&accepted), "{accepted} of 10000000 payloads were accepted");
}
