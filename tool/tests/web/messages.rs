//! The messages to a page.

use super::socket::{Frame, Socket};
use serde_json::Value;

/// Returns the next message.
pub fn message(socket: &mut Socket) -> Value {
    match socket.next() {
        Frame::Text(text) => serde_json::from_str(&text).expect("JSON"),
        other => panic!("{other:?}"),
    }
}

/// Returns the next batch. If `answer` is true, the batch is also acknowledged.
pub fn batch(socket: &mut Socket, answer: bool) -> Value {
    loop {
        let message = message(socket);
        if message["type"] == "batch" {
            if answer {
                socket.send(&format!(r#"{{"received":{}}}"#, message["number"]));
            }
            return message;
        }
    }
}
