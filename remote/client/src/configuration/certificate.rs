//! The certificate of a client. Zenoh reports only that a connection was refused. Therefore the files of
//! `[remote.tls]` are checked before a connection is opened.

use super::RemoteTls;
use crate::error::RemoteError;
use std::path::Path;
use sun2xp_remote_protocol::ClientName;
use x509_parser::certificate::X509Certificate;
use x509_parser::pem::{Pem, parse_x509_pem};

/// Checks the files of a client, and returns its name: the common name of its certificate. `given` is the name in the
/// configuration, if there is one.
pub fn client_of(tls: &RemoteTls, given: Option<&ClientName>) -> Result<ClientName, RemoteError> {
    with_certificate(&tls.authority, "remote.tls.authority", |_| Ok(()))?;
    let name = with_certificate(&tls.certificate, "remote.tls.certificate", common_name)?;
    let key = read(&tls.key, "remote.tls.key")?;
    let begins = String::from_utf8_lossy(&key);
    if !begins.contains("PRIVATE KEY-----") {
        return Err(wrong(&tls.key, "remote.tls.key is not a private key in PEM: give the path of a .key file".into()));
    }
    match given {
        Some(given) if *given != name => Err(wrong(
            &tls.certificate,
            format!(
                "the certificate is that of {name}, and remote.client is {given}: leave remote.client out, or use the \
                 certificate of {given}"
            ),
        )),
        _ => Ok(name),
    }
}

/// Calls `use_it` with the first certificate of a file, if it is valid now.
fn with_certificate<T>(
    path: &Path,
    key: &str,
    use_it: impl FnOnce(&X509Certificate<'_>) -> Result<T, String>,
) -> Result<T, RemoteError> {
    let bytes = read(path, key)?;
    let parsed: Result<(_, Pem), _> = parse_x509_pem(&bytes);
    let not_one = || wrong(path, format!("{key} is not a certificate in PEM: give the path of a .pem file"));
    let (_, pem) = parsed.map_err(|_| not_one())?;
    let certificate = pem.parse_x509().map_err(|_| not_one())?;
    let validity = certificate.validity();
    if !validity.is_valid() {
        return Err(wrong(
            path,
            format!(
                "the certificate of {key} is valid from {} to {}, and not now: check the clock of this machine, or \
                 make a new certificate with `sun2xp serve --make-certificates`",
                validity.not_before, validity.not_after
            ),
        ));
    }
    use_it(&certificate).map_err(|reason| wrong(path, reason))
}

fn common_name(certificate: &X509Certificate<'_>) -> Result<ClientName, String> {
    let name = certificate.subject().iter_common_name().next().and_then(|name| name.as_str().ok());
    let name = name.ok_or(
        "the certificate of remote.tls.certificate has no common name, and the client needs one as its name: make a \
         certificate with `sun2xp serve --make-certificates`",
    )?;
    name.parse().map_err(|error| {
        format!(
            "the common name of remote.tls.certificate cannot be used: {error}. Use `sun2xp serve \
             --make-certificates` to make a certificate whose name a client can have"
        )
    })
}

fn read(path: &Path, key: &str) -> Result<Vec<u8>, RemoteError> {
    let doing = || format!("read {}, the file of {key}", path.display());
    std::fs::read(path).map_err(|source| RemoteError::System { doing: doing(), source })
}

fn wrong(path: &Path, reason: String) -> RemoteError {
    RemoteError::Configuration { file: path.into(), line: None, reason }
}
