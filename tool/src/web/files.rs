//! The files of the page, which are a part of this program.

use axum::body::Body;
use axum::http::header::{CACHE_CONTROL, CONTENT_TYPE, ETAG, IF_NONE_MATCH};
use axum::http::{HeaderMap, Response, StatusCode};
use std::hash::{DefaultHasher, Hash, Hasher};

/// The page may load its own files only, and no other page may embed it.
pub const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; \
                          base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

macro_rules! files {
    ($($name:literal $kind:literal;)*) => {
        /// Every file: its name, its type and its contents.
        const FILES: &[(&str, &str, &[u8])] =
            &[$(($name, $kind, include_bytes!(concat!("../../page/", $name)))),*];
    };
}

files! {
    "index.html" "text/html; charset=utf-8";
    "style.css" "text/css; charset=utf-8";
    "icon.svg" "image/svg+xml";
    "arrow.js" "text/javascript; charset=utf-8";
    "control.js" "text/javascript; charset=utf-8";
    "element.js" "text/javascript; charset=utf-8";
    "ellipsoid.js" "text/javascript; charset=utf-8";
    "faults.js" "text/javascript; charset=utf-8";
    "finger3d.js" "text/javascript; charset=utf-8";
    "hand3d.js" "text/javascript; charset=utf-8";
    "labels.js" "text/javascript; charset=utf-8";
    "object3d.js" "text/javascript; charset=utf-8";
    "page.js" "text/javascript; charset=utf-8";
    "panel.js" "text/javascript; charset=utf-8";
    "plots.js" "text/javascript; charset=utf-8";
    "quality.js" "text/javascript; charset=utf-8";
    "scene.js" "text/javascript; charset=utf-8";
    "shapes.js" "text/javascript; charset=utf-8";
    "store.js" "text/javascript; charset=utf-8";
    "stream.js" "text/javascript; charset=utf-8";
    "theme.js" "text/javascript; charset=utf-8";
    "timeline.js" "text/javascript; charset=utf-8";
    "vendor/three.js" "text/javascript; charset=utf-8";
    "vendor/uplot.js" "text/javascript; charset=utf-8";
    "vendor/uplot.css" "text/css; charset=utf-8";
    "vendor/three.LICENSE" "text/plain; charset=utf-8";
    "vendor/uplot.LICENSE" "text/plain; charset=utf-8";
}

/// Returns the response to a request for a file. `path` begins with a slash.
pub fn response(path: &str, headers: &HeaderMap) -> Response<Body> {
    let name = if path == "/" { "index.html" } else { path.trim_start_matches('/') };
    let Some(&(_, kind, contents)) = FILES.iter().find(|(file, ..)| *file == name) else {
        return status(StatusCode::NOT_FOUND, "No such file. Open the address that sun2xp has printed.\n");
    };
    // The browser keeps files, but asks each time whether they are those of the running program.
    let tag = tag(contents);
    let known = headers.get(IF_NONE_MATCH).is_some_and(|given| given.as_bytes() == tag.as_bytes());
    let mut response = if known {
        status(StatusCode::NOT_MODIFIED, "")
    } else {
        let mut response = Response::new(Body::from(contents));
        response.headers_mut().insert(CONTENT_TYPE, axum::http::HeaderValue::from_static(kind));
        response
    };
    response.headers_mut().insert(CACHE_CONTROL, axum::http::HeaderValue::from_static("no-cache"));
    if let Ok(tag) = tag.parse() {
        response.headers_mut().insert(ETAG, tag);
    }
    response
}

/// Returns a response that consists of a status and a text.
pub fn status(code: StatusCode, text: &'static str) -> Response<Body> {
    let mut response = Response::new(Body::from(text));
    *response.status_mut() = code;
    response
}

fn tag(contents: &[u8]) -> String {
    let mut hasher = DefaultHasher::new();
    contents.hash(&mut hasher);
    format!("\"{:016x}\"", hasher.finish())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use std::fs;
    use std::path::Path;

    fn names(folder: &Path, prefix: &str) -> BTreeSet<String> {
        let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry"));
        let name = |entry: &fs::DirEntry| format!("{prefix}{}", entry.file_name().to_str().expect("ASCII"));
        entries.filter(|entry| entry.path().is_file()).map(|entry| name(&entry)).collect()
    }

    #[test]
    fn every_file_of_the_page_is_served() {
        let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("page");
        let mut files = names(&page, "");
        files.extend(names(&page.join("vendor"), "vendor/"));
        let unserved = ["vendor/README.md", "vendor/three-entry.js", "vendor/update"];
        files.retain(|file| !unserved.contains(&file.as_str()));
        assert_eq!(files, FILES.iter().map(|(name, ..)| (*name).to_owned()).collect());
    }

    #[test]
    fn the_page_names_no_other_server() {
        for (name, _, contents) in FILES.iter().filter(|(name, ..)| !name.starts_with("vendor/")) {
            let text = str::from_utf8(contents).expect("UTF-8");
            let foreign = text.replace("http://www.w3.org/2000/svg", "");
            assert!(!foreign.contains("http://") && !foreign.contains("https://"), "{name}");
        }
    }

    #[test]
    fn a_file_that_the_browser_has_is_not_sent_again() {
        let first = response("/", &HeaderMap::new());
        let mut headers = HeaderMap::new();
        headers.insert(IF_NONE_MATCH, first.headers()[ETAG].clone());
        assert_eq!(response("/", &headers).status(), StatusCode::NOT_MODIFIED);
        assert_eq!(response("/page.js", &headers).status(), StatusCode::OK);
        assert_eq!(response("/../Cargo.toml", &headers).status(), StatusCode::NOT_FOUND);
    }
}
