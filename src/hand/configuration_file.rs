//! Finds the configuration file and converts it to a [`Configuration`]. Errors name the file, the line and the reason.

mod named_hand;
mod place;
mod simulated;
mod text;
mod values;
mod with_io;
mod wrong;

use crate::files::{raised_privileges, read_regular_file};
use crate::hand::ConfigurationError;
use crate::hand::notice::print_notice;
use crate::model::configuration::{Configuration, FINGERS};
use crate::model::{FingerNumber, Fingers, ShownPath};
use std::path::{Path, PathBuf};
use text::Said;
pub(super) use text::{line_of_key, overlay};
pub use values::deserialize;
pub(super) use values::to_document;
pub(crate) use with_io::FingersWithIo;
pub use wrong::Wrong;

/// Largest configuration file, bytes: more than thirty times the size of docs/sun2xp.toml, which contains every key.
pub(super) const LARGEST: u64 = 1 << 20;

/// A configuration and its source.
#[derive(Clone, Debug)]
pub struct Configured {
    /// The configuration of the hand.
    pub configuration: Configuration,
    /// The file; `None` if no file was found, or if the configuration does not come from a file.
    pub file: Option<PathBuf>,
    /// Which fingers' ports the configuration names, and whether it has the table `[remote]`.
    said: Said,
}

/// Finds and reads the configuration file: the file that `SUN2XP_CONFIG` names, or else `sun2xp.toml` in the working
/// directory, or else `sun2xp/sun2xp.toml` in the user's configuration folder, or else in the system's
/// configuration folders (`XDG_CONFIG_DIRS`, or `/etc/xdg`). If none of them exists, the hand is simulated. An empty
/// `SUN2XP_CONFIG` counts as unset.
///
/// A program that is setuid or setgid, or whose file has capabilities, reads only `/etc/xdg/sun2xp/sun2xp.toml`,
/// because its caller controls the environment and the working directory.
///
/// # Errors
/// Returns an error if the file cannot be read or used. It is also an error if `SUN2XP_CONFIG` names a missing file, or
/// is set for a program that must not use it: a planner that expects a real hand must never get the simulation instead.
pub fn find_configuration() -> Result<Configured, ConfigurationError> {
    Configured::find_with_io(FingersWithIo::default())
}

/// Reads and checks one configuration file.
///
/// # Errors
/// Returns [`ConfigurationError::Invalid`], with file, line and reason, if the text is wrong. Returns
/// [`ConfigurationError::Unreadable`] if the file cannot be read, is not a regular file or is larger than 1 MiB, and
/// [`ConfigurationError::Remote`] if the file names a hand on another machine.
pub fn read_configuration(path: &Path) -> Result<Configuration, ConfigurationError> {
    Configured::read(path)?.local().map(|configured| configured.configuration)
}

/// Checks a configuration that a program has as text, in the format of a configuration file.
///
/// # Errors
/// Returns [`ConfigurationError::Invalid`], with line and reason, if the text is wrong. Returns
/// [`ConfigurationError::Remote`] if the text names a hand on another machine.
pub fn parse_configuration(text: &str) -> Result<Configuration, ConfigurationError> {
    Configured::from_text(text)?.local().map(|configured| configured.configuration)
}

fn invalid_text(text: &str, wrong: &Wrong) -> ConfigurationError {
    let file = PathBuf::from("configuration text");
    ConfigurationError::Invalid { file, line: wrong.line(text), reason: wrong.to_string() }
}

/// Reads and checks the text of a configuration file. Ports and boards of the fingers in `with_io` are ignored.
pub(super) fn parse(text: &str, with_io: FingersWithIo) -> Result<Configuration, Wrong> {
    with_io.parse(text).map(|(configuration, _)| configuration)
}

impl Configured {
    /// Reads and checks one configuration file.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read or used.
    pub fn read(path: &Path) -> Result<Self, ConfigurationError> {
        Self::read_with_io(path, FingersWithIo::default())
    }

    /// Reads and checks the text of a configuration. Fingers without a port are simulated, which is not announced.
    ///
    /// # Errors
    /// Returns [`ConfigurationError::Invalid`], with line and reason, if the text is wrong.
    pub fn from_text(text: &str) -> Result<Self, ConfigurationError> {
        Self::from_text_with_io(text, FingersWithIo::default())
    }

    /// Does the same as [`find_configuration`], but ignores ports and boards of the fingers in `with_io`.
    pub(crate) fn find_with_io(with_io: FingersWithIo) -> Result<Self, ConfigurationError> {
        match place::locate()? {
            Some(path) => Self::read_with_io(&path, with_io),
            None => Ok(Self { configuration: Configuration::default(), file: None, said: Said::default() }),
        }
    }

    /// Does the same as [`Configured::read`], but ignores ports and boards of the fingers in `with_io`.
    pub(crate) fn read_with_io(path: &Path, with_io: FingersWithIo) -> Result<Self, ConfigurationError> {
        Self::read_with(path, |text| with_io.parse(text))
    }

    /// Reads one configuration file. `parse` reads and checks its text.
    fn read_with(
        path: &Path,
        parse: impl FnOnce(&str) -> Result<(Configuration, Said), Wrong>,
    ) -> Result<Self, ConfigurationError> {
        let file = path.to_path_buf();
        let text = read_regular_file(path, LARGEST)
            .map_err(|source| ConfigurationError::Unreadable { path: file.clone(), source })?;
        match parse(&text) {
            Ok((configuration, said)) => Ok(Self { configuration, file: Some(file), said }),
            Err(wrong) => Err(ConfigurationError::Invalid { file, line: wrong.line(&text), reason: wrong.to_string() }),
        }
    }

    /// Does the same as [`Configured::from_text`], but ignores ports and boards of the fingers in `with_io`.
    pub(crate) fn from_text_with_io(text: &str, with_io: FingersWithIo) -> Result<Self, ConfigurationError> {
        let (configuration, said) = with_io.parse(text).map_err(|wrong| invalid_text(text, &wrong))?;
        Ok(Self { configuration, file: None, said: Said { ports: [true; FINGERS], ..said } })
    }

    /// Whether the table `[remote]` names a hand on another machine.
    pub(crate) fn is_remote(&self) -> bool {
        self.said.remote
    }

    /// Ignores a table `[remote]`. The server of a hand opens the hand of this machine, and its clients may read the
    /// same file.
    #[must_use]
    pub fn of_this_machine(mut self) -> Self {
        self.said.remote = false;
        self
    }

    /// Refuses a configuration with a table `[remote]`, for programs that open only hands of this machine. The fingers
    /// of such a configuration have no ports, so the program would open a simulated hand instead.
    ///
    /// # Errors
    /// Returns [`ConfigurationError::Remote`] if there is such a table.
    pub fn local(self) -> Result<Self, ConfigurationError> {
        if self.said.remote {
            let file = self.file.unwrap_or_else(|| "configuration text".into());
            return Err(ConfigurationError::Remote { file });
        }
        Ok(self)
    }

    /// Notes that the program provides the hardware of this finger, so that its port does not matter.
    pub(super) fn provides(&mut self, finger: FingerNumber) {
        self.said.ports[finger.index()] = true;
    }

    /// Reports in one line that some of these fingers are simulated although the configuration does not request it. If
    /// there is a configuration file, the line names the fingers.
    pub fn announce(&self, fingers: Fingers) {
        if let Some(line) = self.notice(fingers) {
            print_notice(&line);
        }
    }

    fn notice(&self, fingers: Fingers) -> Option<String> {
        let Some(file) = &self.file else {
            if self.said.ports == [true; FINGERS] {
                return None;
            }
            return Some(without_file(raised_privileges()));
        };
        let unnamed: Vec<String> = fingers
            .members()
            .filter(|&number| self.configuration.hand.fingers.contains(number) && !self.said.ports[number.index()])
            .map(|number| number.to_string())
            .collect();
        let fingers = match unnamed.len() {
            0 => return None,
            1 => format!("for finger {}: it is", unnamed[0]),
            FINGERS => "for any finger: the whole hand is".into(),
            _ => format!("for fingers {}: they are", unnamed.join(" and ")),
        };
        let file = ShownPath(file);
        Some(format!("{file} names no port {fingers} simulated (set port = \"simulated\" to confirm this)"))
    }
}

/// The notice of a hand that is simulated because there is no configuration file.
fn without_file(raised_privileges: bool) -> String {
    if raised_privileges {
        let file = place::SYSTEM_FILE;
        return format!(
            "no {file}: the hand is simulated (to use a real hand, describe it in this file: a program that is setuid \
             or setgid, or has capabilities, reads no other configuration file)"
        );
    }
    "no configuration file: the hand is simulated (to use a real hand, describe it in sun2xp.toml)".into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_notice_of_a_missing_file_says_where_to_describe_a_real_hand() {
        for (raised, file) in [(false, "sun2xp.toml"), (true, place::SYSTEM_FILE)] {
            let said = without_file(raised);
            assert!(said.contains("to use a real hand, describe it in") && said.contains(file), "{said}");
        }
    }

    #[test]
    fn fingers_without_a_port_are_announced_by_their_numbers() {
        for (text, expected) in [
            ("", Some("for any finger: the whole hand is simulated")),
            (
                "[hand]\nrate = 500\n[finger.2.tendon]\nminimum = 6\n",
                Some("for any finger: the whole hand is simulated"),
            ),
            ("[finger.1]\nport = 'simulated'\n", Some("for fingers 2 and 3: they are simulated")),
            ("[finger]\n1.port = 'simulated'\n3.port = 'simulated'\n", Some("for finger 2: it is simulated")),
            ("[hand]\nfingers = [2]\n", Some("for finger 2: it is simulated")),
            ("[hand]\nfingers = [1]\n[finger.1]\nport = '/dev/a'\n", None),
            ("[finger]\nport = 'simulated'\n", None),
            ("[finger]\nport = 'simulated'\n[finger.1]\nport = '/dev/a'\n", None),
            ("finger = { 1 = { port = 'simulated' }, 2.port = '/dev/b', 3.port = '/dev/c' }\n", None),
        ] {
            let (configuration, said) = text::parse(text).expect("usable");
            let configured = Configured { configuration, file: Some("the/file".into()), said };
            let notice = configured.notice(Fingers::ALL);
            match expected {
                None => assert_eq!(notice, None),
                Some(expected) => {
                    let said = notice.unwrap_or_else(|| panic!("no notice for {text:?}"));
                    assert!(said.starts_with(&format!("the/file names no port {expected} (")), "{said}");
                }
            }
        }
    }

    #[test]
    fn a_wrong_text_is_refused_with_its_line() {
        assert_eq!(parse_configuration("[hand]\nrate = 500\n").expect("usable").hand.rate, 500.0);
        let refusal = parse_configuration("[hand]\nrate = 1\n").expect_err("refused");
        assert!(refusal.to_string().starts_with("configuration text:2: hand.rate: "), "{refusal}");
    }

    #[test]
    fn tables_of_other_programs_are_ignored() {
        let (configuration, said) = text::parse("[serve]\nname = 'left'\n[serve.tls]\nkey = 'k'\n").expect("usable");
        assert_eq!((configuration, said.remote), (Configuration::default(), false));
        let (configuration, said) = text::parse("[remote]\nendpoint = 'tcp/cell:7447'\n").expect("usable");
        assert_eq!((configuration, said.remote), (Configuration::default(), true));
    }

    #[test]
    fn a_hand_on_another_machine_is_refused_by_calls_that_open_hands_of_this_machine() {
        let text = "[remote]\nendpoint = 'tcp/cell:7447'\nhand = 'left'\n";
        let configured = Configured::from_text(text).expect("usable");
        assert!(configured.clone().of_this_machine().local().is_ok());
        let refusal = crate::hand::Hand::open_as(configured).err().expect("refused").to_string();
        assert!(refusal.starts_with("configuration text has a table [remote]"), "{refusal}");
        let refusal = parse_configuration(text).expect_err("refused");
        assert!(matches!(refusal, ConfigurationError::Remote { .. }), "{refusal}");
        assert!(Configured::from_text("").expect("usable").local().is_ok());
    }

    #[test]
    fn fingers_that_are_not_opened_are_not_announced() {
        let text = "[finger.1]\nport = 'simulated'\n";
        let (configuration, said) = text::parse(text).expect("usable");
        let configured = Configured { configuration, file: Some("the/file".into()), said };
        assert_eq!(configured.notice(Fingers::only(1).expect("finger 1")), None);
        let said = configured.notice(Fingers::only(3).expect("finger 3")).expect("a notice");
        assert!(said.contains("for finger 3: it is simulated"), "{said}");
    }
}
