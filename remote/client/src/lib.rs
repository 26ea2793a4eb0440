//! A hand that `sun2xp serve` offers on another machine.

#![deny(unsafe_code)]
#![warn(missing_docs)]
