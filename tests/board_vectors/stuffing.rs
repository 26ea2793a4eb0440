//! Stuffing by other means than the library's: by splitting at zeros.

/// As it goes on the wire. No run without a zero may be longer than 253 bytes: it would need more than one code.
pub fn stuffed(frame: &[u8]) -> Vec<u8> {
    // One run for each zero of the frame, and one for its end.
    let mut wire = Vec::new();
    for run in frame.split(|&byte| byte == 0) {
        wire.push(run.len() as u8 + 1);
        wire.extend(run);
    }
    wire.push(0);
    wire
}
