//! Checks the links of the documentation to files of the project: each file exists, and so does the heading if the link
//! names one. Checks that no page contains the marks of an unfinished merge.

use std::fs;
use std::path::{Path, PathBuf};

/// Returns the pages: README, CHANGELOG and SECURITY, and the pages of docs/, of the firmware, of protocol/, of remote/
/// and of the Python package.
fn pages() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders = [".", "docs", "firmware", "firmware/stm32f405", "protocol", "remote", "python"];
    let files = folders.iter().flat_map(|folder| fs::read_dir(root.join(folder)).expect("a folder"));
    files
        .map(|file| file.expect("a file").path())
        .filter(|path| path.extension().is_some_and(|end| end == "md"))
        .collect()
}

/// Returns the targets of the links of a page. The project has no link with a title or with parentheses.
fn links(text: &str) -> impl Iterator<Item = &str> {
    text.split("](").skip(1).filter_map(|rest| Some(rest.split_once(')')?.0))
}

/// Returns the anchor of a heading: lower case, without punctuation, with hyphens for spaces.
fn anchor(heading: &str) -> String {
    let text = heading.trim_start_matches('#').trim().to_lowercase();
    let kept = text.chars().filter(|&sign| sign.is_alphanumeric() || matches!(sign, ' ' | '-' | '_'));
    kept.map(|sign| if sign == ' ' { '-' } else { sign }).collect()
}

/// Returns what is wrong with a link of a page.
fn wrong(page: &Path, link: &str) -> Option<String> {
    if link.contains("://") || link.starts_with("mailto:") {
        return None;
    }
    let (file, heading) = link.split_once('#').unwrap_or((link, ""));
    let target = if file.is_empty() { page.to_owned() } else { page.parent()?.join(file) };
    if !target.exists() {
        return Some(format!("{}: {link}: there is no such file", page.display()));
    }
    if heading.is_empty() {
        return None;
    }
    let text = fs::read_to_string(&target).expect("a page");
    let found = text.lines().filter(|line| line.starts_with('#')).any(|line| anchor(line) == heading);
    (!found).then(|| format!("{}: {link}: there is no such heading", page.display()))
}

#[test]
fn every_link_leads_to_a_file_and_a_heading() {
    let pages = pages();
    let texts: Vec<String> = pages.iter().map(|page| fs::read_to_string(page).expect("a page")).collect();
    let count: usize = texts.iter().map(|text| links(text).count()).sum();
    assert!(pages.len() > 25 && count > 100, "{} pages and {count} links were found", pages.len());
    let all = pages.iter().zip(&texts).flat_map(|(page, text)| links(text).map(move |link| (page, link)));
    let wrong: Vec<String> = all.filter_map(|(page, link)| wrong(page, link)).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn no_page_contains_the_marks_of_a_merge() {
    for page in pages() {
        let text = fs::read_to_string(&page).expect("a page");
        let mark = text.lines().find(|line| line.starts_with("<<<<<<<") || line.starts_with(">>>>>>>"));
        assert_eq!(mark, None, "{}", page.display());
    }
}
