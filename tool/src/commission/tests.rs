//! Commissionings of fingers in memory, whose person does what the tool asks for.

mod ageing;
mod bench;
mod finger;
mod kinds;
mod mistakes;
mod sessions;
