//! Checks of `src/realtime/triple_buffer.rs`.

use crate::realtime::triple_buffer;
use crate::spawn;
use crate::tracked::Tracked;

/// A reader gets whole values. It never gets an older value after a newer one. After the last publication, it gets the
/// last value.
pub fn values_are_whole_and_in_order() {
    const LAST: u32 = 3;
    let (mut input, mut output) = triple_buffer(&[Tracked::new(0), Tracked::new(0)]);
    let writer = spawn(move || {
        for number in 1..=LAST {
            input.input_buffer_mut().iter_mut().for_each(|entry| entry.set(number));
            input.publish();
        }
        input
    });
    let mut before = 0;
    let mut read = |last: bool| {
        let [one, other] = output.read().each_ref().map(Tracked::get);
        assert!(one == other && one >= before, "{one} and {other} after {before}");
        assert!(!last || one == LAST);
        before = one;
    };
    (0..3).for_each(|_| read(false));
    let _input = writer.join().expect("no panic");
    read(true);
}

/// Every published value counts as new at most once, and the last one counts as new exactly once.
pub fn a_value_is_new_once() {
    let (mut input, mut output) = triple_buffer(&0);
    let writer = spawn(move || {
        (1..=2).for_each(|number| input.write(number));
        input
    });
    let mut new = Vec::new();
    for _ in 0..2 {
        new.extend(output.update().then(|| *output.output_buffer()));
    }
    let _input = writer.join().expect("no panic");
    new.extend(output.update().then(|| *output.output_buffer()));
    assert!(new == [2] || new == [1, 2], "{new:?}");
    assert!(!output.update());
}
