//! A person moves the hand on the page, with keys and mouse in headless Chromium.

use super::browser::alone;
use super::chrome::Browser;
use super::control::jog;
use super::program::Program;
use super::tools::available;
use serde_json::{Value, json};
use std::sync::MutexGuard;
use tempfile::TempDir;

/// Notes the commands of the page in `sent`.
const NOTE_COMMANDS: &str = "
    window.sent = [];
    const send = WebSocket.prototype.send;
    WebSocket.prototype.send = function (text) {
      const { command } = JSON.parse(text);
      if (command) window.sent.push(command);
      return send.call(this, text);
    };
";

/// Returns a JavaScript expression for the first button with this text in the control panel. A later row of the panel
/// may have a button with the same text.
fn button(text: &str) -> String {
    format!("[...document.querySelectorAll('#control button')].find((one) => one.textContent === '{text}')")
}

/// The button that pushes the fingertip along x.
const PUSH: &str = "document.querySelector('#control button[title^=\"Push the fingertip along +x\"]')";

/// Opens a page that may move its hand; none without a browser. While the guard lives, no other test uses a browser.
fn page() -> Option<(MutexGuard<'static, ()>, Program, TempDir, Browser)> {
    if !available("chromium", "the page in a browser") {
        return None;
    }
    let alone = alone();
    let (program, folder) = jog(&["--control"]);
    let browser = Browser::start(1280, 800);
    browser.open(&program.url);
    Some((alone, program, folder, browser))
}

fn key(value: &str) -> Value {
    let actions = json!([{ "type": "keyDown", "value": value }, { "type": "keyUp", "value": value }]);
    json!([{ "type": "key", "id": "keys", "actions": actions }])
}

/// Moves the mouse to the middle of a button, and then does `more`.
fn mouse(browser: &Browser, button: &str, more: &[Value]) {
    browser.wait_for(&format!("{button}?.scrollIntoView({{ block: 'nearest' }}); return !!{button}"));
    let place = browser.wait_for(&format!("return {button}?.getBoundingClientRect().toJSON()"));
    let middle = |from: &str, length: &str| {
        let number = |name: &str| place[name].as_f64().expect("a number");
        (number(from) + number(length) / 2.0) as i64
    };
    let (x, y) = (middle("x", "width"), middle("y", "height"));
    let mut actions = vec![json!({ "type": "pointerMove", "x": x, "y": y, "duration": 0 })];
    actions.extend_from_slice(more);
    browser.act(&json!([{ "type": "pointer", "id": "mouse", "actions": actions }]));
}

/// Releases the button of the mouse.
fn release(browser: &Browser) {
    let up = json!({ "type": "pointerUp", "button": 0 });
    browser.act(&json!([{ "type": "pointer", "id": "mouse", "actions": [up] }]));
}

fn commands(browser: &Browser) -> Vec<String> {
    let sent = browser.run("return window.sent.splice(0)");
    sent.as_array().expect("commands").iter().map(|name| name.as_str().expect("a name").to_owned()).collect()
}

#[test]
fn the_space_bar_stops_the_hand_wherever_the_focus_is() {
    let Some((_alone, _program, _folder, browser)) = page() else { return };
    // A click leaves the focus on a button. Until the page is connected, it may rebuild its buttons.
    let focus = format!("const close = {}; close?.focus(); return close === document.activeElement", button("Close"));
    browser.wait_for(&focus);
    browser.run(NOTE_COMMANDS);
    browser.act(&key(" "));
    browser.wait_for("return document.getElementById('link').textContent.includes('stopped')");
    assert_eq!(commands(&browser), ["stop"]);

    // A field for a number has the focus.
    browser.run("document.querySelector('#control input[type=number]').focus()");
    browser.act(&key(" "));
    assert_eq!(commands(&browser), ["stop"]);
}

/// The connection breaks as the stop is sent. The page connects again after half a second.
#[test]
fn a_stop_that_is_lost_with_the_connection_is_sent_again() {
    let Some((_alone, _program, _folder, browser)) = page() else { return };
    browser.wait_for(&format!("return !!{}", button("Close")));
    browser.run(
        "const send = WebSocket.prototype.send;
        WebSocket.prototype.send = function (text) {
          if (window.lost || JSON.parse(text).command !== 'stop') return send.call(this, text);
          window.lost = true;
          this.close();
        };",
    );
    browser.act(&key(" "));
    browser.wait_for("return window.lost && document.getElementById('link').textContent.includes('stopped')");
}

#[test]
fn a_held_button_ends_when_another_finger_is_selected() {
    let Some((_alone, _program, _folder, browser)) = page() else { return };
    browser.wait_for(&format!("return !!{}", button("+z")));
    browser.run(NOTE_COMMANDS);
    press(&browser, &button("+z"), "return true", "return window.sent.length > 2 && 'held'");
    browser.act(&key("2"));
    browser.wait_for("return document.querySelector('#control h3').textContent === 'Finger 2'");
    commands(&browser);
    // Ten times the interval of the commands of a held button.
    browser.run("await new Promise((resolve) => setTimeout(resolve, 600))");
    assert_eq!(commands(&browser), [""; 0]);
    release(&browser);
}

/// Presses a button until the page shows an answer, and returns it. `prepared` and `answer` are scripts: `prepared`
/// returns true when the button may be pressed, and `answer` returns the text of the answer, or a false value until
/// there is one. On a busy machine, the page may change between the calls for the press. If the mouse has therefore
/// pressed something else, this function releases the button, prints what happened, and presses again.
fn press(browser: &Browser, button: &str, prepared: &str, answer: &str) -> String {
    browser.run("addEventListener('pointerdown', (event) => { window.pressed = event.target; }, { capture: true })");
    loop {
        browser.wait_for(&format!(
            "if (!(() => {{ {prepared} }})()) return false;
            window.button = {button};
            window.pressed = null;
            return !!window.button;"
        ));
        mouse(browser, button, &[json!({ "type": "pointerDown", "button": 0 })]);
        let outcome = browser.wait_for(&format!(
            "const answer = (() => {{ {answer} }})();
            if (answer) return 'answer: ' + answer;
            if (!window.button.isConnected) return 'the page has built its panel anew';
            return window.pressed !== {button} && 'the mouse pressed ' + (window.pressed?.outerHTML ?? 'nothing');"
        ));
        let outcome = outcome.as_str().expect("a text");
        if let Some(answer) = outcome.strip_prefix("answer: ") {
            return answer.to_owned();
        }
        println!("The button is pressed again, because {outcome}.");
        release(browser);
    }
}

/// A push lasts while its button is held, so the page must not show a push that does not act.
#[test]
fn a_button_whose_push_was_refused_does_not_stay_pressed() {
    let Some((_alone, _program, _folder, browser)) = page() else { return };
    let refused = "const message = document.querySelector('#control .message');
        return message.className === 'message refused' && message.textContent.includes('components are smaller')";
    let strong = "const force = document.querySelector('#control input[aria-label^=\"force of the push\"]');
        if (!force || document.getElementById('link').dataset.state !== 'live') return false;
        force.max = 2000;
        force.value = 2000;
        return true;";
    press(&browser, PUSH, strong, &format!("return (() => {{ {refused} }})() && 'refused'"));
    browser.wait_for(&format!("return !{PUSH}.classList.contains('held')"));
    release(&browser);
    // In this time, the answer to the end of the push arrives. It must not replace the message of the refusal.
    browser.run("await new Promise((resolve) => setTimeout(resolve, 600))");
    assert_eq!(browser.run(refused), true);
}

#[test]
fn a_held_button_ends_with_the_connection() {
    let Some((_alone, _program, _folder, browser)) = page() else { return };
    browser.run(
        "const send = WebSocket.prototype.send;
        WebSocket.prototype.send = function (text) {
          window.socket = this;
          return send.call(this, text);
        };",
    );
    let live = "return window.socket && document.getElementById('link').dataset.state === 'live'";
    let held_or_refused = format!(
        "if ({PUSH}?.classList.contains('held')) return 'held';
        const message = document.querySelector('#control .message');
        return message?.className === 'message refused' && message.textContent;"
    );
    assert_eq!(press(&browser, PUSH, live, &held_or_refused), "held");
    browser.run("window.socket.close()");
    browser.wait_for(&format!("return !{PUSH}.classList.contains('held')"));
    release(&browser);
}
