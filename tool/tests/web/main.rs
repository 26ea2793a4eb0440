//! `sun2xp monitor --web` and `sun2xp jog --web`: who may read the page and move the hand, and what a browser shows.

mod browser;
mod browser_control;
mod chrome;
mod control;
mod http;
mod messages;
mod program;
mod refusals;
mod slow_pages;
mod socket;
mod wake_up;

#[allow(dead_code)]
#[path = "../terminal/screen.rs"]
mod screen;

#[allow(dead_code)]
#[path = "../../../tests/common/tools.rs"]
mod tools;
