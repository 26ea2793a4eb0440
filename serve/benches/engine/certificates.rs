//! Makes the certificates for TLS connections: those of an authority, a server and a client, as on a lab's network.

use crate::Failure;
use rcgen::{
    BasicConstraints, CertificateParams, DistinguishedName, DnType, ExtendedKeyUsagePurpose, IsCa, Issuer, KeyPair,
    KeyUsagePurpose,
};
use std::fs;
use std::path::{Path, PathBuf};

/// The files of one side of a connection, as PEM.
pub struct Files {
    pub authority: PathBuf,
    pub certificate: PathBuf,
    pub key: PathBuf,
}

impl Files {
    /// Returns the paths of the files of `name` in a folder.
    pub fn of(folder: &Path, name: &str) -> Self {
        Self {
            authority: folder.join("authority.pem"),
            certificate: folder.join(format!("{name}.pem")),
            key: folder.join(format!("{name}.key")),
        }
    }
}

/// Writes the files of an authority, a server and a client into a folder.
pub fn write(folder: &Path) -> Result<(), Failure> {
    let mut parameters = parameters("benchmark", &[])?;
    parameters.is_ca = IsCa::Ca(BasicConstraints::Constrained(0));
    parameters.key_usages = vec![KeyUsagePurpose::KeyCertSign];
    let key = KeyPair::generate()?;
    fs::write(Files::of(folder, "").authority, parameters.self_signed(&key)?.pem())?;
    let issuer = Issuer::new(parameters, key);
    for name in ["server", "client"] {
        write_leaf(folder, name, &issuer)?;
    }
    Ok(())
}

/// Writes a key and its certificate. The certificate is valid for both ends of a connection.
fn write_leaf(folder: &Path, name: &str, issuer: &Issuer<'_, KeyPair>) -> Result<(), Failure> {
    let mut parameters = parameters(name, &["127.0.0.1"])?;
    parameters.key_usages = vec![KeyUsagePurpose::DigitalSignature];
    parameters.extended_key_usages = vec![ExtendedKeyUsagePurpose::ServerAuth, ExtendedKeyUsagePurpose::ClientAuth];
    let key = KeyPair::generate()?;
    let files = Files::of(folder, name);
    fs::write(files.certificate, parameters.signed_by(&key, issuer)?.pem())?;
    fs::write(files.key, key.serialize_pem())?;
    Ok(())
}

/// Returns the parameters of a certificate for a common name and addresses.
fn parameters(name: &str, addresses: &[&str]) -> Result<CertificateParams, Failure> {
    let addresses: Vec<String> = addresses.iter().map(|&address| address.into()).collect();
    let mut parameters = CertificateParams::new(addresses)?;
    parameters.distinguished_name = DistinguishedName::new();
    parameters.distinguished_name.push(DnType::CommonName, name);
    Ok(parameters)
}
