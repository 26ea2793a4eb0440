//! `sun2xp manual`: the manual pages of the tool, of every C call and of the configuration file. The calls are
//! documented in the C headers, and the keys in docs/sun2xp.toml, so that each text exists once.

mod body;
mod calls;
mod configuration;

use crate::failure::{Failure, unreadable, unwritable};
use clap::Command;
use clap_mangen::roff::Roff;
use std::fs;
use std::path::{Path, PathBuf};

const CONFIGURATION: &str = include_str!("../../docs/sun2xp.toml");

/// Writes the manual pages of the tool (section 1), the C calls (3) and the configuration file (5).
#[derive(clap::Args)]
#[command(hide = true)]
pub struct Arguments {
    /// The folder of the pages. man1, man3 and man5 are created in it.
    folder: PathBuf,
    /// The C headers, such as include/Sun2Xp.h.
    headers: Vec<PathBuf>,
}

/// A C header.
struct Header {
    /// The name without .h, such as Sun2Xp.
    name: String,
    text: String,
}

/// A manual page.
struct Page {
    name: String,
    section: u8,
    /// The page without its first line, which names it.
    text: Roff,
}

pub fn run(arguments: &Arguments, command: Command) -> Result<(), Failure> {
    let tool = arguments.folder.join("man1");
    fs::create_dir_all(&tool).map_err(|error| unwritable(&tool, &error))?;
    clap_mangen::generate_to(command, &tool).map_err(|error| unwritable(&tool, &error))?;
    let mut pages = vec![configuration::page(CONFIGURATION)];
    for path in &arguments.headers {
        let header = Header::read(path)?;
        pages.extend(calls::pages(&header));
        pages.push(calls::chapters(&header));
    }
    for page in pages {
        page.write(&arguments.folder)?;
    }
    Ok(())
}

impl Header {
    fn read(path: &Path) -> Result<Self, Failure> {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Ok(Self { name, text: fs::read_to_string(path).map_err(|error| unreadable(path, &error))? })
    }
}

impl Page {
    fn write(self, folder: &Path) -> Result<(), Failure> {
        let Self { name, section, text } = self;
        let folder = folder.join(format!("man{section}"));
        fs::create_dir_all(&folder).map_err(|error| unwritable(&folder, &error))?;
        let version = concat!("sun2xp ", env!("CARGO_PKG_VERSION"));
        let mut page = Roff::new();
        page.control("TH", [name.as_str(), &section.to_string(), "", version, "sun2xp"]);
        page.extend([text]);
        let file = folder.join(format!("{name}.{section}"));
        fs::write(&file, page.render()).map_err(|error| unwritable(&file, &error))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The headers of the library.
    fn headers() -> Vec<Header> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../include");
        let files = fs::read_dir(folder).expect("the headers").map(|entry| entry.expect("a header").path());
        let headers = files.filter(|path| path.extension().is_some_and(|ending| ending == "h"));
        headers.map(|path| Header::read(&path).expect("text")).collect()
    }

    fn page(name: &str) -> String {
        let pages = headers().into_iter().flat_map(|header| calls::pages(&header));
        pages.into_iter().find(|page| page.name == name).expect("a page").text.render()
    }

    #[test]
    fn a_file_that_cannot_be_read_or_written_is_named() {
        let folder = tempfile::tempdir().expect("a folder");
        let missing = folder.path().join("missing.h");
        let failure = Header::read(&missing).err().expect("missing").to_string();
        assert!(failure.contains("missing.h") && failure.contains("Name an existing file"), "{failure}");
        let file = folder.path().join("file");
        fs::write(&file, "").expect("written");
        let page = Page { name: "page".into(), section: 3, text: Roff::new() };
        let failure = page.write(&file).expect_err("no folder").to_string();
        assert!(failure.contains("cannot write") && failure.contains("file/man3"), "{failure}");
    }

    #[test]
    fn every_call_of_the_headers_has_a_page() {
        let mut count = 0;
        for header in headers() {
            let pages = calls::pages(&header);
            let names: Vec<&str> = pages.iter().map(|page| page.name.as_str()).collect();
            let declared = header.text.lines().filter(|line| {
                let starts = ["int ", "unsigned ", "const char *", "struct ", "sun2xp_hand *"];
                starts.iter().any(|kind| line.starts_with(kind)) && line.ends_with(");") && !line.contains(" Sun2Xp")
            });
            for line in declared {
                let name = line.split('(').next().and_then(|start| start.rsplit([' ', '*']).next()).expect("a name");
                assert!(names.contains(&name), "{name} of the line {line}");
                count += 1;
            }
        }
        assert!(count > 40, "{count} calls");
    }

    #[test]
    fn a_page_of_a_call_has_its_prototype_and_errors() {
        let page = page("GetPos");
        for part in [
            "GetPos \\- read the joint angles of a finger",
            "#include <Sun2Xp.h>",
            "int GetPos(int i, float *Pos);",
            ".SH PARAMETERS",
            ".SH \"RETURN VALUE\"",
            "the finger is faulted",
            ".SH EXAMPLES",
        ] {
            assert!(page.contains(part), "{part} is not in\n{page}");
        }
    }

    #[test]
    fn a_page_of_a_call_with_a_handle_has_its_prototype_and_struct() {
        let page = page("sun2xp_limits");
        for part in [
            "#include <sun2xp.h>",
            "int sun2xp_limits(sun2xp_hand *hand, int finger, struct sun2xp_limits *limits);",
            ".SH STRUCTURES",
            "double stiffness;",
        ] {
            assert!(page.contains(part), "{part} is not in\n{page}");
        }
    }

    #[test]
    fn a_description_may_have_lines_and_paragraphs_that_begin_with_returns() {
        let text = "\n/*\n rest - wait\n\n   finger   1 to 3\n\n Returns at once if the finger rests. The call\n \
                    Returns early in no other case.\n\n Returns 0.\n\n Threads: any.\n */\nint rest(int finger);\n";
        let header = Header { name: "fingers".into(), text: text.into() };
        let page = calls::pages(&header).remove(0).text.render();
        let (_, description) = page.split_once(".SH DESCRIPTION\n").expect("a description");
        let (description, value) = description.split_once(".SH \"RETURN VALUE\"\n").expect("a return value");
        assert!(description.contains("Returns at once") && description.contains("Returns early"), "{page}");
        assert!(value.contains("Returns 0."), "{page}");
    }

    #[test]
    fn the_page_of_the_configuration_has_every_table_and_key() {
        let page = configuration::page(CONFIGURATION).text.render();
        let keys = CONFIGURATION.lines().filter_map(configuration::key);
        let keys: Vec<_> = keys.collect();
        assert!(keys.len() > 100, "{} keys", keys.len());
        for (key, _) in keys {
            assert!(page.contains(&key.replace('-', "\\-")), "{key}");
        }
        assert!(page.contains("[finger.tendon]"), "{page}");
    }

    #[test]
    fn the_page_of_the_configuration_has_every_comment_and_optional_table() {
        let page = configuration::page(CONFIGURATION).text.render().replace("\\-", "-").replace("\\*(Aq", "'");
        for comment in CONFIGURATION.lines().filter_map(|line| line.strip_prefix("# ")) {
            assert!(page.contains(comment.trim()), "{comment}");
        }
        for table in ["[hand.simulated_object]", "[telemetry]", "[finger.1]", "[finger.2]", "[finger.3]"] {
            assert!(page.contains(&format!("\n.SH {table}\n")), "{table}");
        }
        // The keys of an optional table are below its title, and its comment is between the title and the first key.
        let (_, object) = page.split_once(".SH [hand.simulated_object]\n").expect("the table");
        let (comment, _) = object.split_once("shape").expect("its first key");
        assert!(comment.contains("An object in the simulated hand"), "{comment}");
    }
}
