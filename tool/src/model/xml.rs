//! A writer of indented XML. Names and values are numbers and the tool's own words, which need no escapes.

use std::fmt::{Display, Write};

/// A document under construction.
pub struct Xml {
    text: String,
    open: Vec<&'static str>,
}

/// An attribute of an element.
pub type Attribute<'a> = (&'static str, &'a dyn Display);

impl Xml {
    /// Constructs a document that begins with a comment.
    pub fn new(comment: &str) -> Self {
        Self { text: format!("<?xml version=\"1.0\"?>\n<!-- {comment} -->\n"), open: Vec::new() }
    }

    /// Writes the start of an element.
    pub fn open(&mut self, name: &'static str, attributes: &[Attribute]) {
        self.start(name, attributes, ">");
        self.open.push(name);
    }

    /// Writes the end of the newest open element.
    pub fn close(&mut self) {
        let name = self.open.pop().expect("no more elements are closed than were opened");
        self.indent();
        self.put(format_args!("</{name}>\n"));
    }

    /// Writes an element without content.
    pub fn empty(&mut self, name: &'static str, attributes: &[Attribute]) {
        self.start(name, attributes, "/>");
    }

    /// Closes all elements and returns the text.
    pub fn finish(mut self) -> String {
        while !self.open.is_empty() {
            self.close();
        }
        self.text
    }

    fn start(&mut self, name: &str, attributes: &[Attribute], end: &str) {
        self.indent();
        self.put(format_args!("<{name}"));
        for (key, value) in attributes {
            self.put(format_args!(" {key}=\"{value}\""));
        }
        self.put(format_args!("{end}\n"));
    }

    fn indent(&mut self) {
        self.text.extend(std::iter::repeat_n("  ", self.open.len()));
    }

    fn put(&mut self, text: std::fmt::Arguments) {
        self.text.write_fmt(text).expect("a string grows as needed");
    }
}

/// Returns the numbers separated by spaces. Each has as many digits as it needs to be read back exactly.
pub fn numbers(numbers: impl IntoIterator<Item = f64>) -> String {
    // The addition makes -0 positive.
    numbers.into_iter().map(|number| (number + 0.0).to_string()).collect::<Vec<_>>().join(" ")
}

/// Returns lengths in cm as numbers in m.
pub fn metres(cm: impl IntoIterator<Item = f64>) -> String {
    numbers(cm.into_iter().map(|cm| cm / 100.0))
}
