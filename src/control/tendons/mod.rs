//! The tendons: conversion of joint torques to tensions, and of tensions to pulls of the motors.

pub(crate) mod bumpless_transfer;
pub(crate) mod figure10;
pub(crate) mod figure11;
pub(crate) mod figure9;
pub(crate) mod gains;
pub(crate) mod low_pass;
pub(crate) mod release;
pub(crate) mod tendon_controller;
pub(crate) mod tension_distribution;
pub(crate) mod tension_integral;
mod tuned_gains;
