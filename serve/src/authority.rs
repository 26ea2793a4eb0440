//! Checks of the folder of `--make-certificates`, and of a certificate authority that is in it already. Whoever can
//! write in the folder, or read the key of the authority, can make a certificate in the name of any client.

use crate::ServeError;
use rcgen::KeyPair;
use std::fs::{Metadata, metadata, symlink_metadata};
use std::io;
use std::os::unix::fs::MetadataExt;
use std::path::Path;
use sun2xp::files::read_regular_file;
use x509_parser::certificate::X509Certificate;
use x509_parser::pem::parse_x509_pem;

/// The common name of the authority.
pub const NAME: &str = "sun2xp authority";

/// Largest file that is read, bytes.
const LARGEST: u64 = 1 << 20;

/// Checks that only `user` and root can write in the folder.
///
/// # Errors
/// Returns an error if others can write there, or if it is not a folder.
pub fn check_folder(folder: &Path, user: u32) -> Result<(), ServeError> {
    let found = metadata(folder).map_err(|error| {
        ServeError::certificate(folder, format!("cannot use the folder ({error}): choose another one"))
    })?;
    if !found.is_dir() {
        return Err(ServeError::certificate(folder, "is not a folder: choose another one"));
    }
    if found.uid() != user && found.uid() != 0 {
        return Err(ServeError::certificate(folder, of_another(&found, user, "choose a folder of your own")));
    }
    if found.mode() & 0o022 != 0 {
        return Err(ServeError::certificate(
            folder,
            "other users can write in this folder, and can therefore replace the authority: run `chmod go-w` on it, or \
             choose another folder",
        ));
    }
    Ok(())
}

/// Reads the key of the authority with this certificate.
///
/// # Errors
/// Returns an error if the key is not a private file of `user`, if the certificate does not belong to this key, or if
/// it is not the certificate of an authority that this command has made and that is valid now.
pub fn read(certificate: &Path, key: &Path, user: u32) -> Result<KeyPair, ServeError> {
    for (path, other) in [(key, certificate), (certificate, key)] {
        let missing = || format!("but {} exists: restore the missing file, or choose an empty folder", other.display());
        symlink_metadata(path).map_err(|error| ServeError::certificate(path, format!("{error}, {}", missing())))?;
    }
    check_key(key, user)?;
    let text = read_regular_file(key, LARGEST).map_err(|error| unreadable(key, &error))?;
    let pair = KeyPair::from_pem(&text).map_err(|error| {
        ServeError::certificate(
            key,
            format!("is not a private key in PEM: {error}. Restore it, or use an empty folder"),
        )
    })?;
    let text = read_regular_file(certificate, LARGEST).map_err(|error| unreadable(certificate, &error))?;
    check_certificate(&text, &pair).map_err(|reason| ServeError::certificate(certificate, reason))?;
    Ok(pair)
}

fn unreadable(file: &Path, error: &io::Error) -> ServeError {
    ServeError::certificate(file, format!("cannot read the file ({error}): restore it, or choose an empty folder"))
}

fn check_key(key: &Path, user: u32) -> Result<(), ServeError> {
    // This inspects a link itself and not the file behind it, because a link can lead to the key of somebody else.
    let found = symlink_metadata(key).map_err(|error| unreadable(key, &error))?;
    if !found.is_file() {
        return Err(ServeError::certificate(key, "is not a regular file: put a copy of the authority's key there"));
    }
    if found.uid() != user {
        let remedy = "run the command as that user, or choose an empty folder";
        return Err(ServeError::certificate(key, of_another(&found, user, remedy)));
    }
    if found.mode() & 0o077 != 0 {
        return Err(ServeError::certificate(
            key,
            format!(
                "other users may use the key of the authority (mode {:o}): if nobody has copied it, run `chmod 600` on \
                 it; otherwise make a new authority in an empty folder",
                found.mode() & 0o777
            ),
        ));
    }
    Ok(())
}

fn of_another(found: &Metadata, user: u32, remedy: &str) -> String {
    format!("belongs to the user with the ID {}, and this command runs as {user}: {remedy}", found.uid())
}

/// Checks that this certificate, PEM, is that of an authority with this key.
fn check_certificate(text: &str, pair: &KeyPair) -> Result<(), String> {
    let remedy = "restore the ca.pem that was made with ca.key, or choose an empty folder";
    let (_, pem) = parse_x509_pem(text.as_bytes()).map_err(|_| format!("is not a certificate in PEM: {remedy}"))?;
    let found = pem.parse_x509().map_err(|_| format!("is not a certificate: {remedy}"))?;
    if found.public_key().subject_public_key.data[..] != *pair.public_key_raw() {
        return Err(format!("is the certificate of another key than ca.key: {remedy}"));
    }
    if !found.is_ca() {
        return Err(format!("is not the certificate of an authority: {remedy}"));
    }
    // A certificate identifies its authority by the name and the key of the authority. Every certificate that this
    // command signs gives the name `NAME` for its authority.
    if common_name(&found) != Some(NAME) {
        return Err(format!(
            "is not the certificate of an authority that this command made (its common name is not `{NAME}`): {remedy}"
        ));
    }
    if !found.validity().is_valid() {
        return Err(
            "the authority is not valid now: check the clock, or make a new authority in an empty folder".into()
        );
    }
    Ok(())
}

fn common_name<'a>(certificate: &'a X509Certificate<'_>) -> Option<&'a str> {
    certificate.subject().iter_common_name().next().and_then(|name| name.as_str().ok())
}
