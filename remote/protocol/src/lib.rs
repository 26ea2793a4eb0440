//! The messages between `sun2xp serve` and its clients, as docs/remote-protocol.md specifies them.

#![forbid(unsafe_code)]
#![warn(missing_docs)]
