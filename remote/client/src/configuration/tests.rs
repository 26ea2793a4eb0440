//! These tests check which configurations are read, and with which texts others are refused.

use super::*;

const GOOD: &str =
    "[hand]\nrate = 1000\n\n[remote]\nendpoint = \"tcp/127.0.0.1:7447\"\nhand = \"left-2\"\nclient = \"p\"\n";

fn read(text: &str) -> Result<Option<RemoteConfiguration>, RemoteError> {
    RemoteConfiguration::from_text(text, Path::new("/folder"))
}

fn refusal(text: &str) -> String {
    read(text).expect_err("refused").to_string()
}

#[test]
fn the_tables_of_a_client_are_read_and_other_tables_are_ignored() {
    let read_one = read(GOOD).expect("good").expect("a table");
    let (hand, client) = ("left-2".parse().expect("a name"), "p".parse().expect("a name"));
    assert_eq!(read_one, RemoteConfiguration::new("tcp/127.0.0.1:7447", hand, client));
    assert_eq!(read("[hand]\nrate = 1000\n[serve]\nname = \"hand\"\n").expect("good"), None);
    let tls = "[remote]\nendpoint = \"tls/cell:7447\"\nhand = \"h\"\nstale_ms = 50\ntake_over = true\n\
               [remote.tls]\nauthority = \"ca.pem\"\ncertificate = \"/etc/p.pem\"\nkey = \"p.key\"\n";
    let tls = read(tls).expect("good").expect("a table");
    assert_eq!((tls.stale_ms, tls.take_over, tls.client), (50, true, None));
    let files = tls.tls.expect("files");
    assert_eq!(files.authority, Path::new("/folder/ca.pem"));
    assert_eq!(files.certificate, Path::new("/etc/p.pem"));
}

#[test]
fn errors_name_the_line_and_the_remedy() {
    let file = "the text of the configuration";
    let unknown = refusal(&GOOD.replace("hand = \"left-2\"", "hund = \"left-2\""));
    assert!(unknown.starts_with(&format!("{file}:6: [remote]: unknown field `hund`, expected one of")), "{unknown}");
    let name = refusal(&GOOD.replace("left-2", "Left"));
    assert!(name.starts_with(&format!("{file}:6: remote.hand: the name has the character 'L'")), "{name}");
    let kind = refusal(&GOOD.replace("\"tcp/127.0.0.1:7447\"", "7447"));
    assert!(kind.starts_with(&format!("{file}:5: [remote]: invalid type: integer `7447`")), "{kind}");
    let syntax = refusal("[remote\n");
    assert!(syntax.starts_with(&format!("{file}:1: ")), "{syntax}");
    let stale = refusal(&format!("{GOOD}stale_ms = 0\n"));
    assert_eq!(stale, format!("{file}:8: remote.stale_ms = 0 must be 1 to 60000"));
    let client = refusal(&GOOD.replace("client = \"p\"\n", ""));
    assert!(client.starts_with(&format!("{file}:4: remote.client is missing")), "{client}");
    let refusal = |file: &Path| RemoteConfiguration::read(file).expect_err("refused").to_string();
    let device = refusal(Path::new("/dev/zero"));
    assert_eq!(device, "/dev/zero: it is not a regular file: name the configuration file of a hand");
    let large = refusal(&std::env::current_exe().expect("this program"));
    assert!(large.ends_with(": it is larger than 1 MiB: name the configuration file of a hand"), "{large}");
}

#[test]
fn endpoints_without_tls_are_on_this_machine() {
    for endpoint in ["tcp/127.0.0.1:7447", "tcp/localhost:1", "tcp/[::1]:7447", "tcp/127.3.2.1:65535"] {
        assert!(read(&GOOD.replace("tcp/127.0.0.1:7447", endpoint)).is_ok(), "{endpoint}");
    }
    for endpoint in ["tcp/cell:7447", "tcp/10.0.0.1:7447", "tcp/0.0.0.0:7447"] {
        let refusal = refusal(&GOOD.replace("tcp/127.0.0.1:7447", endpoint));
        assert!(refusal.contains(":5: remote.endpoint has no TLS"), "{refusal}");
    }
    for endpoint in
        ["127.0.0.1:7447", "udp/127.0.0.1:7447", "tcp/127.0.0.1", "tcp/:7447", "tcp/127.0.0.1:x", "tcp/a#b:1"]
    {
        let refusal = refusal(&GOOD.replace("tcp/127.0.0.1:7447", endpoint));
        assert!(refusal.contains(":5: remote.endpoint = ") && refusal.contains("is not `tls/HOST:PORT`"), "{refusal}");
    }
    let without = refusal(&GOOD.replace("tcp/", "tls/"));
    assert!(without.contains("a table [remote.tls]"), "{without}");
}

#[test]
fn files_of_tls_are_checked() {
    let folder = std::env::temp_dir().join(format!("sun2xp-remote-tls-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let file = |name: &str| folder.join(name);
    let tls = RemoteTls { authority: file("ca.pem"), certificate: file("p.pem"), key: file("p.key") };
    let refusal = || client_of(&tls, None).expect_err("refused").to_string();
    assert!(refusal().contains("the file of remote.tls.authority"), "{}", refusal());
    std::fs::write(file("ca.pem"), "nothing").expect("written");
    let refused = refusal();
    std::fs::remove_dir_all(&folder).expect("removed");
    assert!(refused.contains("remote.tls.authority is not a certificate in PEM"), "{refused}");
}
