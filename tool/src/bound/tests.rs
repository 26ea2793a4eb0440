//! What `sun2xp bound --write` stores. With the default options, the search of the tool takes minutes. The tests search
//! less.

use super::{Arguments, conclude, run};
use std::io;
use std::path::Path;
use sun2xp::hand::{self, Found};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::Configuration;

/// The bounds in the file.
fn bounds(path: &Path) -> [Option<f64>; 3] {
    hand::read_configuration(path).expect("a configuration").fingers.map(|finger| finger.stiffness.bound)
}

#[test]
fn the_bound_is_stored_and_the_rest_of_the_file_stays() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("hand.toml");
    let text = "# Mine.\n[finger.stiffness]\nbound = 5.5 # by hand\n[finger.controller]\nscheme = \"state feedback\"\n";
    let write = |fingers: &[i32]| {
        std::fs::write(&path, text).expect("written");
        let arguments = Arguments {
            config: Some(path.clone()),
            fingers: fingers.to_vec(),
            write: true,
            scheme: None,
            rate: None,
            nominal: true,
            free: false,
            passivity: false,
            samples: Some(40),
            seed: 1990,
            json: false,
        };
        run(&arguments).unwrap_or_else(|error| panic!("{error}"));
    };
    // The search is limited to one finger.
    write(&[2]);
    let [one, two, three] = bounds(&path).map(|bound| bound.expect("a bound"));
    assert!(one == 5.5 && two >= 6.0 && three == 5.5, "{one} {two} {three}");
    write(&[]);
    let after = std::fs::read_to_string(&path).expect("read");
    assert!(after.starts_with(text), "{after}");
    assert!(bounds(&path).iter().all(|bound| bound.is_some_and(|bound| bound >= 6.0)), "{after}");
}

#[test]
fn a_bound_is_stored_before_it_is_printed() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("hand.toml");
    std::fs::write(&path, "").expect("written");
    let found = Found::bound(4.5, FingerNumber::TWO, &Configuration::default());
    let printed = conclude(Some(path.as_path()), &found, || {
        assert_eq!(bounds(&path), [None, Some(4.5), None]);
        Err(io::ErrorKind::BrokenPipe.into())
    });
    let printed = printed.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(printed.map_err(|error| error.kind()), Err(io::ErrorKind::BrokenPipe));
    assert_eq!(bounds(&path), [None, Some(4.5), None]);
}
