//! `sun2xp jog`: moves a hand by keys.

#![allow(dead_code, reason = "the commands come before their users")]

pub mod commands;
