//! A planner may change its working directory, as a daemon does. Calibrations and black boxes must still be written
//! where the configuration says. The test has a process of its own, because it changes the working directory.

use std::env::set_current_dir;
use std::fs;
use std::time::{Duration, Instant};
use sun2xp::hand::{Fingers, Hand, read_configuration, stop_all};

#[test]
fn relative_paths_keep_the_working_directory_of_the_opening() {
    let folder = tempfile::tempdir().expect("a folder");
    set_current_dir(folder.path()).expect("the working directory can be changed");
    fs::create_dir("boxes").expect("made");
    let file = "[hand]\nrate = 500\nblack_box = \"boxes\"\n[finger]\nport = \"simulated\"\n";
    fs::write("hand.toml", file).expect("written");
    let hand = Hand::open_limp(
        read_configuration("hand.toml".as_ref()).expect("usable"),
        Some("hand.toml".into()),
        Fingers::ALL,
    )
    .expect("open");
    set_current_dir("/").expect("the working directory can be changed");

    hand.find_signs(1, |_| {}).expect("signs");
    assert!(hand.store_calibration(1).unwrap_or_else(|error| panic!("{error}")));
    stop_all();
    let begun = Instant::now();
    let boxes = || fs::read_dir(folder.path().join("boxes")).expect("there").flatten();
    while boxes().filter(|file| file.path().extension().is_some_and(|name| name == "jsonl")).count() < 3 {
        assert!(begun.elapsed() < Duration::from_secs(20), "no black box was written");
        std::thread::sleep(Duration::from_millis(10));
    }
}
