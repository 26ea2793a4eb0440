use super::*;
use std::fs::{Permissions, copy, read_dir, set_permissions, write as write_file};
use std::os::unix::fs::{PermissionsExt, symlink};

fn names(texts: &[&str]) -> Vec<ClientName> {
    texts.iter().map(|text| text.parse().expect("a name")).collect()
}

#[test]
fn keys_are_private_and_nothing_is_overwritten() {
    let folder = tempfile::tempdir().expect("a folder");
    let addresses = vec!["10.0.0.5".into()];
    let wanted = Wanted { servers: names(&["cell"]), addresses, clients: names(&["planner"]) };
    let made = make(folder.path(), &wanted).expect("made");
    assert_eq!(made.len(), 6, "{made:?}");
    for file in &made {
        let mode = std::fs::metadata(file).expect("a file").permissions().mode() & 0o777;
        let private = file.extension().is_some_and(|extension| extension == "key");
        assert!(mode & 0o077 == 0 || !private, "{}: {mode:o}", file.display());
    }
    let before = std::fs::read(folder.path().join("ca.pem")).expect("the authority");
    let again = make(folder.path(), &Wanted { clients: names(&["screen", "planner"]), ..Wanted::default() });
    assert!(again.expect_err("refused").to_string().contains("planner.pem: exists already"));
    assert!(!folder.path().join("screen.pem").exists(), "a refusal writes nothing");
    // The authority that is there signs a later certificate.
    let later = make(folder.path(), &Wanted { clients: names(&["screen"]), ..Wanted::default() });
    assert_eq!(later.expect("made").len(), 2);
    assert_eq!(std::fs::read(folder.path().join("ca.pem")).expect("the authority"), before);
}

#[test]
fn names_that_would_collide_or_are_hidden_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    for clients in [names(&["ca"]), names(&["a", "a"]), names(&["."]), names(&[".hidden"])] {
        assert!(make(folder.path(), &Wanted { clients, ..Wanted::default() }).is_err());
    }
    assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 0);
}

fn client(name: &str) -> Wanted {
    Wanted { clients: names(&[name]), ..Wanted::default() }
}

fn refusal(folder: &Path) -> String {
    let before = read_dir(folder).expect("a folder").count();
    let refused = make(folder, &client("late")).expect_err("refused").to_string();
    assert_eq!(read_dir(folder).expect("a folder").count(), before, "a refusal leaves nothing: {refused}");
    refused
}

#[test]
fn an_authority_that_others_can_use_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    make(folder, &client("planner")).expect("made");
    let set = |path: &Path, mode| set_permissions(path, Permissions::from_mode(mode)).expect("changed");
    let key = folder.join("ca.key");
    for mode in [0o640, 0o604, 0o620] {
        set(&key, mode);
        assert!(refusal(folder).contains("chmod 600"), "{mode:o}");
    }
    set(&key, 0o600);
    for mode in [0o770, 0o707] {
        set(folder, mode);
        assert!(refusal(folder).contains("chmod go-w"), "{mode:o}");
    }
    set(folder, 0o755);
    make(folder, &client("screen")).expect("made");
    let moved = folder.join("moved");
    std::fs::rename(&key, &moved).expect("moved");
    assert!(refusal(folder).contains("restore the missing file"));
    symlink(&moved, &key).expect("a link");
    assert!(refusal(folder).contains("not a regular file"));
}

#[test]
fn an_authority_of_another_user_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    make(folder.path(), &client("planner")).expect("made");
    let [certificate, key] = files(folder.path(), AUTHORITY);
    let user = effective_user().expect("a user");
    assert!(authority::read(&certificate, &key, user).is_ok());
    let refused = authority::read(&certificate, &key, user + 1).expect_err("refused").to_string();
    assert!(refused.contains("ca.key") && refused.contains("belongs to the user"), "{refused}");
}

#[test]
fn a_certificate_that_is_not_that_of_the_authority_is_refused() {
    let (folder, other) = (tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder"));
    let (folder, other) = (folder.path(), other.path());
    make(folder, &client("planner")).expect("made");
    make(other, &client("planner")).expect("made");
    copy(other.join("ca.pem"), folder.join("ca.pem")).expect("copied");
    assert!(refusal(folder).contains("another key"));
    // A client puts its own certificate and key in place of those of the authority.
    copy(folder.join("planner.pem"), folder.join("ca.pem")).expect("copied");
    copy(folder.join("planner.key"), folder.join("ca.key")).expect("copied");
    assert!(refusal(folder).contains("not the certificate of an authority"));
    write_file(folder.join("ca.pem"), "nothing").expect("written");
    assert!(refusal(folder).contains("not a certificate in PEM"));
}

#[test]
fn a_link_that_leads_nowhere_is_not_overwritten() {
    let folder = tempfile::tempdir().expect("a folder");
    let elsewhere = folder.path().join("elsewhere");
    symlink(&elsewhere, folder.path().join("late.pem")).expect("a link");
    assert!(refusal(folder.path()).contains("late.pem: exists already"));
    assert!(!elsewhere.exists());
}

#[test]
fn what_was_made_is_removed_if_a_later_step_fails() {
    let folder = tempfile::tempdir().expect("a folder");
    let below = folder.path().join("a").join("b");
    // This address cannot be in a certificate, and it is used only after the authority has been made.
    let wanted = Wanted { servers: names(&["cell"]), addresses: vec!["m\u{fc}ller".into()], clients: Vec::new() };
    let refused = make(&below, &wanted).expect_err("refused").to_string();
    assert!(refused.starts_with("--address \"m\u{fc}ller\": ") && refused.contains("ASCII form"), "{refused}");
    assert_eq!(read_dir(folder.path()).expect("a folder").count(), 0);
}
