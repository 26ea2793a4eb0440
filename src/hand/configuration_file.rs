//! Finds the configuration file and turns it into a [`Configuration`], naming file, line and reason where it cannot.

mod text;
mod values;
mod wrong;

use crate::files::read_regular_file;
use crate::hand::HandError;
use crate::model::configuration::Configuration;
use etcetera::BaseStrategy;
use std::env;
use std::path::{Path, PathBuf};
pub(super) use text::overlay;
pub(super) use values::deserialize;
pub(super) use wrong::Wrong;

/// The largest configuration file that is read, bytes: more than sixty times docs/sun2xp.toml, which names every key.
const LARGEST: u64 = 1 << 20;

/// The file that `SUN2XP_CONFIG` names, else `sun2xp.toml` in the working directory, else `sun2xp/sun2xp.toml` in the
/// user's configuration folder, else in the system's (`XDG_CONFIG_DIRS`, or `/etc/xdg`); none of them: no path, and the
/// simulated hand. An empty `SUN2XP_CONFIG` counts as unset.
///
/// # Errors
/// A file that is named or found and cannot be read or used. A missing file that `SUN2XP_CONFIG` names is an error too:
/// a planner that believes it moves a real hand must never get the simulation instead.
pub fn configured() -> Result<(Configuration, Option<PathBuf>), HandError> {
    match locate() {
        Some(path) => read(&path).map(|configuration| (configuration, Some(path))),
        None => Ok((Configuration::default(), None)),
    }
}

/// Reads and checks one configuration file.
///
/// # Errors
/// [`HandError::Configuration`] with file, line and reason; [`HandError::ConfigurationFile`] where it cannot be read, is no regular file
/// or is larger than 1 MiB.
pub fn read(path: &Path) -> Result<Configuration, HandError> {
    let text = read_regular_file(path, LARGEST)
        .map_err(|source| HandError::ConfigurationFile { path: path.to_path_buf(), source })?;
    text::parse(&text).map_err(|wrong| HandError::Configuration {
        file: path.to_path_buf(),
        line: wrong.line(&text),
        reason: wrong.to_string(),
    })
}

fn locate() -> Option<PathBuf> {
    if let Some(named) = env::var_os("SUN2XP_CONFIG").filter(|name| !name.is_empty()) {
        return Some(named.into());
    }
    let user = etcetera::choose_base_strategy().ok().map(|strategy| strategy.config_dir());
    let system = env::var_os("XDG_CONFIG_DIRS").filter(|folders| !folders.is_empty()).unwrap_or("/etc/xdg".into());
    // The standard of these folders: relative ones are to be ignored.
    let system = env::split_paths(&system).filter(|folder| folder.is_absolute()).collect::<Vec<_>>();
    let folders = user.into_iter().chain(system);
    let candidates = [PathBuf::from("sun2xp.toml")].into_iter().chain(folders.map(|f| f.join("sun2xp/sun2xp.toml")));
    // A file that is there but unreadable is found, and refused: symlink_metadata needs no permission on the file itself.
    candidates.into_iter().find(|path| path.symlink_metadata().is_ok())
}
