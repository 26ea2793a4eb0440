//! The location of the configuration file.

use crate::files::raised_privileges;
use crate::hand::ConfigurationError;
use etcetera::BaseStrategy;
use std::env;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// The only location that no user controls.
pub(super) const SYSTEM_FILE: &str = "/etc/xdg/sun2xp/sun2xp.toml";

/// Everything that determines the location of the file.
struct Environment {
    /// Whether the process has privileges that its caller does not have.
    raised_privileges: bool,
    /// Value of `SUN2XP_CONFIG`.
    named: Option<OsString>,
    /// The user's configuration folder.
    user: Option<PathBuf>,
    /// Value of `XDG_CONFIG_DIRS`.
    system: Option<OsString>,
}

/// Returns the configuration file, if there is one. An empty `SUN2XP_CONFIG` counts as unset.
///
/// # Errors
/// Returns an error if `SUN2XP_CONFIG` is set in a program with raised privileges. Such a program must not use the file
/// that `SUN2XP_CONFIG` names, so without this error it would open another hand.
pub(super) fn locate() -> Result<Option<PathBuf>, ConfigurationError> {
    let environment = Environment {
        raised_privileges: raised_privileges(),
        named: env::var_os("SUN2XP_CONFIG"),
        user: etcetera::choose_base_strategy().ok().map(|strategy| strategy.config_dir()),
        system: env::var_os("XDG_CONFIG_DIRS"),
    };
    // A file that exists but cannot be read counts as found, and is then refused. symlink_metadata needs no permission
    // for the file itself.
    environment.file(|path| path.symlink_metadata().is_ok())
}

impl Environment {
    fn file(self, there: impl Fn(&Path) -> bool) -> Result<Option<PathBuf>, ConfigurationError> {
        let named = self.named.filter(|name| !name.is_empty()).map(PathBuf::from);
        match (named, self.raised_privileges) {
            (Some(path), false) => return Ok(Some(path)),
            (Some(path), true) => return Err(ConfigurationError::UntrustedEnvironment { path, system: SYSTEM_FILE }),
            (None, true) => return Ok(Some(PathBuf::from(SYSTEM_FILE)).filter(|path| there(path))),
            (None, false) => {}
        }
        let system = self.system.filter(|folders| !folders.is_empty()).unwrap_or("/etc/xdg".into());
        // The XDG specification requires that relative folders are ignored.
        let system = env::split_paths(&system).filter(|folder| folder.is_absolute()).collect::<Vec<_>>();
        let folders = self.user.into_iter().chain(system);
        let candidates =
            [PathBuf::from("sun2xp.toml")].into_iter().chain(folders.map(|f| f.join("sun2xp/sun2xp.toml")));
        Ok(candidates.into_iter().find(|path| there(path)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(raised_privileges: bool, named: &str, files: &[&str]) -> Result<Option<String>, ConfigurationError> {
        let environment = Environment {
            raised_privileges,
            named: Some(named.into()),
            user: Some("/home/me/.config".into()),
            system: Some("relative:/opt/xdg:/etc/xdg".into()),
        };
        let file = environment.file(|path| files.iter().any(|file| path == Path::new(file)))?;
        Ok(file.map(|path| path.display().to_string()))
    }

    const FILES: [&str; 4] =
        ["sun2xp.toml", "/home/me/.config/sun2xp/sun2xp.toml", "/opt/xdg/sun2xp/sun2xp.toml", SYSTEM_FILE];

    #[test]
    fn the_first_file_that_exists_is_found() {
        assert_eq!(found(false, "named", &FILES).expect("trusted").as_deref(), Some("named"));
        for first in 0..FILES.len() {
            assert_eq!(found(false, "", &FILES[first..]).expect("trusted").as_deref(), Some(FILES[first]));
        }
        assert_eq!(found(false, "", &["relative/sun2xp/sun2xp.toml"]).expect("trusted"), None);
    }

    #[test]
    fn user_settings_are_ignored_with_raised_privileges() {
        assert_eq!(found(true, "", &FILES).expect("nothing named").as_deref(), Some(SYSTEM_FILE));
        assert_eq!(found(true, "", &FILES[..3]).expect("nothing named"), None);
        let refusal = found(true, "named", &FILES).expect_err("named");
        assert_eq!(refusal.errno(), libc::EACCES);
        assert!(refusal.to_string().contains("named") && refusal.to_string().contains(SYSTEM_FILE), "{refusal}");
    }
}
