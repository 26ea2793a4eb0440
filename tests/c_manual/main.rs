//! The manual of the C calls consists of the comments of the two headers. Its chapters, its entries and the library's
//! behaviour must agree.

mod adjusting;
#[allow(dead_code)]
#[path = "../c/mod.rs"]
mod c;
mod examples;
mod manual;
mod order;
mod sentences;
