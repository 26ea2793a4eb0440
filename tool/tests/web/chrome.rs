//! A headless Chromium, driven over the WebDriver protocol of chromedriver.

use super::browser::alone;
use super::http::{WAIT, request};
use super::tools::available;
use serde_json::{Value, json};
use std::io::{BufRead, BufReader};
use std::net::SocketAddr;
use std::os::unix::process::CommandExt;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use std::{fs, thread};
use tempfile::TempDir;

/// A browser with one page. The browser ends when this value is dropped.
pub struct Browser {
    driver: Child,
    address: SocketAddr,
    session: String,
    _profile: TempDir,
}

impl Browser {
    /// Starts a browser with a window of this size, pixels.
    pub fn start(width: u32, height: u32) -> Self {
        let mut driver = Command::new("chromedriver")
            .arg("--port=0")
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            // Chromedriver starts its browser in this group too.
            .process_group(0)
            .spawn()
            .expect("chromedriver starts");
        let lines = BufReader::new(driver.stdout.take().expect("a pipe")).lines().map_while(Result::ok);
        let port = lines
            .filter_map(|line| line.strip_suffix('.')?.rsplit_once("on port ")?.1.parse().ok())
            .next()
            .expect("chromedriver prints its port");
        let profile = tempfile::tempdir().expect("a folder");
        let mut browser = Self {
            driver,
            address: SocketAddr::from(([127, 0, 0, 1], port)),
            session: String::new(),
            _profile: profile,
        };
        let folder = format!("--user-data-dir={}", browser._profile.path().display());
        let size = format!("--window-size={width},{height}");
        let arguments = [
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--enable-unsafe-swiftshader",
            "--disable-quic",
            "--no-first-run",
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
            &folder,
            &size,
        ];
        let capabilities = json!({ "capabilities": { "alwaysMatch": {
            "goog:chromeOptions": { "args": arguments },
            "goog:loggingPrefs": { "browser": "ALL", "performance": "ALL" },
        } } });
        let session = browser.call("POST", "/session", &capabilities);
        browser.session = format!("/session/{}", session["sessionId"].as_str().expect("a session"));
        browser
    }

    /// Opens a page.
    pub fn open(&self, url: &str) {
        self.call("POST", &format!("{}/url", self.session), &json!({ "url": url }));
    }

    /// Runs the body of a function in the page, and returns its result. `await` works in it.
    pub fn run(&self, body: &str) -> Value {
        let script = format!("const done = arguments[0]; (async () => {{ {body} }})().then(done)");
        self.call("POST", &format!("{}/execute/async", self.session), &json!({ "script": script, "args": [] }))
    }

    /// Runs a function body until it returns something true.
    pub fn wait_for(&self, body: &str) -> Value {
        let end = Instant::now() + WAIT;
        while Instant::now() < end {
            let found = self.run(&format!("return (() => {{ {body} }})() || null"));
            if !found.is_null() {
                return found;
            }
            // Waits for one picture, so that the page can do its own work.
            self.run("await new Promise(requestAnimationFrame)");
        }
        panic!("this script returned nothing true within {WAIT:?}: {body}")
    }

    /// Presses keys, or moves and presses the mouse, as a person does. `sources` are the input sources of the WebDriver
    /// command Perform Actions, each with its actions. What is pressed stays pressed until a later call releases it.
    pub fn act(&self, sources: &Value) {
        self.call("POST", &format!("{}/actions", self.session), &json!({ "actions": sources }));
    }

    /// Returns the entries of a log since the last call: `browser` is the console, `performance` the network.
    pub fn log(&self, kind: &str) -> Vec<Value> {
        let entries = self.call("POST", &format!("{}/se/log", self.session), &json!({ "type": kind }));
        entries.as_array().expect("entries").clone()
    }

    fn call(&self, method: &str, path: &str, body: &Value) -> Value {
        let host = self.address.to_string();
        let headers = [("Host", host.as_str()), ("Content-Type", "application/json"), ("Connection", "close")];
        let response = request(self.address, method, path, &headers, &body.to_string());
        let mut answer: Value = serde_json::from_slice(&response.body).expect("JSON");
        assert_eq!(response.status, 200, "{path}: {answer}");
        answer["value"].take()
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        if !self.session.is_empty() && !thread::panicking() {
            self.call("DELETE", &self.session, &json!({}));
        }
        // After a panic the session still exists, and its browser does not end with chromedriver.
        // SAFETY: kill does not touch memory. The group exists, because nothing has waited for its first process.
        unsafe { libc::kill(-(self.driver.id() as i32), libc::SIGKILL) };
        let _ = self.driver.wait();
    }
}

/// Returns the number of processes whose command line contains this text.
fn processes(text: &str) -> usize {
    let entries = fs::read_dir("/proc").expect("Linux").filter_map(Result::ok);
    let lines = entries.filter_map(|entry| fs::read(entry.path().join("cmdline")).ok());
    lines.filter(|line| String::from_utf8_lossy(line).contains(text)).count()
}

#[test]
fn a_test_that_panics_leaves_no_browser() {
    if !available("chromium", "the page in a browser") {
        return;
    }
    let _alone = alone();
    let (sender, receiver) = std::sync::mpsc::channel();
    let ended: thread::Result<()> = thread::spawn(move || {
        let browser = Browser::start(500, 500);
        let argument = format!("--user-data-dir={}", browser._profile.path().display());
        assert!(processes(&argument) > 0, "the browser runs");
        sender.send(argument).expect("the test waits");
        panic!("this test fails on purpose");
    })
    .join();
    let argument = receiver.recv().expect("the browser has started");
    assert!(ended.is_err());
    let end = Instant::now() + WAIT;
    while processes(&argument) > 0 {
        assert!(Instant::now() < end, "the browser still runs");
        thread::sleep(Duration::from_millis(10));
    }
}
