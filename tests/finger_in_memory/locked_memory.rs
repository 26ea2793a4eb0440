//! The memory that the servo locks, and the size of the records. The servo locks only pages of values that exist. It
//! locks each of these pages once.

use crate::rig::Bench;
use std::ops::Range;
use sun2xp::control::State;
use sun2xp::finger::CycleRecord;

/// The mapped memory of this process. Neighbouring ranges are joined.
fn mapped() -> Vec<Range<usize>> {
    let maps = std::fs::read_to_string("/proc/self/maps").expect("readable");
    let address = |digits: &str| usize::from_str_radix(digits, 16).expect("an address");
    let mut joined: Vec<Range<usize>> = Vec::new();
    for line in maps.lines() {
        let (start, rest) = line.split_once('-').expect("a range");
        let (end, _) = rest.split_once(' ').expect("permissions");
        let (start, end) = (address(start), address(end));
        match joined.last_mut() {
            Some(last) if last.end == start => last.end = end,
            _ => joined.push(start..end),
        }
    }
    joined
}

/// Pages of a value that was replaced during construction are unmapped, and may be mapped again for another value. The
/// servo must no longer list such pages for the replaced value. So the test looks for ranges that are not mapped, and
/// for ranges that overlap.
#[test]
fn every_range_to_lock_is_mapped_and_belongs_to_one_value() {
    let bench = Bench::new();
    let memory = bench.servo.memory();
    let mut ranges = memory.ranges().to_vec();
    assert!(ranges.len() > 10, "{}", ranges.len());
    let mapped = mapped();
    for range in &ranges {
        let inside = mapped.iter().any(|mapped| mapped.start <= range.start && range.end <= mapped.end);
        assert!(inside, "{range:x?} is not mapped");
    }
    ranges.sort_by_key(|range| range.start);
    for pair in ranges.windows(2) {
        assert!(pair[0].end <= pair[1].start, "{:x?} and {:x?} overlap", pair[0], pair[1]);
    }
}

/// The sizes in docs/architecture.md are those of a 64-bit machine. The size of the state depends on the compiler, so
/// it is rounded.
#[test]
#[cfg(target_pointer_width = "64")]
fn the_sizes_of_records_are_those_of_the_documentation() {
    let text = include_str!("../../docs/architecture.md").split_whitespace().collect::<Vec<_>>().join(" ");
    let (record, state) = (size_of::<CycleRecord>(), size_of::<State>());
    let kept = (2000 * record) as f64 * 1e-6;
    for sentence in [
        format!("A record has {record} bytes."),
        format!("The two seconds that are kept need {kept:.1} MB for each kilohertz and finger."),
        format!("the state of the controller, which has {:.1} kB.", state as f64 * 1e-3),
    ] {
        assert!(text.contains(&sentence), "docs/architecture.md does not contain: {sentence}");
    }
}
