//! `sun2xp serve --make-certificates`: a small certificate authority for a laboratory, and certificates of servers and
//! clients. The common name of a certificate is the name of the server or client to which the certificate belongs.

use crate::ServeError;
use crate::authority;
use crate::process::effective_user;
use crate::settings::check_client;
use rcgen::{
    BasicConstraints, Certificate, CertificateParams, DistinguishedName, DnType, ExtendedKeyUsagePurpose, IsCa, Issuer,
    KeyPair, KeyUsagePurpose,
};
use std::fs::{DirBuilder, OpenOptions, remove_dir, remove_file};
use std::io::{self, Write};
use std::os::unix::fs::{DirBuilderExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use sun2xp_remote_protocol::ClientName;
use time::{Duration, OffsetDateTime};

/// Name of the files of the authority, without the extension.
const AUTHORITY: &str = "ca";

/// How long the authority is valid.
const AUTHORITY_VALIDITY: Duration = Duration::days(3650);

/// How long other certificates are valid.
const VALIDITY: Duration = Duration::days(730);

/// A machine accepts a new certificate at once if its clock is behind the clock of the machine that made the
/// certificate by at most this time.
const CLOCK_DIFFERENCE: Duration = Duration::days(1);

/// The certificates to make.
#[derive(Clone, Debug, Default)]
pub struct Wanted {
    /// Names of the servers of hands, and of routers. The names obey the same rules as the names of clients. A client
    /// that connects to a server or router must use the name of this server or router, one of `addresses`, or loopback.
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
/// Returns an error if a name cannot be used, if one of the files exists already, if other users can use the authority
/// or write in the folder, if the files of the authority do not belong together, or if a file cannot be written.
/// Before an error is returned, the files and folders that this call has made are removed again.
pub fn make(folder: &Path, wanted: &Wanted) -> Result<Vec<PathBuf>, ServeError> {
    check_names(folder, wanted)?;
    let absent = |folder: &&Path| !folder.as_os_str().is_empty() && folder.symlink_metadata().is_err();
    let new_folders: Vec<PathBuf> = folder.ancestors().take_while(absent).map(PathBuf::from).collect();
    let mut made = Vec::new();
    match make_files(folder, wanted, &mut made) {
        Ok(()) => Ok(made),
        Err(error) => {
            // Errors of the removal are ignored: `error` already says what is wrong. A folder in which somebody else
            // has put something stays.
            for file in &made {
                let _ = remove_file(file);
            }
            for folder in &new_folders {
                let _ = remove_dir(folder);
            }
            Err(error)
        }
    }
}

fn check_names(folder: &Path, wanted: &Wanted) -> Result<(), ServeError> {
    let named = || wanted.servers.iter().chain(&wanted.clients);
    for name in named() {
        check_client(name).map_err(|reason| ServeError::certificate(folder, format!("\"{name}\": {reason}")))?;
        if name.as_str() == AUTHORITY {
            return Err(ServeError::certificate(folder, "`ca` names the files of the authority: choose another name"));
        }
        if named().filter(|other| *other == name).count() > 1 {
            let reason = format!("{name} is named twice: give each certificate a name of its own");
            return Err(ServeError::certificate(folder, reason));
        }
        let existing = files(folder, name.as_str()).into_iter().find(|file| is_there(file));
        if let Some(file) = existing {
            return Err(ServeError::certificate(&file, "exists already: remove it, or choose another name"));
        }
    }
    Ok(())
}

/// Returns whether something with this name exists, even if it is a link that leads nowhere.
fn is_there(path: &Path) -> bool {
    path.symlink_metadata().is_ok()
}

/// Makes the folder and the files. `made` lists the files that have been made, even if an error is returned.
fn make_files(folder: &Path, wanted: &Wanted, made: &mut Vec<PathBuf>) -> Result<(), ServeError> {
    let user = effective_user()?;
    let mut builder = DirBuilder::new();
    let created = builder.recursive(true).mode(0o700).create(folder);
    created.map_err(|error| {
        ServeError::certificate(folder, format!("cannot make the folder ({error}): choose a place where you can write"))
    })?;
    authority::check_folder(folder, user)?;
    let issuer = issuer(folder, user, made)?;
    for name in &wanted.servers {
        let mut addresses = vec![name.to_string(), "localhost".into(), "127.0.0.1".into(), "::1".into()];
        addresses.extend(wanted.addresses.iter().cloned());
        addresses.sort();
        addresses.dedup();
        leaf(folder, name, addresses, &issuer, made)?;
    }
    for name in &wanted.clients {
        leaf(folder, name, Vec::new(), &issuer, made)?;
    }
    Ok(())
}

/// The files of the certificate and of the key with this name.
fn files(folder: &Path, name: &str) -> [PathBuf; 2] {
    [folder.join(format!("{name}.pem")), folder.join(format!("{name}.key"))]
}

/// Returns the authority of the folder, or makes one.
fn issuer(folder: &Path, user: u32, made: &mut Vec<PathBuf>) -> Result<Issuer<'static, KeyPair>, ServeError> {
    let [certificate, key] = files(folder, AUTHORITY);
    let named = params(authority::NAME, Vec::new(), AUTHORITY_VALIDITY);
    let mut params = named.map_err(|error| unmade(&certificate, &error))?;
    params.is_ca = IsCa::Ca(BasicConstraints::Constrained(0));
    params.key_usages = vec![KeyUsagePurpose::KeyCertSign, KeyUsagePurpose::CrlSign];
    if is_there(&certificate) || is_there(&key) {
        // A certificate identifies its authority by the name and the key of the authority. So the same parameters and
        // the stored key give the same authority.
        return Ok(Issuer::new(params, authority::read(&certificate, &key, user)?));
    }
    let pair = KeyPair::generate().map_err(|error| unmade(&key, &error))?;
    let signed = params.self_signed(&pair).map_err(|error| unmade(&certificate, &error))?;
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
    if let Some(address) = addresses.iter().find(|address| CertificateParams::new(vec![(*address).clone()]).is_err()) {
        let reason = "a certificate can name only ASCII names and IP addresses: give the ASCII form of the name \
                      (xn--...), or an IP address";
        return Err(ServeError::argument("--address", address, reason));
    }
    let [certificate, key] = files(folder, name.as_str());
    // A client's certificate must not pass as the certificate of a server. A server may connect to a router, and
    // is then a client. So its certificate must also pass as the certificate of a client.
    let mut uses = vec![ExtendedKeyUsagePurpose::ClientAuth];
    if !addresses.is_empty() {
        uses.push(ExtendedKeyUsagePurpose::ServerAuth);
    }
    let mut params = params(name.as_str(), addresses, VALIDITY).map_err(|error| unmade(&certificate, &error))?;
    params.key_usages = vec![KeyUsagePurpose::DigitalSignature];
    params.extended_key_usages = uses;
    let pair = KeyPair::generate().map_err(|error| unmade(&key, &error))?;
    let signed = params.signed_by(&pair, issuer).map_err(|error| unmade(&certificate, &error))?;
    write(&certificate, &key, &signed, &pair, made)
}

/// The error for a file that rcgen cannot make. Names and addresses have been checked, so the cause is not in them.
fn unmade(path: &Path, error: &rcgen::Error) -> ServeError {
    ServeError::certificate(path, format!("{error}. This is a defect of the server: please report it"))
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
    let unwritten = |path: &Path, error: io::Error| {
        let remedy = "choose a folder in which you can write, on a disk with free space";
        ServeError::certificate(path, format!("cannot write the file ({error}): {remedy}"))
    };
    // Only the owner of the file may read a key.
    for (path, text, mode) in [(key, pair.serialize_pem(), 0o600), (certificate, signed.pem(), 0o644)] {
        let opened = OpenOptions::new().write(true).create_new(true).mode(mode).open(path);
        let mut file = opened.map_err(|error| unwritten(path, error))?;
        made.push(path.into());
        file.write_all(text.as_bytes()).map_err(|error| unwritten(path, error))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests;
