use super::port_error::PortError;

/// What carries bytes to a board and back, on a clock. A serial port is one; tests have others, on simulated time.
pub trait Transport {
    /// Sends bytes without waiting; what does not fit now is lost. How many were sent.
    fn write(&mut self, bytes: &[u8]) -> Result<usize, PortError>;

    /// Waits for bytes, at most until `deadline` (ns on this transport's clock), and takes what is there: at least one
    /// byte, or none at the deadline. Bytes that are there already are taken even after the deadline.
    fn read_until(&mut self, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError>;

    /// When the bytes that were last taken could be read, ns: the reading itself comes after.
    fn ready_at(&self) -> u64 {
        self.now()
    }

    /// Throws away bytes that came in and were not read.
    fn discard_input(&mut self) -> Result<(), PortError>;

    /// The time, ns.
    fn now(&self) -> u64;
}
