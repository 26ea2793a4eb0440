//! The C calls of libsun2xp for a hand on another machine.
