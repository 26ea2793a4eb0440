//! `sun2xp serve --make-certificates`: a small certificate authority for a laboratory, and certificates of servers and
//! clients. The common name of a certificate is the name of its owner.

use crate::ServeError;
use rcgen::{
    BasicConstraints, Certificate, CertificateParams, DistinguishedName, DnType, ExtendedKeyUsagePurpose, IsCa, Issuer,
    KeyPair, KeyUsagePurpose,
};
use std::fs::{DirBuilder, OpenOptions, read_to_string};
use std::io::Write;
use std::os::unix::fs::{DirBuilderExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use sun2xp_remote_protocol::ClientName;
use time::{Duration, OffsetDateTime};

/// The names of the files of the authority.
const AUTHORITY: &str = "ca";

/// How long the authority is valid.
const AUTHORITY_VALIDITY: Duration = Duration::days(3650);

/// How long other certificates are valid.
const VALIDITY: Duration = Duration::days(730);

/// Difference of the clocks of two machines that does not matter.
const CLOCK_DIFFERENCE: Duration = Duration::days(1);

/// The certificates to make.
#[derive(Clone, Debug, Default)]
pub struct Wanted {
    /// Names of servers, hands and routers. Clients must reach them by this name, or by one of `addresses`.
    pub servers: Vec<ClientName>,
    /// Other names and addresses by which clients reach the servers.
    pub addresses: Vec<String>,
    /// Names of clients.
    pub clients: Vec<ClientName>,
}

/// Makes the certificates in `folder`. An authority that is already there signs them; otherwise a new one does. No file
/// is overwritten. Returns the files that were made.
///
/// # Errors
/// Returns an error if one of the files exists already, before anything is written, or if a file cannot be written.
pub fn make(folder: &Path, wanted: &Wanted) -> Result<Vec<PathBuf>, ServeError> {
    let named = || wanted.servers.iter().chain(&wanted.clients);
    for name in named() {
        if name.as_str() == AUTHORITY {
            return Err(failed(folder, "`ca` is the name of the authority: choose another name"));
        }
        if named().filter(|other| *other == name).count() > 1 {
            return Err(failed(folder, format!("{name} is named twice: each certificate has its own name")));
        }
        let existing = files(folder, name.as_str()).into_iter().find(|file| file.exists());
        if let Some(file) = existing {
            return Err(failed(&file, "exists already: remove it, or choose another name"));
        }
    }
    let mut builder = DirBuilder::new();
    builder.recursive(true).mode(0o700).create(folder).map_err(|error| failed(folder, error))?;
    let mut made = Vec::new();
    let issuer = authority(folder, &mut made)?;
    for name in &wanted.servers {
        let mut addresses = vec![name.to_string(), "localhost".into(), "127.0.0.1".into(), "::1".into()];
        addresses.extend(wanted.addresses.iter().cloned());
        addresses.sort();
        addresses.dedup();
        leaf(folder, name, addresses, &issuer, &mut made)?;
    }
    for name in &wanted.clients {
        leaf(folder, name, Vec::new(), &issuer, &mut made)?;
    }
    Ok(made)
}

/// The files of the certificate and of the key with this name.
fn files(folder: &Path, name: &str) -> [PathBuf; 2] {
    [folder.join(format!("{name}.pem")), folder.join(format!("{name}.key"))]
}

/// Returns the authority of the folder, or makes one.
fn authority(folder: &Path, made: &mut Vec<PathBuf>) -> Result<Issuer<'static, KeyPair>, ServeError> {
    let [certificate, key] = files(folder, AUTHORITY);
    let named = params("sun2xp authority", Vec::new(), AUTHORITY_VALIDITY);
    let mut params = named.map_err(|error| failed(&certificate, error))?;
    params.is_ca = IsCa::Ca(BasicConstraints::Constrained(0));
    params.key_usages = vec![KeyUsagePurpose::KeyCertSign, KeyUsagePurpose::CrlSign];
    if certificate.exists() || key.exists() {
        // Certificates name their authority by its name and its key, so the same parameters are the same authority.
        read_to_string(&certificate).map_err(|error| failed(&certificate, error))?;
        let text = read_to_string(&key).map_err(|error| failed(&key, error))?;
        let pair = KeyPair::from_pem(&text).map_err(|error| failed(&key, error))?;
        return Ok(Issuer::new(params, pair));
    }
    let pair = KeyPair::generate().map_err(|error| failed(&key, error))?;
    let signed = params.self_signed(&pair).map_err(|error| failed(&certificate, error))?;
    write(&certificate, &key, &signed, &pair, made)?;
    Ok(Issuer::new(params, pair))
}

/// Makes the certificate of a server, which has `addresses`, or of a client, which has none.
fn leaf(
    folder: &Path,
    name: &ClientName,
    addresses: Vec<String>,
    issuer: &Issuer<'static, KeyPair>,
    made: &mut Vec<PathBuf>,
) -> Result<(), ServeError> {
    let [certificate, key] = files(folder, name.as_str());
    // A client cannot play the server with its certificate. A server may connect to a router.
    let mut uses = vec![ExtendedKeyUsagePurpose::ClientAuth];
    if !addresses.is_empty() {
        uses.push(ExtendedKeyUsagePurpose::ServerAuth);
    }
    let mut params = params(name.as_str(), addresses, VALIDITY).map_err(|error| failed(&certificate, error))?;
    params.key_usages = vec![KeyUsagePurpose::DigitalSignature];
    params.extended_key_usages = uses;
    let pair = KeyPair::generate().map_err(|error| failed(&key, error))?;
    let signed = params.signed_by(&pair, issuer).map_err(|error| failed(&certificate, error))?;
    write(&certificate, &key, &signed, &pair, made)
}

fn params(name: &str, addresses: Vec<String>, validity: Duration) -> Result<CertificateParams, rcgen::Error> {
    let mut params = CertificateParams::new(addresses)?;
    params.distinguished_name = DistinguishedName::new();
    params.distinguished_name.push(DnType::CommonName, name);
    params.not_before = OffsetDateTime::now_utc() - CLOCK_DIFFERENCE;
    params.not_after = OffsetDateTime::now_utc() + validity;
    Ok(params)
}

fn write(
    certificate: &Path,
    key: &Path,
    signed: &Certificate,
    pair: &KeyPair,
    made: &mut Vec<PathBuf>,
) -> Result<(), ServeError> {
    // Only the owner of the file may read a key.
    for (path, text, mode) in [(key, pair.serialize_pem(), 0o600), (certificate, signed.pem(), 0o644)] {
        let opened = OpenOptions::new().write(true).create_new(true).mode(mode).open(path);
        let written = opened.and_then(|mut file| file.write_all(text.as_bytes()));
        written.map_err(|error| failed(path, error))?;
        made.push(path.into());
    }
    Ok(())
}

fn failed(path: &Path, reason: impl ToString) -> ServeError {
    ServeError::Certificate { path: path.into(), reason: reason.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::PermissionsExt;

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
    fn names_that_would_collide_are_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        for clients in [names(&["ca"]), names(&["a", "a"])] {
            assert!(make(folder.path(), &Wanted { clients, ..Wanted::default() }).is_err());
        }
        assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 0);
    }
}
