//! Byte stuffing (COBS) that is independent of the library's: it splits the frame at zeros.

/// Encodes a frame for the line. A run without a zero must not exceed 253 bytes, because a longer run needs another
/// encoding.
pub fn stuffed(frame: &[u8]) -> Vec<u8> {
    // One run for each zero of the frame and one for its end.
    let mut wire = Vec::new();
    for run in frame.split(|&byte| byte == 0) {
        wire.push(run.len() as u8 + 1);
        wire.extend(run);
    }
    wire.push(0);
    wire
}
