//! The C manual, which is the header, says the same in its chapters, in its entries and by what the library does.

mod adjusting;
#[allow(dead_code)]
#[path = "../c/mod.rs"]
mod c;
mod examples;
mod manual;
mod order;
mod sentences;
