use super::port_error::PortError;

/// Carries bytes to and from a board, and has a clock. A serial port is a transport. Tests use other transports, with
/// simulated time.
pub trait Transport {
    /// Sends bytes without waiting, and returns how many were sent. Bytes that do not fit now are lost.
    fn write(&mut self, bytes: &[u8]) -> Result<usize, PortError>;

    /// Waits for bytes, at most until `deadline` (ns on this transport's clock). Reads the bytes that have arrived, and
    /// returns their number, which is 0 if none has arrived at the deadline. A transport that knows that no byte can
    /// arrive may return 0 before the deadline. Bytes that have already arrived are read even after the deadline.
    fn read_until(&mut self, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError>;

    /// Returns the time at which the bytes of the last read became readable, ns. The read itself can happen later.
    fn ready_at(&self) -> u64 {
        self.now()
    }

    /// Discards bytes that have arrived but were not read.
    fn discard_input(&mut self) -> Result<(), PortError>;

    /// Returns the current time, ns.
    fn now(&self) -> u64;
}
