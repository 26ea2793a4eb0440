use super::*;

fn read(text: &str) -> Result<Settings, ServeError> {
    Settings::from_text(text, Path::new("folder/sun2xp.toml"), &Overrides::default())
}

fn refusal(text: &str) -> String {
    read(text).expect_err("refused").to_string()
}

#[test]
fn without_a_table_the_server_listens_on_loopback_and_nobody_may_command() {
    let settings = read("[hand]\nrate = 1000\n").expect("usable");
    assert_eq!(settings.listen[0].to_string(), "tcp/127.0.0.1:7447");
    assert_eq!(settings.limits, Limits { catch_ms: 100, end_ms: 1000, soft_stiffness: 1.0, lead_force: 10.0 });
    assert!(settings.clients.is_empty() && settings.tls.is_none() && settings.name.as_str() == "hand");
}

#[test]
fn unknown_keys_and_wrong_values_are_named_with_their_line() {
    for (text, line, words) in [
        ("[serve]\nnam = 'left'\n", 2, "nam"),
        ("[serve]\nname = 'Left'\n", 2, "'L'"),
        ("[serve]\n\ncatch_ms = 5\n", 3, "10 to 10000"),
        ("[serve]\ncatch_ms = 200\nend_ms = 150\n", 3, "200 ms (catch_ms)"),
        ("[serve]\nlead_force = nan\n", 2, "0.1 to 1000 N"),
        ("[serve]\nsoft_stiffness = -1\n", 2, "0 to 1000 N/cm"),
        ("[serve]\nlisten = ['udp/127.0.0.1:1']\n", 2, "tcp/"),
        ("[serve]\nlisten = []\n", 2, "connect"),
        ("[serve]\n[serve.clients]\nplanner = 'write'\n", 3, "command"),
        ("[serve]\n[serve.clients]\n'a b' = 'read'\n", 2, "' '"),
        ("[serve]\n[serve.clients]\n'.planner' = 'read'\n", 2, "begins with `.`"),
        ("[serve.tls]\nauthority = 'ca.pem'\ncertificate = 'c'\nkey = 'k'\npassword = 'p'\n", 5, "password"),
        ("serve = 3\n", 1, "table"),
    ] {
        let refused = refusal(text);
        assert!(refused.starts_with(&format!("folder/sun2xp.toml:{line}: ")) && refused.contains(words), "{refused}");
    }
}

#[test]
fn a_missing_file_is_refused_with_its_remedy() {
    let refused = Settings::read(Some(Path::new("/missing/sun2xp.toml")), &Overrides::default());
    let refused = refused.expect_err("refused").to_string();
    assert!(refused.contains("/missing/sun2xp.toml: ") && refused.contains("The file must exist"), "{refused}");
}

#[test]
fn what_other_machines_can_reach_needs_tls() {
    for endpoint in ["tcp/0.0.0.0:7447", "tcp/192.168.1.5:7447", "tcp/[::]:7447", "tcp/cell:7447", "tls/0.0.0.0:7447"] {
        let refused = refusal(&format!("[serve]\nlisten = ['{endpoint}']\n"));
        assert!(refused.contains("TLS") || refused.contains("[serve.tls]"), "{endpoint}: {refused}");
    }
    for endpoint in ["tcp/127.0.0.1:1", "tcp/localhost:1", "tcp/[::1]:1"] {
        assert!(read(&format!("[serve]\nlisten = ['{endpoint}']\n")).is_ok(), "{endpoint}");
    }
    let tls = "[serve.tls]\nauthority = 'ca.pem'\ncertificate = '/etc/c.pem'\nkey = 'k.key'\n";
    let settings = read(&format!("[serve]\nlisten = ['tls/0.0.0.0:7447']\n{tls}")).expect("usable");
    let files = settings.tls.expect("TLS");
    assert_eq!(files.authority, Path::new("folder/ca.pem"), "relative to the file");
    assert_eq!(files.certificate, Path::new("/etc/c.pem"));
    // Although TLS is configured, a plain endpoint would admit clients that have no certificate.
    assert!(refusal(&format!("[serve]\nlisten = ['tcp/127.0.0.1:7447']\n{tls}")).contains("tls/"));
}

#[test]
fn the_command_line_replaces_the_file() {
    let overrides = Overrides { name: Some("left".into()), listen: vec!["tcp/127.0.0.1:9".into()] };
    let text = "[serve]\nname = 'right'\nlisten = ['tcp/127.0.0.1:7']\n";
    let settings = Settings::from_text(text, Path::new("f"), &overrides).expect("usable");
    assert_eq!((settings.name.as_str(), settings.listen[0].to_string().as_str()), ("left", "tcp/127.0.0.1:9"));
}

#[test]
fn an_error_of_the_command_line_names_the_option_and_not_the_file() {
    let refusal = |overrides: Overrides| {
        let text = "[serve]\nname = 'right'\nlisten = ['tcp/127.0.0.1:7']\n";
        Settings::from_text(text, Path::new("sun2xp.toml"), &overrides).expect_err("refused").to_string()
    };
    let name = refusal(Overrides { name: Some("a/b".into()), listen: Vec::new() });
    assert!(name.starts_with("--name \"a/b\": "), "{name}");
    for endpoint in ["nowhere", "tls/cell:7"] {
        let listen = refusal(Overrides { name: None, listen: vec![endpoint.into()] });
        assert!(listen.starts_with(&format!("--listen \"{endpoint}\": ")), "{listen}");
    }
}
