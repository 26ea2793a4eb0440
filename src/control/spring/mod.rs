//! The spring at the fingertip: conversion of a set point to joint torques.

pub(crate) mod admissible_damping;
pub(crate) mod admissible_stiffness;
pub(crate) mod gravity_compensation;
pub(crate) mod joint_hold;
pub(crate) mod joint_spring;
pub(crate) mod joint_springs;
pub(crate) mod joint_stiffness;
pub(crate) mod slew;
pub(crate) mod soft_limits;
pub(crate) mod spring_transition;
