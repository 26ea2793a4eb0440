//! A damaged recording.

/// Flips a bit in the middle of the chunk that is in the middle of a recording. Some bits between the chunks, and some
/// bits of the headers of chunks, have no checksum, so a reader would not detect their change.
pub fn damaged(file: &[u8]) -> Vec<u8> {
    let mut damaged = file.to_vec();
    // A record begins with its kind and its length.
    let (mut record, header) = (mcap::MAGIC.len(), 9);
    loop {
        let length = u64::from_le_bytes(file[record + 1..record + header].try_into().expect("eight bytes")) as usize;
        let end = record + header + length;
        if file[record] == mcap::records::op::CHUNK && end > file.len() / 2 {
            damaged[record + header + length / 2] ^= 1;
            return damaged;
        }
        record = end;
    }
}
