//! `sun2xp serve`: offers a hand to planners on other machines.

#![deny(unsafe_code)]
