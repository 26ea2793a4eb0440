//! remote/vectors.json: the messages of docs/remote-protocol.md as data, for clients and servers in any language. The
//! codec generated the file and must keep agreeing with it.

mod examples;
mod json;
mod malformed;
mod messages;
mod names;

use std::path::PathBuf;
use std::{env, fs};

const ABOUT: &str = "Test vectors of docs/remote-protocol.md, version 1; remote/README.md says how to use them";

fn path() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../vectors.json")
}

fn text() -> String {
    let sections = [
        ("messages", messages::listed()),
        ("malformed", malformed::listed()),
        ("names", names::listed()),
        ("keys", names::keys()),
    ];
    let sections: Vec<String> =
        sections.iter().map(|(name, lines)| format!("\"{name}\": [\n{}\n]", lines.join(",\n"))).collect();
    format!("{{\n\"about\": \"{ABOUT}\",\n\"protocol\": 1,\n{}\n}}\n", sections.join(",\n"))
}

#[test]
fn the_file_is_what_the_codec_makes() {
    if env::var_os("SUN2XP_WRITE_VECTORS").is_some() {
        fs::write(path(), text()).expect("remote/vectors.json can be written");
    }
    assert!(
        fs::read_to_string(path()).is_ok_and(|committed| committed == text()),
        "remote/vectors.json is not what the codec makes. A protocol must not change by accident. If this change is \
         intended, run: SUN2XP_WRITE_VECTORS=1 cargo test -p sun2xp-remote-protocol --test vectors"
    );
}

#[test]
fn the_messages_of_the_file_agree_with_the_codec() {
    let file = fs::read_to_string(path()).expect("remote/vectors.json can be read");
    let vectors: serde_json::Value = serde_json::from_str(&file).expect("JSON");
    let section = |name: &str| vectors[name].as_array().expect("an array").clone();
    let bytes = |vector: &serde_json::Value| json::from_hex(vector["payload"].as_str().expect("hex"));
    for vector in section("messages") {
        let (kind, payload) = (vector["type"].as_str().expect("a type"), bytes(&vector));
        let again = examples::decode_and_encode(kind, &payload).expect("a good message");
        assert_eq!(again, payload, "{vector}");
    }
    for vector in section("malformed") {
        let refused = examples::decode_and_encode(vector["type"].as_str().expect("a type"), &bytes(&vector));
        let reason = refused.expect_err("a malformed message").to_string();
        assert_eq!(Some(reason.as_str()), vector["reason"].as_str(), "{vector}");
    }
    let least = [("messages", 20), ("malformed", 60), ("names", 10), ("keys", 1)];
    least.iter().for_each(|&(name, least)| assert!(section(name).len() >= least, "{name} is too short"));
}
