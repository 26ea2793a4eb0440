//! Reads and writes little-endian numbers in sequence. The order of the calls is the layout of the frame.

/// Reads numbers from the front of a frame's body. The caller has checked the length of the body. Numbers beyond its
/// end read as zero.
pub(super) struct FieldReader<'a>(&'a [u8]);

impl<'a> FieldReader<'a> {
    pub fn new(body: &'a [u8]) -> Self {
        Self(body)
    }

    pub fn bytes<const N: usize>(&mut self) -> [u8; N] {
        match self.0.split_first_chunk::<N>() {
            Some((head, rest)) => {
                self.0 = rest;
                *head
            }
            None => [0; N],
        }
    }

    pub fn u8(&mut self) -> u8 {
        let [byte] = self.bytes();
        byte
    }

    pub fn u16(&mut self) -> u16 {
        u16::from_le_bytes(self.bytes())
    }

    pub fn i16(&mut self) -> i16 {
        i16::from_le_bytes(self.bytes())
    }

    pub fn u32(&mut self) -> u32 {
        u32::from_le_bytes(self.bytes())
    }

    pub fn i32(&mut self) -> i32 {
        i32::from_le_bytes(self.bytes())
    }

    /// Reads four numbers of the same type, in the order of the motors.
    pub fn four<T>(&mut self, mut one: impl FnMut(&mut Self) -> T) -> [T; 4] {
        std::array::from_fn(|_| one(self))
    }
}

/// Appends numbers to a frame. The buffer has the size of the largest frame, and a test checks that every type of frame
/// fits. Numbers that do not fit are omitted.
pub(super) struct FieldWriter<'a> {
    buffer: &'a mut [u8],
    length: usize,
}

impl<'a> FieldWriter<'a> {
    pub fn new(buffer: &'a mut [u8]) -> Self {
        Self { buffer, length: 0 }
    }

    pub fn written(&self) -> &[u8] {
        &self.buffer[..self.length]
    }

    pub fn bytes(&mut self, bytes: &[u8]) {
        if let Some(room) = self.buffer.get_mut(self.length..self.length + bytes.len()) {
            room.copy_from_slice(bytes);
            self.length += bytes.len();
        }
    }

    pub fn u8(&mut self, value: u8) {
        self.bytes(&[value]);
    }

    pub fn u16(&mut self, value: u16) {
        self.bytes(&value.to_le_bytes());
    }

    pub fn i16(&mut self, value: i16) {
        self.bytes(&value.to_le_bytes());
    }

    pub fn u32(&mut self, value: u32) {
        self.bytes(&value.to_le_bytes());
    }

    pub fn i32(&mut self, value: i32) {
        self.bytes(&value.to_le_bytes());
    }
}
