//! Tests an outbox whose Targets are lost and whose confirmations are delayed at random.

use super::*;

/// A server that takes parts as the protocol says.
#[derive(Default)]
struct Server {
    command: u32,
    values: Change,
    paths: usize,
}

impl Server {
    fn take(&mut self, target: &Target) {
        let Some(part) = target.parts.iter().find(|part| part.command != self.command) else { return };
        self.command = part.command;
        self.paths += usize::from(matches!(part.place, Place::Path(_)));
        let Part { place, stiffness, damping, .. } = part.clone();
        self.values.add(Change { place, stiffness, damping });
    }
}

/// A small generator of random numbers (SplitMix64).
struct Random(u64);

impl Random {
    fn below(&mut self, bound: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (mixed ^ (mixed >> 31)) % bound
    }

    /// Returns a random change, as a planner could send it.
    fn change(&mut self) -> Change {
        let angles = [self.below(256) as f64; 3];
        match self.below(3) {
            0 => Change { place: Place::Joints(angles), ..Change::default() },
            1 => Change { stiffness: Some([angles; 3]), ..Change::default() },
            _ => Change { place: Place::Path(vec![PathPose { time: 1.0, joints: angles }]), ..Change::default() },
        }
    }
}

/// Whichever Targets are lost, and however late confirmations arrive, the finger ends with the newest values, and no
/// more paths begin than were sent.
#[test]
fn the_newest_values_arrive() {
    let mut random = Random(1);
    for run in 0..5000 {
        let (mut outbox, mut server, mut now) = (owner(), Server::default(), 0);
        let (mut newest, mut paths, mut on_the_way) = (Change::default(), 0, std::collections::VecDeque::new());
        for _ in 0..random.below(60) {
            if random.below(4) != 0 {
                let change = random.change();
                newest.add(change.clone());
                paths += usize::from(matches!(change.place, Place::Path(_)));
                outbox.put(changes(change), None);
            }
            now += random.below(30 * MS) * random.below(2);
            if let Some(target) = outbox.next(now).filter(|_| random.below(3) != 0) {
                server.take(&target);
            }
            on_the_way.push_back(server.command);
            while on_the_way.len() as u64 > random.below(5) {
                outbox.confirm(ONE, on_the_way.pop_front().expect("one"));
            }
        }
        for _ in 0..3 {
            now += REPETITION;
            outbox.next(now).iter().for_each(|target| server.take(target));
            outbox.confirm(ONE, server.command);
        }
        assert_eq!(server.values, newest, "run {run}");
        assert!(server.paths <= paths, "run {run}: {paths} paths were sent, and {} begun", server.paths);
    }
}
