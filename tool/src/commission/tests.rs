//! Commissionings of fingers in memory. A simulated person does what the tool asks for, or makes a mistake.

mod ageing;
mod bench;
mod finger;
mod kinds;
mod mistakes;
mod sessions;
