//! Every error that docs/faq.md quotes is one that the library reports.

use sun2xp::hand::read_configuration;
use sun2xp::{Configuration, Hand};

const PAGE: &str = include_str!("../docs/faq.md");

/// Returns the text with single spaces.
fn squeezed(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Returns the quoted errors of the page.
fn quotes() -> Vec<String> {
    PAGE.split("\n```text\n").skip(1).map(|block| squeezed(block.split("\n```").next().unwrap_or_default())).collect()
}

/// Returns why a configuration cannot be used. The file is named sun2xp.toml.
fn refused(text: &str) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("sun2xp.toml");
    std::fs::write(&file, text).expect("written");
    let error = match read_configuration(&file) {
        Err(error) => error.to_string(),
        Ok(configuration) => Hand::open(configuration).map(drop).expect_err("refused").to_string(),
    };
    error.replace(&format!("{}/", folder.path().display()), "")
}

/// Returns the errors in the order of the page.
fn errors() -> Vec<String> {
    let mut errors = vec![
        refused("[finger.1]\nport = \"/dev/ttyUSB7\"\n[hand]\nfingers = [1]\n"),
        refused("[finger]\nbuad = 1_000_000\n"),
        refused("[finger.1]\nport = \"/dev/ttyUSB7\"\nbaud = 115_200\n[hand]\nfingers = [1]\n"),
        refused("[finger]\nport = \"/dev/ttyUSB7\"\nbaud = 2_000_000\n"),
    ];
    let hand = Hand::open(Configuration::default()).expect("the simulated hand opens");
    let stiff = [[20.0, 0.0, 0.0], [0.0, 20.0, 0.0], [0.0, 0.0, 20.0]];
    let lopsided = [[3.0, 1.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 3.0]];
    errors.extend([
        hand.send_position(1, [0.0, 60.0, 60.0]).expect_err("degrees").to_string(),
        hand.send_stiffness(1, stiff).expect_err("too stiff").to_string(),
        hand.send_stiffness(1, lopsided).expect_err("not symmetric").to_string(),
    ]);
    hand.stop(1).expect("the finger stops");
    while hand.fault(1).expect("finger 1").stopped.is_none() {
        std::thread::yield_now();
    }
    errors.push(hand.send_position(1, [0.0, 0.5, 1.0]).expect_err("stopped").to_string());
    errors
}

#[test]
fn every_quoted_error_is_reported() {
    let (quotes, errors) = (quotes(), errors());
    assert_eq!(quotes.len(), errors.len());
    for (quote, error) in quotes.iter().zip(&errors) {
        let error = squeezed(error);
        match quote.strip_suffix(" ...") {
            // The page leaves out the end of this error, which lists all keys.
            Some(begin) => assert!(error.starts_with(begin), "{quote}\n{error}"),
            None => assert_eq!(*quote, error),
        }
    }
}
